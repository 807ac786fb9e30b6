// The walls of a volume mesh as triangles, their sections by planes and their sharp edges: what looking for places needs.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

struct WallTriangle {
  std::array<std::uint32_t, 3> nodes;  ///< of the mesh, normal into the fluid
  PatchId patch;
};

/// One connected piece of a section.
struct SectionPiece {
  std::vector<std::array<Point, 2>> segments;
  Box box;
};

/// A chain of edges of like sharpness that hang together.
struct EdgeChain {
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< nodes of the mesh
  double length = 0.0;                              ///< m
};

class WallSections {
 public:
  WallSections(const HybridMesh& mesh, const RunContext& context);

  bool empty() const { return triangles_.empty(); }
  const std::vector<WallTriangle>& triangles() const { return triangles_; }
  const Box& box() const { return box_; }
  const Point& point(std::uint32_t node) const { return mesh_.points.raw()[node]; }
  /// Pieces by their lowest triangle; a node in the plane counts as above it.
  std::vector<SectionPiece> section(const Point& origin, const Vec3& normal) const;
  /// Node of the walls with the largest product with a direction; the lowest number of several.
  std::uint32_t extreme_node(const Vec3& direction) const;
  /// Middle of the wall triangle that is nearest to a plane.
  Point nearest_to(const Point& origin, const Vec3& normal) const;
  /// The longest chain of edges that turn by more than `least` radians; concave ones (towards the fluid) or convex; only those between two patches, if asked.
  /// No edges when there is none.
  EdgeChain longest_chain(double least, bool is_concave, bool between_patches) const;
  /// Mean edge of the triangles of the node nearest to a point, m.
  double edge_near(const Point& p) const;
  /// Height of the layer over the wall node nearest to a point, m; 0 where the mesh has no columns.
  double layer_near(const Point& p) const;

 private:
  struct Edge {
    std::uint32_t lower, upper, triangle;
    friend auto operator<=>(const Edge&, const Edge&) = default;
  };
  void choose_triangles(const HybridMesh& mesh);

  const HybridMesh& mesh_;
  std::vector<WallTriangle> triangles_;
  std::vector<Edge> edges_;  ///< three of each triangle, sorted
  Box box_;
};

}  // namespace sterna
