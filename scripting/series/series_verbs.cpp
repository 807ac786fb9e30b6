#include "scripting/series/series_verbs.h"

#include <algorithm>
#include <array>
#include <memory>

#include "geom/base/error.h"
#include "geom/base/hash.h"
#include "geom/base/schema.h"
#include "scripting/lua/verb_tools.h"
#include "scripting/series/series_run.h"
#include "scripting/values/value_json.h"

namespace sterna {

template <>
struct Schema<scripting::JobsOptions> {
  using O = scripting::JobsOptions;
  static constexpr std::string_view stage = "jobs";
  static constexpr std::array fields = {
      Field<O>{.name = "tasks", .member = &O::tasks, .min = 0, .max = 1e6, .help = "number of cases that run at the same time; 0: one for every four cores"},
      Field<O>{.name = "threads",
               .member = &O::threads,
               .min = 0,
               .max = 1024,
               .help = "threads of each case; 0: the cores of the machine divided by the number of tasks"},
  };
};

template <>
struct Schema<scripting::SlurmOptions> {
  using O = scripting::SlurmOptions;
  static constexpr std::string_view stage = "slurm";
  static constexpr std::array fields = {
      Field<O>{.name = "partition", .member = &O::partition, .help = "partition of the jobs; empty: the cluster's default"},
      Field<O>{
          .name = "tasks", .member = &O::tasks, .min = 0, .max = 1e6, .help = "number of cases that run at the same time; 0: as many as the cluster starts"},
      Field<O>{.name = "threads", .member = &O::threads, .min = 1, .max = 1024, .help = "threads of each case, and cores of its job"},
      Field<O>{.name = "time", .member = &O::time, .help = "time limit of a case in the format of sbatch, e.g. 02:00:00; empty: limit of the partition"},
  };
};

template <>
struct Schema<scripting::SeriesOptions> {
  using O = scripting::SeriesOptions;
  static constexpr std::string_view stage = "series";
  static constexpr std::array fields = {
      Field<O>{
          .name = "retry",
          .member = &O::retry,
          .help = "repeat all cases that failed in an earlier run. Cases that were killed, have changed or failed because of the machine are always repeated"},
  };
};

}  // namespace sterna

namespace sterna::scripting {
namespace {

constexpr std::string_view k_series_usage =
    "series{ \"polar\", over = { alpha = range(-4, 12, 2), beta = {0, 5} }, run = jobs{ 2 }, case = function(p) return volume_mesh{ surface_mesh{ "
    "model:rotate{ pitch = p.alpha*deg } }, layers = 30, first_height = 3e-6 }:write(p.name .. \".cgns\") end }";
constexpr std::string_view k_jobs_usage = "jobs{ 2, threads = 4 }";
constexpr std::string_view k_slurm_usage =
    "slurm{ partition = \"cfd\", tasks = 64, threads = 8, options = { account = \"aero\", mem = \"16G\", exclusive = true } }";
constexpr std::string_view k_range_usage = "range(-4, 12, 2)";
constexpr std::string_view k_zip_usage = "zip{ alpha = {0, 4, 8}, bend = {0, 0.01, 0.03} }";

/// Reserved names in the folder of a series, not allowed as case names.
constexpr std::array<std::string_view, 4> k_reserved = {"slurm", "series.json", "series.csv", "series.html"};

/// Returns the table that jobs{} and slurm{} pass to series{}.
ScriptValue runner_table(const char* kind, const OptionTable& options, TableHandle extra) {
  auto table = std::make_shared<ScriptTable>();
  table->fields["runner"] = std::string(kind);
  for (const Option& option : options) table->fields[std::string(option.name)] = script_value_of(option.get());
  if (extra) table->fields["options"] = extra;
  return TableHandle(table);
}

ScriptValue jobs_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_jobs_usage);
  JobsOptions jobs;
  const OptionTable schema = sterna::options_of(jobs);
  ScriptTable named = table;
  if (named.items.size() == 1 && named.fields.emplace("tasks", named.items.front()).second) named.items.clear();
  TableReader reader(named, call.attempted());
  if (!reader.items().empty()) reader.add_problem("takes one number, the number of tasks: " + std::string(k_jobs_usage));
  reader.read_options(schema);
  reader.finish();
  return runner_table("jobs", schema, nullptr);
}

/// Converts mem = "8G" to "--mem=8G"; records problems.
std::vector<std::string> sbatch_words(const ScriptTable& options, TableReader& reader) {
  std::vector<std::string> words;
  if (!options.items.empty() || !options.other_keys.empty()) reader.add_problem("options: every option of sbatch needs a name");
  for (const auto& [name, value] : options.fields) {
    std::string word = "--" + name;
    std::replace(word.begin(), word.end(), '_', '-');
    if (const auto* flag = std::get_if<bool>(&value)) {
      if (*flag) words.push_back(word);
      continue;
    }
    const auto* text = std::get_if<std::string>(&value);
    const bool is_number = std::holds_alternative<std::int64_t>(value) || std::holds_alternative<double>(value);
    if (!text && !is_number) reader.add_problem("options." + name + ": expected a string, a number or true, not " + std::string(type_text(value)));
    else words.push_back(word + "=" + (text ? *text : to_json(value)));
  }
  return words;
}

bool has_control_characters(const std::string& text) {
  return std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

ScriptValue slurm_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_slurm_usage);
  SlurmOptions slurm;
  const OptionTable schema = sterna::options_of(slurm);
  TableReader reader(table, call.attempted());
  reader.read_options(schema);
  TableHandle extra;
  if (const ScriptValue* value = reader.field("options")) {
    if (const auto* options = std::get_if<TableHandle>(value)) extra = *options;
    else reader.add_problem("options: expected a table of options of sbatch, not " + std::string(type_text(*value)));
  }
  std::vector<std::string> words = {slurm.partition, slurm.time};
  if (extra)
    for (std::string& word : sbatch_words(*extra, reader)) words.push_back(std::move(word));
  if (std::any_of(words.begin(), words.end(), has_control_characters))
    reader.add_problem("options of sbatch must not contain line breaks or control characters");
  reader.finish();
  return runner_table("slurm", schema, extra);
}

ScriptValue range_verb(const ScriptCall& call) {
  if (call.arguments.size() < 2 || call.arguments.size() > 3) reject(call, "takes first value, last value and step", std::string(k_range_usage));
  return range_of(call.arguments[0], call.arguments[1], call.arguments.size() == 3 ? call.arguments[2] : ScriptValue{});
}

ScriptValue zip_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_zip_usage);
  try {
    return zipped(table);
  } catch (const Error& error) {
    reject(call, error.info().problem, error.info().hint);
  }
}

// ---- series --------------------------------------------------------------------------------------------------------------------------------

void read_name(const std::vector<ScriptValue>& items, SeriesPlan& plan, TableReader& reader) {
  const auto* name = items.size() == 1 ? std::get_if<std::string>(&items.front()) : nullptr;
  if (!name) reader.add_problem("needs a name as the first entry: series{ \"polar\", ... }");
  else if (!is_safe_name(*name))
    reader.add_problem("\"" + *name + "\" is not a valid name: the name of the series and its folder has letters, digits and . + - _ = only");
  else plan.name = *name;
  plan.folder = plan.name;
}

void read_over(TableReader& reader, SeriesPlan& plan) {
  const ScriptValue* value = reader.field("over");
  const auto* over = value ? std::get_if<TableHandle>(value) : nullptr;
  if (!over) {
    reader.add_problem(value ? "over: expected a table, not " + std::string(type_text(*value))
                             : "over is missing: over = { alpha = range(-4, 12, 2), beta = {0, 5} }");
    return;
  }
  try {
    plan.cases = cases_of(**over);
  } catch (const Error& error) {
    reader.add_problem("over: " + error.info().problem + (error.info().hint.empty() ? "" : " (" + error.info().hint + ")"));
    return;
  }
  for (const SeriesCase& c : plan.cases)
    if (std::find(k_reserved.begin(), k_reserved.end(), c.name) != k_reserved.end())
      reader.add_problem("over: the name of a case is reserved: \"" + c.name + "\"");
}

void read_run(TableReader& reader, SeriesPlan& plan) {
  const ScriptValue* value = reader.field("run");
  if (!value) return;
  const auto* table = std::get_if<TableHandle>(value);
  const auto* kind = table && (*table)->fields.contains("runner") ? std::get_if<std::string>(&(*table)->fields.at("runner")) : nullptr;
  if (!kind) {
    reader.add_problem("run: expected jobs{ 2 } or slurm{ partition = \"cfd\" }, not " + std::string(type_text(*value)));
    return;
  }
  plan.is_slurm = *kind == "slurm";
  ScriptTable named = **table;
  named.fields.erase("runner");
  TableReader entries(named, "run");
  if (plan.is_slurm) {
    entries.read_options(sterna::options_of(plan.slurm));
    const ScriptValue* extra = entries.field("options");
    if (const auto* options = extra ? std::get_if<TableHandle>(extra) : nullptr) plan.sbatch_words = sbatch_words(**options, entries);
  } else {
    entries.read_options(sterna::options_of(plan.jobs));
  }
  entries.finish();
}

/// Returns true if the case has all these parameters with these values.
bool has_all(const SeriesCase& c, const ScriptTable& requested) {
  return std::all_of(requested.fields.begin(), requested.fields.end(), [&](const auto& entry) {
    const auto it = c.parameters.fields.find(entry.first);
    return it != c.parameters.fields.end() && to_json(it->second) == to_json(entry.second);
  });
}

void read_reference(TableReader& reader, SeriesPlan& plan) {
  const ScriptValue* value = reader.field("reference");
  if (!value || plan.cases.empty()) return;
  const auto* requested = std::get_if<TableHandle>(value);
  if (!requested || (*requested)->fields.empty() || !(*requested)->items.empty()) {
    reader.add_problem("reference: expected the parameters of a case, e.g. { alpha = 0, beta = 0 }, not " + std::string(type_text(*value)));
    return;
  }
  std::size_t n = 0;
  for (std::size_t i = 0; i < plan.cases.size(); ++i) {
    if (!has_all(plan.cases[i], **requested)) continue;
    plan.reference = i;
    ++n;
  }
  if (n != 1)
    reader.add_problem("reference: " + std::string(n == 0 ? "no case has" : std::to_string(n) + " cases have") + " these parameters: " + to_json(*value));
}

void read_cache(TableReader& reader, SeriesPlan& plan) {
  plan.cache = plan.name + ".cache";
  const ScriptValue* value = reader.field("cache");
  if (!value) return;
  if (const auto* folder = std::get_if<std::string>(value); folder && !folder->empty()) plan.cache = *folder;
  else if (const auto* flag = std::get_if<bool>(value)) plan.cache = *flag ? plan.cache : std::filesystem::path();
  else reader.add_problem("cache: expected true, false or the name of a folder, not " + std::string(type_text(*value)));
}

}  // namespace

OptionTable options_of_series(SeriesOptions& options) { return sterna::options_of(options); }

namespace {

ScriptValue series_verb(const ScriptCall& call) {
  const ScriptTable table = table_argument(call, 0, k_series_usage);
  SeriesPlan plan;
  Attempt attempted = call.attempted();
  attempted.ends_with_checks = false;  // the function of the cases is also checked
  TableReader reader(table, attempted);
  read_name(reader.items(), plan, reader);
  read_over(reader, plan);
  read_run(reader, plan);
  read_reference(reader, plan);
  read_cache(reader, plan);
  if (const ScriptValue* value = reader.field("case"); value && std::holds_alternative<FunctionHandle>(*value))
    plan.function = std::get<FunctionHandle>(*value);
  else reader.add_problem(value ? "case: expected a function, not " + std::string(type_text(*value)) : "case is missing: case = function(p) ... end");
  const OptionTable schema = options_of_series(plan.options);
  reader.read_options(schema);
  reader.finish();
  apply_overrides(call, schema);
  if (const std::filesystem::path& program = call.session.series.settings.program; !program.empty()) plan.program_hash = hash_file(program);
  return run_series(call, plan);
}

template <class Options>
std::string help_of() {
  Options options;
  return options_help(sterna::options_of(options));
}

constexpr std::array<ScriptVerb, 5> k_series_verbs = {{
    {"series", k_series_usage,
     "Runs a function for many cases, each in a separate process and folder; can be resumed, and ends with a table. First entry: name; over: values of "
     "parameters, by name; case: function of the parameters; run: jobs{} or slurm{}; reference: parameters of the case from which the others start; cache: "
     "false, or a folder.",
     series_verb, help_of<SeriesOptions>, true, "table"},
    {"jobs", k_jobs_usage, "Runs the cases of a series in processes on this machine, the given number at the same time.", jobs_verb, help_of<JobsOptions>,
     false, "table"},
    {"slurm", k_slurm_usage, "Runs the cases of a series as jobs of a Slurm cluster.", slurm_verb, help_of<SlurmOptions>, false, "table"},
    {"range", k_range_usage, "Returns a list of numbers from the first to the last value with a step, 1 by default.", range_verb, nullptr, false, "table"},
    {"zip", k_zip_usage, "Combines lists to a list of cases: a case with all first values, a case with all second values, and so on.", zip_verb, nullptr, false,
     "table"},
}};

}  // namespace

std::span<const ScriptVerb> series_verbs() { return k_series_verbs; }

}  // namespace sterna::scripting
