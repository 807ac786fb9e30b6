// Common parts of mesh:su2_config and mesh:foam_case: options, reference values, conditions at openings, and the roles of a mesh's patches in a solver.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/number_with_unit.h"
#include "geom/base/schema.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"
#include "volmesh/flow/flow_state.h"

namespace sterna::scripting {

struct CaseOptions {
  double alpha = 0.0;
  double beta = 0.0;
  double reference_area = k_automatic;
  double reference_length = k_automatic;
  std::string wing;
  std::string half = "automatic";
  double wall_temperature = k_automatic;
  std::string monitor;
  int iterations = 5000;
};

/// The condition at an opening or an actuator disc.
struct CaseBoundary {
  double pressure = k_automatic;
  double total_pressure = k_automatic;
  double total_temperature = k_automatic;
  double thrust = k_automatic;
  double pressure_jump = k_automatic;
  double temperature_jump = 0.0;
};
using CaseBoundaries = std::map<std::string, CaseBoundary>;  ///< conditions by names of patches

/// Reference values of the whole aircraft.
struct CaseReference {
  double area = k_automatic;    ///< m^2
  double length = k_automatic;  ///< m; automatic: that of the flow
  Point moment_origin{};        ///< m
  std::string source;           ///< origin of the values for the file and the log: "wing "main""
};

/// Kind that patches with matching names have in the solver. It replaces their kind in the mesh.
struct CaseKind {
  std::string names;  ///< pattern; if two patterns match a name, the one with more letters applies
  PatchKind kind = PatchKind::wall;
};

/// The request for a case, independent of the solver.
struct CaseRequest {
  CaseOptions options;
  volmesh::FlowState flow;
  CaseReference reference;
  CaseBoundaries boundaries;
  std::vector<CaseKind> kinds;
};

/// The worst value of a quality measure, which determines a solver's numerics.
struct CaseMeasure {
  double worst = 0.0;             ///< in the measure's unit
  std::optional<Point> location;  ///< m; location of the worst value, if it misses a limit of its gate
};

/// Returns the worst value from the last check of the mesh, or from a new check if the last one has not measured it. \p solver name of the solver in the error
/// \throws Error(bad_argument) if the mesh is not conforming, so that the measure is undefined
CaseMeasure measured_worst(const HybridMesh& mesh, Measure measure, const CheckReport* known, std::string_view solver, const RunContext& context);
/// Returns " at (x, y, z)", or nothing.
std::string at_location(const CaseMeasure& measure);

struct PatchFacts {
  std::size_t n_faces = 0;
  Vec3 area;          ///< m^2, sum of the faces' normals, out of the fluid
  double size = 0.0;  ///< m^2, sum of the areas of the faces
};

/// Collects data that are neither in the mesh nor given, so that all of them are reported together.
class CaseProblems {
 public:
  void add(std::string text) { all_.push_back(std::move(text)); }
  const std::vector<std::string>& all() const { return all_; }
  /// \throws Error(bad_argument)
  void require_none(const std::string& attempted) const;

 private:
  std::vector<std::string> all_;
};

/// The patches of a mesh in the roles that they have in solvers.
struct CasePatches {
  Column<PatchId, PatchFacts> facts;
  std::vector<PatchId> monitored;    ///< patches whose forces are computed: those named by `monitor`, else all walls except those of tunnels
  std::vector<PatchId> unmonitored;  ///< walls of a tunnel, which are recognised because they touch an inflow or outflow
  bool has_layers = false;
  bool is_tunnel = false;    ///< there are openings, but no farfield
  bool is_internal = false;  ///< a tunnel without a model in it (duct, nozzle): the result is the flow between its openings instead of forces
  bool is_half = false;
  std::vector<PatchId> inflows, outflows;
};

/// Returns the mesh with other kinds of patches; nothing if no kind is changed. Cells are kept, so a slip wall may have layers.
/// \throws Error(bad_argument) for a pattern that matches no patch, for the kind interface, and for periodic sides and actuator discs
std::optional<HybridMesh> with_kinds(const HybridMesh& mesh, std::vector<CaseKind> kinds, const std::string& attempted);

/// Rejects patches of unknown kind, because a guess would become a boundary condition. \param unknown patches of unknown kind (MeshValue::unknown_kinds)
/// \throws Error(bad_argument) that names the patches without a rule in `kinds`
void require_known_kinds(const std::set<std::string>& unknown, const std::vector<CaseKind>& kinds, const std::string& attempted);

/// Returns the patches by their roles. \param mesh is a half model if it has a plane of symmetry
CasePatches find_case_patches(const HybridMesh& mesh, const CaseOptions& options, CaseProblems& problems);

/// Returns true if the patch is one of two periodic sides.
bool is_periodic(const HybridMesh& mesh, PatchId patch);
/// A disc has two sides: <name>, which is upstream (the front), and <name>.back. These functions return the side opposite to the front, and the side opposite
/// to the back; nothing if the patch is not that side.
std::optional<PatchId> back_of_disc(const HybridMesh& mesh, const CasePatches& case_patches, PatchId patch);
std::optional<PatchId> front_of_disc(const HybridMesh& mesh, const CasePatches& case_patches, PatchId patch);

/// Conditions by names of patches. Records which conditions are used.
class UsedBoundaries {
 public:
  explicit UsedBoundaries(const CaseBoundaries& boundaries) : boundaries_(boundaries) {}
  /// Returns the condition of the patch; an empty one if its name is not given.
  CaseBoundary of(const Patch& patch);
  /// Returns the pressure jump over an actuator disc, Pa. If it cannot be determined, returns nothing and adds a problem.
  std::optional<double> pressure_jump(const Patch& disc, double area, CaseProblems& problems);
  /// Adds a problem for every name that no patch has used, and for every value that has no meaning at its patch (such as a thrust at an inflow).
  void require_used(CaseProblems& problems) const;

 private:
  const CaseBoundaries& boundaries_;
  std::map<std::string, PatchKind> used_;
};

/// Return the values that the solver gets, in m^2 and m.
double reference_area(const CaseReference& reference, const CasePatches& case_patches);
double reference_length(const CaseReference& reference, const volmesh::FlowState& flow);
/// Returns the point with zeros in place of rounding errors.
Point moment_origin(const CaseReference& reference, const volmesh::FlowState& flow);

/// Returns a component of a vector of this length, with zero in place of a rounding error, so that files for human readers do not contain "-3.3e-16".
double clean_component(double x, double length);
/// Returns the unit normal into the fluid.
Vec3 inward_normal(const PatchFacts& facts);
std::string case_number(double x);

}  // namespace sterna::scripting

namespace sterna {

template <>
struct Schema<scripting::CaseOptions> {
  using O = scripting::CaseOptions;
  static constexpr std::string_view stage = "solver_case";
  static constexpr std::array fields = {
      Field<O>{.name = "alpha", .member = &O::alpha, .unit = Unit::radian, .min = -1.6, .max = 1.6, .help = "angle of attack, positive for flow from below"},
      Field<O>{.name = "beta", .member = &O::beta, .unit = Unit::radian, .min = -1.6, .max = 1.6, .help = "sideslip angle, positive for flow towards y > 0"},
      Field<O>{.name = "reference_area",
               .member = &O::reference_area,
               .min = 1e-12,
               .max = 1e9,
               .help = "reference area of the whole aircraft, m^2, also for half models",
               .automatic = "area of the wing of `reference`"},
      Field<O>{.name = "reference_length",
               .member = &O::reference_length,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "reference length of pitching moments",
               .automatic = "mean aerodynamic chord of `reference`, or the flow's length"},
      Field<O>{.name = "wing", .member = &O::wing, .help = "name of the wing of `reference`; empty: the largest"},
      Field<O>{.name = "half",
               .member = &O::half,
               .help = "half model: the solver uses half of the reference area; automatic: yes if one patch is a symmetry plane",
               .choices = "automatic yes no"},
      Field<O>{.name = "wall_temperature",
               .member = &O::wall_temperature,
               .unit = k_kelvin,
               .min = 50.0,
               .max = 5000.0,
               .help = "temperature of all walls",
               .automatic = "adiabatic walls"},
      Field<O>{.name = "monitor",
               .member = &O::monitor,
               .help = "patterns of names of patches whose forces are summed, separated by blanks; empty: all walls except those of tunnels"},
      Field<O>{.name = "iterations", .member = &O::iterations, .min = 1, .max = 100000000, .help = "largest number of iterations"},
  };
};

template <>
struct Schema<scripting::CaseBoundary> {
  using O = scripting::CaseBoundary;
  static constexpr std::string_view stage = "boundaries";
  static constexpr std::array fields = {
      Field<O>{.name = "pressure",
               .member = &O::pressure,
               .min = 1e-6,
               .max = 1e10,
               .help = "static pressure of an outflow, Pa",
               .automatic = "from the flow conditions, in tunnels"},
      Field<O>{.name = "total_pressure",
               .member = &O::total_pressure,
               .min = 1e-6,
               .max = 1e10,
               .help = "total pressure of an inflow, Pa",
               .automatic = "from the flow conditions, in tunnels"},
      Field<O>{.name = "total_temperature",
               .member = &O::total_temperature,
               .unit = k_kelvin,
               .min = 1.0,
               .max = 1e4,
               .help = "total temperature of an inflow",
               .automatic = "from the flow conditions, in tunnels"},
      Field<O>{.name = "thrust",
               .member = &O::thrust,
               .min = -1e9,
               .max = 1e9,
               .help = "thrust of an actuator disc, N; the pressure jump is thrust over area",
               .automatic = "not given"},
      Field<O>{.name = "pressure_jump",
               .member = &O::pressure_jump,
               .min = -1e9,
               .max = 1e9,
               .help = "pressure jump over an actuator disc, Pa",
               .automatic = "thrust over area"},
      Field<O>{.name = "temperature_jump",
               .member = &O::temperature_jump,
               .unit = k_kelvin,
               .min = -1e4,
               .max = 1e4,
               .help = "jump of the total temperature over an actuator disc"},
  };
};

}  // namespace sterna
