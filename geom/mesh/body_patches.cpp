#include "geom/mesh/body_patches.h"

#include <algorithm>

namespace sterna {
namespace {

/// Of a body's opening over all walls, by the boxes' diagonals: tunnels' planes are larger.
constexpr double k_largest_opening = 0.2;

double diagonal(const Box& box) { return box.empty() ? 0.0 : norm(box.max - box.min); }

bool is_within(const Box& inner, const Box& outer) {
  const double room = 1e-6 * diagonal(outer);
  return inner.min.x >= outer.min.x - room && inner.min.y >= outer.min.y - room && inner.min.z >= outer.min.z - room && inner.max.x <= outer.max.x + room &&
         inner.max.y <= outer.max.y + room && inner.max.z <= outer.max.z + room;
}

}  // namespace

std::vector<std::uint8_t> patches_of_bodies(const Column<PatchId, Patch>& patches, std::span<const Box> boxes) {
  Box walls;
  for (const PatchId p : patches.ids())
    if (patches[p].kind == PatchKind::wall && !boxes[p.index()].empty()) {
      walls.add(boxes[p.index()].min);
      walls.add(boxes[p.index()].max);
    }
  std::vector<std::uint8_t> result(patches.size(), walls.empty() ? 1 : 0);
  for (const PatchId p : patches.ids()) {
    const Box& box = boxes[p.index()];
    const bool is_opening = (patches[p].kind == PatchKind::inflow || patches[p].kind == PatchKind::outflow) && !box.empty() && !walls.empty() &&
                            is_within(box, walls) && diagonal(box) < k_largest_opening * diagonal(walls);
    if (patches[p].kind == PatchKind::wall || is_opening) result[p.index()] = 1;
  }
  return result;
}

}  // namespace sterna
