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

}  // namespace

int print_model_info(const CommandLine& line, const CommandContext& context) {
  const std::string file = line.word("file"), unit = line.word("unit");
  ReadCadOptions options;
  if (!unit.empty()) set_options(sterna::options_of(options), {{"unit", unit}}, context);
  const ModelValue value = read_model(input_paths({file}).front(), options, context.run.part("read", 0.0, k_model_read_end));
  const ModelReport measures = measure_model(value, context.run.part("measure", k_model_read_end, 1.0));
  context.console.end_progress();
  if (!value.report.empty() && !value.description) context.console.print(file + ": " + value.report);  // the log has the report of a description
  context.console.print(describe(value));
  context.console.print(measures_text(measures));
  context.console.print("  closed   " + closedness_text(value.model, k_listed_edges));
  return k_exit_success;
}

int check_model(const CommandLine& line, const CommandContext& context) {
  const std::string input = line.word("mesh");
  if (!line.all("model").empty())
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "check",
                 .problem = "--model applies to volume meshes; " + input + " is a model itself",
                 .hint = "sterna check mesh.su2 --model " + input});
  if (line.flag("json"))
    throw Error({.code = ErrorCode::bad_argument, .attempted = "check", .problem = "--json applies to volume meshes; " + input + " is a model"});
  refuse_without_effect(line.given, {"--findings-per-kind", "--strict", "--for", "--cell-centred", "--no-cell-centred", "--cells", "--gate", "--intersections"},
                        "check", input + " is a model, for which check only reports whether it is closed");
  const ModelValue value = read_model(input_paths({input}).front(), {}, context.run.part("read", 0.0, 1.0));
  context.console.end_progress();
  context.console.print(describe(value));
  context.console.print("  " + closedness_text(value.model, value.model.edges.size()));
  const bool is_closed = !value.model.faces.empty() && free_edges(value.model).empty();
  context.console.print(is_closed ? "CLOSED" : "OPEN");
  return is_closed ? k_exit_success : k_exit_invalid;
}

namespace {

/// With --auto the command also accepts triangulations, whose triangles are kept or wrapped. Rejects sizes of faces for them, which would have no effect.
void refuse_on_triangulations(const CommandLine& line) {
  const auto input = std::ranges::find_if(line.all("models"), [](const std::string& name) { return !is_model_file(name); });
  if (input == line.all("models").end() || !line.flag("auto")) return;  // without --auto a triangulation is refused
  std::string names;
  const auto add = [&](const std::string& name) { names += (names.empty() ? "" : ", ") + name; };
  for (const auto& [name, text] : line.options)
    if (name != "unit" && name != "read_cad.unit" && !name.starts_with("remesh.") && !name.starts_with("repair.") && !name.starts_with("wrap.")) add(name);
  if (!line.all("source").empty()) add("--source");
  Rule sizes;
  const OptionTable table = size_rule_options(sizes);
  for (const auto& [pattern, options] : line.patches_of("patch"))
    for (const auto& [name, text] : options)
      if (std::ranges::find(table, name, &Option::name) != table.end()) add("--patch " + pattern + ":" + name);
  if (names.empty()) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "surface",
               .problem = "no effect, because " + *input + " is a triangulation: " + names,
               .hint = "`sterna remesh " + *input + " ...` makes new triangles with these sizes"});
}

}  // namespace

int surface_command(const CommandLine& line, const CommandContext& context) {
  const bool is_auto = line.flag("auto");
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
  for (const auto& option : line.options) (stage_of(option.first).empty() ? own : of_stages).push_back(option);
  if (!is_auto && !of_stages.empty())
    throw Error({.code = ErrorCode::bad_argument, .attempted = "option " + of_stages.front().first, .problem = "is given without --auto"});
  set_options(model_surface_options(recipe.options, reading), own, context);
  for (const auto& option : of_stages) set_options(stage_of(option.first), {option}, context);
  const std::vector<Rule> layers = layer_rules_of(line.patches_of("patch"), &recipe.patches);
  for (const std::string& source : line.all("source")) recipe.sources.push_back(source_of_text(source));
  refuse_on_triangulations(line);
  for (const std::string& output : line.all("output")) require_surface_output(output);
  const std::vector<InputPath> inputs = input_paths(line.all("models"));
  const std::unique_ptr<const StageCache> cache = cache_of(line);
  const Reuse reuse{.cache = cache.get(), .lines = nullptr};
  const RunContext part = context.run.part("surface", 0.0, 0.95);
  if (!is_automatic(reading.unit)) requested.stitching.unit = reading.unit;
  requested.reading = reading;
  requested.recipe = recipe;
  SurfaceValue surface = is_auto ? auto_surface(inputs, requested, reuse, part) : mesh_model_files(inputs, reading, recipe, part, reuse);
  add_layer_rules(layers, surface);
  for (const std::string& output : line.all("output")) write_surface(surface, output, context.run.part("write", 0.95, 1.0));
  context.console.end_progress();
  for (const std::string& change : changes_of(surface.history)) context.run.info("changed: " + change);
  for (const std::string& output : line.all("output")) context.run.info("wrote " + output + ": " + describe(surface));
  return k_exit_success;
}

int unite_model_files(const CommandLine& line, const CommandContext& context) {
  const std::vector<std::string>& inputs = line.all("parts");
  const std::filesystem::path output = line.word("output");
  for (const std::string& name : inputs)
    if (!is_model_file(name))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "union",
                   .problem = name + " is not a model, but other files are",
                   .hint = "unite models (STEP, IGES, BREP, sumo, CPACS) or surfaces (STL ...), not both"});
  UniteOptions options;
  ReadCadOptions reading;
  OptionTable table = sterna::options_of(options);
  table.push_back(find_option(sterna::options_of(reading), "unit", "union"));
  set_options(table, line.options, context);
  require_model_output({.without_description = "it is a union"}, output);
  std::vector<ModelHandle> models;
  const double n = static_cast<double>(inputs.size());
  for (const std::string& name : inputs) {
    const double i = static_cast<double>(models.size());
    models.push_back(std::make_shared<const ModelValue>(
        read_model(input_paths({name}).front(), reading, context.run.part("read", k_model_read_end * i / n, k_model_read_end * (i + 1) / n))));
  }
  ModelValue united = unite_solids(models, options, context.run.part("union", k_model_read_end, 0.95));
  united.description.reset();  // the file contains the union, while the description is that of its inputs
  write_model(united, output, {}, context.run.part("write", 0.95, 1.0));
  context.console.end_progress();
  context.run.info("wrote " + output.string() + ": " + describe(united));
  return k_exit_success;
}

int convert_model(const CommandLine& line, const CommandContext& context) {
  const std::string input = line.word("input");
  const std::filesystem::path output = line.word("output");
  if (!line.word("format").empty() || line.flag("surface"))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "convert",
                 .problem = "--format and --surface apply to meshes; " + input + " is a model",
                 .hint = "the extension of the output sets the format: .step, .iges, .brep, .smx"});
  refuse_without_effect(line.given, {"--numbering"}, "convert", input + " is a model, which has no cells");
  ReadCadOptions reading;
  WriteCadOptions writing;
  OptionTable table = sterna::options_of(reading);
  for (Option& option : sterna::options_of(writing)) table.push_back(std::move(option));
  set_options(table, line.options, context);
  if (!is_model_output(output)) require_model_output({}, output);  // before the input is read
  const ModelValue value = read_model(input_paths({input}).front(), reading, context.run.part("read", 0.0, k_model_read_end));
  write_model(value, output, writing, context.run.part("write", k_model_read_end, 1.0));
  context.console.end_progress();
  context.run.info("wrote " + output.string() + ": " + describe(value));
  return k_exit_success;
}

}  // namespace sterna::scripting
