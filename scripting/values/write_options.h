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
               .help = "order of nodes and cells in the file. lines: wall-normal lines and columns first; bandwidth: neighbours near each other; both: whole "
                       "lines, ordered by bandwidth; automatic: both for OpenFOAM, otherwise lines. .sterna files keep the order of the mesh",
               .choices = "automatic lines bandwidth both"},
  };
};

}  // namespace sterna
