// Points inside a boundary until tetrahedra have the sizes that are asked for: by fronts from the boundary inwards, then circumcentres where they meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "geom/base/run_context.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// Wanted length of edges at a place, m; a reference to a callable double(const Vec3&) that any thread may call. Positive, and it grows slower than the
/// distance.
class SizeFunction {
 public:
  template <class F>
  SizeFunction(const F& f) : object_(&f), call_([](const void* o, const Vec3& p) { return (*static_cast<const F*>(o))(p); }) {}
  double operator()(const Vec3& p) const { return call_(object_, p); }

 private:
  const void* object_;
  double (*call_)(const void*, const Vec3&);
};

struct RefineReport {
  int rounds = 0;
  std::int64_t n_candidates = 0;
  std::int64_t n_inserted = 0;
  std::int64_t n_serial = 0;   ///< candidates that no block could take
  std::int64_t n_left = 0;     ///< tetrahedra that are larger than wanted, and no point helped
  std::int64_t n_far = 0;      ///< of these, with corners far apart and a sphere that is far larger: flat ones that lie over many triangles of the boundary
  double bytes = 0.0;          ///< of the arrays at their largest
  bool is_over_limit = false;  ///< more bytes than were allowed: unfinished
};

/// Inserts points until every tetrahedron's circumradius fits the size at its centroid, as far as the boundary lets it. In rounds: each tetrahedron that is too
/// large and touches the boundary, or one that is right, proposes a point at the wanted distance from that face on the line of the points that its corners have
/// as nearest (Rebay 1993), or its circumcentre where that is nearer; where nobody proposes, circumcentres. A point is inserted unless one of the mesh is
/// nearer than 0.7 of the size, of the boundary 0.6. Points nearer to a boundary triangle than would leave room for a good tetrahedron are not. Edges have the
/// wanted length in the geometric mean. Parallel, same bytes for any number of threads.
/// \pre as connect() makes it; the first points, and those of the boundary, stay
/// \post the same boundary; tetrahedra positive; new points behind the old ones, each used. Points in the volume may be gone.
/// \p most_bytes: looked at after each round; \p expected: tetrahedra, for room to begin with, or 0
/// \throws Error(cancelled); Error(overflow) for more tetrahedra than a mesh can have
RefineReport refine(TetMesh& mesh, std::uint32_t n_kept_points, const SizeFunction& sizes, const RunContext& context,
                    double most_bytes = std::numeric_limits<double>::infinity(), std::size_t expected = 0);

}  // namespace sterna::tets
