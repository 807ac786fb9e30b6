// Builds wings. Steps: make rows of points through the sections; spline a surface around the airfoil between sections, split at the leading edge; make upper
// and lower faces over shared edges, and cut patches out of them; add trailing edge and tips, coves and walls of open slots, and the moving parts.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "geom/base/error.h"
#include "geom/model/components.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"
#include "geom/model/moving_part.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/nurbs_tools.h"
#include "geom/model/section_rows.h"
#include "geom/model/side_graph.h"
#include "geom/model/slot_faces.h"
#include "geom/model/wing_sides.h"

namespace sterna {
namespace {

constexpr std::size_t k_side_points = k_wing_side_points;
/// If the first and last section of a symmetric wing are nearer to each other than this fraction of the span, the wing is a ring.
constexpr double k_ring = 1e-6;
/// Limit of the cosine of the angle, seen along x, between a panel and the reversed previous panel (15 degrees). A panel above it overlaps the previous one.
constexpr double k_fold = 0.9659258262890683;

/// Edges shared by the faces on both sides of a section.
struct Station {
  SplitCurve upper, lower;  ///< from the trailing to the leading edge
  EdgeId thickness;         ///< edge of a blunt trailing edge; else upper and lower begin at the same corner
  CornerId leading() const { return upper.corners.back(); }
};

/// Returns true if the row is planar to 1e-10 of its size: the rounding of a rotated section, and within the tolerance of a planar face.
bool is_planar(const std::vector<Point>& row) {
  Vec3 normal;
  double size = 0.0, off = 0.0;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) normal += cross(row[i] - row[0], row[i + 1] - row[0]);
  normal = normalized(normal);
  for (const Point& p : row) {
    size = std::max({size, distance(p, row[0]), norm(p)});
    off = std::max(off, std::abs(dot(p - row[0], normal)));
  }
  return off <= 1e-10 * size;
}

/// Edges around the cut-out of a slot, collected while the sides are built.
struct CutOut {
  std::vector<double> locations;                     ///< locations of the corners of the lips
  std::vector<EdgeId> upper, lower;                  ///< lips between the corners
  std::array<SplitCurve, 2> upper_ends, lower_ends;  ///< edges across the chord at the first and last location of the cut-out
  std::array<EdgeId, 2> thickness;                   ///< edges of a blunt trailing edge at these locations
};

/// Ends of a wing where a moving part was cut off. They are closed by walls.
struct CutEnds {
  bool right = false, left = false;
};

class WingBuilder {
 public:
  WingBuilder(const Wing& wing, const Transform& map, CutEnds cut = {})
      : cut_(cut), wing_(wing), map_(map * transform_of(wing.placement)), builder_({wing.name, wing.is_pylon ? ComponentKind::pylon : ComponentKind::wing}) {}
  Model build();

 private:
  using Crossing = double WingPatch::Location::*;
  void make_rows();
  void refuse_fold_back() const;
  void make_panels();
  void make_part(const WingSides& panel, double from_location, double to_location, const Station& from, const Station& to);
  void make_side(const WingSides& panel, Crossing side, double from_location, double to_location, const Station& from, const Station& to,
                 const SplitCurve& leading, const SplitCurve& trailing);
  Station station(const WingSides& panel, double location);
  const WingPatch* patch_over(ControlKind kind, double from_location, double to_location) const;
  std::vector<double> patch_ends(ControlKind kind, double from_location, double to_location) const;
  const WingPatch* slot_at(ControlKind kind, double location) const;
  void keep_ends(Crossing side, std::size_t patch, bool is_last, const SplitCurve& across);
  void make_cove(std::size_t patch);
  /// Returns the name of a control surface that covers the whole chord at an end, else that of the wing.
  const std::string& name_at_end(std::size_t section, std::size_t neighbour) const;
  void tip(const Station& at, std::size_t section, std::size_t neighbour, const EndCap& cap);

  CutEnds cut_;
  const Wing& wing_;
  Transform map_;
  ModelBuilder builder_;
  std::vector<WingSides> panels_;
  std::vector<CutOut> cut_outs_;  ///< one for every patch
  WingRows made_;
  std::vector<std::vector<Point>>& rows_ = made_.rows;
  bool is_blunt_ = true;
  bool is_ring_ = false;
};

void WingBuilder::make_rows() {
  const auto refuse = [&](const std::string& problem) {
    throw Error({.code = ErrorCode::bad_argument, .attempted = "making wing '" + wing_.name + "'", .problem = problem});
  };
  if (wing_.sections.size() < 2) refuse("the wing has " + std::to_string(wing_.sections.size()) + " sections; at least 2 are needed");
  made_ = wing_rows(wing_);
  is_blunt_ = made_.is_blunt;
  refuse_fold_back();
  if (wing_.is_symmetric) {
    double off = 0.0;
    for (std::size_t k = 0; k < rows_.front().size(); ++k) off = std::max(off, distance(rows_.front()[k], rows_.back()[k]));
    is_ring_ = off <= k_ring * distance(rows_.front().front(), rows_[rows_.size() / 2].front());
    if (is_ring_) rows_.back() = rows_.front();
  }
  for (std::vector<Point>& row : rows_)
    for (Point& p : row) p = map_.point(p);
  for (std::size_t i = 1; i < rows_.size(); ++i)
    if (distance(rows_[i].front(), rows_[i - 1].front()) + distance(rows_[i][k_side_points], rows_[i - 1][k_side_points]) == 0.0)
      refuse("two neighbouring sections, number " + std::to_string(i) + " and " + std::to_string(i + 1) + " along the whole span, are at the same location");
}

/// Rejects a panel that folds back over the previous one because sections are out of order. \pre rows in component axes
void WingBuilder::refuse_fold_back() const {
  for (std::size_t i = 2; i < rows_.size(); ++i) {
    const Vec3 before = rows_[i - 1][k_side_points] - rows_[i - 2][k_side_points], after = rows_[i][k_side_points] - rows_[i - 1][k_side_points];
    const Vec3 a{0.0, before.y, before.z}, b{0.0, after.y, after.z};
    if (!(norm(a) > 0.0 && norm(b) > 0.0 && dot(a, b) < -k_fold * norm(a) * norm(b))) continue;
    // Chord of the previous panel at the end of this panel. A joined wing may return beside it.
    const double t = std::max(0.0, 1.0 - norm(b) / norm(a));
    const auto between = [&](std::size_t k) { return rows_[i - 2][k].x + t * (rows_[i - 1][k].x - rows_[i - 2][k].x); };
    if (rows_[i][k_side_points].x < between(0) && between(k_side_points) < rows_[i][0].x)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "making wing '" + wing_.name + "'",
                   .problem = "the wing folds back onto itself: the panels before and behind a section overlap",
                   .locations = {{map_.point(rows_[i - 1][k_side_points]), "leading edge of that section"}},
                   .hint = "give the sections in their order along the span"});
  }
}

/// Returns the patch of a kind that covers the whole of a range.
const WingPatch* WingBuilder::patch_over(ControlKind kind, double from_location, double to_location) const {
  for (const WingPatch& patch : wing_.patches)
    if (patch.kind == kind && first_location(patch) <= from_location && last_location(patch) >= to_location) return &patch;
  return nullptr;
}

/// Returns the ends of patches of a kind within a range, and those of the range itself.
std::vector<double> WingBuilder::patch_ends(ControlKind kind, double from_location, double to_location) const {
  std::vector<double> ends{from_location, to_location};
  for (const WingPatch& patch : wing_.patches)
    for (const double end : {first_location(patch), last_location(patch)})
      if (patch.kind == kind && end > from_location && end < to_location) add_sorted(ends, end);
  return ends;
}

/// Returns the patch with an open slot whose cut-out contains a location, excluding its ends.
const WingPatch* WingBuilder::slot_at(ControlKind kind, double location) const {
  for (const WingPatch& patch : wing_.patches)
    if (patch.kind == kind && patch.slot && first_location(patch) < location && last_location(patch) > location) return &patch;
  return nullptr;
}

Station WingBuilder::station(const WingSides& panel, double location) {
  std::vector<double> upper{0.0, 1.0}, lower{0.0, 1.0};
  for (const WingPatch& patch : wing_.patches)
    if (patch.kind != ControlKind::all_moving && first_location(patch) <= location && last_location(patch) >= location) {
      const WingPatch::Location crossing = crossing_at(patch.border, location);
      add_sorted(upper, crossing.upper);
      add_sorted(lower, crossing.lower);
    }
  const WingPatch *flap = slot_at(ControlKind::trailing_edge, location), *slat = slot_at(ControlKind::leading_edge, location);
  const auto keep = [](std::vector<double>& at, double from, double to) { std::erase_if(at, [=](double u) { return u < from || u > to; }); };
  const WingPatch::Location none{location, 0.0, 0.0}, all{location, 1.0, 1.0};
  const WingPatch::Location from = flap ? crossing_at(flap->border, location) : none, to = slat ? crossing_at(slat->border, location) : all;
  keep(upper, from.upper, to.upper);
  keep(lower, from.lower, to.lower);
  const double v = panel.v(location);
  const CurvePtr upper_curve = line_of_constant_v(panel.upper, v), lower_curve = line_of_constant_v(panel.lower, v);
  const CornerId trailing = builder_.corner(upper_curve->point(upper.front())), leading = builder_.corner(upper_curve->point(upper.back()));
  const CornerId below = is_blunt_ || flap ? builder_.corner(lower_curve->point(lower.front())) : trailing,
                 leading_below = slat ? builder_.corner(lower_curve->point(lower.back())) : leading;
  return {builder_.split_curve(upper_curve, upper, trailing, leading), builder_.split_curve(lower_curve, lower, below, leading_below),
          is_blunt_ && !flap ? builder_.straight_edge(trailing, below) : EdgeId()};
}

void WingBuilder::keep_ends(Crossing side, std::size_t patch, bool is_last, const SplitCurve& across) {
  const double lip = (is_last ? wing_.patches[patch].border.back() : wing_.patches[patch].border.front()).*side;
  const SplitCurve kept = wing_.patches[patch].kind == ControlKind::trailing_edge ? pieces(across, 0.0, lip) : pieces(across, lip, 1.0);
  CutOut& out = cut_outs_[patch];
  (side == &WingPatch::Location::upper ? out.upper_ends : out.lower_ends)[is_last ? 1 : 0] = kept;
}

/// Builds the faces of one side: the patches, and the remaining parts.
void WingBuilder::make_side(const WingSides& panel, Crossing side, double from_location, double to_location, const Station& from, const Station& to,
                            const SplitCurve& leading, const SplitCurve& trailing) {
  const bool is_upper = side == &WingPatch::Location::upper;
  const NurbsSurfaceForm& form = is_upper ? panel.upper : panel.lower;
  const SurfacePtr& surface = is_upper ? panel.upper_surface : panel.lower_surface;
  const FaceRole role = is_upper ? FaceRole::upper : FaceRole::lower;
  std::map<std::pair<double, double>, CornerId> corners;
  SideGraph graph;
  const auto add = [&](const SplitCurve& split, bool is_across, double fixed, SideGraph::Mark left = {}, SideGraph::Mark right = {}) {
    const auto location = [&](double t) { return is_across ? Uv{t, fixed} : Uv{fixed, t}; };
    for (std::size_t i = 0; i < split.edges.size(); ++i)
      if (split.edges[i].is_valid()) graph.add(split.edges[i], location(split.at[i]), location(split.at[i + 1]), left, right);
    for (std::size_t i = 0; i < split.at.size(); ++i)
      if (split.corners[i].is_valid()) corners.emplace(std::pair(location(split.at[i]).u, location(split.at[i]).v), split.corners[i]);
  };
  const auto corner = [&](Uv at) {
    const auto [found, is_new] = corners.emplace(std::pair(at.u, at.v), CornerId());
    if (is_new) found->second = builder_.corner(surface->point(at));
    return found->second;
  };
  const auto beside_slots = [&](const Station& station, double location) {  // a cut-out that begins at the station takes part of its edge
    const SplitCurve& split = is_upper ? station.upper : station.lower;
    double low = 0.0, high = 1.0;
    for (std::size_t k = 0; k < wing_.patches.size(); ++k) {
      const WingPatch& patch = wing_.patches[k];
      if (!patch.slot || patch.kind == ControlKind::all_moving || first_location(patch) >= to_location || last_location(patch) <= from_location ||
          location < first_location(patch) || location > last_location(patch))
        continue;
      (patch.kind == ControlKind::trailing_edge ? low : high) = crossing_at(patch.border, location).*side;
      if (location == first_location(patch) || location == last_location(patch)) keep_ends(side, k, location == last_location(patch), split);
    }
    return pieces(split, low, high);
  };
  add(beside_slots(from, from_location), true, panel.v(from_location));
  add(leading, false, 1.0);
  add(beside_slots(to, to_location), true, panel.v(to_location));
  add(trailing, false, 0.0);
  for (const ControlKind kind : {ControlKind::trailing_edge, ControlKind::leading_edge}) {
    for (const double end : patch_ends(kind, from_location, to_location)) {  // sides of the patches, across the span
      if (end == from_location || end == to_location) continue;
      const double edge_u = kind == ControlKind::trailing_edge ? 0.0 : 1.0;
      std::vector<double> at{edge_u};
      for (const WingPatch& patch : wing_.patches)
        if (patch.kind == kind && first_location(patch) <= end && last_location(patch) >= end) add_sorted(at, crossing_at(patch.border, end).*side);
      if (at.size() == 1) continue;  // the border ends at the edge itself
      const double v = panel.v(end);
      SplitCurve across{line_of_constant_v(form, v), at, {}, {}};
      for (const double u : at) across.corners.push_back(corner({u, v}));
      for (std::size_t i = 1; i < at.size(); ++i)
        across.edges.push_back(builder_.edge(across.curve, {at[i - 1], at[i]}, across.corners[i - 1], across.corners[i]));
      add(across, true, v);
      for (std::size_t k = 0; k < wing_.patches.size(); ++k)
        if (const WingPatch& patch = wing_.patches[k]; patch.slot && patch.kind == kind && (first_location(patch) == end || last_location(patch) == end))
          keep_ends(side, k, last_location(patch) == end, across);
    }
    for (std::size_t k = 0; k < wing_.patches.size(); ++k) {  // borders of the patches, along the span
      const WingPatch& patch = wing_.patches[k];
      if (patch.kind != kind || first_location(patch) >= to_location || last_location(patch) <= from_location) continue;
      std::vector<double> locations{std::max(from_location, first_location(patch)), std::min(to_location, last_location(patch))};
      for (const WingPatch::Location& p : patch.border)
        if (p.section > locations.front() && p.section < locations.back()) add_sorted(locations, p.section);
      for (std::size_t i = 1; i < locations.size(); ++i) {
        const Uv a{crossing_at(patch.border, locations[i - 1]).*side, panel.v(locations[i - 1])},
            b{crossing_at(patch.border, locations[i]).*side, panel.v(locations[i])};
        const EdgeId edge = builder_.edge(line_on_surface(form, a, b), {0.0, 1.0}, corner(a), corner(b), "hinge");
        if (patch.slot) {
          CutOut& out = cut_outs_[k];
          (is_upper ? out.upper : out.lower).push_back(edge);
          if (out.locations.empty()) out.locations.push_back(locations.front());
          if (is_upper) out.locations.push_back(locations[i]);
        }
        if (kind == ControlKind::trailing_edge) graph.add(edge, a, b, k);
        else graph.add(edge, a, b, {}, k);
      }
    }
  }
  const WingPatch* whole = patch_over(ControlKind::all_moving, from_location, to_location);
  for (const SideGraph::Loop& loop : graph.loops()) {
    const WingPatch* patch = whole ? whole : loop.mark ? &wing_.patches[*loop.mark] : nullptr;
    builder_.face(surface, loop.sides, patch ? FaceRole::control : role, patch ? patch->name : wing_.name);
  }
}

/// Builds the faces between two stations of a panel.
void WingBuilder::make_part(const WingSides& panel, double from_location, double to_location, const Station& from, const Station& to) {
  // Pieces within cut-outs have no edge, and no corner where they end at a station.
  const auto along = [&](const NurbsSurfaceForm& form, double u, const std::vector<double>& locations, CornerId first, CornerId last, const char* name) {
    const ControlKind kind = u == 0.0 ? ControlKind::trailing_edge : ControlKind::leading_edge;
    SplitCurve line{line_of_constant_u(form, u), {}, {}, {}};
    for (const double location : locations) {
      line.at.push_back(panel.v(location));
      const bool is_first = line.at.size() == 1, is_last = line.at.size() == locations.size();
      line.corners.push_back(slot_at(kind, location) ? CornerId() : is_first ? first : is_last ? last : builder_.corner(line.curve->point(line.at.back())));
      if (is_first) continue;
      const std::size_t i = line.edges.size();
      line.edges.push_back(slot_at(kind, 0.5 * (locations[i] + location))
                               ? EdgeId()
                               : builder_.edge(line.curve, {line.at[i], line.at[i + 1]}, line.corners[i], line.corners[i + 1], name));
    }
    return line;
  };
  const std::vector<double> behind = patch_ends(ControlKind::trailing_edge, from_location, to_location),
                            before = patch_ends(ControlKind::leading_edge, from_location, to_location);
  const SplitCurve leading = along(panel.upper, 1.0, before, from.leading(), to.leading(), "leading edge");
  const SplitCurve upper_trailing = along(panel.upper, 0.0, behind, from.upper.corners.front(), to.upper.corners.front(), "trailing edge");
  const SplitCurve lower_trailing =
      is_blunt_ ? along(panel.lower, 0.0, behind, from.lower.corners.front(), to.lower.corners.front(), "trailing edge") : upper_trailing;
  make_side(panel, &WingPatch::Location::upper, from_location, to_location, from, to, leading, upper_trailing);
  make_side(panel, &WingPatch::Location::lower, from_location, to_location, from, to, leading, lower_trailing);
  if (!is_blunt_) return;
  const SurfacePtr surface = trailing_edge_surface(panel);
  EdgeId thickness = from.thickness;
  for (std::size_t i = 0; i < behind.size(); ++i) {
    const EdgeId next = i == 0                   ? from.thickness
                        : i + 1 == behind.size() ? to.thickness
                                                 : builder_.straight_edge(upper_trailing.corners[i], lower_trailing.corners[i]);
    for (std::size_t k = 0; k < wing_.patches.size(); ++k)
      for (const bool is_last : {false, true})
        if (wing_.patches[k].slot && (is_last ? last_location(wing_.patches[k]) : first_location(wing_.patches[k])) == behind[i])
          cut_outs_[k].thickness[is_last ? 1 : 0] = next;
    if (i > 0 && upper_trailing.edges[i - 1].is_valid()) {
      const WingPatch* patch = patch_over(ControlKind::trailing_edge, behind[i - 1], behind[i]);
      if (!patch) patch = patch_over(ControlKind::all_moving, from_location, to_location);
      const ParameterBox box{{0.0, 1.0}, {upper_trailing.at[i - 1], upper_trailing.at[i]}};
      builder_.patch(surface, box, {thickness, lower_trailing.edges[i - 1], next, upper_trailing.edges[i - 1]}, FaceRole::trailing_edge,
                     patch ? patch->name : wing_.name);
    }
    thickness = next;
  }
}

/// Builds the faces of a cut-out: cove and walls at both ends.
void WingBuilder::make_cove(std::size_t k) {
  const WingPatch& patch = wing_.patches[k];
  const CutOut& out = cut_outs_[k];
  std::vector<SlotStation> stations;
  std::vector<SplitCurve> sections;
  const Model& model = builder_.model();
  for (std::size_t i = 0; i < out.locations.size(); ++i) {
    const auto corner = [&](const std::vector<EdgeId>& lip) { return i == 0 ? model.edges[lip[0]].start : model.edges[lip[i - 1]].end; };
    SlotStation station{corner(out.upper), corner(out.lower), {}};
    const HingeSection hinge = hinge_section(panel_at(panels_, out.locations[i], i > 0), patch, out.locations[i]);
    station.bulge = Bulge{hinge.middle, hinge.ahead,
                          0.5 * (distance(model.corners[station.upper].point, hinge.middle) + distance(model.corners[station.lower].point, hinge.middle))};
    stations.push_back(station);
    sections.push_back(slot_section(builder_, station));
  }
  slot_strip(builder_, sections, stations, out.upper, out.lower, FaceRole::hinge, wing_.name);
  const bool is_flap = patch.kind == ControlKind::trailing_edge;
  for (const std::size_t end : {0u, 1u})
    slot_wall(builder_, {out.upper_ends[end], out.lower_ends[end], !is_flap, is_flap && is_blunt_ ? std::optional(out.thickness[end]) : std::nullopt},
              end == 0 ? sections.front() : sections.back(), FaceRole::control_side, wing_.name);
}

void WingBuilder::make_panels() {
  Station first, at;
  std::size_t from = 0;
  cut_outs_.resize(wing_.patches.size());
  for (std::size_t i = 1; i < rows_.size(); ++i) {
    if (!made_.is_break[i]) continue;
    panels_.push_back(wing_sides(wing_panel(rows_, from, i, made_.is_sampled_between(from, i))));
    const WingSides& part = panels_.back();
    const std::vector<double> cuts = patch_ends(ControlKind::all_moving, static_cast<double>(from), static_cast<double>(i));
    if (from == 0) first = at = station(part, 0.0);
    for (std::size_t k = 1; k < cuts.size(); ++k) {
      const bool closes_ring = is_ring_ && i + 1 == rows_.size() && k + 1 == cuts.size();
      const Station next = closes_ring ? first : station(part, cuts[k]);
      make_part(part, cuts[k - 1], cuts[k], at, next);
      at = next;
    }
    from = i;
  }
  for (std::size_t k = 0; k < wing_.patches.size(); ++k)
    if (wing_.patches[k].slot && wing_.patches[k].kind != ControlKind::all_moving) make_cove(k);
  if (is_ring_) return;
  const auto end = [&](const Station& station, std::size_t section, std::size_t neighbour, const EndCap& cap, bool is_cut) {
    const bool is_flat = !(cap.height > 0.0) && is_planar(rows_[section]);  // a bent section need not be planar
    if (!is_cut && (cap.height > 0.0 || is_flat)) return tip(station, section, neighbour, cap);
    const EdgeId trailing = is_blunt_ ? station.thickness : builder_.pole(station.upper.corners.front());
    ruled_wall(builder_, station.upper, station.lower, trailing, builder_.pole(station.leading()), is_cut ? FaceRole::control_side : FaceRole::tip,
               is_cut ? wing_.name : name_at_end(section, neighbour));
  };
  end(first, 0, 1, wing_.right_tip, cut_.right);
  end(at, rows_.size() - 1, rows_.size() - 2, wing_.left_tip, cut_.left);
}

const std::string& WingBuilder::name_at_end(std::size_t section, std::size_t neighbour) const {
  const auto [from, to] = std::minmax({static_cast<double>(section), static_cast<double>(neighbour)});
  const double middle = 0.5 * (from + to);
  const WingPatch* patch = section < neighbour ? patch_over(ControlKind::all_moving, from, middle) : patch_over(ControlKind::all_moving, middle, to);
  return patch && !patch->slot ? patch->name : wing_.name;
}

/// Builds a flat tip, or a tip of half ellipses between upper and lower side. These are rational quadratics with the poles side, side + bulge, crest line, side
/// + bulge, side. The bulge is the section's half thickness times the height, outwards along the section's normal.
void WingBuilder::tip(const Station& at, std::size_t section, std::size_t neighbour, const EndCap& cap) {
  const std::string& name = name_at_end(section, neighbour);
  if (!(cap.height > 0.0)) {
    std::vector<EdgeId> border = at.upper.edges;
    border.insert(border.end(), at.lower.edges.rbegin(), at.lower.edges.rend());
    if (is_blunt_) border.push_back(at.thickness);
    builder_.plane(border, FaceRole::tip, name);
    return;
  }
  const std::vector<Point>& row = rows_[section];
  Vec3 outwards;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) outwards += cross(row[i] - row[0], row[i + 1] - row[0]);
  outwards = normalized(outwards);
  const Vec3 along = 0.5 * (row.front() + row[k_side_points]) - 0.5 * (rows_[neighbour].front() + rows_[neighbour][k_side_points]);
  if (dot(outwards, along) < 0.0) outwards = -outwards;
  const Vec3 chord = normalized(0.5 * (row.front() + row.back()) - row[k_side_points]);
  const NurbsCurveForm<Point> upper = *at.upper.curve->exact_nurbs(), lower = *at.lower.curve->exact_nurbs();
  Vec3 up = cross(outwards, chord);
  double side = 0.0;
  for (std::size_t i = 0; i < upper.poles.size(); ++i) side += dot(upper.poles[i] - lower.poles[i], up);
  if (side < 0.0) up = -up;
  NurbsSurfaceForm form{3, 2, upper.knots, {0.0, 0.0, 0.0, 0.5, 0.5, 1.0, 1.0, 1.0}, upper.poles.size(), 5, {}, {}};
  for (std::size_t i = 0; i < form.n_u; ++i) {
    const Point &a = upper.poles[i], &b = lower.poles[i];
    const Vec3 bulge = cap.height * 0.5 * dot(a - b, up) * outwards;
    form.poles.insert(form.poles.end(), {a, a + bulge, 0.5 * (a + b) + bulge, b + bulge, b});
    form.weights.insert(form.weights.end(), {1.0, std::numbers::sqrt2 / 2.0, 1.0, std::numbers::sqrt2 / 2.0, 1.0});
  }
  const EdgeId nose = builder_.pole(at.leading());
  EdgeId base;
  if (is_blunt_) {
    base = builder_.edge(line_of_constant_u(form, 0.0), {0.0, 1.0}, at.upper.corners.front(), at.lower.corners.front());
    builder_.plane({base, at.thickness}, FaceRole::trailing_edge, name);
  } else {
    base = builder_.pole(at.upper.corners.front());
  }
  std::vector<ModelBuilder::Side> sides;
  for (std::size_t i = 0; i < at.upper.edges.size(); ++i) sides.push_back({at.upper.edges[i], {at.upper.at[i], 0.0}, {at.upper.at[i + 1], 0.0}});
  sides.push_back({nose, {1.0, 0.0}, {1.0, 1.0}});
  for (std::size_t i = at.lower.edges.size(); i-- > 0;) sides.push_back({at.lower.edges[i], {at.lower.at[i + 1], 1.0}, {at.lower.at[i], 1.0}});
  sides.push_back({base, {0.0, 1.0}, {0.0, 0.0}});
  builder_.face(std::make_shared<NurbsSurface>(form), sides, FaceRole::tip, name);
}

Model WingBuilder::build() {
  make_rows();
  make_panels();
  Model model = builder_.closed_solid(wing_.name);
  for (const WingPatch& patch : wing_.patches)
    if (patch.slot && patch.kind != ControlKind::all_moving)
      append(model, transformed(make_moving_part(wing_, patch, panels_, is_blunt_), map_ * patch.slot->motion * map_.inverse()));
  return model;
}

/// Returns the sections between two rows as a wing, with the patches that lie within it.
Wing part_of(const Wing& wing, double from, double to) {
  Wing part = wing;
  part.sections = {wing.sections.begin() + static_cast<std::ptrdiff_t>(from), wing.sections.begin() + static_cast<std::ptrdiff_t>(to) + 1};
  part.patches.clear();
  for (WingPatch patch : wing.patches) {
    if (first_location(patch) < from || last_location(patch) > to) continue;
    for (WingPatch::Location& p : patch.border) p.section -= from;
    if (patch.slot) {
      for (WingPatch::Location& p : patch.slot->hinge) p.section -= from;
      patch.slot->from -= from;
      patch.slot->to -= from;
    }
    part.patches.push_back(std::move(patch));
  }
  return part;
}

/// Builds the parts of a wing beside and between its open all-moving surfaces, and these surfaces.
Model make_parts(const Wing& wing, std::vector<WingPatch> moving, const Transform& map) {
  Model model;
  const double end = static_cast<double>(wing.sections.size() - 1);
  double from = 0.0;
  std::sort(moving.begin(), moving.end(), [](const WingPatch& a, const WingPatch& b) { return first_location(a) < first_location(b); });
  for (const WingPatch& patch : moving) {
    if (first_location(patch) > from) append(model, WingBuilder(part_of(wing, from, first_location(patch)), map, {from > 0.0, true}).build());
    Wing part = part_of(wing, patch.slot->from, patch.slot->to);
    part.name = patch.name;
    part.patches = {{patch.name, ControlKind::all_moving, {{0.0, 1.0, 1.0}, {static_cast<double>(part.sections.size() - 1), 1.0, 1.0}}, {}}};
    const Transform whole = map * transform_of(wing.placement);
    append(model, transformed(WingBuilder(part, map, {patch.slot->from > 0.0, patch.slot->to < end}).build(), whole * patch.slot->motion * whole.inverse()));
    from = last_location(patch);
  }
  if (from < end) append(model, WingBuilder(part_of(wing, from, end), map, {from > 0.0, false}).build());
  return model;
}

}  // namespace

Model make_wing(const Wing& wing, const Transform& map) {
  std::vector<WingPatch> moving;
  for (const WingPatch& patch : wing.patches)
    if (patch.slot && patch.kind == ControlKind::all_moving) moving.push_back(patch);
  return moving.empty() ? WingBuilder(wing, map).build() : make_parts(wing, std::move(moving), map);
}

}  // namespace sterna
