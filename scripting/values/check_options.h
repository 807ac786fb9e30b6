// The options of mesh:check{} and `sterna check` that users see.
#pragma once

#include "geom/base/schema.h"
#include "geom/mesh/check.h"

namespace sterna::scripting {

struct CheckSettings {
  bool intersections = CheckOptions{}.intersections;
  bool quality = CheckOptions{}.quality;
  int findings_per_kind = CheckOptions{}.findings_per_kind;
  bool cell_centred = CheckOptions{}.cell_centred;
  bool strict = false;

  /// `limits`: gate_limits.h
  CheckOptions to_options(const GateTable& limits = {}) const {
    CheckOptions options;
    options.intersections = intersections;
    options.quality = quality;
    options.findings_per_kind = findings_per_kind;
    options.quality = options.quality || strict;
    options.cell_centred = cell_centred;
    options.limits = limits;
    return options;
  }
  /// Whether the mesh passes: VALID, and with `strict` no QUALITY gate FAILs.
  bool accepts(const CheckReport& report) const { return report.is_valid() && (!strict || report.quality_state() != GateState::fail); }
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::CheckSettings> {
  using O = scripting::CheckSettings;
  static constexpr std::string_view stage = "check";
  static constexpr std::array fields = {
      Field<O>{.name = "intersections", .member = &O::intersections, .help = "test boundaries and envelope exactly for intersection (gate G2)"},
      Field<O>{.name = "quality", .member = &O::quality, .help = "measure the QUALITY gates (dual metrics, growth, angles, skew)"},
      Field<O>{.name = "findings_per_kind", .member = &O::findings_per_kind, .min = 1, .max = 1e6, .help = "places listed for each kind of violation"},
      Field<O>{.name = "cell_centred",
               .member = &O::cell_centred,
               .help = "with quality, measure also what cell-centred solvers feel: OpenFOAM's non-orthogonality, skewness ..."},
      Field<O>{.name = "strict", .member = &O::strict, .help = "a QUALITY gate that FAILs is an error too"},
  };
};

}  // namespace sterna
