// Steps: convert components to a description; make the components of the description side by side; set patch names that only scripts know; unite the components
// if requested.
#include "scripting/values/aircraft_model.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "geom/base/error.h"
#include "geom/cad/aircraft_union.h"
#include "geom/model/components.h"
#include "geom/model/deform.h"
#include "geom/model/model_builder.h"
#include "scripting/values/fluid_model.h"

namespace sterna::scripting {
namespace {

/// Sets the names of fan face and nozzle of a component or its mirror image.
void finish_component(Model& model, const ComponentValue& component, const std::string& name, bool is_image) {
  for (const ComponentId c : model.components.ids()) {
    if (model.components[c].name != name) continue;
    for (ModelFace& face : model.faces) {
      if (face.component != c) continue;
      // The engine takes in the fluid at its fan face, which is an outflow of the domain.
      const auto rename = [&](const std::string& patch, PatchKind kind) {
        if (patch.empty()) return;
        face.name = is_image ? image_name(patch) : patch;
        face.kind = kind;
      };
      if (face.role == FaceRole::fan_face) rename(component.intake, PatchKind::outflow);
      if ((face.role == FaceRole::tail || face.role == FaceRole::nozzle) && component.kind == ComponentKind::nacelle) {
        face.role = FaceRole::nozzle;
        rename(component.exhaust, PatchKind::inflow);
      }
    }
  }
}

void append_description(Aircraft& aircraft, const ComponentValue& component) {
  if (const auto* body = std::get_if<Body>(&component.shape)) {
    aircraft.bodies.push_back(*body);
    if (component.intake.empty() && component.exhaust.empty()) return;
    JetEngine engine{.name = body->name};
    if (!component.intake.empty()) engine.intakes.push_back({body->name, true});
    if (!component.exhaust.empty()) engine.nozzles.push_back({body->name, false});
    aircraft.engines.push_back(std::move(engine));
    return;
  }
  aircraft.wings.push_back(std::get<Wing>(component.shape));
  for (const Deflection& d : component.deflections) {
    aircraft.control_surfaces.push_back(d.surface);
    aircraft.deflections.push_back(d);
  }
}

}  // namespace

Aircraft aircraft_of(const AircraftParts& parts) {
  Aircraft aircraft{.name = parts.name};
  std::set<std::string> names;
  for (const ComponentHandle& component : parts.components) {
    for (const std::string& name :
         component->has_mirror_image() ? std::vector{component->name(), image_name(component->name())} : std::vector{component->name()})
      if (!names.insert(name).second)
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = "assembling the aircraft",
                     .problem = "two components are named \"" + name + "\"",
                     .hint = "give them names: wing{ name = \"tail\", ... }"});
    append_description(aircraft, *component);
  }
  return aircraft;
}

ModelValue make_aircraft(const AircraftParts& parts, const RunContext& context) {
  ModelValue value;
  Aircraft aircraft = aircraft_of(parts);
  value.model = make_components(aircraft, context);
  for (const ComponentHandle& component : parts.components) {
    finish_component(value.model, *component, component->name(), false);
    if (component->has_mirror_image()) finish_component(value.model, *component, image_name(component->name()), true);
  }
  value.description = std::move(aircraft);
  if (parts.models.empty()) return value;
  std::vector<ModelHandle> models = {std::make_shared<const ModelValue>(std::move(value))};
  models.insert(models.end(), parts.models.begin(), parts.models.end());
  return assemble(models, context);
}

ModelValue unite_solids(const std::vector<ModelHandle>& models, const UniteOptions& options, const RunContext& context) {
  ModelValue value = assemble(models, context);
  refit_for_cad(value.model, context);  // the kernel of the union supports splines only
  UniteResult united = cad::unite_aircraft(value.model, options, context);
  value.report = fmt::format("union: volume {:.6g} m^3, sum of the parts {:.6g} m^3; {} {}", united.report.volume, united.report.sum_of_volumes,
                             united.report.n_bodies, united.report.n_bodies == 1 ? "body" : "bodies that do not touch");
  for (const UniteTry& attempt : united.report.tries)
    if (!attempt.problem.empty()) value.report += fmt::format("\n  tolerance {:.3g} m was not enough: {}", attempt.tolerance, attempt.problem);
  context.info(value.report);
  value.model = std::move(united.model);
  value.is_as_described = false;
  value.parts.clear();
  return value;
}

ModelValue assemble(const std::vector<ModelHandle>& models, const RunContext& context) {
  if (models.size() == 1) return *models.front();
  ModelValue value{.without_description = "it is assembled from models"};
  std::set<std::string> taken;
  for (const ModelHandle& handle : models) {
    Model model = handle->model;
    std::map<std::string, std::string> renamed;
    for (Component& component : model.components) {
      std::string name = component.name;
      for (int i = 2; !taken.insert(name).second; ++i) name = component.name + std::to_string(i);
      if (name == component.name) continue;
      context.info("a second component \"" + component.name + "\" is now \"" + name + "\"");
      renamed[component.name] = name;
      component.name = name;
    }
    for (const auto& [from, to] : renamed) {
      for (ModelFace& face : model.faces)
        if (face.name == from) face.name = to;
      for (ModelSolid& solid : model.solids)
        if (solid.name == from) solid.name = to;
    }
    append(value.model, model);
    for (ModelPart& part : parts_of(*handle)) value.parts.push_back(std::move(part));
    value.sizes.insert(value.sizes.end(), handle->sizes.begin(), handle->sizes.end());
    value.layers.insert(value.layers.end(), handle->layers.begin(), handle->layers.end());
    value.through.insert(value.through.end(), handle->through.begin(), handle->through.end());
    value.inputs.insert(value.inputs.end(), handle->inputs.begin(), handle->inputs.end());
  }
  return value;
}

}  // namespace sterna::scripting
