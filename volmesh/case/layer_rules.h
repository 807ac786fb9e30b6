// Layer rules: options of volume meshes for patches by name. This file defines which options a rule may set; volmesh/envelope/patch_layers.h applies them.
#pragma once

#include <span>
#include <string>

#include "geom/base/rules.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::volmesh {

/// Options that only patches have.
struct PatchOptions {
  std::string kind = "as_read";
  double blend = k_automatic;
};

/// Returns the options that a rule may set: the only list of them. `rule` must outlive the table.
OptionTable layer_rule_options(Rule& rule);

/// Returns the patch with the kind that the rules give. If several rules give one, the last rule applies.
Patch with_kind(Patch patch, std::span<const Rule> rules);

}  // namespace sterna::volmesh

namespace sterna {

template <>
struct Schema<volmesh::PatchOptions> {
  using O = volmesh::PatchOptions;
  static constexpr std::string_view stage = "patches";
  static constexpr std::array fields = {
      Field<O>{.name = "kind",
               .member = &O::kind,
               .help = "kind of these patches; only walls carry layers",
               .choices = "as_read wall slip symmetry inflow outflow farfield interface"},
      Field<O>{.name = "blend", .member = &O::blend, .unit = Unit::metre, .min = 1e-12, .help = "blending distance from walls with other layer settings"},
  };
};

}  // namespace sterna
