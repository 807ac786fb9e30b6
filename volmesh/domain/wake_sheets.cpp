// Steps for each chain of trailing edges: shape (directions, chords, stations); keep (cells with enough space, such that no edge inside the sheet joins two
// boundary vertices); number; open the edge; add triangles. Both sides are slightly offset from their common base vertices, so all later steps work as on any
// thin body.
#include "volmesh/domain/wake_sheets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/base/sort_unique.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"
#include "geom/mesh/topology.h"
#include "volmesh/domain/trailing_edges.h"

namespace sterna::volmesh {
namespace {

constexpr const char* k_wake_attempt = "making wake sheets";
constexpr double k_sheet_raise = 0.01;  ///< fraction of the first height: offset of both sides from their base vertex
/// Lower limit of the offset, as a fraction of the largest coordinate: normals between both sides then have five digits.
constexpr double k_least_sheet_raise = 1e-11;
constexpr double k_blend = 1.5;         ///< number of chords over which the sheet turns into the free stream
constexpr double k_least_start = 0.25;  ///< shortest first edge along the stream, as a fraction of the edge across, to avoid sliver triangles
/// Edges at the free ends of a chain get no sheet if they are shorter than this fraction of the edges upstream, and of the chain's median edge.
constexpr double k_short_end = 0.25;
constexpr std::size_t k_least_sheet_edges = 3;  ///< smallest number of edges of a chain, with and without its short ends
constexpr double k_longest = 2.5;               ///< largest ratio of an edge along the stream to the edge across, so that the top of the layer has no slivers
/// The same ratio where edges across are shorter than the second value, a fraction of the chord.
constexpr double k_longest_fine = 3.0, k_longest_chord = 0.05;
constexpr double k_spread = 0.3;  ///< number of chords over which streamwise lines become equidistant
/// Largest sideways shift for that, as a fraction of the distance along the line; with a larger shift cells would lean and cross.
constexpr double k_spread_slope = 0.7;
constexpr double k_clear_angle = 0.3;   ///< fraction of the distance from the trailing edge: nearer walls block the sheet, unless they are farther than an edge
constexpr double k_start_share = 0.01;  ///< fraction of the first edge: nearer ray hits are on the wall at the start
constexpr std::size_t k_most_stations = 1000;
constexpr int k_shape_sweeps = 3;       ///< number of smoothing sweeps for chords along the edge
constexpr double k_shape_reach = 0.15;  ///< number of chords to both sides over which directions are averaged

/// Returns the mean length in metres of the edges that run upstream from a vertex of the trailing edge.
double upstream_edge(const TriMesh& wall, const Topology& topology, VertexId v, const Vec3& stream) {
  double sum = 0.0;
  int n = 0;
  for (const VertexId w : topology.neighbours(v)) {
    const Vec3 way = wall.points[w] - wall.points[v];
    if (dot(way, stream) > -0.5 * norm(way)) continue;
    sum += norm(way);
    ++n;
  }
  return n > 0 ? sum / n : 0.0;
}

/// A plane in which an open wall ends, and the side of it on which the wall lies.
struct BorderPlane {
  std::size_t axis = 0;
  double at = 0.0;
  double side = 1.0;
  bool is_beyond(const Point& p) const { return (p[axis] - at) * side < 0.0; }
};

std::vector<BorderPlane> border_planes(const TriMesh& wall, const Topology& topology) {
  std::map<std::pair<std::size_t, double>, std::size_t> n_edges;  // the key is axis and coordinate
  std::vector<std::array<VertexId, 2>> border;
  for (std::size_t i = 0; i < topology.n_halfedges(); ++i) {
    const HalfedgeId h(i);
    if (!topology.is_boundary(h)) continue;
    border.push_back({topology.from(h), topology.to(h)});
    for (std::size_t k = 0; k < 3; ++k)
      if (const double at = wall.points[border.back()[0]][k]; at == wall.points[border.back()[1]][k]) ++n_edges[{k, at}];
  }
  // An edge along an axis lies in two such planes. It is assigned to the plane that contains more edges.
  std::map<std::pair<std::size_t, double>, BorderPlane> planes;
  for (const auto& [a, b] : border) {
    std::optional<std::pair<std::size_t, double>> best;
    for (std::size_t k = 0; k < 3; ++k)
      if (wall.points[a][k] == wall.points[b][k] && (!best || n_edges[{k, wall.points[a][k]}] > n_edges[*best])) best = {k, wall.points[a][k]};
    if (best) planes[*best] = {best->first, best->second, 1.0};
  }
  Box box;
  for (const Point& p : wall.points) box.add(p);
  std::vector<BorderPlane> found;
  for (auto& [key, plane] : planes) {
    plane.side = 0.5 * (box.min[plane.axis] + box.max[plane.axis]) < plane.at ? -1.0 : 1.0;
    found.push_back(plane);
  }
  return found;
}

/// Makes a sheet of n x m cells behind the n edges of a chain.
class SheetMaker {
 public:
  SheetMaker(const WakeSheet& wake, const Vec3& stream, double raise, const TrailingEdge& chain, const Column<VertexId, VertexId>& partner, SheetsOnWall& made,
             TriMesh& wall, const RunContext& context)
      : wake_(wake),
        stream_(stream),
        raise_(raise),
        chain_(chain),
        partner_(partner),
        made_(made),
        wall_(wall),
        context_(context),
        topology_(wall, context),
        tree_(wall, context) {}

  /// \return true if a sheet was made. No sheet is made if it would lie in a plane in which the wall ends (such as the half of a fin in the plane of symmetry).
  /// A warning reports this
  bool make() {
    shape();
    if (is_in_border_plane()) return false;
    keep_cells();
    number();
    open_edge();
    add_triangles();
    return true;
  }

 private:
  std::size_t n_lines() const { return chain_.is_loop ? n_cells_ : n_cells_ + 1; }
  std::size_t line(std::size_t i) const { return chain_.is_loop ? i % n_cells_ : i; }
  VertexId edge_vertex(std::size_t i) const { return i < n_cells_ ? topology_.from(chain_.edges[i]) : topology_.to(chain_.edges.back()); }
  const Point& point(std::size_t i, std::size_t j) const { return points_[line(i)][j]; }

  [[noreturn]] void fail(std::string problem, std::string hint, const Point& where) const {
    throw_bad_argument(k_wake_attempt, std::move(problem), {{where, "the trailing edge"}}, std::move(hint));
  }

  // ---- Shape ------------------------------------------------------------------------------------------------------------------------------

  /// Returns the axis whose coordinate is constant along the border of the wall at the end of the chain. Returns nothing if the chain ends inside the wall.
  std::optional<std::size_t> border_axis(VertexId v) const {
    std::vector<Point> ends;
    for (const HalfedgeId h : topology_.outgoing(v)) {
      if (topology_.is_boundary(h)) ends.push_back(wall_.points[topology_.to(h)]);
      if (topology_.is_boundary(previous(h))) ends.push_back(wall_.points[topology_.from(previous(h))]);
    }
    if (ends.empty()) return std::nullopt;
    for (std::size_t k = 0; k < 3; ++k)
      if (std::ranges::all_of(ends, [&](const Point& p) { return p[k] == wall_.points[v][k]; })) return k;
    fail("a trailing edge ends at a border of the wall that is in no plane x, y or z = constant",
         "close the wall, or leave the patch of this wall out of the wake", wall_.points[v]);
  }

  template <class T, class Mean>
  void smooth_along(std::vector<T>& values, const Mean& mean) const {
    for (int sweep = 0; sweep < k_shape_sweeps; ++sweep) {
      const std::vector<T> before = values;
      for (std::size_t i = 0; i < values.size(); ++i) {
        if (!chain_.is_loop && (i == 0 || i + 1 == values.size())) continue;
        values[i] = mean(before[(i + values.size() - 1) % values.size()], before[i], before[(i + 1) % values.size()]);
      }
    }
  }

  void shape() {
    n_cells_ = chain_.edges.size();
    chords_ = local_chords(wall_, topology_, {wake_.wing, made_.sheets.n_given_triangles}, stream_, chain_);
    smooth_along(chords_, [](double a, double b, double c) { return 0.25 * a + 0.5 * b + 0.25 * c; });
    std::vector<Vec3> starts(n_lines());
    spacing_.assign(n_lines(), 0.0);
    std::vector<double> first(n_lines(), 0.0);
    for (std::size_t i = 0; i < n_lines(); ++i) {
      int n_edges = 0;
      for (const std::size_t e : {i, i + n_cells_ - 1}) {
        if (!chain_.is_loop && (i == n_cells_ ? e == i : e + 1 == n_cells_ && i == 0)) continue;
        const HalfedgeId h = chain_.edges[e % n_cells_];
        starts[i] += normal_behind(wall_, topology_, h, chain_.is_blunt, stream_);
        spacing_[i] += distance(wall_.points[topology_.to(h)], wall_.points[topology_.from(h)]);
        ++n_edges;
      }
      spacing_[i] /= n_edges;
      first[i] = std::max(upstream_edge(wall_, topology_, edge_vertex(i), stream_), k_least_start * spacing_[i]);
    }
    even_out(starts);
    const std::vector<double> shares = stations(first);
    points_.resize(n_lines());
    for (std::size_t i = 0; i < n_lines(); ++i) points_[i] = points_along(i, starts[i], shares);
    has_images_ = is_from_side_to_side();
    if (has_images_) equalise_ends();
    if (!chain_.is_loop) spread_lines();
  }

  /// Returns true if the ends of the chain are images of each other on two periodic sides. \throws if the image of an end is at another location
  bool is_from_side_to_side() const {
    if (chain_.is_loop) return false;
    const VertexId first = edge_vertex(0), last = edge_vertex(n_cells_);
    for (const auto& [end, other] : {std::array{first, last}, std::array{last, first}})
      if (partner_of(end).is_valid() && partner_of(end) != other)
        fail("a trailing edge ends at a periodic side, but its other end is not the periodic image of this end", "leave the patch of this wall out of the wake",
             wall_.points[end]);
    return partner_of(first).is_valid();
  }
  VertexId partner_of(VertexId v) const { return v.index() < partner_.size() ? partner_[v] : VertexId(); }

  /// Gives the lines at both ends the same shape, which is their mean.
  void equalise_ends() {
    std::vector<Point>&first = points_[0], &last = points_[n_cells_];
    for (std::size_t j = 1; j < first.size(); ++j) {
      const Vec3 way = 0.5 * ((first[j] - first[0]) + (last[j] - last[0]));
      first[j] = first[0] + way;
      last[j] = last[0] + way;
    }
  }

  /// Turns normals into directions. They are averaged along the trailing edge, so that a round tip does not turn the last lines. Their component along the edge
  /// is removed, so that lines do not cross.
  void even_out(std::vector<Vec3>& normals) const {
    for (Vec3& normal : normals) normal = normalized(normal);
    const std::vector<Vec3> given = normals;
    for (std::size_t i = 0; i < n_lines(); ++i) {
      const double reach = k_shape_reach * chords_[i];
      Vec3 sum = spacing_[i] * given[i];
      const auto walk = [&](int step) {
        std::size_t at = i;
        for (double way = 0.0; chain_.is_loop || (step > 0 ? at < n_cells_ : at > 0);) {
          const std::size_t beyond = (at + (step > 0 ? 1 : n_lines() - 1)) % n_lines();
          way += distance(wall_.points[edge_vertex(at)], wall_.points[edge_vertex(beyond)]);
          if (way > reach && at != i) break;
          sum += spacing_[beyond] * given[beyond];
          at = beyond;
          if (way > reach) break;
        }
        return wall_.points[edge_vertex(at)];
      };
      const Vec3 edge = walk(1) - walk(-1), across = normalized(edge - dot(edge, stream_) * stream_), normal = normalized(sum);
      const Vec3 start = stream_ - dot(stream_, normal) * normal;
      normals[i] = normalized(start - dot(start, across) * across);
    }
  }

  /// Distributes lines evenly. Short edges across the stream at the trailing edge (near a tip) are not needed behind it. Along each row, lines therefore become
  /// equidistant within k_spread chords. The sideways shift of a line is at most k_spread_slope of the distance along it.
  void spread_lines() {
    for (std::size_t j = 1; j <= n_rows(); ++j) {
      std::vector<Point> row;
      std::vector<double> at = {0.0};
      double way = 0.0, metres = 0.0;  // distance along the line, in chords and in metres
      for (std::size_t i = 0; i < n_lines(); ++i) {
        row.push_back(points_[i][j]);
        if (i > 0) at.push_back(at.back() + distance(row[i - 1], row[i]));
        const double share = distance(points_[i][j], points_[i][0]) / static_cast<double>(n_lines());
        way += share / chords_[i];
        metres += share;
      }
      const double weight = std::min(1.0, way / k_spread);
      for (std::size_t i = 1, k = 0; i + 1 < n_lines(); ++i) {
        const double even = (1.0 - weight) * at[i] + weight * at.back() * static_cast<double>(i) / static_cast<double>(n_cells_);
        const double target = std::clamp(even, at[i] - k_spread_slope * metres, at[i] + k_spread_slope * metres);
        while (at[k + 1] < target) ++k;
        points_[i][j] = row[k] + (target - at[k]) / (at[k + 1] - at[k]) * (row[k + 1] - row[k]);
      }
    }
  }

  /// Returns the stations as fractions of the length, ascending from 0 to 1. They are the same for all lines.
  std::vector<double> stations(const std::vector<double>& first) const {
    const auto mean = [](const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()); };
    const double length = wake_.length * mean(chords_), across = mean(spacing_);
    const double longest = std::max({k_longest * across, std::min(k_longest_fine * across, k_longest_chord * mean(chords_)), mean(first)});
    if (!(length > 0.0)) fail("the wing has no chord at its trailing edge", "check the direction of the free stream", wall_.points[edge_vertex(0)]);
    std::vector<double> at = {0.0};
    for (double step = mean(first); at.back() < length; step = std::min(step * wake_.growth, longest)) {
      at.push_back(at.back() + step);
      if (at.size() > k_most_stations)
        fail("a sheet of " + number_text(length, 3) + " m needs more than " + std::to_string(k_most_stations) + " rows of cells, the first " +
                 number_text(mean(first), 3) + " m long",
             "give a shorter length or a larger growth", wall_.points[edge_vertex(0)]);
    }
    const double end = at.back();
    for (double& s : at) s /= end;
    return at;
  }

  std::vector<Point> points_along(std::size_t i, Vec3 start, const std::vector<double>& shares) const {
    const VertexId v = edge_vertex(i);
    Vec3 stream = stream_;
    std::optional<std::size_t> axis;
    if (!chain_.is_loop && (i == 0 || i == n_cells_)) axis = border_axis(v);
    if (axis) {
      start[*axis] = stream[*axis] = 0.0;
      start = normalized(start);
      stream = normalized(stream);
    }
    const double length = wake_.length * chords_[i], blend = k_blend * chords_[i];
    std::vector<Point> points = {wall_.points[v]};
    for (std::size_t j = 1; j < shares.size(); ++j) {
      const double way = std::min(1.0, 0.5 * (shares[j - 1] + shares[j]) * length / blend), weight = way * way * (3.0 - 2.0 * way);
      points.push_back(points.back() + (shares[j] - shares[j - 1]) * length * normalized((1.0 - weight) * start + weight * stream));
      if (axis) points.back()[*axis] = points.front()[*axis];
    }
    return points;
  }

  /// Returns true if most lines run inside such a plane.
  bool is_in_border_plane() {
    planes_ = border_planes(wall_, topology_);
    for (const BorderPlane& plane : planes_) {
      const auto n = std::ranges::count_if(
          points_, [&](const std::vector<Point>& of_line) { return std::ranges::any_of(of_line, [&](const Point& p) { return plane.is_beyond(p); }); });
      if (2 * static_cast<std::size_t>(n) <= n_lines()) continue;
      context_.warn("no wake sheet behind the trailing edge at " + format_point(point(n_lines() / 2, 0)) + ": the sheet would lie in the plane " +
                    "xyz"[plane.axis] + std::string(" = ") + number_text(plane.at, 6) + ", in which the wall ends");
      return true;
    }
    return false;
  }

  // ---- Selection of cells -----------------------------------------------------------------------------------------------------------------

  std::size_t n_rows() const { return points_.front().size() - 1; }
  bool is_kept(std::size_t i, std::size_t j) const { return j < kept_[i]; }

  /// Returns true if no wall is near a location on a line. The trailing edge where the line starts is ignored.
  bool has_room(std::size_t i, const Point& p, double way) const {
    const double reach = std::min(k_clear_angle * way, spacing_[line(i)]);
    return !tree_.nearest(p, reach).triangle.is_valid();
  }

  bool is_beyond_a_plane(const Point& p) const {
    return std::ranges::any_of(planes_, [&](const BorderPlane& plane) { return plane.is_beyond(p); });
  }

  /// Returns true if there is no wall between two neighbours on a line.
  bool is_free(std::size_t i, std::size_t j) const {
    for (const TriangleTree::RayHit& hit : tree_.ray(point(i, j), point(i, j + 1) - point(i, j)))
      if (hit.t < 1.0 && (j > 0 || hit.t > k_start_share)) return false;
    return true;
  }

  /// Ends each column of cells where there is no space. Then removes parts that are too narrow.
  void keep_cells() {
    kept_.assign(n_cells_, 0);
    for (std::size_t i = 0; i < n_cells_; ++i)
      for (std::size_t j = 0; j < n_rows(); ++j) {
        const Point &a = point(i, j + 1), &b = point(i + 1, j + 1), middle = 0.25 * (a + b + point(i, j) + point(i + 1, j));
        const double way = std::min(distance(a, point(i, 0)), distance(b, point(i + 1, 0)));
        const double way_of_middle = 0.5 * std::min(distance(a, point(i, 0)) + distance(point(i, j), point(i, 0)),
                                                    distance(b, point(i + 1, 0)) + distance(point(i + 1, j), point(i + 1, 0)));
        if (!is_free(i, j) || !is_free(i + 1, j) || !has_room(i, a, way) || !has_room(i + 1, b, way) || !has_room(i, middle, way_of_middle) ||
            is_beyond_a_plane(a) || is_beyond_a_plane(b))
          break;
        kept_[i] = j + 1;
      }
    for (bool has_changed = true; has_changed;) {
      has_changed = false;
      if (has_images_) kept_.front() = kept_.back() = std::min(kept_.front(), kept_.back());
      for (std::size_t i = 0; i < n_cells_; ++i)
        while (kept_[i] > 0 && !is_sound(i, kept_[i])) {
          --kept_[i];
          has_changed = true;
        }
    }
    if (std::ranges::all_of(kept_, [](std::size_t n) { return n == 0; }))
      fail("there is no room for a sheet of 2 x 2 cells",
           "a wall is in the way: leave the patch of this trailing edge out of the wake, or mesh the wing with shorter edges", point(n_cells_ / 2, 0));
  }

  /// Returns true if a vertex of the grid has separate growth lines on both sides, that is, if it lies inside the sheet or on the border of the wall.
  bool is_inside(std::size_t i, std::size_t j) const {
    const bool has_left = chain_.is_loop || i > 0, has_right = chain_.is_loop || i < n_cells_;
    if ((!has_left || !has_right) && !is_at_border(i)) return false;
    for (const std::size_t column : {i + n_cells_ - 1, i}) {
      if (column + 1 == i + n_cells_ ? !has_left : !has_right) continue;
      if (!is_kept(column % n_cells_, j) || (j > 0 && !is_kept(column % n_cells_, j - 1))) return false;
    }
    return true;
  }
  bool is_at_border(std::size_t i) const {
    const VertexId v = edge_vertex(i);
    return std::ranges::any_of(topology_.outgoing(v), [&](HalfedgeId h) { return topology_.is_boundary(h) || topology_.is_boundary(previous(h)); });
  }

  /// Checks the first `n` cells of a column: each triangle must have an inner vertex, and no edge between two cells may join two boundary vertices.
  bool is_sound(std::size_t i, std::size_t n) const {
    for (std::size_t j = 0; j < n; ++j) {
      const bool a = is_inside(i, j), b = is_inside(i + 1, j), c = is_inside(i + 1, j + 1), d = is_inside(i, j + 1);
      if (!(a || c) && !(b || d)) return false;
      const auto has_both = [&](std::size_t other, std::size_t row) { return is_kept(other % n_cells_, row); };
      if (!a && !b && (j == 0 || has_both(i, j - 1))) return false;
      const bool has_right = chain_.is_loop || i + 1 < n_cells_, has_left = chain_.is_loop || i > 0;
      if (!b && !c && has_right && has_both(i + 1, j)) return false;
      if (!a && !d && has_left && has_both(i + n_cells_ - 1, j)) return false;
      const std::array inside = {a, b, c, d};
      if (!has_diagonal(inside, true) && !has_diagonal(inside, false)) return false;
    }
    return true;
  }
  /// Returns true if a cell (a, b, c, d) may be cut along a-c (`is_first`) or along b-d.
  static bool has_diagonal(const std::array<bool, 4>& inside, bool is_first) {
    const auto [a, b, c, d] = inside;
    return is_first ? a || c : b || d;
  }

  // ---- Additions to the wall --------------------------------------------------------------------------------------------------------------

  /// Returns the unit normal of the left side at a vertex of the grid.
  Vec3 normal_at(std::size_t i, std::size_t j) const {
    Vec3 sum;
    for (std::size_t column = 0; column < n_cells_; ++column) {
      if (line(column) != line(i) && line(column + 1) != line(i)) continue;
      for (std::size_t row = j == 0 ? 0 : j - 1; row <= j && row < n_rows(); ++row)
        if (is_kept(column, row)) sum += cross(point(column, row + 1) - point(column + 1, row), point(column + 1, row + 1) - point(column, row));
    }
    return normalized(sum);
  }

  /// Numbers the vertices of both sides; those of the left side come first.
  void number() {
    sides_.assign(n_lines(), std::vector<std::array<VertexId, 2>>(n_rows() + 1));
    for (std::size_t i = 0; i < n_lines(); ++i)
      for (std::size_t j = 0; j <= n_rows(); ++j) {
        if (!is_used(i, j)) continue;
        std::array<VertexId, 2>& sides = sides_[i][j];
        const bool is_base_vertex = is_inside(i, j);
        sides[0] = j == 0 ? edge_vertex(i) : wall_.points.push_back(point(i, j));
        sides[1] = is_base_vertex ? wall_.points.push_back(point(i, j)) : sides[0];
        if (is_base_vertex)
          made_.sheets.base_vertices.push_back({sides, point(i, j), start_of(i), static_cast<int>(j), wake_.height_growth, chain_.is_blunt && j == 0});
        else made_.sheets.borders.push_back(sides[0]);
      }
  }
  /// Returns the vertices of both sides on the trailing edge; the existing vertex if no layers continue there. \pre row 0 is numbered before the other rows
  std::array<VertexId, 2> start_of(std::size_t i) const {
    const std::array<VertexId, 2>& sides = sides_[i][0];
    return sides[0].is_valid() ? sides : std::array<VertexId, 2>{edge_vertex(i), edge_vertex(i)};
  }
  bool is_used(std::size_t i, std::size_t j) const {
    for (std::size_t column = 0; column < n_cells_; ++column)
      if ((line(column) == i || line(column + 1) == i) && (is_kept(column, j) || (j > 0 && is_kept(column, j - 1)))) return true;
    return false;
  }

  /// Returns the triangles to the right of the chain at one of its vertices.
  std::vector<TriangleId> on_the_right(std::size_t i) const {
    const bool has_back = chain_.is_loop || i > 0, has_ahead = chain_.is_loop || i < n_cells_;
    std::vector<TriangleId> triangles;
    if (!has_back) {  // the triangles are visited clockwise from the edge ahead to the border
      for (HalfedgeId h = topology_.twin(chain_.edges[i]); h.is_valid(); h = topology_.twin(next(h))) triangles.push_back(triangle_of(h));
      return triangles;
    }
    const HalfedgeId ahead = has_ahead ? chain_.edges[i % n_cells_] : HalfedgeId();
    for (HalfedgeId h = topology_.twin(chain_.edges[(i + n_cells_ - 1) % n_cells_]); h.is_valid() && h != ahead; h = topology_.twin(previous(h)))
      triangles.push_back(triangle_of(h));
    return triangles;
  }

  /// Separates both sides by a small offset. The triangles of the wing on the right get their own vertices.
  void open_edge() {
    std::vector<std::pair<VertexId, Vec3>> moved;
    for (std::size_t i = 0; i < n_lines(); ++i)
      for (std::size_t j = 0; j <= n_rows(); ++j) {
        const auto [left, right] = sides_[i][j];
        if (!left.is_valid() || left == right) continue;
        Vec3 normal = has_images_ && (i == 0 || i == n_cells_) ? normal_at(0, j) + normal_at(n_cells_, j) : normal_at(i, j);
        if (!chain_.is_loop && (i == 0 || i == n_cells_))
          if (const auto axis = border_axis(edge_vertex(i))) normal[*axis] = 0.0;
        moved.push_back({left, raise_ * normalized(normal)});
        moved.push_back({right, -raise_ * normalized(normal)});
        if (j > 0) continue;
        for (const TriangleId t : on_the_right(i))
          for (VertexId& corner : wall_.triangles[t])
            if (corner == left) corner = right;
      }
    for (const auto& [v, way] : moved) wall_.points[v] += way;
  }

  void add_triangles() {
    for (std::size_t i = 0; i < n_cells_; ++i)
      for (std::size_t j = 0; j < kept_[i]; ++j) {
        const std::array inside = {is_inside(i, j), is_inside(i + 1, j), is_inside(i + 1, j + 1), is_inside(i, j + 1)};
        const bool is_shorter = distance(point(i, j), point(i + 1, j + 1)) <= distance(point(i + 1, j), point(i, j + 1));
        const bool is_first = is_shorter ? has_diagonal(inside, true) : !has_diagonal(inside, false);
        for (std::size_t side = 0; side < 2; ++side) {
          const auto at = [&](std::size_t column, std::size_t row) { return sides_[line(column)][row][side]; };
          const VertexId a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
          const TriangleId source = triangle_of(side == 0 ? chain_.edges[i] : topology_.twin(chain_.edges[i]));
          if (is_first) {
            add_triangle({a, b, c}, side, source);
            add_triangle({a, c, d}, side, source);
          } else {
            add_triangle({a, b, d}, side, source);
            add_triangle({b, c, d}, side, source);
          }
        }
      }
  }
  /// \p t has the orientation of the right side
  void add_triangle(TriangleVertices t, std::size_t side, TriangleId source) {
    if (side == 0) std::swap(t[1], t[2]);
    wall_.triangles.push_back(t);
    wall_.triangle_patch.push_back(wall_.triangle_patch[source]);
    made_.sources.push_back(source);
  }

  const WakeSheet& wake_;
  const Vec3 stream_;
  double raise_;  ///< m
  const TrailingEdge& chain_;
  const Column<VertexId, VertexId>& partner_;  ///< partners of the given vertices of the wall, or empty
  SheetsOnWall& made_;
  TriMesh& wall_;
  const RunContext& context_;
  Topology topology_;  ///< topology of the wall without this sheet
  TriangleTree tree_;  ///< tree of the wall without this sheet
  std::vector<BorderPlane> planes_;
  std::size_t n_cells_ = 0;
  bool has_images_ = false;                 ///< result of is_from_side_to_side()
  std::vector<double> chords_, spacing_;    ///< m, for each line: local chord, and edge across the stream
  std::vector<std::vector<Point>> points_;  ///< points of each line, starting at the trailing edge
  std::vector<std::size_t> kept_;           ///< number of cells in each column
  std::vector<std::vector<std::array<VertexId, 2>>> sides_;
};

/// Removes the short edges of a round tip from a chain. The first edges of a sheet along the stream are as long there as elsewhere, so the triangles behind the
/// short edges would be slivers.
TrailingEdge without_short_ends(const TriMesh& wall, const Topology& topology, const Vec3& stream, TrailingEdge chain) {
  if (chain.is_loop) return chain;
  const auto length = [&](HalfedgeId h) { return distance(wall.points[topology.to(h)], wall.points[topology.from(h)]); };
  std::vector<double> lengths;
  double along = 0.0;
  for (const HalfedgeId h : chain.edges) {
    lengths.push_back(length(h));
    along += upstream_edge(wall, topology, topology.from(h), stream) / static_cast<double>(chain.edges.size());
  }
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::ranges::nth_element(lengths, middle);
  const double least = k_short_end * std::min(along, *middle);
  const auto is_short_end = [&](HalfedgeId h, VertexId end) {
    return length(h) < least &&
           std::ranges::none_of(topology.outgoing(end), [&](HalfedgeId o) { return topology.is_boundary(o) || topology.is_boundary(previous(o)); });
  };
  std::vector<HalfedgeId>& edges = chain.edges;
  while (edges.size() > k_least_sheet_edges && is_short_end(edges.back(), topology.to(edges.back()))) edges.pop_back();
  while (edges.size() > k_least_sheet_edges && is_short_end(edges.front(), topology.from(edges.front()))) edges.erase(edges.begin());
  return chain;
}

void require_patches(const TriMesh& wall, const WakeSheet& wake) {
  std::vector<std::string> names;
  for (const Patch& patch : wall.patches) names.push_back(patch.name);
  if (std::ranges::any_of(names, [&](const std::string& name) { return matches_glob(name, wake.wing); })) return;
  throw_bad_argument(k_wake_attempt, "no patch name matches \"" + wake.wing + "\"", {}, names_hint(names, wake.wing));
}

double raise_for(double first_height, const TriMesh& wall) {
  double largest = 0.0;
  for (const Point& p : wall.points) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  if (k_sheet_raise * first_height < k_least_sheet_raise * largest)
    throw_bad_argument(k_wake_attempt,
                       "the first height of " + number_text(first_height, 3) + " m is too small for coordinates of " + number_text(largest, 3) + " m", {},
                       "move the body to the origin, or leave wakes out");
  return k_sheet_raise * first_height;
}

}  // namespace

Vec3 stream_of(const TriMesh& boundary) {
  constexpr Vec3 k_along_x{1.0, 0.0, 0.0};
  Vec3 sum;
  double area = 0.0;
  for (const TriangleId t : boundary.triangles.ids()) {
    const PatchKind kind = boundary.patches[boundary.triangle_patch[t]].kind;
    if (kind == PatchKind::farfield) return k_along_x;
    if (kind != PatchKind::inflow) continue;
    const auto [a, b, c] = corners(boundary, t);
    sum += area_vector(a, b, c);
    area += norm(area_vector(a, b, c));
  }
  constexpr double k_one_way = 0.5;  // fraction of the area: if the mean normal is shorter, the stream has no direction
  return norm(sum) > k_one_way * area ? normalized(sum) : k_along_x;
}

SheetsOnWall add_wake_sheets(std::span<const WakeSheet> wakes, const Vec3& of_domain, double first_height, const Column<VertexId, VertexId>& partner,
                             TriMesh& wall, const RunContext& context) {
  SheetsOnWall made;
  made.sheets.n_given_vertices = wall.n_vertices();
  made.sheets.n_given_triangles = wall.n_triangles();
  const double raise = raise_for(first_height, wall);
  std::size_t n_chains = 0;
  for (const WakeSheet& wake : wakes) {
    require_patches(wall, wake);
    const Vec3 stream = normalized(wake.direction.value_or(of_domain));
    if (!(norm2(stream) > 0.0)) throw_bad_argument(k_wake_attempt, "the direction of the free stream is zero", {}, "give for example direction = {1, 0, 0}");
    const Topology topology(wall, context);
    std::vector<TrailingEdge> chains = find_trailing_edges(wall, topology, {wake.wing, made.sheets.n_given_triangles}, stream);
    if (chains.empty())
      throw_bad_argument(k_wake_attempt,
                         "the patches whose names match \"" + wake.wing +
                             "\" have no trailing edge: no three edges in a row at which the wall turns by more than 120 degrees and faces downstream, or "
                             "above a base narrower than a tenth of the chord",
                         {}, "check the direction of the free stream");
    // This is done before the wall is changed. Making sheets doubles vertices, but half-edges stay valid.
    for (TrailingEdge& chain : chains) chain = without_short_ends(wall, topology, stream, std::move(chain));
    for (const TrailingEdge& chain : chains) n_chains += SheetMaker(wake, stream, raise, chain, partner, made, wall, context).make() ? 1 : 0;
  }
  if (n_chains == 0)
    throw_bad_argument(k_wake_attempt, "all sheets would lie in planes in which the wall ends", {},
                       "leave the wakes out, or request them behind the wing only");
  std::ranges::sort(made.sheets.base_vertices, {}, [](const DoubledSheets::BaseVertex& base_vertex) { return base_vertex.sides[0]; });
  sort_unique(made.sheets.borders);
  context.info("wake sheets behind " + std::to_string(n_chains) + " trailing edges: " + std::to_string(made.sources.size() / 2) + " triangles");
  return made;
}

}  // namespace sterna::volmesh
