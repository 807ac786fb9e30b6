#include "scripting/lua/script_check.h"

#include <algorithm>
#include <array>

#include "geom/base/error.h"
#include "scripting/lua/input_path.h"
#include "scripting/lua/script_hooks.h"

namespace sterna::scripting {

void finish_checks(const ScriptCall& call) {
  if (call.session.check && !call.is_geometry) throw ChecksDone{};
}

bool is_geometry_made(const ScriptCall& call, const ScriptVerb& verb) {
  constexpr std::array<std::string_view, 5> k_others = {"read_surface", "surface:move", "surface:rotate", "model:measures", "model:info"};
  if (!call.session.check || !call.session.check->makes_geometry) return false;
  const bool is_geometry = verb.gives == "model" || verb.gives == "model or surface" || std::ranges::find(k_others, verb.name) != k_others.end();
  if (!is_geometry) return false;
  const auto stands_for_another = [&](const ScriptValue& value) { return is_unknown(value) || is_placeholder(call, value); };
  return std::ranges::none_of(call.arguments, [&](const ScriptValue& argument) {
    const auto* table = std::get_if<TableHandle>(&argument);
    return stands_for_another(argument) || (table && *table && std::ranges::any_of((*table)->items, stands_for_another));
  });
}

ScriptValue placeholder(const ScriptCall& call, std::string_view gives) { return call.session.hooks->placeholder(call, gives); }

bool is_placeholder(const ScriptCall& call, const ScriptValue& value) {
  if (!call.session.check) return false;
  const auto made = call.session.check->placeholders.find(object_name(value));
  return made != call.session.check->placeholders.end() && is_same_object(made->second, value);
}

void note_output(const ScriptCall& call, const std::filesystem::path& path) {
  if (call.session.check) call.session.check->outputs.insert(path.lexically_normal());
}

void check_input(const ScriptCall& call, const InputPath& file) {
  if (!call.session.check || !call.is_heavy || call.session.check->outputs.contains(file.path.lexically_normal())) return;
  std::error_code ignored;  // a path that cannot be accessed counts as missing
  if (std::filesystem::exists(file.path, ignored)) return;
  throw Error({.code = ErrorCode::file_not_found,
               .attempted = call.attempted(),
               .problem = "there is no file " + file.name,
               .hint = "files are searched in the current folder, then beside the script"});
}

}  // namespace sterna::scripting
