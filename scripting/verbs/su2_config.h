// A configuration of SU2 for a mesh: its markers by the kinds of patches, flow, reference values and settings to start from.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/math/constants.h"
#include "geom/mesh/hybrid_mesh.h"
#include "scripting/verbs/solver_case.h"
#include "volmesh/flow/flow_state.h"

namespace sterna::scripting {

struct Su2Options {
  std::string mesh;
  std::string solver = "automatic";
  std::string turbulence = "SA";
  std::string wall_functions = "automatic";
  double cfl = k_automatic;
  bool restart = false;
};

/// Returns the text of the configuration. Walls are MARKER_HEATFLUX (adiabatic) or MARKER_ISOTHERMAL, in flow without viscosity MARKER_EULER. Slip walls are
/// MARKER_EULER, symmetry is MARKER_SYM, the farfield MARKER_FAR. Inflow and outflow of tunnels (meshes without farfield) have total conditions and pressure of
/// the flow, along the patch's normal. Inflow and outflow of bodies in a farfield, and actuator discs, have the conditions in `boundaries`. Forces are computed
/// on all walls except those of tunnels (walls that touch an inflow or outflow). Half models have half the area. Tunnels need no reference area. Ducts, which
/// are tunnels without a model in them, monitor no forces; their openings are MARKER_ANALYZE. CFL numbers and the linear solver follow from the least
/// Measure::orthogonality. The decisions go to the log. \p boundaries by the names of patches
/// \throws Error(bad_argument) with all data that are neither in the mesh nor given
std::string su2_config(const HybridMesh& mesh, const Su2Options& options, const CaseOptions& common, const volmesh::FlowState& flow,
                       const CaseReference& reference, const CaseBoundaries& boundaries, const RunContext& context,
                       const CaseMeasure& orthogonality = {.worst = 90.0 * k_degree, .location = {}});

/// Checks the flow data that a configuration needs, independent of the mesh. \param is_viscous unknown before meshing; the temperature is then not required
void require_su2_flow(const volmesh::FlowState& flow, std::optional<bool> is_viscous, CaseProblems& problems);

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::Su2Options> {
  using O = scripting::Su2Options;
  static constexpr std::string_view stage = "su2_config";
  static constexpr std::array fields = {
      Field<O>{.name = "mesh", .member = &O::mesh, .help = "name of the mesh file that SU2 reads (.su2 or .cgns); empty: name of the configuration with .su2"},
      Field<O>{.name = "solver",
               .member = &O::solver,
               .help = "solver; automatic: RANS if the mesh has layers, otherwise EULER",
               .choices = "automatic EULER NAVIER_STOKES RANS"},
      Field<O>{.name = "turbulence", .member = &O::turbulence, .help = "turbulence model of RANS", .choices = "SA SST"},
      Field<O>{.name = "wall_functions",
               .member = &O::wall_functions,
               .help = "wall functions of RANS; automatic: yes if the requested first height corresponds to a y+ above 20 in this flow",
               .choices = "automatic yes no"},
      Field<O>{.name = "cfl",
               .member = &O::cfl,
               .min = 0.01,
               .max = 1e6,
               .help = "CFL number at the start; SU2 adapts it",
               .automatic = "10; 5 or 1 if faces of control volumes are nearly parallel to their edges"},
      Field<O>{.name = "restart", .member = &O::restart, .help = "continue from restart_flow, which an earlier run wrote"},
  };
};

}  // namespace sterna
