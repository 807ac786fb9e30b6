#include "scripting/lua/script_check.h"

#include "geom/base/error.h"
#include "scripting/lua/input_path.h"
#include "scripting/lua/script_hooks.h"

namespace sterna::scripting {
namespace {

/// Whether both are the same object, not only equal ones.
bool is_same(const ScriptValue& a, const ScriptValue& b) {
  return std::visit(
      [&](const auto& of_a) {
        using V = std::decay_t<decltype(of_a)>;
        if constexpr (requires { of_a.use_count(); }) {
          const auto* of_b = std::get_if<V>(&b);
          return of_b && *of_b == of_a;
        } else {
          return false;
        }
      },
      a);
}

}  // namespace

void finish_checks(const ScriptCall& call) {
  if (call.session.check) throw ChecksDone{};
}

ScriptValue stand_in(const ScriptCall& call, std::string_view gives) { return call.session.hooks->stand_in(call, gives); }

bool is_stand_in(const ScriptCall& call, const ScriptValue& value) {
  if (!call.session.check) return false;
  const auto made = call.session.check->stand_ins.find(object_name(value));
  return made != call.session.check->stand_ins.end() && is_same(made->second, value);
}

void note_output(const ScriptCall& call, const std::filesystem::path& path) {
  if (call.session.check) call.session.check->outputs.insert(path.lexically_normal());
}

void check_input(const ScriptCall& call, const InputPath& file) {
  if (!call.session.check || !call.is_heavy || call.session.check->outputs.contains(file.path.lexically_normal())) return;
  std::error_code ignored;  // what cannot be looked up is not there
  if (std::filesystem::exists(file.path, ignored)) return;
  throw Error({.code = ErrorCode::file_not_found,
               .attempted = call.attempted(),
               .problem = "there is no file " + file.name,
               .hint = "files are looked for in the current folder, then beside the script"});
}

}  // namespace sterna::scripting
