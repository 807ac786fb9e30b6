#include "io/surface/surface_vtk.h"

#include <bit>
#include <limits>

#include "io/grammar/vtk_grid.h"
#include "io/grammar/vtk_legacy.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

enum class Encoding { text, binary };

/// Escapes an array name, which must not contain blanks; VTK decodes these escapes.
std::string escaped(std::string_view name) {
  constexpr std::string_view k_digits = "0123456789ABCDEF";
  std::string text;
  for (const char c : name) {
    const auto u = static_cast<unsigned char>(c);
    if (u > ' ' && u != 0x7f && c != '%' && c != '"') text += c;
    else text += {'%', k_digits[u >> 4], k_digits[u & 15]};
  }
  return text;
}

std::string number(std::int32_t value, Encoding encoding) {
  if (encoding == Encoding::text) return std::to_string(value) + "\n";
  std::string bytes(sizeof value, '\0');
  put_bytes(bytes.data(), value, std::endian::big);
  return bytes + "\n";
}

std::string head(const TriMesh& mesh, Encoding encoding) {
  std::string text = "# vtk DataFile Version 3.0\nsurface\n" + std::string(encoding == Encoding::text ? "ASCII" : "BINARY") + "\nDATASET POLYDATA\n";
  if (mesh.patches.size() > 0) text += "FIELD FieldData " + std::to_string(mesh.patches.size()) + "\n";
  for (const PatchId patch : mesh.patches.ids())
    text += escaped(vtk_patch_key(mesh.patches[patch])) + " 1 1 int\n" + number(static_cast<std::int32_t>(patch.value()) + 1, encoding);
  return text + "POINTS " + std::to_string(mesh.n_vertices()) + " double\n";
}

OutputSection binary_points(const TriMesh& mesh) {
  return items_section(mesh.n_vertices(), 3 * sizeof(double), [&mesh](std::uint64_t i, char* at) {
    for (std::size_t axis = 0; axis < 3; ++axis) at = put_bytes(at, mesh.points.raw()[i][axis], std::endian::big);
    return at;
  });
}
OutputSection binary_triangles(const TriMesh& mesh) {
  return items_section(mesh.n_triangles(), 4 * sizeof(std::int32_t), [&mesh](std::uint64_t i, char* at) {
    at = put_bytes(at, std::int32_t{3}, std::endian::big);
    for (const VertexId v : mesh.triangles.raw()[i]) at = put_bytes(at, static_cast<std::int32_t>(v.value()), std::endian::big);
    return at;
  });
}
OutputSection binary_markers(const TriMesh& mesh) {
  return items_section(mesh.n_triangles(), sizeof(std::int32_t), [&mesh](std::uint64_t i, char* at) {
    return put_bytes(at, static_cast<std::int32_t>(patch_number(mesh, TriangleId(i))), std::endian::big);
  });
}

void write(const TriMesh& mesh, const std::filesystem::path& path, Encoding encoding, const RunContext& context) {
  require_count(4 * mesh.n_triangles(), std::numeric_limits<std::int32_t>::max(), "values of POLYGONS", "legacy VTK 3.0", path.string());
  const std::string n = std::to_string(mesh.n_triangles());
  const bool is_text = encoding == Encoding::text;
  const std::string end = is_text ? "" : "\n";  // the lines of a text file contain their own line ends
  const std::vector<OutputSection> sections = {fixed_section(head(mesh, encoding)),
                                               is_text ? point_lines(mesh, "") : binary_points(mesh),
                                               fixed_section(end + "POLYGONS " + n + " " + std::to_string(4 * mesh.n_triangles()) + "\n"),
                                               is_text ? triangle_lines(mesh, "3 ", 0) : binary_triangles(mesh),
                                               fixed_section(end + "CELL_DATA " + n + "\nSCALARS marker int 1\nLOOKUP_TABLE default\n"),
                                               is_text ? patch_number_lines(mesh) : binary_markers(mesh),
                                               fixed_section(end)};
  write_file(path, sections, context);
}

}  // namespace

SurfaceSoup read_surface_vtk(const std::filesystem::path& path, const RunContext& context) { return surface_of(read_vtk_grid(path, context), context); }
HybridMesh read_volume_vtk(const std::filesystem::path& path, const RunContext& context) { return volume_of(read_vtk_grid(path, context), context); }

void write_surface_vtk(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write(mesh, path, Encoding::binary, context); }
void write_surface_vtk_text(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write(mesh, path, Encoding::text, context); }

}  // namespace sterna::io
