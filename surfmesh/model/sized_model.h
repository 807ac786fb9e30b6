// A model with the sizes at the start of its meshing. mesh_model() and forecast_surface() share it.
#pragma once

#include <span>

#include "geom/base/borrowed.h"
#include "surfmesh/model/model_sizes.h"
#include "surfmesh/model/wing_bands.h"

namespace sterna::surfmesh {

struct SizedModel {
  const Model& model;
  const SurfaceMeshOptions& options;
  Column<EdgeId, EdgeSamples> edges;
  ModelSizes sizes;
  ModelTopology topology;  ///< empty until small parts have been absorbed (absorb_small_parts)
};

/// Samples the edges and computes the sizes required by options, curvature and locations.
/// \throws Error(bad_argument) for patch rules that match no patch, and for chord errors out of reach
SizedModel sized_model(Borrowed<const Model> model, Borrowed<const SurfaceMeshOptions> options, std::span<const Rule> patches, const SpaceSizes& requested,
                       const RunContext& context);

/// Adds the sizes of narrow regions and, if requested, of gaps.
/// \pre small parts have been absorbed
void add_narrow_locations(SizedModel& sized, const WingBands* bands, const RunContext& context);

}  // namespace sterna::surfmesh
