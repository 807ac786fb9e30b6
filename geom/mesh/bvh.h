// Parallel bounding-volume hierarchy over boxes and over triangles: nearest point, box overlap, ray; same result for any thread count.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/vec3.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna {

/// Hierarchy over n boxes; items are numbered as given.
class BoxTree {
 public:
  /// Built in parallel by median splits of the box centres along their longest extent, O(n log n); an empty box overlaps nothing.
  /// `leaf_items`: at most so many in a leaf; by default few, as for items whose test costs as much as that of a box, or more.
  /// \throws Error(bad_argument) when a box is not finite, Error(overflow) for 2^31 boxes or more.
  BoxTree(std::span<const Box> boxes, const RunContext& context, std::uint32_t leaf_items = 4);

  /// Calls visit(item) for every item whose box overlaps `box` (closed boxes); visit returns false to stop. Order is deterministic.
  void visit_overlaps(const Box& box, const std::function<bool(std::uint32_t)>& visit) const;
  /// The same for inner loops: no indirect call.
  template <class Visit>
  void for_each_overlap(const Box& box, const Visit& visit) const;
  /// All unordered pairs of items (i < j) with overlapping boxes, sorted. Parallel.
  std::vector<std::array<std::uint32_t, 2>> overlapping_pairs(const RunContext& context) const;

  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< leaf: first entry in order(); inner: left child (right child is first + 1)
    std::uint32_t count = 0;  ///< leaf: number of items; inner: 0
  };
  /// The root comes first, children after their parents; empty when there are no items.
  std::span<const Node> nodes() const { return nodes_; }
  /// Level l is nodes()[level_begins()[l] .. level_begins()[l + 1]); the last entry is the number of nodes.
  std::span<const std::size_t> level_begins() const { return level_begin_; }
  std::span<const std::uint32_t> order() const { return order_; }
  std::span<const Box> boxes() const { return boxes_; }

 private:
  std::vector<Node> nodes_;
  std::vector<std::size_t> level_begin_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;
};

inline bool overlap(const Box& a, const Box& b) {
  return a.min.x <= b.max.x && b.min.x <= a.max.x && a.min.y <= b.max.y && b.min.y <= a.max.y && a.min.z <= b.max.z && b.min.z <= a.max.z;
}

template <class Visit>
void BoxTree::for_each_overlap(const Box& box, const Visit& visit) const {
  if (nodes_.empty()) return;
  // Median splits: the depth is the logarithm of at most 2^31 items, and each level leaves one node behind.
  std::uint32_t stack[64];
  int n = 0;
  stack[n++] = 0;
  while (n > 0) {
    const Node& node = nodes_[stack[--n]];
    if (!overlap(node.box, box)) continue;
    if (node.count == 0) {
      stack[n++] = node.first + 1;
      stack[n++] = node.first;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (overlap(boxes_[order_[i]], box) && !visit(order_[i])) return;
    }
  }
}

struct NearestHit {
  TriangleId triangle;  ///< invalid when nothing lies within the limit
  Point point;
  double distance = std::numeric_limits<double>::infinity();
};

/// Hierarchy over the triangles of a mesh (a copy of the coordinates is kept).
class TriangleTree {
 public:
  /// Built in parallel.
  /// \pre vertex ids in range.
  /// \throws Error(bad_argument) when a corner of a triangle is not finite.
  TriangleTree(const TriMesh& mesh, const RunContext& context);

  /// Nearest point on any triangle within `limit`; of equally near triangles the lowest id. A triangle without area counts as its edges.
  NearestHit nearest(const Point& p, double limit = std::numeric_limits<double>::infinity()) const;
  /// All triangles that the ray p + t d, t >= 0, hits, with t of the hit in the triangle's plane; sorted by t, then id. Triangles are closed and
  /// widened by the rounding error: a ray through an edge or a vertex reports the triangles on both sides, one that passes an edge
  /// within rounding may too. Triangles parallel to the ray or without area are never hit.
  struct RayHit {
    TriangleId triangle;
    double t = 0.0;
  };
  std::vector<RayHit> ray(const Point& p, const Vec3& direction) const;
  /// Generalised winding number of a closed mesh about p: 1 inside for outward normals (Jacobson et al. 2013), hierarchical (Barill et al. 2018)
  /// with an error small enough to tell 0, 1, 2 apart (0.05 at worst in the tests). On the surface itself the value is a half, or undefined at edges.
  double winding_number(const Point& p) const;
  const BoxTree& boxes() const { return tree_; }

 private:
  /// What a node looks like from afar: moments of its area vectors a about the centre, with r from the centre to each triangle's centroid.
  struct FarField {
    Vec3 dipole;                     ///< sum of a
    std::array<double, 6> second{};  ///< of sum r a^T: xx, yy, zz, xy + yx, yz + zy, zx + xz
    Vec3 center;
    double radius = 0.0;
    double area = 0.0;
  };
  FarField far_field_of(std::size_t index) const;

  std::vector<std::array<Point, 3>> corners_;
  BoxTree tree_;
  std::vector<FarField> far_field_;  ///< for each node
};

}  // namespace sterna
