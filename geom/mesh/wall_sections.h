// The walls of a volume mesh as triangles, their sections by planes and their sharp edges; used for the selection of cut planes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

struct WallTriangle {
  std::array<std::uint32_t, 3> nodes;  ///< nodes of the mesh, normal into the fluid
  PatchId patch;
};

/// One connected piece of a section.
struct SectionPiece {
  std::vector<std::array<Point, 2>> segments;
  Box box;
};

/// A connected chain of edges of similar sharpness.
struct EdgeChain {
  std::vector<std::array<std::uint32_t, 2>> edges;  ///< nodes of the mesh
  double length = 0.0;                              ///< m
};

class WallSections {
 public:
  WallSections(Borrowed<const HybridMesh> mesh, const RunContext& context);

  bool empty() const { return triangles_.empty(); }
  const std::vector<WallTriangle>& triangles() const { return triangles_; }
  const Box& box() const { return box_; }
  const Point& point(std::uint32_t node) const { return mesh_.points.raw()[node]; }
  /// Returns the pieces ordered by their lowest triangle; a node in the plane counts as above it.
  std::vector<SectionPiece> section(const Point& origin, const Vec3& normal) const;
  /// Returns the wall node that is farthest in a direction; ties by the lowest number.
  std::uint32_t extreme_node(const Vec3& direction) const;
  /// Returns the centre of the wall triangle that is nearest to a plane.
  Point nearest_to(const Point& origin, const Vec3& normal) const;
  /// Returns the longest chain of concave (towards the fluid) or convex edges that turn by more than `least` radians. If requested, only edges between two
  /// patches are considered. Empty if there is none.
  EdgeChain longest_chain(double least, bool is_concave, bool between_patches) const;
  /// Returns the mean edge of the triangles at the node nearest to a point, m.
  double edge_near(const Point& p) const;
  /// Returns the layer height at the wall node nearest to a point, m; 0 if the mesh has no columns.
  double layer_near(const Point& p) const;

 private:
  struct Edge {
    std::uint32_t lower, upper, triangle;
    friend auto operator<=>(const Edge&, const Edge&) = default;
  };
  void choose_triangles(const HybridMesh& mesh);

  const HybridMesh& mesh_;
  std::vector<WallTriangle> triangles_;
  std::vector<Edge> edges_;  ///< three per triangle, sorted
  Box box_;
};

}  // namespace sterna
