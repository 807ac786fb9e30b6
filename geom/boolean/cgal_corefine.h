// The exact union of two or more closed triangulated solids. The one door to CGAL: its headers stay in cgal_corefine.cpp.
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
  std::vector<std::uint32_t> tag;  ///< per triangle; whatever the caller wants to know of it again
};

struct CorefinedUnion {
  TaggedSolid surface;     ///< coordinates are the exact ones, each rounded to the nearest double; a piece of a triangle has its tag
  bool is_solid = true;    ///< false: the surface of the union is not manifold, or the union was refused
  std::size_t failed = 0;  ///< !is_solid: the solid that could not be added to those before it
  std::string reason;      ///< !is_solid: why
};

/// Adds the solids one by one, in order; exact constructions throughout, rounded once at the end, so that no solid is cut by the rounding of an earlier cut.
/// Faces that two solids share exactly are handled; of two coplanar pieces with the same side the one of the earlier solid stays. Serial, one result for any
/// number of threads. Rounding may turn pieces thinner than the last bit; the caller checks the result. Cost: about 10 us a triangle plus 0.2 ms a pair of
/// crossing triangles.
/// \throws Error(cancelled) between solids.
CorefinedUnion corefine_union(const std::vector<TaggedSolid>& solids, const RunContext& context);

}  // namespace sterna
