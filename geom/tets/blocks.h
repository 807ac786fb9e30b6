// Partition of space into boxes with about the same number of points in each, for parallel work.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::tets {

/// A box that does not include its upper sides; initially all of space.
struct Block {
  Vec3 low = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  Vec3 high = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

  bool holds(const Vec3& p) const { return p.x >= low.x && p.x < high.x && p.y >= low.y && p.y < high.y && p.z >= low.z && p.z < high.z; }
};

/// Partition of space by recursive bisection. Each step divides the longest side of the points' box so that the lower part contains a given fraction of the
/// points.
class Blocks {
 public:
  /// \p n_halvings: at most 6; there are 2^n_halvings blocks. \p share: in (0, 1). A different share gives different planes everywhere.
  /// \post the same for any number of threads
  Blocks(std::vector<Vec3> points, int n_halvings, double share, const RunContext& context);

  std::size_t size() const { return blocks_.size(); }
  const Block& operator[](std::size_t i) const { return blocks_[i]; }
  /// Returns the block that contains a point. \pre finite
  std::size_t find(const Vec3& p) const;

 private:
  struct Plane {
    std::size_t axis = 0;
    double at = 0.0;
  };
  std::vector<Plane> planes_;  ///< binary tree: the two sides of plane i are divided by planes 2 i + 1 and 2 i + 2
  std::vector<Block> blocks_;
};

}  // namespace sterna::tets
