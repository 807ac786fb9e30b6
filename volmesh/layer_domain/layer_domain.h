// Layer domain: the wall that carries layers, and the outer boundary, with the data that all steps use. The surface is completed, cut, and split into both.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "geom/base/borrowed.h"
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

/// Builds the fluid's boundary. It is completed, its sliver triangles are split, it is cut by discs and made periodic, and it is split into walls with layers
/// and the other patches. Then the ridges of the wall are opened. \p closed vertices of the wall that get no multi-normal fan
/// \pre the options were returned by validated()
Domain domain_around(const TriMesh& surface, const MeshCase& options, const RunContext& context, std::span<const VertexId> closed = {});

/// Returns the walls with layers, and the layer requirements on them.
LayerBase base_of(const Domain& domain, const MeshCase& options, const RunContext& context);

/// Returns the edge lengths that the user's sources require on re-meshed patches; empty if no source affects them.
std::function<double(const Point&)> end_sizes(Borrowed<const MeshCase> options);

/// Returns the discs that end on no wall. \p on_walls numbers of the other discs
std::vector<ActuatorDisc> free_discs(const std::vector<ActuatorDisc>& discs, const std::vector<std::size_t>& on_walls);

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
