// Half-edge arithmetic: half-edge 3 t + c starts at corner c of triangle t.
// \pre all arguments are valid
#pragma once

#include <cstdint>

#include "geom/base/ids.h"

namespace sterna {

constexpr HalfedgeId halfedge(TriangleId t, int corner) { return HalfedgeId(std::uint64_t{3} * t.value() + static_cast<std::uint64_t>(corner)); }
constexpr TriangleId triangle_of(HalfedgeId h) { return TriangleId::untested(h.value() / 3); }
constexpr int corner_of(HalfedgeId h) { return static_cast<int>(h.value() % 3); }
constexpr HalfedgeId next(HalfedgeId h) { return HalfedgeId::untested(h.value() % 3 == 2 ? h.value() - 2 : h.value() + 1); }
constexpr HalfedgeId previous(HalfedgeId h) { return HalfedgeId::untested(h.value() % 3 == 0 ? h.value() + 2 : h.value() - 1); }

}  // namespace sterna
