// Keys, formats and units as SU2's config_template.cfg (version 8) has them. Steps of su2_config: what each patch is (area, normal, neighbours); markers of
// every kind; flow and reference values; text.
#include "scripting/verbs/su2_config.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <sstream>

#include <fmt/format.h>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/math/constants.h"
#include "io/names/patch_names.h"
#include "volmesh/flow/standard_atmosphere.h"

namespace sterna::scripting {
namespace {

using volmesh::FlowState;

constexpr double k_flat = 1e-9;  ///< rad: smaller angles are zero

struct PatchFacts {
  std::size_t n_faces = 0;
  Vec3 area;          ///< m^2, sum of the faces' normals, out of the fluid
  double size = 0.0;  ///< m^2
};

Column<PatchId, PatchFacts> facts_of(const HybridMesh& mesh) {
  Column<PatchId, PatchFacts> facts(mesh.patches.size());
  const auto add = [&](PatchId patch, const Vec3& area) {
    ++facts[patch].n_faces;
    facts[patch].area = facts[patch].area + area;
    facts[patch].size += norm(area);
  };
  for (const BoundaryTriangle& f : mesh.boundary_triangles) {
    const Point &a = mesh.points[f.nodes[0]], &b = mesh.points[f.nodes[1]], &c = mesh.points[f.nodes[2]];
    add(f.patch, 0.5 * cross(b - a, c - a));
  }
  for (const BoundaryQuad& f : mesh.boundary_quads) {
    const Point &a = mesh.points[f.nodes[0]], &b = mesh.points[f.nodes[1]], &c = mesh.points[f.nodes[2]], &d = mesh.points[f.nodes[3]];
    add(f.patch, 0.5 * cross(c - a, d - b));
  }
  return facts;
}

/// Patches with a node on an inflow or outflow.
std::set<PatchId> beside_openings(const HybridMesh& mesh) {
  const auto is_opening = [&](PatchId p) { return mesh.patches[p].kind == PatchKind::inflow || mesh.patches[p].kind == PatchKind::outflow; };
  std::vector<std::uint8_t> is_on(mesh.points.size(), 0);
  const auto for_each_face = [&](const auto& f) {
    for (const BoundaryTriangle& face : mesh.boundary_triangles) f(face.patch, std::span<const NodeId>(face.nodes));
    for (const BoundaryQuad& face : mesh.boundary_quads) f(face.patch, std::span<const NodeId>(face.nodes));
  };
  for_each_face([&](PatchId patch, std::span<const NodeId> nodes) {
    if (is_opening(patch))
      for (const NodeId node : nodes) is_on[node.index()] = 1;
  });
  std::set<PatchId> result;
  for_each_face([&](PatchId patch, std::span<const NodeId> nodes) {
    if (!is_opening(patch) && std::ranges::any_of(nodes, [&](NodeId node) { return is_on[node.index()] != 0; })) result.insert(patch);
  });
  return result;
}

std::string list(const std::vector<std::string>& entries) {
  if (entries.empty()) return "( NONE )";
  std::string text;
  for (const std::string& entry : entries) text += (text.empty() ? "( " : ", ") + entry;
  return text + " )";
}

/// A component of a vector of this length: what rounding has left of a zero is one, so no "-3.3e-16" stands in a file that people read.
double component(double x, double length) {
  constexpr double k_rounding = 1e-14;
  return std::abs(x) <= k_rounding * length ? 0.0 : x;
}

std::string number(double x) { return fmt::format("{:.10g}", std::abs(x) < 1e-300 ? 0.0 : x); }

class Configuration {
 public:
  Configuration(const HybridMesh& mesh, const Su2Options& options, const FlowState& flow, const Su2Reference& reference,
                const std::map<std::string, Su2Boundary>& boundaries, const RunContext& context)
      : mesh_(mesh),
        options_(options),
        flow_(flow),
        reference_(reference),
        boundaries_(boundaries),
        context_(context),
        facts_(facts_of(mesh)),
        names_(io::su2_marker_names(mesh.patches, RunContext())) {
    is_viscous_ = options.solver == "automatic" ? mesh.layers.n_columns() > 0 || !mesh.prisms.empty() : options.solver != "EULER";
    solver_ = options.solver != "automatic" ? options.solver : is_viscous_ ? "RANS" : "EULER";
    for (const PatchId p : mesh.patches.ids()) {
      if (facts_[p].n_faces == 0) continue;
      has_farfield_ = has_farfield_ || mesh.patches[p].kind == PatchKind::farfield;
      has_opening_ = has_opening_ || mesh.patches[p].kind == PatchKind::inflow || mesh.patches[p].kind == PatchKind::outflow;
      n_symmetry_ += mesh.patches[p].kind == PatchKind::symmetry && !is_periodic(p) ? 1 : 0;
    }
    is_tunnel_ = has_opening_ && !has_farfield_;
  }

  std::string text() {
    find_half();
    sort_patches();
    add_periodic();
    require_flow();
    require_reference();
    require_used_boundaries();
    if (!problems_.empty()) throw Error({.code = ErrorCode::bad_argument, .attempted = "making a configuration of SU2", .problem = problems_});
    tell();
    return head() + physics() + reference_values() + markers() + numerics() + files();
  }

 private:
  void add_problem(const std::string& text) { problems_ += (problems_.empty() ? "" : "; ") + text; }

  bool is_periodic(PatchId p) const {
    return std::ranges::any_of(mesh_.periodic, [&](const PeriodicSides& sides) { return sides.first == p || sides.second == p; });
  }

  /// What the patches of a pair are of themselves does not count: the flow goes out of one and comes in through the other. SU2 takes the centre and angles of a
  /// rotation, none here.
  void add_periodic() {
    for (const PeriodicSides& sides : mesh_.periodic)
      periodic_.push_back(fmt::format("{}, {}, 0, 0, 0, 0, 0, 0, {}, {}, {}", names_[sides.first.index()], names_[sides.second.index()],
                                      number(sides.translation.x), number(sides.translation.y), number(sides.translation.z)));
  }

  void find_half() {
    is_half_ = options_.half == "yes" || (options_.half == "automatic" && n_symmetry_ > 0);
    if (options_.half == "automatic" && n_symmetry_ > 1)
      add_problem(
          fmt::format("the mesh has {} symmetry planes: is it a half model? give half = \"yes\" or \"no\", and the reference area accordingly", n_symmetry_));
    if (is_half_ && std::abs(options_.beta) > k_flat) add_problem("a half model has no sideslip (beta)");
    if (is_tunnel_ && (std::abs(options_.alpha) > k_flat || std::abs(options_.beta) > k_flat))
      add_problem("in a tunnel the model is turned, not the flow: leave alpha and beta out");
  }

  const Su2Boundary* boundary_of(PatchId patch) {
    const auto found = boundaries_.find(mesh_.patches[patch].name);
    if (found == boundaries_.end()) return nullptr;
    used_.insert(found->first);
    return &found->second;
  }

  void sort_patches() {
    const std::set<PatchId> of_tunnel = is_tunnel_ ? beside_openings(mesh_) : std::set<PatchId>{};
    std::vector<std::string> patterns;
    std::istringstream words(options_.monitor);
    for (std::string word; words >> word;) patterns.push_back(word);
    for (const PatchId p : mesh_.patches.ids()) {
      if (facts_[p].n_faces == 0 || is_periodic(p)) continue;
      const std::string& name = names_[p.index()];
      switch (mesh_.patches[p].kind) {
        case PatchKind::wall:
          (is_viscous_ ? walls_ : euler_).push_back(name);
          if (patterns.empty() && of_tunnel.contains(p)) unmonitored_.push_back(name);
          else if (patterns.empty()) monitored_.push_back(name);
          break;
        case PatchKind::slip: euler_.push_back(name); break;
        case PatchKind::symmetry: symmetry_.push_back(name); break;
        case PatchKind::farfield: farfield_.push_back(name); break;
        case PatchKind::inflow: add_inflow(p, name); break;
        case PatchKind::outflow: add_outflow(p, name); break;
        case PatchKind::interface: add_disc(p, name); break;
      }
      if (std::ranges::any_of(patterns, [&](const std::string& pattern) { return matches_glob(mesh_.patches[p].name, pattern); })) monitored_.push_back(name);
    }
    if (monitored_.empty())
      add_problem(patterns.empty() ? "no wall is left whose forces count: name some with monitor"
                                   : "no patch has a name like \"" + options_.monitor + "\" (monitor)");
  }

  Point moment_origin() const {
    const Point& o = reference_.moment_origin;
    return {component(o.x, length()), component(o.y, length()), component(o.z, length())};
  }
  double heat(double power) const { return std::pow(1.0 + 0.5 * (volmesh::k_heat_ratio - 1.0) * flow_.mach * flow_.mach, power); }

  void add_inflow(PatchId p, const std::string& name) {
    const Su2Boundary given = boundary_of(p) ? *boundary_of(p) : Su2Boundary{};
    const Vec3 inward = -1.0 * normalized(facts_[p].area);
    const Vec3 along{component(inward.x, 1.0), component(inward.y, 1.0), component(inward.z, 1.0)};
    if (is_tunnel_ && flow_.mach >= 1.0) {
      supersonic_inlets_.push_back(fmt::format("{}, {}, {}, {}, {}, {}", name, number(flow_.temperature), number(flow_.pressure), number(flow_.speed * along.x),
                                               number(flow_.speed * along.y), number(flow_.speed * along.z)));
      return;
    }
    double pressure = given.total_pressure, temperature = given.total_temperature;
    if (is_tunnel_ && is_automatic(pressure)) pressure = flow_.pressure * heat(volmesh::k_heat_ratio / (volmesh::k_heat_ratio - 1.0));
    if (is_tunnel_ && is_automatic(temperature)) temperature = flow_.temperature * heat(1.0);
    if (is_automatic(pressure) || is_automatic(temperature)) {
      add_problem("what comes out of the inflow \"" + mesh_.patches[p].name + "\" cannot be known: give boundaries = { [\"" + mesh_.patches[p].name +
                  "\"] = { total_pressure = ..., total_temperature = ... } }" + (is_tunnel_ ? ", or a flow with temperature and pressure" : ""));
      return;
    }
    inlets_.push_back(fmt::format("{}, {}, {}, {}, {}, {}", name, number(temperature), number(pressure), number(along.x), number(along.y), number(along.z)));
  }

  void add_outflow(PatchId p, const std::string& name) {
    const Su2Boundary given = boundary_of(p) ? *boundary_of(p) : Su2Boundary{};
    if (is_tunnel_ && flow_.mach >= 1.0 && is_automatic(given.pressure)) {
      supersonic_outlets_.push_back(name);
      return;
    }
    const double pressure = is_tunnel_ && is_automatic(given.pressure) ? flow_.pressure : given.pressure;
    if (is_automatic(pressure)) {
      add_problem("what goes into the outflow \"" + mesh_.patches[p].name + "\" cannot be known: give boundaries = { [\"" + mesh_.patches[p].name +
                  "\"] = { pressure = ... } }" + (is_tunnel_ ? ", or a flow with temperature and pressure" : ""));
      return;
    }
    outlets_.push_back(name + ", " + number(pressure));
  }

  /// A disc has two sides: <name> upstream and <name>.back.
  void add_disc(PatchId p, const std::string& name) {
    const std::string& own = mesh_.patches[p].name;
    for (const PatchId other : mesh_.patches.ids())
      if (mesh_.patches[other].kind == PatchKind::interface && facts_[other].n_faces > 0 && own == mesh_.patches[other].name + ".back")
        return;  // told with its front
    for (const PatchId back : mesh_.patches.ids()) {
      if (facts_[back].n_faces == 0 || mesh_.patches[back].name != own + ".back") continue;
      const Su2Boundary* given = boundary_of(p);
      if (!given || (is_automatic(given->thrust) && is_automatic(given->pressure_jump))) {
        add_problem("what the actuator disc \"" + own + "\" does cannot be known: give boundaries = { [\"" + own +
                    "\"] = { thrust = ... } } (N), or pressure_jump (Pa)");
        return;
      }
      const double jump = is_automatic(given->pressure_jump) ? given->thrust / facts_[p].size : given->pressure_jump;
      discs_.push_back(fmt::format("{0}, {1}, {2}, {3}, 0, {2}, {3}, 0", name, names_[back.index()], number(jump), number(given->temperature_jump)));
      return;
    }
    add_problem("patch \"" + own + "\" is of kind interface and no actuator disc: its condition cannot be known");
  }

  void require_flow() {
    if (is_automatic(flow_.mach)) add_problem("the Mach number cannot be known: give mach, or speed with the temperature of the air");
    if (is_viscous_ && is_automatic(flow_.temperature)) add_problem("the temperature cannot be known: give altitude or temperature");
  }

  void require_reference() {
    if (is_automatic(reference_.area))
      add_problem("the reference area cannot be known: give reference_area (of the whole aircraft), or reference = the aircraft or its wing");
  }

  void require_used_boundaries() {
    for (const auto& [name, boundary] : boundaries_)
      if (!used_.contains(name)) add_problem("boundaries: no inflow, outflow or actuator disc of the mesh is called \"" + name + "\"");
  }

  double area() const { return is_half_ ? 0.5 * reference_.area : reference_.area; }
  double length() const { return is_automatic(reference_.length) ? flow_.length : reference_.length; }

  void tell() {
    context_.info(fmt::format("SU2: {}, {} walls, reference area {:.6g} m^2{}{}, length {:.6g} m, moments about ({:.6g}, {:.6g}, {:.6g}) m", solver_,
                              walls_.size() + (is_viscous_ ? 0 : euler_.size()), area(),
                              is_half_ ? fmt::format(" (half of {:.6g}: half model)", reference_.area) : "",
                              reference_.source.empty() ? "" : " of " + reference_.source, length(), moment_origin().x, moment_origin().y, moment_origin().z));
    if (!unmonitored_.empty()) context_.info("SU2: walls of the tunnel, whose forces do not count: " + list(unmonitored_));
  }

  static std::string title(const std::string& text) { return "\n% ---- " + text + "\n"; }

  std::string head() const { return "% SU2 configuration by sterna " STERNA_VERSION "\n% Flow: " + describe(flow_) + "\n"; }

  std::string physics() const {
    std::string text = title("Problem") + "SOLVER= " + solver_ + "\n";
    if (solver_ == "RANS") text += "KIND_TURB_MODEL= " + options_.turbulence + "\n";
    text += "MATH_PROBLEM= DIRECT\nRESTART_SOL= NO\nSYSTEM_MEASUREMENTS= SI\n";
    text += title("Free stream") + "MACH_NUMBER= " + number(flow_.mach) + "\nAOA= " + number(options_.alpha * k_degrees) +
            "\nSIDESLIP_ANGLE= " + number(options_.beta * k_degrees) + "\n";
    const bool has_state = !is_automatic(flow_.pressure) && !is_automatic(flow_.temperature);
    if (is_viscous_ && !(is_tunnel_ && has_state)) {
      text += "INIT_OPTION= REYNOLDS\nFREESTREAM_TEMPERATURE= " + number(flow_.temperature) + "\n";
    } else if (has_state) {
      text += "INIT_OPTION= TD_CONDITIONS\nFREESTREAM_OPTION= TEMPERATURE_FS\nFREESTREAM_PRESSURE= " + number(flow_.pressure) +
              "\nFREESTREAM_TEMPERATURE= " + number(flow_.temperature) + "\n";
    }
    if (is_viscous_) text += "REYNOLDS_NUMBER= " + number(flow_.reynolds) + "\nREYNOLDS_LENGTH= " + number(flow_.length) + "\n";
    text += "FLUID_MODEL= STANDARD_AIR\n";
    if (is_viscous_) text += "VISCOSITY_MODEL= SUTHERLAND\n";
    return text;
  }

  std::string reference_values() const {
    const Point o = moment_origin();
    return title("Reference values" + (is_half_ ? " (half model: half the area of the aircraft)" : std::string())) + "REF_AREA= " + number(area()) +
           "\nREF_LENGTH= " + number(length()) + "\nREF_ORIGIN_MOMENT_X= " + number(o.x) + "\nREF_ORIGIN_MOMENT_Y= " + number(o.y) +
           "\nREF_ORIGIN_MOMENT_Z= " + number(o.z) + "\nREF_DIMENSIONALIZATION= DIMENSIONAL\n";
  }

  std::string markers() const {
    std::string text = title("Boundaries");
    std::vector<std::string> walls;
    for (const std::string& name : walls_) walls.push_back(name + ", " + (is_automatic(options_.wall_temperature) ? "0.0" : number(options_.wall_temperature)));
    const auto add = [&](const char* key, const std::vector<std::string>& entries) {
      if (!entries.empty()) text += std::string(key) + "= " + list(entries) + "\n";
    };
    add(is_automatic(options_.wall_temperature) ? "MARKER_HEATFLUX" : "MARKER_ISOTHERMAL", walls);
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
    add("MARKER_PLOTTING", monitored_);
    add("MARKER_MONITORING", monitored_);
    return text;
  }

  std::string numerics() const {
    std::string text = title("Numerics to start from") + "NUM_METHOD_GRAD= WEIGHTED_LEAST_SQUARES\nCFL_NUMBER= " + number(options_.cfl) +
                       "\nCFL_ADAPT= YES\nCFL_ADAPT_PARAM= ( 0.1, 1.2, " + number(std::min(options_.cfl, 10.0)) + ", 1e3 )\n" +
                       "CONV_NUM_METHOD_FLOW= ROE\nMUSCL_FLOW= YES\nSLOPE_LIMITER_FLOW= VENKATAKRISHNAN\nTIME_DISCRE_FLOW= EULER_IMPLICIT\n";
    if (solver_ == "RANS") text += "CONV_NUM_METHOD_TURB= SCALAR_UPWIND\nMUSCL_TURB= NO\nTIME_DISCRE_TURB= EULER_IMPLICIT\n";
    text += "LINEAR_SOLVER= FGMRES\nLINEAR_SOLVER_PREC= ILU\nLINEAR_SOLVER_ERROR= 1e-3\nLINEAR_SOLVER_ITER= 10\nMGLEVEL= 0\n";
    return text + "ITER= " + std::to_string(options_.iterations) + "\nCONV_FIELD= RMS_DENSITY\nCONV_RESIDUAL_MINVAL= -9\nCONV_STARTITER= 10\n";
  }

  std::string files() const {
    const bool is_cgns = options_.mesh.ends_with(".cgns");
    return title("Files") + "MESH_FILENAME= " + options_.mesh + "\nMESH_FORMAT= " + (is_cgns ? "CGNS" : "SU2") +
           "\nTABULAR_FORMAT= CSV\nCONV_FILENAME= history\nRESTART_FILENAME= restart_flow\nVOLUME_FILENAME= flow\nSURFACE_FILENAME= "
           "surface_flow\nOUTPUT_FILES= ( RESTART, PARAVIEW, SURFACE_PARAVIEW )\n" +
           "SCREEN_OUTPUT= ( INNER_ITER, RMS_DENSITY, LIFT, DRAG )\nHISTORY_OUTPUT= ( ITER, RMS_RES, AERO_COEFF )\n";
  }

  const HybridMesh& mesh_;
  const Su2Options& options_;
  const FlowState& flow_;
  const Su2Reference& reference_;
  const std::map<std::string, Su2Boundary>& boundaries_;
  const RunContext& context_;
  Column<PatchId, PatchFacts> facts_;
  std::vector<std::string> names_;  ///< of markers, by patch
  std::string solver_, problems_;
  bool is_viscous_ = false, has_farfield_ = false, has_opening_ = false, is_tunnel_ = false, is_half_ = false;
  int n_symmetry_ = 0;
  std::set<std::string> used_;
  std::vector<std::string> walls_, euler_, symmetry_, farfield_, inlets_, outlets_, supersonic_inlets_, supersonic_outlets_, discs_, periodic_, monitored_,
      unmonitored_;
};

}  // namespace

std::string su2_config(const HybridMesh& mesh, const Su2Options& options, const FlowState& flow, const Su2Reference& reference,
                       const std::map<std::string, Su2Boundary>& boundaries, const RunContext& context) {
  return Configuration(mesh, options, flow, reference, boundaries, context).text();
}

}  // namespace sterna::scripting
