// VTU writer. The arrays of a mesh are functions of a range, so that the cells of the columns are never stored.
#include <algorithm>
#include <cstring>
#include <limits>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/mesh/cell_quality.h"
#include "io/grammar/vtk_cells.h"
#include "io/grammar/vtk_grid.h"
#include "io/grammar/vtu_document.h"
#include "io/output/cell_sections.h"
#include "io/volume/volume_vtu.h"

namespace sterna::io {
namespace {

/// A run of cells or faces of one type in the file.
struct Run {
  int vtk_type = 0;
  std::uint64_t n_nodes = 0;  ///< nodes per cell
  std::uint64_t n_cells = 0;
  std::uint64_t first_cell = 0;   ///< number of the first cell in the file
  std::uint64_t first_value = 0;  ///< index of the first value in the connectivity
};

enum : std::size_t { k_triangle_run = 4, k_quad_run = 5, k_n_runs = 6 };

/// The cells of a VTU file: volume cells by kind, then boundary faces.
class FileCells {
 public:
  explicit FileCells(const HybridMesh& mesh) : mesh_(mesh), cells_(mesh) {
    for (std::size_t k = 0; k < k_kinds_in_file.size(); ++k)
      add(k, vtk_type(k_kinds_in_file[k]), static_cast<std::uint64_t>(n_nodes(k_kinds_in_file[k])), cells_.count(k_kinds_in_file[k]));
    add(k_triangle_run, k_vtk_triangle, 3, mesh.boundary_triangles.size());
    add(k_quad_run, k_vtk_quad, 4, mesh.boundary_quads.size());
  }

  std::uint64_t n_cells() const { return n_cells_; }
  std::uint64_t n_values() const { return n_values_; }

  /// Calls f(run number, begin, end) for each run that the file's cells [begin, end) touch. The arguments begin and end of f count within the run.
  template <class F>
  void for_each_run(std::uint64_t begin, std::uint64_t end, const F& f) const {
    for (std::size_t r = 0; r < k_n_runs; ++r) {
      const Run& run = runs_[r];
      const std::uint64_t from = std::max(begin, run.first_cell);
      const std::uint64_t to = std::min(end, run.first_cell + run.n_cells);
      if (from < to) f(r, from - run.first_cell, to - run.first_cell);
    }
  }

  /// Calls f(nodes in VTK order, layer, marker) for cells [begin, end) of run r.
  template <class F>
  void for_each_cell(std::size_t r, std::uint64_t begin, std::uint64_t end, const F& f) const {
    if (r == k_triangle_run) {
      for (std::uint64_t i = begin; i < end; ++i) f(std::span<const NodeId>(mesh_.boundary_triangles[i].nodes), 0, marker(mesh_.boundary_triangles[i].patch));
    } else if (r == k_quad_run) {
      for (std::uint64_t i = begin; i < end; ++i) f(std::span<const NodeId>(mesh_.boundary_quads[i].nodes), 0, marker(mesh_.boundary_quads[i].patch));
    } else {
      const auto order = vtk_order(k_kinds_in_file[r]);
      std::array<NodeId, 8> turned;
      cells_.for_each(k_kinds_in_file[r], begin, end, [&](std::span<const NodeId> nodes, int layer) {
        for (std::size_t i = 0; i < nodes.size(); ++i) turned[i] = nodes[order[i]];
        f(std::span<const NodeId>(turned.data(), nodes.size()), layer, 0);
      });
    }
  }

  const Run& run(std::size_t r) const { return runs_[r]; }

 private:
  static std::int32_t marker(PatchId patch) { return static_cast<std::int32_t>(patch.value()) + 1; }
  void add(std::size_t r, int type, std::uint64_t n_nodes, std::uint64_t n_cells) {
    runs_[r] = {.vtk_type = type, .n_nodes = n_nodes, .n_cells = n_cells, .first_cell = n_cells_, .first_value = n_values_};
    n_cells_ += n_cells;
    n_values_ += n_cells * n_nodes;
  }

  const HybridMesh& mesh_;
  CellSections cells_;
  std::array<Run, k_n_runs> runs_;
  std::uint64_t n_cells_ = 0;
  std::uint64_t n_values_ = 0;
};

template <class T>
char* put(char* out, T value) {
  std::memcpy(out, &value, sizeof(T));
  return out + sizeof(T);
}

/// Returns an array of one value per cell of the file; value(run number, nodes, layer, marker).
template <class T, class Value>
VtuArray per_cell(std::string name, VtuType type, const FileCells& cells, const Value& value) {
  return {.name = std::move(name), .type = type, .n_values = cells.n_cells(), .fill = [&cells, value](std::uint64_t begin, std::uint64_t end, char* out) {
            cells.for_each_run(begin, end, [&](std::size_t r, std::uint64_t from, std::uint64_t to) {
              cells.for_each_cell(r, from, to, [&](std::span<const NodeId>, int layer, std::int32_t marker) { out = put<T>(out, value(layer, marker)); });
            });
          }};
}

VtuArray types_array(const FileCells& cells) {
  return {.name = "types", .type = VtuType::uint8, .n_values = cells.n_cells(), .fill = [&cells](std::uint64_t begin, std::uint64_t end, char* out) {
            cells.for_each_run(begin, end, [&](std::size_t r, std::uint64_t from, std::uint64_t to) {
              out = std::fill_n(out, to - from, static_cast<char>(cells.run(r).vtk_type));
            });
          }};
}

template <class T>
VtuArray offsets_array(VtuType type, const FileCells& cells) {
  return {.name = "offsets", .type = type, .n_values = cells.n_cells(), .fill = [&cells](std::uint64_t begin, std::uint64_t end, char* out) {
            cells.for_each_run(begin, end, [&](std::size_t r, std::uint64_t from, std::uint64_t to) {
              const Run& run = cells.run(r);
              for (std::uint64_t i = from; i < to; ++i) out = put<T>(out, static_cast<T>(run.first_value + (i + 1) * run.n_nodes));
            });
          }};
}

/// Generates the values [begin, end). A block may begin or end within a cell: all cells that it touches are generated and then clipped.
template <class T>
VtuArray connectivity_array(VtuType type, const FileCells& cells) {
  return {.name = "connectivity", .type = type, .n_values = cells.n_values(), .fill = [&cells](std::uint64_t begin, std::uint64_t end, char* out) {
            for (std::size_t r = 0; r < k_n_runs; ++r) {
              const Run& run = cells.run(r);
              const std::uint64_t from = std::max(begin, run.first_value);
              const std::uint64_t to = std::min(end, run.first_value + run.n_cells * run.n_nodes);
              if (from >= to) continue;
              const std::uint64_t first_cell = (from - run.first_value) / run.n_nodes;
              const std::uint64_t last_cell = (to - run.first_value + run.n_nodes - 1) / run.n_nodes;
              std::uint64_t value = run.first_value + first_cell * run.n_nodes;
              cells.for_each_cell(r, first_cell, last_cell, [&](std::span<const NodeId> nodes, int, std::int32_t) {
                for (const NodeId node : nodes) {
                  if (value >= from && value < to) out = put<T>(out, static_cast<T>(node.value()));
                  ++value;
                }
              });
            }
          }};
}

VtuArray points_array(const HybridMesh& mesh) {
  static_assert(sizeof(Point) == 3 * sizeof(double));
  return {.name = "Points",
          .type = VtuType::float64,
          .n_components = 3,
          .n_values = 3 * mesh.points.size(),
          .fill = [&mesh](std::uint64_t begin, std::uint64_t end, char* out) {
            const char* const bytes = reinterpret_cast<const char*>(mesh.points.raw().data());
            std::memcpy(out, bytes + begin * sizeof(double), (end - begin) * sizeof(double));
          }};
}

/// Returns the qualities of all cells in the file.
std::vector<CellQuality> qualities_of(const HybridMesh& mesh, const RunContext& context) {
  constexpr double k_nan = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t k_chunk = 4096;
  const CellSections sections(mesh);
  const FileCells cells(mesh);
  std::vector<CellQuality> qualities(cells.n_cells(), {k_nan, k_nan, k_nan, k_nan});
  for (std::size_t r = 0; r < k_kinds_in_file.size(); ++r) {
    const CellKind kind = k_kinds_in_file[r];
    parallel_chunks(context, sections.count(kind), k_chunk, [&](std::size_t begin, std::size_t end) {
      std::uint64_t at = cells.run(r).first_cell + begin;
      std::array<Vec3, 8> p;
      sections.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int) {
        for (std::size_t k = 0; k < nodes.size(); ++k) p[k] = mesh.points[nodes[k]];
        qualities[at++] = cell_quality(kind, {p.data(), nodes.size()});
      });
    });
  }
  return qualities;
}

void add_quality_arrays(const std::vector<CellQuality>& qualities, VtuDocument& document) {
  constexpr double k_degrees = 180.0 / std::numbers::pi;
  const auto add = [&](std::string name, double CellQuality::*member, double unit) {
    document.cell_data.push_back({.name = std::move(name),
                                  .type = VtuType::float64,
                                  .n_values = qualities.size(),
                                  .fill = [&qualities, member, unit](std::uint64_t begin, std::uint64_t end, char* out) {
                                    for (std::uint64_t i = begin; i < end; ++i) out = put<double>(out, unit * (qualities[i].*member));
                                  }});
  };
  add("scaled_jacobian", &CellQuality::scaled_jacobian, 1.0);
  add("volume", &CellQuality::volume, 1.0);
  add("min_dihedral", &CellQuality::min_dihedral, k_degrees);
  add("max_dihedral", &CellQuality::max_dihedral, k_degrees);
}

void write_with(const HybridMesh& mesh, const std::vector<CellQuality>* qualities, const std::filesystem::path& path, const RunContext& context) {
  const FacesByPatch checked(mesh);  // rejects faces without patch
  constexpr std::uint64_t k_int32 = std::numeric_limits<std::int32_t>::max();
  const FileCells cells(mesh);
  VtuDocument document;
  document.packing = vtu_packing(path);
  document.n_points = mesh.points.size();
  document.n_cells = cells.n_cells();
  document.points = points_array(mesh);
  document.connectivity =
      mesh.points.size() <= k_int32 ? connectivity_array<std::int32_t>(VtuType::int32, cells) : connectivity_array<std::int64_t>(VtuType::int64, cells);
  document.offsets = cells.n_values() <= k_int32 ? offsets_array<std::int32_t>(VtuType::int32, cells) : offsets_array<std::int64_t>(VtuType::int64, cells);
  document.types = types_array(cells);
  document.cell_data.push_back(per_cell<std::int32_t>("marker", VtuType::int32, cells, [](int, std::int32_t marker) { return marker; }));
  document.cell_data.push_back(per_cell<std::int32_t>("layer", VtuType::int32, cells, [](int layer, std::int32_t) { return layer; }));
  for (const PatchId patch : mesh.patches.ids())
    document.field_data.emplace_back(vtk_patch_key(mesh.patches[patch]), static_cast<std::int32_t>(patch.value()) + 1);
  if (qualities) add_quality_arrays(*qualities, document);
  write_vtu(document, path, context);
}

}  // namespace

void write_volume_vtu(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) { write_with(mesh, nullptr, path, context); }

void write_quality_vtu(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const std::vector<CellQuality> qualities = qualities_of(mesh, context);
  write_with(mesh, &qualities, path, context);
}

}  // namespace sterna::io
