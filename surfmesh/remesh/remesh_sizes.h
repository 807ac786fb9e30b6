// Target edge length on a reference. It is stored at the vertices and grows with the distance along edges.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/size_points.h"
#include "surfmesh/remesh/reference.h"
#include "surfmesh/remesh/remesh_surface.h"

namespace sterna::surfmesh {

/// Limits for one patch of one connected piece, for the current member of the refinement family.
struct SurfaceLimits {
  double max_edge, min_edge;  ///< m
  double curvature_angle;     ///< rad
  double chord_error;         ///< m
};

/// Limits of each triangle. The automatic longest edge is computed for each connected piece.
class SurfaceLimitTable {
 public:
  SurfaceLimitTable(Borrowed<const TriMesh> wall, const Topology& topology, const RemeshOptions& options, std::span<const Rule> rules);
  const SurfaceLimits& of(TriangleId t) const { return limits_[pieces_.component[t]][wall_.triangle_patch[t].index()]; }
  /// Returns the shortest target edge in metres that is possible anywhere.
  double least() const;

 private:
  const TriMesh& wall_;
  Components pieces_;
  std::vector<std::vector<SurfaceLimits>> limits_;  ///< limits of each patch, by piece
};

class RemeshSizes {
 public:
  /// Computes the sizes required by options, patches, curvature, gaps and `requested`.
  /// \throws Error(bad_argument) like remesh_surface
  RemeshSizes(Borrowed<const Reference> reference, const RemeshOptions& options, std::span<const Rule> patches, const SpaceSizes& requested,
              const RunContext& context);

  /// Returns the size in metres at a point on or near a triangle of the reference. Thread-safe, unless there is a user function (is_serial).
  double operator()(const Point& p, TriangleId t) const;
  /// Recomputes all sizes without the curvature at the covered vertices of the reference, because the rows of a leading edge determine the size there. Empty:
  /// no vertex is covered.
  void cover(const Column<VertexId, std::uint8_t>& covered, const RunContext& context);
  /// Lowers the size at a location; carry() then propagates it.
  void lower(TriangleId t, const Point& p, double size);
  void carry();
  /// Sets sizes at locations in space. They grow with the distance in space, and replace those of the previous call.
  void request_at(std::span<const SizePoint> size_points, const RunContext& context);
  bool is_serial() const { return static_cast<bool>(requested_.function); }
  double min_edge(TriangleId t) const { return min_edge_[t]; }
  double largest() const { return largest_; }
  double least() const;
  double slope() const { return slope_; }
  /// Returns the approximate number of triangles for these sizes.
  double n_expected() const;

 private:
  const Reference& r_;
  RemeshOptions options_;
  std::vector<Rule> patches_;
  SpaceSizes requested_;
  double refinement_ = 1.0, slope_ = 0.2, largest_ = 0.0;
  Column<TriangleId, double> cap_, min_edge_, own_;  ///< own: size required by the curvature of the triangle's edges
  Column<VertexId, double> at_;
  std::optional<SizePointTree> size_points_;
};

/// Returns the shortest edge in metres that options require anywhere. It is known before the sizes, and is the length over which turns of lines are measured.
double least_edge(const TriMesh& wall, const RemeshOptions& options, std::span<const Rule> patches, const RunContext& context);

}  // namespace sterna::surfmesh
