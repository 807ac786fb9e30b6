// Steps: rows of all sections with their place along the span -> places where a deflection begins, bends or ends -> rows there, between neighbours on
// the straight panels -> every row turned by the deflections that reach it.
#include "geom/model/deflection.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "geom/base/error.h"
#include "geom/model/section_rows.h"

namespace sterna {
namespace {

/// Beyond, the knee would need more room than the profile has.
constexpr double k_max_angle = std::numbers::pi / 3.0;
/// Places along the span nearer than this part of it are one.
constexpr double k_same_span = 1e-9;
/// Half width of the knee, in thicknesses of the section at the hinge; a turn by 60 degrees needs 0.5 not to fold.
constexpr double k_knee = 1.0;

using Row = std::vector<Point>;
constexpr std::size_t k_nose = k_wing_side_points;

[[noreturn]] void refuse(ErrorCode code, const Deflection& d, const std::string& problem, const std::string& hint = {}) {
  throw Error({.code = code, .attempted = "deflecting '" + d.surface.name + "'", .problem = problem, .hint = hint});
}

Point middle(const Row& row) { return 0.25 * (row.front() + row.back()) + 0.5 * row[k_nose]; }
Vec3 chord_of(const Row& row) { return 0.5 * (row.front() + row.back()) - row[k_nose]; }

/// All rows with their place along the span, in [0, 1].
struct Span {
  std::vector<Row> rows;
  std::vector<double> at;
  double length = 0.0;

  explicit Span(std::vector<Row> all) : rows(std::move(all)), at{0.0} {
    for (std::size_t i = 1; i < rows.size(); ++i) at.push_back(at.back() + distance(middle(rows[i - 1]), middle(rows[i])));
    length = at.back();
    for (double& s : at) s /= length;
    at.back() = 1.0;
  }
  Row row_at(double s) const {
    const auto above = std::upper_bound(at.begin() + 1, at.end() - 1, s);
    const auto i = static_cast<std::size_t>(above - at.begin());
    const double t = std::clamp((s - at[i - 1]) / (at[i] - at[i - 1]), 0.0, 1.0);
    if (t == 0.0) return rows[i - 1];
    if (t == 1.0) return rows[i];
    Row row;
    for (std::size_t k = 0; k < rows[i].size(); ++k) row.push_back((1.0 - t) * rows[i - 1][k] + t * rows[i][k]);
    return row;
  }
};

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// Where a deflection acts along the span, and how far beside its ends it fades.
struct Reach {
  double from, to;
  double fade;  ///< of the span
};

Reach reach_of(const Deflection& d, const Span& span) {
  const double from = std::max(d.surface.hinge.front().span, 0.0), to = std::min(d.surface.hinge.back().span, 1.0);
  const double chord = 0.5 * (norm(chord_of(span.row_at(from))) + norm(chord_of(span.row_at(to))));
  const double fairing = d.fairing == Deflection::k_automatic_fairing ? 0.1 * chord : d.fairing;
  return {from, to, fairing / span.length};
}

double hinge_chord(const Deflection& d, double s) {
  const std::vector<HingePoint>& hinge = d.surface.hinge;
  for (std::size_t i = 0; i + 1 < hinge.size(); ++i)
    if (s <= hinge[i + 1].span || i + 2 == hinge.size()) {
      const double t = std::clamp((s - hinge[i].span) / (hinge[i + 1].span - hinge[i].span), 0.0, 1.0);
      return hinge[i].chord + t * (hinge[i + 1].chord - hinge[i].chord);
    }
  return hinge.back().chord;
}

/// Point of the hinge line in a row: half way between upper and lower side; and the thickness there.
struct HingePlace {
  Point point;
  double thickness = 0.0;
};
HingePlace hinge_place(const Row& row, double fraction) {
  const Vec3 chord = chord_of(row);
  const auto part = [&](const Point& p) { return dot(p - row[k_nose], chord) / norm2(chord); };
  const auto side = [&](bool is_upper) {
    for (std::size_t k = 0; k < k_nose; ++k) {  // from the trailing edge towards the nose
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
    if (d.surface.wing != wing.name) refuse(ErrorCode::bad_argument, d, "it belongs to wing '" + d.surface.wing + "', not to '" + wing.name + "'");
    if (!(std::abs(d.angle) <= k_max_angle)) refuse(ErrorCode::bad_argument, d, "its angle is " + std::to_string(d.angle * 180.0 / std::numbers::pi) + " degrees; at most 60 are possible");
    if (d.surface.hinge.size() < 2) refuse(ErrorCode::bad_argument, d, "it has " + std::to_string(d.surface.hinge.size()) + " hinge points; at least 2 are needed");
    for (std::size_t i = 1; i < d.surface.hinge.size(); ++i)
      if (!(d.surface.hinge[i].span > d.surface.hinge[i - 1].span)) refuse(ErrorCode::bad_argument, d, "its hinge points do not ascend along the span");
    if (!(d.surface.hinge.front().span < 1.0 && d.surface.hinge.back().span > 0.0)) refuse(ErrorCode::bad_argument, d, "it lies beyond the tips");
    for (const HingePoint& h : d.surface.hinge)
      if (!(h.chord >= 0.0 && h.chord <= 1.0)) refuse(ErrorCode::bad_argument, d, "a hinge point lies at " + std::to_string(h.chord) + " of the chord; it must be within 0 and 1");
    if (d.fairing != Deflection::k_automatic_fairing && !(d.fairing > 0.0)) refuse(ErrorCode::bad_argument, d, "its fairing is " + std::to_string(d.fairing) + " m; it must be positive");
    if (wing.is_cubic) refuse(ErrorCode::unsupported_format, d, "wing '" + wing.name + "' is cubic along its span; only wings that are straight between sections can be bent", "use straight panels between more sections");
  }
}

void check_overlaps(const std::vector<Deflection>& deflections, const Span& span) {
  for (std::size_t i = 0; i < deflections.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) {
      const Deflection &a = deflections[i], &b = deflections[k];
      if (a.angle == 0.0 || b.angle == 0.0) continue;
      if (a.surface.kind != b.surface.kind && a.surface.kind != ControlKind::all_moving && b.surface.kind != ControlKind::all_moving) continue;
      const Reach p = reach_of(a, span), q = reach_of(b, span);
      if (p.from - p.fade < q.to + q.fade && q.from - q.fade < p.to + p.fade)
        refuse(ErrorCode::bad_argument, a, "with its fairings it overlaps '" + b.surface.name + "' along the span: " + std::to_string(p.from - p.fade) + " .. " + std::to_string(p.to + p.fade) + " and " +
                                               std::to_string(q.from - q.fade) + " .. " + std::to_string(q.to + q.fade) + " of it", "give a smaller fairing");
    }
}

/// Turns the moving part of a row; points that do not move stay to the bit.
void turn(Row& row, double s, const Deflection& d, const Span& span) {
  const Reach reach = reach_of(d, span);
  const double outside = std::max({reach.from - s, s - reach.to, 0.0});
  const double share = outside >= reach.fade * (1.0 - k_same_span) && outside > 0.0 ? 0.0 : 1.0 - smooth_step(reach.fade > 0.0 ? outside / reach.fade : 0.0);
  if (share == 0.0) return;
  const double fraction = hinge_chord(d, s);
  const HingePlace hinge = hinge_place(row, fraction);
  // The hinge line around here: of the straight part of it that s is on.
  std::size_t i = 0;
  while (i + 2 < d.surface.hinge.size() && s > d.surface.hinge[i + 1].span) ++i;
  const auto place = [&](const HingePoint& h) { return hinge_place(span.row_at(std::clamp(h.span, 0.0, 1.0)), h.chord).point; };
  Vec3 axis = normalized(place(d.surface.hinge[i + 1]) - place(d.surface.hinge[i]));
  if (std::abs(axis.y) >= std::abs(axis.z) ? axis.y < 0.0 : axis.z < 0.0) axis = -axis;  // positive about +y (a fin: +z) turns trailing edges down (right)
  const Vec3 chord = chord_of(row);
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

}  // namespace

Wing deflected(const Wing& wing, const std::vector<Deflection>& deflections) {
  check(wing, deflections);
  if (std::all_of(deflections.begin(), deflections.end(), [](const Deflection& d) { return d.angle == 0.0; })) return wing;
  WingRows made = wing_rows(wing);
  const Span span(std::move(made.rows));
  check_overlaps(deflections, span);
  std::vector<double> places = span.at;
  for (const Deflection& d : deflections) {
    if (d.angle == 0.0) continue;
    const Reach reach = reach_of(d, span);
    constexpr int k_fade_steps = 4;  // the fade is a quintic: straight pieces of it
    for (int i = 0; i <= k_fade_steps; ++i) {
      places.push_back(reach.from - reach.fade * i / k_fade_steps);
      places.push_back(reach.to + reach.fade * i / k_fade_steps);
    }
    for (const HingePoint& h : d.surface.hinge) places.push_back(h.span);
  }
  std::erase_if(places, [](double s) { return s < 0.0 || s > 1.0; });
  std::sort(places.begin(), places.end());
  // Of places that coincide the sections' own ones stay.
  std::vector<double> kept;
  for (const double s : places) {
    if (!kept.empty() && s - kept.back() <= k_same_span) {
      if (std::binary_search(span.at.begin(), span.at.end(), s)) kept.back() = s;
      continue;
    }
    kept.push_back(s);
  }
  Wing bent = wing;
  bent.is_symmetric = false;
  bent.sections.clear();
  if (wing.is_symmetric) bent.left_tip = wing.left_tip;
  for (const double s : kept) {
    WingSection section{.name = "at " + std::to_string(s) + " of the span"};
    section.loop = span.row_at(s);
    section.is_row = true;
    section.is_break = true;
    for (const Deflection& d : deflections)
      if (d.angle != 0.0) turn(section.loop, s, d, span);
    section.leading_edge = section.loop[k_nose];
    section.chord = norm(chord_of(section.loop));
    bent.sections.push_back(std::move(section));
  }
  return bent;
}

}  // namespace sterna
