// Layer domain: the wall that carries layers and the outer boundary, with the common data of all steps. Surface -> complete -> cut -> split.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/envelope/collide.h"
#include "volmesh/envelope/layer_base.h"

namespace sterna::volmesh {

/// Returns the options of the requested family member, with the layers solved for.
/// \throws Error(bad_argument) for missing required options and for inconsistent options; Error(empty_surface)
MeshCase validated(const TriMesh& wall, MeshCase options, const RunContext& context);

/// Builds the fluid's boundary: completed, its sliver triangles split, cut by discs, made periodic, split into walls and the rest, its ridges opened.
/// \p closed: vertices of the wall that get no multi-normal fan
/// \pre options validated
Domain domain_around(const TriMesh& surface, const MeshCase& options, const RunContext& context, std::span<const VertexId> closed = {});

/// Returns the walls with layers, and the layer requirements on them.
LayerBase base_of(const Domain& domain, const MeshCase& options, const RunContext& context);

/// Returns the edge lengths that the user's sources request on re-meshed patches; empty if no source does. `options` must outlive the result.
std::function<double(const Point&)> end_sizes(const MeshCase& options);

/// Returns the discs that end on no wall. \p on_walls: indices of the others
std::vector<ActuatorDisc> free_discs(const std::vector<ActuatorDisc>& discs, const std::vector<std::size_t>& on_walls);

/// Wall and outer boundary with the common data of all steps.
struct MeshingSite {
  /// Builds the layer domain. \throws as volume_mesh() for errors that no step can repair
  MeshingSite(const TriMesh& surface, const MeshCase& user_options, const RunContext& context, std::span<const VertexId> closed = {});
  MeshingSite(const MeshingSite&) = delete;
  MeshingSite& operator=(const MeshingSite&) = delete;

  MeshCase options;                ///< including the feature angle
  EnvelopeOptions given_envelope;  ///< without the feature angle, unless the user gave it
  Domain domain;
  LayerBase base;
  Collider collider;
};

}  // namespace sterna::volmesh
