#include "io/mesh/surface_polygon.h"

#include <cmath>

namespace sterna::io {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

struct Vec2 {
  double x = 0.0;
  double y = 0.0;
  friend bool operator==(const Vec2&, const Vec2&) = default;
};

/// Returns twice the signed area; positive if a, b, c turn left. Rounding errors can only change the choice of the split, never make a split invalid.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

void split_quad(std::span<const Vec3> q, std::vector<Triangle>& triangles) {
  const auto is_inside = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {  // diagonal a-c of a, b, c, d
    return dot(cross(b - a, c - a), cross(c - a, d - a)) > 0.0;
  };
  const bool is_inside_02 = is_inside(q[0], q[1], q[2], q[3]);
  const bool is_inside_13 = is_inside(q[1], q[2], q[3], q[0]);
  const bool take_02 = is_inside_02 == is_inside_13 ? norm2(q[2] - q[0]) <= norm2(q[3] - q[1]) : is_inside_02;
  if (take_02) {
    triangles.push_back({0, 1, 2});
    triangles.push_back({0, 2, 3});
  } else {
    triangles.push_back({0, 1, 3});
    triangles.push_back({1, 2, 3});
  }
}

/// Projects the polygon along its mean normal (Newell), so that it is counter-clockwise.
std::vector<Vec2> project(std::span<const Vec3> corners) {
  Vec3 normal;
  for (std::size_t i = 0; i < corners.size(); ++i) normal += cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
  std::size_t axis = std::abs(normal.x) > std::abs(normal.y) ? 0 : 1;
  if (std::abs(normal.z) >= std::abs(normal[axis])) axis = 2;
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double sign = normal[axis] < 0.0 ? -1.0 : 1.0;
  std::vector<Vec2> flat(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) flat[i] = {sign * corners[i][u], corners[i][v]};
  return flat;
}

bool is_fan(const std::vector<Vec2>& flat) {
  for (std::size_t i = 1; i + 1 < flat.size(); ++i)
    if (!(turn(flat[0], flat[i], flat[i + 1]) > 0.0)) return false;
  return true;
}

class EarClipper {
 public:
  explicit EarClipper(std::vector<Vec2> flat) : flat_(std::move(flat)), next_(flat_.size()), previous_(flat_.size()) {
    const auto n = static_cast<std::uint32_t>(flat_.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      next_[i] = (i + 1) % n;
      previous_[i] = (i + n - 1) % n;
    }
  }

  void clip(std::vector<Triangle>& triangles) {
    std::size_t n_left = flat_.size();
    std::uint32_t corner = 0;
    while (n_left > 3) {
      std::size_t n_tried = 0;
      while (n_tried < n_left && !is_ear(corner)) {
        corner = next_[corner];
        ++n_tried;
      }
      if (n_tried == n_left) break;
      triangles.push_back({previous_[corner], corner, next_[corner]});
      next_[previous_[corner]] = next_[corner];
      previous_[next_[corner]] = previous_[corner];
      corner = next_[next_[corner]];  // not the neighbour, so that ears are clipped alternately: this gives better shapes than a triangle fan
      --n_left;
    }
    for (std::uint32_t b = next_[corner]; next_[b] != corner; b = next_[b]) triangles.push_back({corner, b, next_[b]});
  }

 private:
  bool is_ear(std::uint32_t corner) const {
    const Vec2 &a = flat_[previous_[corner]], &b = flat_[corner], &c = flat_[next_[corner]];
    if (!(turn(a, b, c) > 0.0)) return false;
    for (std::uint32_t i = next_[next_[corner]]; i != previous_[corner]; i = next_[i]) {
      const Vec2& p = flat_[i];
      if (p == a || p == b || p == c) continue;  // the two sides of a bridge to a hole
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  std::vector<Vec2> flat_;
  std::vector<std::uint32_t> next_, previous_;
};

}  // namespace

void split_polygon(std::span<const Vec3> corners, std::vector<Triangle>& triangles) {
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
  } else if (corners.size() == 4) {
    split_quad(corners, triangles);
  } else {
    std::vector<Vec2> flat = project(corners);
    if (is_fan(flat)) {
      for (std::uint32_t i = 1; i + 1 < flat.size(); ++i) triangles.push_back({0, i, i + 1});
    } else {
      EarClipper(std::move(flat)).clip(triangles);
    }
  }
}

}  // namespace sterna::io
