// Inside geom/cad only: curves and surfaces of OpenCASCADE behind our interfaces, and ours as theirs.
#pragma once

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>

#include "geom/model/curve.h"
#include "geom/model/surface.h"

namespace sterna::cad {

/// The same geometry with the same parameters: ours where we have the type, else a wrapper. Infinite ones get the range (box) that is asked for.
CurvePtr curve_of(const Handle(Geom_Curve) & curve, Interval range);
ParameterCurvePtr parameter_curve_of(const Handle(Geom2d_Curve) & curve, Interval range);
SurfacePtr surface_of(const Handle(Geom_Surface) & surface, const ParameterBox& box);

/// The same geometry with the same parameters as OpenCASCADE's; null where there is no exact form.
Handle(Geom_Curve) geom_of(const Curve& curve);
Handle(Geom2d_Curve) geom_of(const ParameterCurve& curve);
Handle(Geom_Surface) geom_of(const Surface& surface);

}  // namespace sterna::cad
