#include "geom/model/winglet_blend.h"

#include <algorithm>
#include <cmath>

namespace sterna {
namespace {

/// Returns the vector from row `i` to row `k`, seen along x.
Vec3 across(const WingRows& rows, std::size_t i, std::size_t k) {
  const std::size_t nose = rows.rows[i].size() / 2;
  const Vec3 d = rows.rows[k][nose] - rows.rows[i][nose];
  return {0.0, d.y, d.z};
}
double turn_between(const Vec3& a, const Vec3& b) { return std::atan2(norm(cross(a, b)), dot(a, b)); }

/// Intersection of the lines a0 -> a1 and b0 -> b1 as seen along x (its x is half way between the lines). Also stores if the intersection lies beyond the ends
/// of both.
struct Meeting {
  Point point;
  bool is_ahead = false;
};
Meeting meeting(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
  const Vec3 u = a1 - a0, v = b1 - b0, w = b1 - a1;
  const double determinant = u.y * v.z - u.z * v.y;
  if (determinant == 0.0) return {};
  const double s = (w.y * v.z - w.z * v.y) / determinant, t = (w.y * u.z - w.z * u.y) / determinant;
  return {0.5 * (a1 + s * u) + 0.5 * (b1 + t * v), s > 0.0 && t > 0.0};
}

/// Inserts the rows between `outer` and `outer` + 1 for a winglet at the first row.
void insert_blend(WingRows& rows, std::size_t outer) {
  const std::vector<Point>&tip = rows.rows[outer - 1], &a = rows.rows[outer], &b = rows.rows[outer + 1], &inner = rows.rows[outer + 2];
  const double turn = turn_between(across(rows, outer + 2, outer + 1), across(rows, outer, outer - 1)), weight = std::cos(0.5 * turn);
  std::vector<std::vector<Point>> blend(k_winglet_rows);
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Meeting shoulder = meeting(inner[k], b[k], tip[k], a[k]);
    if (!shoulder.is_ahead) return;
    for (std::size_t i = 0; i < k_winglet_rows; ++i) {
      const double t = static_cast<double>(i + 1) / static_cast<double>(k_winglet_rows + 1), p = (1.0 - t) * (1.0 - t), q = 2.0 * weight * t * (1.0 - t),
                   r = t * t;
      blend[i].push_back((p * a[k] + q * shoulder.point + r * b[k]) / (p + q + r));
    }
  }
  const auto at = static_cast<std::ptrdiff_t>(outer) + 1;
  rows.rows.insert(rows.rows.begin() + at, blend.begin(), blend.end());
  rows.is_break[outer] = rows.is_break[outer + 1] = true;
  rows.is_break.insert(rows.is_break.begin() + at, k_winglet_rows, false);
  rows.is_sampled.insert(rows.is_sampled.begin() + at, k_winglet_rows, true);
}

void blend_first(WingRows& rows, bool is_half) {
  double length = 0.0;
  for (std::size_t i = 0; i + 1 < rows.rows.size(); ++i) length += norm(across(rows, i, i + 1)) * (is_half ? 1.0 : 0.5);
  double reach = 0.0;
  for (std::size_t outer = 1; outer + 2 < rows.rows.size(); ++outer) {
    const Vec3 winglet = across(rows, outer, outer - 1), between = across(rows, outer + 1, outer), wing = across(rows, outer + 2, outer + 1);
    reach += norm(winglet);
    if (reach + norm(between) > k_max_winglet_part * length) return;
    const double turn = turn_between(wing, winglet);
    if (turn < k_min_winglet_turn || turn_between(wing, between) >= turn || turn_between(between, winglet) >= turn) continue;
    insert_blend(rows, outer);
    return;
  }
}

}  // namespace

void blend_winglets(WingRows& rows, bool at_both_ends) {
  blend_first(rows, !at_both_ends);
  if (!at_both_ends) return;
  const auto turn_round = [&] {
    std::reverse(rows.rows.begin(), rows.rows.end());
    std::reverse(rows.is_break.begin(), rows.is_break.end());
    std::reverse(rows.is_sampled.begin(), rows.is_sampled.end());
  };
  turn_round();
  blend_first(rows, false);
  turn_round();
}

}  // namespace sterna
