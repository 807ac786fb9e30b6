// NURBS surface with the evaluator used in meshing: no allocation, poles in four lanes, kernels for each pair of degrees up to 3 x 3.
#pragma once

#include "geom/model/knot_basis.h"
#include "geom/model/surface.h"

namespace sterna {

/// Any NURBS surface, degrees 1 .. 25; spline surfaces through grids of points (spline.h) are also of this class.
class NurbsSurface final : public Surface {
 public:
  /// `is_periodic_*`: the last row equals the first, and parameters outside the domain are wrapped. `kind` empty: "NURBS p x q".
  /// \throws Error(bad_argument) if the form is invalid
  explicit NurbsSurface(NurbsSurfaceForm form, bool is_periodic_u = false, bool is_periodic_v = false, std::string kind = {});
  ParameterBox domain() const override { return {basis_u_.domain(), basis_v_.domain()}; }
  bool is_periodic_u() const override { return basis_u_.is_periodic(); }
  bool is_periodic_v() const override { return basis_v_.is_periodic(); }
  Point point(Uv at) const override;
  SurfaceDerivatives derivatives(Uv at) const override;
  void points(std::span<const Uv> at, std::span<Point> points) const override;
  std::vector<double> breaks_u() const override { return basis_u_.breaks(); }
  std::vector<double> breaks_v() const override { return basis_v_.breaks(); }
  std::optional<NurbsSurfaceForm> exact_nurbs() const override { return form_; }
  std::string kind() const override { return kind_; }
  const NurbsSurfaceForm& form() const { return form_; }

 private:
  template <int n_u, int n_v>
  Point point_of(Uv at) const;
  template <int n_u, int n_v>
  SurfaceDerivatives derivatives_of(Uv at) const;
  template <int n_u, int n_v>
  void points_of(std::span<const Uv> at, std::span<Point> points) const;
  /// Calls f with the number of functions in both directions as constants, or with 0, 0 if either degree is above 3.
  template <class F>
  decltype(auto) with_orders(const F& f) const;

  NurbsSurfaceForm form_;
  KnotBasis basis_u_, basis_v_;
  std::vector<Lanes4> poles_;  ///< w * (x, y, z, 1)
  std::string kind_;
};

}  // namespace sterna
