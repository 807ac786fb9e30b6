#include "volmesh/layer/slide_lines.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <optional>

#include "geom/base/parallel.h"
#include "geom/base/sort_unique.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/mesh/cell_shapes.h"
#include "geom/mesh/line_measures.h"
#include "volmesh/case/growth_law.h"
#include "volmesh/layer/layer_cells.h"

namespace sterna::volmesh {
namespace {

/// Trial steps, relative to the largest allowed step. If none improves the cost, the next smaller step is tried.
constexpr std::array k_tried_steps = {0.5, 0.25, 0.1, 0.04, 0.015};
constexpr int k_most_moves = 8;  ///< largest number of moves of a growth line in a sweep
constexpr int k_sweeps = 3;
constexpr double k_reserve = 0.75;             ///< fraction of a hard limit; locations above it are improved
constexpr double k_regular_volumes = 3.0;      ///< target ratio of the volume of a prism to that of the tetrahedron that fits the prism (G9)
constexpr double k_cut_slope = 5.0;            ///< factor from the difference between cut share and k_good_cut_share to the excess of a side
constexpr double k_least_win = 0.02;           ///< a growth line moves only if this reduces the cost by at least this fraction
constexpr double k_far_reach = 2.5;            ///< factor on slide_share, for growth lines at which slide_share was not sufficient to meet a hard limit
constexpr double k_farthest = 0.6;             ///< largest displacement of a top, as a fraction of its height, unless slide_share is larger
constexpr double k_still_share = 0.02;         ///< fraction of a growth line's height; the displacement of the nodes below it decreases towards the wall
constexpr double k_still_share_of_flat = 0.1;  ///< the same fraction if flat cells of all growth lines have the same growth
constexpr double k_far_reserve = 0.2, k_far_excess = 0.8;  ///< sides that are better than this with approximate centres need no exact centres
constexpr int k_newton_steps = 30;
constexpr double k_sum_tolerance = 1e-12;
constexpr double k_most_power = 3.0, k_most_exponent = 3.0;
constexpr double k_most_change = 10.0;  ///< largest change of a ratio, times the height over the edge; it inclines faces by less than 68 degrees
constexpr double k_growth_rounding = 1e-6;
constexpr std::size_t k_search_chunk = 1 << 13;

/// Returns the cost of a value, given relative to its limit; zero within the limit.
double cost_of(double excess) { return excess > 1.0 ? excess * excess - 1.0 : 0.0; }

struct Solved {
  double exponent;
  std::vector<double> steps;
};

/// Returns the steps from[j] exp(x weight[j]) with this sum. Finds x by Newton's method from `start`, between `least` and `most`. Empty if there is no such x.
std::optional<Solved> solve_sum(const std::vector<double>& from, const std::vector<double>& weight, double sum, double start, double least, double most) {
  Solved solved{start, std::vector<double>(from.size())};
  for (int i = 0; i < k_newton_steps; ++i) {
    double value = -sum, slope = 0.0;
    for (std::size_t j = 0; j < from.size(); ++j) {
      solved.steps[j] = from[j] * std::exp(solved.exponent * weight[j]);
      value += solved.steps[j];
      slope += weight[j] * solved.steps[j];
    }
    if (std::abs(value) < k_sum_tolerance * sum) return solved;
    if (!(slope > 0.0)) return std::nullopt;  // all steps are equal
    solved.exponent -= value / slope;         // the function is convex, so iterates from above never fall below the solution
    if (!(solved.exponent > least && solved.exponent < most)) return std::nullopt;
  }
  return std::nullopt;
}

/// Returns steps with another sum, but with the same first step and the same shape of growth: the ratio of each step to the first is raised to a common power.
/// Empty if no power gives this sum.
std::optional<std::vector<double>> steps_with_sum(const std::vector<double>& steps, double sum) {
  std::vector<double> logs;
  for (const double step : steps) logs.push_back(std::log(step / steps[0]));
  std::optional<Solved> solved = solve_sum(std::vector<double>(steps.size(), steps[0]), logs, sum, 1.0, 0.0, k_most_power);
  if (!solved) return std::nullopt;
  return std::move(solved->steps);
}

/// Returns steps with another sum, while flat steps are kept. Each step is multiplied by exp(x w), where w is 0 for the first step, 1 for the last step, and
/// small where steps are flat, because the ratios of flat cells must equal those of the adjacent growth lines (growth_law.h). Empty if this needs ratios that
/// would incline the faces between flat cells.
std::optional<std::vector<double>> steps_above_flat_ones(const std::vector<double>& steps, double sum, double edge) {
  const double whole = std::log(steps.back() / steps[0]);
  if (!(whole > 0.0)) return std::nullopt;
  std::vector<double> weight;
  for (const double step : steps) weight.push_back(bend_share(step, edge) * std::log(step / steps[0]) / whole);
  std::optional<Solved> solved = solve_sum(steps, weight, sum, 0.0, -k_most_exponent, k_most_exponent);
  if (!solved) return std::nullopt;
  for (std::size_t j = 1; j < steps.size(); ++j)
    if (std::abs(solved->exponent * (weight[j] - weight[j - 1])) > k_most_change * steps[j - 1] / edge) return std::nullopt;
  return std::move(solved->steps);
}

double worst_growth(const std::vector<double>& steps) {
  double worst = 1.0;
  for (std::size_t i = 1; i < steps.size(); ++i) worst = std::max({worst, steps[i] / steps[i - 1], steps[i - 1] / steps[i]});
  return worst;
}

std::vector<double> steps_of(const std::vector<Point>& nodes) {
  std::vector<double> steps;
  for (std::size_t j = 1; j < nodes.size(); ++j) steps.push_back(distance(nodes[j - 1], nodes[j]));
  return steps;
}

/// Returns the growth line at `share` of its height. Its curve is scaled about the wall, with nodes on the scaled curve at the new steps. The first cell is
/// kept.
/// \param edge m: longest edge of the wall at the growth line if flat cells of all growth lines have the same growth; 0 if each growth line has its own ratio
std::optional<std::vector<Point>> scaled_line(const std::vector<Point>& nodes, double share, double edge) {
  const std::vector<double> steps = steps_of(nodes);
  double length = 0.0;
  for (const double step : steps) length += step;
  const std::optional<std::vector<double>> goal = edge > 0.0 ? steps_above_flat_ones(steps, share * length, edge) : steps_with_sum(steps, share * length);
  if (!goal) return std::nullopt;
  std::vector<Point> result = nodes;
  double along = (*goal)[0] / share, passed = 0.0;  // positions on the original curve: of the new node, and of the start of segment k
  std::size_t k = 0;
  for (std::size_t j = 2; j + 1 < nodes.size(); ++j) {
    along += (*goal)[j - 1] / share;
    while (k + 1 < steps.size() && passed + steps[k] < along) passed += steps[k++];
    const double part = std::min(1.0, (along - passed) / steps[k]);
    result[j] = nodes[0] + share * (nodes[k] + part * (nodes[k + 1] - nodes[k]) - nodes[0]);
  }
  result.back() = nodes[0] + share * (nodes.back() - nodes[0]);
  return result;
}

/// Moves the nodes with the top, by distances that decrease towards the wall. \p still is the length scale of this decrease, as a fraction of the height. The
/// first cell stays.
void shift_top(const Vec3& shift, double still, std::vector<Point>& nodes) {
  for (std::size_t j = 2; j < nodes.size(); ++j) {
    const double t = distance(nodes[0], nodes[j]) / distance(nodes[0], nodes.back());
    if (j + 1 < nodes.size()) nodes[j] += (t * t / (t + still)) * shift;
  }
  nodes.back() += shift;
}

}  // namespace

LineSlider::LineSlider(Borrowed<HybridMesh> layers, Borrowed<FillBoundary> boundary, const ImproveOptions& options, const RunContext& context)
    : mesh_(layers),
      boundary_(boundary),
      limits_(quality_limits(options.improve_min_angle, options.improve_max_angle)),
      share_(options.slide_share),
      context_(context) {
  const double least_weight = gates_[Measure::face_weight].hard;
  largest_step_ = std::min(gates_[Measure::tet_growth].hard, (1.0 - least_weight) / least_weight);
  lock_lines();
  list_sides();
}

void LineSlider::lock_lines() {
  const LayerBlock& layers = mesh_.layers;
  is_locked_.assign(layers.n_lines(), 0);
  // A growth line is locked if it has no node to redistribute.
  for (std::size_t line = 0; line < layers.n_lines(); ++line) is_locked_[line] = layers.n_steps(line) < 3;
  for (std::size_t column = 0; column < layers.n_columns(); ++column)
    if (layers.n_collapsed(column) > 0)
      for (const Line line : layers.base[column]) is_locked_[line] = 1;
  for (std::size_t t = layers.n_columns(); t < boundary_.triangles.size(); ++t)
    for (const std::uint32_t p : boundary_.triangles[t])
      if (p < layers.n_lines()) is_locked_[p] = 1;
}

void LineSlider::list_sides() {
  const LayerBlock& layers = mesh_.layers;
  sides_.reserve(3 * layers.n_columns());
  for (std::size_t column = 0; column < layers.n_columns(); ++column)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(layers.base[column][k], layers.base[column][(k + 1) % 3]);
      sides_.push_back({{a, b}, static_cast<std::uint32_t>(column)});
    }
  parallel_sort(context_, sides_, std::less<>());
}

const Vec3& LineSlider::point(const TetraResult& tets, std::uint32_t v) const {
  return v < boundary_.points.size() ? boundary_.points[v] : tets.new_points[v - boundary_.points.size()];
}

std::array<Vec3, 4> LineSlider::corners(const TetraResult& tets, std::uint32_t t) const {
  const auto& c = tets.tetrahedra[t];
  return {point(tets, c[0]), point(tets, c[1]), point(tets, c[2]), point(tets, c[3])};
}

double LineSlider::excess_of_tet(const TetraResult& tets, std::uint32_t t) const {
  const std::array<Vec3, 4> p = corners(tets, t);
  const double quality = tet_quality(p[0], p[1], p[2], p[3], limits_.obtuse_weight);
  return quality > 0.0 ? limits_.target / quality : k_infinity;
}

LineSlider::Interface LineSlider::interface_of(const TetraResult& tets, std::uint32_t column, std::uint32_t tet) const {
  const LayerBlock& layers = mesh_.layers;
  const Cell cell = layers.cell(column, layers.layers_of_column(column) - 1);
  WedgePoints p;  // the last cell; if a growth line ends one layer below the others, the last steps of all three growth lines
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t top = layers.top(layers.base[column][k]).index();
    p[k] = mesh_.points.raw()[top - 1];
    p[k + 3] = mesh_.points.raw()[top];
  }
  const double edge = (distance(p[3], p[4]) + distance(p[4], p[5]) + distance(p[5], p[3])) / 3.0;
  const double height = (distance(p[0], p[3]) + distance(p[1], p[4]) + distance(p[2], p[5])) / 3.0;
  const std::array<Vec3, 4> t = corners(tets, tet);
  const double volume = tet_volume(t[0], t[1], t[2], t[3]);
  const Point middle = (p[3] + p[4] + p[5]) / 3.0;
  const Vec3 normal = normalized(cross(p[4] - p[3], p[5] - p[3]));
  const double below = std::abs(dot(check_parts::cell_shape(mesh_, cell).centre - middle, normal));
  const double above = std::abs(dot(0.25 * (t[0] + t[1] + t[2] + t[3]) - middle, normal));
  const double weight = std::min(below, above) / (below + above);
  const double volumes = cell.kind == CellKind::prism ? check_parts::deviation(k_regular_volumes * volume / wedge_volume(p)) : 1.0;
  return {volumes / gates_[Measure::interface_volume].hard, check_parts::interface_jump(height, edge) / gates_[Measure::interface_height].hard,
          gates_[Measure::face_weight].hard / weight};
}

/// Returns the first entry of the edge between corners k and k + 1 of a column.
std::size_t LineSlider::side_of(std::uint32_t column, std::size_t k) const {
  const auto [a, b] = std::minmax(mesh_.layers.base[column][k], mesh_.layers.base[column][(k + 1) % 3]);
  return static_cast<std::size_t>(std::ranges::lower_bound(sides_, Side{{a, b}, 0}) - sides_.begin());
}

/// Returns the entry of the other column for the same edge; the side itself if there is no other column.
std::size_t LineSlider::partner(std::size_t side) const {
  if (side + 1 < sides_.size() && sides_[side + 1].ends == sides_[side].ends) return side + 1;
  if (side > 0 && sides_[side - 1].ends == sides_[side].ends) return side - 1;
  return side;
}

double LineSlider::excess_of_side(std::size_t side) const {
  const LayerBlock& layers = mesh_.layers;
  const auto nodes = [&](Line line) { return mesh_.points.raw().data() + layers.first_node[line]; };
  const auto third = [&](std::uint32_t column) -> const Point* {
    for (const Line line : layers.base[column])
      if (line != sides_[side].ends[0] && line != sides_[side].ends[1]) return nodes(line);
    return nullptr;
  };
  const std::size_t other = partner(side);
  const auto& base = layers.base[sides_[side].column];
  Line from = sides_[side].ends[0], to = sides_[side].ends[1];  // in the direction of the first column
  for (std::size_t k = 0; k < 3; ++k)
    if (base[k] == to && base[(k + 1) % 3] == from) std::swap(from, to);
  const std::uint32_t own = sides_[side].column, beyond = sides_[other].column;
  const SideLines lines = {nodes(from), nodes(to), third(own), other == side ? nullptr : third(beyond)};
  const auto excess = [&](const SideShape& shape, double reserve) {
    return std::max(1.0 + k_cut_slope * (reserve - shape.cut_share), gates_[Measure::face_weight].hard / (k_reserve * shape.weight));
  };
  const ColumnLines of_own = column_lines(layers, mesh_.points.raw(), own), of_beyond = column_lines(layers, mesh_.points.raw(), beyond);
  const int n = std::min(of_own.n_prisms(), of_beyond.n_prisms());
  const int first = std::min(first_layer_to_look_at(of_own), first_layer_to_look_at(of_beyond));
  if (excess(side_shape(lines, first, n), k_far_reserve) <= k_far_excess) return 0.0;
  const auto centre_in = [&](std::uint32_t column) {
    return [&mesh = mesh_, column](int layer) { return check_parts::cell_shape(mesh, mesh.layers.cell(column, layer)).centre; };
  };
  return excess(side_shape(lines, first, n, centre_in(own), centre_in(beyond)), k_good_cut_share);
}

/// Returns for each column the tetrahedron on its top; k_none if there is none.
std::vector<std::uint32_t> LineSlider::tets_on_columns(const TetraResult& tets) const {
  struct Top {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t column;
    bool operator<(const Top& other) const { return corners < other.corners; }
  };
  const std::size_t n_lines = mesh_.layers.n_lines();
  std::vector<Top> tops;
  for (std::size_t column = 0; column < mesh_.layers.n_columns(); ++column) {
    if (mesh_.layers.n_collapsed(column) > 0 || mesh_.layers.layers_of_column(column) == 0) continue;
    Top& top = tops.emplace_back(mesh_.layers.base[column], static_cast<std::uint32_t>(column));
    std::ranges::sort(top.corners);
  }
  parallel_sort(context_, tops, std::less<>());
  std::vector<std::uint32_t> tet_on(mesh_.layers.n_columns(), k_none);
  parallel_for(context_, tets.tetrahedra.size(), [&](std::size_t t) {
    const auto& c = tets.tetrahedra[t];
    if (std::ranges::count_if(c, [&](std::uint32_t v) { return v < n_lines; }) < 3) return;
    for (std::size_t skipped = 0; skipped < 4; ++skipped) {
      Top face{{c[(skipped + 1) % 4], c[(skipped + 2) % 4], c[(skipped + 3) % 4]}, 0};
      std::ranges::sort(face.corners);
      const auto top = std::ranges::lower_bound(tops, face.corners, {}, &Top::corners);
      if (top != tops.end() && top->corners == face.corners) tet_on[top->column] = static_cast<std::uint32_t>(t);
    }
  });
  return tet_on;
}

/// Returns growth lines at volume steps between tetrahedra that are near or beyond the limit.
std::vector<LineSlider::Fault> LineSlider::steps_beyond(const TetraResult& tets) const {
  const std::size_t n_lines = mesh_.layers.n_lines();
  std::vector<double> smallest(n_lines, k_infinity), largest(n_lines, 0.0);
  const auto for_each_line = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < tets.tetrahedra.size(); ++t)
      for (const std::uint32_t v : tets.tetrahedra[t])
        if (v < n_lines && !is_locked_[v]) visit(v, t);
  };
  for_each_line([&](Line line, std::uint32_t t) {
    const std::array<Vec3, 4> p = corners(tets, t);
    const double volume = tet_volume(p[0], p[1], p[2], p[3]);
    smallest[line] = std::min(smallest[line], volume);
    largest[line] = std::max(largest[line], volume);
  });
  std::map<Line, std::vector<std::uint32_t>> around;
  for_each_line([&](Line line, std::uint32_t t) {
    if (largest[line] > k_reserve * largest_step_ * smallest[line]) around[line].push_back(t);
  });
  std::vector<Fault> faults;
  for (const auto& [line, star] : around)
    for (const auto& pair : neighbours_in(tets, star)) {
      const double excess = excess_of_step(tets, pair) / k_reserve;
      if (excess > 1.0) faults.push_back({excess, line});
    }
  return faults;
}

/// Returns growth lines at locations near or beyond hard limits, worst first, each once.
std::vector<LineSlider::Fault> LineSlider::find_faults(const TetraResult& tets, const std::vector<std::uint32_t>& tet_on) const {
  const std::size_t n_lines = mesh_.layers.n_lines();
  const auto add = [&](double excess, Line line, std::vector<Fault>& faults) {
    if (line < n_lines && !is_locked_[line]) faults.push_back({excess, line});
  };
  std::vector<Fault> faults = parallel_collect<Fault>(
      context_, tets.tetrahedra.size(),
      [&](std::size_t begin, std::size_t end, std::vector<Fault>& found) {
        for (std::size_t t = begin; t < end; ++t) {
          if (std::ranges::min(tets.tetrahedra[t]) >= n_lines) continue;
          const double excess = excess_of_tet(tets, static_cast<std::uint32_t>(t));
          if (excess <= 1.0) continue;
          for (const std::uint32_t v : tets.tetrahedra[t]) add(excess, v, found);
        }
      },
      k_search_chunk);
  const auto append = [&](const std::vector<Fault>& more) { faults.insert(faults.end(), more.begin(), more.end()); };
  append(parallel_collect<Fault>(
      context_, tet_on.size(),
      [&](std::size_t begin, std::size_t end, std::vector<Fault>& found) {
        for (std::size_t column = begin; column < end; ++column) {
          if (tet_on[column] == k_none) continue;
          const double excess = interface_of(tets, static_cast<std::uint32_t>(column), tet_on[column]).worst() / k_reserve;
          if (excess <= 1.0) continue;
          // The three vertices of the column, and possibly one across a fold.
          for (const std::uint32_t v : tets.tetrahedra[tet_on[column]]) add(excess, v, found);
        }
      },
      k_search_chunk));
  append(parallel_collect<Fault>(
      context_, sides_.size(),
      [&](std::size_t begin, std::size_t end, std::vector<Fault>& found) {
        for (std::size_t side = begin; side < end; ++side) {
          const std::size_t other = partner(side);
          if (other < side || mesh_.layers.n_collapsed(sides_[side].column) > 0 || mesh_.layers.n_collapsed(sides_[other].column) > 0) continue;
          const double excess = excess_of_side(side);
          if (excess <= 1.0) continue;
          for (const std::size_t s : {side, other})
            for (const Line line : mesh_.layers.base[sides_[s].column]) add(excess, line, found);
        }
      },
      k_search_chunk));
  append(steps_beyond(tets));
  std::ranges::sort(faults, [](const Fault& a, const Fault& b) { return a.line != b.line ? a.line < b.line : a.excess > b.excess; });
  faults.erase(std::unique(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) { return a.line == b.line; }), faults.end());
  std::ranges::sort(faults, [](const Fault& a, const Fault& b) { return a.excess != b.excess ? a.excess > b.excess : a.line < b.line; });
  if (faults.size() > k_most_lines) faults.resize(k_most_lines);
  return faults;
}

std::vector<LineSlider::Star> LineSlider::stars_of(const TetraResult& tets, const std::vector<Fault>& faults, const std::vector<std::uint32_t>& tet_on) const {
  std::vector<std::uint32_t> star_of(mesh_.layers.n_lines(), k_none);
  for (std::size_t i = 0; i < faults.size(); ++i) star_of[faults[i].line] = static_cast<std::uint32_t>(i);
  std::vector<Star> stars(faults.size());
  for (std::size_t column = 0; column < mesh_.layers.n_columns(); ++column)
    for (const Line line : mesh_.layers.base[column])
      if (star_of[line] != k_none) {
        stars[star_of[line]].columns.push_back(static_cast<std::uint32_t>(column));
        stars[star_of[line]].tet_on.push_back(tet_on[column]);
      }
  for (std::size_t t = 0; t < tets.tetrahedra.size(); ++t)
    for (const std::uint32_t v : tets.tetrahedra[t])
      if (v < star_of.size() && star_of[v] != k_none) stars[star_of[v]].tets.push_back(static_cast<std::uint32_t>(t));
  parallel_for(
      context_, stars.size(), [&](std::size_t i) { stars[i].neighbours = neighbours_in(tets, stars[i].tets); }, 16);
  return stars;
}

/// Returns pairs of a star's tetrahedra with a common face. They are sorted by the position of the later one, then by that of the other. O(n log n), because
/// growth lines under stars of sliver tetrahedra have thousands.
std::vector<std::array<std::uint32_t, 2>> LineSlider::neighbours_in(const TetraResult& tets, const std::vector<std::uint32_t>& star) const {
  struct Face {
    std::array<std::uint32_t, 3> corners;  ///< ascending
    std::uint32_t location;
    auto operator<=>(const Face&) const = default;
  };
  std::vector<Face> faces;
  faces.reserve(4 * star.size());
  for (std::uint32_t i = 0; i < star.size(); ++i) {
    std::array<std::uint32_t, 4> c = tets.tetrahedra[star[i]];
    std::ranges::sort(c);
    for (const auto& face : {std::array{c[1], c[2], c[3]}, std::array{c[0], c[2], c[3]}, std::array{c[0], c[1], c[3]}, std::array{c[0], c[1], c[2]}})
      faces.push_back({face, i});
  }
  std::ranges::sort(faces);
  std::vector<std::array<std::uint32_t, 2>> locations;
  for (std::size_t k = 1; k < faces.size(); ++k)
    if (faces[k].corners == faces[k - 1].corners) locations.push_back({faces[k].location, faces[k - 1].location});
  std::ranges::sort(locations);
  std::vector<std::array<std::uint32_t, 2>> pairs;
  pairs.reserve(locations.size());
  for (const auto& [later, earlier] : locations) pairs.push_back({star[earlier], star[later]});
  return pairs;
}

/// Returns the ratio of the volume step between two tetrahedra to the largest allowed step.
double LineSlider::excess_of_step(const TetraResult& tets, const std::array<std::uint32_t, 2>& pair) const {
  const auto volume = [&](std::uint32_t t) {
    const std::array<Vec3, 4> p = corners(tets, t);
    return tet_volume(p[0], p[1], p[2], p[3]);
  };
  return check_parts::deviation(volume(pair[0]) / volume(pair[1])) / largest_step_;
}

/// Returns the cost of a star. Stops when the sum reaches `stop_at`. Therefore the terms that take longest, those of the sides of all layers, are computed
/// last.
double LineSlider::cost(const TetraResult& tets, const Star& star, double stop_at) const {
  double sum = 0.0;
  for (const auto& pair : star.neighbours) sum += cost_of(excess_of_step(tets, pair) / k_reserve);
  for (const std::uint32_t t : star.tets) sum += cost_of(excess_of_tet(tets, t));
  for (std::size_t i = 0; i < star.columns.size() && sum < stop_at; ++i) {
    if (star.tet_on[i] == k_none) continue;
    const Interface interface = interface_of(tets, star.columns[i], star.tet_on[i]);
    for (const double excess : {interface.volume, interface.height, interface.weight}) sum += cost_of(excess / k_reserve);
  }
  for (const std::uint32_t column : star.columns)
    for (std::size_t k = 0; k < 3 && sum < stop_at; ++k) sum += cost_of(excess_of_side(side_of(column, k)));
  return sum;
}

bool LineSlider::is_valid(const TetraResult& tets, const Star& star) const {
  for (const std::uint32_t column : star.columns)
    if (!is_column_certain(column_lines(mesh_.layers, mesh_.points.raw(), column))) return false;
  return std::ranges::all_of(star.tets, [&](std::uint32_t t) { return is_tet_valid(corners(tets, t)); });
}

std::vector<Point> LineSlider::nodes_of(Line line) const {
  const auto first = mesh_.points.raw().begin() + mesh_.layers.first_node[line];
  return {first, first + mesh_.layers.n_steps(line) + 1};
}

void LineSlider::put(Line line, const std::vector<Point>& nodes) {
  std::ranges::copy(nodes, mesh_.points.raw().begin() + mesh_.layers.first_node[line]);
  boundary_.points[line] = nodes.back();
}

/// Returns the largest allowed ratio of consecutive cells of the growth line.
double LineSlider::allowed_growth(Line line) const {
  const LayerRequest& request = mesh_.request;
  const double requested = request.max_growth_of(line);
  return std::max(requested, 1.0) * (1.0 + k_growth_rounding);
}

Vec3 LineSlider::to_middle(Line line, const Star& star) const {
  Vec3 sum;
  int n = 0;
  for (const std::uint32_t column : star.columns)
    for (const Line other : mesh_.layers.base[column])
      if (other != line) {
        sum += boundary_.points[other];
        ++n;
      }
  return n > 0 ? sum / n - boundary_.points[line] : Vec3{};
}

/// Makes one move, the best of decreasing steps up, down and sideways. Returns false if no step improves the cost.
bool LineSlider::help(const TetraResult& tets, Line line, const Star& star, Moved& state) {
  const double cost_now = cost(tets, star, std::numeric_limits<double>::infinity());
  if (!(cost_now > 0.0)) return false;
  const std::vector<Point> now = nodes_of(line);
  const double height = distance(state.nodes.front(), state.nodes.back()), growth = std::max(worst_growth(steps_of(now)), allowed_growth(line));
  const Vec3 up = normalized(now.back() - now[now.size() - 2]), middle = to_middle(line, star);
  const Vec3 aside = normalized(middle - dot(middle, up) * up), across = cross(up, aside);
  double edge = 0.0;
  if (!mesh_.request.line_first_room.empty())  // flat cells of all growth lines have the same growth
    for (const std::uint32_t column : star.columns)
      for (const Line other : mesh_.layers.base[column])
        edge = std::max(edge, distance(state.nodes.front(), mesh_.points[NodeId(mesh_.layers.first_node[other])]));
  struct Trial {
    double cost, share;
    Vec3 shift;
    std::vector<Point> nodes;
  };
  for (const double step : k_tried_steps) {
    std::vector<Trial> trials;
    const auto attempt = [&](double share, const Vec3& shift) {
      if (share < 1.0 - state.reach || share > 1.0 + 0.5 * state.reach || norm(shift) > state.reach * height) return;
      std::optional<std::vector<Point>> nodes = scaled_line(state.nodes, share, edge);
      if (!nodes) return;
      shift_top(shift, edge > 0.0 ? k_still_share_of_flat : k_still_share, *nodes);
      if (worst_growth(steps_of(*nodes)) > growth) return;
      put(line, *nodes);
      const double most = (1.0 - k_least_win) * cost_now, with = cost(tets, star, most);
      if (with < most) trials.push_back({with, share, shift, std::move(*nodes)});
    };
    const double length = step * state.reach;
    for (const double sign : {-1.0, 1.0}) {
      attempt(state.share + sign * length, state.shift);
      attempt(state.share, state.shift + sign * length * height * aside);
      attempt(state.share, state.shift + sign * length * height * across);
    }
    std::ranges::sort(trials, {}, &Trial::cost);
    for (Trial& trial : trials) {
      put(line, trial.nodes);
      if (!is_valid(tets, star)) continue;
      state.share = trial.share;
      state.shift = trial.shift;
      return true;
    }
  }
  put(line, now);
  return false;
}

/// Returns the growth lines on whose nodes the costs around a growth line depend, ascending.
std::vector<LineSlider::Line> LineSlider::lines_seen_from(const TetraResult& tets, const Star& star) const {
  std::vector<Line> lines;
  const auto add_column = [&](std::uint32_t column) { lines.insert(lines.end(), mesh_.layers.base[column].begin(), mesh_.layers.base[column].end()); };
  for (const std::uint32_t column : star.columns) {
    add_column(column);
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t side : {side_of(column, k), partner(side_of(column, k))}) add_column(sides_[side].column);
  }
  for (const std::uint32_t t : star.tets)
    for (const std::uint32_t v : tets.tetrahedra[t])
      if (v < mesh_.layers.n_lines()) lines.push_back(v);
  sort_unique(lines);
  return lines;
}

/// Returns groups of faults that do not affect each other, so that the faults of a group can be treated at the same time. Faults are assigned in their order.
std::vector<std::vector<std::uint32_t>> LineSlider::independent_groups(const std::vector<Star>& stars,
                                                                       const std::vector<std::vector<std::uint32_t>>& seen) const {
  std::vector<std::vector<std::uint32_t>> groups;
  std::vector<std::uint32_t> group_of(stars.size());
  for (std::uint32_t i = 0; i < stars.size(); ++i) {
    std::vector<std::uint32_t> taken;
    for (const std::uint32_t other : seen[i])
      if (other < i) taken.push_back(group_of[other]);
    sort_unique(taken);
    std::uint32_t group = 0;
    while (group < taken.size() && taken[group] == group) ++group;
    group_of[i] = group;
    if (group == groups.size()) groups.emplace_back();
    groups[group].push_back(i);
  }
  return groups;
}

std::vector<std::uint32_t> LineSlider::slide(const TetraResult& tets) {
  const std::vector<std::uint32_t> tet_on = tets_on_columns(tets);
  const std::vector<Fault> faults = find_faults(tets, tet_on);
  const std::vector<Star> stars = stars_of(tets, faults, tet_on);
  const std::vector<std::vector<std::uint32_t>> seen = faults_seen(tets, faults, stars);
  std::vector<Moved> states(faults.size());
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const auto known = moved_.find(faults[i].line);
    states[i] = known == moved_.end() ? Moved{nodes_of(faults[i].line)} : known->second;
    states[i].reach = n_rounds_ > 0 && k_reserve * faults[i].excess > 1.0 ? std::max(share_, std::min(k_farthest, k_far_reach * share_)) : share_;
  }
  std::vector<std::uint8_t> has_moved(faults.size(), 0), moved_now(faults.size(), 0), is_stale(faults.size(), 1);
  const std::vector<std::vector<std::uint32_t>> groups = independent_groups(stars, seen);
  for (int sweep = 0; sweep < k_sweeps; ++sweep)
    for (const std::vector<std::uint32_t>& group : groups) {
      parallel_for(
          context_, group.size(),
          [&](std::size_t k) {
            const std::uint32_t i = group[k];
            moved_now[i] = 0;
            if (!is_stale[i]) return;
            is_stale[i] = 0;
            for (int n = 0; n < k_most_moves && help(tets, faults[i].line, stars[i], states[i]); ++n) moved_now[i] = 1;
          },
          1);
      for (const std::uint32_t i : group) {
        if (!moved_now[i]) continue;
        has_moved[i] = 1;
        for (const std::uint32_t other : seen[i]) is_stale[other] = 1;
      }
    }
  ++n_rounds_;
  std::vector<std::uint32_t> moved;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    if (!has_moved[i]) continue;
    moved.push_back(faults[i].line);
    moved_.insert_or_assign(faults[i].line, std::move(states[i]));
    for (const std::uint32_t column : stars[i].columns) boundary_.layer_volumes[column] = last_prism_volume(mesh_.layers, mesh_.points.raw(), column);
  }
  std::ranges::sort(moved);
  return moved;
}

/// Returns for each fault the other faults whose costs it changes, or that change its cost, ascending.
std::vector<std::vector<std::uint32_t>> LineSlider::faults_seen(const TetraResult& tets, const std::vector<Fault>& faults,
                                                                const std::vector<Star>& stars) const {
  std::vector<std::vector<Line>> lines(faults.size());
  parallel_for(
      context_, faults.size(), [&](std::size_t i) { lines[i] = lines_seen_from(tets, stars[i]); }, 16);
  std::map<Line, std::uint32_t> fault_of;
  for (std::uint32_t i = 0; i < faults.size(); ++i) fault_of[faults[i].line] = i;
  std::vector<std::vector<std::uint32_t>> seen(faults.size());
  for (std::uint32_t i = 0; i < faults.size(); ++i)
    for (const Line line : lines[i]) {
      const auto other = fault_of.find(line);
      if (other == fault_of.end() || other->second == i) continue;
      seen[i].push_back(other->second);
      seen[other->second].push_back(i);
    }
  for (std::vector<std::uint32_t>& others : seen) sort_unique(others);
  return seen;
}

}  // namespace sterna::volmesh
