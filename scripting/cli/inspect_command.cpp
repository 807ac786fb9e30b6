#include "scripting/cli/inspect_command.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <iterator>

#include "geom/base/error.h"
#include "scripting/command/cli_options.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/flow_verbs.h"
#include "scripting/values/inspect_surface.h"
#include "scripting/values/layer_options.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/patch_rules.h"
#include "scripting/verbs/half_verbs.h"

namespace sterna::scripting {
namespace {

/// Returns the options of reading, of inspecting and of the volume mesh. A first height is not required. The arguments must outlive the table.
OptionTable inspect_options(surfmesh::StitchOptions& surface, volmesh::InspectRequest& request) {
  OptionTable table = sterna::options_of(request.limits);
  for (Option& option : all_options(surface, request.volume)) table.push_back(std::move(option));
  for (Option& option : table) option.required = false;
  return table;
}

/// Returns the same options for models, whose faces are meshed first.
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

bool is_of_half(const std::string& name) { return name.starts_with("half."); }
OptionOverrides half_options_of(const OptionOverrides& given) {
  OptionOverrides result;
  std::ranges::copy_if(given, std::back_inserter(result), [](const auto& option) { return is_of_half(option.first); });
  return result;
}
OptionOverrides options_but_half(const OptionOverrides& given) {
  OptionOverrides result;
  std::ranges::copy_if(given, std::back_inserter(result), [](const auto& option) { return !is_of_half(option.first); });
  return result;
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
                  "surface files; several are joined to one wall. Or model files, whose faces are meshed first. `sterna formats` lists the formats")
      ->required();
  command
      .add_option("-o,--output", inspect.output,
                  "picture of the findings: .vtu, the surface with the predicted fraction of the layer's height, visibility angles, gaps and findings; or .png")
      ->type_name("FILE");
  command.add_flag("--json", inspect.is_json, "print the report as JSON");
  command.add_flag("--strict", inspect.is_strict, "exit status 1 also if there are warnings");
  command.add_option("--flow", inspect.flow, "flow conditions, for the y+ of the first height, e.g. --flow \"mach=0.78 altitude=11000 length=4.2\"")
      ->type_name("CONDITIONS");
  add_volume_arguments(command, inspect.volume, inspect.options, "inspect");
  surfmesh::StitchOptions surface;
  volmesh::InspectRequest request;
  add_schema_options(command, inspect_options(surface, request), inspect.options);
  add_set_option(command, inspect.options);
  command.footer(
      "Without --first-height the surface is inspected, but layer heights are not predicted. Options of later stages (tetrahedra ...) are accepted without "
      "effect. For models, options of the surface mesh are set with --set surface_mesh.max_edge=0.2.");
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
  request.volume.patches = layer_rules_of(command.volume.patches, is_model ? &recipe.patches : nullptr);
  read_features(command.volume, request.volume);
  if (is_model) recipe.sources = sources_of(command.volume.sources);
  VolumeRequest volume = command.volume;
  const OptionOverrides others = options_but_half(command.options);
  volume.half = half_options_of(command.options);
  CommandContext silent = context;
  silent.only_options = false;
  const HalfOptions half = half_options(volume, silent);
  surfmesh::StitchOptions unused_stitching;
  SurfaceRecipe unused_recipe;
  ReadCadOptions unused_reading;
  const std::string name_of_input = command.inputs.front();
  const OptionsElsewhere elsewhere =
      is_model ? OptionsElsewhere{sterna::options_of(unused_stitching), "applies to triangulations, and " + name_of_input + " is a model"}
               : OptionsElsewhere{model_surface_options(unused_recipe.options, unused_reading),
                                  "applies to the faces of models, and " + name_of_input + " is a triangulation"};
  set_options(is_model ? inspect_options_of_models(recipe, reading, request) : inspect_options(surface, request), others, context, {elsewhere});
  if (volume.is_half || !request.volume.farfield.farfield_floor.empty()) surface.allow_open = true;
  choose_solve_for(
      request.volume, [&](std::string_view name) { return is_given(command, name); }, "reading the options");
  choose_family_wake(request.volume, is_given(command, "refinement"));
  if (is_given(command, "refinement")) recipe.options.sizes.refinement = request.volume.family.refinement;  // as `sterna mesh`
  if (!command.flow.empty()) request.flow = quantity_of_text("y_plus 1 " + command.flow).flow;
  if (!command.output.empty()) require_inspection_output(command.output);
  const BeforeInspection before{.cut = volume.is_half ? [&](const SurfaceValue& whole, const RunContext& part) { return half_surface(whole, half, part); }
                                                      : decltype(BeforeInspection::cut)(),
                                .complete_options = [&](SurfaceValue& wall, volmesh::MeshCase& options, const RunContext& part) {
                                  read_farfield_of(options, wall, part);
                                  add_sources(volume, wall.mesh, options);
                                }};
  const Inspection report =
      is_model ? inspect_models(inputs, reading, recipe, request, context.run, before) : inspect_files(inputs, surface, request, context.run, before);
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
