// Layer settings of patches: determines which patches carry layers, and the layer targets of each wall vertex if patches differ.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/first_heights.h"
#include "volmesh/case/layer_rules.h"
#include "volmesh/case/prism_options.h"
#include "volmesh/case/ridge_options.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Sets the kinds of patches for which rules give a kind. If several rules give one, the last rule applies.
/// \throws Error(bad_argument) for a rule whose name matches no patch; the message lists the patch names
void apply_patch_kinds(TriMesh& surface, std::span<const Rule> rules);

/// Returns true if a patch with these options carries layers. \pre the options are those of request_of
inline bool carries_layers(const EnvelopeOptions& of_patch) { return of_patch.layers > 0; }

/// Returns the layer options of a patch of this kind: those of all walls, replaced by the rules in their order. No option is derived from the others. Patches
/// of other kinds than wall have no layers, whatever the rules request.
EnvelopeOptions request_of(const Patch& patch, const EnvelopeOptions& options, std::span<const Rule> rules);

/// Returns the layer options of each patch (request_of), with the option that follows from its total height.
/// \pre kinds are set (apply_patch_kinds), and the number of layers is not automatic
/// \throws Error(bad_argument) for a patch with layers but without a first height
Column<PatchId, EnvelopeOptions> layers_of_patches(const Column<PatchId, Patch>& patches, const EnvelopeOptions& options, std::span<const Rule> rules);

/// Returns the layer targets of each vertex if patches have different settings. Returns empty columns if all triangles of the base have the settings of the
/// options. First heights and thicknesses are blended in their logarithms, growth ratios linearly. They are blended within `blend` of the border with a patch
/// with different settings, by the distance along the wall, so that both sides meet in their mean at the border. Each connected part of the wall gets the
/// largest requested number of layers; parts with several numbers are logged. Vertices that must grow alike get the smallest of their requests. Triangles of
/// patches without layers (which do not occur in a base) get the settings of the options. Deterministic; takes about 1 s per million vertices and different
/// patch. If `by_location` is not null, it supplies the first heights of patches for which no rule gives one.
/// \throws Error(bad_argument) like layers_of_patches
/// \pre `options` are those passed to the envelope and the extrusion
LayerDemand demand_of(const LayerBase& base, const EnvelopeOptions& options, std::span<const Rule> rules, const FirstHeights* by_location,
                      const RunContext& context);

/// Returns for each patch whether ridges between such patches are opened. `options` are those of patches without a rule.
Column<PatchId, std::uint8_t> patches_with_open_ridges(const Column<PatchId, Patch>& patches, const RidgeOptions& options, std::span<const Rule> rules);

/// Returns LayerBase::truncation. At borders of patches, the setting is used with which growth lines lose the fewest layers. `options` are those of patches
/// without a rule.
Column<VertexId, Truncation> truncation_by_patches(const TriMesh& wall, const PrismOptions& options, std::span<const Rule> rules);

}  // namespace sterna::volmesh
