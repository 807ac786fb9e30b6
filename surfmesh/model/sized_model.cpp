#include "surfmesh/model/sized_model.h"

#include "surfmesh/model/proximity.h"
#include "surfmesh/model/surface_sizes.h"

namespace sterna::surfmesh {

SizedModel sized_model(Borrowed<const Model> of, Borrowed<const SurfaceMeshOptions> given, std::span<const Rule> patches, const SpaceSizes& requested,
                       const RunContext& context) {
  const Model& model = of;
  const SurfaceMeshOptions& options = given;
  SizedModel sized{model, options, sample_edges(model, context), {}, {}};
  sized.sizes = sizes_of_faces(model, sized.edges, options, patches, context);
  add_local_sizes(model, sized.edges, options, requested, sized.sizes);
  return sized;
}

void add_narrow_locations(SizedModel& sized, const WingBands* bands, const RunContext& context) {
  add_sources(sized.model, sized.edges, sized.topology, sized.options, sized.sizes, context, bands);
  if (looks_for_gaps(sized.options))
    add_gap_sources(sized.model, SurfaceSizes(sized.model, sized.edges, sized.topology, sized.sizes, {}, context, true), sized.options, sized.sizes, context);
}

}  // namespace sterna::surfmesh
