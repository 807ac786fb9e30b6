#include "io/field/field_vtu.h"

#include <cstring>

#include "io/grammar/vtk_cells.h"
#include "io/grammar/vtk_grid.h"
#include "io/grammar/vtu_document.h"

namespace sterna::io {
namespace {

VtuArray array_of(const TriMeshField& field) {
  return {
      .name = field.unit.empty() ? field.name : field.name + "_" + field.unit,
      .type = VtuType::float32,
      .n_values = field.values.size(),
      .fill = [&field](std::uint64_t begin, std::uint64_t end, char* out) { std::memcpy(out, field.values.data() + begin, (end - begin) * sizeof(float)); }};
}

}  // namespace

void write_field_vtu(const TriMesh& mesh, const std::vector<TriMeshField>& fields, const std::filesystem::path& path, const RunContext& context) {
  std::vector<std::int32_t> connectivity, offsets, marker;
  for (const TriangleId t : mesh.triangles.ids()) {
    for (const VertexId v : mesh.triangles[t]) connectivity.push_back(static_cast<std::int32_t>(v.value()));
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    marker.push_back(static_cast<std::int32_t>(mesh.triangle_patch[t].value()) + 1);
  }
  static_assert(sizeof(Point) == 3 * sizeof(double));
  VtuDocument document;
  document.n_points = mesh.n_vertices();
  document.n_cells = mesh.n_triangles();
  document.points = {.name = "Points",
                     .type = VtuType::float64,
                     .n_components = 3,
                     .n_values = 3 * mesh.n_vertices(),
                     .fill = [&mesh](std::uint64_t begin, std::uint64_t end, char* out) {
                       std::memcpy(out, reinterpret_cast<const char*>(mesh.points.raw().data()) + begin * sizeof(double), (end - begin) * sizeof(double));
                     }};
  document.connectivity = vtu_array("connectivity", connectivity);
  document.offsets = vtu_array("offsets", offsets);
  document.types = {.name = "types", .type = VtuType::uint8, .n_values = mesh.n_triangles(), .fill = [](std::uint64_t begin, std::uint64_t end, char* out) {
                      std::memset(out, k_vtk_triangle, end - begin);
                    }};
  document.cell_data.push_back(vtu_array("marker", marker));
  for (const TriMeshField& field : fields) (field.is_at_vertices ? document.point_data : document.cell_data).push_back(array_of(field));
  for (const PatchId patch : mesh.patches.ids())
    document.field_data.emplace_back(vtk_patch_key(mesh.patches[patch]), static_cast<std::int32_t>(patch.value()) + 1);
  document.packing = vtu_packing(path);
  write_vtu(document, path, context);
}

}  // namespace sterna::io
