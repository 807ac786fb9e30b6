#include "geom/mesh/forced_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/base/number_text.h"
#include "geom/base/print_text.h"
#include "geom/math/constants.h"
#include "geom/math/measures.h"
#include "geom/math/spherical_cap.h"
#include "geom/mesh/line_measures.h"

namespace sterna::check_parts {
namespace {

constexpr int k_forced_digits = 3;  ///< digits of lengths in messages
/// rad; beyond this angle between a line and an adjacent normal nothing is proven. Proofs about sides hold for lines that lean by at most k_lean_room more than
/// the best direction at their base vertices.
constexpr double k_most_forced_skew = 88 * k_degree;
/// Nothing is proven if a side's normal is tilted by more than this (sine) against the plane perpendicular to the wall's edge.
constexpr double k_most_tilt = 0.4;
/// Tolerance factors: a first height within its target (G11) may be larger by the first factor, a growth ratio equal to the requested one by the second.
constexpr double k_first_height_room = 1.02, k_growth_room = 1.001;
/// Lines that lean by more than this (cosine) may have any length for a given height.
constexpr double k_least_lean_cosine = 0.1;
/// Sweeps of the search for a bound's multipliers. Any multipliers give a proof; more sweeps give a tighter bound.
constexpr int k_multiplier_sweeps = 100;
/// Rounding tolerance when measures of this mesh are compared with the bounds, which must hold for this mesh, too.
constexpr double k_bound_slack = 1e-9;

constexpr const char* k_remesh_there = "remesh the wall there (surface_mesh), or split its sliver triangles";
constexpr const char* k_request_more = "more layers, a larger growth or first height, or a finer wall there";
constexpr const char* k_fewer_layers = "truncate the layer there, or request fewer layers";

/// Returns the least share of corner `own` in the centre of a prism with these lengths at its corners, where heights are at least `stand` times the lengths.
/// largest_share() returns the largest share.
double least_share(double own, double others, double stand) { return (2.0 * stand * own + others) / (4.0 * (stand * own + others)); }
double largest_share(double own, double others, double stand) { return (2.0 * own + stand * others) / (4.0 * (own + stand * others)); }

}  // namespace

/// Two wall triangles at a common edge, and bounds of the layer above them.
struct GivenLayer::Pair {
  /// One of the two triangles, relative to the edge.
  struct Half {
    double area = 0.0;     ///< m^2
    double reach = 0.0;    ///< m, distance of the opposite corner from the edge's line
    double longest = 0.0;  ///< m, longest side
    double step = 0.0;     ///< m, step of the opposite line in the layer
  };
  std::array<Half, 2> halves;
  double edge = 0.0;          ///< m
  double steps = 0.0;         ///< m, sum of the steps of the edge's two lines in the layer
  double moved = 0.0;         ///< m, largest distance of a corner of the two cells from the wall
  double moved_across = 0.0;  ///< m, as `moved`, along the side's normal
  double tilt = 0.0;          ///< sine of the largest angle between the side's normal and the plane perpendicular to the wall's edge
  double carry = 0.0;         ///< least quotient of two components of a step or a side's normal: along the axes of one triangle over along those of the other
  double stand = 0.0;         ///< least cosine between a step and the normal of an adjacent triangle
  double stands = 0.0;        ///< least component of the side's normal along a triangle, perpendicular to the edge
};

struct GivenLayer::Room {
  double last = 0.0, total = 0.0;                            ///< m, largest length of the last cell and of the line
  double last_as_requested = 0.0, total_as_requested = 0.0;  ///< m, the same lengths if no gap limited the line
  Vec3 best;                                                 ///< unit, the direction of lines with the best view of the facets
  /// Returns the largest fraction of a line's length along a direction while the line is within k_lean_room of the best direction.
  double most_along(const Vec3& direction) const { return std::max(0.0, std::cos(std::max(0.0, angle_between(best, direction) - k_lean_room))); }
};

GivenLayer::GivenLayer(Borrowed<const HybridMesh> mesh) : mesh_(mesh), rings_(mesh->layers), mirror_normals_(mesh) {
  for (std::size_t k = 0; k < mesh->layers.n_lines(); ++k) line_at_.push_back({mesh->layers.first_node[k], static_cast<std::uint32_t>(k)});
  std::sort(line_at_.begin(), line_at_.end());
}

double GivenLayer::step(std::uint32_t line, int layer) const {
  return distance(mesh_.points[mesh_.layers.node(line, layer)], mesh_.points[mesh_.layers.node(line, layer + 1)]);
}

/// Returns the length of a line up to a layer, m.
double GivenLayer::length(std::uint32_t line, int layer) const {
  double sum = 0.0;
  for (int j = 0; j < layer; ++j) sum += step(line, j);
  return sum;
}

std::vector<Vec3> GivenLayer::normals_around(std::uint32_t line) const {
  std::vector<Vec3> normals;
  for (const std::uint32_t column : rings_.columns(line)) {
    const auto& base = mesh_.layers.base[column];
    normals.push_back(normalized(area_vector(base_point(base[0]), base_point(base[1]), base_point(base[2]))));
  }
  mirror_normals_.add_images(mesh_.layers.node(line, 0), normals);
  return normals;
}

/// Returns true if the line is surrounded by columns of prisms only.
bool GivenLayer::is_closed(std::uint32_t line) const {
  std::vector<std::uint32_t> before, after;
  for (const std::uint32_t column : rings_.columns(line)) {
    if (!mesh_.layers.is_prismatic(column)) return false;
    const auto& base = mesh_.layers.base[column];
    const std::size_t corner = base[0] == line ? 0 : base[1] == line ? 1 : 2;
    after.push_back(base[(corner + 1) % 3]);
    before.push_back(base[(corner + 2) % 3]);
  }
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  return !before.empty() && before == after;
}

std::array<std::uint32_t, 4> GivenLayer::lines_of(const ColumnSide& side) const {
  const auto &base = mesh_.layers.base[side.column], &behind = mesh_.layers.base[side.other];
  std::array<std::uint32_t, 4> lines = {base[side.corner], base[(side.corner + 1) % 3], base[(side.corner + 2) % 3], behind[0]};
  for (const std::uint32_t line : behind)
    if (line != lines[0] && line != lines[1]) lines[3] = line;
  return lines;
}

std::optional<GivenLayer::Pair> GivenLayer::pair_of(const ColumnSide& side) const {
  if (!is_between_prisms(side)) return std::nullopt;
  const auto [a, b, c, e] = lines_of(side);
  const Point &pa = base_point(a), &pb = base_point(b), &pc = base_point(c), &pe = base_point(e);
  Pair pair;
  pair.edge = distance(pa, pb);
  double best = 0.0, least_length = k_infinity;
  for (const std::uint32_t line : {a, b, c, e}) {
    best = std::max(best, smallest_spherical_cap(normals_around(line)).angle);
    pair.moved = std::max(pair.moved, length(line, side.layer + 1));
    least_length = std::min(least_length, length(line, side.layer));
  }
  const double turn = angle_between(area_vector(pa, pb, pc), area_vector(pb, pa, pe)), skew = best + k_lean_room;
  if (!(skew < k_most_forced_skew)) return std::nullopt;
  // The side's normal is perpendicular to a step, so its angle to the planes of the triangles is at most `skew`. So is the angle of lines to the triangle
  // normals.
  pair.moved_across = pair.moved * std::sin(std::min(2.0 * skew, 0.5 * std::numbers::pi));
  pair.steps = step(a, side.layer) + step(b, side.layer);
  pair.halves[0] = {triangle_area(pa, pb, pc), 0.0, longest_side(pa, pb, pc), step(c, side.layer)};
  pair.halves[1] = {triangle_area(pb, pa, pe), 0.0, longest_side(pa, pb, pe), step(e, side.layer)};
  double turned = 0.0;
  for (Pair::Half& half : pair.halves) {
    half.reach = 2.0 * half.area / pair.edge;
    // Heights over a triangle differ by at most `rise`; the plane through them is at most as steep as `rise` over the triangle's least height.
    const double rise = pair.moved - std::cos(skew) * least_length, width = 2.0 * half.area / half.longest - 2.0 * pair.moved * std::sin(skew);
    if (!(width > 0.0)) return std::nullopt;
    turned = std::max(turned, std::atan(rise / width));
  }
  pair.tilt = 2.0 * pair.moved_across / pair.edge;
  if (!(pair.tilt < k_most_tilt)) return std::nullopt;
  // Let n be the side's normal minus its component along the edge: its angles to the two triangle normals are at most `widest`.
  if (!(skew + turned < k_most_forced_skew)) return std::nullopt;
  const double sine = std::sin(skew) / std::sqrt(1.0 - pair.tilt * pair.tilt);
  if (!(sine < 1.0)) return std::nullopt;
  const double widest = std::asin(sine);
  pair.stand = std::cos(skew + turned);
  pair.carry = std::cos(widest) / std::cos(turn - widest);
  const double squared = std::cos(skew) * std::cos(skew) - pair.tilt * pair.tilt;
  if (!(squared > 0.0)) return std::nullopt;
  pair.stands = std::sqrt(squared);
  return pair;
}

std::optional<Forcing> GivenLayer::face_weight(const ColumnSide& side, double limit) const {
  const std::optional<Pair> pair = pair_of(side);
  if (!pair) return std::nullopt;
  for (std::size_t k = 0; k < 2; ++k) {
    const Pair::Half &near = pair->halves[k], &far = pair->halves[1 - k];
    // Along the edge, points of a triangle are at most its longest side apart; the centres of side and cell are displaced by at most `moved`.
    const double near_error = (pair->tilt * near.longest + 2.0 * pair->moved_across) / pair->stands;
    const double far_error = (pair->tilt * far.longest + 2.0 * pair->moved_across) / pair->stands;
    const double to_far = pair->carry * least_share(far.step, pair->steps, pair->stand) * far.reach - far_error;
    const double to_near = largest_share(near.step, pair->steps, pair->stand) * near.reach + near_error;
    const double bound = to_near / (to_near + to_far);
    if (to_far > 0.0 && bound < limit)
      return Forcing{"two wall triangles extend " + in_metres(near.reach, k_forced_digits) + " and " + in_metres(far.reach, k_forced_digits) +
                         " from their common edge here: no face weight can be above " + print_text("%.3g", bound),
                     k_remesh_there};
  }
  return std::nullopt;
}

std::optional<Forcing> GivenLayer::volume_ratio(const ColumnSide& side, double limit) const {
  const std::optional<Pair> pair = pair_of(side);
  if (!pair) return std::nullopt;
  for (std::size_t k = 0; k < 2; ++k) {
    const Pair::Half &small = pair->halves[k], &large = pair->halves[1 - k];
    const double largest = small.area + area_error(small.longest, pair->moved);
    const double smallest = large.area - area_error(large.longest, pair->moved);
    if (!(smallest > 0.0)) continue;
    double heights = 0.0;
    for (const double stand : {pair->stand, 1.0})
      heights = std::max(heights, (stand * pair->steps + small.step) / (pair->carry * stand * pair->steps + pair->stand * large.step));
    const double bound = largest / smallest * heights;
    if (bound < limit)
      return Forcing{"adjacent wall triangles have " + print_text("%.3g", small.area) + " and " + print_text("%.3g", large.area) +
                         " m^2 here: no volume ratio can be above " + print_text("%.3g", bound),
                     k_remesh_there};
  }
  return std::nullopt;
}

std::optional<Forcing> GivenLayer::orthogonality(NodeId node, double limit) const {
  const auto next = std::upper_bound(line_at_.begin(), line_at_.end(), node.value(), [](std::uint32_t n, const auto& entry) { return n < entry.first; });
  if (next == line_at_.begin()) return std::nullopt;
  const auto [first, line] = *std::prev(next);
  const auto layer = static_cast<int>(node.value() - first);
  if (layer >= mesh_.layers.n_steps(line) || !is_closed(line)) return std::nullopt;

  const double own = length(line, layer + 1);
  const double own_step = std::max(step(line, layer), layer > 0 ? step(line, layer - 1) : 0.0);
  std::vector<Vec3> normals;
  Vec3 sum{};
  double error = 0.0, slack = 0.0, beside = 0.0;
  for (const std::uint32_t column : rings_.columns(line)) {
    const auto& base = mesh_.layers.base[column];
    double moved = 0.0, tallest = own_step;
    for (const std::uint32_t k : base) {
      if (k == line) continue;
      moved = std::max(moved, length(k, layer + 1));
      tallest = std::max({tallest, step(k, layer), layer > 0 ? step(k, layer - 1) : 0.0});
    }
    moved += own;  // displacement of a side of the triangle from the line
    const double longest = longest_side(base_point(base[0]), base_point(base[1]), base_point(base[2]));
    const Vec3 area = area_vector(base_point(base[0]), base_point(base[1]), base_point(base[2]));
    const double off = moved * (longest + 0.5 * moved);
    normals.push_back(normalized(area));
    sum += area / 3.0;
    error += off / 3.0;
    slack = std::max(slack, off / norm(area));
    // Each cell has two dual faces beside the line. Their area is at most (|r| 13/6 + t 7/6) t / 2, with t the tallest step and r the vector from an edge's
    // midpoint to a triangle's centroid.
    const double r = 0.5 * longest + moved;
    beside += (layer > 0 ? 2.0 : 1.0) * tallest * (r * 13.0 + tallest * 7.0) / 6.0;
  }
  const double size = norm(sum);
  if (!(size > 2.0 * error)) return std::nullopt;
  // s . v <= |v + sum m_i n_i| + slack sum m_i holds for any multipliers m >= 0 and any unit step s with s . n_i >= -slack.
  Vec3 rest = sum / size;
  std::vector<double> multipliers(normals.size(), 0.0);
  for (int sweep = 0; sweep < k_multiplier_sweeps; ++sweep)
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const double change = std::max(-multipliers[i], -dot(rest, normals[i]));
      multipliers[i] += change;
      rest += change * normals[i];
    }
  double all = 0.0;
  for (const double multiplier : multipliers) all += multiplier;
  const double sine = (size * (norm(rest) + slack * all) + error) / (size - error);
  if (!(sine < 1.0)) return std::nullopt;
  const double across = (layer > 0 ? 2.0 : 1.0) * (size - error), best = std::asin(sine);
  const double bound = (across * best + beside * 0.5 * std::numbers::pi) / (across + beside);
  if (!(bound < limit)) return std::nullopt;
  return Forcing{"growth lines visible from all wall facets deviate by at least " + print_text("%.3g deg", (0.5 * std::numbers::pi - best) * k_degrees) +
                     " from the mean normal of the facets here: no orthogonality can be above " + print_text("%.3g deg", bound * k_degrees),
                 k_more_normals};
}

std::optional<GivenLayer::Room> GivenLayer::room_of(std::uint32_t line, double gap) const {
  const LayerRequest& request = mesh_.request;
  const std::vector<Vec3> normals = normals_around(line);
  const SphericalCap cap = smallest_spherical_cap(normals);
  const double lean = std::cos(std::min(cap.angle + k_lean_room, 0.5 * std::numbers::pi));
  if (!(lean > k_least_lean_cosine)) return std::nullopt;
  // The request has at least as many layers as the line. In a gap the tallest last cell follows from the actual number of layers.
  const int n = mesh_.layers.n_steps(line), n_requested = request.line_layers.empty() ? n : request.line_layers[line];
  const double growth = k_growth_room * request.max_growth_of(line);
  if (!(growth > 1.0) || n < 1) return std::nullopt;
  const double power = std::pow(growth, n), power_requested = std::pow(growth, n_requested);
  const double first = k_first_height_room * request.first_height_of(line) / lean;
  Room room;
  room.best = cap.axis;
  room.last_as_requested = room.last = first * power_requested / growth;
  room.total_as_requested = room.total = first * (power_requested - 1.0) / (growth - 1.0);
  if (gap < k_infinity) {
    room.total = std::min(room.total, std::max(gap / lean, length(line, n)));
    room.last = std::min(room.last, room.total * (1.0 - 1.0 / growth) / (1.0 - 1.0 / power));
  }
  return room;
}

std::optional<Forcing> GivenLayer::interface_height(std::size_t column, std::span<const double> gaps, double limit) const {
  const LayerBlock& layers = mesh_.layers;
  if (!layers.is_prismatic(column)) return std::nullopt;
  const int n = layers.layers_of_column(column);
  const auto& base = layers.base[column];
  std::array<Room, 3> rooms;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::optional<Room> room = room_of(base[k], gaps.empty() ? k_infinity : gaps[base[k]]);
    if (!room) return std::nullopt;
    rooms[k] = *room;
  }
  double wall = 0.0, edge = 0.0, height = 0.0;
  Room most;  // `total`: largest mean difference between the edges of the wall and the shorter edges of the layer's top
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t j = (k + 1) % 3;
    const Vec3 along = base_point(base[j]) - base_point(base[k]);
    const double from = rooms[k].most_along(along), to = rooms[j].most_along(-along);
    most.total += (from * rooms[k].total + to * rooms[j].total) / 3.0;
    most.total_as_requested += (from * rooms[k].total_as_requested + to * rooms[j].total_as_requested) / 3.0;
    most.last += rooms[k].last / 3.0;
    most.last_as_requested += rooms[k].last_as_requested / 3.0;
    wall += norm(along) / 3.0;
    edge += distance(mesh_.points[layers.top(base[k])], mesh_.points[layers.top(base[j])]) / 3.0;
    height += step(base[k], n - 1) / 3.0;
  }
  // A mesh that violates the assumptions of the bounds proves nothing.
  if (height > most.last * (1.0 + k_bound_slack) || edge < (wall - most.total) * (1.0 - k_bound_slack)) return std::nullopt;
  const double as_requested = k_regular_height * (wall - most.total_as_requested) / most.last_as_requested;
  const double in_gap = k_regular_height * (wall - most.total) / most.last;
  const std::string edges = "the wall edges are " + in_metres(wall, k_forced_digits) + " long here, ";
  if (as_requested > limit)
    return Forcing{edges + "and the requested layer has no last cell above " + in_metres(most.last_as_requested, k_forced_digits), k_request_more};
  if (in_gap > limit) return Forcing{edges + "and the gap allows no last cell above " + in_metres(most.last, k_forced_digits), k_fewer_layers};
  return std::nullopt;
}

LazyGivenLayer::LazyGivenLayer(Borrowed<const HybridMesh> mesh) : mesh_(mesh) {}
LazyGivenLayer::~LazyGivenLayer() = default;
const GivenLayer& LazyGivenLayer::get() {
  if (!given_) given_ = std::make_unique<const GivenLayer>(mesh_);
  return *given_;
}

}  // namespace sterna::check_parts
