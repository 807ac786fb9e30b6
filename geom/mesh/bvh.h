// Parallel bounding-volume hierarchy over boxes and over triangles: nearest point, box overlap, ray. Results are the same for any thread count.
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

/// Hierarchy over n boxes; items keep the numbers of the input order.
class BoxTree {
 public:
  /// Builds the tree in parallel by median splits of the box centres along their longest extent, O(n log n). An empty box overlaps nothing.
  /// `leaf_items`: maximum number of items in a leaf. The default is small because a test of an item is assumed to cost at least as much as a box test.
  /// \throws Error(bad_argument) if a box is not finite, Error(overflow) for 2^31 boxes or more.
  BoxTree(std::span<const Box> boxes, const RunContext& context, std::uint32_t leaf_items = 4);

  /// Calls visit(item) for every item whose box overlaps `box` (closed boxes); visit returns false to stop. Order is deterministic.
  void visit_overlaps(const Box& box, const std::function<bool(std::uint32_t)>& visit) const;
  /// As visit_overlaps(), without the indirect call; for inner loops.
  template <class Visit>
  void for_each_overlap(const Box& box, const Visit& visit) const;
  /// Returns all unordered pairs of items (i < j) with overlapping boxes, sorted. Parallel.
  std::vector<std::array<std::uint32_t, 2>> overlapping_pairs(const RunContext& context) const;

  struct Node {
    Box box;
    std::uint32_t first = 0;  ///< leaf: first entry in order(); inner node: left child (the right child is first + 1)
    std::uint32_t count = 0;  ///< leaf: number of items; inner node: 0
  };
  /// Returns the nodes: the root first, children after their parents; empty if there are no items.
  std::span<const Node> nodes() const { return nodes_; }
  /// Returns the level offsets: level l is nodes()[level_begins()[l] .. level_begins()[l + 1]); the last entry is the number of nodes.
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
  // Median splits: the depth is at most the logarithm of 2^31 items, and one node per level stays on the stack.
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
  TriangleId triangle;  ///< invalid if no triangle lies within the limit
  Point point;
  double distance = std::numeric_limits<double>::infinity();
};

/// Hierarchy over the triangles of a mesh; keeps a copy of the coordinates.
class TriangleTree {
 public:
  /// Builds the tree in parallel.
  /// \pre vertex ids in range.
  /// \throws Error(bad_argument) if a corner of a triangle is not finite.
  TriangleTree(const TriMesh& mesh, const RunContext& context);

  /// Returns the nearest point on any triangle within `limit`; ties by lowest triangle id. A triangle without area is represented by its edges.
  NearestHit nearest(const Point& p, double limit = std::numeric_limits<double>::infinity()) const;
  /// Triangle hit by the ray p + t d, and t of the hit in the triangle's plane.
  struct RayHit {
    TriangleId triangle;
    double t = 0.0;
  };
  /// Returns all triangles that the ray p + t d, t >= 0, hits; sorted by t, then id. Triangles are closed and widened by the rounding error. A ray through an
  /// edge or a vertex therefore hits the triangles on both sides; a ray that passes an edge within rounding may do so, too. Triangles parallel to the ray or
  /// without area are never hit.
  std::vector<RayHit> ray(const Point& p, const Vec3& direction) const;
  /// Returns the generalised winding number of a closed mesh about p: 1 inside for outward normals (Jacobson et al. 2013), hierarchical (Barill et al. 2018)
  /// with an error small enough to distinguish 0, 1, 2 (at most 0.05 in the tests). On the surface itself the value is a half, or undefined at edges.
  double winding_number(const Point& p) const;
  const BoxTree& boxes() const { return tree_; }

 private:
  /// Far-field moments of a tree node. They are moments of its triangles' area vectors a about the centre of the node; r is the vector from the centre to a
  /// triangle's centroid.
  struct FarField {
    Vec3 dipole;                     ///< sum of a
    std::array<double, 6> second{};  ///< sum of r a^T: xx, yy, zz, xy + yx, yz + zy, zx + xz
    Vec3 center;
    double radius = 0.0;
    double area = 0.0;
  };
  FarField far_field_of(std::size_t index) const;

  std::vector<std::array<Point, 3>> corners_;
  BoxTree tree_;
  std::vector<FarField> far_field_;  ///< one per tree node
};

}  // namespace sterna
