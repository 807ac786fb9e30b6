// Size rules: options of surface meshes for faces (patches) by name.
#pragma once

#include "geom/base/rules.h"

namespace sterna::surfmesh {

/// Returns the options that a rule may set: the only list of them. `rule` must outlive the table.
OptionTable size_rule_options(Rule& rule);

}  // namespace sterna::surfmesh
