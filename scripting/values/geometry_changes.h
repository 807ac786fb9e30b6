// Comparisons of surfaces with what they were made of: noted in SurfaceValue::changed for manifests, and warned of.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/compare_geometry.h"
#include "geom/mesh/half.h"
#include "geom/mesh/surface_soup.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Notes the comparison in surface.changed and logs a warning for each loss. The figures are logged as well where something differs.
void note_change(SurfaceValue& surface, const GeometryChange& change, const RunContext& context, GeometryChangeUse use = GeometryChangeUse::keeps_shape);

/// Compares a surface that was stitched from soups with them where facets were dropped, and notes and warns of what is missing.
void note_reading(SurfaceValue& surface, const std::vector<SurfaceSoup>& soups, const RunContext& context);

/// Compares half of a surface with the part of the whole on that side of the plane.
void note_half(SurfaceValue& half, const TriMesh& whole, const HalfOptions& options, const RunContext& context);

/// The JSON array of manifests.
std::string changed_json(const std::vector<std::string>& changed);
/// Its entries; those that are no objects are left out.
/// \pre `text` is JSON
std::vector<std::string> changed_of_json(const std::string& text);

}  // namespace sterna::scripting
