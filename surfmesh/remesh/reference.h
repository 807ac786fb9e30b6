// The given surface in the form that remeshing uses: lines (sharp edges, patch borders, open boundaries), smooth pieces between them, normals, and a curved
// patch over each triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

inline constexpr std::int32_t k_no_line = -1;

/// A run of edges between two different corners. Closed runs are cut into three lines.
struct FeatureLine {
  std::vector<VertexId> vertices;
  std::vector<HalfedgeId> halfedges;  ///< for each segment the half-edge that starts at its first vertex; if it does not exist, the half-edge that ends there
  std::vector<Vec3> bulges;           ///< for each segment the vector from its middle to the middle of the curve
  std::vector<double> lengths;        ///< length along the polyline at each vertex
  bool is_nose = false;               ///< smooth leading edge: its edges are a line only because rows are requested there
  double length() const { return lengths.back(); }
};

/// A location on a triangle of the reference; the weight of its first corner is 1 - b1 - b2.
struct ReferenceLocation {
  TriangleId triangle;
  double b1 = 0.0, b2 = 0.0;
};

struct ReferenceOptions {
  double feature_angle = 0.0;  ///< rad
  double line_scale = 0.0;     ///< m: length over which turns of lines are measured to find corners
  bool is_smooth = true;
  std::vector<std::array<VertexId, 2>> noses{};  ///< edges along smooth leading edges, which are feature lines although the surface is smooth across them
};

struct Reference {
  const TriMesh* mesh = nullptr;
  Topology topology;
  Column<TriangleId, Vec3> triangle_normals;  ///< unit; triangles too thin for a normal take the normal of their surroundings
  Column<HalfedgeId, std::int32_t> line;      ///< line of the edge; k_no_line: none
  Column<HalfedgeId, std::uint32_t> segment;  ///< segment of the edge in its line
  Column<HalfedgeId, Vec3> normals;           ///< normal at the half-edge's first vertex, in the smooth piece of its triangle
  Column<HalfedgeId, Vec3> bulges;            ///< bulge of the edge: vector from its middle to the surface; the same for both half-edges
  Column<TriangleId, std::uint32_t> region;   ///< smooth piece of the triangle
  Column<TriangleId, std::uint8_t> is_kept;   ///< true for triangles that stay unchanged in the result
  Column<VertexId, std::uint8_t> is_corner;   ///< true for ends of lines and for vertices of kept triangles
  std::vector<FeatureLine> lines;

  /// \param kept true for triangles that remain unchanged; empty if there are none. \param flat true for triangles without bulge; empty if there are none
  Reference(const TriMesh& wall, const ReferenceOptions& options, const Column<TriangleId, std::uint8_t>& kept, const Column<TriangleId, std::uint8_t>& flat,
            const RunContext& context);

  /// Returns the nearest location on the triangles that can be reached from `start` without crossing a line. The search is a walk that approaches p in each
  /// step.
  ReferenceLocation nearest(const Point& p, TriangleId start) const;
  Point flat_point(const ReferenceLocation& location) const;
  /// Returns the point on the curved patch.
  Point point(const ReferenceLocation& location) const;
  /// Returns the unit normal.
  Vec3 normal(const ReferenceLocation& location) const;
  /// Returns the point on the curve of a line; \p s in [0, length].
  Point line_point(std::int32_t line, double s) const;
  /// Segment of a line that contains s, and the fraction of the segment at s.
  struct LineLocation {
    std::uint32_t segment;
    double t;
  };
  LineLocation line_location(std::int32_t line, double s) const;
};

}  // namespace sterna::surfmesh
