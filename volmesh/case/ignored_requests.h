// Requests that have no effect on this model: errors and warnings instead of silence.
#pragma once

#include <cstdint>
#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"

namespace sterna::volmesh {

/// Checks that each request for layers in `options.patches` holds on at least one patch: a number of layers, heights, growth, blend, opened ridges, truncation.
/// A request that a later rule replaces on purpose (by a kind that is no wall, or by layers = 0) is no error. Options of all walls that no wall uses are
/// warnings, also where no wall has layers.
/// \param patches with their kinds (apply_patch_kinds)
/// \param has_layer of each patch: whether it carries layers
/// \throws Error(bad_argument) with all rules in question, the kinds of their patches, and the remedy
void require_used_requests(const Column<PatchId, Patch>& patches, const Column<PatchId, std::uint8_t>& has_layer, const MeshCase& options,
                           const RunContext& context);

/// Checks that all options of the farfield belong to its shape: a radius to a sphere or cylinder, a centre to a sphere, corners to a box or cylinder.
/// \param options with the shape that is made
/// \throws Error(bad_argument) with the options that the shape does not have, and the shapes that have them
void require_used_farfield(const FarfieldOptions& options);

/// Warns of sources that lie wholly outside of the fluid. A source inside of a body is not reported where it refines edges near its surface.
/// \param boundary closed boundary of the fluid, normals into the fluid
void warn_of_sources_outside(const TriMesh& boundary, const MeshCase& options, const RunContext& context);

/// Warns of options of adjacent patches (ends_growth, ...) that were given, where the model has no patch that is triangulated by them.
void warn_of_unused_ends(const EndOptions& given, const RunContext& context);

}  // namespace sterna::volmesh
