// The wanted length of edges on a reference: kept at its vertices, growing with the distance along its edges.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/size_sites.h"
#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

/// What one patch of one connected piece asks for, as a member of the family.
struct SurfaceLimits {
  double max_edge, min_edge;  ///< m
  double curvature_angle;     ///< rad
  double chord_error;         ///< m
};

/// The limits of each triangle: the automatic longest edge is one of its connected piece.
class SurfaceLimitTable {
 public:
  /// The wall must outlive it.
  SurfaceLimitTable(const TriMesh& wall, const Topology& topology, const RemeshOptions& options, std::span<const PatchSurfaceOptions> rules);
  const SurfaceLimits& of(TriangleId t) const { return limits_[pieces_.component[t]][wall_.triangle_patch[t].index()]; }
  /// m, the shortest edge that may be asked for anywhere.
  double least() const;

 private:
  const TriMesh& wall_;
  Components pieces_;
  std::vector<std::vector<SurfaceLimits>> limits_;  ///< of each piece each patch
};

class RemeshSizes {
 public:
  /// What options, patches, curvature, gaps and `asked` want. The reference must outlive it.
  /// \throws Error(bad_argument) as remesh_surface
  RemeshSizes(const Reference& reference, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches, const SpaceSizes& asked,
              const RunContext& context);

  /// Metres, at a point of (or near) a triangle of the reference. From many threads, but for a function of the user (is_serial).
  double operator()(const Point& p, TriangleId t) const;
  /// All sizes anew; curvature asks for nothing at these vertices of the reference, as rows of a leading edge answer for it there. Empty: nowhere.
  void cover(const Column<VertexId, std::uint8_t>& covered, const RunContext& context);
  /// Lowers sizes at places; then carry() hands them on.
  void lower(TriangleId t, const Point& p, double size);
  void carry();
  /// Sizes at places in space, which grow with the distance in space, in place of those of the call before.
  void ask_at(std::span<const SizeSite> sites, const RunContext& context);
  bool is_serial() const { return static_cast<bool>(asked_.function); }
  double min_edge(TriangleId t) const { return min_edge_[t]; }
  double largest() const { return largest_; }
  double least() const;
  double slope() const { return slope_; }
  /// Triangles that such sizes make, about.
  double n_expected() const;

 private:
  const Reference& r_;
  RemeshOptions options_;
  std::vector<PatchSurfaceOptions> patches_;
  SpaceSizes asked_;
  double refinement_ = 1.0, slope_ = 0.2, largest_ = 0.0;
  Column<TriangleId, double> cap_, min_edge_, own_;  ///< own: what the curvature of the triangle's edges asks for
  Column<VertexId, double> at_;
  std::optional<SizeSites> sites_;
};

/// The shortest edge that options ask for anywhere (m), before there are sizes: over which lines' turns are seen.
double least_edge(const TriMesh& wall, const RemeshOptions& options, std::span<const PatchSurfaceOptions> patches, const RunContext& context);

}  // namespace sterna::surfmesh
