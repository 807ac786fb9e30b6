#include "io/field/trouble_vtu.h"

#include <cstring>

#include "io/grammar/vtk_cells.h"
#include "io/grammar/vtu_document.h"

namespace sterna::io {
namespace {

static_assert(sizeof(Point) == 3 * sizeof(double));

/// A small mesh in memory that can be converted to a document.
struct SmallGrid {
  const std::vector<Point>* points = nullptr;
  std::vector<std::int32_t> connectivity, offsets, types, marker;

  template <class Nodes>
  void add(const Nodes& nodes, int vtk_type, std::int32_t mark) {
    for (const auto node : nodes) connectivity.push_back(static_cast<std::int32_t>(node));
    offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    types.push_back(vtk_type);
    marker.push_back(mark);
  }

  /// Returns the grid as a document that refers to it.
  VtuDocument document(std::string marker_name) const&& = delete;
  VtuDocument document(std::string marker_name) const& {
    VtuDocument result;
    result.n_points = points->size();
    result.n_cells = types.size();
    result.points = {.name = "Points",
                     .type = VtuType::float64,
                     .n_components = 3,
                     .n_values = 3 * points->size(),
                     .fill = [p = points](std::uint64_t begin, std::uint64_t end, char* out) {
                       std::memcpy(out, reinterpret_cast<const char*>(p->data()) + begin * sizeof(double), (end - begin) * sizeof(double));
                     }};
    result.connectivity = vtu_array("connectivity", connectivity);
    result.offsets = vtu_array("offsets", offsets);
    result.types = {.name = "types", .type = VtuType::uint8, .n_values = types.size(), .fill = [this](std::uint64_t begin, std::uint64_t end, char* out) {
                      for (std::uint64_t i = begin; i < end; ++i) *out++ = static_cast<char>(types[i]);
                    }};
    result.cell_data.push_back(vtu_array(std::move(marker_name), marker));
    return result;
  }
};

}  // namespace

void write_trouble_vtu(const TroubleGeometry& geometry, const std::filesystem::path& path) {
  SmallGrid grid{.points = &geometry.points};
  for (const auto& triangle : geometry.triangles) grid.add(triangle, k_vtk_triangle, 2);
  for (const auto& edge : geometry.edges) grid.add(edge, k_vtk_line, 1);
  for (const std::uint32_t vertex : geometry.vertices) grid.add(std::array{vertex}, k_vtk_vertex, 0);
  write_vtu(grid.document("dimension"), path, RunContext({.threads = 1}));
}

}  // namespace sterna::io
