#include "io/file/surface_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "geom/base/error.h"
#include "io/file/format_table.h"
#include "io/file/volume_file.h"
#include "io/input/file_buffer.h"
#include "io/mesh/surface_boundary.h"
#include "io/names/patch_names.h"

namespace sterna::io {
namespace {

struct LocationHash {
  std::size_t operator()(const std::array<std::uint64_t, 3>& location) const {
    constexpr std::uint64_t k_odd = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio: spreads the bits
    std::uint64_t hash = 0;
    for (const std::uint64_t word : location) hash = (std::rotl(hash, 23) ^ word) * k_odd;
    return hash ^ (hash >> 32);
  }
};

/// Returns a hash key of a position in which positive and negative zero are equal.
std::array<std::uint64_t, 3> location_of(const Vec3& p) {
  return {std::bit_cast<std::uint64_t>(p.x + 0.0), std::bit_cast<std::uint64_t>(p.y + 0.0), std::bit_cast<std::uint64_t>(p.z + 0.0)};
}

bool has_separate_corners(const SurfaceSoup& soup) {
  if (soup.points.size() != 3 * soup.triangles.size()) return false;
  for (std::uint32_t t = 0; t < soup.triangles.size(); ++t)
    if (soup.triangles[t] != std::array<std::uint32_t, 3>{3 * t, 3 * t + 1, 3 * t + 2}) return false;
  return true;
}

}  // namespace

SurfaceSoup read_surface_file(const std::filesystem::path& path, const RunContext& context) {
  const Format& format = format_of(path);
  if (!format.read_surface)
    throw Error({.code = ErrorCode::unsupported_format,
                 .attempted = "reading " + path.string(),
                 .problem = std::string(format.name) + " is not read as a surface",
                 .hint = "surfaces are read from " + list_formats_with(FormatUse::read_surface)});
  SurfaceSoup soup = format.read_surface(path, context);
  if (soup.triangles.empty() && soup.n_cells > 0) {  // the reader found cells and no face
    if (!format.read_volume)
      throw_malformed(soup.source, "end of the file", "found a volume mesh of " + std::to_string(soup.n_cells) + " cells without boundary faces",
                      "write the boundary as triangles or quadrilaterals, or convert the mesh to a format whose volume meshes are read");
    soup = boundary_soup(read_volume_file(path, context), soup.source, context);
  }
  return soup;
}

namespace {

constexpr std::size_t k_named_patches = 4;  ///< in messages

/// Warns about patch names and kinds that the format does not store. The default STL is binary for a single patch, so it then stores no name.
void warn_of_lost_patches(const TriMesh& mesh, const std::filesystem::path& path, const Format& format, const RunContext& context) {
  const bool is_binary_stl = format.name == "STL" && mesh.patches.size() <= 1;
  if (format.carries_patch_names && !is_binary_stl) return;
  std::string kinds;
  std::size_t n_kinds = 0;
  for (const Patch& patch : mesh.patches)
    if (patch.kind != PatchKind::wall && ++n_kinds <= k_named_patches)
      kinds += (kinds.empty() ? "\"" : ", \"") + patch.name + "\" (" + std::string(to_string(patch.kind)) + ")";
  if (n_kinds > k_named_patches) kinds += " and " + std::to_string(n_kinds - k_named_patches) + " more";
  std::string lost;
  if (mesh.patches.size() > 1) lost = "the " + std::to_string(mesh.patches.size()) + " patches of the surface become one patch";
  if (n_kinds > 0) lost += (lost.empty() ? "" : ", and ") + std::string("the kinds of ") + kinds + " are lost, because manifests store kinds by patch name";
  if (lost.empty()) return;
  std::string others;
  for (const Format& other : formats())
    if (other.write_surface && other.carries_patch_names && other.name != "STL") others += (others.empty() ? "" : ", ") + std::string(other.name);
  context.warn(path.string() + ": " + std::string(is_binary_stl ? "binary STL" : format.name) + " has no patches: " + lost + ". Formats with names: " + others);
}

}  // namespace

void write_surface_file(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context, std::string_view format_name) {
  const Format& format = format_to_write(path, FormatUse::write_surface, format_name);
  for (const PatchId patch : mesh.triangle_patch)
    if (patch.index() >= mesh.patches.size())
      throw Error({.code = ErrorCode::mesh_invalid, .attempted = "writing " + path.string(), .problem = "a triangle belongs to no patch"});
  for (const VertexId v : mesh.points.ids())
    if (!is_finite(mesh.points[v]))
      throw Error({.code = ErrorCode::mesh_invalid,
                   .attempted = "writing " + path.string(),
                   .problem = "the coordinates of vertex " + std::to_string(v.value()) + " are not finite"});
  warn_of_lost_patches(mesh, path, format, context);
  const StageTimer timer(context, "write");
  format.write_surface(mesh, path, context);
}

TriMesh to_tri_mesh(const SurfaceSoup& soup) {
  TriMesh mesh;
  std::vector<VertexId> vertex_of_point;
  vertex_of_point.reserve(soup.points.size());
  if (has_separate_corners(soup)) {
    std::unordered_map<std::array<std::uint64_t, 3>, VertexId, LocationHash> vertex_at;
    for (const Vec3& p : soup.points) {
      const auto [entry, is_new] = vertex_at.try_emplace(location_of(p));
      if (is_new) entry->second = mesh.points.push_back(p);
      vertex_of_point.push_back(entry->second);
    }
  } else {
    mesh.points.raw() = soup.points;
    for (const VertexId v : mesh.points.ids()) vertex_of_point.push_back(v);
  }
  for (const auto& t : soup.triangles) mesh.triangles.push_back({vertex_of_point[t[0]], vertex_of_point[t[1]], vertex_of_point[t[2]]});
  for (const std::uint32_t patch : soup.patch) mesh.triangle_patch.push_back(PatchId(patch));
  for (const std::string& name : soup.patch_names) mesh.patches.push_back({.name = name, .kind = kind_of_name(name)});
  return mesh;
}

}  // namespace sterna::io
