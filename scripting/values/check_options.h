// The user options of mesh:check{} and `sterna check`.
#pragma once

#include <optional>
#include <string>
#include <string_view>

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

  /// Spelling of the options in messages.
  struct Names {
    std::string_view solvers, no_cell_centred;
  };
  static constexpr Names k_script_names{"solvers", "cell_centred = false"}, k_command_names{"--for", "--no-cell-centred"};
  /// Two options that exclude each other.
  struct Contradiction {
    std::string problem, remedy;
  };
  /// Returns the first pair of options of which one requests gates that the other switches off. Arguments as for to_options().
  std::optional<Contradiction> contradiction(const GateTable& limits, Consumers usual, const Names& names) const;

  /// \p limits gate_limits.h; \p usual consumers if the solvers are automatic, from which `cell_centred = false` removes the cell-centred solvers
  /// \throws Error(bad_argument) if the options contradict each other, or if a solver is unknown
  CheckOptions to_options(const GateTable& limits = {}, Consumers usual = {}, const Names& names = k_script_names) const;
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
