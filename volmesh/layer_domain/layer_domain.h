// Layer domain: the wall that carries layers, and the outer boundary, with the data that all steps use. The surface is completed, cut, and split into both.
#pragma once

#include <span>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Returns the options of the requested family member. The dependent layer parameter is computed.
/// \throws Error(bad_argument) for missing required options and for inconsistent options; Error(empty_surface)
MeshCase validated(const TriMesh& wall, MeshCase options, const RunContext& context);

/// Builds the fluid's boundary. It is completed, changed by the features of the case (features/domain_feature.h), and split into walls with layers and the
/// other patches, to which features add. \p closed vertices of the wall that get no multi-normal fan \pre the options were returned by validated()
Domain domain_around(const TriMesh& surface, const MeshCase& options, const RunContext& context, std::span<const VertexId> closed = {});

/// Returns the walls with layers, and the layer requirements on them.
LayerBase base_of(const Domain& domain, const MeshCase& options, const RunContext& context);

/// Wall and outer boundary, with the data that all steps use.
struct LayerDomain {
  /// Builds the layer domain. \throws the errors of volume_mesh() that no step can repair
  LayerDomain(const TriMesh& surface, const MeshCase& user_options, const RunContext& context, std::span<const VertexId> closed = {});
  LayerDomain(const LayerDomain&) = delete;
  LayerDomain& operator=(const LayerDomain&) = delete;

  MeshCase options;                ///< options, including the feature angle
  EnvelopeOptions given_envelope;  ///< envelope options without the feature angle, unless the user gave it
  Domain domain;
  LayerBase base;
  Collider collider;
};

}  // namespace sterna::volmesh
