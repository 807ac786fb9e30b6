// Layer settings of patches: determines which patches carry layers, and the layer targets of each wall vertex if patches differ.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/first_heights.h"
#include "volmesh/case/patch_rule.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Sets the kinds of patches for which rules give a kind. If several rules give one, the last rule applies.
/// \throws Error(bad_argument) for a rule whose name matches no patch; the message lists the patch names
void apply_patch_kinds(TriMesh& surface, std::span<const PatchRule> rules);

/// Returns the patch with the kind that the rules give.
Patch with_kind(Patch patch, std::span<const PatchRule> rules);

/// Layer settings of one patch.
struct PatchLayers {
  int layers = 0;                     ///< 0: the patch carries no layers
  double first_height = k_automatic;  ///< m; set if there are layers
  /// True if a rule gives the number of layers, the first height, the growth, the total height.
  bool has_own_layers = false, has_own_first_height = false, has_own_growth = false, has_own_height = false;
  double max_growth = 0.0;
  double total_height = k_automatic;   ///< m; automatic: from the wall's edges
  double max_thickness = k_automatic;  ///< m; automatic: a fraction of the body length
  double blend = k_automatic;          ///< m; automatic: from heights and edges
  bool carries_layers() const { return layers > 0; }
};

/// Returns the layer settings for a patch of this kind: the options of the envelope, replaced by the rules in their order. No setting is derived from the
/// others.
PatchLayers request_of(const Patch& patch, const EnvelopeOptions& options, std::span<const PatchRule> rules);

/// Returns the layer settings of each patch: the options of the envelope, replaced by the rules in their order. Patches of other kinds than wall carry no
/// layers, whatever the rules request.
/// \pre kinds are set (apply_patch_kinds), and the number of layers is not automatic
/// \throws Error(bad_argument) for a patch with layers but without a first height
Column<PatchId, PatchLayers> layers_of_patches(const Column<PatchId, Patch>& patches, const EnvelopeOptions& options, std::span<const PatchRule> rules);

/// Returns the layer targets of each vertex if patches have different settings. Returns empty columns if all triangles of the base have the settings of the
/// options. First heights and thicknesses are blended in their logarithms, growth ratios linearly. They are blended within `blend` of the border with a patch
/// with different settings, by the distance along the wall, so that both sides meet in their mean at the border. Each connected part of the wall gets the
/// largest requested number of layers; parts with several numbers are logged. Vertices that must grow alike get the smallest of their requests. Triangles of
/// patches without layers (which do not occur in a base) get the settings of the options. Deterministic; takes about 1 s per million vertices and different
/// patch. If `by_location` is not null, it supplies the first heights of patches for which no rule gives one.
/// \throws Error(bad_argument) like layers_of_patches
/// \pre `options` are those passed to the envelope and the extrusion
LayerDemand demand_of(const LayerBase& base, const EnvelopeOptions& options, std::span<const PatchRule> rules, const FirstHeights* by_location,
                      const RunContext& context);

/// Returns for each patch whether ridges between such patches are opened. `of_all` applies to patches without a rule.
Column<PatchId, std::uint8_t> patches_with_open_ridges(const Column<PatchId, Patch>& patches, bool of_all, std::span<const PatchRule> rules);

/// Returns LayerBase::truncation. At borders of patches, the setting is used with which growth lines lose the fewest layers. `of_all` applies to patches
/// without a rule.
Column<VertexId, Truncation> truncation_by_patches(const TriMesh& wall, Truncation of_all, std::span<const PatchRule> rules);

}  // namespace sterna::volmesh
