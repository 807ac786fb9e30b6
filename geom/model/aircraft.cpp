#include "geom/model/aircraft.h"

namespace sterna {

std::string_view to_string(ControlKind kind) {
  switch (kind) {
    case ControlKind::trailing_edge: return "trailing edge";
    case ControlKind::leading_edge: return "leading edge";
    case ControlKind::all_moving: return "all moving";
  }
  return "unknown";
}

}  // namespace sterna
