#include "geom/mesh/layer_fields.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/column_scan.h"

namespace sterna::check_parts {
namespace {

/// Columns and lines per chunk; each column holds some 30 cells.
constexpr std::size_t k_field_chunk = 256;

/// Figures of one line; NaN if not defined for the line.
struct LineFigures {
  double height = 0.0, first = k_nan, coverage = k_nan, growth = k_nan, angle = k_nan;
};

std::vector<LineFigures> measure_lines(const HybridMesh& mesh, const LayerLines& lines, const RunContext& context) {
  const Fans fans(lines);
  const FacetsOfExplicitPrisms beside(mesh, lines);
  const MirrorNormals mirror_normals(mesh);
  const bool has_target = lines.are_columns() && is_request_usable(mesh);
  std::vector<LineFigures> all(lines.n_lines());
  parallel_chunks(context, lines.n_lines(), k_field_chunk, [&](std::size_t begin, std::size_t end) {
    std::vector<double> heights;
    std::vector<Vec3> normals;
    for (std::size_t k = begin; k < end; ++k) {
      const auto line = static_cast<std::uint32_t>(k);
      const auto point = [&](int j) { return mesh.points[lines.node(line, j)]; };
      LineFigures& figures = all[k];
      const int n = lines.n_layers(line);
      double normal_height = 0.0;  // m, layer height along the wall normal
      heights.clear();
      for (int j = 0; j < n; ++j) heights.push_back(distance(point(j), point(j + 1)));
      if (n > 0) {
        figures.height = distance(point(0), point(n));
        figures.first = heights.front();
        figures.growth = n > 1 ? worst_growth(heights) : k_nan;
        normals.clear();
        Vec3 wall_normal{};
        for (const std::uint32_t t : fans.around(line)) {
          const auto& corner = lines.triangles()[t];
          const auto base_point = [&](std::size_t i) { return mesh.points[lines.node(corner[i], 0)]; };
          normals.push_back(normalized(area_vector(base_point(0), base_point(1), base_point(2))));
          const std::size_t c = corner[0] == line ? 0 : corner[1] == line ? 1 : 2;
          wall_normal += corner_angle(base_point(c), base_point((c + 1) % 3), base_point((c + 2) % 3)) * normals.back();
        }
        if (!normals.empty())
          for (const FacetsOfExplicitPrisms::Facet& facet : beside.around(line)) {
            normals.push_back(facet.normal);
            wall_normal += facet.angle * facet.normal;
          }
        if (!normals.empty()) normal_height = dot(point(n) - point(0), mirror_normals.mirrored(lines.node(line, 0), wall_normal));
        if (!normals.empty()) figures.angle = k_degrees * stack_angle(mesh, lines, line, normals);
      }
      if (has_target && mesh.request.target_height[k] > 0.0) figures.coverage = std::clamp(normal_height / mesh.request.target_height[k], 0.0, 1.0);
    }
  });
  return all;
}

/// A column without collapsed lines, and the layers in which it has prisms.
struct Column {
  std::array<std::uint32_t, 3> lines;
  int n_prisms;
};

WedgePoints wedge_of(const HybridMesh& mesh, const LayerLines& lines, const Column& column, int layer) {
  WedgePoints p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = mesh.points[lines.node(column.lines[k], layer)];
    p[k + 3] = mesh.points[lines.node(column.lines[k], layer + 1)];
  }
  return p;
}

/// Skew and scaled Jacobian of the worst prism, and the size jump to the tetrahedra.
struct ColumnFigures {
  double skew = k_nan, jacobian = k_nan, jump = k_nan;
};

/// Index of boundary triangles by their nodes.
class TriangleIndex {
 public:
  TriangleIndex(const HybridMesh& mesh, const RunContext& context) : entries_(mesh.boundary_triangles.size()) {
    parallel_for(context, entries_.size(), [&](std::size_t i) {
      const auto& n = mesh.boundary_triangles[i].nodes;
      entries_[i] = {sorted({n[0].value(), n[1].value(), n[2].value()}), static_cast<std::uint32_t>(i)};
    });
    parallel_sort(context, entries_, std::less<>{});
  }
  std::optional<std::uint32_t> find(const std::array<std::uint32_t, 3>& nodes) const {
    const auto key = sorted(nodes);
    const auto found = std::lower_bound(entries_.begin(), entries_.end(), key, [](const Entry& entry, const auto& searched) { return entry.key < searched; });
    return found != entries_.end() && found->key == key ? std::optional(found->triangle) : std::nullopt;
  }

 private:
  struct Entry {
    std::array<std::uint32_t, 3> key;
    std::uint32_t triangle;
    auto operator<=>(const Entry&) const = default;
  };
  static std::array<std::uint32_t, 3> sorted(std::array<std::uint32_t, 3> nodes) {
    std::sort(nodes.begin(), nodes.end());
    return nodes;
  }
  std::vector<Entry> entries_;
};

class ColumnMeasurer {
 public:
  ColumnMeasurer(const HybridMesh& mesh, const LayerLines& lines) : mesh_(mesh), lines_(lines), scan_(mesh) {}

  /// \pre the three lines of the triangle have layers
  ColumnFigures measure(std::size_t triangle) {
    const auto& lines = lines_.triangles()[triangle];
    const Column column{lines, std::min({lines_.n_layers(lines[0]), lines_.n_layers(lines[1]), lines_.n_layers(lines[2])})};
    ColumnFigures figures{0.0, 1.0, k_nan};
    if (lines_.are_columns() && mesh_.layers.is_prismatic(triangle)) {
      for (const PrismMeasures& prism : scan_.measure(triangle)) lower(figures, prism.quality, prism.skew);
    } else {
      for (int j = 0; j < column.n_prisms; ++j) {
        const WedgePoints wedge = wedge_of(mesh_, lines_, column, j);
        lower(figures, wedge_quality(wedge), skew_angle(wedge));
      }
    }
    const auto last = [&](std::size_t k, int below) { return mesh_.points[lines_.node(lines[k], lines_.n_layers(lines[k]) - below)]; };
    double height = 0.0, edge = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      height += distance(last(k, 1), last(k, 0)) / 3.0;
      edge += distance(last(k, 0), last((k + 1) % 3, 0)) / 3.0;
    }
    figures.jump = interface_jump(height, edge);
    return figures;
  }

 private:
  static void lower(ColumnFigures& figures, double quality, double skew) {
    figures.jacobian = std::min(figures.jacobian, quality);
    figures.skew = std::max(figures.skew, k_degrees * skew);
  }

  const HybridMesh& mesh_;
  const LayerLines& lines_;
  ColumnScan scan_;
};

/// Returns the mean of the values that are not NaN; NaN if there are none.
double mean_of(const std::array<double, 3>& values) {
  double sum = 0.0;
  int n = 0;
  for (const double value : values)
    if (value == value) {
      sum += value;
      ++n;
    }
  return n > 0 ? sum / n : k_nan;
}

double largest_of(const std::array<double, 3>& values) {
  double largest = k_nan;
  for (const double value : values)
    if (value == value && !(largest >= value)) largest = value;
  return largest;
}

/// Returns the boundary triangle under each column, if any. In a damaged mesh two columns may stand on the same triangle: it is assigned to the first.
std::vector<std::optional<std::size_t>> base_triangles_of_columns(const HybridMesh& mesh, const LayerLines& lines, const RunContext& context) {
  const TriangleIndex index(mesh, context);
  std::vector<std::optional<std::size_t>> base_triangles(lines.triangles().size());
  parallel_for(context, base_triangles.size(), [&](std::size_t t) {
    const auto& corner = lines.triangles()[t];
    base_triangles[t] = index.find({lines.node(corner[0], 0).value(), lines.node(corner[1], 0).value(), lines.node(corner[2], 0).value()});
  });
  std::vector<std::uint8_t> is_taken(mesh.boundary_triangles.size(), 0);
  for (auto& base_triangle : base_triangles)
    if (base_triangle && std::exchange(is_taken[*base_triangle], 1) != 0) base_triangle.reset();
  return base_triangles;
}

std::vector<std::vector<double>> measure_columns(const HybridMesh& mesh, const LayerLines& lines, const RunContext& context) {
  std::vector<std::vector<double>> fields(k_n_layer_fields, std::vector<double>(mesh.boundary_triangles.size(), k_nan));
  const std::vector<LineFigures> figures = measure_lines(mesh, lines, context);
  const std::vector<std::optional<std::size_t>> base_triangles = base_triangles_of_columns(mesh, lines, context);
  parallel_chunks(context, lines.triangles().size(), k_field_chunk, [&](std::size_t begin, std::size_t end) {
    ColumnMeasurer measurer(mesh, lines);
    for (std::size_t t = begin; t < end; ++t) {
      const auto& corner = lines.triangles()[t];
      if (!base_triangles[t]) continue;
      const auto of_lines = [&](double LineFigures::*member) {
        return std::array{figures[corner[0]].*member, figures[corner[1]].*member, figures[corner[2]].*member};
      };
      const std::array<int, 3> n = {lines.n_layers(corner[0]), lines.n_layers(corner[1]), lines.n_layers(corner[2])};
      const auto put = [&](LayerField field, double value) { fields[field][*base_triangles[t]] = value; };
      put(k_layer_height, mean_of(of_lines(&LineFigures::height)));
      put(k_first_height, mean_of(of_lines(&LineFigures::first)));
      put(k_coverage, mean_of(of_lines(&LineFigures::coverage)));
      put(k_layers, *std::max_element(n.begin(), n.end()));
      put(k_growth, largest_of(of_lines(&LineFigures::growth)));
      put(k_stack_angle, largest_of(of_lines(&LineFigures::angle)));
      if (n[0] == 0 || n[1] == 0 || n[2] == 0) continue;
      const ColumnFigures column = measurer.measure(t);
      put(k_skew, column.skew);
      put(k_interface_jump, column.jump);
      put(k_worst_jacobian, column.jacobian);
    }
  });
  return fields;
}

}  // namespace

std::vector<std::vector<double>> layer_fields(const HybridMesh& mesh, const CellNumbers& cells, const RunContext& context) {
  if (mesh.layers.n_columns() == 0 && mesh.prisms.empty()) return std::vector(k_n_layer_fields, std::vector<double>(mesh.boundary_triangles.size(), k_nan));
  const FaceSlots slots(mesh, cells, {});
  // Columns store their lines; stacks of explicit prisms are found from the faces that prisms share.
  const FaceMatch match = mesh.layers.n_columns() > 0 ? FaceMatch{}
                                                      : match_faces(slots, mesh.points.size(), static_cast<std::uint64_t>(CheckOptions{}.faces_at_a_time), {},
                                                                    false, GateTable{}, context);
  const LayerLines lines(mesh, slots, match, context);
  return measure_columns(mesh, lines, context);
}

}  // namespace sterna::check_parts
