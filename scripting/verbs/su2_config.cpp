// Keys, formats and units are those of SU2's config_template.cfg (version 8). Steps of su2_config: compute the data of each patch (area, normal, neighbours);
// write the markers of every kind; write flow and reference values.
#include "scripting/verbs/su2_config.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "geom/math/constants.h"
#include "io/names/patch_names.h"
#include "volmesh/flow/boundary_layer.h"
#include "volmesh/flow/standard_atmosphere.h"

namespace sterna::scripting {
namespace {

using volmesh::FlowState;

/// Parameters of SU2's iteration to the steady state. For RANS and upwind schemes, SU2's documentation calls a CFL number below 20 low and above 100 high, and
/// ten iterations of the linear solver enough on a sound mesh. Faces of control volumes that are nearly parallel to their edges make the matrix less diagonally
/// dominant, so lower CFL numbers are combined with more iterations there. The two limits are those of the gate (G5). No run has tested them, since SU2 is not
/// in Debian.
struct March {
  double cfl, largest_cfl;
  int linear_iterations;
};
constexpr March k_usual_march{.cfl = 10.0, .largest_cfl = 1000.0, .linear_iterations = 10};
constexpr March k_careful_march{.cfl = 5.0, .largest_cfl = 100.0, .linear_iterations = 15};
constexpr March k_slow_march{.cfl = 1.0, .largest_cfl = 20.0, .linear_iterations = 20};
constexpr int k_force_window = 200;            ///< iterations
constexpr double k_force_change = 0.002;       ///< largest change of lift and drag within the window
constexpr double k_no_angle = 0.1 * k_degree;  ///< angle of attack: lift may be zero below it

std::string list(const std::vector<std::string>& entries) {
  if (entries.empty()) return "( NONE )";
  std::string text;
  for (const std::string& entry : entries) text += (text.empty() ? "( " : ", ") + entry;
  return text + " )";
}

class Configuration {
 public:
  Configuration(const HybridMesh& mesh, const Su2Options& options, const CaseOptions& common, const FlowState& flow, const CaseReference& reference,
                const CaseBoundaries& boundaries, const CaseMeasure& orthogonality, const RunContext& context)
      : mesh_(mesh),
        options_(options),
        common_(common),
        flow_(flow),
        reference_(reference),
        boundaries_(boundaries),
        orthogonality_(orthogonality),
        context_(context),
        case_patches_(find_case_patches(mesh, common, problems_)),
        names_(io::su2_marker_names(mesh.patches, RunContext())) {
    is_viscous_ = options.solver == "automatic" ? case_patches_.has_layers : options.solver != "EULER";
    solver_ = options.solver != "automatic" ? options.solver : is_viscous_ ? "RANS" : "EULER";
  }

  std::string text() {
    sort_patches();
    add_periodic();
    require_su2_flow(flow_, is_viscous_, problems_);
    if (is_automatic(reference_.area) && !case_patches_.is_tunnel)
      problems_.add("the reference area is unknown: give reference_area (of the whole aircraft), or reference = the aircraft or its wing");
    boundaries_.require_used(problems_);
    problems_.require_none("making a configuration of SU2");
    choose_wall_functions();
    report();
    return head() + physics() + reference_values() + markers() + numerics() + files();
  }

 private:
  void choose_wall_functions() {
    if (solver_ != "RANS") return;
    constexpr double k_least_y_plus = 20.0;
    double y_plus = 0.0;
    const double reynolds = flow_.reynolds;
    if (mesh_.request.is_known() && reynolds >= volmesh::k_least_reynolds && reynolds <= volmesh::k_largest_reynolds)
      y_plus = mesh_.request.first_height / volmesh::first_height({.y_plus = 1.0}, flow_).height;
    has_wall_functions_ = options_.wall_functions == "automatic" ? y_plus > k_least_y_plus : options_.wall_functions == "yes";
    if (has_wall_functions_ && y_plus > 0.0)
      context_.info(fmt::format("SU2: wall functions are used, because the first height corresponds to y+ {:.3g}", y_plus));
  }

  /// Adds the periodic pairs. The kinds of their patches are ignored: the flow leaves through one patch and enters through the other. SU2 also expects centre
  /// and angles of a rotation, which are zero here.
  void add_periodic() {
    for (const PeriodicSides& sides : mesh_.periodic)
      periodic_.push_back(fmt::format("{}, {}, 0, 0, 0, 0, 0, 0, {}, {}, {}", names_[sides.first.index()], names_[sides.second.index()],
                                      case_number(sides.translation.x), case_number(sides.translation.y), case_number(sides.translation.z)));
  }

  void sort_patches() {
    for (const PatchId p : mesh_.patches.ids()) {
      if (case_patches_.facts[p].n_faces == 0 || is_periodic(mesh_, p)) continue;
      const std::string& name = names_[p.index()];
      switch (mesh_.patches[p].kind) {
        case PatchKind::wall: (is_viscous_ ? walls_ : euler_).push_back(name); break;
        case PatchKind::slip: euler_.push_back(name); break;
        case PatchKind::symmetry: symmetry_.push_back(name); break;
        case PatchKind::farfield: farfield_.push_back(name); break;
        case PatchKind::inflow: add_inflow(p, name); break;
        case PatchKind::outflow: add_outflow(p, name); break;
        case PatchKind::interface: add_disc(p, name); break;
      }
    }
    for (const PatchId p : case_patches_.monitored) monitored_.push_back(names_[p.index()]);
    for (const PatchId p : case_patches_.unmonitored) unmonitored_.push_back(names_[p.index()]);
  }

  double heat(double power) const { return std::pow(1.0 + 0.5 * (volmesh::k_heat_ratio - 1.0) * flow_.mach * flow_.mach, power); }

  void add_inflow(PatchId p, const std::string& name) {
    const CaseBoundary given = boundaries_.of(mesh_.patches[p]);
    const Vec3 along = inward_normal(case_patches_.facts[p]);
    if (case_patches_.is_tunnel && flow_.mach >= 1.0) {
      supersonic_inlets_.push_back(fmt::format("{}, {}, {}, {}, {}, {}", name, case_number(flow_.temperature), case_number(flow_.pressure),
                                               case_number(flow_.speed * along.x), case_number(flow_.speed * along.y), case_number(flow_.speed * along.z)));
      return;
    }
    double pressure = given.total_pressure, temperature = given.total_temperature;
    if (case_patches_.is_tunnel && is_automatic(pressure)) pressure = flow_.pressure * heat(volmesh::k_heat_ratio / (volmesh::k_heat_ratio - 1.0));
    if (case_patches_.is_tunnel && is_automatic(temperature)) temperature = flow_.temperature * heat(1.0);
    if (is_automatic(pressure) || is_automatic(temperature)) {
      problems_.add("the condition at the inflow \"" + mesh_.patches[p].name + "\" is unknown: give boundaries = { [\"" + mesh_.patches[p].name +
                    "\"] = { total_pressure = ..., total_temperature = ... } }" + (case_patches_.is_tunnel ? ", or a flow with temperature and pressure" : ""));
      return;
    }
    inlets_.push_back(fmt::format("{}, {}, {}, {}, {}, {}", name, case_number(temperature), case_number(pressure), case_number(along.x), case_number(along.y),
                                  case_number(along.z)));
  }

  void add_outflow(PatchId p, const std::string& name) {
    const CaseBoundary given = boundaries_.of(mesh_.patches[p]);
    if (case_patches_.is_tunnel && flow_.mach >= 1.0 && is_automatic(given.pressure)) {
      supersonic_outlets_.push_back(name);
      return;
    }
    const double pressure = case_patches_.is_tunnel && is_automatic(given.pressure) ? flow_.pressure : given.pressure;
    if (is_automatic(pressure)) {
      problems_.add("the condition at the outflow \"" + mesh_.patches[p].name + "\" is unknown: give boundaries = { [\"" + mesh_.patches[p].name +
                    "\"] = { pressure = ... } }" + (case_patches_.is_tunnel ? ", or a flow with temperature and pressure" : ""));
      return;
    }
    outlets_.push_back(name + ", " + case_number(pressure));
  }

  void add_disc(PatchId p, const std::string& name) {
    if (front_of_disc(mesh_, case_patches_, p)) return;  // the back of a disc is handled together with its front
    const std::optional<PatchId> back = back_of_disc(mesh_, case_patches_, p);
    if (!back) {
      problems_.add("patch \"" + mesh_.patches[p].name + "\" is of kind interface, but no side of an actuator disc: its boundary condition is unknown");
      return;
    }
    const double warmer = boundaries_.of(mesh_.patches[p]).temperature_jump;
    if (const auto jump = boundaries_.pressure_jump(mesh_.patches[p], case_patches_.facts[p].size, problems_))
      discs_.push_back(fmt::format("{0}, {1}, {2}, {3}, 0, {2}, {3}, 0", name, names_[back->index()], case_number(*jump), case_number(warmer)));
  }

  bool has_area() const { return !is_automatic(reference_.area); }
  double area() const { return has_area() ? reference_area(reference_, case_patches_) : 1.0; }
  double length() const { return reference_length(reference_, flow_); }
  Point origin() const { return moment_origin(reference_, flow_); }

  void report() {
    if (case_patches_.is_internal)
      context_.info(fmt::format("SU2: {}, internal flow from {} to {}: the history has mass flow, pressures and the pressure drop between these markers",
                                solver_, list(openings(case_patches_.inflows)), list(openings(case_patches_.outflows))));
    if (!has_area() && !case_patches_.is_internal)
      context_.warn("SU2: no reference area is given, so force coefficients refer to 1 m^2: give --reference-area");
    if (!is_viscous_ && !is_automatic(common_.wall_temperature)) context_.warn("SU2: wall_temperature has no effect: the solver is " + solver_);
    if (solver_ != "RANS" && (options_.turbulence != Su2Options{}.turbulence || options_.wall_functions == "yes"))
      context_.warn("SU2: turbulence and wall_functions have no effect: the solver is " + solver_);
    if (case_patches_.is_internal) return;
    context_.info(fmt::format("SU2: {}, {} walls, reference area {:.6g} m^2{}{}, length {:.6g} m, moments about ({:.6g}, {:.6g}, {:.6g}) m", solver_,
                              walls_.size() + (is_viscous_ ? 0 : euler_.size()), area(),
                              case_patches_.is_half ? fmt::format(" (half of {:.6g}: half model)", reference_.area) : "",
                              reference_.source.empty() ? "" : " of " + reference_.source, length(), origin().x, origin().y, origin().z));
    if (!unmonitored_.empty()) context_.info("SU2: walls of the tunnel, without forces: " + list(unmonitored_));
  }

  std::vector<std::string> openings(const std::vector<PatchId>& patches) const {
    std::vector<std::string> result;
    for (const PatchId p : patches) result.push_back(names_[p.index()]);
    return result;
  }

  static std::string title(const std::string& text) { return "\n% ---- " + text + "\n"; }

  std::string head() const { return "% SU2 configuration by sterna " STERNA_VERSION "\n% Flow: " + describe(flow_) + "\n"; }

  std::string physics() const {
    std::string text = title("Problem") + "SOLVER= " + solver_ + "\n";
    if (solver_ == "RANS") text += "KIND_TURB_MODEL= " + options_.turbulence + "\n";
    text += std::string("MATH_PROBLEM= DIRECT\nRESTART_SOL= ") + (options_.restart ? "YES" : "NO") + "\nSYSTEM_MEASUREMENTS= SI\n";
    text += title("Free stream") + "MACH_NUMBER= " + case_number(flow_.mach) + "\nAOA= " + case_number(common_.alpha * k_degrees) +
            "\nSIDESLIP_ANGLE= " + case_number(common_.beta * k_degrees) + "\n";
    const bool has_state = !is_automatic(flow_.pressure) && !is_automatic(flow_.temperature);
    if (is_viscous_ && !(case_patches_.is_tunnel && has_state)) {
      text += "INIT_OPTION= REYNOLDS\nFREESTREAM_TEMPERATURE= " + case_number(flow_.temperature) + "\n";
    } else if (has_state) {
      text += "INIT_OPTION= TD_CONDITIONS\nFREESTREAM_OPTION= TEMPERATURE_FS\nFREESTREAM_PRESSURE= " + case_number(flow_.pressure) +
              "\nFREESTREAM_TEMPERATURE= " + case_number(flow_.temperature) + "\n";
    }
    if (is_viscous_) text += "REYNOLDS_NUMBER= " + case_number(flow_.reynolds) + "\nREYNOLDS_LENGTH= " + case_number(flow_.length) + "\n";
    text += "FLUID_MODEL= STANDARD_AIR\n";
    if (is_viscous_) text += "VISCOSITY_MODEL= SUTHERLAND\n";
    return text;
  }

  std::string reference_values() const {
    const Point o = origin();
    const std::string note = !has_area()             ? " (no area is given: coefficients refer to 1 m^2)"
                             : case_patches_.is_half ? " (half model: half the area of the aircraft)"
                                                     : "";
    return title("Reference values" + note) + "REF_AREA= " + case_number(area()) + "\nREF_LENGTH= " + case_number(length()) +
           "\nREF_ORIGIN_MOMENT_X= " + case_number(o.x) + "\nREF_ORIGIN_MOMENT_Y= " + case_number(o.y) + "\nREF_ORIGIN_MOMENT_Z= " + case_number(o.z) +
           "\nREF_DIMENSIONALIZATION= DIMENSIONAL\n";
  }

  std::string markers() const {
    std::string text = title("Boundaries");
    std::vector<std::string> walls;
    for (const std::string& name : walls_)
      walls.push_back(name + ", " + (is_automatic(common_.wall_temperature) ? "0.0" : case_number(common_.wall_temperature)));
    const auto add = [&](const char* key, const std::vector<std::string>& entries) {
      if (!entries.empty()) text += std::string(key) + "= " + list(entries) + "\n";
    };
    add(is_automatic(common_.wall_temperature) ? "MARKER_HEATFLUX" : "MARKER_ISOTHERMAL", walls);
    std::vector<std::string> modelled;
    for (const std::string& name : walls_) modelled.push_back(name + ", STANDARD_WALL_FUNCTION");
    if (has_wall_functions_) add("MARKER_WALL_FUNCTIONS", modelled);
    add("MARKER_EULER", euler_);
    add("MARKER_SYM", symmetry_);
    add("MARKER_FAR", farfield_);
    if (!inlets_.empty()) text += "INLET_TYPE= TOTAL_CONDITIONS\n";
    add("MARKER_INLET", inlets_);
    add("MARKER_OUTLET", outlets_);
    add("MARKER_SUPERSONIC_INLET", supersonic_inlets_);
    add("MARKER_SUPERSONIC_OUTLET", supersonic_outlets_);
    add("MARKER_PERIODIC", periodic_);
    if (!discs_.empty()) text += "ACTDISK_TYPE= VARIABLES_JUMP\nACTDISK_JUMP= DIFFERENCE\n";
    add("MARKER_ACTDISK", discs_);
    add("MARKER_PLOTTING", case_patches_.is_internal ? unmonitored_ : monitored_);
    add("MARKER_MONITORING", monitored_);
    if (case_patches_.is_internal) text += "MARKER_MONITORING= ( NONE )\n";
    std::vector<std::string> analyzed = openings(case_patches_.inflows);
    for (const std::string& name : openings(case_patches_.outflows)) analyzed.push_back(name);
    if (case_patches_.is_tunnel) {
      add("MARKER_ANALYZE", analyzed);
      text += "MARKER_ANALYZE_AVERAGE= MASSFLUX\n";
    }
    return text;
  }

  std::string numerics() const {
    const GateLimits& limits = info_of(Measure::orthogonality).limits;
    const double worst = orthogonality_.worst;
    const March march = worst >= limits.target ? k_usual_march : worst >= limits.hard ? k_careful_march : k_slow_march;
    const double cfl = is_automatic(options_.cfl) ? march.cfl : options_.cfl;
    const std::string because =
        fmt::format("% The lowest orthogonality of a control volume (90 degrees: faces are normal to their edges) is {:.4g} degrees{}, {}.\n",
                    worst * k_degrees, at_location(orthogonality_),
                    worst >= limits.target ? fmt::format("above {:g}: usual CFL numbers", limits.target * k_degrees)
                                           : fmt::format("below {:g}: lower CFL numbers, and more iterations of the linear solver",
                                                         (worst >= limits.hard ? limits.target : limits.hard) * k_degrees));
    std::string text = title("Numerics") + because + "NUM_METHOD_GRAD= WEIGHTED_LEAST_SQUARES\nCFL_NUMBER= " + case_number(cfl) +
                       "\nCFL_ADAPT= YES\nCFL_ADAPT_PARAM= ( 0.1, 1.2, " + case_number(std::min(cfl, march.cfl)) + ", " +
                       case_number(std::max(cfl, march.largest_cfl)) + " )\n" +
                       "CONV_NUM_METHOD_FLOW= ROE\nMUSCL_FLOW= YES\nSLOPE_LIMITER_FLOW= VENKATAKRISHNAN\nTIME_DISCRE_FLOW= EULER_IMPLICIT\n";
    if (solver_ == "RANS") text += "CONV_NUM_METHOD_TURB= SCALAR_UPWIND\nMUSCL_TURB= NO\nTIME_DISCRE_TURB= EULER_IMPLICIT\n";
    text +=
        fmt::format("LINEAR_SOLVER= FGMRES\nLINEAR_SOLVER_PREC= ILU\nLINEAR_SOLVER_ERROR= 1e-3\nLINEAR_SOLVER_ITER= {}\nMGLEVEL= 0\n", march.linear_iterations);
    return text + "ITER= " + std::to_string(common_.iterations) + "\n" + end();
  }

  /// Returns the end criterion. For a force SU2 takes the mean change from one iteration to the next, divided by the force; with several forces all changes
  /// must be below the limit.
  std::string end() const {
    if (monitored_.empty()) return "CONV_FIELD= RMS_DENSITY\nCONV_RESIDUAL_MINVAL= -9\nCONV_STARTITER= 10\n";
    const bool has_lift = std::abs(common_.alpha) > k_no_angle;
    return fmt::format(
        "% The run ends when {} changed by less than {:g} % over {} iterations.\nCONV_FIELD= {}\nCONV_CAUCHY_ELEMS= {}\nCONV_CAUCHY_EPS= {:g}\n"
        "CONV_STARTITER= {}\n",
        has_lift ? "drag and lift have" : "drag has", 100.0 * k_force_change, k_force_window, has_lift ? "( DRAG, LIFT )" : "DRAG", k_force_window,
        k_force_change / k_force_window, k_force_window);
  }

  /// Returns the output of the pressure drop, which SU2 provides if there are at least two markers.
  std::string drop() const { return case_patches_.inflows.size() + case_patches_.outflows.size() > 1 ? ", SURFACE_PRESSURE_DROP" : ""; }

  std::string files() const {
    const bool is_cgns = options_.mesh.ends_with(".cgns");
    return title("Files") + "MESH_FILENAME= " + options_.mesh + "\nMESH_FORMAT= " + (is_cgns ? "CGNS" : "SU2") +
           "\nTABULAR_FORMAT= CSV\nCONV_FILENAME= history\nRESTART_FILENAME= restart_flow\nSOLUTION_FILENAME= restart_flow\nVOLUME_FILENAME= "
           "flow\nSURFACE_FILENAME= "
           "surface_flow\nOUTPUT_FILES= ( RESTART, PARAVIEW, SURFACE_PARAVIEW )\n" +
           (case_patches_.is_internal ? "SCREEN_OUTPUT= ( INNER_ITER, RMS_DENSITY, SURFACE_MASSFLOW, SURFACE_TOTAL_PRESSURE" + drop() + " )\n"
                                      : "SCREEN_OUTPUT= ( INNER_ITER, RMS_DENSITY, LIFT, DRAG )\n") +
           "HISTORY_OUTPUT= ( ITER, RMS_RES" + (case_patches_.is_internal ? "" : ", AERO_COEFF") + (case_patches_.is_tunnel ? ", FLOW_COEFF" : "") + " )\n";
  }

  const HybridMesh& mesh_;
  const Su2Options& options_;
  const CaseOptions& common_;
  const FlowState& flow_;
  const CaseReference& reference_;
  UsedBoundaries boundaries_;
  CaseMeasure orthogonality_;
  const RunContext& context_;
  CaseProblems problems_;
  CasePatches case_patches_;
  std::vector<std::string> names_;  ///< names of markers, by patch
  std::string solver_;
  bool is_viscous_ = false;
  bool has_wall_functions_ = false;
  std::vector<std::string> walls_, euler_, symmetry_, farfield_, inlets_, outlets_, supersonic_inlets_, supersonic_outlets_, discs_, periodic_, monitored_,
      unmonitored_;
};

}  // namespace

void require_su2_flow(const FlowState& flow, std::optional<bool> is_viscous, CaseProblems& problems) {
  if (is_automatic(flow.mach)) problems.add("the Mach number is unknown: give mach, or speed with the temperature of the air");
  if (is_viscous.value_or(false) && is_automatic(flow.temperature)) problems.add("the temperature is unknown: give altitude or temperature");
}

std::string su2_config(const HybridMesh& mesh, const Su2Options& options, const CaseOptions& common, const FlowState& flow, const CaseReference& reference,
                       const CaseBoundaries& boundaries, const RunContext& context, const CaseMeasure& orthogonality) {
  return Configuration(mesh, options, common, flow, reference, boundaries, orthogonality, context).text();
}

}  // namespace sterna::scripting
