#include "geom/model/nurbs_surface.h"

#include <string>
#include <type_traits>

#include "geom/base/error.h"
#include "geom/model/nurbs_tools.h"

namespace sterna {
namespace {

using Value = Lanes4::Value;
constexpr std::string_view k_nurbs_surface_attempt = "making a NURBS surface";

Point position(const Value& v) { return {v[0], v[1], v[2]}; }

/// Data of a surface point: the basis functions of both directions, their number, and the first of their poles.
struct Support {
  BasisValues bu, bv;
  std::size_t orders_u, orders_v;
  const Lanes4* row;
};
template <int n_u, int n_v, bool has_derivatives>
inline void find_support(Uv at, const KnotBasis& u, const KnotBasis& v, const Lanes4* poles, std::size_t stride, Support& support) {
  u.evaluate<has_derivatives>(at.u, support.bu);
  v.evaluate<has_derivatives>(at.v, support.bv);
  support.orders_u = n_u > 0 ? n_u : static_cast<std::size_t>(u.degree()) + 1;
  support.orders_v = n_v > 0 ? n_v : static_cast<std::size_t>(v.degree()) + 1;
  support.row = poles + support.bu.first * stride + support.bv.first;
}

NurbsSurfaceForm checked(NurbsSurfaceForm form) {
  const auto count = [](int degree, const std::vector<double>& knots) { return static_cast<std::int64_t>(knots.size()) - degree - 1; };
  if (count(form.degree_u, form.knots_u) != static_cast<std::int64_t>(form.n_u) || count(form.degree_v, form.knots_v) != static_cast<std::int64_t>(form.n_v))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = std::string(k_nurbs_surface_attempt),
                 .problem = "the given numbers of poles are " + std::to_string(form.n_u) + " x " + std::to_string(form.n_v) +
                            ", but knots and degrees require " + std::to_string(count(form.degree_u, form.knots_u)) + " x " +
                            std::to_string(count(form.degree_v, form.knots_v))});
  return form;
}

}  // namespace

NurbsSurface::NurbsSurface(NurbsSurfaceForm form, bool is_periodic_u, bool is_periodic_v, std::string kind)
    : form_(checked(std::move(form))),
      basis_u_(form_.degree_u, form_.knots_u, is_periodic_u, k_nurbs_surface_attempt),
      basis_v_(form_.degree_v, form_.knots_v, is_periodic_v, k_nurbs_surface_attempt),
      poles_(weighted_poles(form_.poles, form_.weights, form_.n_u * form_.n_v, k_nurbs_surface_attempt)),
      kind_(kind.empty() ? "NURBS " + std::to_string(form_.degree_u) + " x " + std::to_string(form_.degree_v) : std::move(kind)) {}

template <int n_u, int n_v>
Point NurbsSurface::point_of(Uv at) const {
  Support support;
  find_support<n_u, n_v, false>(at, basis_u_, basis_v_, poles_.data(), form_.n_v, support);
  auto& [bu, bv, orders_u, orders_v, row] = support;
  Value sum{};
  for (std::size_t i = 0; i < orders_u; ++i, row += form_.n_v) {
    Value along{};
    for (std::size_t j = 0; j < orders_v; ++j) along += bv.value[j] * row[j].value;
    sum += bu.value[i] * along;
  }
  return form_.weights.empty() ? position(sum) : position(sum) / sum[3];
}

template <int n_u, int n_v>
SurfaceDerivatives NurbsSurface::derivatives_of(Uv at) const {
  Support support;
  find_support<n_u, n_v, true>(at, basis_u_, basis_v_, poles_.data(), form_.n_v, support);
  auto& [bu, bv, orders_u, orders_v, row] = support;
  Value s{}, su{}, sv{}, suu{}, suv{}, svv{};
  for (std::size_t i = 0; i < orders_u; ++i, row += form_.n_v) {
    Value along{}, along_v{}, along_vv{};
    for (std::size_t j = 0; j < orders_v; ++j) {
      const Value pole = row[j].value;
      along += bv.value[j] * pole;
      along_v += bv.d1[j] * pole;
      along_vv += bv.d2[j] * pole;
    }
    s += bu.value[i] * along;
    su += bu.d1[i] * along;
    suu += bu.d2[i] * along;
    sv += bu.value[i] * along_v;
    suv += bu.d1[i] * along_v;
    svv += bu.value[i] * along_vv;
  }
  if (!form_.weights.empty()) {  // quotient rule; lane 3 is the weight
    const double r = 1.0 / s[3];
    const double wu = su[3], wv = sv[3], wuu = suu[3], wuv = suv[3], wvv = svv[3];
    s *= r;
    su = (su - wu * s) * r;
    sv = (sv - wv * s) * r;
    suu = (suu - 2.0 * wu * su - wuu * s) * r;
    suv = (suv - wu * sv - wv * su - wuv * s) * r;
    svv = (svv - 2.0 * wv * sv - wvv * s) * r;
  }
  return {position(s), position(su), position(sv), position(suu), position(suv), position(svv)};
}

template <int n_u, int n_v>
void NurbsSurface::points_of(std::span<const Uv> at, std::span<Point> points) const {
  for (std::size_t i = 0; i < at.size(); ++i) points[i] = point_of<n_u, n_v>(at[i]);
}

template <class F>
decltype(auto) NurbsSurface::with_orders(const F& f) const {
  const auto with_v = [&](auto n_u) {
    constexpr int k_u = decltype(n_u)::value;
    switch (form_.degree_v) {
      case 1: return f(n_u, std::integral_constant<int, 2>{});
      case 2: return f(n_u, std::integral_constant<int, 3>{});
      case 3: return f(n_u, std::integral_constant<int, 4>{});
      default: return f(std::integral_constant<int, 0 * k_u>{}, std::integral_constant<int, 0>{});
    }
  };
  switch (form_.degree_u) {
    case 1: return with_v(std::integral_constant<int, 2>{});
    case 2: return with_v(std::integral_constant<int, 3>{});
    case 3: return with_v(std::integral_constant<int, 4>{});
    default: return f(std::integral_constant<int, 0>{}, std::integral_constant<int, 0>{});
  }
}

Point NurbsSurface::point(Uv at) const {
  return with_orders([&](auto n_u, auto n_v) { return point_of<decltype(n_u)::value, decltype(n_v)::value>(at); });
}

SurfaceDerivatives NurbsSurface::derivatives(Uv at) const {
  return with_orders([&](auto n_u, auto n_v) { return derivatives_of<decltype(n_u)::value, decltype(n_v)::value>(at); });
}

void NurbsSurface::points(std::span<const Uv> at, std::span<Point> points) const {
  with_orders([&](auto n_u, auto n_v) { points_of<decltype(n_u)::value, decltype(n_v)::value>(at, points); });
}

}  // namespace sterna
