// One pass over all cells: the exact test of each kind (G3), the volumes for the divergence theorem, and quality while the points are loaded.
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "geom/mesh/check_parts.h"
#include "geom/mesh/column_scan.h"
#include "geom/mesh/computed_volumes.h"
#include "geom/mesh/layer_scans.h"

namespace sterna::check_parts {
namespace {

class CellScanner {
 public:
  CellScanner(const HybridMesh& mesh, bool with_quality, const GateTable& limits) : mesh_(mesh), with_quality_(with_quality), columns_(mesh), scan_(limits) {}

  CellScan take() { return std::move(scan_); }

  void add_column(std::uint64_t first_number, std::size_t column) {
    const LayerBlock& layers = mesh_.layers;
    if (layers.is_prismatic(column)) {
      add_prisms(first_number, column);
      return;
    }
    for (int j = 0, n = layers.layers_of_column(column); j < n; ++j) {
      const std::uint64_t number = first_number + static_cast<std::uint64_t>(j);
      const Cell cell = layers.cell(column, j);
      if (cell.kind == CellKind::prism) {
        add_prism(number, points_of<6>(cell.nodes));
        continue;
      }
      if (cell.kind == CellKind::pyramid) {
        add_pyramid(number, points_of<5>(cell.nodes));
      } else {
        const auto p = points_of<4>(cell.nodes);
        note(number, is_tet_valid(p), CellKind::tetrahedron, p);
        scan_.layer_volume.add(tet_volume(p[0], p[1], p[2], p[3]));
        if (with_quality_) add_dihedrals(number, tet_dihedral_range(p));
      }
      if (with_quality_ && layers.n_collapsed(column) > 0) scan_.quality.add_collapsed();
    }
  }

  void add_explicit(std::uint64_t number, const std::array<NodeId, 6>& nodes) { add_prism(number, points_of<6>(nodes)); }
  void add_explicit(std::uint64_t number, const std::array<NodeId, 5>& nodes) { add_pyramid(number, points_of<5>(nodes)); }
  void add_explicit(std::uint64_t number, const std::array<NodeId, 8>& nodes) {
    const auto p = points_of<8>(nodes);
    note(number, is_hexahedron_valid(p), CellKind::hexahedron, p);
    scan_.layer_volume.add(hexahedron_volume(p));
  }
  void add_explicit(std::uint64_t number, const std::array<NodeId, 4>& nodes) {
    const auto p = points_of<4>(nodes);
    note(number, is_tet_valid(p), CellKind::tetrahedron, p);
    scan_.tet_volume.add(tet_volume(p[0], p[1], p[2], p[3]));
    if (!with_quality_) return;
    const auto range = tet_dihedral_range(p);
    add_dihedrals(number, range);
    scan_.quality.add_tet(p, range);
  }

 private:
  template <std::size_t N, class Nodes>
  std::array<Vec3, N> points_of(const Nodes& nodes) const {
    std::array<Vec3, N> p;
    for (std::size_t k = 0; k < N; ++k) p[k] = mesh_.points[nodes[k]];
    return p;
  }
  void note(std::uint64_t number, bool is_valid, double least_jacobian) {
    if (!is_valid) scan_.invalid.push_back(number);
    else if (!(least_jacobian > k_solver_margin)) scan_.within_rounding.push_back(number);
  }
  void note(std::uint64_t number, bool is_valid, CellKind kind, std::span<const Vec3> p) { note(number, is_valid, least_computed_jacobian(kind, p)); }
  void add_prisms(std::uint64_t first_number, std::size_t column) {
    const auto& measures = columns_.measure(column);
    for (std::size_t j = 0; j < measures.size(); ++j) {
      const PrismMeasures& prism = measures[j];
      const auto points = [&] { return points_of<6>(mesh_.layers.cell(column, static_cast<int>(j)).nodes); };
      note(first_number + j, prism.is_surely_valid || is_wedge_valid(points()), prism.quality);
      scan_.layer_volume.add(prism.volume);
      if (!with_quality_) continue;
      scan_.quality.add_prism(prism.quality, prism.skew, points);
      scan_.scaled_jacobian.add(prism.quality, first_number + j);
    }
  }
  void add_prism(std::uint64_t number, const WedgePoints& p) {
    const double quality = wedge_quality(p);
    note(number, is_wedge_valid(p), quality);
    scan_.layer_volume.add(wedge_volume(p));
    if (!with_quality_) return;
    scan_.quality.add_prism(quality, skew_angle(p), [&] { return p; });
    scan_.scaled_jacobian.add(quality, number);
  }
  void add_pyramid(std::uint64_t number, const std::array<Vec3, 5>& p) {
    note(number, is_pyramid_valid(p), CellKind::pyramid, p);
    scan_.layer_volume.add(pyramid_volume(p));
  }

  void add_dihedrals(std::uint64_t number, const std::array<double, 2>& range) {
    scan_.min_dihedral.add(range[0], number);
    scan_.max_dihedral.add(range[1], number);
  }

  const HybridMesh& mesh_;
  bool with_quality_;
  ColumnScan columns_;
  CellScan scan_;
};

}  // namespace

CellScan joined(CellScan all, CellScan more) {
  all.invalid = concatenate(std::move(all.invalid), std::move(more.invalid));
  all.within_rounding = concatenate(std::move(all.within_rounding), std::move(more.within_rounding));
  all.layer_volume.add(more.layer_volume);
  all.tet_volume.add(more.tet_volume);
  all.quality.merge(more.quality);
  all.scaled_jacobian.merge(more.scaled_jacobian);
  all.min_dihedral.merge(more.min_dihedral);
  all.max_dihedral.merge(more.max_dihedral);
  return all;
}

CellScan::CellScan(const GateTable& limits)
    : scaled_jacobian(info_of(Measure::scaled_jacobian), limits[Measure::scaled_jacobian]),
      min_dihedral(info_of(Measure::min_dihedral), limits[Measure::min_dihedral]),
      max_dihedral(info_of(Measure::max_dihedral), limits[Measure::max_dihedral]) {}

void report_cells(const HybridMesh& mesh, const CellNumbers& cells, const CellScan& scan, Findings& findings) {
  const auto report = [&](Violation violation, std::uint64_t number, const auto& what) {
    findings.add(violation, [&] {
      const Point center = cells.center(number);
      return std::pair(center, cells.name(number) + near_patch(mesh, center) + what(cells.cell(number)));
    });
  };
  for (const std::uint64_t number : scan.invalid) report(Violation::invalid_cell, number, [](const Cell&) { return std::string(" is inverted or folded"); });
  for (const std::uint64_t number : scan.within_rounding)
    report(Violation::cell_within_rounding, number, [&](const Cell& cell) {
      std::array<Vec3, 8> p;
      for (std::size_t k = 0; k < cell.span().size(); ++k) p[k] = mesh.points[cell.nodes[k]];
      return " has a volume or Jacobian of " + number_text(least_computed_jacobian(cell.kind, std::span(p).first(cell.span().size())), 2) +
             " times the product of its edges in double precision; the limit is " + number_text(k_solver_margin, 2);
    });
}

std::vector<double> tet_volumes(const HybridMesh& mesh, const RunContext& context) {
  std::vector<double> volumes(mesh.tetrahedra.size());
  parallel_for(context, volumes.size(), [&](std::size_t i) {
    const auto& n = mesh.tetrahedra[i];
    volumes[i] = std::max(0.0, tet_volume(mesh.points[n[0]], mesh.points[n[1]], mesh.points[n[2]], mesh.points[n[3]]));
  });
  return volumes;
}

CellScan scan_column_chunk(const HybridMesh& mesh, bool with_quality, const GateTable& limits, std::size_t begin, std::size_t end) {
  const auto n_layers = static_cast<std::uint64_t>(mesh.layers.n_layers);
  CellScanner scanner(mesh, with_quality, limits);
  for (std::size_t c = begin; c < end; ++c) scanner.add_column(c * n_layers, c);
  return scanner.take();
}

CellScan scan_columns(const HybridMesh& mesh, bool with_quality, const GateTable& limits, const RunContext& context) {
  return parallel_reduce(
      context, mesh.layers.n_columns(), CellScan(limits),
      [&](std::size_t begin, std::size_t end) { return scan_column_chunk(mesh, with_quality, limits, begin, end); },
      [](CellScan all, CellScan more) { return joined(std::move(all), std::move(more)); }, k_column_chunk);
}

CellScan scan_explicit_cells(CellScan columns, const HybridMesh& mesh, const CellNumbers& cells, bool with_quality, const GateTable& limits,
                             const RunContext& context) {
  CellScan scan = std::move(columns);
  const auto add_block = [&](std::uint64_t first_number, const auto& block) {
    scan = parallel_reduce(
        context, block.size(), std::move(scan),
        [&](std::size_t begin, std::size_t end) {
          CellScanner scanner(mesh, with_quality, limits);
          for (std::size_t c = begin; c < end; ++c) scanner.add_explicit(first_number + c, block[c]);
          return scanner.take();
        },
        [](CellScan all, CellScan more) { return joined(std::move(all), std::move(more)); });
  };
  add_block(cells.first_prism(), mesh.prisms);
  add_block(cells.first_pyramid(), mesh.pyramids);
  add_block(cells.first_hexahedron(), mesh.hexahedra);
  add_block(cells.first_tetrahedron(), mesh.tetrahedra);
  return scan;
}

}  // namespace sterna::check_parts
