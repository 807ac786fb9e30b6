#include "io/surface/surface_vtu.h"

#include <cstring>
#include <limits>

#include "io/grammar/vtu_document.h"
#include "io/grammar/vtu_grid.h"
#include "io/mesh/surface_boundary.h"
#include "io/output/surface_output.h"
#include "io/volume/volume_vtu.h"

namespace sterna::io {
namespace {

VtuArray points_array(const TriMesh& mesh) {
  static_assert(sizeof(Point) == 3 * sizeof(double));
  return {.name = "Points",
          .type = VtuType::float64,
          .n_components = 3,
          .n_values = 3 * mesh.n_vertices(),
          .fill = [&mesh](std::uint64_t begin, std::uint64_t end, char* out) {
            std::memcpy(out, reinterpret_cast<const char*>(mesh.points.raw().data()) + begin * sizeof(double), (end - begin) * sizeof(double));
          }};
}

/// Returns value(i) for i in [0, n).
template <class Value>
VtuArray int32_array(std::string name, std::uint64_t n, const Value& value) {
  return {.name = std::move(name), .type = VtuType::int32, .n_values = n, .fill = [value](std::uint64_t begin, std::uint64_t end, char* out) {
            for (std::uint64_t i = begin; i < end; ++i) out = put_bytes(out, static_cast<std::int32_t>(value(i)), std::endian::little);
          }};
}

}  // namespace

SurfaceSoup read_surface_vtu(const std::filesystem::path& path, const RunContext& context) { return surface_of(read_vtu_grid(path, context), context); }

void write_surface_vtu(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_volume_vtu(as_boundary(mesh, Winding::kept), path, context);
}

void write_surface_vtp(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  require_count(3 * mesh.n_triangles(), std::numeric_limits<std::int32_t>::max(), "corners of triangles", "VTP with 32-bit indices", path.string());
  VtuDocument document;
  document.kind = VtuKind::poly_data;
  document.n_points = mesh.n_vertices();
  document.n_cells = mesh.n_triangles();
  document.points = points_array(mesh);
  document.connectivity = int32_array("connectivity", 3 * mesh.n_triangles(), [&mesh](std::uint64_t i) { return mesh.triangles.raw()[i / 3][i % 3].value(); });
  document.offsets = int32_array("offsets", mesh.n_triangles(), [](std::uint64_t i) { return 3 * (i + 1); });
  document.cell_data.push_back(int32_array("marker", mesh.n_triangles(), [&mesh](std::uint64_t i) { return patch_number(mesh, TriangleId(i)); }));
  for (const PatchId patch : mesh.patches.ids())
    document.field_data.emplace_back(vtk_patch_key(mesh.patches[patch]), static_cast<std::int32_t>(patch.value()) + 1);
  write_vtu(document, path, context);
}

}  // namespace sterna::io
