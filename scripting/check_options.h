// The options of mesh:check{} and `sterna check` that users see.
#pragma once

#include "geom/base/schema.h"
#include "geom/mesh/check.h"

namespace sterna::scripting {

struct CheckSettings {
  bool intersections = CheckOptions{}.intersections;
  bool quality = CheckOptions{}.quality;
  int findings_per_kind = CheckOptions{}.findings_per_kind;

  CheckOptions to_options() const {
    CheckOptions options;
    options.intersections = intersections;
    options.quality = quality;
    options.findings_per_kind = findings_per_kind;
    return options;
  }
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::CheckSettings> {
  using O = scripting::CheckSettings;
  static constexpr std::string_view stage = "check";
  static constexpr std::array fields = {
      Field<O>{.name = "intersections", .member = &O::intersections, .help = "test boundaries and envelope exactly for intersection (gate G2)"},
      Field<O>{.name = "quality", .member = &O::quality, .help = "measure angles and skew"},
      Field<O>{.name = "findings_per_kind", .member = &O::findings_per_kind, .min = 1, .max = 1e6, .help = "places listed for each kind of violation"},
  };
};

}  // namespace sterna
