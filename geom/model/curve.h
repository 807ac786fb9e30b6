// Curves that edges lie on, in space and in a face's parameter plane. Immutable and shared; every member may be called from many threads.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "geom/model/nurbs_form.h"

namespace sterna {

struct CurveDerivatives {
  Point point;
  Vec3 first;   ///< d/dt
  Vec3 second;  ///< d2/dt2
};

/// Curve in space, metres over a parameter t. Evaluators accept any t of the domain (and of any period, if periodic). Outside the domain they extend the end
/// pieces and never throw.
class Curve {
 public:
  virtual ~Curve() = default;
  virtual Interval domain() const = 0;
  virtual bool is_periodic() const { return false; }
  virtual Point point(double t) const = 0;
  virtual CurveDerivatives derivatives(double t) const = 0;
  /// Returns the parameters inside the domain, ascending, where the curve is less than twice continuously differentiable.
  virtual std::vector<double> breaks() const { return {}; }
  /// Returns the same curve with the same parameter as NURBS; empty if there is no exact form.
  virtual std::optional<NurbsCurveForm<Point>> exact_nurbs() const { return std::nullopt; }
};
using CurvePtr = std::shared_ptr<const Curve>;

struct ParameterCurveDerivatives {
  Uv point;
  Uv first;
};

/// Curve in the parameter plane of a face's surface.
class ParameterCurve {
 public:
  virtual ~ParameterCurve() = default;
  virtual Interval domain() const = 0;
  virtual Uv point(double t) const = 0;
  virtual ParameterCurveDerivatives derivatives(double t) const = 0;
  virtual std::optional<NurbsCurveForm<Uv>> exact_nurbs() const { return std::nullopt; }
};
using ParameterCurvePtr = std::shared_ptr<const ParameterCurve>;

}  // namespace sterna
