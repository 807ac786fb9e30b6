// The fields of a case of OpenFOAM. They give the conditions of velocity, pressure, temperature and turbulence that follow from the kind of each patch.
#include <cmath>

#include <fmt/format.h>

#include "io/volume/volume_foam.h"
#include "scripting/verbs/foam_setup.h"
#include "volmesh/flow/standard_atmosphere.h"

namespace sterna::scripting {
namespace {

/// Entries of a patch in the files of the fields.
struct PatchConditions {
  std::string velocity, pressure, temperature;
  std::string transported;  ///< conditions of nuTilda, k and omega at openings; "VALUE" is replaced by the value of the free stream
  std::string nu_tilda, k, omega, nut, alphat;
  std::string potential = "type zeroGradient;";
};

/// Returns the same entry for every field: for symmetry and cyclic patches.
PatchConditions constrained(const std::string& type) {
  const std::string entry = "type " + type + ";";
  return {entry, entry, entry, entry, entry, entry, entry, entry, entry, entry};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) text.replace(at, what.size(), by);
  return text;
}

class FoamFields {
 public:
  FoamFields(const HybridMesh& mesh, const CasePatches& case_patches, const std::vector<std::string>& names, const FoamSetup& setup, UsedBoundaries& boundaries,
             std::vector<PeriodicSides>& joined, CaseProblems& problems)
      : mesh_(mesh), case_patches_(case_patches), names_(names), setup_(setup), boundaries_(boundaries), joined_(joined), problems_(problems) {}

  std::vector<CaseFile> files() {
    std::vector<PatchConditions> all;
    std::vector<std::string> names;
    for (const PatchId p : mesh_.patches.ids()) {
      if (case_patches_.facts[p].n_faces == 0) continue;
      all.push_back(conditions(p));
      names.push_back(names_[p.index()]);
    }
    std::vector<CaseFile> result;
    const auto add = [&](const std::string& name, const std::string& type, const std::string& dimensions, const std::string& value, const auto& entry) {
      std::string text = io::foam_header(name, type, "0") + "dimensions [" + dimensions + "];\ninternalField uniform " + value + ";\n\nboundaryField\n{\n";
      for (std::size_t i = 0; i < all.size(); ++i)
        text += "    " + names[i] + "\n    {\n        " + replaced(replaced(entry(all[i]), "; ", ";\n        "), "VALUE", value) + "\n    }\n";
      result.push_back({.path = "0/" + name, .text = text + "}\n"});
    };
    // Phi has the conditions for potentialFoam. By default potentialFoam sets a potential of 0 on a farfield with a free stream, and the fluid stays at rest.
    add("Phi", "volScalarField", "0 2 -1 0 0 0 0", "0", [](const PatchConditions& c) { return c.potential; });
    const auto transported = [](const std::string& own, const PatchConditions& c) { return own.empty() ? c.transported : own; };
    add("U", "volVectorField", "0 1 -1 0 0 0 0", foam_vector(setup_.velocity), [](const PatchConditions& c) { return c.velocity; });
    add("p", "volScalarField", setup_.is_compressible ? "1 -1 -2 0 0 0 0" : "0 2 -2 0 0 0 0", free_pressure(),
        [](const PatchConditions& c) { return c.pressure; });
    if (setup_.is_compressible)
      add("T", "volScalarField", "0 0 0 1 0 0 0", case_number(setup_.flow.temperature), [](const PatchConditions& c) { return c.temperature; });
    if (setup_.model == "SpalartAllmaras")
      add("nuTilda", "volScalarField", "0 2 -1 0 0 0 0", case_number(setup_.nu_tilda), [&](const PatchConditions& c) { return transported(c.nu_tilda, c); });
    if (setup_.model == "kOmegaSST") {
      add("k", "volScalarField", "0 2 -2 0 0 0 0", case_number(setup_.k), [&](const PatchConditions& c) { return transported(c.k, c); });
      add("omega", "volScalarField", "0 0 -1 0 0 0 0", case_number(setup_.omega), [&](const PatchConditions& c) { return transported(c.omega, c); });
    }
    if (setup_.is_turbulent) add("nut", "volScalarField", "0 2 -1 0 0 0 0", "0", [](const PatchConditions& c) { return c.nut; });
    if (setup_.is_turbulent && setup_.is_compressible)
      add("alphat", "volScalarField", "1 -1 -1 0 0 0 0", "0", [](const PatchConditions& c) { return c.alphat; });
    return result;
  }

 private:
  std::string free_pressure() const { return setup_.is_compressible ? case_number(setup_.flow.pressure) : "0"; }
  bool is_supersonic() const { return setup_.is_compressible && setup_.flow.mach >= 1.0; }

  /// Returns a pressure in the form that the solver uses. In incompressible flow this is the difference from the pressure of the free stream, over the density.
  std::string pressure_of(double pressure, const std::string& what) {
    if (setup_.is_compressible) return case_number(pressure);
    if (is_automatic(setup_.flow.pressure) || !setup_.is_density_known) {
      problems_.add(what + " is given in Pa, but pressure and density of the flow are unknown: give altitude, or temperature and pressure");
      return "0";
    }
    return case_number((pressure - setup_.flow.pressure) / setup_.density);
  }

  PatchConditions conditions(PatchId p) {
    for (const PeriodicSides& sides : mesh_.periodic)
      if (sides.first == p || sides.second == p) return constrained("cyclic");
    switch (mesh_.patches[p].kind) {
      case PatchKind::wall: return setup_.is_viscous ? wall() : slip();
      case PatchKind::slip: return slip();
      case PatchKind::symmetry: return constrained(io::foam_patch_type(mesh_, p));
      case PatchKind::farfield: return farfield();
      case PatchKind::inflow: return inflow(p);
      case PatchKind::outflow: return outflow(p);
      case PatchKind::interface: return disc(p);
    }
    return slip();
  }

  static constexpr const char* k_calculated = "type calculated; value uniform 0;";

  /// Returns wall functions that have no effect where y+ is about 1, and that are valid where it is larger.
  PatchConditions wall() const {
    return {.velocity = "type noSlip;",
            .pressure = "type zeroGradient;",
            .temperature = is_automatic(setup_.common.wall_temperature) ? "type zeroGradient;"
                                                                        : "type fixedValue; value uniform " + case_number(setup_.common.wall_temperature) + ";",
            .transported = "type zeroGradient;",
            .nu_tilda = "type fixedValue; value uniform 0;",
            .k = "type kLowReWallFunction; value uniform VALUE;",
            .omega = "type omegaWallFunction; blended true; value uniform VALUE;",
            .nut = "type nutUSpaldingWallFunction; value uniform 0;",
            .alphat = "type compressible::alphatWallFunction; Prt 0.85; value uniform 0;"};
  }

  PatchConditions slip() const {
    return {.velocity = "type slip;",
            .pressure = "type zeroGradient;",
            .temperature = "type zeroGradient;",
            .transported = "type zeroGradient;",
            .nut = k_calculated,
            .alphat = k_calculated};
  }

  /// Returns conditions by the direction of the flow through each face: the free stream where it enters, extrapolation where it leaves.
  PatchConditions farfield() const {
    return {.velocity = "type freestreamVelocity; freestreamValue uniform " + foam_vector(setup_.velocity) + ";",
            .pressure = "type freestreamPressure; freestreamValue uniform " + free_pressure() + ";" + (is_supersonic() ? " supersonic true;" : ""),
            .temperature = "type inletOutlet; inletValue uniform VALUE; value uniform VALUE;",
            .transported = "type inletOutlet; inletValue uniform VALUE; value uniform VALUE;",
            .nut = k_calculated,
            .alphat = k_calculated};
  }

  std::string unknown(const char* what, PatchId p, const char* needed) const {
    return std::string("the condition at ") + what + " \"" + mesh_.patches[p].name + "\" is unknown: give boundaries = { [\"" + mesh_.patches[p].name +
           "\"] = { " + needed + " } }";
  }

  PatchConditions inflow(PatchId p) {
    const CaseBoundary given = boundaries_.of(mesh_.patches[p]);
    PatchConditions c{.temperature = "type fixedValue; value uniform VALUE;",
                      .transported = "type fixedValue; value uniform VALUE;",
                      .nut = k_calculated,
                      .alphat = k_calculated};
    if (case_patches_.is_tunnel && is_automatic(given.total_pressure)) {
      c.velocity = "type fixedValue; value uniform " + foam_vector(setup_.flow.speed * inward_normal(case_patches_.facts[p])) + ";";
      c.pressure = is_supersonic() ? "type fixedValue; value uniform VALUE;" : "type zeroGradient;";
      return c;
    }
    if (is_automatic(given.total_pressure) || (setup_.is_compressible && is_automatic(given.total_temperature) && !case_patches_.is_tunnel)) {
      problems_.add(unknown("the inflow", p, setup_.is_compressible ? "total_pressure = ..., total_temperature = ..." : "total_pressure = ..."));
      return c;
    }
    const std::string total = pressure_of(given.total_pressure, "the total pressure of \"" + mesh_.patches[p].name + "\"");
    c.velocity = "type pressureInletVelocity; value uniform (0 0 0);";
    c.pressure = "type totalPressure; p0 uniform " + total + ";" +
                 (setup_.is_compressible ? " rho none; psi thermo:psi; gamma " + case_number(volmesh::k_heat_ratio) + ";" : "") + " value uniform " + total +
                 ";";
    if (!is_automatic(given.total_temperature))
      c.temperature = "type totalTemperature; psi thermo:psi; gamma " + case_number(volmesh::k_heat_ratio) + "; T0 uniform " +
                      case_number(given.total_temperature) + "; value uniform " + case_number(given.total_temperature) + ";";
    return c;
  }

  PatchConditions outflow(PatchId p) {
    const CaseBoundary given = boundaries_.of(mesh_.patches[p]);
    PatchConditions c{.velocity = "type inletOutlet; inletValue uniform (0 0 0); value uniform VALUE;",
                      .temperature = "type inletOutlet; inletValue uniform VALUE; value uniform VALUE;",
                      .transported = "type inletOutlet; inletValue uniform VALUE; value uniform VALUE;",
                      .nut = k_calculated,
                      .alphat = k_calculated,
                      .potential = "type fixedValue; value uniform 0;"};
    if (!case_patches_.is_tunnel && is_automatic(given.pressure)) {
      problems_.add(unknown("the outflow", p, "pressure = ..."));
      return c;
    }
    if (!is_automatic(given.pressure))
      c.pressure = "type fixedValue; value uniform " + pressure_of(given.pressure, "the pressure of \"" + mesh_.patches[p].name + "\"") + ";";
    else c.pressure = is_supersonic() ? "type zeroGradient;" : "type fixedValue; value uniform VALUE;";
    return c;
  }

  /// Returns the conditions of one side of an actuator disc. The two sides become cyclic patches, over which the pressure rises in the direction of the flow.
  PatchConditions disc(PatchId p) {
    PatchConditions c = constrained("cyclic");
    const PatchId front = front_of_disc(mesh_, case_patches_, p).value_or(p);
    const bool is_front = front == p;
    const std::optional<PatchId> back = back_of_disc(mesh_, case_patches_, front);
    if (!back) {
      problems_.add("patch \"" + mesh_.patches[p].name + "\" is of kind interface, but no side of an actuator disc: its boundary condition is unknown");
      return c;
    }
    if (is_front) joined_.push_back({front, *back, {}});
    CaseProblems reported;  // for the back: problems are reported with the front
    const std::optional<double> jump = boundaries_.pressure_jump(mesh_.patches[front], case_patches_.facts[front].size, is_front ? problems_ : reported);
    if (!jump) return c;
    if (!setup_.is_compressible && !setup_.is_density_known) {
      (is_front ? problems_ : reported).add("the thrust of \"" + mesh_.patches[front].name + "\" needs the density of the flow: give altitude, or density");
      return c;
    }
    const std::string value = case_number((is_front ? 1.0 : -1.0) * (setup_.is_compressible ? *jump : *jump / setup_.density));
    c.pressure = "type fixedJump; patchType cyclic; jump uniform " + value + "; value uniform VALUE;";
    return c;
  }

  const HybridMesh& mesh_;
  const CasePatches& case_patches_;
  const std::vector<std::string>& names_;
  const FoamSetup& setup_;
  UsedBoundaries& boundaries_;
  std::vector<PeriodicSides>& joined_;
  CaseProblems& problems_;
};

}  // namespace

std::string foam_vector(const Vec3& v) { return "(" + case_number(v.x) + " " + case_number(v.y) + " " + case_number(v.z) + ")"; }

std::vector<CaseFile> foam_fields(const HybridMesh& mesh, const CasePatches& case_patches, const std::vector<std::string>& names, const FoamSetup& setup,
                                  UsedBoundaries& boundaries, std::vector<PeriodicSides>& joined, CaseProblems& problems) {
  return FoamFields(mesh, case_patches, names, setup, boundaries, joined, problems).files();
}

}  // namespace sterna::scripting
