// A model and the sizes that its mesh begins with: what mesh_model() and forecast_surface() share.
#pragma once

#include <span>

#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

struct SizedModel {
  const Model& model;
  const SurfaceMeshOptions& options;
  Column<EdgeId, EdgeSamples> edges;
  ModelSizes sizes;
  ModelTopology topology;  ///< empty until small parts are absorbed (absorb_small_parts)
};

/// Samples of the edges, and the sizes that options, curvature and places request.
/// \pre `model` and `options` outlive the result
/// \throws Error(bad_argument) for rules of patches that match none, and for chord errors out of reach
SizedModel sized_model(const Model& model, const SurfaceMeshOptions& options, std::span<const PatchSurfaceOptions> patches, const SpaceSizes& asked,
                       const RunContext& context);

/// Adds the sizes of narrow places and, where they are requested, of gaps.
/// \pre small parts are absorbed
void add_narrow_places(SizedModel& sized, const WingBands* bands, const RunContext& context);

}  // namespace sterna::surfmesh
