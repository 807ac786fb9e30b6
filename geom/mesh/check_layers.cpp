// Gates of layers, line by line: growth (G8), lean at the wall (G10), first height (G11), coverage (G12) and steps (G13).
#include <algorithm>
#include <cmath>
#include <map>

#include "geom/math/measures.h"
#include "geom/mesh/line_measures.h"

namespace sterna::check_parts {
namespace {

/// Relative slack of the requested growth ratio: lines are curved, so the lengths of their chords do not grow by quite the ratio of the heights.
constexpr double k_growth_slack = 0.01;
/// Relative slack of n h0, the height below which a layer is compressed: rounding of the line's end.
constexpr double k_height_slack = 1e-9;
constexpr std::size_t k_gate_line_chunk = 1024;
constexpr const char* k_no_request = "the mesh does not say what was asked for";

/// Unit normals of the symmetry patches at the feet of lines that stand on them: the body goes on behind with its mirror image, so normals there are means with
/// theirs.
class MirrorFeet {
 public:
  explicit MirrorFeet(const HybridMesh& mesh) {
    for (const BoundaryQuad& quad : mesh.boundary_quads) {
      if (quad.patch.index() >= mesh.patches.size() || mesh.patches[quad.patch].kind != PatchKind::symmetry) continue;
      const auto& p = mesh.points;
      const Vec3 normal = normalized(cross(p[quad.nodes[2]] - p[quad.nodes[0]], p[quad.nodes[3]] - p[quad.nodes[1]]));
      for (const NodeId node : quad.nodes) feet_.push_back({node, quad.patch, normal});
    }
    std::sort(feet_.begin(), feet_.end(), [](const Foot& a, const Foot& b) { return std::pair(a.node, a.patch) < std::pair(b.node, b.patch); });
    feet_.erase(std::unique(feet_.begin(), feet_.end(), [](const Foot& a, const Foot& b) { return a.node == b.node && a.patch == b.patch; }), feet_.end());
  }
  /// The part of a normal at a node that lies in the planes that the node is on.
  Vec3 mirrored(NodeId node, Vec3 normal) const {
    for (auto foot = std::lower_bound(feet_.begin(), feet_.end(), node, [](const Foot&a, NodeId b) { return a.node < b; });
         foot != feet_.end() && foot->node == node; ++foot)
      normal = normal - dot(normal, foot->normal) * foot->normal;
    return normalized(normal);
  }

 private:
  struct Foot {
    NodeId node;
    PatchId patch;
    Vec3 normal;
  };
  std::vector<Foot> feet_;
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

class LineScanner {
 public:
  /// `is_compressed` has one entry per line, which is set where the mesh's request can be used.
  LineScanner(const HybridMesh& mesh, const LayerLines& lines, const Fans& fans, const MirrorFeet& feet, const GateTable& limits, bool is_request_usable,
              std::vector<std::uint8_t>& is_compressed)
      : mesh_(mesh), lines_(lines), fans_(fans), feet_(feet), is_compressed_(is_compressed), is_request_usable_(is_request_usable), scan_(limits) {}

  LayerScan take() { return std::move(scan_); }

  void add(std::uint32_t line) {
    const int n = lines_.n_layers(line);
    read_fan(line, n);
    if (n == 0) return;
    read_heights(line, n);
    if (n > 1) scan_.growth.add(worst_growth(heights_) * growth_scale(line), line, area_);
    scan_.angle.add(stack_angle(mesh_, lines_, line, normals_), line, area_);
    if (lines_.are_columns() && is_request_usable_) add_first_height(line, n);
  }

 private:
  const Point& point(std::uint32_t line, int j) const { return mesh_.points[lines_.node(line, j)]; }

  /// Normals, area and vertex normal of the wall around the line's foot; steps to its neighbours.
  void read_fan(std::uint32_t line, int n) {
    normals_.clear();
    area_ = 0.0;
    vertex_normal_ = {};
    const Point& foot = point(line, 0);
    double n_level = 0.0;
    for (const std::uint32_t t : fans_.around(line)) {
      const auto& lines = lines_.triangles()[t];
      const std::size_t corner = lines[0] == line ? 0 : lines[1] == line ? 1 : 2;
      const std::uint32_t next = lines[(corner + 1) % 3];
      const Point &a = point(next, 0), &b = point(lines[(corner + 2) % 3], 0);
      const Vec3 normal = area_vector(foot, a, b);
      area_ += norm(normal) / 3.0;
      normals_.push_back(normalized(normal));
      vertex_normal_ += corner_angle(foot, a, b) * normals_.back();
      // Each inner edge is the next one of two lines and is looked at from the lower; one at the rim only from its only triangle.
      const int step = std::abs(n - lines_.n_layers(next));
      if (step == 0) {
        n_level += is_shared(line, next) ? 0.5 : 1.0;
      } else if (line < next || !is_shared(line, next)) {
        scan_.step.add(step, line);
      }
    }
    vertex_normal_ = feet_.mirrored(lines_.node(line, 0), vertex_normal_);
    if (n_level > 0.0) scan_.step.add(0.0, line, n_level);
  }

  /// Whether a triangle runs next -> line.
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

  /// Where lines were asked for different growths, the limit is the largest of them: a line that was asked for less is measured as if its ratios were as much
  /// larger.
  double growth_scale(std::uint32_t line) const {
    const LayerRequest& request = mesh_.request;
    if (!lines_.are_columns() || line >= request.line_max_growth.size()) return 1.0;
    return request.max_growth / request.line_max_growth[line];
  }

  void add_first_height(std::uint32_t line, int n) {
    const double asked = mesh_.request.first_height_of(line);
    // Compressed, by the height along the normal, as the extrusion has it: what was asked for cannot be met.
    is_compressed_[line] = dot(point(line, n) - point(line, 0), vertex_normal_) < n * asked * (1.0 - k_height_slack);
    if (is_compressed_[line] != 0) return;
    scan_.first_height.add(std::abs(dot(point(line, 1) - point(line, 0), vertex_normal_) / asked - 1.0), line);
  }

  const HybridMesh& mesh_;
  const LayerLines& lines_;
  const Fans& fans_;
  const MirrorFeet& feet_;
  std::vector<std::uint8_t>& is_compressed_;
  bool is_request_usable_;
  LayerScan scan_;
  std::vector<Vec3> normals_;
  std::vector<double> heights_;
  Vec3 vertex_normal_;
  double area_ = 0.0;
};

/// Areas of one patch by what became of the layer there.
struct PatchAreas {
  double full = 0.0, reduced = 0.0, compressed = 0.0, collapsed = 0.0;
  std::map<std::string, double> lost;
  double total() const { return full + reduced + compressed + collapsed; }
};

/// Each corner of a wall triangle stands for a third of it.
std::map<std::uint32_t, PatchAreas> measure_coverage(const HybridMesh& mesh, const LayerLines& lines, const std::vector<std::uint8_t>& is_compressed,
                                                     const RunContext& context) {
  const LayerRequest& request = mesh.request;
  using Areas = std::map<std::uint32_t, PatchAreas>;
  return parallel_reduce(
      context, lines.triangles().size(), Areas{},
      [&](std::size_t begin, std::size_t end) {
        Areas areas;
        for (std::size_t t = begin; t < end; ++t) {
          const auto& corner = lines.triangles()[t];
          const auto foot = [&](std::size_t k) { return mesh.points[lines.node(corner[k], 0)]; };
          const double third = triangle_area(foot(0), foot(1), foot(2)) / 3.0;
          PatchAreas& patch = areas[lines.patch(t).value()];
          for (const std::uint32_t line : corner) {
            const int n = lines.n_layers(line);
            const double height = n == 0 ? 0.0 : distance(mesh.points[lines.node(line, 0)], mesh.points[lines.node(line, n)]);
            const bool is_full = n > 0 && height >= k_full_share * request.target_height[line];
            (n == 0 ? patch.collapsed : is_full ? patch.full : is_compressed[line] != 0 ? patch.compressed : patch.reduced) += third;
            if (!is_full) patch.lost[request.reasons[request.reason[line]]] += third;
          }
        }
        return areas;
      },
      [](Areas all, const Areas& more) {
        for (const auto& [patch, areas] : more) {
          PatchAreas& sum = all[patch];
          sum.full += areas.full;
          sum.reduced += areas.reduced;
          sum.compressed += areas.compressed;
          sum.collapsed += areas.collapsed;
          for (const auto& [reason, area] : areas.lost) sum.lost[reason] += area;
        }
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
  for (const auto& [reason, area] : areas.lost) result.lost.emplace_back(reason, scale * area);
  std::stable_sort(result.lost.begin(), result.lost.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  return result;
}

void judge_coverage(const HybridMesh& mesh, const LayerLines& lines, const std::vector<std::uint8_t>& is_compressed, const GateTable& limits,
                    const RunContext& context, CheckReport& report) {
  double full = 0.0, collapsed = 0.0, total = 0.0;
  for (const auto& [patch, areas] : measure_coverage(mesh, lines, is_compressed, context)) {
    report.coverage.push_back(share_out(mesh, patch, areas));
    full += areas.full;
    collapsed += areas.collapsed;
    total += areas.total();
  }
  const auto put = [&](Measure measure, double share) {
    GateScan scan(info_of(measure), limits[measure]);
    if (total > 0.0) scan.add(share, 0, total);
    GateResult result = scan.result([](std::uint64_t) { return std::pair(Point{}, std::string()); });
    result.places.clear();  // it is of the whole wall; patches and gate G13 say where
    report.gates[static_cast<std::size_t>(measure)] = std::move(result);
  };
  put(Measure::coverage, total > 0.0 ? full / total : 0.0);
  put(Measure::collapsed, total > 0.0 ? collapsed / total : 0.0);
}

/// The growth that was asked for replaces the default limit.
GateTable with_requested_growth(GateTable limits, const HybridMesh& mesh) {
  GateLimits& growth = limits[Measure::stack_growth];
  if (mesh.request.is_known() && growth.usual == info_of(Measure::stack_growth).limits.usual) {
    growth.usual = mesh.request.max_growth * (1.0 + k_growth_slack);
    growth.hard = std::max(growth.hard, growth.usual);
  }
  return limits;
}

}  // namespace

void judge_layers(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const GateTable& user_limits, const RunContext& context,
                  CheckReport& report) {
  const GateTable limits = with_requested_growth(user_limits, mesh);
  const auto put = [&](GateResult result) { report.gates[static_cast<std::size_t>(result.measure)] = std::move(result); };
  const LayerLines lines(mesh, slots, match, context);
  if (!lines.reason().empty()) {
    for (const Measure measure :
         {Measure::stack_growth, Measure::stack_angle, Measure::first_height, Measure::coverage, Measure::collapsed, Measure::layer_step})
      put(not_checked(measure, limits, lines.reason()));
    return;
  }
  const Fans fans(lines);
  const MirrorFeet feet(mesh);
  const bool is_usable = lines.are_columns() && is_request_usable(mesh);
  std::vector<std::uint8_t> is_compressed(lines.n_lines(), 0);
  const LayerScan scan = parallel_reduce(
      context, lines.n_lines(), LayerScan(limits),
      [&](std::size_t begin, std::size_t end) {
        LineScanner scanner(mesh, lines, fans, feet, limits, is_usable, is_compressed);
        for (std::size_t k = begin; k < end; ++k) scanner.add(static_cast<std::uint32_t>(k));
        return scanner.take();
      },
      [](LayerScan all, const LayerScan& more) {
        all.merge(more);
        return all;
      },
      k_gate_line_chunk);
  const auto line = [&](std::uint64_t id) {
    const auto k = static_cast<std::uint32_t>(id);
    const NodeId foot = lines.node(k, 0);
    std::string what = (lines.are_columns() ? "line " + std::to_string(k) : "node " + std::to_string(foot.value()) + " of the wall");
    if (!fans.around(k).empty() && lines.patch(fans.around(k).front()).is_valid()) what += ", patch " + patch_name(mesh, lines.patch(fans.around(k).front()));
    return std::pair(mesh.points[foot], what);
  };
  put(scan.growth.result(line));
  put(scan.angle.result(line));
  put(scan.step.result(line));
  if (!is_usable) {
    for (const Measure measure : {Measure::first_height, Measure::coverage, Measure::collapsed}) put(not_checked(measure, limits, k_no_request));
    return;
  }
  put(scan.first_height.result(line));
  judge_coverage(mesh, lines, is_compressed, limits, context, report);
}

}  // namespace sterna::check_parts
