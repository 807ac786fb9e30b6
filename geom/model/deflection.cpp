// Steps: add images on the other half; check the deflections; find the locations along the span where a deflection begins, bends or ends; make rows there;
// rotate every row by the deflections that reach it; add patches where the hinge lines cross the rows' sides.
#include "geom/model/deflection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geom/base/error.h"
#include "geom/model/deform.h"
#include "geom/model/section_rows.h"
#include "geom/model/wing_span.h"

namespace sterna {
namespace {

/// Largest angle of a deflection, radians; beyond it the bend needs more room than the profile has.
constexpr double k_max_angle = std::numbers::pi / 3.0;
/// Locations along the span nearer than this fraction of it are identical.
constexpr double k_same_span = 1e-9;
/// Hinge points nearer than this fraction of the span to a section, a tip or another surface's hinge point are moved there. Files give them with few digits,
/// and a narrow strip between the two is useless.
constexpr double k_snap = 1e-4;
/// Hinges of open surfaces nearer to an edge than this fraction of the chord leave no solid.
constexpr double k_min_open_chord = 0.03;
/// Half width of the bend, in thicknesses of the section at the hinge; a rotation by 60 degrees requires 0.5 to avoid folding.
constexpr double k_knee = 1.0;

using Row = std::vector<Point>;
constexpr std::size_t k_nose = k_wing_side_points;

[[noreturn]] void refuse_deflection(ErrorCode code, const Deflection& d, const std::string& problem, const std::string& hint = {}) {
  throw Error({.code = code, .attempted = "deflecting '" + d.surface.name + "'", .problem = problem, .hint = hint});
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// Range of a deflection along the span, and the width beside its ends over which it fades.
struct Reach {
  double from, to;
  double fade;           ///< fraction of the span
  double slot = 0.0;     ///< metres
  double end_gap = 0.0;  ///< fraction of the span
};

Reach reach_of(const Deflection& d, const WingSpan& span) {
  const double from = std::max(d.surface.hinge.front().span, 0.0), to = std::min(d.surface.hinge.back().span, 1.0);
  const double chord = 0.5 * (norm(chord_vector(span.row(span.location_of(from)))) + norm(chord_vector(span.row(span.location_of(to)))));
  const double fairing = d.fairing == Deflection::k_automatic_fairing ? 0.1 * chord : d.fairing;
  const double slot = d.slot == Deflection::k_automatic_slot ? 0.01 * chord : d.slot,
               end_gap = d.end_gap == Deflection::k_automatic_slot ? 0.01 * chord : d.end_gap;
  if (d.gap == ControlGap::open) return {from, to, 0.0, slot, end_gap / span.length()};
  return {from, to, fairing / span.length()};
}

bool is_open(const Deflection& d) { return d.gap == ControlGap::open; }
/// Returns true if the skin itself bends.
bool is_bending(const Deflection& d) { return d.angle != 0.0 && !is_open(d); }

double hinge_chord(const Deflection& d, double s) {
  const std::vector<HingePoint>& hinge = d.surface.hinge;
  for (std::size_t i = 0; i + 1 < hinge.size(); ++i)
    if (s <= hinge[i + 1].span || i + 2 == hinge.size()) {
      const double t = std::clamp((s - hinge[i].span) / (hinge[i + 1].span - hinge[i].span), 0.0, 1.0);
      return hinge[i].chord + t * (hinge[i + 1].chord - hinge[i].chord);
    }
  return hinge.back().chord;
}

/// Point of the hinge line in a row, half way between upper and lower side, and the thickness there.
struct HingeLocation {
  Point point;
  double thickness = 0.0;
};
HingeLocation hinge_location(const Row& row, double fraction) {
  const Vec3 chord = chord_vector(row);
  const auto part = [&](const Point& p) { return dot(p - row[k_nose], chord) / norm2(chord); };
  const auto side = [&](bool is_upper) {
    for (std::size_t k = 0; k < k_nose; ++k) {  // k runs from the trailing edge to the nose
      const Point &a = is_upper ? row[k] : row[2 * k_nose - k], &b = is_upper ? row[k + 1] : row[2 * k_nose - k - 1];
      if (part(b) <= fraction && part(a) >= fraction) return part(a) == part(b) ? a : a + (part(a) - fraction) / (part(a) - part(b)) * (b - a);
    }
    return row[k_nose];
  };
  const Point upper = side(true), lower = side(false);
  return {0.5 * (upper + lower), distance(upper, lower)};
}

void check(const Wing& wing, const std::vector<Deflection>& deflections) {
  for (const Deflection& d : deflections) {
    if (d.surface.wing != wing.name)
      refuse_deflection(ErrorCode::bad_argument, d, "the control surface belongs to wing '" + d.surface.wing + "', not to '" + wing.name + "'");
    if (!(std::abs(d.angle) <= k_max_angle))
      refuse_deflection(ErrorCode::bad_argument, d, "the angle is " + std::to_string(d.angle * 180.0 / std::numbers::pi) + " degrees, the limit is 60 degrees");
    if (d.surface.hinge.size() < 2)
      refuse_deflection(ErrorCode::bad_argument, d,
                        "the control surface has " + std::to_string(d.surface.hinge.size()) + " hinge points; at least 2 are needed");
    for (std::size_t i = 1; i < d.surface.hinge.size(); ++i)
      if (!(d.surface.hinge[i].span > d.surface.hinge[i - 1].span))
        refuse_deflection(ErrorCode::bad_argument, d, "the hinge points are not in ascending order along the span");
    if (!(d.surface.hinge.front().span < 1.0 && d.surface.hinge.back().span > 0.0))
      refuse_deflection(ErrorCode::bad_argument, d, "the control surface lies beyond the wing tips");
    for (const HingePoint& h : d.surface.hinge)
      if (!(h.chord >= 0.0 && h.chord <= 1.0))
        refuse_deflection(ErrorCode::bad_argument, d, "a hinge point lies at " + std::to_string(h.chord) + " of the chord; the limits are 0 and 1");
    if (d.fairing != Deflection::k_automatic_fairing && !(d.fairing > 0.0))
      refuse_deflection(ErrorCode::bad_argument, d, "the fairing is " + std::to_string(d.fairing) + " m, must be positive");
    if (!is_open(d)) continue;
    for (const auto& [value, what] : {std::pair{d.slot, "slot"}, std::pair{d.end_gap, "end gap"}})
      if (value != Deflection::k_automatic_slot && !(value > 0.0))
        refuse_deflection(ErrorCode::bad_argument, d, std::string("the ") + what + " is " + std::to_string(value) + " m, must be positive");
    if (d.surface.kind == ControlKind::all_moving) continue;
    if (!(d.surface.hinge.front().span > 0.0 && d.surface.hinge.back().span < 1.0))
      refuse_deflection(ErrorCode::bad_argument, d, "with an open gap the control surface must end before the wing tips");
    for (const HingePoint& h : d.surface.hinge)
      if (!(h.chord > k_min_open_chord && h.chord < 1.0 - k_min_open_chord))
        refuse_deflection(ErrorCode::bad_argument, d,
                          "with an open gap the hinge must lie between 0.03 and 0.97 of the chord, not at " + std::to_string(h.chord));
  }
}

bool share_an_edge(const Deflection& a, const Deflection& b) {
  return a.surface.kind == b.surface.kind || a.surface.kind == ControlKind::all_moving || b.surface.kind == ControlKind::all_moving;
}

void check_overlaps(const std::vector<Deflection>& deflections, const WingSpan& span) {
  for (std::size_t i = 0; i < deflections.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Deflection &a = deflections[i], &b = deflections[k];
      if (!share_an_edge(a, b)) continue;
      Reach p = reach_of(a, span), q = reach_of(b, span);
      for (const auto& [reach, deflection] : {std::pair{&p, &a}, std::pair{&q, &b}})
        if (is_open(*deflection)) *reach = {reach->from - reach->end_gap, reach->to + reach->end_gap, 0.0};     // wing must remain between two surfaces
        else if (deflection->angle == 0.0) *reach = {reach->from + k_same_span, reach->to - k_same_span, 0.0};  // patches may touch
      if (p.from - p.fade < q.to + q.fade && q.from - q.fade < p.to + p.fade)
        refuse_deflection(ErrorCode::bad_argument, a,
                          "including fairings and end gaps the control surface overlaps '" + b.surface.name +
                              "' along the span: " + std::to_string(p.from - p.fade) + " .. " + std::to_string(p.to + p.fade) + " and " +
                              std::to_string(q.from - q.fade) + " .. " + std::to_string(q.to + q.fade) + " of the span",
                          "give a smaller fairing or end gap");
    }
}

/// Moves an end of the hinge along its line. Returns false if nothing would remain.
bool draw_in(Deflection& d, bool is_first, double span) {
  std::vector<HingePoint>& hinge = d.surface.hinge;
  if (is_first ? span >= hinge.back().span - k_same_span : span <= hinge.front().span + k_same_span) return false;
  const HingePoint end{span, hinge_chord(d, span)};
  std::erase_if(hinge, [&](const HingePoint& h) { return is_first ? h.span <= span : h.span >= span; });
  hinge.insert(is_first ? hinge.begin() : hinge.end(), end);
  return true;
}

Point hinge_point(const HingePoint& h, const WingSpan& span) { return hinge_location(span.row(span.location_of(std::clamp(h.span, 0.0, 1.0))), h.chord).point; }

/// Returns the unit direction; positive angles about it turn trailing edges down: about +y (a fin: +z, to the right).
Vec3 hinge_axis(const Point& a, const Point& b) {
  const Vec3 axis = normalized(b - a);
  return (std::abs(axis.y) >= std::abs(axis.z) ? axis.y < 0.0 : axis.z < 0.0) ? -axis : axis;
}

/// Rotates the moving part of a row; points that do not move are unchanged to the bit.
void turn(Row& row, double s, const Deflection& d, const WingSpan& span) {
  const Reach reach = reach_of(d, span);
  const double outside = std::max({reach.from - s, s - reach.to, 0.0});
  const double share = outside >= reach.fade * (1.0 - k_same_span) && outside > 0.0 ? 0.0 : 1.0 - smooth_step(reach.fade > 0.0 ? outside / reach.fade : 0.0);
  if (share == 0.0) return;
  const double fraction = hinge_chord(d, s);
  const HingeLocation hinge = hinge_location(row, fraction);
  // The hinge line is the straight segment that contains s.
  std::size_t i = 0;
  while (i + 2 < d.surface.hinge.size() && s > d.surface.hinge[i + 1].span) ++i;
  const Vec3 axis = hinge_axis(hinge_point(d.surface.hinge[i], span), hinge_point(d.surface.hinge[i + 1], span));
  const Vec3 chord = chord_vector(row);
  const double knee = k_knee * std::max(hinge.thickness / norm(chord), 1e-3);
  const double angle = share * (d.surface.kind == ControlKind::leading_edge ? -d.angle : d.angle);
  const Point nose = row[k_nose];
  for (Point& p : row) {
    const double part = dot(p - nose, chord) / norm2(chord);
    double moving = 1.0;
    if (d.surface.kind == ControlKind::trailing_edge) moving = smooth_step((part - fraction + knee) / (2.0 * knee));
    if (d.surface.kind == ControlKind::leading_edge) moving = 1.0 - smooth_step((part - fraction + knee) / (2.0 * knee));
    if (moving == 0.0) continue;
    p = rotation(hinge.point, axis, moving * angle).point(p);
  }
}

/// Returns the end of the wing before an open slot. Its distance from the middle of the hinge is the radius of the moving part's round nose plus the slot.
RowCrossing lip_of(const Deflection& d, const Row& row, const RowCrossing& hinge, double slot) {
  const auto [upper, lower] = points_at(row, hinge);
  const std::optional<RowCrossing> lip =
      row_at_distance(row, hinge, 0.5 * (upper + lower), 0.5 * distance(upper, lower) + slot, d.surface.kind == ControlKind::trailing_edge);
  if (!lip)
    refuse_deflection(ErrorCode::bad_argument, d,
                      "the slot of " + std::to_string(slot) + " m is larger than the remaining part of the section beyond the hinge");
  return *lip;
}

/// The hinge of an open surface: a straight line in space between its ends.
struct StraightHinge {
  Point from, to;
  Vec3 axis;
};
StraightHinge straight_hinge(const Deflection& d, const WingSpan& span, const Reach& reach) {
  const auto at = [&](double s) { return hinge_point({s, hinge_chord(d, s)}, span); };
  const Point from = at(reach.from), to = at(reach.to);
  return {from, to, hinge_axis(from, to)};
}

/// Returns the fraction of its chord at which the straight hinge crosses a row; the hinge must be near the midpoint between both sides there.
double straight_chord(const Deflection& d, const StraightHinge& hinge, const Row& row, double slot) {
  /// Largest distance between the middle of a section and the hinge, relative to the slot. If it were larger, the moving part would touch the wing.
  constexpr double k_max_bend = 0.5;
  Vec3 normal;
  for (std::size_t i = 0; i + 1 < row.size(); ++i) normal += cross(row[i] - row[0], row[i + 1] - row[0]);
  const Point& nose = row[k_nose];
  const Point at = hinge.from + dot(nose - hinge.from, normal) / dot(hinge.to - hinge.from, normal) * (hinge.to - hinge.from);
  const Vec3 chord = chord_vector(row);
  const double fraction = dot(at - nose, chord) / norm2(chord), off = distance(hinge_location(row, fraction).point, at);
  if (!(fraction > k_min_open_chord && fraction < 1.0 - k_min_open_chord && off <= k_max_bend * slot))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "deflecting '" + d.surface.name + "'",
                 .problem = "the straight line between the ends of the hinge deviates from the middle of the wing section by " + std::to_string(off) +
                            " m at " + std::to_string(fraction) + " of the chord; the slot is " + std::to_string(slot) + " m",
                 .locations = {{at, "hinge line"}},
                 .hint = "give one control surface for each straight piece, or a wider slot"});
  return fraction;
}

/// Adds the images on the other half of a symmetric wing.
std::vector<Deflection> with_images(const Wing& wing, const std::vector<Deflection>& deflections) {
  std::vector<Deflection> all;
  for (const Deflection& d : deflections) {
    all.push_back(d);
    if (!wing.is_symmetric || (d.other_side == OtherSide::none && !d.surface.has_image)) continue;
    all.push_back(image_of(d));
    std::vector<HingePoint>& hinge = all.back().surface.hinge;
    std::reverse(hinge.begin(), hinge.end());
    for (HingePoint& h : hinge) h.span = 1.0 - h.span;
  }
  return all;
}

/// Moves hinge points to nearby sections and to each other.
void snap(std::vector<Deflection>& deflections, const WingSpan& span) {
  std::vector<double> targets = span.fractions();
  for (Deflection& d : deflections)
    for (HingePoint& h : d.surface.hinge) {
      const auto nearest = std::min_element(targets.begin(), targets.end(), [&](double a, double b) { return std::abs(a - h.span) < std::abs(b - h.span); });
      if (std::abs(*nearest - h.span) <= k_snap) h.span = *nearest;
      else if (h.span > 0.0 && h.span < 1.0) targets.push_back(h.span);
    }
}

/// moving_from() and moving_to() return the two ends of the moving part of an open surface. There is no gap at a tip.
double moving_from(const Reach& reach) { return reach.from > 0.0 ? reach.from + reach.end_gap : 0.0; }
double moving_to(const Reach& reach) { return reach.to < 1.0 ? reach.to - reach.end_gap : 1.0; }

/// Location of a row of the wing as a fraction of the span. `is_break`: a kink is allowed there.
struct Stop {
  double at;
  bool is_break;
  bool is_own;  ///< the row is a section of the wing
};

std::vector<Stop> stops_of(const WingSpan& span, const std::vector<Deflection>& deflections) {
  std::vector<Stop> stops;
  const std::vector<double> own = span.fractions();
  for (std::size_t i = 0; i < own.size(); ++i) stops.push_back({own[i], span.made().is_break[i], true});
  for (std::size_t i = 0; i + 1 < own.size(); ++i)
    if (const WingRows& made = span.made(); !(made.is_break[i] && made.is_break[i + 1]) && !made.is_sampled[i] && !made.is_sampled[i + 1])
      for (int k = 1; k < k_cubic_rows; ++k) stops.push_back({span.fraction_of(static_cast<double>(i) + static_cast<double>(k) / k_cubic_rows), false, false});
  for (const Deflection& d : deflections) {
    const Reach reach = reach_of(d, span);
    if (is_open(d) && d.surface.kind == ControlKind::all_moving)
      for (const double s : {reach.from, moving_from(reach), moving_to(reach), reach.to}) stops.push_back({s, true, false});
    if (!is_bending(d)) continue;
    constexpr int k_fade_steps = 4;  // the fade is a quintic, approximated by straight pieces
    for (int i = 0; i <= k_fade_steps; ++i) {
      const bool is_break = i == 0 || i == k_fade_steps;
      stops.push_back({reach.from - reach.fade * i / k_fade_steps, is_break, false});
      stops.push_back({reach.to + reach.fade * i / k_fade_steps, is_break, false});
    }
    for (const HingePoint& h : d.surface.hinge) stops.push_back({h.span, true, false});
  }
  std::erase_if(stops, [](const Stop& s) { return s.at < 0.0 || s.at > 1.0; });
  std::stable_sort(stops.begin(), stops.end(), [](const Stop& a, const Stop& b) { return a.at < b.at; });
  std::vector<Stop> kept;
  for (const Stop& stop : stops) {
    if (kept.empty() || stop.at - kept.back().at > k_same_span) {
      kept.push_back(stop);
      continue;
    }
    if (stop.is_own) kept.back().at = stop.at;  // where locations coincide, those of sections are kept
    kept.back().is_own = kept.back().is_own || stop.is_own;
    kept.back().is_break = kept.back().is_break || stop.is_break;
  }
  return kept;
}

Wing bent_wing(const Wing& wing, const WingSpan& span, const std::vector<Stop>& stops, const std::vector<Deflection>& deflections) {
  Wing bent = wing;
  bent.is_symmetric = bent.has_winglet = false;  // its rows already include the blend
  bent.is_cubic = std::any_of(stops.begin(), stops.end(), [](const Stop& s) { return !s.is_break; });
  bent.sections.clear();
  if (wing.is_symmetric) bent.left_tip = wing.left_tip;
  for (const Stop& stop : stops) {
    WingSection section{.name = "at " + std::to_string(stop.at) + " of the span"};
    section.loop = span.row(span.location_of(stop.at));
    section.is_row = true;
    section.is_break = stop.is_break;
    for (const Deflection& d : deflections)
      if (is_bending(d)) turn(section.loop, stop.at, d, span);
    section.leading_edge = section.loop[k_nose];
    section.chord = norm(chord_vector(section.loop));
    bent.sections.push_back(std::move(section));
  }
  return bent;
}

/// Returns the index of a fraction of the span among the stops (within rounding), or among the wing's own rows if there are no stops.
double location_among(const WingSpan& span, const std::vector<Stop>& stops, double s) {
  if (stops.empty()) {
    const double location = span.location_of(s);
    return std::abs(location - std::round(location)) <= k_same_span ? std::round(location) : location;
  }
  for (std::size_t i = 0; i < stops.size(); ++i) {
    if (std::abs(s - stops[i].at) <= k_same_span) return static_cast<double>(i);
    if (i > 0 && s < stops[i].at) return static_cast<double>(i - 1) + (s - stops[i - 1].at) / (stops[i].at - stops[i - 1].at);
  }
  return static_cast<double>(stops.size() - 1);
}

/// Returns the patch of a control surface; locations are counted in `stops`, or in the wing's own rows if there are none.
WingPatch patch_of(const Deflection& d, const WingSpan& span, const std::vector<Stop>& stops) {
  const Reach reach = reach_of(d, span);
  std::vector<double> at{reach.from, reach.to};
  if (stops.empty()) {
    for (const double s : span.fractions()) at.push_back(s);
  } else {
    for (const Stop& stop : stops) at.push_back(stop.at);
  }
  for (const HingePoint& h : d.surface.hinge) at.push_back(h.span);
  std::erase_if(at, [&](double s) { return s < reach.from || s > reach.to; });
  std::sort(at.begin(), at.end());
  WingPatch patch{d.surface.name, d.surface.kind, {}, {}};
  const StraightHinge line = straight_hinge(d, span, reach);
  if (is_open(d))
    patch.slot =
        WingPatch::Slot{{}, 0.0, 0.0, d.has_flat_nose, rotation(line.from, line.axis, d.surface.kind == ControlKind::leading_edge ? -d.angle : d.angle)};
  const bool has_lips = is_open(d) && d.surface.kind != ControlKind::all_moving;
  double last = -1.0;
  for (const double s : at) {
    const double location = location_among(span, stops, s);
    if (location <= last) continue;
    last = location;
    const Row row = span.row(span.location_of(s));
    const RowCrossing hinge =
        d.surface.kind == ControlKind::all_moving ? RowCrossing{} : row_crossing(row, has_lips ? straight_chord(d, line, row, reach.slot) : hinge_chord(d, s));
    const RowCrossing border = has_lips ? lip_of(d, row, hinge, reach.slot) : hinge;
    patch.border.push_back({location, border.upper, border.lower});
    if (patch.slot) patch.slot->hinge.push_back({location, hinge.upper, hinge.lower});
  }
  if (patch.slot) {
    patch.slot->from = location_among(span, stops, moving_from(reach));
    patch.slot->to = location_among(span, stops, moving_to(reach));
  }
  return patch;
}

}  // namespace

std::vector<Deflection> with_room_between(const Wing& wing, std::vector<Deflection> deflections) {
  const WingSpan span(wing);
  constexpr int k_rounds = 8;  // several rounds are needed, because the fairing is a fraction of the chord at the surface's ends, which move
  // Width beside the ends of a surface: its fairing, or the gap beside a separate part. It is zero for a patch.
  const auto beside = [](const Deflection& d, const Reach& reach) { return is_open(d) ? reach.end_gap : is_bending(d) ? reach.fade : 0.0; };
  bool is_tight = true;
  for (int round = 0; round < k_rounds && is_tight; ++round) {
    is_tight = false;
    for (Deflection& a : deflections)
      for (Deflection& b : deflections) {
        const bool moves_a = is_bending(a) || is_open(a), moves_b = is_bending(b) || is_open(b);
        if (&a == &b || !share_an_edge(a, b) || !(moves_a || moves_b)) continue;
        const Reach p = reach_of(a, span), q = reach_of(b, span);
        const double missing = (p.to + beside(a, p)) - (q.from - beside(b, q)) + k_same_span;
        if (!(p.from < q.from && p.to < q.to) || missing <= 0.0) continue;
        const double share = moves_a && moves_b ? 0.5 : 1.0;
        if (moves_a) is_tight = draw_in(a, false, p.to - share * missing - k_same_span) || is_tight;
        if (moves_b) is_tight = draw_in(b, true, q.from + share * missing + k_same_span) || is_tight;
      }
  }
  return deflections;
}

Deflection image_of(const Deflection& deflection) {
  Deflection image = deflection;
  image.surface.name = image_name(deflection.surface.name);
  image.surface.wing = deflection.surface.wing;
  if (deflection.other_side != OtherSide::same) image.angle = deflection.other_side == OtherSide::opposite ? -deflection.angle : 0.0;
  return image;
}

ControlSurface from_root(const Wing& wing, ControlSurface surface) {
  if (surface.hinge.size() < 2)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "placing control surface '" + surface.name + "'",
                 .problem = "the control surface has " + std::to_string(surface.hinge.size()) + " hinge points; at least 2 are needed"});
  const WingSpan span(wing);
  const double end = static_cast<double>(span.rows().size() - 1);
  for (HingePoint& h : surface.hinge) {
    const double location = span.location_from_root(wing, h.span);
    // Beyond the ends (over the tip) lengths are extrapolated.
    h.span = location < 0.0 || location > end ? (location < 0.0 ? -1e-3 : 1.0 + 1e-3) : span.fraction_of(location);
  }
  std::sort(surface.hinge.begin(), surface.hinge.end(), [](const HingePoint& a, const HingePoint& b) { return a.span < b.span; });
  return surface;
}

Wing deflected(const Wing& wing, const std::vector<Deflection>& deflections) {
  if (deflections.empty()) return wing;
  std::vector<Deflection> all = with_images(wing, deflections);
  check(wing, all);
  const WingSpan span(wing);
  snap(all, span);
  check(wing, all);
  check_overlaps(all, span);
  const bool is_bent =
      std::any_of(all.begin(), all.end(), [](const Deflection& d) { return is_bending(d) || (is_open(d) && d.surface.kind == ControlKind::all_moving); });
  const std::vector<Stop> stops = is_bent ? stops_of(span, all) : std::vector<Stop>{};
  Wing result = is_bent ? bent_wing(wing, span, stops, all) : wing;
  for (const Deflection& d : all) result.patches.push_back(patch_of(d, span, stops));
  return result;
}

}  // namespace sterna
