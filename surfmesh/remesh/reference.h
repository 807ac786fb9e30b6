// The given surface as remeshing sees it: lines (sharp edges, borders, rims), smooth pieces between them, normals, and a curved patch over each triangle.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/topology.h"
#include "geom/mesh/tri_mesh.h"

namespace sterna::surfmesh {

inline constexpr std::int32_t k_no_line = -1;

/// A run of edges between two different corners; closed ones are cut in three.
struct FeatureLine {
  std::vector<VertexId> vertices;
  std::vector<HalfedgeId> halfedges;  ///< of each segment one that runs from its first vertex or, where none does, to it
  std::vector<Vec3> bulges;           ///< of each segment: from its middle to the curve's
  std::vector<double> lengths;        ///< along the polyline, at each vertex
  bool is_nose = false;               ///< of edges that are lines only because they were asked to be: a smooth leading edge
  double length() const { return lengths.back(); }
};

/// A place on a triangle of the reference; the weight of its first corner is what remains.
struct Foot {
  TriangleId triangle;
  double b1 = 0.0, b2 = 0.0;
};

struct ReferenceOptions {
  double feature_angle = 0.0;  ///< rad
  double line_scale = 0.0;     ///< m: lines' corners are turns seen over this length
  bool is_smooth = true;
  std::vector<std::array<VertexId, 2>> noses{};  ///< edges that are lines, however flat: the surface is smooth across them
};

struct Reference {
  const TriMesh* mesh = nullptr;
  Topology topology;
  Column<TriangleId, Vec3> triangle_normals;  ///< unit; of triangles too thin to have one, of those about them
  Column<HalfedgeId, std::int32_t> line;      ///< of the edge; k_no_line
  Column<HalfedgeId, std::uint32_t> segment;  ///< in its line
  Column<HalfedgeId, Vec3> normals;           ///< at the half-edge's first vertex, of the smooth piece that its triangle is in
  Column<HalfedgeId, Vec3> bulges;            ///< of the edge: from its middle to the surface's, the same for both half-edges
  Column<TriangleId, std::uint32_t> region;   ///< smooth piece
  Column<TriangleId, std::uint8_t> is_kept;   ///< to come out as it is
  Column<VertexId, std::uint8_t> is_corner;   ///< end of lines, or of a kept triangle
  std::vector<FeatureLine> lines;

  /// \param kept triangles to come out as they are; empty: none. \param flat: triangles without bulge; empty: none
  Reference(const TriMesh& wall, const ReferenceOptions& options, const Column<TriangleId, std::uint8_t>& kept, const Column<TriangleId, std::uint8_t>& flat,
            const RunContext& context);

  /// Of the triangles reached from `start` without crossing a line, one that is nearest as seen from each step of the way.
  Foot nearest(const Point& p, TriangleId start) const;
  Point flat_point(const Foot& foot) const;
  /// On the curved patch.
  Point point(const Foot& foot) const;
  /// Unit.
  Vec3 normal(const Foot& foot) const;
  /// On the curve of a line; \p s in [0, length].
  Point line_point(std::int32_t line, double s) const;
  /// Segment of a line that s is in, and the share of it.
  struct LinePlace {
    std::uint32_t segment;
    double t;
  };
  LinePlace line_place(std::int32_t line, double s) const;
};

}  // namespace sterna::surfmesh
