// Where a volume mesh is made: the wall that carries layers and the outer boundary, with what every step needs of them. Surface -> complete -> cut -> split.
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

/// The options of the member of the family that is asked for, with the layers that are solved for.
/// \throws Error(bad_argument) for options that are required or do not agree; Error(empty_surface)
MeshCase validated(const TriMesh& wall, MeshCase options, const RunContext& context);

/// The fluid's boundary: completed, its needles split, cut by discs, made periodic, taken apart, its ridges opened.
/// \p closed: vertices of the wall that get no fan of lines
/// \pre options validated
Domain domain_around(const TriMesh& surface, const MeshCase& options, const RunContext& context, std::span<const VertexId> closed = {});

/// The walls with layers, and what is asked of the layer on them.
LayerBase base_of(const Domain& domain, const MeshCase& options, const RunContext& context);

/// Edge lengths that the user's sources ask for on patches that are triangulated anew; empty where nothing does. `options` must outlive it.
std::function<double(const Point&)> end_sizes(const MeshCase& options);

/// The discs that end on no wall. \p on_walls: indices of the others
std::vector<ActuatorDisc> free_discs(const std::vector<ActuatorDisc>& discs, const std::vector<std::size_t>& on_walls);

/// Wall and outer boundary with what every step needs of them.
struct MeshingSite {
  /// \throws as volume_mesh() for what no step can repair
  MeshingSite(const TriMesh& surface, const MeshCase& user_options, const RunContext& context, std::span<const VertexId> closed = {});
  MeshingSite(const MeshingSite&) = delete;
  MeshingSite& operator=(const MeshingSite&) = delete;

  MeshCase options;                ///< with the feature angle
  EnvelopeOptions given_envelope;  ///< without it, unless the user gave it
  Domain domain;
  LayerBase base;
  Collider collider;
};

}  // namespace sterna::volmesh
