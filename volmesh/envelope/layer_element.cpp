#include "volmesh/envelope/layer_element.h"

namespace sterna::volmesh {
namespace {

/// Derivatives of one quantity with respect to its input vectors.
struct Seeds {
  Vec3 to_top, to_middle;           ///< derivatives with respect to n_top and n_middle
  std::array<Vec3, 3> to_growth{};  ///< direct derivatives with respect to the growth edges
  std::array<Vec3, 2> to_edge{};    ///< direct derivatives with respect to the edges of the envelope
};

/// Returns the seeds of corner k. Its sine is twice the area divided by both lengths at the corner.
Seeds corner_seeds(const LayerElement& el, std::size_t k) {
  const double sine = (1.0 + el.corner[k]) * el.least_sine[k];
  const Vec3 third = el.top[1] - el.top[0];
  const double a = norm2(el.top[0]), b = norm2(el.top[1]), c = norm2(third);
  Seeds s;
  s.to_top = (sine / (el.top_area2 * el.top_area2 * el.least_sine[k])) * el.n_top;
  const double share = sine / el.least_sine[k];
  const Vec3 to_a = (-share / a) * el.top[0], to_b = (-share / b) * el.top[1], to_c = (-share / c) * third;
  if (k == 0) s.to_edge = {to_a, to_b};
  else if (k == 1) s.to_edge = {to_a - to_c, to_c};
  else s.to_edge = {-to_c, to_b + to_c};
  return s;
}

/// Calls f(x, onset, seeds) for every barrier term that is active.
template <class F>
void for_each_active_term(const LayerElement& el, const F& f) {
  if (el.area - el.margins->area < k_area_onset) {
    Seeds s;
    s.to_top = el.n_wall / el.wall_area2;
    f(el.area - el.margins->area, k_area_onset, s);
  }
  const Vec3 unit_top = el.n_top / el.top_area2;
  for (std::size_t k = 0; k < 3; ++k)
    if (el.corner[k] < k_corner_onset) f(el.corner[k], k_corner_onset, corner_seeds(el, k));
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& u = el.unit[k];
    const auto along = [&](const Vec3& d) { return (d - dot(d, u) * u) / el.length[k]; };
    if (el.wall_cosine[k] < k_wall_cosine_onset) {
      Seeds s;
      s.to_growth[k] = along(el.n_wall);
      f(el.wall_cosine[k], k_wall_cosine_onset, s);
    }
    const double above = el.top_cosine[k] - el.top_margin(k);
    if (above < k_top_cosine_onset) {
      Seeds s;
      s.to_top = (u - el.top_cosine[k] * unit_top) / el.top_area2;
      const bool has_wall_margin = el.margins->top_of_wall * el.wall_cosine[k] < el.margins->top;
      s.to_growth[k] = along(has_wall_margin ? unit_top - el.margins->top_of_wall * el.n_wall : unit_top);
      f(above, k_top_cosine_onset, s);
    }
    const double middle = el.middle[k] - el.margins->middle;
    if (middle < k_middle_onset) {
      const double share = el.top_cosine[k] * el.top_area2 / el.wall_area2;  // b_2 divided by wall area and height; b_0 is the wall cosine
      const double root = std::sqrt(el.wall_cosine[k] * share);
      const double d_wall = 0.5 * share / root, d_share = 0.5 * el.wall_cosine[k] / root;
      Seeds s;
      s.to_top = (d_share / el.wall_area2) * u;
      s.to_middle = u / el.wall_area2;
      s.to_growth[k] = along(d_wall * el.n_wall + (d_share * el.n_top + el.n_middle) / el.wall_area2);
      f(middle, k_middle_onset, s);
    }
  }
}

// Derivatives with respect to top0 and top1. n_top = top0 x top1, n_middle = (e0 x top1 + top0 x e1) / 2, top_k = e_k + g_(k+1) - g_0.
Vec3 to_edge_0(const LayerElement& el, const Seeds& s) { return cross(el.top[1], s.to_top) + 0.5 * cross(el.e[1], s.to_middle) + s.to_edge[0]; }
Vec3 to_edge_1(const LayerElement& el, const Seeds& s) { return cross(s.to_top, el.top[0]) + 0.5 * cross(s.to_middle, el.e[0]) + s.to_edge[1]; }

/// Adds the seeds of f_3 = sum over k of 1 - top_cosine[k].
void add_top_seeds(const LayerElement& el, double weight, Seeds& sum) {
  const Vec3 unit_top = el.n_top / el.top_area2;
  for (std::size_t k = 0; k < 3; ++k) {
    sum.to_top -= (weight / el.top_area2) * (el.unit[k] - el.top_cosine[k] * unit_top);
    sum.to_growth[k] -= (weight / el.length[k]) * (unit_top - el.top_cosine[k] * el.unit[k]);
  }
}

}  // namespace

double LayerElement::scaled_jacobian() const {
  const double wall_a = norm(e[0]), wall_b = norm(e[1]), wall_c = norm(e[1] - e[0]);
  const double top_a = norm(top[0]), top_b = norm(top[1]), top_c = norm(top[1] - top[0]);
  const std::array<double, 3> wall_product = {wall_a * wall_b, wall_a * wall_c, wall_b * wall_c};
  const std::array<double, 3> top_product = {top_a * top_b, top_a * top_c, top_b * top_c};
  double least = 1.0;
  for (std::size_t k = 0; k < 3; ++k)
    least = std::min({least, wall_cosine[k] * wall_area2 / wall_product[k], top_cosine[k] * top_area2 / top_product[k],
                      0.5 * middle[k] * wall_area2 / std::sqrt(wall_product[k] * top_product[k])});
  return least;
}

double LayerElement::measure(double least_quality) {
  n_top = cross(top[0], top[1]);
  n_middle = 0.5 * (cross(e[0], top[1]) + cross(top[0], e[1]));
  top_area2 = norm(n_top);
  area = dot(n_wall, n_top) / wall_area2;
  double slack = area - margins->area;
  if (!(slack > 0.0)) return -1.0;
  const std::array<double, 3> sines = corner_sines(top[0], top[1], top_area2);
  for (std::size_t k = 0; k < 3; ++k) {
    corner[k] = sines[k] / least_sine[k] - 1.0;
    if (!(corner[k] > 0.0)) return -1.0;
    slack = std::min(slack, corner[k]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    wall_cosine[k] = dot(n_wall, unit[k]);
    top_cosine[k] = dot(n_top, unit[k]) / top_area2;
    const double above = top_cosine[k] - top_margin(k);
    if (!(wall_cosine[k] > 0.0) || !(above > 0.0)) return -1.0;
    middle[k] = dot(n_middle, unit[k]) / wall_area2 + std::sqrt(wall_cosine[k] * top_cosine[k] * top_area2 / wall_area2);
    slack = std::min({slack, wall_cosine[k], above, middle[k] - margins->middle});
  }
  if (slack < k_quality_onset && least_quality > 0.0 && !is_virtual && scaled_jacobian() < least_quality) return -1.0;
  return slack > 0.0 ? slack : -1.0;
}

double LayerElement::energy(const ElementWeights& weights) const {
  double sum = 0.0;
  if (area - margins->area < k_area_onset) sum += barrier_value(area - margins->area, k_area_onset);
  for (std::size_t k = 0; k < 3; ++k) {
    if (corner[k] < k_corner_onset) sum += barrier_value(corner[k], k_corner_onset);
    if (wall_cosine[k] < k_wall_cosine_onset) sum += barrier_value(wall_cosine[k], k_wall_cosine_onset);
    const double above = top_cosine[k] - top_margin(k);
    if (above < k_top_cosine_onset) sum += barrier_value(above, k_top_cosine_onset);
    const double above_middle = middle[k] - margins->middle;
    if (above_middle < k_middle_onset) sum += barrier_value(above_middle, k_middle_onset);
  }
  return weights.barrier * sum + weights.top * (3.0 - top_cosine[0] - top_cosine[1] - top_cosine[2]);
}

void LayerElement::differentiate_corner_0(const ElementWeights& weights, Vec3& gradient, SymmetricBlock& hessian) const {
  if (weights.top > 0.0) {
    Seeds seeds;
    add_top_seeds(*this, weights.top, seeds);
    gradient += seeds.to_growth[0] - to_edge_0(*this, seeds) - to_edge_1(*this, seeds);
    // For unit vectors, 1 - cos is half the square of (growth edge - top normal), so Gauss-Newton applies. A displacement of the corner along the normal turns
    // the normal by the displacement over the altitude, which affects all three growth edges. It also turns the growth edge of the corner.
    const Vec3 unit_top = n_top / top_area2;
    hessian.add(3.0 * weights.top * norm2(top[1] - top[0]) / (top_area2 * top_area2), unit_top);
    const double turning = weights.top / (length[0] * length[0]);
    hessian.add_identity(turning);
    hessian.add(-turning, unit[0]);
  }
  for_each_active_term(*this, [&](double x, double onset, const Seeds& s) {
    const Barrier b = barrier(x, onset);
    const Vec3 v = s.to_growth[0] - to_edge_0(*this, s) - to_edge_1(*this, s);
    gradient += (weights.barrier * b.slope) * v;
    hessian.add(weights.barrier * b.curvature, v);
  });
}

}  // namespace sterna::volmesh
