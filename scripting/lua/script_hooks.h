// What the bridge to Lua needs of the folders above it: a session holds it, and the interpreter fills it in.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "geom/base/schema.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

struct FieldDoc {
  std::string_view name;
  std::string_view help;  ///< with its unit; "if ..." where it is not always there
};

struct ObjectKind {
  std::string_view name;     ///< "surface", in front of the names of its methods
  const char* type;          ///< key of its metatable
  std::string_view summary;  ///< one sentence
  const ScriptVerb* field;   ///< object.name for names that are no method
  std::span<const ScriptVerb> (*methods)();
  std::span<const FieldDoc> fields;
};

struct ScriptHooks {
  std::span<const ObjectKind> (*kinds)();                                   ///< of all objects
  const ScriptVerb* describe;                                               ///< tostring() of any object of ours
  ScriptValue (*run)(const ScriptVerb& verb, const ScriptCall& call);       ///< the verb, or the same result from the cache; models know what they were made of
  ScriptValue (*stand_in)(const ScriptCall& call, std::string_view gives);  ///< see stand_in() of script_check.h
  void (*set_option)(const Option& option, std::string_view text);          ///< as users type it on the command line
  std::string (*hint_for_global)(std::string_view name);                    ///< what to try instead of a global that is not there; empty: nothing is near
};

}  // namespace sterna::scripting
