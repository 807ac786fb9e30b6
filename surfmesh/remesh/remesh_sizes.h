// The wanted length of edges on a reference: kept at its vertices, growing with the distance along its edges.
#pragma once

#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/size_sites.h"
#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

class RemeshSizes {
 public:
  /// What options, patches, curvature, gaps and `asked` want. The reference must outlive it.
  /// \throws Error(bad_argument) as remesh_surface
  RemeshSizes(const Reference& reference, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches, const SpaceSizes& asked,
              const RunContext& context);

  /// Metres, at a point of (or near) a triangle of the reference. From many threads, but for a function of the user (is_serial).
  double operator()(const Point& p, TriangleId t) const;
  /// Lowers sizes at places; then carry() hands them on.
  void lower(TriangleId t, const Point& p, double size);
  void carry();
  bool is_serial() const { return static_cast<bool>(asked_.function); }
  double min_edge(TriangleId t) const { return min_edge_[t]; }
  double largest() const { return largest_; }
  double least() const;
  double slope() const { return slope_; }
  /// Triangles that such sizes make, about.
  double n_expected() const;

 private:
  const Reference& r_;
  SpaceSizes asked_;
  double refinement_ = 1.0, slope_ = 0.2, largest_ = 0.0;
  Column<TriangleId, double> cap_, min_edge_, own_;  ///< own: what the curvature of the triangle's edges asks for
  Column<VertexId, double> at_;
};

/// The shortest edge that options ask for anywhere (m), before there are sizes: over which lines' turns are seen.
double least_edge(const TriMesh& wall, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches, const RunContext& context);

}  // namespace sterna::surfmesh
