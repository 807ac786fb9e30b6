// Collects what a surface file lists (points, polygons, patch names) and makes a SurfaceSoup of it.
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

  /// Coordinates may be nan or infinite: finish() leaves out what uses such points.
  /// \throws Error(overflow) when there are more points than 32-bit indices.
  std::uint32_t add_point(const Vec3& p);

  /// Polygons added from now on belong to the patch of this name; patches are numbered in the order of their first call.
  void set_patch(std::string_view name);

  /// Indices may refer to points that are added later.
  /// \pre 3 <= corners.size() <= k_max_polygon_corners
  void add_polygon(std::span<const std::uint32_t> corners);
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (patch_names_.empty()) set_patch({});
    soup_.triangles.push_back({a, b, c});
    soup_.patch.push_back(current_patch_);
  }

  /// Splits the polygons, drops patches without triangles. With `drop_unused_points` (the boundary of a volume mesh) only the points in use stay, in their
  /// order. Polygons with corners that are not finite are left out with a warning; then only the points in use stay, too.
  /// \pre every index is below n_points()
  SurfaceSoup finish(const RunContext& context, bool drop_unused_points = false);

 private:
  struct Polygon {  // of more than three corners; its triangles come before triangle `before`
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
  std::size_t n_not_finite_ = 0;  ///< polygons
  std::string not_finite_place_;  ///< of the first of them: "polygon 7 of 12, beside (1, 0, 2)"
  std::vector<Polygon> polygons_;
  std::vector<std::uint32_t> corners_;
};

/// "patch_7": the name of a patch that the file only numbers.
std::string numbered_patch(std::int64_t number);

}  // namespace sterna::io
