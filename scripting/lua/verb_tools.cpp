#include "scripting/lua/verb_tools.h"

#include "io/output/atomic_file.h"
#include "scripting/lua/script_check.h"
#include "scripting/lua/script_hooks.h"

namespace sterna::scripting {

void reject(const ScriptCall& call, std::string problem, std::string hint) {
  throw Error({.code = ErrorCode::bad_argument, .attempted = call.attempted(), .problem = std::move(problem), .hint = std::move(hint)});
}

ScriptTable table_argument(const ScriptCall& call, std::size_t index, std::string_view usage) {
  if (call.arguments.size() > index + 1) reject(call, "takes one table, not several arguments", std::string(usage));
  if (call.arguments.size() <= index) return {};
  const ScriptValue& argument = call.arguments[index];
  if (const auto* table = std::get_if<TableHandle>(&argument)) return **table;
  ScriptTable table;
  if (!std::holds_alternative<std::monostate>(argument)) table.items.push_back(argument);
  return table;
}

InputPath find_input(const ScriptCall& call, const std::string& name) {
  const std::filesystem::path path = name;
  if (const std::filesystem::path own = (call.session.output_folder / path).lexically_normal(); call.session.series.written.contains(own)) return {name, own};
  std::error_code ignored;  // a name that cannot be accessed is reported by the reader, with the reason
  if (path.is_relative() && !std::filesystem::exists(path, ignored))
    for (const std::filesystem::path& folder : {call.session.input_folder, call.session.script.parent_path()})
      if (!folder.empty() && std::filesystem::exists(folder / path, ignored)) {
        note_input(call.session.series, folder / path);
        return {name, folder / path};
      }
  note_input(call.session.series, path);
  check_input(call, {name, path});
  return {name, path};
}

std::filesystem::path output_path(const ScriptCall& call, const std::string& name) {
  const std::filesystem::path& folder = call.session.output_folder;
  if (folder.empty()) return name;
  const std::filesystem::path path = (folder / name).lexically_normal();
  if (std::filesystem::path(name).is_relative()) {
    std::error_code failure;  // the writer reports why the folder does not exist
    std::filesystem::create_directories(path.parent_path(), failure);
    call.session.series.written.insert(path);
  }
  return path;
}

std::filesystem::path output_entry(TableReader& reader, const ScriptCall& call, const std::string& name, std::string_view expected) {
  const ScriptValue* value = reader.field(name);
  if (!value) return {};
  if (const auto* file = std::get_if<std::string>(value)) return output_path(call, *file);
  reader.add_problem(name + ": expected " + std::string(expected) + ", not " + std::string(type_text(*value)));
  return {};
}

void require_writable(std::initializer_list<std::filesystem::path> files) {
  for (const std::filesystem::path& file : files)
    if (!file.empty()) const io::AtomicFile probe(file);
}

std::vector<InputPath> file_names(const ScriptCall& call, TableReader& reader) {
  std::vector<InputPath> files;
  std::size_t number = 0;
  for (const ScriptValue& item : reader.items()) {
    ++number;
    if (const auto* name = std::get_if<std::string>(&item)) files.push_back(find_input(call, *name));
    else reader.add_problem("entry " + std::to_string(number) + ": expected a file name, not " + std::string(type_text(item)));
  }
  if (number == 0) reader.add_problem("needs a file name");
  return files;
}

std::vector<std::filesystem::path> output_names(const ScriptCall& call, const OptionTable& schema) {
  std::vector<std::filesystem::path> names;
  const auto add = [&](const ScriptValue& value) {
    if (const auto* name = std::get_if<std::string>(&value)) names.push_back(output_path(call, *name));
    else reject(call, "expected file names, not " + std::string(type_text(value)));
  };
  for (std::size_t i = 1; i < call.arguments.size(); ++i) {
    const auto* table = std::get_if<TableHandle>(&call.arguments[i]);
    if (!table) add(call.arguments[i]);
    else {
      if (schema.empty() && !(*table)->fields.empty()) reject(call, "takes file names only, no options (\"" + (*table)->fields.begin()->first + "\")");
      TableReader reader(**table, call.attempted());
      for (const ScriptValue& item : reader.items()) add(item);
      reader.read_options(schema);
      reader.finish();
    }
  }
  if (names.empty()) reject(call, "needs at least one file name");
  for (const auto& name : names) note_output(call, name);
  return names;
}

void apply_overrides(const ScriptCall& call, const OptionTable& options) {
  for (const auto& [name, text] : call.session.overrides)
    for (const Option& option : options)
      if (name == option.name || name == std::string(option.stage) + "." + std::string(option.name)) call.session.hooks->set_option(option, text);
}

ScriptValue select_field(const ScriptCall& call, Fields fields, std::span<const ScriptVerb> methods) {
  const auto* name = call.arguments.size() < 2 ? nullptr : std::get_if<std::string>(&call.arguments[1]);
  std::vector<std::string> known;
  for (auto& [field, value] : fields) {
    if (name && field == *name) return std::move(value);
    known.push_back(field);
  }
  for (const ScriptVerb& method : methods) known.emplace_back(method.name.substr(method.name.find(':') + 1));
  const std::string nearest = name ? nearest_name(*name, known) : "";
  std::string all;
  for (const std::string& other : known) all += (all.empty() ? "" : ", ") + other;
  throw Error({.code = ErrorCode::unknown_option,
               .attempted = call.attempted(),
               .problem = name ? "there is no \"" + *name + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?")
                               : "the name of a field must be a string",
               .hint = all});
}

}  // namespace sterna::scripting
