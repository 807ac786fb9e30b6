#include "scripting/cli/inspect_command.h"

#include <CLI/CLI.hpp>

#include "geom/base/error.h"
#include "scripting/command/cli_options.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/inspect_surface.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/models.h"
#include "scripting/values/patch_rules.h"
#include "scripting/verbs/source_verbs.h"

namespace sterna::scripting {
namespace {

/// Of reading, inspecting and the volume mesh; no first height is needed. The arguments must outlive the table.
OptionTable inspect_options(surfmesh::StitchOptions& surface, volmesh::InspectRequest& request) {
  OptionTable table = sterna::options_of(request.limits);
  for (Option& option : all_options(surface, request.volume)) table.push_back(std::move(option));
  for (Option& option : table) option.required = false;
  return table;
}

/// The same of models: their faces are meshed first.
OptionTable inspect_options_of_models(SurfaceRecipe& recipe, ReadCadOptions& reading, volmesh::InspectRequest& request) {
  OptionTable table = sterna::options_of(request.limits);
  for (Option& option : volmesh::options_of(request.volume)) table.push_back(std::move(option));
  for (Option& option : model_surface_options(recipe.options, reading)) table.push_back(std::move(option));
  for (Option& option : table) option.required = false;
  return table;
}

bool is_given(const InspectCommand& command, std::string_view name) {
  return std::ranges::any_of(command.options, [&](const auto& option) {
    return option.first == name || option.first == "envelope." + std::string(name) || option.first == "family." + std::string(name);
  });
}

std::string names_of(const InspectCommand& command) {
  std::string text;
  for (const std::string& name : command.inputs) text += (text.empty() ? "" : " ") + name;
  return text;
}

}  // namespace

void add_inspect_arguments(CLI::App& command, InspectCommand& inspect, const std::function<void()>& chosen) {
  command
      .add_option("surfaces", inspect.inputs,
                  "surface files; several are joined to one wall. Or model files, whose faces are meshed first. `sterna formats` lists what is read")
      ->required();
  command
      .add_option(
          "-o,--output", inspect.output,
          "picture of the trouble: .vtu, the surface with the predicted share of the layer's height, visibility angles, gaps and what was found; or .png")
      ->type_name("FILE");
  command.add_flag("--json", inspect.is_json, "print the report as JSON");
  command.add_flag("--strict", inspect.is_strict, "exit status 1 also for warnings");
  command.add_option("--flow", inspect.flow, "flow conditions, for the y+ of the first height, e.g. --flow \"mach=0.78 altitude=11000 length=4.2\"")
      ->type_name("CONDITIONS");
  command
      .add_option(
          "--source", inspect.sources,
          "shorter edges in a region, as of `sterna mesh`, e.g. --source \"cylinder from=1,0,0 to=8,0,0 radius=0.5 size=5cm\"; may be given several times")
      ->type_name("SOURCE")
      ->allow_extra_args(false)
      ->take_all();
  surfmesh::StitchOptions surface;
  volmesh::InspectRequest request;
  add_schema_options(command, inspect_options(surface, request), inspect.options);
  add_set_option(command, inspect.options);
  add_patch_option(
      command, inspect.patches,
      "what patches with such names ask for instead, as of `sterna mesh`, e.g. --patch \"tunnel*:layers=20,first_height=2e-5\"; may be given several times");
  command.footer(
      "Without --first-height the surface is looked at, but not how high the layers will be. Options of later stages (tetrahedra ...) are taken and have no "
      "effect. Of models, options of their surface: --set surface_mesh.max_edge=0.2.");
  command.final_callback(chosen);
}

int execute(const InspectCommand& command, const CommandContext& context) {
  std::vector<InputPath> inputs;
  for (const std::string& name : command.inputs) inputs.push_back({name, name});
  const bool is_model = std::ranges::any_of(command.inputs, [](const std::string& name) { return is_model_file(name); });
  surfmesh::StitchOptions surface;
  volmesh::InspectRequest request;
  ReadCadOptions reading;
  SurfaceRecipe recipe;
  for (const std::string& source : command.sources) request.volume.sources.push_back(source_of_text(source));
  request.volume.patches = layer_rules_of(command.patches, is_model ? &recipe.patches : nullptr);
  set_options(is_model ? inspect_options_of_models(recipe, reading, request) : inspect_options(surface, request), command.options, context);
  choose_solve_for(
      request.volume, [&](std::string_view name) { return is_given(command, name); }, "reading the options");
  choose_family_wake(request.volume, is_given(command, "refinement"));
  if (!command.flow.empty()) request.flow = quantity_of_text("y_plus 1 " + command.flow).flow;
  if (!command.output.empty()) require_inspection_output(command.output);
  const Inspection report = is_model ? inspect_models(inputs, reading, recipe, request, context.run) : inspect_files(inputs, surface, request, context.run);
  context.console.end_progress();
  const std::string name = names_of(command);
  context.console.print(command.is_json ? json_of(report, name) : text_of(report, name));
  if (!command.output.empty()) {
    write_inspection(report, command.output, context.run);
    context.run.info("wrote " + command.output.string());
  }
  return report.is_ok() && !(command.is_strict && report.count(volmesh::Severity::warn) > 0) ? k_exit_success : k_exit_failed;
}

}  // namespace sterna::scripting
