// Welding of vertices and removal of facets that bound nothing: first half of stitch_surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::surfmesh {

/// Indexed triangles with one patch number each.
struct IndexedSurface {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> patch;
};

/// Makes vertices with equal coordinates (0.0 = -0.0) one; keeps the order of first appearance. Returns how many went.
std::int64_t weld_exact(IndexedSurface& surface, const RunContext& context);
/// Makes vertices nearer than `tolerance` one (chains included); the lowest index stays. With `only`, just marked vertices take part.
std::int64_t weld_near(IndexedSurface& surface, double tolerance, const std::vector<std::uint8_t>* only);
/// Drops facets with a repeated vertex.
std::int64_t drop_collapsed(IndexedSurface& surface);
/// Of facets on the same three vertices (any orientation) keeps the first.
std::int64_t drop_duplicates(IndexedSurface& surface);
/// Removes facets of zero area with three distinct vertices by flipping their longest edge with the neighbour. Returns how many were removed; those that
/// cannot be flipped without making another zero-area facet or a repeated edge stay.
std::int64_t flip_zero_area(IndexedSurface& surface);
/// Drops vertices that no facet uses.
std::int64_t drop_unused(IndexedSurface& surface);

}  // namespace sterna::surfmesh
