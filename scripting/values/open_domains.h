// Classifies open surfaces: as part of a body that ends in planes of the domain, as a sheet, or as a surface with inward normals.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Returns one sentence with the planes if all boundary loops of an open surface lie in one to three planes x, y or z = constant. The planes must be at its
/// ends, and the loops must span its opening there: half or a quarter of a body, or a section between two planes. Returns nothing if repair has to close the
/// surface.
std::optional<std::string> ends_in_planes(const TriMesh& mesh, const RunContext& context);

/// Returns one sentence if the largest open part of the surface is a sheet, such as terrain. A sheet is as large as its opening and has all normals to one
/// side.
std::optional<std::string> is_open_sheet(const TriMesh& mesh, const RunContext& context);

/// Returns the surface with the normals of its open parts upwards, along the axis in which most of their area points. The fluid is above the floor
/// (farfield_floor).
SurfaceValue with_floor_upwards(const SurfaceValue& wall, const std::string& floor, const RunContext& context);

/// Returns the surface as a body. If there is a farfield, open parts with inward normals are turned, because a farfield surrounds bodies. Reports the change.
/// \param has_farfield true if a farfield is given, or is the default
SurfaceValue as_body(const SurfaceValue& wall, bool has_farfield, const RunContext& context);

}  // namespace sterna::scripting
