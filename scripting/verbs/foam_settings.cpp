// Files in constant/ and system/, and Allrun, of a case of OpenFOAM. Each file gives the reason for every scheme beside it; the figures are in
// docs/measurements/solvers.md.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "io/volume/volume_foam.h"
#include "scripting/verbs/foam_run.h"
#include "scripting/verbs/foam_setup.h"
#include "volmesh/flow/standard_atmosphere.h"

namespace sterna::scripting {
namespace {

constexpr double k_prandtl = 0.72;          ///< Prandtl number of air
constexpr double k_euler_reynolds = 1e8;    ///< Reynolds number of cases without viscosity
constexpr double k_lengths_in_time = 20.0;  ///< default duration of a transient run, in reference lengths over the flow's speed
constexpr double k_first_step = 1e-3;       ///< first time step, in reference lengths over the flow's speed; later steps follow from the Courant number

constexpr std::string_view k_euler_comment =
    "// Inviscid flow: walls slip, and the viscosity is that of a Reynolds number of 1e8. It is far below the numerical viscosity of any mesh. Without it the "
    "momentum\n// equation of a cell through whose faces nothing flows has no coefficient, and the solver stops.\n";

std::string dictionary(std::string_view object, std::string_view location, const std::string& text) {
  return io::foam_header(object, "dictionary", location) + text;
}

std::string words(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& word : list) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Returns the factors of a number of tasks in three directions, as equal as possible, the largest first.
std::array<int, 3> split_tasks(int n) {
  std::array<int, 3> best = {n, 1, 1};
  for (int a = 1; a * a * a <= n; ++a) {
    if (n % a != 0) continue;
    for (int b = a; a * b * b <= n; ++b)
      if ((n / a) % b == 0) best = {n / a / b, b, a};
  }
  return best;
}

class FoamSettings {
 public:
  explicit FoamSettings(const FoamSetup& setup) : s_(setup), is_steady_(setup.options.steady) {}

  std::vector<CaseFile> files() const {
    std::vector<CaseFile> all;
    const auto add = [&](const std::string& folder, const std::string& name, const std::string& text) {
      all.push_back({.path = folder + "/" + name, .text = dictionary(name, folder, text)});
    };
    if (s_.is_compressible) add("constant", "thermophysicalProperties", gas());
    else
      add("constant", "transportProperties",
          "transportModel Newtonian;\n" + (s_.is_viscous ? std::string() : std::string(k_euler_comment)) + "nu " + case_number(viscosity()) + ";\n");
    add("constant", "turbulenceProperties", turbulence());
    add("system", "controlDict", control());
    add("system", "fvSchemes", schemes());
    add("system", "fvSolution", solution());
    if (s_.is_compressible) add("system", "fvOptions", temperature_limits() + (is_steady_ ? velocity_bound() : std::string()));
    add("system", "decomposeParDict", decomposition());
    for (CaseFile& file : foam_run_files(s_)) all.push_back(std::move(file));
    return all;
  }

 private:
  /// Returns the kinematic viscosity, m^2/s. Without any viscosity the momentum equation of a cell through whose faces nothing flows has no coefficient, e.g.
  /// of a tetrahedron with three faces on slip walls, and the solver stops with a division by zero in the first iteration.
  double viscosity() const { return s_.is_viscous ? s_.nu : s_.flow.speed * s_.length / k_euler_reynolds; }

  std::string turbulence() const {
    if (!s_.is_turbulent) return "simulationType laminar;\n";
    return "simulationType RAS;\nRAS\n{\n    RASModel " + s_.model + ";\n    turbulence on;\n    printCoeffs on;\n}\n";
  }

  std::string gas() const {
    const double mu = viscosity() * s_.density;
    // A viscosity given by the user is constant; that of air follows Sutherland's law.
    constexpr double k_same = 1e-3;
    const bool is_air = std::abs(mu - volmesh::viscosity_of_air(s_.flow.temperature)) <= k_same * mu;
    const bool is_sutherland = s_.is_viscous && is_air;
    return (s_.is_viscous ? std::string() : std::string(k_euler_comment)) +
           std::string("thermoType\n{\n    type hePsiThermo;\n    mixture pureMixture;\n    transport ") + (is_sutherland ? "sutherland" : "const") +
           ";\n    thermo hConst;\n    equationOfState perfectGas;\n    specie specie;\n    energy sensibleInternalEnergy;\n}\n\nmixture\n{\n    specie { "
           "molWeight 28.9644; }\n    thermodynamics { Cp " +
           case_number(k_heat_capacity) + "; Hf 0; }\n    transport { " + (is_sutherland ? "As 1.458e-06; Ts 110.4; Pr " : "mu " + case_number(mu) + "; Pr ") +
           case_number(k_prandtl) + "; }\n}\n";
  }

  std::string forces(const std::string& name, const std::string& type, const std::string& more) const {
    return "    " + name + "\n    {\n        type " + type +
           ";\n        libs (forces);\n        writeControl timeStep;\n        writeInterval 1;\n        log no;\n" + "        patches (" +
           words(s_.monitored) + ");\n        rho " + (s_.is_compressible ? "rho" : "rhoInf") + ";\n        rhoInf " + case_number(s_.density) +
           (s_.is_compressible ? ";\n        pRef " + case_number(s_.flow.pressure) : std::string()) + ";\n        CofR " + foam_vector(s_.moment_origin) +
           ";\n" + more + "    }\n";
  }

  /// Returns a function object that evaluates a field at an opening: mean pressure in Pa (in incompressible flow the solver's value times the density), or flow
  /// rate in kg/s or m^3/s.
  std::string at_opening(const std::string& patch, const std::string& operation, const std::string& field, const std::string& indent) const {
    const bool is_scaled = field == "p" && !s_.is_compressible && s_.is_density_known;
    return indent + "type surfaceFieldValue;\n" + indent + "libs (fieldFunctionObjects);\n" + indent + "writeControl timeStep;\n" + indent +
           "writeInterval 1;\n" + indent + "log no;\n" + indent + "writeFields no;\n" + indent + "regionType patch;\n" + indent + "name " + patch + ";\n" +
           indent + "operation " + operation + ";\n" + (is_scaled ? indent + "scaleFactor " + case_number(s_.density) + ";\n" : "") + indent + "fields (" +
           field + ");\n";
  }

  /// Returns the function objects of tunnels and ducts: mean pressure and flow rate of each opening, and the pressure drop from each inflow to each outflow.
  std::string openings() const {
    std::string text;
    const auto add = [&](const std::string& name, const std::string& content) { text += "    " + name + "\n    {\n" + content + "    }\n"; };
    for (const auto* patches : {&s_.inflows, &s_.outflows})
      for (const std::string& patch : *patches) {
        add("pressure_" + patch, at_opening(patch, "areaAverage", "p", "        "));
        add("flowRate_" + patch, at_opening(patch, "sum", "phi", "        "));
      }
    const auto region = [&](const char* name, const std::string& patch) {
      return std::string("        ") + name + "\n        {\n" + at_opening(patch, "areaAverage", "p", "            ") + "        }\n";
    };
    for (const std::string& in : s_.inflows)
      for (const std::string& out : s_.outflows)
        add(s_.pressure_drop(in, out),
            "        type fieldValueDelta;\n        libs (fieldFunctionObjects);\n        writeControl timeStep;\n        writeInterval 1;\n        log no;\n  "
            "      "
            "operation subtract;\n" +
                region("region1", in) + region("region2", out));
    return text;
  }

  std::string control() const {
    const double step = k_first_step * s_.flow.length / s_.flow.speed;
    const double end = is_automatic(s_.options.end_time) ? k_lengths_in_time * s_.flow.length / s_.flow.speed : s_.options.end_time;
    std::string text =
        "application " + s_.application + ";\nstartFrom latestTime;\nstartTime 0;\nstopAt endTime;\n" +
        (is_steady_ ? std::string("#include \"runControl\"  // endTime and writeInterval: Allrun runs in parts\ndeltaT 1")
                    : "endTime " + case_number(end) + ";\nwriteInterval " + std::to_string(s_.options.write_interval) + ";\ndeltaT " + case_number(step)) +
        ";\nwriteControl timeStep;\npurgeWrite 2;\nwriteFormat " + (s_.options.format == "binary" ? "binary" : "ascii") +
        ";\nwritePrecision 12;\ntimePrecision 12;\nrunTimeModifiable true;\n";
    if (!is_steady_) text += "adjustTimeStep yes;\nmaxCo " + case_number(s_.options.courant) + ";\n";
    text += "\nfunctions\n{\n";
    if (!s_.monitored.empty()) text += forces("forces", "forces", "");
    text += openings();
    if (!is_automatic(s_.area) && !s_.monitored.empty()) {
      const Vec3 drag = s_.drag_direction(), lift = s_.lift_direction();  // pitching moments are positive nose-up
      text += forces("forceCoeffs", "forceCoeffs",
                     "        dragDir " + foam_vector({clean_component(drag.x, 1.0), clean_component(drag.y, 1.0), clean_component(drag.z, 1.0)}) +
                         ";\n        liftDir " + foam_vector({clean_component(lift.x, 1.0), 0.0, clean_component(lift.z, 1.0)}) + ";\n        pitchAxis " +
                         foam_vector(s_.pitch_axis()) + ";\n        magUInf " + case_number(s_.flow.speed) + ";\n        lRef " + case_number(s_.length) +
                         ";\n        Aref " + case_number(s_.area) + ";\n");
    }
    if (s_.is_viscous)
      text +=
          "    yPlus\n    {\n        type yPlus;\n        libs (fieldFunctionObjects);\n        writeControl writeTime;\n    }\n    wallShearStress\n    {\n   "
          "     type "
          "wallShearStress;\n        libs (fieldFunctionObjects);\n        writeControl writeTime;\n    }\n";
    if (s_.is_compressible)
      text +=
          "    temperature\n    {\n        type fieldMinMax;\n        libs (fieldFunctionObjects);\n        mode magnitude;\n        fields (T);\n        "
          "writeControl "
          "timeStep;\n        writeInterval 1;\n        log no;\n    }\n";
    text += foam_watch_functions(s_);
    text += "    residuals\n    {\n        type solverInfo;\n        libs (utilityFunctionObjects);\n        fields (" + solved() + ");\n    }\n";
    return text + "}\n";
  }

  /// Returns the names of the fields that have an equation.
  std::string solved() const {
    std::string text = "p U";
    if (s_.is_compressible) text += " e";
    if (s_.model == "SpalartAllmaras") text += " nuTilda";
    if (s_.model == "kOmegaSST") text += " k omega";
    return text;
  }

  bool has_stages_of_shocks() const { return s_.is_transonic() && is_steady_; }

  std::string gradients() const {
    std::string text, scheme = "pointCellsLeastSquares", more;
    if (has_stages_of_shocks()) {
      scheme = "$gradients";
      more = " grad(U) $gradientOfU;";
    } else if (s_.is_transonic()) {
      text =
          "// Limited, so that no value at a face exceeds the values of the cells around: without the limiter the start from uniform flow diverges where "
          "shocks form.\n";
      scheme = "cellLimited pointCellsLeastSquares 1";
    }
    if (s_.is_turbulent || !s_.is_viscous) {
      text +=
          "// The pressure gradient is computed from values at faces, as in the pressure equation: by least squares the thin cells over a sharp trailing "
          "edge\n// become unstable, in gases within 30 iterations, otherwise after 100 to 200.\n";
      more += " grad(p) Gauss linear;";
    }
    return text + "gradSchemes { default " + scheme + ";" + more + " }\n\n";
  }

  std::string schemes() const {
    const std::string bounded = is_steady_ ? "bounded " : "";
    std::string text =
        std::string(is_steady_ ? "#include \"stage\"  // convection of the velocity and correction of normal gradients: first order at the start\n\n" : "") +
        std::string("ddtSchemes { default ") + (is_steady_ ? "steadyState" : "backward") + "; }\n\n" +
        "// Least squares over all cells that share a point. Gauss linear is not exact for linear fields on tetrahedra and on prisms over curved walls:\n"
        "// 3 % of the drag of a sphere; leastSquares, over neighbours by faces, has too few of them in a tetrahedron and diverges.\n" +
        gradients();
    text +=
        "// Second order upwind for the velocity. Component by component is best for laminar flow (along the steepest direction the drag of a coarse sphere is "
        "2.5 % high). Other flows are limited along the steepest direction, because otherwise a start from uniform flow diverges in gases and over sharp "
        "trailing edges. k and omega are limited: first order only where necessary. nuTilda is first order: with a limiter it falls below zero in tetrahedra "
        "at the edges of wakes and is reset there at every iteration.\ndivSchemes\n{\n    default none;\n    div(phi,U) " +
        (is_steady_ ? std::string("$convectionOfU") : s_.convection()) + ";\n";
    if (s_.is_compressible) {
      text += "    div(phi,e) " + bounded + "Gauss limitedLinear 1;\n    div(phi,Ekp) " + bounded + "Gauss limitedLinear 1;\n    div(phi,K) " + bounded +
              "Gauss limitedLinear 1;\n    div(phid,p) " + (has_stages_of_shocks() ? "$convectionOfPressure" : "Gauss upwind") +
              ";\n    div((phi|interpolate(rho)),p) " + bounded +
              "Gauss upwind;\n    div(phiv,p) Gauss limitedLinear 1;\n    div(((rho*nuEff)*dev2(T(grad(U))))) Gauss linear;\n";
    } else {
      text += "    div((nuEff*dev2(T(grad(U))))) Gauss linear;\n    div(div(phi,U)) Gauss linear;\n";
    }
    for (const char* const name : {"nuTilda", "k", "omega"})
      if (solved().find(name) != std::string::npos)
        text += std::string("    div(phi,") + name + ") " + bounded + (name == std::string_view("nuTilda") ? "Gauss upwind;\n" : "Gauss limitedLinear 1;\n");
    text += "}\n\n// " + s_.correction_reason + "\nlaplacianSchemes { default Gauss linear " + (is_steady_ ? "$correction" : s_.correction) +
            "; }\ninterpolationSchemes { default linear; }\nsnGradSchemes { default " + (is_steady_ ? "$correction" : s_.correction) + "; }\n";
    if (s_.is_turbulent) text += "wallDist { method meshWave; }\n";
    return text;
  }

  std::string solution() const {
    const std::string tolerance = case_number(s_.residual_limit() > 0.0 ? std::min(1e-8, 0.01 * s_.residual_limit()) : 1e-8);
    const std::string smooth = "{ solver smoothSolver; smoother symGaussSeidel; tolerance " + tolerance + "; relTol 0.1; maxIter 20; }\n";
    const std::string multigrid = "{ solver GAMG; smoother GaussSeidel; tolerance " + tolerance + "; relTol 0.05; }\n";
    const std::string krylov = "{ solver PBiCGStab; preconditioner DILU; tolerance " + tolerance + "; relTol 0.1; }\n";
    std::string text = "solvers\n{\n    p " + (s_.is_transonic() ? krylov : multigrid) +
                       "    Phi { solver GAMG; smoother DICGaussSeidel; tolerance 1e-07; relTol 0; }\n" + "    \"(U|e|nuTilda|k|omega)\" " +
                       (s_.is_compressible ? krylov : smooth);
    if (!is_steady_) {
      text += "    pFinal { $p; relTol 0; }\n    \"(U|e|nuTilda|k|omega)Final\" { $U; relTol 0; }\n";
      if (s_.is_compressible) text += "    \"rho.*\" { solver diagonal; }\n";
    }
    text +=
        "}\n\n// After each corrector the fluxes conserve mass to the tolerance of Phi.\npotentialFlow { nNonOrthogonalCorrectors 5; PhiRefCell 0; PhiRefValue "
        "0; }\n\n";
    const std::string limits =
        s_.is_compressible ? std::string("    pMinFactor 0.1;\n    pMaxFactor 2;\n    transonic ") + (s_.is_transonic() ? "yes" : "no") + ";\n" : "";
    const std::string reference = "    pRefCell 0;\n    pRefValue " + (s_.is_compressible ? case_number(s_.flow.pressure) : std::string("0")) + ";\n";
    if (!is_steady_)
      return text + "PIMPLE\n{\n    nOuterCorrectors 2;\n    nCorrectors 2;\n    nNonOrthogonalCorrectors 1;\n    consistent yes;\n" + limits + reference +
             "}\n";
    std::string controls;
    std::string fields = solved() + " ";
    for (std::size_t at = 0, end = fields.find(' '); end != std::string::npos; at = end + 1, end = fields.find(' ', at))
      controls += "        " + fields.substr(at, end - at) + " " + case_number(s_.residual_limit()) + ";\n";
    if (s_.is_damped()) text = "#include \"stage\"\n\n" + text;
    text += std::string("SIMPLE\n{\n    consistent ") + (s_.is_damped() ? "$consistentPressure" : "yes") + ";\n    nNonOrthogonalCorrectors " +
            std::to_string(s_.n_correctors) + ";\n" + limits + reference +
            (s_.residual_limit() > 0.0 ? "    residualControl\n    {\n" + controls + "    }\n" : "") + "}\n\n";
    if (s_.model == "SpalartAllmaras") text += "// At 0.7 for nuTilda, nuTilda and the velocity in the buffer layer oscillate without converging.\n";
    if (s_.is_damped()) return text + "relaxationFactors\n{\n    fields { p $relaxationOfP; }\n    equations { p 1; U $relaxationOfU; }\n}\n";
    return text + "relaxationFactors\n{\n    " + (s_.is_compressible ? "fields { p 1; rho 1; }\n    " : "") + "equations { p 1; U 0.8; " +
           (s_.is_compressible ? "e 0.8; " : "") + "nuTilda 0.4; \"(k|omega)\" 0.7; }\n}\n";
  }

  std::string temperature_limits() const {
    return "// The start from uniform flow gives single cells extreme values: below zero the viscosity of air has no value, and the solver aborts. Where the "
           "temperature ends at one of\n// these limits (postProcessing/temperature has the range of every step), do not trust the "
           "flow.\nlimit_temperature\n{\n    type limitTemperature;\n    active yes;\n    selectionMode all;\n    min " +
           case_number(0.3 * s_.lowest_temperature) + ";\n    max " + case_number(3.0 * s_.highest_temperature) + ";\n}\n";
  }

  std::string velocity_bound() const {
    return "\n// Bounds the velocity: without this bound the first iterations of a business jet at Mach 0.5 reached 19 km/s beside a wing tip and did not "
           "return. A run whose\n// largest velocity stays near the bound is stopped as diverged.\nlimit_velocity\n{\n    type limitVelocity;\n    active "
           "yes;\n    selectionMode all;\n    max " +
           case_number(foam_speed_bound(s_)) + ";\n}\n";
  }

  std::string decomposition() const {
    const auto n = split_tasks(s_.options.tasks);
    return "numberOfSubdomains " + std::to_string(s_.options.tasks) +
           ";\n// By coordinates, because not every OpenFOAM has scotch (Debian's does not). If scotch is available, \"method scotch;\" gives smaller "
           "interfaces.\nmethod hierarchical;\nhierarchicalCoeffs { n (" +
           std::to_string(n[0]) + " " + std::to_string(n[1]) + " " + std::to_string(n[2]) + "); order xyz; }\ncoeffs { n (" + std::to_string(n[0]) + " " +
           std::to_string(n[1]) + " " + std::to_string(n[2]) + "); order xyz; }\n";
  }

  const FoamSetup& s_;
  bool is_steady_;
};

}  // namespace

std::vector<CaseFile> foam_settings(const FoamSetup& setup) { return FoamSettings(setup).files(); }

}  // namespace sterna::scripting
