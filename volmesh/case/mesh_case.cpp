#include "volmesh/case/mesh_case.h"

#include <algorithm>

namespace sterna::volmesh {

OptionTable options_of(VolumeMeshOptions& options) {
  OptionTable table;
  const auto add = [&](OptionTable stage) {
    for (Option& option : stage) table.push_back(std::move(option));
  };
  add(sterna::options_of(options.family));
  add(sterna::options_of(options.envelope));
  add(sterna::options_of(options.prisms));
  add(sterna::options_of(options.farfield));
  add(sterna::options_of(options.ends));
  add(sterna::options_of(options.size));
  add(sterna::options_of(options.tetrahedra));
  add(sterna::options_of(options.improve));
  return table;
}

OptionTable required_options_of(VolumeMeshOptions& options) {
  OptionTable table = options_of(options);
  const bool has_own = std::any_of(options.patches.begin(), options.patches.end(), [](const PatchRule& rule) { return !is_automatic(rule.first_height); });
  for (Option& option : table)
    if (option.name == "first_height" && has_own) option.required = false;
  return table;
}

}  // namespace sterna::volmesh
