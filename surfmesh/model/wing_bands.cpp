// 1. gather_sides   finds how each edge lies to its adjacent faces: turn, outward direction, curvature across
// 2. find_strips    finds the bases of blunt trailing edges for which options require cells or a band
// 3. find_edges     finds leading edges (smooth between two faces, most curved, facing forward) and trailing edges (sharp and facing aft, or the long sides of
// a base)
// 4. join_at_corners  finds corners across which a band continues, and edges that are columns of the band there
// 5. set_spacing    sets the segment lengths along the edges: from the stretch, the edge's own curvature and the chord, and small at the ends
#include "surfmesh/model/wing_bands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "geom/delaunay/face_state.h"
#include "geom/math/constants.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_infinite = std::numeric_limits<double>::infinity();
constexpr double k_smooth_turn = 20.0 * k_degree;
/// Largest useful stretch: more stretched triangles have no benefit, even below prisms (docs/method/surface.md, "Wing edges and bands").
constexpr double k_largest_stretch = 50.0;
/// A use of an edge, or of the edge on the other side of an absorbed strip.
struct Side {
  EdgeUseLocation location;
  bool is_against = false;  ///< the edge of this use runs against the edge that represents both
};

struct Look {
  Vec3 normal;   ///< outward normal, as defined by the model
  Vec3 inwards;  ///< direction along the surface, from the edge into the face
  Vec3 bend;     ///< 1/m: curvature of the surface in the direction `inwards`, as a vector towards the centre of curvature
  bool is_valid = false;
};

Look look(const Model& model, const Side& side, double share) {
  const ModelFace& face = model.faces[side.location.face];
  const EdgeUse& use = face.borders[side.location.border][side.location.location];
  const Interval range = model.edges[use.edge].range;
  const double t = side.is_against ? range.to - share * range.length() : range.from + share * range.length();
  const ParameterCurveDerivatives p = use.parameter->derivatives(t);
  const SurfaceDerivatives d = face.surface->derivatives(p.point);
  const Vec3 normal = cross(d.du, d.dv), tangent = (use.is_reversed ? -1.0 : 1.0) * (p.first.u * d.du + p.first.v * d.dv);
  Look result;
  if (!(norm2(normal) > 0.0) || !(norm2(tangent) > 0.0) || !is_finite(normal)) return result;
  result.is_valid = true;
  const Vec3 unit = normalized(normal);
  result.inwards = normalized(cross(unit, tangent));
  result.normal = face.is_reversed ? -unit : unit;
  const Uv w = delaunay::parameter_step({d.du, d.dv, unit}, result.inwards);
  const double second = dot(w.u * w.u * d.duu + 2.0 * w.u * w.v * d.duv + w.v * w.v * d.dvv, unit);
  if (std::isfinite(second)) result.bend = second * unit;
  return result;
}

/// Measures of an edge's shape. They are the same for the faces of a solid and for the faces of the fluid around it, whose normals are opposite.
struct BandShape {
  std::size_t n_smooth = 0, n_sharp = 0;
  int n_base = 0;          ///< number of convex edges minus number of concave edges
  double looks = 0.0;      ///< mean x of the outward direction of the edge
  double curvature = 0.0;  ///< mean curvature across the edge, on the side where it is less
};

BandShape shape_of(const Model& model, const Side& a, const Side& b) {
  BandShape shape;
  int n = 0;
  for (std::size_t k = 1; k <= k_looks; ++k) {
    const double share = static_cast<double>(k) / (k_looks + 1);
    const Look p = look(model, a, share), q = look(model, b, share);
    if (!p.is_valid || !q.is_valid) continue;
    ++n;
    const double turn = angle_between(p.normal, q.normal);
    const bool is_convex = dot(p.normal, q.inwards) < 0.0;
    if (turn < k_smooth_turn) ++shape.n_smooth;
    if (turn > k_sharp_turn) ++shape.n_sharp;
    if (turn > k_base_turn_from && turn < k_base_turn_to) shape.n_base += is_convex ? 1 : -1;
    const Vec3 ahead = turn < k_smooth_turn ? -1.0 * (p.bend + q.bend) : -1.0 * (p.inwards + q.inwards);
    if (norm2(ahead) > 0.0) shape.looks += normalized(ahead).x;
    shape.curvature += std::min(norm(p.bend), norm(q.bend));
  }
  if (n > 0) {
    shape.looks /= n;
    shape.curvature /= n;
  }
  return shape;
}

bool may_be_wing(const Model& model, FaceId f) {
  const ModelFace& face = model.faces[f];
  switch (face.role) {
    case FaceRole::unknown:
    case FaceRole::skin:
    case FaceRole::upper:
    case FaceRole::lower:
    case FaceRole::leading_edge:
    case FaceRole::trailing_edge:
    case FaceRole::control: break;
    default: return false;
  }
  if (!face.component.is_valid()) return true;
  const ComponentKind kind = model.components[face.component].kind;
  return kind == ComponentKind::unknown || kind == ComponentKind::wing || kind == ComponentKind::pylon || kind == ComponentKind::nacelle;
}

struct End {
  EdgeId edge;
  int end = 0;
};

struct Finding {
  const Model& model;
  const Column<EdgeId, EdgeSamples>& edges;
  const ModelSizes& sizes;
  const ModelTopology& topology;
  WingBands bands;
  Column<EdgeId, std::vector<Side>> sides;  ///< sides of the edges that represent themselves, on faces that remain

  const FaceSizes& of(const Side& side) const { return sizes.faces[side.location.face]; }
  bool is_strip(const Side& side) const { return bands.strips[side.location.face].has_value(); }
  CornerId corner(End e) const { return topology.corner[e.end == 0 ? model.edges[e.edge].start : model.edges[e.edge].end]; }
};

void gather_sides(Finding& finding) {
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(finding.model);
  finding.sides.resize(finding.model.edges.size());
  for (const EdgeId e : finding.model.edges.ids()) {
    const SameEdge& same = finding.topology.same_as[e];
    if (finding.topology.is_point[e] != 0 || finding.edges[e].samples.empty()) continue;
    for (const EdgeUseLocation& location : uses[e])
      if (finding.topology.is_absorbed[location.face] == 0) finding.sides[same.edge].push_back({location, same.is_reversed});
  }
}

const Side* other_side(const std::vector<Side>& sides, FaceId f) {
  if (sides.size() != 2) return nullptr;
  if (sides[0].location.face == f && sides[1].location.face == f) return nullptr;
  return sides[0].location.face == f ? &sides[1] : &sides[0];
}

double area_of(const Finding& finding, FaceId f) { return finding.sizes.faces[f].curvature->area(); }

/// Returns the two long sides of a face that is a base; sets no other member of the result.
std::optional<BaseStrip> strip_of(const Finding& finding, FaceId f) {
  const Model& model = finding.model;
  const ModelFace& face = model.faces[f];
  if (face.borders.size() != 1 || !may_be_wing(model, f) || finding.topology.is_absorbed[f] != 0) return std::nullopt;
  struct Use {
    std::size_t at;
    EdgeId edge;
    double length;
  };
  std::vector<Use> uses;
  for (std::size_t i = 0; i < face.borders[0].size(); ++i) {
    const EdgeId e = finding.topology.same_as[face.borders[0][i].edge].edge;
    if (finding.topology.is_point[face.borders[0][i].edge] == 0) uses.push_back({i, e, finding.edges[e].length});
  }
  if (uses.size() != 3 && uses.size() != 4) return std::nullopt;
  std::size_t a = 0, b = 2;
  if (uses.size() == 4 && uses[1].length + uses[3].length > uses[0].length + uses[2].length) a = 1, b = 3;
  if (uses.size() == 3) {
    const std::size_t shortest =
        static_cast<std::size_t>(std::min_element(uses.begin(), uses.end(), [](const Use& p, const Use& q) { return p.length < q.length; }) - uses.begin());
    a = shortest == 0 ? 1 : 0;
    b = shortest == 2 ? 1 : 2;
  }
  BaseStrip strip{.long_edge = {uses[a].edge, uses[b].edge}};
  const double length = 0.5 * (uses[a].length + uses[b].length);
  strip.width = area_of(finding, f) / length;
  double looks = 0.0;
  int n_base = 0;
  for (const Use& use : {uses[a], uses[b]}) {
    const std::vector<Side>& sides = finding.sides[use.edge];
    const Side* other = other_side(sides, f);
    if (!other || !may_be_wing(model, other->location.face)) return std::nullopt;
    n_base += shape_of(model, sides[0], sides[1]).n_base;
    if (face.role != FaceRole::trailing_edge && strip.width > k_strip_width * area_of(finding, other->location.face) / use.length) return std::nullopt;
    looks -= 0.5 * look(model, *other, 0.5).inwards.x;
  }
  if (std::abs(n_base) < 2 * static_cast<int>(k_agreeing) || looks < k_looks_along) return std::nullopt;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    if (i == a || i == b) continue;
    if (k_strip_length * uses[i].length > std::min(uses[a].length, uses[b].length)) return std::nullopt;
    strip.short_edges.push_back(uses[i].edge);
  }
  const auto runs_with_border = [&](std::size_t at) {
    const EdgeUse& use = face.borders[0][at];
    return use.is_reversed == finding.topology.same_as[use.edge].is_reversed;
  };
  // Both uses follow the border, so along the strip they run against each other. Edges that both run with their border therefore have opposite parameters.
  strip.is_against = runs_with_border(uses[a].at) == runs_with_border(uses[b].at);
  return strip;
}

void find_strips(Finding& finding) {
  for (const FaceId f : finding.model.faces.ids()) {
    std::optional<BaseStrip> strip = strip_of(finding, f);
    if (!strip) {
      if (finding.topology.is_absorbed[f] != 0 && finding.model.faces[f].role == FaceRole::trailing_edge &&
          !is_automatic(finding.sizes.faces[f].trailing_cells))
        finding.bands.notes.push_back("the base of \"" + finding.model.faces[f].name +
                                      "\" is too narrow for cells (use a smaller min_edge); its trailing edge is sharp in the mesh");
      continue;
    }
    double cells = finding.sizes.faces[f].trailing_cells;
    BandTarget target = finding.sizes.faces[f].trailing;
    for (const EdgeId e : strip->long_edge) {
      const Side* other = other_side(finding.sides[e], f);
      if (is_automatic(cells)) cells = finding.of(*other).trailing_cells;
      target = both(target, finding.of(*other).trailing);
    }
    if (is_automatic(cells) && !target.is_any()) continue;
    // If the number is not given, cells are about square beside the first row.
    if (is_automatic(cells)) cells = std::max(1.0, strip->width / target.first_height(finding.sizes.faces[f].max_edge));
    strip->n_cells = static_cast<std::size_t>(std::max(1.0, std::round(cells)));
    for (const EdgeId e : strip->short_edges) finding.bands.n_short[e] = std::max(finding.bands.n_short[e], strip->n_cells);
    finding.bands.strips[f] = std::move(strip);
  }
  const bool is_requested =
      std::any_of(finding.sizes.faces.begin(), finding.sizes.faces.end(), [](const FaceSizes& face) { return !is_automatic(face.trailing_cells); });
  const bool is_found =
      std::any_of(finding.bands.strips.begin(), finding.bands.strips.end(), [](const std::optional<BaseStrip>& strip) { return strip.has_value(); });
  if (is_requested && !is_found && finding.bands.notes.empty())
    finding.bands.notes.push_back(
        "trailing_edge_cells has no effect: no face of the model is the base of a blunt trailing edge (four sides, narrow, facing aft)");
  // A short side that two strips share gets the number of cells of the finer strip. The other strip, and its neighbours along the span, follow.
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (std::optional<BaseStrip>& strip : finding.bands.strips) {
      if (!strip) continue;
      for (const EdgeId e : strip->short_edges)
        if (finding.bands.n_short[e] > strip->n_cells) {
          strip->n_cells = finding.bands.n_short[e];
          is_changed = true;
        }
      for (const EdgeId e : strip->short_edges) finding.bands.n_short[e] = strip->n_cells;
    }
  }
}

/// Returns the kind of the edge if it is a leading or trailing edge.
std::optional<BandKind> kind_of(const Finding& finding, EdgeId e) {
  const Model& model = finding.model;
  const std::vector<Side>& sides = finding.sides[e];
  if (sides.size() != 2) return std::nullopt;
  for (const Side& side : sides)
    if (!may_be_wing(model, side.location.face)) return std::nullopt;
  const bool is_strip = finding.is_strip(sides[0]) || finding.is_strip(sides[1]);
  if (is_strip) {
    for (const Side& side : sides)
      if (const auto& strip = finding.bands.strips[side.location.face]; strip && (strip->long_edge[0] == e || strip->long_edge[1] == e))
        return BandKind::trailing;
    return std::nullopt;
  }
  const BandShape shape = shape_of(model, sides[0], sides[1]);
  if (shape.n_sharp >= k_agreeing && std::abs(shape.looks) > k_looks_along) return shape.looks > 0.0 ? BandKind::trailing : BandKind::leading;
  if (shape.n_smooth < k_agreeing || shape.looks > -k_looks_along) return std::nullopt;
  const FaceRole a = model.faces[sides[0].location.face].role, b = model.faces[sides[1].location.face].role;
  const bool is_known = (a == FaceRole::upper && b == FaceRole::lower) || (a == FaceRole::lower && b == FaceRole::upper);
  double width = k_infinite;
  for (const Side& side : sides) width = std::min(width, area_of(finding, side.location.face) / finding.edges[e].length);
  return is_known || shape.curvature * width * k_nose_radius >= 1.0 ? std::optional(BandKind::leading) : std::nullopt;
}

void find_edges(Finding& finding) {
  for (const EdgeId e : finding.model.edges.ids()) {
    const std::vector<Side>& sides = finding.sides[e];
    if (sides.size() != 2) continue;
    const FaceSizes &p = finding.of(sides[0]), &q = finding.of(sides[1]);
    if (!p.leading.is_any() && !q.leading.is_any() && !p.trailing.is_any() && !q.trailing.is_any()) continue;
    const std::optional<BandKind> kind = kind_of(finding, e);
    if (!kind) continue;
    const BandTarget target = *kind == BandKind::leading ? both(p.leading, q.leading) : both(p.trailing, q.trailing);
    if (!target.is_any()) continue;
    BandEdge band{.kind = *kind, .growth = target.growth};
    const double max_edge = std::min(p.max_edge, q.max_edge);
    band.first = std::min(max_edge, target.first_height(max_edge));
    band.longest = target.longest(max_edge);
    for (const Side& side : sides)
      if (const auto& strip = finding.bands.strips[side.location.face])
        band.longest = std::min(band.longest, k_largest_stretch * strip->width / static_cast<double>(strip->n_cells));
    finding.bands.edges[e] = std::move(band);
    finding.bands.is_unused = false;
    for (const Side& side : sides)
      if (!finding.is_strip(side)) finding.bands.bands_of_face[side.location.face].push_back(e);
  }
}

/// Returns the unit direction away from the corner.
Vec3 direction_at(const Finding& finding, End end) {
  const ModelEdge& edge = finding.model.edges[end.edge];
  constexpr double k_step = 1e-3;
  const double from = end.end == 0 ? edge.range.from : edge.range.to;
  return normalized(edge.curve->point(from + (end.end == 0 ? k_step : -k_step) * edge.range.length()) - edge.curve->point(from));
}

bool is_short_of_strips(const Finding& finding, EdgeId e) {
  return finding.bands.n_short[e] > 0 && finding.sides[e].size() == 2 && finding.is_strip(finding.sides[e][0]) && finding.is_strip(finding.sides[e][1]);
}

/// Returns true if the band of two edge ends continues across their corner. The other edges at the corner are then cut as columns of the band.
bool goes_on(Finding& finding, End a, End b, const std::vector<End>& at_corner) {
  const BandEdge &p = *finding.bands.edges[a.edge], &q = *finding.bands.edges[b.edge];
  const Vec3 along = direction_at(finding, a), back = direction_at(finding, b);
  if (p.kind != q.kind || angle_between(along, -1.0 * back) > k_largest_kink) return false;
  std::vector<End> crossings;
  for (const End& end : at_corner) {
    if ((end.edge == a.edge && end.end == a.end) || (end.edge == b.edge && end.end == b.end) || is_short_of_strips(finding, end.edge)) continue;
    const Vec3 across = direction_at(finding, end);
    const double sine = std::min(norm(cross(across, along)), norm(cross(across, back)));
    // Tests if the edge has rows on both sides.
    const auto has_rows = [&](const Side& side) {
      const auto& list = finding.bands.bands_of_face[side.location.face];
      return std::find(list.begin(), list.end(), a.edge) != list.end() || std::find(list.begin(), list.end(), b.edge) != list.end();
    };
    const std::vector<Side>& sides = finding.sides[end.edge];
    if (sine < k_steep_sine || sides.size() != 2 || !has_rows(sides[0]) || !has_rows(sides[1])) return false;
    crossings.push_back(end);
  }
  for (const End& end : crossings) {
    RowLaw law{std::min(p.first, q.first), std::min(p.growth, q.growth), finding.of(finding.sides[end.edge][0]).limits};
    law.limits.take_less(finding.of(finding.sides[end.edge][1]).limits);
    finding.bands.crossings[end.edge][static_cast<std::size_t>(end.end)] = {law, std::min(p.longest, q.longest), {along, back}, true};
  }
  return true;
}

void join_at_corners(Finding& finding) {
  Column<CornerId, std::vector<End>> ends(finding.model.corners.size());
  Column<CornerId, std::uint8_t> has_pole(finding.model.corners.size(), 0);
  const Column<EdgeId, std::vector<EdgeUseLocation>> uses = uses_of_edges(finding.model);
  for (const EdgeId e : finding.model.edges.ids()) {
    if (!finding.sides[e].empty())
      for (const int end : {0, 1}) ends[finding.corner({e, end})].push_back({e, end});
    else if (finding.topology.is_point[e] != 0 && !uses[e].empty()) has_pole[finding.corner({e, 0})] = 1;
  }
  for (const CornerId c : finding.model.corners.ids()) {
    std::vector<End> of_bands;
    for (const End& end : ends[c])
      if (finding.bands.edges[end.edge]) of_bands.push_back(end);
    if (of_bands.size() == 2 && has_pole[c] == 0 && goes_on(finding, of_bands[0], of_bands[1], ends[c])) continue;
    for (const End& end : of_bands) finding.bands.edges[end.edge]->is_ending[static_cast<std::size_t>(end.end)] = true;
  }
}

/// Returns the distance in metres along bands from each corner to the nearest end of its band.
Column<CornerId, double> ways_to_ends(const Finding& finding) {
  Column<CornerId, double> way(finding.model.corners.size(), k_infinite);
  for (const EdgeId e : finding.model.edges.ids())
    for (const std::size_t end : {0u, 1u})
      if (finding.bands.edges[e] && finding.bands.edges[e]->is_ending[end]) way[finding.corner({e, static_cast<int>(end)})] = 0.0;
  for (bool is_changed = true; is_changed;) {
    is_changed = false;
    for (const EdgeId e : finding.model.edges.ids()) {
      if (!finding.bands.edges[e]) continue;
      double &a = way[finding.corner({e, 0})], &b = way[finding.corner({e, 1})];
      const double to_a = std::min(a, b + finding.edges[e].length), to_b = std::min(b, a + finding.edges[e].length);
      is_changed = is_changed || to_a < a || to_b < b;
      a = to_a;
      b = to_b;
    }
  }
  return way;
}

/// Returns the distance from p to the borders of a face that do not meet the band's edge.
double room_beside(const Finding& finding, EdgeId band, FaceId f, const Point& p) {
  double room = k_infinite;
  const CornerId a = finding.corner({band, 0}), b = finding.corner({band, 1});
  for (const Border& border : finding.model.faces[f].borders)
    for (const EdgeUse& use : border) {
      const EdgeId e = finding.topology.same_as[use.edge].edge;
      if (e == band || finding.edges[e].samples.empty() || finding.topology.is_point[use.edge] != 0) continue;
      const CornerId c = finding.corner({e, 0}), d = finding.corner({e, 1});
      if (c == a || c == b || d == a || d == b) continue;
      const std::vector<EdgeSample>& samples = finding.edges[e].samples;
      for (std::size_t k = 0; k + 1 < samples.size(); ++k) room = std::min(room, distance_to_segment(p, samples[k].point, samples[k + 1].point));
    }
  return room;
}

void set_spacing(Finding& finding) {
  const Column<CornerId, double> ways = ways_to_ends(finding);
  for (const EdgeId e : finding.model.edges.ids()) {
    std::optional<BandEdge>& band = finding.bands.edges[e];
    if (!band) continue;
    const EdgeSamples& samples = finding.edges[e];
    const Interval range = finding.model.edges[e].range;
    const double stretch = band->longest / band->first;
    double along = 0.0;
    for (std::size_t i = 0; i < samples.samples.size(); ++i) {
      const EdgeSample& s = samples.samples[i];
      if (i > 0) along += distance(samples.samples[i - 1].point, s.point);
      double first = band->first, longest = band->longest, room = k_infinite;
      for (const Side& side : finding.sides[e]) {
        const CurvatureLimits& limits = finding.of(side).limits;
        longest = std::min(longest, limits.size_of(s.curvature));
        if (finding.is_strip(side)) continue;
        if (const Look l = look(finding.model, side, (s.t - range.from) / range.length()); l.is_valid) first = std::min(first, limits.size_of(norm(l.bend)));
        room = std::min(room, room_beside(finding, e, side.location.face, s.point));
      }
      const double way = std::min(ways[finding.corner({e, 0})] + along, ways[finding.corner({e, 1})] + samples.length - along);
      const double climb = band->growth - 1.0;
      const double spacing = std::max(first, std::min({longest, stretch * first, first + finding.sizes.growth * way, first + climb * k_share_of_chord * room}));
      band->spacing.push_back(spacing);
      band->reach.push_back((spacing - first) / climb);
    }
  }
}

void note_missing(Finding& finding) {
  std::map<std::string, bool> leading, trailing, cells;  // per rule: true if an edge was found for it
  for (const FaceId f : finding.model.faces.ids()) {
    const FaceSizes& sizes = finding.sizes.faces[f];
    if (sizes.leading.is_any()) leading[sizes.leading.rule];
    if (sizes.trailing.is_any()) trailing[sizes.trailing.rule];
    for (const EdgeId e : finding.bands.bands_of_face[f]) {
      if (finding.bands.edges[e]->kind == BandKind::leading) leading[sizes.leading.rule] = true;
      else trailing[sizes.trailing.rule] = true;
    }
  }
  const auto note = [&](const std::string& rule, const std::string& what, const std::string& hint) {
    std::string names;
    for (const FaceId f : finding.model.faces.ids())
      if (const std::string& name = finding.model.faces[f].name; (rule.empty() || matches_glob(name, rule)) && may_be_wing(finding.model, f) &&
                                                                 names.find("\"" + name + "\"") == std::string::npos && names.size() < 80)
        names += (names.empty() ? "\"" : ", \"") + name + "\"";
    finding.bands.notes.push_back("no edge of " + (names.empty() ? "the model" : "faces " + names) + " is a " + what + ": " + hint);
  };
  for (const auto& [rule, is_found] : leading)
    if (!is_found)
      note(rule, "leading edge",
           "a leading edge is an edge that faces forward (-x), sharp or between two smooth faces where they turn most; a face that wraps the nose has no "
           "leading edge until "
           "the face is split there");
  for (const auto& [rule, is_found] : trailing)
    if (!is_found)
      note(rule, "trailing edge",
           "a trailing edge is an edge that faces aft (+x): a sharp edge between two faces, or a long side of a narrow base of four sides");
}

}  // namespace

bool WingBands::covers(const Column<EdgeId, EdgeSamples>& samples, FaceId f, const Point& p) const {
  if (strips[f]) return true;
  if (is_unused) return false;
  for (const EdgeId e : bands_of_face[f]) {
    const std::vector<EdgeSample>& s = samples[e].samples;
    const std::vector<double>& reach = edges[e]->reach;
    for (std::size_t k = 0; k + 1 < s.size(); ++k) {
      const double within = std::min(reach[k], reach[k + 1]);
      if (within > 0.0 && distance_to_segment(p, s[k].point, s[k + 1].point) < within) return true;
    }
  }
  return false;
}

void WingBands::overrule(const Column<EdgeId, EdgeSamples>& samples, const std::vector<EdgeUseLocation>& uses, EdgeId e, double largest,
                         std::vector<double>& sizes) const {
  if (edges[e]) {
    sizes = edges[e]->spacing;
  } else if (n_short[e] > 0) {
    // This is the short side of a strip of cells. If the strip continues beyond it, the strip requires no size there.
    sizes.assign(sizes.size(), is_short_ending[e] != 0 ? samples[e].length / static_cast<double>(n_short[e]) : largest);
  } else if (!is_unused) {
    for (std::size_t k = 0; k < sizes.size(); ++k)
      if (std::all_of(uses.begin(), uses.end(), [&](const EdgeUseLocation& location) { return covers(samples, location.face, samples[e].samples[k].point); }))
        sizes[k] = largest;
  }
}

WingBands find_wing_bands(const Model& model, const Column<EdgeId, EdgeSamples>& edges, const ModelSizes& sizes, const ModelTopology& topology) {
  Finding finding{model, edges, sizes, topology, {}, {}};
  WingBands& bands = finding.bands;
  bands.edges.resize(model.edges.size());
  bands.crossings.resize(model.edges.size());
  bands.strips.resize(model.faces.size());
  bands.n_short.resize(model.edges.size(), 0);
  bands.is_short_ending.resize(model.edges.size());
  bands.bands_of_face.resize(model.faces.size());
  const bool is_any = std::any_of(sizes.faces.begin(), sizes.faces.end(),
                                  [](const FaceSizes& f) { return f.leading.is_any() || f.trailing.is_any() || !is_automatic(f.trailing_cells); });
  if (!is_any) return std::move(bands);
  gather_sides(finding);
  find_strips(finding);
  find_edges(finding);
  join_at_corners(finding);
  set_spacing(finding);
  note_missing(finding);
  for (const EdgeId e : model.edges.ids()) bands.is_short_ending[e] = bands.n_short[e] > 0 && !is_short_of_strips(finding, e);
  return std::move(bands);
}

}  // namespace sterna::surfmesh
