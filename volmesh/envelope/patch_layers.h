// Walls with their own layers: which patches carry layers, and what each vertex of the wall asks for where patches differ.
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

/// Sets the kinds of patches that rules name one for; of several the last.
/// \throws Error(bad_argument) for a rule that no patch has a name like: with the names
void apply_patch_kinds(TriMesh& surface, std::span<const PatchRule> rules);

/// The patch with the kind that rules give it.
Patch with_kind(Patch patch, std::span<const PatchRule> rules);

/// What is asked of the layer on one patch.
struct PatchLayers {
  int layers = 0;                                                                                             ///< 0: the patch carries none
  double first_height = k_automatic;                                                                          ///< m; a number where there are layers
  bool has_own_layers = false, has_own_first_height = false, has_own_growth = false, has_own_height = false;  ///< a rule gives it
  double max_growth = 0.0;
  double total_height = k_automatic;   ///< m; automatic: by the wall's edges
  double max_thickness = k_automatic;  ///< m; automatic: a share of the body length
  double blend = k_automatic;          ///< m; automatic: by heights and edges
  bool carries_layers() const { return layers > 0; }
};

/// What the options of the envelope, overruled by the rules in their order, say of a patch of this kind: nothing is solved for.
PatchLayers request_of(const Patch& patch, const EnvelopeOptions& options, std::span<const PatchRule> rules);

/// Per patch: the options of the envelope, overruled by the rules in their order. Patches of other kinds than wall carry no layers, whatever is asked.
/// \pre kinds are set (apply_patch_kinds), the number of layers is not automatic
/// \throws Error(bad_argument) for a patch with layers and without a first height
Column<PatchId, PatchLayers> layers_of_patches(const Column<PatchId, Patch>& patches, const EnvelopeOptions& options, std::span<const PatchRule> rules);

/// What is asked of the layer at each vertex, where patches ask for different things; empty when all triangles of the base ask for the same as the options do.
/// First heights and thicknesses are blended in their logarithms, growth ratios as they are: within `blend` of the border with a patch that asks for something
/// else, by the distance along the wall, so that both sides meet in the mean of the patches at the border. Layers: per connected part of the wall the largest
/// number asked for; parts in which patches ask for several are logged. Vertices that must grow alike get the least of what theirs ask for. Triangles of
/// patches without layers (which a base has no use for) ask for what the options say. Deterministic; about 1 s per million vertices and different patch.
/// `by_place` may be null: else it gives the first heights of patches that no rule gives one for.
/// \throws Error(bad_argument) as layers_of_patches
/// \pre `options` are those that envelope and extrusion get
LayerDemand demand_of(const LayerBase& base, const EnvelopeOptions& options, std::span<const PatchRule> rules, const FirstHeights* by_place,
                      const RunContext& context);

/// Per patch: whether ridges between such patches are opened. `of_all` is what holds for patches without a rule.
Column<PatchId, std::uint8_t> patches_with_open_ridges(const Column<PatchId, Patch>& patches, bool of_all, std::span<const PatchRule> rules);

/// LayerBase::truncation: at borders of patches the one by which lines give up the fewest layers. `of_all` is what holds for patches without a rule.
Column<VertexId, Truncation> truncation_by_patches(const TriMesh& wall, Truncation of_all, std::span<const PatchRule> rules);

}  // namespace sterna::volmesh
