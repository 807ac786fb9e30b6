// The options of mesh:write{}, `sterna mesh` and `sterna convert` for the file of a volume mesh.
#pragma once

#include <string>

#include "geom/base/schema.h"

namespace sterna::scripting {

struct WriteOptions {
  std::string numbering = "automatic";
};

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::WriteOptions> {
  using O = scripting::WriteOptions;
  static constexpr std::string_view stage = "write";
  static constexpr std::array fields = {
      Field<O>{.name = "numbering",
               .member = &O::numbering,
               .help =
                   "of nodes and cells in the file: wall-normal lines and columns first, the rest behind them, as they are made; neighbours near each other; "
                   "or both, lines whole in such an order; automatic: both for OpenFOAM, whose solvers take cells as they come, else lines. A .sterna file "
                   "stays as it was made",
               .choices = "automatic lines bandwidth both"},
  };
};

}  // namespace sterna
