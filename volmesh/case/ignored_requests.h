// Finds requests that have no effect on this model. They lead to errors or warnings.
#pragma once

#include <cstdint>
#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Checks that each layer request in `options.patches` applies to at least one patch. Requests are the number of layers, heights, growth, blend, opened ridges
/// and truncation. If a later rule replaces a request on purpose (by a kind other than wall, or by layers = 0), that is no error. Options for all walls that no
/// wall uses lead to warnings, also if no wall has layers.
/// \param patches patches with their kinds (apply_patch_kinds)
/// \param has_layer for each patch: true if it carries layers
/// \throws Error(bad_argument) with all affected rules, the kinds of their patches, and the remedy
void require_used_requests(const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, const MeshCase& options,
                           const RunContext& context);

/// Checks that all farfield options that are set belong to the shape. A radius belongs to a sphere or cylinder, a centre to a sphere, corners to a box or
/// cylinder.
/// \param options options with the shape that will be made
/// \throws Error(bad_argument) with the options that do not belong to the shape, and the shapes to which they belong
void require_used_farfield(const FarfieldOptions& options);

/// Warns of sources that lie entirely outside the fluid. A source inside a body is not reported if it refines edges near the body's surface.
/// \param boundary closed boundary of the fluid, normals into the fluid
void warn_of_sources_outside(const TriMesh& boundary, const MeshCase& options, const RunContext& context);

/// Warns of options for adjacent patches (ends_growth etc.) that are set although no patch of the model is triangulated with them.
void warn_of_unused_end_options(const EndOptions& given, const RunContext& context);

}  // namespace sterna::volmesh
