#include "io/file/volume_file.h"

#include <optional>
#include <string>

#include "geom/base/error.h"
#include "geom/mesh/open_faces.h"
#include "io/file/format_table.h"

namespace sterna::io {
namespace {

constexpr std::string_view k_boundary_name = "boundary";
constexpr double k_read_end = 0.9;  // fraction of the time for reading; the boundary test takes the rest

/// Finds open faces. Returns nothing, with a warning, if the mesh has so many cells that its faces cannot be numbered.
std::optional<OpenFaces> open_faces_of(const HybridMesh& mesh, std::string_view source, const RunContext& context) {
  try {
    return find_open_faces(mesh, context);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::overflow) throw;
    context.warn(std::string(source) + ": the mesh is too large to test whether its boundary is complete");
    return std::nullopt;
  }
}

void complete_boundary(HybridMesh& mesh, const std::string& source, Incomplete incomplete, const RunContext& context) {
  const std::optional<OpenFaces> open = open_faces_of(mesh, source, context);
  if (!open || open->size() == 0) return;
  const bool has_none = mesh.boundary_triangles.empty() && mesh.boundary_quads.empty();
  const std::string first = format_point(open->first_location(mesh));
  if (has_none || incomplete == Incomplete::completed) {
    const PatchId patch = add_boundary(mesh, *open, k_boundary_name);
    context.warn(source + ": " + (has_none ? "the file has no boundary faces" : "boundary faces are missing, the first at " + first) + "; the " +
                 std::to_string(open->triangles.size()) + " triangles and " + std::to_string(open->quads.size()) +
                 " quadrilaterals that belong to one cell only became the patch \"" + mesh.patches[patch].name + "\" of the kind wall" +
                 (has_none ? "" : ". If cells are missing there, the mesh has a hole"));
  } else {
    context.warn(source + ": " + std::to_string(open->size()) + " faces belong to one cell and to no patch, the first at " + first +
                 ". A marker or cells are missing: check reports the mesh as INVALID; convert collects these faces in a patch \"boundary\"");
  }
}

void report_unused_points(HybridMesh& mesh, const std::string& source, Incomplete incomplete, const RunContext& context) {
  const std::uint64_t n = count_unused_points(mesh);
  if (n == 0) return;
  const bool is_dropped = incomplete == Incomplete::completed && mesh.layers.n_columns() == 0;
  context.warn(source + ": " + std::to_string(n) + " of " + std::to_string(mesh.points.size()) + " points belong to no cell" +
               (is_dropped ? " and are left out" : "; convert leaves them out"));
  if (is_dropped) drop_unused_points(mesh);
}

}  // namespace

HybridMesh read_volume_file(const std::filesystem::path& path, const RunContext& context, Incomplete incomplete) {
  const Format& format = format_of(path, FormatUse::read_volume);
  if (!format.read_volume)
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "reading " + path.string(),
                 .problem = "volume meshes are not read from " + std::string(format.name),
                 .hint = "volume meshes are read from " + list_formats_with(FormatUse::read_volume)});
  const StageTimer timer(context, "read");
  HybridMesh mesh = format.read_volume(path, context.part("read", 0.0, k_read_end));
  if (count_cells(mesh).total() == 0) return mesh;
  complete_boundary(mesh, path.string(), incomplete, context.part("boundary", k_read_end, 1.0));
  report_unused_points(mesh, path.string(), incomplete, context);
  return mesh;
}

void write_volume_file(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name, Numbering cells) {
  const Format& format = format_to_write(path, FormatUse::write_volume, format_name);
  const StageTimer timer(context, "write");
  if (format.write_numbered) format.write_numbered(mesh, path, cells, context.part("write", 0.0, 1.0));
  else format.write_volume(mesh, path, context.part("write", 0.0, 1.0));
}

}  // namespace sterna::io
