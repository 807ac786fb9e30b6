// Builds a SurfaceSoup from the contents of a surface file: points, polygons, patch names.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/surface_soup.h"

namespace sterna::io {

class SurfaceBuilder {
 public:
  explicit SurfaceBuilder(std::string source) { soup_.source = std::move(source); }

  std::size_t n_points() const { return soup_.points.size(); }
  std::size_t n_polygons() const { return soup_.triangles.size() + polygons_.size(); }
  void reserve_points(std::size_t n) { soup_.points.reserve(n); }
  void reserve_polygons(std::size_t n);

  /// Adds a point. Coordinates may be nan or infinite: finish() leaves out the polygons that use such points.
  /// \throws Error(overflow) if there are more points than 32-bit indices.
  std::uint32_t add_point(const Vec3& p);

  /// Sets the patch of the polygons added afterwards; patches are numbered in the order of their first call.
  void set_patch(std::string_view name);

  /// Adds a polygon. Indices may refer to points that are added later.
  /// \pre 3 <= corners.size() <= k_max_polygon_corners
  void add_polygon(std::span<const std::uint32_t> corners);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (patch_names_.empty()) set_patch({});
    soup_.triangles.push_back({a, b, c});
    soup_.patch.push_back(current_patch_);
  }

  /// Splits the polygons and drops patches without triangles. With `drop_unused_points` (for the boundary of a volume mesh) unused points are removed; the
  /// order of the others is kept. Polygons with corners that are not finite are left out with a warning; unused points are then removed, too.
  /// \pre every index is below n_points()
  SurfaceSoup finish(const RunContext& context, bool drop_unused_points = false);

 private:
  struct Polygon {  // a polygon of more than three corners; its triangles come before triangle `before`
    std::size_t before = 0;
    std::size_t first_corner = 0;
    std::size_t n_corners = 0;
    std::uint32_t patch = 0;
  };
  bool is_finite_polygon(std::span<const std::uint32_t> corners) const;
  void note_not_finite(std::size_t number, std::span<const std::uint32_t> corners);
  void drop_not_finite();
  void split_polygons();
  void compact_points();
  void compact_patches();

  SurfaceSoup soup_;
  std::map<std::string, std::uint32_t, std::less<>> patch_names_;
  std::uint32_t current_patch_ = 0;
  bool has_not_finite_ = false;
  std::size_t n_not_finite_ = 0;     ///< number of polygons with a corner that is not finite
  std::string not_finite_location_;  ///< location of the first such polygon: "polygon 7 of 12, beside (1, 0, 2)"
  std::vector<Polygon> polygons_;
  std::vector<std::uint32_t> corners_;
};

/// Returns the name of a patch that has only a number in the file: "patch_7".
std::string numbered_patch(std::int64_t number);

}  // namespace sterna::io
