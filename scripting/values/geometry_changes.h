// Comparisons of surfaces with their inputs. They are noted in SurfaceValue::history for manifests, and reported as warnings.
#pragma once

#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/compare_geometry.h"
#include "geom/mesh/half.h"
#include "geom/mesh/surface_soup.h"
#include "scripting/values/verbs.h"

namespace sterna::scripting {

/// Stores the figures of the comparison in the last step of the surface and logs a warning for each loss. If something differs, the figures are logged as well.
/// \pre surface.history has the step that is compared as its last
void note_change(SurfaceValue& surface, const GeometryChange& change, const RunContext& context, GeometryChangeUse use = GeometryChangeUse::keeps_shape);

/// Compares a surface stitched from soups with these soups if facets were dropped. Adds a step for missing parts and warns about them.
void note_reading(SurfaceValue& surface, const std::vector<SurfaceSoup>& soups, const RunContext& context);

/// Compares half of a surface with the part of the whole surface on that side of the plane, as a step of its own.
void note_half(SurfaceValue& half, const TriMesh& whole, const HalfOptions& options, const RunContext& context);

}  // namespace sterna::scripting
