// The user options of mesh:check{} and `sterna check`.
#pragma once

#include "geom/base/schema.h"
#include "geom/mesh/check.h"
#include "scripting/values/consumers.h"

namespace sterna::scripting {

struct CheckSettings {
  bool intersections = CheckOptions{}.intersections;
  bool quality = CheckOptions{}.quality;
  int findings_per_kind = CheckOptions{}.findings_per_kind;
  bool cell_centred = CheckOptions{}.cell_centred;
  bool strict = false;
  std::string solvers = "automatic";

  /// \p limits gate_limits.h; \p usual consumers if the solvers are automatic
  CheckOptions to_options(const GateTable& limits = {}, Consumers usual = {}, std::string_view option = "solvers") const {
    CheckOptions options;
    options.consumers = consumers_of_solvers(solvers, usual, option);
    options.intersections = intersections;
    options.quality = quality;
    options.findings_per_kind = findings_per_kind;
    options.quality = options.quality || strict;
    options.cell_centred = cell_centred;
    options.limits = limits;
    return options;
  }
  /// Returns true if the mesh passes: VALID and, with `strict`, no QUALITY gate FAILs for the requested solvers.
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
      Field<O>{
          .name = "findings_per_kind", .member = &O::findings_per_kind, .min = 1, .max = 1e6, .help = "number of locations listed for each kind of violation"},
      Field<O>{.name = "cell_centred",
               .member = &O::cell_centred,
               .help = "with quality, also compute the measures of cell-centred solvers: OpenFOAM's non-orthogonality, skewness ..."},
      Field<O>{.name = "strict", .member = &O::strict, .help = "treat a QUALITY gate that FAILs as an error"},
      Field<O>{.name = "solvers",
               .member = &O::solvers,
               .help = "solvers of the verdict, separated by commas: su2, tau, edge, fun3d (node-centred), openfoam, fluent (cell-centred), all; automatic: "
                       "solvers that read the format of the file, otherwise all"},
  };
};

}  // namespace sterna
