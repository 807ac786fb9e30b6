// `sterna inspect`: the pre-flight inspection on the command line.
#include <algorithm>

#include "geom/base/error.h"
#include "scripting/cli/commands.h"
#include "scripting/cli/volume_request.h"
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

}  // namespace

HeldOptions inspect_arguments() { return held_table<inspect_options, surfmesh::StitchOptions, volmesh::InspectRequest>(); }

int inspect_command(const CommandLine& line, const CommandContext& context) {
  const std::vector<std::string>& files = line.all("surfaces");
  const std::vector<InputPath> inputs = input_paths(files);
  const bool is_model = std::ranges::any_of(files, [](const std::string& name) { return is_model_file(name); });
  const std::filesystem::path output = line.word("output");
  surfmesh::StitchOptions surface;
  volmesh::InspectRequest request;
  ReadCadOptions reading;
  SurfaceRecipe recipe;
  request.volume.patches = layer_rules_of(line.patches_of("patch"), is_model ? &recipe.patches : nullptr);
  read_features(line, request.volume);
  if (is_model) recipe.sources = sources_of(line.all("source"));
  OptionOverrides given = options_with_farfield(line);
  const OptionOverrides of_half = take_stage(given, "half");
  CommandContext silent = context;
  silent.only_options = false;
  const HalfOptions half = half_options(line, of_half, silent);
  AutoSurface unused;
  set_options(is_model ? inspect_options_of_models(recipe, reading, request) : inspect_options(surface, request), given, context,
              options_of_other_files(is_model, files.front(), unused));
  const bool is_half = line.flag("half");
  if (is_half || !request.volume.farfield.farfield_floor.empty()) surface.allow_open = true;
  complete_layers(request.volume, given, "reading the options");
  if (std::ranges::any_of(given, [](const auto& option) { return option.first == "refinement" || option.first == "family.refinement"; }))
    recipe.options.sizes.refinement = request.volume.family.refinement;  // as `sterna mesh`
  if (const std::string flow = line.word("flow"); !flow.empty()) request.flow = quantity_of_text("y_plus 1 " + flow).flow;
  if (!output.empty()) require_inspection_output(output);
  const BeforeInspection before{
      .cut = is_half ? [&](const SurfaceValue& whole, const RunContext& part) { return half_surface(whole, half, part); } : decltype(BeforeInspection::cut)(),
      .complete_options = [&](SurfaceValue& wall, volmesh::MeshCase& options, const RunContext& part) {
        read_farfield_of(options, wall, part);
        add_sources(line, wall.mesh, options);
      }};
  const Inspection report =
      is_model ? inspect_models(inputs, reading, recipe, request, context.run, before) : inspect_files(inputs, surface, request, context.run, before);
  context.console.end_progress();
  std::string name;
  for (const std::string& file : files) name += (name.empty() ? "" : " ") + file;
  context.console.print(line.flag("json") ? json_of(report, name) : text_of(report, name));
  if (!output.empty()) {
    write_inspection(report, output, context.run);
    context.run.info("wrote " + output.string());
  }
  return report.is_ok() && !(line.flag("strict") && report.count(volmesh::Severity::warn) > 0) ? k_exit_success : k_exit_failed;
}

}  // namespace sterna::scripting
