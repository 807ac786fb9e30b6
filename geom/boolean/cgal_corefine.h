// Exact union of two or more closed triangulated solids. The only interface to CGAL's corefinement, whose headers stay in cgal_corefine.cpp.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna {

/// A closed, manifold solid without self-intersection, normals outwards.
struct TaggedSolid {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> tag;  ///< per triangle; user tag, carried to the result
};

struct CorefinedUnion {
  TaggedSolid surface;     ///< the exact coordinates, each rounded to the nearest double; a piece of a triangle has the tag of that triangle
  bool is_solid = true;    ///< false: the surface of the union is not manifold, or CGAL rejected the union
  std::size_t failed = 0;  ///< !is_solid: index of the solid that could not be added to the previous ones
  std::string reason;      ///< !is_solid: the cause
};

/// Adds the solids one by one, in order. Exact constructions are used throughout and rounded once at the end, so that no solid is cut by the rounding of an
/// earlier cut. Faces that two solids share exactly are handled: if both solids are on the same side of the face, the piece of the earlier solid is kept.
/// Serial; the result is the same for any number of threads. Rounding may invert pieces thinner than the last bit; the caller must check the result. Cost:
/// about 10 us per triangle plus 0.2 ms per pair of crossing triangles.
/// \throws Error(cancelled) between solids
CorefinedUnion corefine_union(const std::vector<TaggedSolid>& solids, const RunContext& context);

}  // namespace sterna
