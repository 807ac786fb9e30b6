#include "geom/model/aircraft.h"

namespace sterna {

Transform transform_of(const Placement& p) {
  const Point origin;
  return translation(p.origin) * rotation(origin, {0.0, 0.0, 1.0}, p.rotation.z) * rotation(origin, {0.0, 1.0, 0.0}, p.rotation.y) *
         rotation(origin, {1.0, 0.0, 0.0}, p.rotation.x);
}

std::string_view to_string(ControlKind kind) {
  switch (kind) {
    case ControlKind::trailing_edge: return "trailing edge";
    case ControlKind::leading_edge: return "leading edge";
    case ControlKind::all_moving: return "all moving";
  }
  return "unknown";
}

}  // namespace sterna
