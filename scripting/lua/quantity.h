// Flow conditions and the lengths derived from them. They can be printed, and a length can be used as a number of metres where one is expected.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/base/schema.h"
#include "volmesh/flow/flow_state.h"

namespace sterna::scripting {

struct QuantityValue {
  std::string_view verb;        ///< verb that made it: "y_plus", "boundary_layer", "flow"
  double metres = k_automatic;  ///< the derived length; automatic: the quantity consists of flow conditions only
  std::string text;             ///< one line for print and log
  volmesh::FlowState flow;
  std::vector<std::pair<std::string, double>> fields = {};  ///< fields in addition to those of the flow: height, friction_velocity ...

  bool is_length() const { return !is_automatic(metres); }
  std::string_view type_text() const { return is_length() ? "a length" : "flow conditions"; }
};

}  // namespace sterna::scripting
