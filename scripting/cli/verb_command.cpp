#include "scripting/cli/verb_command.h"

#include <algorithm>
#include <memory>

#include "geom/base/error.h"
#include "scripting/cli/commands.h"
#include "scripting/interpreter/script_help.h"
#include "scripting/interpreter/script_state.h"
#include "scripting/lua/table_reader.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/model_surface.h"
#include "scripting/values/models.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/summary.h"
#include "scripting/values/typed_number.h"
#include "scripting/values/verbs.h"
#include "scripting/verbs/draw_command.h"
#include "scripting/verbs/source_verbs.h"

namespace sterna::scripting {
namespace {

constexpr double k_verb_end = 0.93;  ///< fraction of the progress before writing

/// Returns the value of an option in the form of a table's entry.
ScriptValue entry_of_option(const Option& option) {
  const OptionValue value = option.get();
  return option.is_automatic_value(value) ? ScriptValue(std::string("automatic")) : script_value_of(value);
}

ScriptTable table_of_files(const std::vector<std::string>& files) {
  ScriptTable table;
  table.items.assign(files.begin(), files.end());
  return table;
}

/// Refuses an output that is one of the inputs.
void require_other_output(const std::vector<std::string>& inputs, const std::filesystem::path& output, std::string_view attempted) {
  for (const std::string& name : inputs) {
    std::error_code none;  // missing files are no input, or not yet an output
    if (std::filesystem::equivalent(name, output, none))
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = std::string(attempted),
                   .problem = "the output " + output.string() + " is one of the inputs, which the output would replace",
                   .hint = "give it another name"});
  }
}

/// Writes the surface to the outputs of the command.
void write_made(const SurfaceValue& surface, const CommandLine& line, const CommandContext& context) {
  for (const std::string& output : line.all("output")) write_surface(surface, output, context.run.part("write", k_verb_end, 1.0));
  context.console.end_progress();
}

void log_outputs(const SurfaceValue& surface, const CommandLine& line, const CommandContext& context) {
  for (const std::string& output : line.all("output")) context.run.info("wrote " + output + ": " + describe(surface));
}

/// Returns a part of the progress for a verb, which names its own steps.
RunContext unnamed_part(const CommandContext& context, double from, double to) { return context.run.part({}, from, to); }

/// Runs a verb on the surface of the command's file.
int run_on_file(std::string_view verb, double read_end, const CommandLine& line, const CommandContext& context) {
  for (const std::string& output : line.all("output")) require_surface_output(output);
  const HeldOptions options = options_of_verb(verb), reading = options_of_verb("read_surface");
  OptionTable all = options.table;
  all.push_back(find_option(reading.table, "unit", verb));
  ScriptTable request, file = table_of_files(line.all("surface"));
  add_options(request, all, line.options, context);
  if (const auto unit = request.fields.extract("unit"); !unit.empty()) file.fields["unit"] = unit.mapped();
  file.fields["allow_open"] = true;
  if (!line.patches_of("patch").empty()) request.fields["patches"] = patches_entry(line.patches_of("patch"));
  if (!line.all("source").empty()) request.fields["sources"] = sources_entry(line.all("source"));
  const auto cache = cache_of(line);
  request.items = {execute_verb("read_surface", std::move(file), context, unnamed_part(context, 0.0, read_end))};
  const ScriptValue made = execute_verb(verb, std::move(request), context, unnamed_part(context, read_end, k_verb_end), cache.get());
  const SurfaceValue& surface = *std::get<SurfaceHandle>(made);
  write_made(surface, line, context);
  log_outputs(surface, line, context);
  return k_exit_success;
}

/// Runs a verb on all files of the command. `options`: those of the verb for surfaces.
int run_on_parts(std::string_view verb, const OptionTable& options, const CommandLine& line, const CommandContext& context) {
  ScriptTable request = table_of_files(line.all("parts"));
  add_options(request, options, line.options, context);
  require_surface_output(line.word("output"));
  for (const char* const report : {"changes", "report"})
    if (const std::string file = line.word(report); !file.empty()) request.fields[report] = file;
  const auto cache = cache_of(line);
  const ScriptValue made = execute_verb(verb, std::move(request), context, unnamed_part(context, 0.0, k_verb_end), cache.get());
  const SurfaceValue& surface = *std::get<SurfaceHandle>(made);
  write_made(surface, line, context);
  if (verb == "repair")
    for (const std::string& change : changes_of(surface.history)) context.run.info("changed: " + change);
  log_outputs(surface, line, context);
  return k_exit_success;
}

}  // namespace

HeldOptions options_of_verb(std::string_view verb) { return find_verb(verb)->options(); }

ScriptValue execute_verb(std::string_view name, ScriptTable table, const CommandContext& context, const RunContext& part, const StageCache* cache) {
  const ScriptVerb& verb = *find_verb(name);
  ScriptSession session{.context = part,
                        .script = {},
                        .overrides = {},
                        .print = [&](std::string_view text) { context.console.print(text); },
                        .on_mesh = {},
                        .cache = cache,
                        .cancelled = {},
                        .hooks = &script_hooks(),
                        .value = {}};
  return verb.run({.session = session, .where = {}, .verb = verb.name, .arguments = {std::make_shared<const ScriptTable>(std::move(table))}});
}

void add_options(ScriptTable& table, const OptionTable& options, const OptionOverrides& given, const CommandContext& context) {
  set_options(options, given, context);
  for (const auto& [name, text] : given) {
    const Option& option = find_option(options, name, name);
    table.fields[std::string(option.name)] = entry_of_option(option);
  }
}

ScriptValue patches_entry(const PatchEntries& patches) {
  ScriptTable table;
  std::map<std::string, ScriptTable> rules;
  for (const auto& [names, options] : patches) {
    Rule rule;
    const OptionTable known = surface_and_layer_options(rule);
    for (const auto& [name, text] : options) {
      const Option& option = find_option(known, name, "--patch \"" + names + "\"");
      set_option_as_typed(option, text);
      auto& fields = rules[names].fields;  // of an earlier --patch with this pattern, too: its values stay where this one has "automatic"
      if (is_set(rule, option.name) || !fields.contains(std::string(option.name))) fields[std::string(option.name)] = entry_of_option(option);
    }
  }
  for (auto& [names, rule] : rules) table.fields[names] = std::make_shared<const ScriptTable>(std::move(rule));
  return std::make_shared<const ScriptTable>(std::move(table));
}

ScriptValue sources_entry(const std::vector<std::string>& texts) {
  ScriptTable list;
  for (const std::string& text : texts) list.items.emplace_back(table_of_source(source_of_text(text)));
  return std::make_shared<const ScriptTable>(std::move(list));
}

int half_command(const CommandLine& line, const CommandContext& context) {
  if (const std::string input = line.word("surface"); is_model_file(input))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = "half " + input,
                 .problem = "the file is a model, not a triangulation",
                 .hint = "`sterna mesh " + input + " --half ...` meshes half of it; in a script half(read_cad \"...\"); or `sterna surface` first"});
  return run_on_file("half", 0.5, line, context);
}

int remesh_command(const CommandLine& line, const CommandContext& context) { return run_on_file("remesh", 0.03, line, context); }

int repair_command(const CommandLine& line, const CommandContext& context) {
  require_other_output(line.all("parts"), line.word("output"), "repair");
  return run_on_parts("repair", options_of_verb("repair").table, line, context);
}

int wrap_command(const CommandLine& line, const CommandContext& context) {
  require_other_output(line.all("parts"), line.word("output"), "wrap");
  return run_on_parts("wrap", options_of_verb("wrap").table, line, context);
}

int union_command(const CommandLine& line, const CommandContext& context) {
  require_other_output(line.all("parts"), line.word("output"), "union");
  if (std::ranges::any_of(line.all("parts"), [](const std::string& name) { return is_model_file(name); })) return unite_model_files(line, context);
  const HeldOptions uniting = held_options<UnionOptions>(), reading = options_of_verb("read_surface");
  OptionTable options = uniting.table;
  options.push_back(find_option(reading.table, "unit", "union"));
  return run_on_parts("union", options, line, context);
}

int draw_command(const CommandLine& line, const CommandContext& context) {
  const std::string output = line.word("output");
  require_picture_output(output);
  DrawOptions options;
  ScriptTable request = table_of_files({line.word("mesh"), output});
  add_options(request, sterna::options_of(options), line.options, context);
  require_draw_options(options);
  execute_verb("draw", std::move(request), context, context.run);
  context.console.end_progress();
  return k_exit_success;
}

}  // namespace sterna::scripting
