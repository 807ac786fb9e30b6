// The commands for model files: STEP, IGES, BREP, sumo, CPACS.
#include <fmt/format.h>

#include <algorithm>

#include "geom/base/error.h"
#include "geom/cad/unite.h"
#include "scripting/cli/commands.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/aircraft_model.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/repair_surfaces.h"
#include "scripting/values/summary.h"
#include "scripting/verbs/source_verbs.h"

namespace sterna::scripting {
namespace {

constexpr double k_model_read_end = 0.4;
/// Number of open edges listed by `sterna info`; `sterna check` lists all.
constexpr std::size_t k_listed_edges = 10;

InputPath input_of(const std::string& name) { return {name, name}; }

}  // namespace

int print_model_info(const InfoCommand& command, const CommandContext& context) {
  ReadCadOptions options;
  if (!command.unit.empty()) set_options(sterna::options_of(options), {{"unit", command.unit}}, context);
  const ModelValue value = read_model(input_of(command.input), options, context.run.part("read", 0.0, k_model_read_end));
  const ModelReport measures = measure_model(value, context.run.part("measure", k_model_read_end, 1.0));
  context.console.end_progress();
  if (!value.report.empty() && !value.description) context.console.print(command.input + ": " + value.report);  // the log has the report of a description
  context.console.print(describe(value));
  context.console.print(measures_text(measures));
  context.console.print("  closed   " + closedness_text(value.model, k_listed_edges));
  return k_exit_success;
}

int check_model(const CheckCommand& command, const CommandContext& context) {
  if (!command.models.empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "check",
                 .problem = "--model applies to volume meshes; " + command.input + " is a model itself",
                 .hint = "sterna check mesh.su2 --model " + command.input});
  if (command.is_json)
    throw Error({.code = ErrorCode::bad_argument, .attempted = "check", .problem = "--json applies to volume meshes; " + command.input + " is a model"});
  refuse_without_effect(command.given,
                        {"--findings-per-kind", "--strict", "--for", "--cell-centred", "--no-cell-centred", "--cells", "--gate", "--intersections"}, "check",
                        command.input + " is a model, for which check only reports whether it is closed");
  const ModelValue value = read_model(input_of(command.input), {}, context.run.part("read", 0.0, 1.0));
  context.console.end_progress();
  context.console.print(describe(value));
  context.console.print("  " + closedness_text(value.model, value.model.edges.size()));
  const bool is_closed = !value.model.faces.empty() && free_edges(value.model).empty();
  context.console.print(is_closed ? "CLOSED" : "OPEN");
  return is_closed ? k_exit_success : k_exit_invalid;
}

namespace {

/// With --auto the command also accepts triangulations, whose triangles are kept or wrapped. Rejects sizes of faces for them, which would have no effect.
void refuse_on_triangulations(const SurfaceCommand& command) {
  const auto input = std::ranges::find_if(command.inputs, [](const std::string& name) { return !is_model_file(name); });
  if (input == command.inputs.end() || !command.is_auto) return;  // without --auto a triangulation is refused
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const auto& [name, text] : command.options)
    if (name != "unit" && name != "read_cad.unit" && !name.starts_with("remesh.") && !name.starts_with("repair.") && !name.starts_with("wrap.")) add(name);
  if (!command.sources.empty()) add("--source");
  Rule sizes;
  const OptionTable table = size_rule_options(sizes);
  for (const auto& [pattern, options] : command.patches)
    for (const auto& [name, text] : options)
      if (std::ranges::find(table, name, &Option::name) != table.end()) add("--patch " + pattern + ":" + name);
  if (names.empty()) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "surface",
               .problem = "no effect, because " + *input + " is a triangulation: " + names,
               .hint = "`sterna remesh " + *input + " ...` makes new triangles with these sizes"});
}

}  // namespace

int execute(const SurfaceCommand& command, const CommandContext& context) {
  SurfaceRecipe recipe;
  ReadCadOptions reading;
  AutoSurface requested;
  // Options of the stages that --auto may start have the name of their stage as prefix: --set remesh.max_triangles=1e6
  const auto stage_of = [&](const std::string& name) -> OptionTable {
    if (name.starts_with("remesh.")) return sterna::options_of(requested.remesh);
    if (name.starts_with("repair.")) return sterna::options_of(requested.repair);
    if (name.starts_with("wrap.")) return sterna::options_of(requested.wrap);
    return {};
  };
  OptionOverrides own, of_stages;
  for (const auto& option : command.options) (stage_of(option.first).empty() ? own : of_stages).push_back(option);
  if (!command.is_auto && !of_stages.empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "option " + of_stages.front().first, .problem = "is given without --auto"});
  set_options(model_surface_options(recipe.options, reading), own, context);
  for (const auto& option : of_stages) set_options(stage_of(option.first), {option}, context);
  const std::vector<Rule> layers = layer_rules_of(command.patches, &recipe.patches);
  for (const std::string& source : command.sources) recipe.sources.push_back(source_of_text(source));
  if (!recipe.sources.empty()) recipe.sources_text = sources_text(recipe.sources, false);
  refuse_on_triangulations(command);
  for (const auto& output : command.outputs) require_surface_output(output);
  std::vector<InputPath> inputs;
  for (const std::string& name : command.inputs) inputs.push_back(input_of(name));
  const std::unique_ptr<const StageCache> cache = cache_of(command.cache);
  const Reuse reuse{.cache = cache.get(), .lines = nullptr};
  const RunContext part = context.run.part("surface", 0.0, 0.95);
  if (!is_automatic(reading.unit)) requested.stitching.unit = reading.unit;
  requested.reading = reading;
  requested.recipe = recipe;
  SurfaceValue surface = command.is_auto ? auto_surface(inputs, requested, reuse, part) : mesh_model_files(inputs, reading, recipe, part, reuse);
  add_layer_rules(layers, surface);
  for (const auto& output : command.outputs) write_surface(surface, output, context.run.part("write", 0.95, 1.0));
  context.console.end_progress();
  for (const std::string& change : surface.changes) context.run.info("changed: " + change);
  for (const auto& output : command.outputs) context.run.info("wrote " + output.string() + ": " + describe(surface));
  return k_exit_success;
}

int unite_models(const UnionCommand& command, const CommandContext& context) {
  for (const std::string& name : command.inputs)
    if (!is_model_file(name))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "union",
                   .problem = name + " is not a model, but other files are",
                   .hint = "unite models (STEP, IGES, BREP, sumo, CPACS) or surfaces (STL ...), not both"});
  UniteOptions options;
  ReadCadOptions reading;
  OptionTable table = sterna::options_of(options);
  table.push_back(find_option(sterna::options_of(reading), "unit", "union"));
  set_options(table, command.options, context);
  require_model_output({.without_description = "it is a union"}, command.output);
  std::vector<ModelHandle> models;
  const double n = static_cast<double>(command.inputs.size());
  for (const std::string& name : command.inputs) {
    const double i = static_cast<double>(models.size());
    models.push_back(std::make_shared<const ModelValue>(
        read_model(input_of(name), reading, context.run.part("read", k_model_read_end * i / n, k_model_read_end * (i + 1) / n))));
  }
  ModelValue united = unite_solids(models, options, context.run.part("union", k_model_read_end, 0.95));
  united.description.reset();  // the file contains the union, while the description is that of its inputs
  write_model(united, command.output, {}, context.run.part("write", 0.95, 1.0));
  context.console.end_progress();
  context.run.info("wrote " + command.output.string() + ": " + describe(united));
  return k_exit_success;
}

int convert_model(const ConvertCommand& command, const CommandContext& context) {
  if (!command.settings.format.empty() || command.settings.as_surface)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "convert",
                 .problem = "--format and --surface apply to meshes; " + command.input + " is a model",
                 .hint = "the extension of the output sets the format: .step, .iges, .brep, .smx"});
  refuse_without_effect(command.given, {"--numbering"}, "convert", command.input + " is a model, which has no cells");
  ReadCadOptions reading;
  WriteCadOptions writing;
  OptionTable table = sterna::options_of(reading);
  for (Option& option : sterna::options_of(writing)) table.push_back(std::move(option));
  set_options(table, command.options, context);
  if (!is_model_output(command.output)) require_model_output({}, command.output);  // before the input is read
  const ModelValue value = read_model(input_of(command.input), reading, context.run.part("read", 0.0, k_model_read_end));
  write_model(value, command.output, writing, context.run.part("write", k_model_read_end, 1.0));
  context.console.end_progress();
  context.run.info("wrote " + command.output.string() + ": " + describe(value));
  return k_exit_success;
}

}  // namespace sterna::scripting
