// Steps: border_of finds the border of each side; find_translation; align_absorbed_corners; add_stops, repeated until every border has the stops of its images;
// cut_into_pieces. Then each piece is linked with its image, and linked pieces are collected into kinds.
#include "surfmesh/model/periodic_borders.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "surfmesh/model/surface_sizes.h"

namespace sterna::surfmesh {
namespace {

constexpr int k_border_digits = 3;
struct BorderProjection {
  EdgeId edge;
  double t = 0.0;
  double distance = std::numeric_limits<double>::infinity();
};

struct Side {
  std::string name;
  std::vector<EdgeId> edges;  ///< edges in ascending order
};

struct Sides {
  std::array<Side, 2> side;
  Vec3 translation;  ///< from the first side to the second
};

class PeriodicBorderFinder {
 public:
  PeriodicBorderFinder(const Model& model, const Column<EdgeId, EdgeSamples>& edges, ModelTopology& topology)
      : model_(model), edges_(edges), topology_(topology) {
    Box box;
    for (const EdgeSamples& e : edges)
      for (const EdgeSample& s : e.samples) box.add(s.point);
    tolerance_ = box.empty() ? 0.0 : k_border_tolerance * box.longest_side();
  }

  PeriodicBorders find(std::span<const PeriodicNames> pairs) {
    borders_.stops.resize(model_.edges.size());
    borders_.of_edge.resize(model_.edges.size());
    for (const PeriodicNames& names : pairs) pairs_.push_back(sides_of(names));
    for (const Sides& pair : pairs_) align_absorbed_corners(pair);
    // The loop repeats because a stop may be the image of an image of a corner. With two pairs in two directions it takes two rounds.
    for (bool is_any = true; is_any;) {
      is_any = false;
      for (const Sides& pair : pairs_)
        for (const bool is_back : {false, true}) is_any = add_stops(pair, is_back) || is_any;
    }
    cut_into_pieces();
    for (const Sides& pair : pairs_) link(pair);
    gather_kinds();
    return std::move(borders_);
  }

 private:
  struct Link {
    std::size_t piece;
    Vec3 translation;
    bool is_reversed;
  };

  static ErrorInfo error_of(const std::string& first, const std::string& second) {
    return {.code = ErrorCode::bad_argument,
            .attempted = "dividing the borders of the periodic sides \"" + first + "\" and \"" + second + "\" alike",
            .hint =
                "periodic sides must be flat, face each other, and be images of each other under one translation: a body that passes through one side must "
                "pass through the other "
                "at the same location (a wing of constant section, a straight bar)"};
  }

  bool is_face(const std::string& name) const {
    return std::ranges::any_of(model_.faces, [&](const ModelFace& face) { return face.name == name; });
  }

  Sides sides_of(const PeriodicNames& names) {
    for (const std::string& name : {names.first, names.second})
      if (!is_face(name) && free_border_of(name).edges.empty()) {
        ErrorInfo info = error_of(names.first, names.second);
        info.problem = "the model has no face \"" + name + "\"";
        std::vector<std::string> known;
        for (const ModelFace& face : model_.faces) known.push_back(face.name);
        info.hint = names_hint(known, name);
        throw Error(std::move(info));
      } else if (!taken_.insert(name).second) {
        ErrorInfo info = error_of(names.first, names.second);
        info.problem = "side \"" + name + "\" is named twice; each side must have one partner";
        throw Error(std::move(info));
      }
    Sides sides{{is_face(names.first) ? border_of(names.first) : free_border_of(names.first),
                 is_face(names.second) ? border_of(names.second) : free_border_of(names.second)},
                {}};
    find_translation(sides);
    return sides;
  }

  /// Returns the edges between a face with this name and other faces; empty if there are none.
  Side border_of(const std::string& name) {
    std::map<EdgeId, int> n_uses;
    for (const FaceId f : model_.faces.ids()) {
      if (model_.faces[f].name != name || topology_.is_absorbed[f] != 0) continue;
      for (const Border& border : model_.faces[f].borders)
        for (const EdgeUse& use : border)
          if (topology_.is_point[use.edge] == 0 && !edges_[use.edge].samples.empty()) ++n_uses[topology_.same_as[use.edge].edge];
    }
    Side side{name, {}};
    for (const auto& [edge, n] : n_uses)
      if (n == 1) side.edges.push_back(edge);
    if (side.edges.empty()) {
      ErrorInfo info = error_of(name, name);
      info.attempted = "dividing the border of periodic side \"" + name + "\"";
      info.problem = "the side has no border";
      throw Error(std::move(info));
    }
    return side;
  }

  /// Returns the free edges in the plane that volume_mesh gives this name and closes by a patch; empty for other names.
  Side free_border_of(const std::string& name) const {
    Side side{name, {}};
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const bool is_max : {false, true}) {
        if (name != open_plane_name(axis, is_max)) continue;
        std::vector<EdgeId> free;
        Box box;
        for (const EdgeId e : free_edges(model_))
          if (topology_.is_point[e] == 0 && topology_.same_as[e].edge == e && !edges_[e].samples.empty()) {
            free.push_back(e);
            for (const EdgeSample& s : edges_[e].samples) box.add(s.point);
          }
        for (const EdgeId e : free)
          if (std::ranges::all_of(edges_[e].samples,
                                  [&](const EdgeSample& s) { return std::abs(s.point[axis] - (is_max ? box.max : box.min)[axis]) <= tolerance_; }))
            side.edges.push_back(e);
      }
    return side;
  }

  BorderProjection projection_on(const Side& side, const Point& p) const {
    // Edges are first selected by the distance to their polylines. Distances to the selected edges are measured to their curves.
    BorderProjection best;
    std::vector<std::pair<double, EdgeId>> near;
    for (const EdgeId e : side.edges) {
      const std::vector<EdgeSample>& s = edges_[e].samples;
      double nearest = std::numeric_limits<double>::infinity(), longest = 0.0;
      for (std::size_t k = 0; k + 1 < s.size(); ++k) {
        nearest = std::min(nearest, distance_to_segment(p, s[k].point, s[k + 1].point));
        longest = std::max(longest, distance(s[k].point, s[k + 1].point));
      }
      near.emplace_back(std::max(0.0, nearest - longest), e);  // the curve is nowhere farther from its chord than the longest chord
    }
    std::ranges::sort(near);
    for (const auto& [bound, e] : near) {
      if (bound > best.distance) break;
      const double t = nearest_parameter(model_.edges[e], edges_[e], model_.edges[e].range, p);
      if (const double d = distance(model_.edges[e].curve->point(t), p); d < best.distance) best = {e, t, d};
    }
    return best;
  }

  Box box_of(const Side& side) const {
    Box box;
    for (const EdgeId e : side.edges)
      for (const EdgeSample& s : edges_[e].samples) box.add(s.point);
    return box;
  }

  Vec3 without_rounding(Vec3 v) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (std::abs(v[k]) <= tolerance_) v[k] = 0.0;
    return v;
  }

  /// Computes the translation from the boxes. The boxes are not accurate enough if circles were sampled at other locations. In that case the translation is
  /// corrected by the distances across the borders.
  void find_translation(Sides& sides) {
    const Box here = box_of(sides.side[0]), there = box_of(sides.side[1]);
    sides.translation = without_rounding(0.5 * (there.min - here.min) + 0.5 * (there.max - here.max));
    const Vec3 by_boxes = sides.translation;
    constexpr int k_corrections = 12;
    for (int i = 0; i < k_corrections && largest_distance(sides) > tolerance_; ++i) sides.translation = without_rounding(sides.translation + correction(sides));
    if (largest_distance(sides) > tolerance_) {
      sides.translation = by_boxes;
      fail_distances(sides);
    }
  }

  double largest_distance(const Sides& sides) const {
    double largest = 0.0;
    for (const EdgeId e : sides.side[0].edges)
      for (const EdgeSample& s : edges_[e].samples) largest = std::max(largest, projection_on(sides.side[1], s.point + sides.translation).distance);
    for (const EdgeId e : sides.side[1].edges)
      for (const EdgeSample& s : edges_[e].samples) largest = std::max(largest, projection_on(sides.side[0], s.point - sides.translation).distance);
    return largest;
  }

  /// Returns the correction of the translation as the least-squares solution for the remaining distances across the second border. The matrix is the sum of (I
  /// - t t^T).
  Vec3 correction(const Sides& sides) const {
    std::array<Vec3, 3> matrix{};
    Vec3 right;
    for (const EdgeId e : sides.side[0].edges)
      for (const EdgeSample& s : edges_[e].samples) {
        const Point p = s.point + sides.translation;
        const BorderProjection projection = projection_on(sides.side[1], p);
        const CurveDerivatives d = model_.edges[projection.edge].curve->derivatives(projection.t);
        if (!(norm2(d.first) > 0.0)) continue;
        const Vec3 along = normalized(d.first), off = d.point - p;
        for (std::size_t k = 0; k < 3; ++k) {
          matrix[k][k] += 1.0;
          matrix[k] -= along[k] * along;
        }
        right += off - dot(off, along) * along;
      }
    const double determinant = dot(matrix[0], cross(matrix[1], matrix[2]));
    if (!(std::abs(determinant) > 0.0)) return {};
    return Vec3{dot(right, cross(matrix[1], matrix[2])), dot(right, cross(matrix[2], matrix[0])), dot(right, cross(matrix[0], matrix[1]))} / determinant;
  }

  [[noreturn]] void fail_distances(const Sides& sides) const {
    ErrorInfo info = error_of(sides.side[0].name, sides.side[1].name);
    double worst = 0.0;
    const auto look = [&](const Side& from, const Side& to, const Vec3& way) {
      for (const EdgeId e : from.edges) {
        BorderProjection farthest{e, 0.0, 0.0};
        Point location;
        for (const EdgeSample& s : edges_[e].samples)
          if (const double d = projection_on(to, s.point + way).distance; d > farthest.distance) {
            farthest.distance = d;
            location = s.point;
          }
        worst = std::max(worst, farthest.distance);
        if (farthest.distance <= tolerance_) continue;
        ++info.n_locations;
        if (info.locations.size() < k_max_locations)
          info.locations.push_back({location, "the border of \"" + to.name + "\" is " + in_metres(farthest.distance, k_border_digits) + " off its image"});
      }
    };
    look(sides.side[0], sides.side[1], sides.translation);
    look(sides.side[1], sides.side[0], -sides.translation);
    info.problem = std::to_string(info.n_locations) + " edges have no image within " + in_metres(tolerance_, k_border_digits) + ", the largest deviation is " +
                   in_metres(worst, k_border_digits) + " (the sides are " + format_point(sides.translation) + " m apart)";
    throw Error(std::move(info));
  }

  std::set<CornerId> corners_of(const Side& side) const {
    std::set<CornerId> corners;
    for (const EdgeId e : side.edges)
      for (const CornerId c : {model_.edges[e].start, model_.edges[e].end}) corners.insert(topology_.corner[c]);
    return corners;
  }

  /// Aligns the corners that short edges merged: remaining corners on the second side must be the images of those on the first side.
  void align_absorbed_corners(const Sides& sides) {
    const std::set<CornerId> here = corners_of(sides.side[0]), there = corners_of(sides.side[1]);
    for (const CornerId c : here) {
      const Point image = model_.corners[c].point + sides.translation;
      if (std::ranges::any_of(there, [&](CornerId d) { return distance(model_.corners[d].point, image) <= tolerance_; })) continue;
      for (const CornerId d : model_.corners.ids()) {
        const CornerId stands = topology_.corner[d];
        if (stands == d || !there.contains(stands) || distance(model_.corners[d].point, image) > tolerance_) continue;
        for (CornerId& other : topology_.corner)
          if (other == stands) other = d;
        break;
      }
    }
  }

  bool add_stops(const Sides& sides, bool is_back) {
    const Side &from = sides.side[is_back ? 1 : 0], &to = sides.side[is_back ? 0 : 1];
    const Vec3 way = is_back ? -sides.translation : sides.translation;
    std::vector<Point> target;
    for (const CornerId c : corners_of(from)) target.push_back(model_.corners[c].point + way);
    for (const EdgeId e : from.edges)
      for (const BorderStop& stop : borders_.stops[e]) target.push_back(stop.point + way);
    const std::set<CornerId> corners = corners_of(to);
    bool is_any = false;
    for (const Point& p : target) {
      const auto is_there = [&](const Point& q) { return distance(p, q) <= tolerance_; };
      if (std::ranges::any_of(corners, [&](CornerId c) { return is_there(model_.corners[c].point); })) continue;
      const BorderProjection projection = projection_on(to, p);
      std::vector<BorderStop>& stops = borders_.stops[projection.edge];
      if (std::ranges::any_of(stops, [&](const BorderStop& stop) { return is_there(stop.point); })) continue;
      const Interval range = model_.edges[projection.edge].range;
      if (projection.distance > tolerance_ || !(projection.t > range.from && projection.t < range.to)) fail_corner(sides, p - way, from, to, p);
      stops.push_back({projection.t, p});
      std::ranges::sort(stops, {}, &BorderStop::t);
      is_any = true;
    }
    return is_any;
  }

  [[noreturn]] void fail_corner(const Sides& sides, const Point& corner, const Side& from, const Side& to, const Point& image) const {
    ErrorInfo info = error_of(sides.side[0].name, sides.side[1].name);
    double nearest = std::numeric_limits<double>::infinity();
    for (const CornerId c : corners_of(to)) nearest = std::min(nearest, distance(model_.corners[c].point, image));
    info.problem = "a corner on \"" + from.name + "\" has no image within " + in_metres(tolerance_, k_border_digits) + " on \"" + to.name +
                   "\"; the nearest corner there is " + in_metres(nearest, k_border_digits) + " off the image";
    info.n_locations = 1;
    info.locations.push_back({corner, "the corner"});
    throw Error(std::move(info));
  }

  void cut_into_pieces() {
    std::set<EdgeId> all;
    for (const Sides& pair : pairs_)
      for (const Side& side : pair.side) all.insert(side.edges.begin(), side.edges.end());
    for (const EdgeId e : all) {
      borders_.of_edge[e] = {borders_.pieces.size(), borders_.stops[e].size() + 1};
      double from = model_.edges[e].range.from;
      for (const BorderStop& stop : borders_.stops[e]) {
        borders_.pieces.push_back({e, {from, stop.t}, borders_.pieces.size(), {}, false});
        from = stop.t;
      }
      borders_.pieces.push_back({e, {from, model_.edges[e].range.to}, borders_.pieces.size(), {}, false});
    }
    links_.resize(borders_.pieces.size());
  }

  void link(const Sides& sides) {
    for (const EdgeId e : sides.side[0].edges)
      for (std::size_t i = 0; i < borders_.of_edge[e][1]; ++i) {
        const std::size_t here = borders_.of_edge[e][0] + i;
        const Interval range = borders_.pieces[here].range;
        const auto image = [&](double share) {
          return projection_on(sides.side[1], model_.edges[e].curve->point(range.from + share * range.length()) + sides.translation);
        };
        const BorderProjection middle = image(0.5);
        const auto [first, n] = borders_.of_edge[middle.edge];
        std::size_t there = first;
        while (there + 1 < first + n && middle.t > borders_.pieces[there].range.to) ++there;
        const double before = nearest_parameter(model_.edges[middle.edge], edges_[middle.edge], borders_.pieces[there].range,
                                                model_.edges[e].curve->point(range.from + 0.4 * range.length()) + sides.translation);
        const bool is_reversed = before > middle.t;
        links_[here].push_back({there, sides.translation, is_reversed});
        links_[there].push_back({here, -sides.translation, is_reversed});
      }
  }

  void gather_kinds() {
    std::vector<std::uint8_t> is_met(borders_.pieces.size(), 0);
    for (std::size_t first = 0; first < borders_.pieces.size(); ++first) {
      if (is_met[first] != 0) continue;
      is_met[first] = 1;
      std::vector<std::size_t> kind{first};
      for (std::size_t next = 0; next < kind.size(); ++next) {
        const PeriodicPiece from = borders_.pieces[kind[next]];
        for (const Link& link : links_[kind[next]]) {
          if (is_met[link.piece] != 0) continue;
          is_met[link.piece] = 1;
          PeriodicPiece& piece = borders_.pieces[link.piece];
          piece.like = first;
          piece.translation = without_rounding(from.translation + link.translation);
          piece.is_reversed = from.is_reversed != link.is_reversed;
          kind.push_back(link.piece);
        }
      }
      std::ranges::sort(kind);
      if (kind.size() > 1) borders_.kinds.push_back(std::move(kind));
    }
  }

  const Model& model_;
  const Column<EdgeId, EdgeSamples>& edges_;
  ModelTopology& topology_;
  double tolerance_ = 0.0;
  std::set<std::string> taken_;
  std::vector<Sides> pairs_;
  std::vector<std::vector<Link>> links_;
  PeriodicBorders borders_;
};

}  // namespace

PeriodicBorders find_periodic_borders(const Model& model, const Column<EdgeId, EdgeSamples>& edges, std::span<const PeriodicNames> pairs,
                                      ModelTopology& topology) {
  return PeriodicBorderFinder(model, edges, topology).find(pairs);
}

std::string open_plane_name(std::size_t axis, bool is_max) { return std::string("symmetry_") + "xyz"[axis] + (is_max ? "_max" : "_min"); }

bool is_open_plane(std::string_view name) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (name == open_plane_name(axis, false) || name == open_plane_name(axis, true)) return true;
  return false;
}

double nearest_parameter(const ModelEdge& edge, const EdgeSamples& samples, const Interval& range, const Point& p) {
  const std::vector<EdgeSample>& s = samples.samples;
  double nearest = std::numeric_limits<double>::infinity(), t = range.from, low = range.from, high = range.to;
  for (std::size_t k = 0; k + 1 < s.size(); ++k) {
    const double from = std::max(s[k].t, range.from), to = std::min(s[k + 1].t, range.to);
    if (!(to > from)) continue;
    const Point a = from == s[k].t ? s[k].point : edge.curve->point(from), b = to == s[k + 1].t ? s[k + 1].point : edge.curve->point(to);
    const double d = distance_to_segment(p, a, b);
    if (d >= nearest) continue;
    nearest = d;
    const double length2 = norm2(b - a);
    t = from + (length2 > 0.0 ? std::clamp(dot(p - a, b - a) / length2, 0.0, 1.0) : 0.0) * (to - from);
    low = std::max(range.from, from - (to - from));
    high = std::min(range.to, to + (to - from));
  }
  // Newton's method for (c - p) . c' = 0, limited to the neighbours of the nearest chord.
  constexpr int k_steps = 30;
  constexpr double k_still = 1e-15;  // relative to the range: a smaller step ends the iteration
  for (int i = 0; i < k_steps; ++i) {
    const CurveDerivatives d = edge.curve->derivatives(t);
    const Vec3 off = d.point - p;
    const double slope = dot(off, d.first), bend = norm2(d.first) + dot(off, d.second);
    if (!(bend > 0.0)) break;
    const double next = std::clamp(t - slope / bend, low, high);
    const bool is_still = std::abs(next - t) <= k_still * range.length();
    t = next;
    if (is_still) break;
  }
  double least = distance(edge.curve->point(t), p);
  for (const double end : {range.from, range.to})
    if (const double d = distance(edge.curve->point(end), p); d < least) {
      least = d;
      t = end;
    }
  return t;
}

double image_parameter(const PeriodicBorders& periodic_borders, std::size_t piece, double t, const Model& model, const Column<EdgeId, EdgeSamples>& edges) {
  const PeriodicPiece &here = periodic_borders.pieces[piece], &first = periodic_borders.pieces[here.like];
  if (here.like == piece) return t;
  return nearest_parameter(model.edges[here.edge], edges[here.edge], here.range, model.edges[first.edge].curve->point(t) + here.translation);
}

std::vector<SizePoint> sizes_of_partners(const PeriodicBorders& periodic_borders, const Model& model, const Column<EdgeId, EdgeSamples>& edges,
                                         const SurfaceSizes& field) {
  constexpr double k_equal = 0.98;  // relative to the size of the piece: a smallest size above this requires no source
  constexpr double k_most_between = 512.0;
  std::vector<SizePoint> size_points;
  for (const std::vector<std::size_t>& kind : periodic_borders.kinds) {
    const PeriodicPiece& first = periodic_borders.pieces[kind.front()];
    const ModelEdge& edge = model.edges[first.edge];
    const auto look = [&](double t) {
      std::vector<double> own;
      std::vector<Point> locations;
      for (const std::size_t piece : kind) {
        const double at = image_parameter(periodic_borders, piece, t, model, edges);
        own.push_back(field.on_edge(periodic_borders.pieces[piece].edge, at));
        locations.push_back(model.edges[periodic_borders.pieces[piece].edge].curve->point(at));
      }
      const double least = *std::ranges::min_element(own);
      for (std::size_t i = 0; i < kind.size(); ++i)
        if (least < k_equal * own[i]) size_points.push_back({locations[i], least});
      return least;
    };
    std::vector<double> ends{first.range.from};
    for (const EdgeSample& s : edges[first.edge].samples)
      if (s.t > first.range.from && s.t < first.range.to) ends.push_back(s.t);
    ends.push_back(first.range.to);
    double before = look(ends.front());
    for (std::size_t i = 1; i < ends.size(); ++i) {
      const double after = look(ends[i]);
      const double n = std::min(k_most_between, std::ceil(distance(edge.curve->point(ends[i - 1]), edge.curve->point(ends[i])) / std::min(before, after)));
      for (double k = 1.0; k < n; k += 1.0) look(ends[i - 1] + k / n * (ends[i] - ends[i - 1]));
      before = after;
    }
  }
  return size_points;
}

}  // namespace sterna::surfmesh
