// Flow conditions and lengths that were found from them: they print what they are, and a length counts as a number of metres wherever one is expected.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/base/schema.h"
#include "volmesh/flow/flow_state.h"

namespace sterna::scripting {

struct QuantityValue {
  std::string_view verb;        ///< that made it: "y_plus", "boundary_layer", "flow"
  double metres = k_automatic;  ///< automatic: conditions, no length
  std::string text;             ///< one line for print and log
  volmesh::FlowState flow;
  std::vector<std::pair<std::string, double>> fields = {};  ///< beside those of the flow: height, friction_velocity ...

  bool is_length() const { return !is_automatic(metres); }
  std::string_view type_text() const { return is_length() ? "a length" : "flow conditions"; }
};

}  // namespace sterna::scripting
