// Steps: find the locations along the span where the shape changes; make cross sections there; add faces between them, the nose, and the end walls.
#include "geom/model/moving_part.h"

#include <algorithm>
#include <cmath>

#include "geom/model/model_builder.h"
#include "geom/model/nurbs_surface.h"
#include "geom/model/slot_faces.h"

namespace sterna {
namespace {

/// Cross section of the part. It consists of pieces of both sides of the wing, from the trailing edge towards the leading edge.
struct PartSection {
  double location = 0.0;
  WingPatch::Location hinge;
  SplitCurve upper, lower;
  EdgeId thickness;  ///< edge of a blunt trailing edge
  SlotStation nose;
};

class PartBuilder {
 public:
  PartBuilder(const Wing& wing, const WingPatch& patch, const std::vector<WingSides>& panels, bool is_blunt)
      : patch_(patch),
        panels_(panels),
        is_flap_(patch.kind == ControlKind::trailing_edge),
        is_blunt_(is_blunt && is_flap_),
        builder_({patch.name, wing.is_pylon ? ComponentKind::pylon : ComponentKind::wing}) {}
  Model build();

 private:
  std::vector<double> locations() const;
  PartSection section(double location);
  void faces(const PartSection& a, const PartSection& b, EdgeId& upper_hinge, EdgeId& lower_hinge);

  const WingPatch& patch_;
  const std::vector<WingSides>& panels_;
  bool is_flap_, is_blunt_;
  ModelBuilder builder_;
};

std::vector<double> PartBuilder::locations() const {
  std::vector<double> locations{patch_.slot->from, patch_.slot->to};
  const auto add = [&](double location) {
    if (location > patch_.slot->from && location < patch_.slot->to) add_sorted(locations, location);
  };
  for (const WingPatch::Location& p : patch_.slot->hinge) add(p.section);
  for (const WingSides& panel : panels_) add(static_cast<double>(panel.first_row));
  return locations;
}

PartSection PartBuilder::section(double location) {
  const WingSides& sides = panel_at(panels_, location, location > patch_.slot->from);
  const double v = sides.v(location);
  PartSection s{.location = location, .hinge = crossing_at(patch_.slot->hinge, location)};
  const CurvePtr upper = line_of_constant_v(sides.upper, v), lower = line_of_constant_v(sides.lower, v);
  const CornerId upper_hinge = builder_.corner(upper->point(s.hinge.upper)), lower_hinge = builder_.corner(lower->point(s.hinge.lower));
  const CornerId upper_end = builder_.corner(upper->point(is_flap_ ? 0.0 : 1.0)), lower_end = is_blunt_ ? builder_.corner(lower->point(0.0)) : upper_end;
  if (is_flap_) {
    s.upper = builder_.split_curve(upper, {0.0, s.hinge.upper}, upper_end, upper_hinge);
    s.lower = builder_.split_curve(lower, {0.0, s.hinge.lower}, lower_end, lower_hinge);
  } else {
    s.upper = builder_.split_curve(upper, {s.hinge.upper, 1.0}, upper_hinge, upper_end);
    s.lower = builder_.split_curve(lower, {s.hinge.lower, 1.0}, lower_hinge, lower_end);
  }
  if (is_blunt_) s.thickness = builder_.straight_edge(upper_end, lower_end);
  s.nose = {upper_hinge, lower_hinge, {}};
  const HingeSection hinge = hinge_section(sides, patch_, location);
  if (!patch_.slot->is_flat) s.nose.bulge = Bulge{hinge.middle, hinge.ahead, 0.5 * distance(hinge.upper, hinge.lower)};
  return s;
}

void PartBuilder::faces(const PartSection& a, const PartSection& b, EdgeId& upper_hinge, EdgeId& lower_hinge) {
  const WingSides& sides = panel_at(panels_, b.location, true);
  const double from = sides.v(a.location), to = sides.v(b.location);
  const auto side = [&](const SplitCurve& start, const SplitCurve& end, double start_hinge, double end_hinge, const NurbsSurfaceForm& form,
                        const SurfacePtr& surface, EdgeId trailing) {
    const double far = is_flap_ ? 0.0 : 1.0;
    const EdgeId hinge = builder_.edge(line_on_surface(form, {start_hinge, from}, {end_hinge, to}), {0.0, 1.0},
                                       is_flap_ ? start.corners.back() : start.corners.front(), is_flap_ ? end.corners.back() : end.corners.front(), "hinge");
    const Uv near_start{start_hinge, from}, near_end{end_hinge, to}, far_start{far, from}, far_end{far, to};
    if (is_flap_)
      builder_.face(surface,
                    {{start.edges[0], far_start, near_start}, {hinge, near_start, near_end}, {end.edges[0], near_end, far_end}, {trailing, far_end, far_start}},
                    FaceRole::control, patch_.name);
    else
      builder_.face(surface,
                    {{start.edges[0], near_start, far_start}, {trailing, far_start, far_end}, {end.edges[0], far_end, near_end}, {hinge, near_end, near_start}},
                    FaceRole::control, patch_.name);
    return hinge;
  };
  const auto end_edge = [&](const NurbsSurfaceForm& form, const SplitCurve& start, const SplitCurve& end) {
    return builder_.edge(line_of_constant_u(form, is_flap_ ? 0.0 : 1.0), {from, to}, is_flap_ ? start.corners.front() : start.corners.back(),
                         is_flap_ ? end.corners.front() : end.corners.back(), is_flap_ ? "trailing edge" : "leading edge");
  };
  const EdgeId upper_end = end_edge(sides.upper, a.upper, b.upper), lower_end = is_blunt_ ? end_edge(sides.lower, a.lower, b.lower) : upper_end;
  upper_hinge = side(a.upper, b.upper, a.hinge.upper, b.hinge.upper, sides.upper, sides.upper_surface, upper_end);
  lower_hinge = side(a.lower, b.lower, a.hinge.lower, b.hinge.lower, sides.lower, sides.lower_surface, lower_end);
  if (!is_blunt_) return;
  builder_.patch(trailing_edge_surface(sides), {{0.0, 1.0}, {from, to}}, {a.thickness, lower_end, b.thickness, upper_end}, FaceRole::trailing_edge,
                 patch_.name);
}

Model PartBuilder::build() {
  std::vector<PartSection> sections;
  for (const double location : locations()) sections.push_back(section(location));
  std::vector<SlotStation> noses;
  std::vector<SplitCurve> nose_sections;
  for (const PartSection& s : sections) {
    noses.push_back(s.nose);
    nose_sections.push_back(slot_section(builder_, s.nose));
  }
  std::vector<EdgeId> upper(sections.size() - 1), lower(sections.size() - 1);
  for (std::size_t i = 0; i + 1 < sections.size(); ++i) faces(sections[i], sections[i + 1], upper[i], lower[i]);
  slot_strip(builder_, nose_sections, noses, upper, lower, FaceRole::hinge, patch_.name);
  for (const std::size_t i : {std::size_t{0}, sections.size() - 1})
    slot_wall(builder_, {sections[i].upper, sections[i].lower, !is_flap_, is_blunt_ ? std::optional(sections[i].thickness) : std::nullopt}, nose_sections[i],
              FaceRole::control_side, patch_.name);
  return builder_.closed_solid(patch_.name);
}

}  // namespace

Model make_moving_part(const Wing& wing, const WingPatch& patch, const std::vector<WingSides>& panels, bool is_blunt) {
  return PartBuilder(wing, patch, panels, is_blunt).build();
}

}  // namespace sterna
