// First heights that vary over the surface: the values of a function at the vertices are interpolated between them.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {
class TriangleTree;  // geom/mesh/bvh.h
}

namespace sterna::volmesh {

/// Immutable. at() is thread-safe.
class FirstHeights {
 public:
  /// \p heights one per vertex, in metres
  /// \throws Error(bad_argument) with the location of a height that is not a length of at least k_least_first_height
  FirstHeights(const TriMesh& surface, std::vector<double> heights, const RunContext& context);
  ~FirstHeights();
  FirstHeights(const FirstHeights&) = delete;
  FirstHeights& operator=(const FirstHeights&) = delete;

  /// Returns the height at a point in metres. At a vertex the given value is returned bit-exactly. Elsewhere the logarithms of the heights are interpolated at
  /// the nearest point of the surface.
  double at(const Point& p) const;
  double least() const { return least_; }
  double greatest() const { return greatest_; }
  std::span<const double> values() const { return heights_; }
  /// Returns all heights divided by `factor`, for a finer member of a mesh family.
  std::shared_ptr<const FirstHeights> refined(double factor, const RunContext& context) const;

 private:
  TriMesh surface_;
  std::vector<double> heights_;
  double least_ = 0.0, greatest_ = 0.0;
  std::unique_ptr<const TriangleTree> tree_;
};

inline constexpr double k_least_first_height = 1e-12;  ///< m; the same lower limit as that of the option first_height

}  // namespace sterna::volmesh
