#include "io/mesh/surface_builder.h"

#include <algorithm>
#include <limits>

#include "geom/base/error.h"
#include "io/mesh/surface_polygon.h"

namespace sterna::io {
namespace {

constexpr std::uint32_t k_unused = std::numeric_limits<std::uint32_t>::max();

}  // namespace

std::string numbered_patch(std::int64_t number) { return "patch_" + std::to_string(number); }

void SurfaceBuilder::reserve_polygons(std::size_t n) {
  soup_.triangles.reserve(n);
  soup_.patch.reserve(n);
}

std::uint32_t SurfaceBuilder::add_point(const Vec3& p) {
  if (soup_.points.size() >= k_unused)
    throw Error({.code = ErrorCode::overflow, .attempted = "reading " + soup_.source, .problem = "more than 4294967294 points"});
  soup_.points.push_back(p);
  has_not_finite_ = has_not_finite_ || !is_finite(p);
  return static_cast<std::uint32_t>(soup_.points.size() - 1);
}

void SurfaceBuilder::set_patch(std::string_view name) {
  const auto found = patch_names_.find(name);
  if (found != patch_names_.end()) {
    current_patch_ = found->second;
    return;
  }
  current_patch_ = static_cast<std::uint32_t>(soup_.patch_names.size());
  soup_.patch_names.emplace_back(name);
  patch_names_.emplace(name, current_patch_);
}

void SurfaceBuilder::add_polygon(std::span<const std::uint32_t> corners) {
  if (corners.size() == 3) return add_triangle(corners[0], corners[1], corners[2]);
  if (patch_names_.empty()) set_patch({});
  polygons_.push_back({.before = soup_.triangles.size(), .first_corner = corners_.size(), .n_corners = corners.size(), .patch = current_patch_});
  corners_.insert(corners_.end(), corners.begin(), corners.end());
}

SurfaceSoup SurfaceBuilder::finish(const RunContext& context, bool drop_unused_points) {
  if (has_not_finite_) drop_not_finite();
  if (!polygons_.empty()) split_polygons();
  if (drop_unused_points || has_not_finite_) compact_points();
  compact_patches();
  if (n_not_finite_ > 0)
    context.warn(soup_.source + ": " + std::to_string(n_not_finite_) +
                 " polygons have a corner whose coordinates are nan or infinite and are left out, the first is " + not_finite_location_ +
                 ". The surface has holes there; repair or --auto closes them");
  return std::move(soup_);
}

bool SurfaceBuilder::is_finite_polygon(std::span<const std::uint32_t> corners) const {
  return std::all_of(corners.begin(), corners.end(), [&](std::uint32_t corner) { return is_finite(soup_.points[corner]); });
}

void SurfaceBuilder::note_not_finite(std::size_t number, std::span<const std::uint32_t> corners) {
  if (n_not_finite_++ > 0) return;
  not_finite_location_ = "polygon " + std::to_string(number + 1) + " of " + std::to_string(n_polygons());
  for (const std::uint32_t corner : corners) {
    if (!is_finite(soup_.points[corner])) continue;
    not_finite_location_ += ", beside " + format_point(soup_.points[corner]);
    return;
  }
}

/// Removes polygons and triangles that have a corner that is not finite.
void SurfaceBuilder::drop_not_finite() {
  std::vector<Polygon> kept_polygons;
  std::vector<std::array<std::uint32_t, 3>> kept;
  std::vector<std::uint32_t> kept_patch;
  const std::size_t n_triangles = soup_.triangles.size();
  std::size_t t = 0, n_before = 0;  // n_before: number of polygons in the file before this one
  const auto take_triangles = [&](std::size_t end) {
    for (; t < end; ++t, ++n_before) {
      if (!is_finite_polygon(soup_.triangles[t])) {
        note_not_finite(n_before, soup_.triangles[t]);
        continue;
      }
      kept.push_back(soup_.triangles[t]);
      kept_patch.push_back(soup_.patch[t]);
    }
  };
  for (const Polygon& polygon : polygons_) {
    take_triangles(polygon.before);
    const std::span<const std::uint32_t> corners(corners_.data() + polygon.first_corner, polygon.n_corners);
    if (is_finite_polygon(corners)) {
      kept_polygons.push_back(polygon);
      kept_polygons.back().before = kept.size();
    } else {
      note_not_finite(n_before, corners);
    }
    ++n_before;
  }
  take_triangles(n_triangles);
  soup_.triangles = std::move(kept);
  soup_.patch = std::move(kept_patch);
  polygons_ = std::move(kept_polygons);
}

void SurfaceBuilder::split_polygons() {
  std::vector<std::array<std::uint32_t, 3>> triangles, local;
  std::vector<std::uint32_t> patch;
  const std::size_t n_triangles = soup_.triangles.size() + corners_.size() - 2 * polygons_.size();
  triangles.reserve(n_triangles);
  patch.reserve(n_triangles);
  std::size_t n_copied = 0;
  const auto copy_until = [&](std::size_t end) {
    for (; n_copied < end; ++n_copied) {
      triangles.push_back(soup_.triangles[n_copied]);
      patch.push_back(soup_.patch[n_copied]);
    }
  };
  std::vector<Vec3> points;
  for (const Polygon& polygon : polygons_) {
    copy_until(polygon.before);
    const std::span<const std::uint32_t> corners(corners_.data() + polygon.first_corner, polygon.n_corners);
    points.clear();
    for (const std::uint32_t corner : corners) points.push_back(soup_.points[corner]);
    local.clear();
    split_polygon(points, local);
    for (const auto& t : local) {
      triangles.push_back({corners[t[0]], corners[t[1]], corners[t[2]]});
      patch.push_back(polygon.patch);
    }
  }
  copy_until(soup_.triangles.size());
  soup_.triangles = std::move(triangles);
  soup_.patch = std::move(patch);
}

void SurfaceBuilder::compact_points() {
  std::vector<std::uint32_t> old2new(soup_.points.size(), k_unused);
  for (const auto& triangle : soup_.triangles)
    for (const std::uint32_t corner : triangle) old2new[corner] = 0;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < old2new.size(); ++i) {
    if (old2new[i] == k_unused) continue;
    old2new[i] = static_cast<std::uint32_t>(points.size());
    points.push_back(soup_.points[i]);
  }
  for (auto& triangle : soup_.triangles)
    for (std::uint32_t& corner : triangle) corner = old2new[corner];
  soup_.points = std::move(points);
}

void SurfaceBuilder::compact_patches() {
  std::vector<std::uint32_t> old2new(soup_.patch_names.size(), k_unused);
  for (const std::uint32_t patch : soup_.patch) old2new[patch] = 0;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < old2new.size(); ++i) {
    if (old2new[i] == k_unused) continue;
    old2new[i] = static_cast<std::uint32_t>(names.size());
    names.push_back(std::move(soup_.patch_names[i]));
  }
  for (std::uint32_t& patch : soup_.patch) patch = old2new[patch];
  soup_.patch_names = std::move(names);
}

}  // namespace sterna::io
