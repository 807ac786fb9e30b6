// Private to surfmesh/wrap: moves the wrap back onto the input, restores the input's sharp edges and patches, and improves the triangles.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/boolean/cgal_wrap.h"
#include "geom/mesh/bvh.h"
#include "surfmesh/wrap/wrap_input.h"

namespace sterna::surfmesh {

struct WrapSizes {
  /// m; edge length, largest closed opening, largest distance from the input, and offset of the wrap.
  double edge = 0.0, gap = 0.0, tolerance = 0.0, offset = 0.0;
  bool is_fluid_inside = false;
};

/// Feature of the input to which a vertex of the wrap is tied.
enum class LineTie : char { none, line, corner };

struct FittedWrap {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> patch;  ///< for each triangle: patch of the input's mesh
  std::vector<LineTie> tie;          ///< tie of each vertex
};

/// The input for distance queries: facets, lines and corners.
class InputSurface {
 public:
  InputSurface(Borrowed<const WrapInput> input, const RunContext& context);

  const WrapInput& input() const { return input_; }
  const TriangleTree& facets() const { return facets_; }
  NearestHit nearest(const Vec3& p, double limit = std::numeric_limits<double>::infinity()) const { return facets_.nearest(p, limit); }
  /// Returns the nearest point of a sharp edge or a patch border.
  NearestHit nearest_line(const Vec3& p, double limit) const;
  NearestHit nearest_corner(const Vec3& p, double limit) const;
  /// Returns true if the hit lies on a border of the input, which bounds an opening.
  bool is_on_border(const NearestHit& hit) const;
  Vec3 normal(TriangleId facet) const;

 private:
  const WrapInput& input_;
  TriangleTree facets_, lines_, corners_;
};

/// \pre `wrap` is closed, manifold and without self-intersection. \post the result is closed, manifold and without self-intersection
FittedWrap fit_wrap(const WrapSurface& wrap, const InputSurface& surface, const WrapSizes& sizes, double feature_angle, const RunContext& context);

/// Returns for each triangle the patch of the nearest facet. Patches become connected regions; small regions are merged into their neighbours.
std::vector<std::uint32_t> patches_of(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles, const InputSurface& surface,
                                      const WrapSizes& sizes, const RunContext& context);

TriMesh wrap_mesh(const std::vector<Vec3>& points, const std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace sterna::surfmesh
