// Steps of foam_case: what flows (flow_of), what is solved (physics), what turbulence comes with it (free_stream), then fields and settings as text.
#include "scripting/verbs/foam_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "geom/math/constants.h"
#include "io/volume/volume_foam.h"
#include "scripting/verbs/foam_setup.h"
#include "volmesh/flow/standard_atmosphere.h"

namespace sterna::scripting {
namespace {

constexpr double k_compressible_mach = 0.3;    ///< Mach number; below it density changes by less than 5 %
constexpr double k_supersonic_advice = 1.3;    ///< Mach number; above it a pressure-based steady solver may not converge because of strong shocks
constexpr double k_viscosity_ratio_sst = 1.0;  ///< viscosity ratio of the free stream; NASA's Turbulence Modeling Resource recommends 0.01 to 10
constexpr double k_chi_of_free_stream = 3.0;   ///< nuTilda over nu; Spalart and Rumsey (2007) recommend 3 to 5, so that boundary layers are turbulent from the
                                               ///< start
constexpr double k_full_correction = 70.0, k_half_correction = 80.0;  ///< degrees of non-orthogonality
constexpr double k_cv1 = 7.1;                                         ///< constant of Spalart and Allmaras: nut = nuTilda chi^3 / (chi^3 + cv1^3)

/// Returns nuTilda over nu for a ratio of viscosities. This is the root of chi^4 = ratio (chi^3 + cv1^3), found by Newton's method from above, where the
/// function is convex.
double chi_of_ratio(double ratio) {
  const double c = k_cv1 * k_cv1 * k_cv1;
  double chi = ratio + k_cv1 + std::sqrt(std::sqrt(ratio * c));
  for (int i = 0; i < 100; ++i) chi -= (chi * chi * chi * chi - ratio * (chi * chi * chi + c)) / (4.0 * chi * chi * chi - 3.0 * ratio * chi * chi);
  return chi;
}

bool is_compressible(const FoamOptions& options, const volmesh::FlowState& flow) {
  if (options.compressible != "automatic") return options.compressible == "yes";
  return !is_automatic(flow.mach) && flow.mach >= k_compressible_mach;
}

/// Completes the flow. If only the Reynolds number is known, any speed gives the same coefficients.
void complete_flow(FoamSetup& setup, const RunContext& context) {
  volmesh::FlowState& flow = setup.flow;
  if (is_automatic(flow.speed)) {
    flow.speed = 1.0;
    context.info("OpenFOAM: only the Reynolds number of the flow is given, so the speed is taken as 1 m/s; coefficients do not depend on the speed");
  }
  setup.is_density_known = !is_automatic(flow.density);
  setup.density = setup.is_density_known ? flow.density : 1.0;
  setup.nu = flow.speed * flow.length / flow.reynolds;
}

/// Chooses the correction of normal gradients, whose explicit part grows with the tangent of the angle between a face normal and the line through the centres
/// of its cells. The two limits are those commonly used with OpenFOAM. A run of an airliner with an angle of 89 degrees diverged with the full correction and
/// converged with the smallest one (docs/flow.md).
void choose_correction(FoamSetup& setup, const CaseMeasure& non_orthogonality) {
  const double degrees = non_orthogonality.worst * k_degrees;
  const std::string measured = fmt::format("The largest angle between a face normal and the line through the centres of its cells is {:.4g} degrees{}", degrees,
                                           at_location(non_orthogonality));
  if (degrees <= k_full_correction) {
    setup.correction_reason = fmt::format("{}: up to {:g} the full correction is applied.", measured, k_full_correction);
  } else if (degrees <= k_half_correction) {
    setup.correction = "limited corrected 0.5";
    setup.correction_reason = fmt::format("{}: above {:g} the correction is limited to the rest of the gradient.", measured, k_full_correction);
  } else {
    setup.correction = "limited corrected 0.33";
    setup.correction_reason = fmt::format("{}: above {:g} the correction is limited to half of the rest of the gradient.", measured, k_half_correction);
  }
  // Without a second solution for the pressure, a run of a half M6 wing became unstable after 150 iterations; it has faces above 80 degrees ahead of its
  // trailing edge.
  setup.n_correctors = degrees > k_full_correction || (setup.is_turbulent && !setup.is_compressible) ? 1 : 0;
}

void set_turbulence(FoamSetup& setup) {
  const double given = setup.options.viscosity_ratio;
  if (setup.model == "SpalartAllmaras") {
    setup.nu_tilda = setup.nu * (is_automatic(given) ? k_chi_of_free_stream : chi_of_ratio(given));
  } else if (setup.model == "kOmegaSST") {
    setup.k = 1.5 * std::pow(setup.options.turbulence_intensity * setup.flow.speed, 2);
    setup.omega = setup.k / (setup.nu * (is_automatic(given) ? k_viscosity_ratio_sst : given));
  }
}

/// Returns the direction of the flow: that of a tunnel's inflow, else the direction given by the angles. x points aft, z up.
Vec3 direction_of(const HybridMesh& mesh, const CasePatches& case_patches, const CaseOptions& common) {
  if (case_patches.is_tunnel)
    for (const PatchId p : mesh.patches.ids())
      if (mesh.patches[p].kind == PatchKind::inflow && case_patches.facts[p].n_faces > 0) return inward_normal(case_patches.facts[p]);
  const double a = common.alpha, b = common.beta;
  return {std::cos(a) * std::cos(b), clean_component(std::sin(b), 1.0), clean_component(std::sin(a) * std::cos(b), 1.0)};
}

void report(const FoamSetup& setup, const CasePatches& case_patches, const CaseReference& reference, const RunContext& context) {
  std::string text = fmt::format("OpenFOAM: {}, {}, forces of {} patches", setup.application, setup.model, setup.monitored.size());
  if (case_patches.is_internal) {
    text = fmt::format("OpenFOAM: {}, {}, internal flow: postProcessing has mean pressures and flow rates of the openings", setup.application, setup.model);
    if (setup.has_pressure_drop()) text += " and the pressure drop";
  } else if (is_automatic(setup.area)) {
    text += "; no reference area is given, so forces are in N, without coefficients";
  } else {
    text += fmt::format(", reference area {:.6g} m^2{}{}, length {:.6g} m, moments about ({:.6g}, {:.6g}, {:.6g}) m", setup.area,
                        case_patches.is_half ? fmt::format(" (half of {:.6g}: half model)", reference.area) : "",
                        reference.source.empty() ? "" : " of " + reference.source, setup.length, setup.moment_origin.x, setup.moment_origin.y,
                        setup.moment_origin.z);
  }
  context.info(text);
  if (!setup.is_density_known && !setup.is_compressible)
    context.info("OpenFOAM: the density of the flow is not given, so forces are reported for 1 kg/m^3; coefficients do not depend on the density");
  if (!is_automatic(setup.flow.mach) && setup.flow.mach > k_supersonic_advice)
    context.warn(fmt::format(
        "OpenFOAM: Mach {:.3g} is above {}: {} is pressure-based and may not converge with strong shocks; rhoCentralFoam is density-based and transient",
        setup.flow.mach, k_supersonic_advice, setup.application));
}

/// Warns about wall vertices where the layer has no height. Runs diverged beside such vertices in narrow crevices and gaps (docs/measurements/solvers.md).
void warn_of_collapsed_lines(const HybridMesh& mesh, const RunContext& context) {
  const std::vector<std::uint8_t>& is_collapsed = mesh.layers.is_collapsed;
  const auto n = std::ranges::count_if(is_collapsed, [](std::uint8_t value) { return value != 0; });
  if (n == 0) return;
  const auto first = static_cast<std::size_t>(std::ranges::find_if(is_collapsed, [](std::uint8_t value) { return value != 0; }) - is_collapsed.begin());
  const Point& location = mesh.points[NodeId(mesh.layers.first_node[first])];
  context.warn(
      fmt::format("OpenFOAM: the layer has no height at {} of the walls, the first at ({:.6g}, {:.6g}, {:.6g}): runs can diverge beside such vertices in "
                  "narrow crevices and gaps. Fill them with fill_crevices{{ wall, width = ... }} (docs/crevices.md), move the parts there apart or into each "
                  "other, or refine the wall there; the report of the mesh gives the reason at each vertex",
                  n == 1 ? std::string("a vertex") : fmt::format("{} vertices", n), location.x, location.y, location.z));
}

/// Warns about options that are given but have no effect in this case.
void report_without_effect(const FoamSetup& setup, const RunContext& context) {
  const FoamOptions &given = setup.options, usual;
  const auto warn = [&](bool is_given, const char* name, const std::string& why) {
    if (is_given) context.warn(std::string("OpenFOAM: ") + name + " has no effect: " + why);
  };
  warn(given.turbulence_intensity != usual.turbulence_intensity && setup.model != "kOmegaSST", "turbulence_intensity",
       "it applies to the model kOmegaSST, and the model is " + setup.model);
  warn(!is_automatic(given.viscosity_ratio) && !setup.is_turbulent, "viscosity_ratio", "the model " + setup.model + " has no turbulence");
  warn(!is_automatic(given.end_time) && given.steady, "end_time", "the run is steady and ends after `iterations`");
  warn(given.courant != usual.courant && given.steady, "courant", "the run is steady");
  warn(!is_automatic(given.residual) && !given.steady, "residual", "the run is transient and ends at end_time");
  warn(setup.common.iterations != CaseOptions{}.iterations && !given.steady, "iterations", "the run is transient and ends at end_time");
  warn(!is_automatic(setup.common.wall_temperature) && !setup.is_compressible, "wall_temperature", "the flow is incompressible and has no temperature");
}

}  // namespace

void require_foam_flow(const FoamOptions& options, const volmesh::FlowState& flow, CaseProblems& problems) {
  if (!is_compressible(options, flow)) return;
  if (is_automatic(flow.temperature) || is_automatic(flow.pressure) || is_automatic(flow.speed))
    problems.add(
        std::string("the state of the gas is unknown, but a compressible flow needs it: give altitude, or temperature and pressure, with mach or speed") +
        (options.compressible == "automatic" ? fmt::format(" (or compressible = \"no\"; the default is \"yes\" from Mach {} on)", k_compressible_mach) : ""));
}

FoamCase foam_case(const HybridMesh& mesh, const FoamOptions& options, const CaseOptions& common, const volmesh::FlowState& flow,
                   const CaseReference& reference, const CaseBoundaries& boundaries, const RunContext& context, const CaseMeasure& non_orthogonality) {
  CaseProblems problems;
  const CasePatches case_patches = find_case_patches(mesh, common, problems);
  FoamSetup setup{.options = options, .common = common, .flow = flow};
  setup.model = options.model != "automatic" ? options.model : case_patches.has_layers ? "SpalartAllmaras" : "euler";
  setup.is_viscous = setup.model != "euler";
  setup.is_turbulent = setup.is_viscous && setup.model != "laminar";
  setup.is_compressible = is_compressible(options, flow);
  setup.application = std::string(setup.is_compressible ? "rho" : "") +
                      (setup.is_compressible ? (options.steady ? "SimpleFoam" : "PimpleFoam") : (options.steady ? "simpleFoam" : "pimpleFoam"));
  require_foam_flow(options, flow, problems);
  complete_flow(setup, context);
  set_turbulence(setup);
  choose_correction(setup, non_orthogonality);
  setup.velocity = setup.flow.speed * direction_of(mesh, case_patches, common);
  setup.area = reference_area(reference, case_patches);
  setup.length = reference_length(reference, setup.flow);
  setup.moment_origin = moment_origin(reference, setup.flow);
  const std::vector<std::string> names = io::foam_patch_names(mesh.patches, RunContext());
  for (const PatchId p : case_patches.monitored) setup.monitored.push_back(names[p.index()]);
  if (case_patches.is_tunnel) {
    for (const PatchId p : case_patches.inflows) setup.inflows.push_back(names[p.index()]);
    for (const PatchId p : case_patches.outflows) setup.outflows.push_back(names[p.index()]);
  }

  if (!case_patches.is_internal && !setup.monitored.empty()) setup.settles_by = "forces/*/force*.dat";
  if (case_patches.is_internal && setup.has_pressure_drop())
    setup.settles_by = setup.pressure_drop(setup.inflows.front(), setup.outflows.front()) + "/*/fieldValueDelta*.dat";
  setup.has_fast_openings = case_patches.is_tunnel || !boundaries.empty();

  FoamCase result{.application = setup.application, .files = {}, .joined = {}};
  UsedBoundaries used(boundaries);
  result.files = foam_fields(mesh, case_patches, names, setup, used, result.joined, problems);
  used.require_used(problems);
  problems.require_none("making a case of OpenFOAM");
  for (CaseFile& file : foam_settings(setup)) result.files.push_back(std::move(file));
  report(setup, case_patches, reference, context);
  if (setup.is_viscous) warn_of_collapsed_lines(mesh, context);
  report_without_effect(setup, context);
  return result;
}

}  // namespace sterna::scripting
