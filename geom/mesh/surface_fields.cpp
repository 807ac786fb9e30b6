#include "geom/mesh/surface_fields.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/layer_fields.h"
#include "geom/mesh/layer_room.h"

namespace sterna {
namespace {

constexpr GateLimits k_no_limits = {k_nan, k_nan, k_nan, k_nan};

enum : std::size_t { k_edge_length, k_min_angle, k_aspect, k_area_ratio, k_n_shape_fields };

const std::vector<SurfaceFieldInfo>& table() {
  const auto limits_of = [](Measure measure) {
    const MeasureInfo& info = info_of(measure);
    const GateLimits& l = info.limits;
    return GateLimits{in_report_unit(info, l.hard), in_report_unit(info, l.target), in_report_unit(info, l.usual), l.usual_share};
  };
  static const std::vector<SurfaceFieldInfo> fields = {
      {"edge_length", "mean edge", "m", true, false, k_no_limits, false},
      {"min_angle", "smallest angle", "deg", false, true, k_no_limits, false},
      {"aspect", "aspect ratio", "", true, false, k_no_limits, false},
      {"area_ratio", "area ratio to neighbours", "", true, false, k_no_limits, false},
      {"layer_height", "height of the layer", "m", true, false, k_no_limits, true},
      {"first_height", "first height", "m", true, false, k_no_limits, true},
      {"coverage", "height / target height", "", false, true, {k_nan, k_nan, k_full_height_share, info_of(Measure::coverage).limits.target}, true},
      {"layers", "number of layers", "", false, true, k_no_limits, true},
      {"growth", "growth ratio along growth lines", "", false, false, limits_of(Measure::stack_growth), true},
      {"skew", "skew angle of the worst prism", "deg", false, false, k_no_limits, true},
      {"stack_angle", "stack angle above best possible", "deg", false, false, limits_of(Measure::stack_angle), true},
      {"interface_jump", "last height / (0.816 edge) or its inverse", "", true, false, limits_of(Measure::interface_height), true},
      {"scaled_jacobian", "scaled Jacobian of the worst prism", "", false, true, limits_of(Measure::scaled_jacobian), true},
  };
  return fields;
}

/// List of faces with three or four corners, of any origin.
struct Faces {
  const std::vector<Point>& points;
  std::size_t n_triangles, n_quads;
  std::function<std::array<std::uint32_t, 4>(std::size_t)> nodes;  ///< the fourth is not used for triangles
  std::function<int(std::size_t)> group;                           ///< only faces of the same group are compared
  std::size_t size() const { return n_triangles + n_quads; }
  std::size_t n_corners(std::size_t face) const { return face < n_triangles ? 3 : 4; }
};

struct Shape {
  double edge, angle, aspect, area;
};

Shape shape_of(const std::array<Point, 4>& p, std::size_t n) {
  Shape shape{0.0, std::numbers::pi, 0.0, 0.0};
  std::array<double, 4> edges{};
  for (std::size_t k = 0; k < n; ++k) {
    const Point& next = p[(k + 1) % n];
    edges[k] = distance(p[k], next);
    shape.edge += edges[k] / static_cast<double>(n);
    shape.angle = std::min(shape.angle, corner_angle(p[k], next, p[(k + n - 1) % n]));
  }
  shape.angle *= 180.0 / std::numbers::pi;
  if (n == 3) {
    shape.area = triangle_area(p[0], p[1], p[2]);
    const double longest = *std::max_element(edges.begin(), edges.begin() + 3);
    shape.aspect = 0.25 * std::sqrt(3.0) * longest * longest / shape.area;
    return shape;
  }
  shape.area = 0.5 * norm(cross(p[2] - p[0], p[3] - p[1]));
  const double one = edges[0] + edges[2], other = edges[1] + edges[3];
  shape.aspect = std::max(one, other) / std::min(one, other);
  return shape;
}

/// Returns the largest area ratio across an edge; NaN for faces without a neighbour.
std::vector<double> area_ratios(const Faces& faces, const std::vector<double>& areas, const RunContext& context) {
  struct Edge {
    std::uint32_t lower, upper, face;
    auto operator<=>(const Edge&) const = default;
  };
  std::vector<Edge> edges(3 * faces.n_triangles + 4 * faces.n_quads);
  parallel_for(context, faces.size(), [&](std::size_t f) {
    const auto nodes = faces.nodes(f);
    const std::size_t n = faces.n_corners(f), first = f < faces.n_triangles ? 3 * f : 4 * f - faces.n_triangles;
    for (std::size_t k = 0; k < n; ++k)
      edges[first + k] = {std::min(nodes[k], nodes[(k + 1) % n]), std::max(nodes[k], nodes[(k + 1) % n]), static_cast<std::uint32_t>(f)};
  });
  parallel_sort(context, edges, std::less<>{});
  std::vector<double> ratios(faces.size(), k_nan);
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    for (end = i + 1; end < edges.size() && edges[end].lower == edges[i].lower && edges[end].upper == edges[i].upper;) ++end;
    for (std::size_t a = i; a < end; ++a)
      for (std::size_t b = a + 1; b < end; ++b) {
        const std::uint32_t f = edges[a].face, g = edges[b].face;
        if (faces.n_corners(f) != faces.n_corners(g) || faces.group(f) != faces.group(g)) continue;
        const double ratio = check_parts::deviation(areas[f] / areas[g]);
        for (const std::uint32_t face : {f, g}) ratios[face] = ratios[face] >= ratio ? ratios[face] : ratio;
      }
  }
  return ratios;
}

std::vector<SurfaceField> shape_fields(const Faces& faces, const RunContext& context) {
  std::vector<SurfaceField> fields;
  for (std::size_t i = 0; i < k_n_shape_fields; ++i) fields.push_back({table()[i], std::vector<double>(faces.size(), k_nan)});
  std::vector<double> areas(faces.size());
  parallel_for(context, faces.size(), [&](std::size_t f) {
    const auto nodes = faces.nodes(f);
    const std::size_t n = faces.n_corners(f);
    std::array<Point, 4> p;
    for (std::size_t k = 0; k < n; ++k) p[k] = faces.points[nodes[k]];
    const Shape shape = shape_of(p, n);
    fields[k_edge_length].values[f] = shape.edge;
    fields[k_min_angle].values[f] = shape.angle;
    fields[k_aspect].values[f] = shape.aspect;
    areas[f] = shape.area;
  });
  fields[k_area_ratio].values = area_ratios(faces, areas, context);
  return fields;
}

}  // namespace

std::span<const SurfaceFieldInfo> surface_field_table() { return table(); }

std::vector<SurfaceField> surface_fields(const HybridMesh& mesh, const RunContext& context) {
  using namespace check_parts;
  Findings findings(1);
  const CellNumbers cells(mesh);
  if (!check_indices(mesh, cells, context, findings))
    throw Error({.code = ErrorCode::mesh_invalid,
                 .attempted = "measuring the faces of a mesh",
                 .problem = "indices are out of range or points are not finite",
                 .hint = "`sterna check` lists the defects"});
  const std::size_t n_triangles = mesh.boundary_triangles.size();
  const Faces faces{mesh.points.raw(), n_triangles, mesh.boundary_quads.size(),
                    [&](std::size_t f) {
                      std::array<std::uint32_t, 4> nodes{};
                      if (f < n_triangles) {
                        for (std::size_t k = 0; k < 3; ++k) nodes[k] = mesh.boundary_triangles[f].nodes[k].value();
                      } else {
                        for (std::size_t k = 0; k < 4; ++k) nodes[k] = mesh.boundary_quads[f - n_triangles].nodes[k].value();
                      }
                      return nodes;
                    },
                    [&](std::size_t f) {
                      const PatchId patch = f < n_triangles ? mesh.boundary_triangles[f].patch : mesh.boundary_quads[f - n_triangles].patch;
                      return static_cast<int>(mesh.patches[patch].kind);
                    }};
  std::vector<SurfaceField> fields = shape_fields(faces, context);
  std::vector<std::vector<double>> layers = layer_fields(mesh, cells, context);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    layers[i].resize(faces.size(), k_nan);  // quads carry no layer
    fields.push_back({table()[k_n_shape_fields + i], std::move(layers[i])});
  }
  return fields;
}

std::vector<SurfaceField> surface_fields(const TriMesh& mesh, const RunContext& context) {
  const Faces faces{mesh.points.raw(), mesh.n_triangles(), 0,
                    [&](std::size_t f) {
                      const TriangleVertices& v = mesh.triangles.raw()[f];
                      return std::array<std::uint32_t, 4>{v[0].value(), v[1].value(), v[2].value(), 0};
                    },
                    [&](std::size_t f) { return static_cast<int>(mesh.patches[mesh.triangle_patch.raw()[f]].kind); }};
  return shape_fields(faces, context);
}

const SurfaceField* find_field(std::span<const SurfaceField> fields, std::string_view name) {
  const auto found = std::find_if(fields.begin(), fields.end(), [&](const SurfaceField& field) { return field.info.name == name; });
  return found == fields.end() ? nullptr : &*found;
}

}  // namespace sterna
