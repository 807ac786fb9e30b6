// Inserts points inside a boundary until the tetrahedra have their target sizes. Fronts advance from the boundary inwards; circumcentres are inserted where
// fronts meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "geom/base/run_context.h"
#include "geom/tets/tet_mesh.h"

namespace sterna::tets {

/// Target edge length at a location, m; a reference to a callable double(const Vec3&) that any thread may call. Positive, with a slope below 1.
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
  std::int64_t n_serial = 0;  ///< candidates that no block could insert
  std::int64_t n_left = 0;    ///< tetrahedra that are larger than the target and could not be improved by a point
  std::int64_t n_far = 0;  ///< flat tetrahedra among n_left that lie over many triangles of the boundary: their corners are far apart and their sphere is much
                           ///< larger
  double bytes = 0.0;      ///< largest size of the arrays
  bool is_over_limit = false;  ///< stopped early because the memory limit was exceeded
};

/// Inserts points until every tetrahedron's circumradius fits the size at its centroid, as far as the boundary allows. Works in rounds. In each round,
/// tetrahedra that are too large and have a face on the boundary or on a tetrahedron of the right size propose a point. It lies at the target distance from
/// that face, on the line of the points equidistant from the corners of the face (Rebay 1993); or it is the circumcentre of the tetrahedron, if that is nearer.
/// If there are no such tetrahedra, all that are too large propose their circumcentres. A point is inserted unless a point of the mesh is nearer than 0.7 of
/// the size, or a boundary point nearer than 0.6. Points too near to a boundary triangle for a good tetrahedron are not inserted. Edges have the target length
/// in the geometric mean. Parallel; the result has the same bytes for any number of threads.
/// \pre mesh as made by connect(); the first points, and those of the boundary, stay
/// \post the boundary is unchanged and all tetrahedra are positive; new points follow the old ones, and each is used. Points in the volume may have been
/// removed.
/// \p most_bytes: checked after each round; \p expected: number of tetrahedra for the initial reservation, or 0
/// \throws Error(cancelled); Error(overflow) for more tetrahedra than a mesh can have
RefineReport refine(TetMesh& mesh, std::uint32_t n_kept_points, const SizeFunction& sizes, const RunContext& context,
                    double most_bytes = std::numeric_limits<double>::infinity(), std::size_t expected = 0);

}  // namespace sterna::tets
