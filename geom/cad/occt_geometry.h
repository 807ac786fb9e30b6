// Inside geom/cad only: wraps curves and surfaces of OpenCASCADE in our interfaces, and converts ours to OpenCASCADE.
#pragma once

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>

#include "geom/model/curve.h"
#include "geom/model/surface.h"

namespace sterna::cad {

/// Returns the same geometry with the same parameters: as our type if there is one, else as a wrapper. Infinite geometry is limited to the given range (box).
CurvePtr curve_of(const Handle(Geom_Curve) & curve, Interval range);
ParameterCurvePtr parameter_curve_of(const Handle(Geom2d_Curve) & curve, Interval range);
SurfacePtr surface_of(const Handle(Geom_Surface) & surface, const ParameterBox& box);

/// Returns the same geometry with the same parameters in OpenCASCADE; null if there is no exact form.
Handle(Geom_Curve) geom_of(const Curve& curve);
Handle(Geom2d_Curve) geom_of(const ParameterCurve& curve);
Handle(Geom_Surface) geom_of(const Surface& surface);

}  // namespace sterna::cad
