// Features of a fluid domain: actuator discs, wake sheets, opened ridges and others. Each feature is one class, which the steps of a run call at fixed points.
// A new feature is one class and one entry in the list of domain_features().
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/adjacent/close_boundary.h"
#include "volmesh/case/mesh_case.h"
#include "volmesh/domain/domain_parts.h"
#include "volmesh/envelope/envelope.h"
#include "volmesh/features/fluid_boundary.h"
#include "volmesh/layer/assemble.h"

namespace sterna::volmesh {

/// The request of a domain.
struct DomainTask {
  const MeshCase& options;           ///< options returned by validated()
  std::span<const VertexId> closed;  ///< vertices of the wall that get no multi-normal fan
  const EndOptions* given_ends;      ///< options as the user gave them, for a warning if no patch is triangulated with them; null: no warning
  const RunContext& context;
};

/// A layer that is laid out on the wall of a domain.
struct LayerTask {
  const MeshCase& options;
  const Domain& domain;
  const LayerBase& base;
  const EnvelopeShape& envelope;
  const RunContext& context;
};

/// A feature. The functions are declared in the order in which a run calls them. Within one call, features follow in the order of the list, except for trace().
/// By default, a function does nothing.
class DomainFeature {
 public:
  virtual ~DomainFeature() = default;

  /// Changes the closed boundary of the fluid, before it is separated into walls with layers and other patches.
  virtual void prepare(const DomainTask& /*task*/, FluidBoundary& /*boundary*/) {}
  /// Adds to the separated domain. \pre Domain::wall2surface contains triangles of `boundary`
  virtual void extend(const DomainTask& /*task*/, const FluidBoundary& /*boundary*/, Domain& /*domain*/) {}
  /// Replaces the triangles in Domain::wall2surface by those before prepare(). Called in reverse order, so the triangles are those after prepare().
  virtual void trace(FluidBoundary& /*boundary*/, Domain& /*domain*/) {}
  /// Returns what the feature requires of later steps. \pre the domain is complete
  virtual DomainNeeds needs(const Domain& /*domain*/) const { return {}; }

  /// Adds to the outer boundary around the layer. \pre `outer` was returned by close_boundary()
  virtual void add_boundary(const LayerTask& /*task*/, ClosedOuter& /*outer*/) const {}
  /// Separates columns, which stand on the closed wall until then.
  virtual void cut_columns(const Domain& /*domain*/, LayerBlock& /*layers*/, std::vector<Point>& /*points*/) const {}
  /// Adds data to a layer that is assembled, or that was stored. \pre the layer targets of the mesh belong to the closed wall
  virtual void label(const Domain& /*domain*/, HybridMesh& /*layer*/) const {}
  /// Converts the layer to the cells of the given wall. \throws the errors of close_multi_normals() and close_wakes()
  virtual void finish(const Domain& /*domain*/, HybridMesh& /*layer*/, FillBoundary& /*boundary*/) const {}
};

/// Returns the features that the case requests, in their fixed order.
std::vector<std::shared_ptr<DomainFeature>> domain_features(const MeshCase& options);
/// Checks that features and options can be combined. \throws Error(bad_argument)
void require_compatible(const MeshCase& options);

}  // namespace sterna::volmesh
