// A closed cylinder built from sterna's own curves and surfaces: seam, two circles, two caps.
#pragma once

#include <memory>
#include <string>

#include "geom/model/analytic_surfaces.h"
#include "geom/model/curves.h"
#include "geom/model/model.h"

namespace sterna::test {

inline Model cylinder(double radius, double height, const Point& base = {}, const std::string& name = "can") {
  Model model;
  const Frame frame{base, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const Frame top{base + Vec3{0, 0, height}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double turn = k_full_turn.to;
  const ComponentId component = model.components.push_back({.name = name});
  const CornerId low = model.corners.push_back({base + Vec3{radius, 0, 0}});
  const CornerId high = model.corners.push_back({base + Vec3{radius, 0, height}});
  const EdgeId bottom_circle = model.edges.push_back({.curve = circle(frame, radius, k_full_turn), .range = k_full_turn, .start = low, .end = low});
  const EdgeId top_circle = model.edges.push_back({.curve = circle(top, radius, k_full_turn), .range = k_full_turn, .start = high, .end = high});
  const EdgeId seam = model.edges.push_back(
      {.curve = std::make_shared<LineCurve>(base + Vec3{radius, 0, 0}, Vec3{0, 0, 1}, Interval{0, height}), .range = {0, height}, .start = low, .end = high});
  const auto line = [](Uv from, Uv direction, Interval range) { return std::make_shared<ParameterLine>(from, direction, range); };
  const auto arc = std::make_shared<ParameterArc>(Uv{0, 0}, Uv{radius, 0}, Uv{0, radius}, k_full_turn);
  ModelFace side{.surface = std::make_shared<CylinderSurface>(frame, radius, ParameterBox{k_full_turn, {0, height}}),
                 .borders = {},
                 .component = component,
                 .name = name + " side"};
  side.borders = {{{bottom_circle, false, line({0, 0}, {1, 0}, k_full_turn)},
                   {seam, false, line({turn, 0}, {0, 1}, {0, height})},
                   {top_circle, true, line({0, height}, {1, 0}, k_full_turn)},
                   {seam, true, line({0, 0}, {0, 1}, {0, height})}}};
  side.colour = {1.0f, 0.5f, 0.0f};
  side.layer = "skin";
  const ParameterBox square{{-radius, radius}, {-radius, radius}};
  ModelFace cap{.surface = std::make_shared<PlaneSurface>(top, square), .borders = {{{top_circle, false, arc}}}, .component = component, .name = name + " top"};
  ModelFace floor{.surface = std::make_shared<PlaneSurface>(frame, square),
                  .borders = {{{bottom_circle, false, arc}}},
                  .is_reversed = true,
                  .component = component,
                  .name = name + " bottom"};
  ModelSolid solid{.name = name, .faces = {model.faces.push_back(side), model.faces.push_back(cap), model.faces.push_back(floor)}, .is_closed = true};
  model.solids.push_back(solid);
  return model;
}

}  // namespace sterna::test
