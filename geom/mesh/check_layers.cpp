// Gates of layers, line by line: growth (G8), lean at the wall (G10), first height (G11), coverage (G12) and steps (G13).
#include <algorithm>
#include <cmath>
#include <map>

#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/math/spherical_cap.h"
#include "geom/mesh/gate_items.h"
#include "geom/mesh/layer_room.h"
#include "geom/mesh/line_measures.h"

namespace sterna::check_parts {
namespace {

/// Relative slack of the requested growth ratio: lines are curved, so the lengths of their chords do not grow exactly by the ratio of the heights.
constexpr double k_growth_slack = 0.01;
/// Relative slack of the number of layers times the first height, the height below which a layer is compressed: covers rounding at the end of the line.
constexpr double k_height_slack = 1e-9;
constexpr std::size_t k_gate_line_chunk = 1024;
constexpr const char* k_no_boundary_layer = "no boundary layer was requested (total_height, boundary_layer, or first_height from flow conditions)";
constexpr const char* k_no_request = "the mesh does not store the requested layer";

/// Data of a line for the coverage.
struct LineHeight {
  double height = 0.0;         ///< m, layer height along the wall normal
  Vec3 normal;                 ///< unit, wall normal at the base vertex
  double visibility = 0.0;     ///< cosine, as in RoomRequest; only for lines below their full height
  bool is_full = false;        ///< at least k_full_height_share of the target height
  bool is_compressed = false;  ///< too low for the requested first height
};

struct LayerScan {
  explicit LayerScan(const GateTable& limits)
      : growth(info_of(Measure::stack_growth), limits[Measure::stack_growth]),
        angle(info_of(Measure::stack_angle), limits[Measure::stack_angle]),
        first_height(info_of(Measure::first_height), limits[Measure::first_height]),
        step(info_of(Measure::layer_step), limits[Measure::layer_step]) {}
  void merge(const LayerScan& other) {
    growth.merge(other.growth);
    angle.merge(other.angle);
    first_height.merge(other.first_height);
    step.merge(other.step);
  }
  GateScan growth, angle, first_height, step;  ///< ids are lines
};

/// Items whose ids are lines. The nodes of an item are the base vertices; its cells are those beside the wall if lines are columns.
struct LineItems {
  const HybridMesh& mesh;
  const LayerLines& lines;
  const Fans& fans;

  std::pair<Point, std::string> operator()(std::uint64_t id) const {
    const auto k = static_cast<std::uint32_t>(id);
    const NodeId base_node = lines.node(k, 0);
    std::string what = (lines.are_columns() ? "line " + std::to_string(k) : "node " + std::to_string(base_node.value()) + " of the wall");
    if (!fans.around(k).empty() && lines.patch(fans.around(k).front()).is_valid()) what += ", patch " + patch_name(mesh, lines.patch(fans.around(k).front()));
    return {mesh.points[base_node], what};
  }
  void gather(std::uint64_t id, GateExtent& extent) const {
    const auto k = static_cast<std::uint32_t>(id);
    extent.nodes.push_back(lines.node(k, 0).value());
    if (!lines.are_columns()) return;
    for (const std::uint32_t column : fans.around(k))
      if (mesh.layers.layers_of_column(column) > 0) extent.cells.push_back(std::uint64_t{column} * static_cast<std::uint64_t>(mesh.layers.n_layers));
  }
};

class LineScanner {
 public:
  /// `line_heights` has one entry per line, which is set if the mesh's request is usable.
  LineScanner(const HybridMesh& mesh, const LayerLines& lines, const Fans& fans, const FacetsOfExplicitPrisms& beside, const MirrorNormals& mirror_normals,
              const GateTable& limits, bool is_request_usable, std::vector<LineHeight>& line_heights)
      : mesh_(mesh),
        lines_(lines),
        fans_(fans),
        beside_(beside),
        mirror_normals_(mirror_normals),
        line_heights_(line_heights),
        is_request_usable_(is_request_usable),
        scan_(limits) {}

  LayerScan take() { return std::move(scan_); }

  void add(std::uint32_t line) {
    const int n = lines_.n_layers(line);
    if (fans_.around(line).empty()) return;  // the cells of the line are not in columns
    read_fan(line, n);
    if (lines_.are_columns() && is_request_usable_) read_height(line, n);
    if (n == 0) return;
    read_heights(line, n);
    if (n > 1) scan_.growth.add(worst_growth(heights_) * growth_scale(line), line, area_);
    scan_.angle.add(stack_angle(mesh_, lines_, line, normals_), line, area_);
    if (lines_.are_columns() && is_request_usable_) add_first_height(line);
  }

 private:
  const Point& point(std::uint32_t line, int j) const { return mesh_.points[lines_.node(line, j)]; }

  /// Reads normals, area and vertex normal of the wall around the line's base vertex, and the steps to its neighbours.
  void read_fan(std::uint32_t line, int n) {
    normals_.clear();
    area_ = 0.0;
    vertex_normal_ = {};
    const Point& base_point = point(line, 0);
    double n_level = 0.0;
    for (const std::uint32_t t : fans_.around(line)) {
      const auto& lines = lines_.triangles()[t];
      const std::size_t corner = lines[0] == line ? 0 : lines[1] == line ? 1 : 2;
      const std::uint32_t next = lines[(corner + 1) % 3];
      const Point &a = point(next, 0), &b = point(lines[(corner + 2) % 3], 0);
      const Vec3 normal = area_vector(base_point, a, b);
      area_ += norm(normal) / 3.0;
      normals_.push_back(normalized(normal));
      vertex_normal_ += corner_angle(base_point, a, b) * normals_.back();
      // Each inner edge is the next edge of two lines and is evaluated at the lower one. An edge of the open boundary is evaluated at its only triangle.
      const int step = std::abs(n - lines_.n_layers(next));
      if (step == 0) {
        n_level += is_shared(line, next) ? 0.5 : 1.0;
      } else if (line < next || !is_shared(line, next)) {
        scan_.step.add(step, line);
      }
    }
    for (const FacetsOfExplicitPrisms::Facet& facet : beside_.around(line)) {
      normals_.push_back(facet.normal);
      vertex_normal_ += facet.angle * facet.normal;
    }
    vertex_normal_ = mirror_normals_.mirrored(lines_.node(line, 0), vertex_normal_);
    if (n_level > 0.0) scan_.step.add(0.0, line, n_level);
  }

  /// Returns true if a triangle runs next -> line.
  bool is_shared(std::uint32_t line, std::uint32_t next) const {
    const auto around = fans_.around(line);
    return std::any_of(around.begin(), around.end(), [&](std::uint32_t t) {
      const auto& lines = lines_.triangles()[t];
      const std::size_t corner = lines[0] == line ? 0 : lines[1] == line ? 1 : 2;
      return lines[(corner + 2) % 3] == next;
    });
  }

  void read_heights(std::uint32_t line, int n) {
    heights_.resize(static_cast<std::size_t>(n));
    for (int j = 0; j < n; ++j) heights_[static_cast<std::size_t>(j)] = distance(point(line, j), point(line, j + 1));
  }

  /// Returns the factor on the growth ratios of a line. If lines have different requested growth ratios, the limit is the largest of them. A line with a
  /// smaller requested ratio is measured as if its ratios were larger by the same factor.
  double growth_scale(std::uint32_t line) const {
    const LayerRequest& request = mesh_.request;
    if (!lines_.are_columns() || line >= request.line_max_growth.size()) return 1.0;
    return request.max_growth / request.line_max_growth[line];
  }

  void read_height(std::uint32_t line, int n) {
    LineHeight& own = line_heights_[line];
    own.normal = vertex_normal_;
    own.height = dot(point(line, n) - point(line, 0), vertex_normal_);
    // The requested first height cannot be met.
    own.is_compressed = n > 0 && own.height < mesh_.request.first_room_of(line, n) * (1.0 - k_height_slack);
    own.is_full = n > 0 && own.height >= k_full_height_share * mesh_.request.target_height[line] * (1.0 - k_height_slack);
    if (own.is_full || normals_.empty()) return;
    std::vector<Vec3> normals = normals_;
    mirror_normals_.add_images(lines_.node(line, 0), normals);
    own.visibility = std::cos(smallest_spherical_cap(normals).angle);
  }

  void add_first_height(std::uint32_t line) {
    if (line_heights_[line].is_compressed) return;
    const double requested = mesh_.request.first_height_of(line);
    const double excess = dot(point(line, 1) - point(line, 0), vertex_normal_) / requested - 1.0;
    scan_.first_height.add(std::abs(excess), line | (excess < 0.0 ? GateScan::k_too_small : 0));
  }

  const HybridMesh& mesh_;
  const LayerLines& lines_;
  const Fans& fans_;
  const FacetsOfExplicitPrisms& beside_;
  const MirrorNormals& mirror_normals_;
  std::vector<LineHeight>& line_heights_;
  bool is_request_usable_;
  LayerScan scan_;
  std::vector<Vec3> normals_;
  std::vector<double> heights_;
  Vec3 vertex_normal_;
  double area_ = 0.0;
};

/// Returns the mean edge of the envelope above each wall triangle, m.
std::vector<double> envelope_edges(const HybridMesh& mesh, const LayerLines& lines, const RunContext& context) {
  std::vector<double> edges(lines.triangles().size());
  parallel_for(context, edges.size(), [&](std::size_t t) {
    const auto top = [&](std::size_t k) { return mesh.points[lines.node(lines.triangles()[t][k], lines.n_layers(lines.triangles()[t][k]))]; };
    edges[t] = (distance(top(0), top(1)) + distance(top(1), top(2)) + distance(top(2), top(0))) / 3.0;
  });
  return edges;
}

/// Returns the walls under layers, with their requested heights, and all other boundary faces.
std::vector<FacingTriangle> facing_triangles(const HybridMesh& mesh, const LayerLines& lines, const std::vector<double>& edges) {
  std::vector<FacingTriangle> facing;
  std::vector<std::uint8_t> has_layers(mesh.patches.size(), 0);
  for (std::size_t t = 0; t < lines.triangles().size(); ++t) {
    const auto& base_lines = lines.triangles()[t];
    FacingTriangle triangle{.base_lines = base_lines, .edge = edges[t]};
    for (std::size_t k = 0; k < 3; ++k) {
      triangle.corners[k] = mesh.points[lines.node(base_lines[k], 0)];
      triangle.requested = std::max(triangle.requested, mesh.request.target_height[base_lines[k]]);
    }
    facing.push_back(triangle);
    if (lines.patch(t).index() < has_layers.size()) has_layers[lines.patch(t).index()] = 1;
  }
  const auto add = [&](PatchId patch, NodeId a, NodeId b, NodeId c) {
    if (patch.index() < has_layers.size() && has_layers[patch.index()] != 0) return;
    constexpr std::uint32_t k_none = FacingTriangle::k_no_line;
    facing.push_back({.corners = {mesh.points[a], mesh.points[b], mesh.points[c]}, .base_lines = {k_none, k_none, k_none}});
  };
  for (const BoundaryTriangle& t : mesh.boundary_triangles) add(t.patch, t.nodes[0], t.nodes[1], t.nodes[2]);
  for (const BoundaryQuad& q : mesh.boundary_quads) {
    add(q.patch, q.nodes[0], q.nodes[1], q.nodes[2]);
    add(q.patch, q.nodes[0], q.nodes[2], q.nodes[3]);
  }
  return facing;
}

/// Permitted heights of each line, m. Gaps are evaluated only if a line is below its full height.
struct PermittedHeights {
  std::vector<double> heights;  ///< permitted by the geometry; the target if the line has its full height
  std::vector<double> gaps;     ///< permitted by gaps; infinite if no gap limits the line
};

PermittedHeights permitted_heights(const HybridMesh& mesh, const LayerLines& lines, const Fans& fans, const std::vector<LineHeight>& heights,
                                   const RunContext& context) {
  PermittedHeights permitted{mesh.request.target_height, std::vector<double>(heights.size(), k_infinity)};
  if (std::all_of(heights.begin(), heights.end(), [](const LineHeight& line) { return line.is_full; })) return permitted;
  const std::vector<double> edges = envelope_edges(mesh, lines, context);
  const LayerRoom room(facing_triangles(mesh, lines, edges), context);
  parallel_for(context, heights.size(), [&](std::size_t k) {
    const auto line = static_cast<std::uint32_t>(k);
    const auto around = fans.around(line);
    if (heights[k].is_full || around.empty()) return;
    double edge = 0.0;
    for (const std::uint32_t t : around) edge += edges[t] / static_cast<double>(around.size());
    const RoomRequest request{line, mesh.points[lines.node(line, 0)], heights[k].normal, mesh.request.target_height[k], edge, heights[k].visibility};
    permitted.gaps[k] = room.in_gap(request);
    permitted.heights[k] = LayerRoom::permitted(request, permitted.gaps[k]);
  });
  return permitted;
}

/// Areas of one patch by state of the layer.
struct PatchAreas {
  double full = 0.0, reduced = 0.0, compressed = 0.0, collapsed = 0.0, attainable = 0.0, attained = 0.0;
  double requested = 0.0, covered = 0.0;  ///< m^2; `requested`: area with a requested boundary layer; `covered`: area where the line covers the thickness of
                                          ///< that layer, or as much of it as the geometry permits
  std::map<std::string, double> lost;
  double total() const { return full + reduced + compressed + collapsed; }
  void add(const PatchAreas& more) {
    full += more.full;
    reduced += more.reduced;
    compressed += more.compressed;
    collapsed += more.collapsed;
    attainable += more.attainable;
    attained += more.attained;
    requested += more.requested;
    covered += more.covered;
    for (const auto& [reason, area] : more.lost) lost[reason] += area;
  }
};

/// Returns true if a line has 0.9 of the requested boundary-layer thickness, or of what a gap or a corner permits.
bool covers_boundary_layer(double height, double thickness, double target, double permitted, double in_gap) {
  const bool is_limited = permitted < k_full_height_share * target;
  const double possible = std::min({thickness, in_gap, is_limited ? permitted : k_infinity});
  return height >= k_full_height_share * possible * (1.0 - k_height_slack);
}

/// Each corner of a wall triangle represents a third of its area.
std::map<std::uint32_t, PatchAreas> measure_coverage(const HybridMesh& mesh, const LayerLines& lines, const std::vector<LineHeight>& heights,
                                                     const PermittedHeights& possible, const RunContext& context) {
  const std::vector<double>& permitted = possible.heights;
  const LayerRequest& request = mesh.request;
  using Areas = std::map<std::uint32_t, PatchAreas>;
  return parallel_reduce(
      context, lines.triangles().size(), Areas{},
      [&](std::size_t begin, std::size_t end) {
        Areas areas;
        for (std::size_t t = begin; t < end; ++t) {
          const auto& corner = lines.triangles()[t];
          const auto base_point = [&](std::size_t k) { return mesh.points[lines.node(corner[k], 0)]; };
          const double third = triangle_area(base_point(0), base_point(1), base_point(2)) / 3.0;
          PatchAreas& patch = areas[lines.patch(t).value()];
          for (const std::uint32_t line : corner) {
            const LineHeight& own = heights[line];
            (lines.n_layers(line) == 0 ? patch.collapsed : own.is_full ? patch.full : own.is_compressed ? patch.compressed : patch.reduced) += third;
            if (permitted[line] >= k_full_height_share * request.target_height[line]) patch.attainable += third;
            if (own.is_full || own.height >= k_full_height_share * permitted[line]) patch.attained += third;
            if (!request.line_boundary_layer.empty() && request.line_boundary_layer[line] > 0.0) {
              patch.requested += third;
              if (covers_boundary_layer(own.height, request.line_boundary_layer[line], request.target_height[line], permitted[line], possible.gaps[line]))
                patch.covered += third;
            }
            if (!own.is_full) patch.lost[request.reasons[request.reason[line]]] += third;
          }
        }
        return areas;
      },
      [](Areas all, const Areas& more) {
        for (const auto& [patch, areas] : more) all[patch].add(areas);
        return all;
      });
}

PatchCoverage share_out(const HybridMesh& mesh, std::uint32_t patch, const PatchAreas& areas) {
  PatchCoverage result;
  result.patch = patch < mesh.patches.size() ? mesh.patches[PatchId(patch)].name : "(no boundary face)";
  result.area = areas.total();
  const double scale = result.area > 0.0 ? 1.0 / result.area : 0.0;
  result.full = scale * areas.full;
  result.reduced = scale * areas.reduced;
  result.compressed = scale * areas.compressed;
  result.collapsed = scale * areas.collapsed;
  result.attainable = scale * areas.attainable;
  result.attained = scale * areas.attained;
  for (const auto& [reason, area] : areas.lost) result.lost.emplace_back(reason, scale * area);
  std::stable_sort(result.lost.begin(), result.lost.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return result;
}

void judge_coverage(const HybridMesh& mesh, const LayerLines& lines, const std::vector<LineHeight>& heights, const PermittedHeights& permitted,
                    const GateTable& limits, const RunContext& context, CheckReport& report) {
  double attained = 0.0, collapsed = 0.0, total = 0.0, requested = 0.0, covered = 0.0;
  for (const auto& [patch, areas] : measure_coverage(mesh, lines, heights, permitted, context)) {
    report.coverage.push_back(share_out(mesh, patch, areas));
    attained += areas.attained;
    requested += areas.requested;
    covered += areas.covered;
    collapsed += areas.collapsed;
    total += areas.total();
  }
  const auto put = [&](Measure measure, double part, double whole) {
    GateScan scan(info_of(measure), limits[measure]);
    if (whole > 0.0) scan.add(part / whole, 0, whole);
    GateResult result = scan.result([](std::uint64_t) { return std::pair(Point{}, std::string()); });
    result.locations.clear();  // the measure applies to the whole wall; the locations are in the patch table and gate G13
    result.n_too_small = result.n_too_large = 0;
    result.share_beyond = 0.0;
    report.gates[static_cast<std::size_t>(measure)] = std::move(result);
  };
  put(Measure::boundary_layer, covered, requested);
  if (requested == 0.0) report.gates[static_cast<std::size_t>(Measure::boundary_layer)].reason = k_no_boundary_layer;
  put(Measure::coverage, attained, total);
  put(Measure::collapsed, collapsed, total);
}

/// The requested growth ratio replaces the default limit of most lines, up to the hard limit. The hard limit stays, because a wing whose layers grew by the
/// requested ratio of 2 had 10 % more drag.
GateTable with_requested_growth(GateTable limits, const HybridMesh& mesh) {
  GateLimits& growth = limits[Measure::stack_growth];
  if (mesh.request.is_known() && growth.usual == info_of(Measure::stack_growth).limits.usual) {
    growth.usual = mesh.request.max_growth * (1.0 + k_growth_slack);
    if (growth.hard < growth.usual) growth.usual = growth.hard;  // not if there is no hard limit
  }
  return limits;
}

}  // namespace

std::vector<double> judge_layers(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const GateTable& user_limits,
                                 const RunContext& context, CheckReport& report) {
  const GateTable limits = with_requested_growth(user_limits, mesh);
  const auto put = [&](GateResult result) { report.gates[static_cast<std::size_t>(result.measure)] = std::move(result); };
  const LayerLines lines(mesh, slots, match, context);
  if (!lines.reason().empty()) {
    for (const Measure measure : {Measure::stack_growth, Measure::stack_angle, Measure::first_height, Measure::boundary_layer, Measure::coverage,
                                  Measure::collapsed, Measure::layer_step})
      put(not_checked(measure, limits, lines.reason()));
    return {};
  }
  const Fans fans(lines);
  const FacetsOfExplicitPrisms beside(mesh, lines);
  const MirrorNormals mirror_normals(mesh);
  const bool is_usable = lines.are_columns() && is_request_usable(mesh);
  std::vector<LineHeight> heights(lines.n_lines());
  const LayerScan scan = parallel_reduce(
      context, lines.n_lines(), LayerScan(limits),
      [&](std::size_t begin, std::size_t end) {
        LineScanner scanner(mesh, lines, fans, beside, mirror_normals, limits, is_usable, heights);
        for (std::size_t k = begin; k < end; ++k) scanner.add(static_cast<std::uint32_t>(k));
        return scanner.take();
      },
      [](LayerScan all, const LayerScan& more) {
        all.merge(more);
        return all;
      },
      k_gate_line_chunk);
  const LineItems line{mesh, lines, fans};
  put(scan.growth.result(line));
  put(scan.angle.result(line));
  put(scan.step.result(line));
  if (!is_usable) {
    for (const Measure measure : {Measure::first_height, Measure::boundary_layer, Measure::coverage, Measure::collapsed})
      put(not_checked(measure, limits, k_no_request));
    return {};
  }
  put(scan.first_height.result(line));
  PermittedHeights permitted = permitted_heights(mesh, lines, fans, heights, context);
  judge_coverage(mesh, lines, heights, permitted, limits, context, report);
  return std::move(permitted.gaps);
}

}  // namespace sterna::check_parts
