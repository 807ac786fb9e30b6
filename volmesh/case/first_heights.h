// First heights that differ from place to place: values of a function at the vertices of a surface, and between them.
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

/// Immutable; may be asked from many threads.
class FirstHeights {
 public:
  /// One height per vertex, metres.
  /// \throws Error(bad_argument) with the place of a height that is not a length of at least k_least_first_height
  FirstHeights(const TriMesh& surface, std::vector<double> heights, const RunContext& context);
  ~FirstHeights();
  FirstHeights(const FirstHeights&) = delete;
  FirstHeights& operator=(const FirstHeights&) = delete;

  /// At a vertex its height, to the bit; else that of the nearest point of the surface, interpolated in logarithms over its triangle; m.
  double at(const Point& p) const;
  double least() const { return least_; }
  double greatest() const { return greatest_; }
  std::span<const double> values() const { return heights_; }
  /// All heights divided by `factor`, of a finer mesh of a family.
  std::shared_ptr<const FirstHeights> refined(double factor, const RunContext& context) const;

 private:
  TriMesh surface_;
  std::vector<double> heights_;
  double least_ = 0.0, greatest_ = 0.0;
  std::unique_ptr<const TriangleTree> tree_;
};

inline constexpr double k_least_first_height = 1e-12;  ///< m, as of the option first_height

}  // namespace sterna::volmesh
