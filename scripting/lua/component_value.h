// A component of an aircraft that a script describes: wing{}, fuselage{} and so on. Unlike all other values it can be changed in place, because scripts deflect
// and move components in statements: wing:deflect{...}.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geom/model/aircraft.h"
#include "geom/model/model.h"

namespace sterna::scripting {

struct ComponentValue {
  ComponentKind kind = ComponentKind::body;
  std::variant<Body, Wing> shape;
  std::string intake, exhaust;          ///< patch names of a nacelle's fan face and nozzle; empty: its own name
  std::vector<Deflection> deflections;  ///< deflections of a wing, including those of zero angle, in the order of the script

  const std::string& name() const {
    return std::visit([](const auto& s) -> const std::string& { return s.name; }, shape);
  }
  Placement& placement() {
    return std::visit([](auto& s) -> Placement& { return s.placement; }, shape);
  }
  const Placement& placement() const {
    return std::visit([](const auto& s) -> const Placement& { return s.placement; }, shape);
  }
  bool has_mirror_image() const {
    return std::visit([](const auto& s) { return s.has_mirror_image; }, shape);
  }
  /// Returns "a wing", "a nacelle": for messages.
  std::string_view type_text() const {
    switch (kind) {
      case ComponentKind::wing: return "a wing";
      case ComponentKind::nacelle: return "a nacelle";
      case ComponentKind::pylon: return "a pylon";
      case ComponentKind::fairing: return "a fairing";
      case ComponentKind::boom: return "a boom";
      case ComponentKind::sting: return "a sting";
      default: return "a body";
    }
  }
};

}  // namespace sterna::scripting
