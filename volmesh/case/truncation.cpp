#include "volmesh/case/truncation.h"

#include <string>

#include "geom/base/error.h"

namespace sterna::volmesh {

Truncation truncation_of(std::string_view text) {
  if (text == "auto") return Truncation::automatic;
  if (text == "never") return Truncation::never;
  if (text == "always") return Truncation::always;
  throw_bad_argument("truncating the layer", "unknown value \"" + std::string(text) + "\"", {}, "use auto, never or always");
}

}  // namespace sterna::volmesh
