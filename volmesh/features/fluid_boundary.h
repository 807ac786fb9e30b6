// The closed boundary of the fluid while features change it, before it is separated into walls with layers and other patches.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/run_context.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/domain/complete_boundary.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/domain/split_slivers.h"

namespace sterna::volmesh {

/// The closed boundary of the fluid with the kinds of its patches. Added planes on which no layers end have separate vertices.
struct FluidBoundary {
  TriMesh mesh;
  Column<PatchId, std::uint8_t> has_layer;
  std::vector<AddedPlane> planes;
  std::size_t n_given = 0;                     ///< number of triangles of the user's surface, which come first until slivers are split
  SliverSplits slivers = {};                   ///< sources in the boundary before slivers were split
  std::vector<PeriodicPatches> periodic = {};  ///< joined sides
};

/// Completes the user's surface, and finds the patches with layers. \p given surface with patch kinds
FluidBoundary completed_boundary(const TriMesh& given, const MeshCase& options, const RunContext& context);

/// Returns for each patch of the boundary whether it carries layers. The log states where layers continue over inflow and outflow patches.
Column<PatchId, std::uint8_t> patches_with_layers(const TriMesh& boundary, const MeshCase& options, const RunContext& context);

/// Returns the smallest first height of all walls in metres.
double least_first_height(const MeshCase& options);
/// Returns true if layers of some walls get several normals along sharp convex edges.
bool opens_ridges(const MeshCase& options);
/// Returns the edge lengths that the user's sources require on re-meshed patches; empty if no source affects them.
std::function<double(const Point&)> end_sizes(Borrowed<const MeshCase> options);

}  // namespace sterna::volmesh
