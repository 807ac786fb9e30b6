// Boxes that part space, with about as many points in each: who works where.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"

namespace sterna::tets {

/// A box without its upper sides; all of space at first.
struct Block {
  Vec3 low = {-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  Vec3 high = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

  bool holds(const Vec3& p) const { return p.x >= low.x && p.x < high.x && p.y >= low.y && p.y < high.y && p.z >= low.z && p.z < high.z; }
};

/// Space is halved time after time at the longest side of the points there, so that the lower part has a share of them.
class Blocks {
 public:
  /// \p n_halvings: at most 6; there are 2^n_halvings blocks. \p share: in (0, 1). Others give other planes everywhere.
  /// \post the same for any number of threads
  Blocks(std::vector<Vec3> points, int n_halvings, double share, const RunContext& context);

  std::size_t size() const { return blocks_.size(); }
  const Block& operator[](std::size_t i) const { return blocks_[i]; }
  /// The block that holds a point. \pre finite
  std::size_t find(const Vec3& p) const;

 private:
  struct Plane {
    std::size_t axis = 0;
    double at = 0.0;
  };
  std::vector<Plane> planes_;  ///< those that halve plane i's sides are 2 i + 1 and 2 i + 2
  std::vector<Block> blocks_;
};

}  // namespace sterna::tets
