// The given surface as remeshing uses it: lines (sharp edges, patch borders, open boundaries), smooth pieces between them, normals, and a curved patch over
// each triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

inline constexpr std::int32_t k_no_line = -1;

/// A run of edges between two different corners; closed runs are cut in three.
struct FeatureLine {
  std::vector<VertexId> vertices;
  std::vector<HalfedgeId> halfedges;  ///< for each segment the half-edge that runs from its first vertex or, if there is none, the one that runs to it
  std::vector<Vec3> bulges;           ///< for each segment: from its middle to the middle of the curve
  std::vector<double> lengths;        ///< along the polyline, at each vertex
  bool is_nose = false;               ///< the edges are lines only on request: a smooth leading edge
  double length() const { return lengths.back(); }
};

/// A location on a triangle of the reference; the weight of its first corner is 1 - b1 - b2.
struct Foot {
  TriangleId triangle;
  double b1 = 0.0, b2 = 0.0;
};

struct ReferenceOptions {
  double feature_angle = 0.0;  ///< rad
  double line_scale = 0.0;     ///< m: length over which turns of lines are measured to find corners
  bool is_smooth = true;
  std::vector<std::array<VertexId, 2>> noses{};  ///< edges that are lines however flat they are: the surface is smooth across them
};

struct Reference {
  const TriMesh* mesh = nullptr;
  Topology topology;
  Column<TriangleId, Vec3> triangle_normals;  ///< unit; triangles too thin for a normal take that of their surroundings
  Column<HalfedgeId, std::int32_t> line;      ///< line of the edge; k_no_line
  Column<HalfedgeId, std::uint32_t> segment;  ///< in its line
  Column<HalfedgeId, Vec3> normals;           ///< at the half-edge's first vertex, for the smooth piece of its triangle
  Column<HalfedgeId, Vec3> bulges;            ///< bulge of the edge: from its middle to the surface's, the same for both half-edges
  Column<TriangleId, std::uint32_t> region;   ///< smooth piece
  Column<TriangleId, std::uint8_t> is_kept;   ///< unchanged in the result
  Column<VertexId, std::uint8_t> is_corner;   ///< end of lines, or of a kept triangle
  std::vector<FeatureLine> lines;

  /// \param kept triangles that remain unchanged; empty: none. \param flat: triangles without bulge; empty: none
  Reference(const TriMesh& wall, const ReferenceOptions& options, const Column<TriangleId, std::uint8_t>& kept, const Column<TriangleId, std::uint8_t>& flat,
            const RunContext& context);

  /// Returns the nearest location on triangles that can be reached from `start` without crossing a line, by a walk that approaches p in each step.
  Foot nearest(const Point& p, TriangleId start) const;
  Point flat_point(const Foot& foot) const;
  /// Returns the point on the curved patch.
  Point point(const Foot& foot) const;
  /// Returns the unit normal.
  Vec3 normal(const Foot& foot) const;
  /// Returns the point on the curve of a line; \p s in [0, length].
  Point line_point(std::int32_t line, double s) const;
  /// Segment of a line that contains s, and the fraction within it.
  struct LinePlace {
    std::uint32_t segment;
    double t;
  };
  LinePlace line_place(std::int32_t line, double s) const;
};

}  // namespace sterna::surfmesh
