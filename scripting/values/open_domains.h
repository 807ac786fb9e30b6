// Open surfaces: which of them are part of a body that ends in planes of the domain, which are sheets, and which have their normals inwards.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// One sentence with the planes, where all rims of an open surface lie in one to three planes x, y or z = constant at its ends and span its opening there: half
/// or a quarter of a body, or a section between two planes. Nothing where repair has to close the surface.
std::optional<std::string> ends_in_planes(const TriMesh& mesh, const RunContext& context);

/// One sentence where the largest open part of the surface is a sheet: as large as its opening, with its normals to one side, as terrain.
std::optional<std::string> is_open_sheet(const TriMesh& mesh, const RunContext& context);

/// The surface with the normals of its open parts upwards, along the axis in which most of their area points: the fluid is above the floor (farfield_floor).
SurfaceValue with_floor_upwards(const SurfaceValue& wall, const std::string& floor, const RunContext& context);

/// The surface as a body, where it is open, has its normals inwards, and a farfield is given: a farfield is around bodies. Says so.
/// \param has_farfield it is given, or is the default
SurfaceValue as_body(const SurfaceValue& wall, bool has_farfield, const RunContext& context);

}  // namespace sterna::scripting
