// Functions that the bridge to Lua needs from the folders above it. The interpreter sets them, and they are stored in a session.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "geom/base/schema.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

struct FieldDoc {
  std::string_view name;
  std::string_view help;  ///< description with unit; "if ..." if the field is not always present
};

struct ObjectKind {
  std::string_view name;     ///< "surface", the prefix of the names of its methods
  const char* type;          ///< key of its metatable
  std::string_view summary;  ///< one sentence
  const ScriptVerb* field;   ///< verb that reads object.name for names that are no method
  std::span<const ScriptVerb> (*methods)();
  std::span<const FieldDoc> fields;
};

struct ScriptHooks {
  std::span<const ObjectKind> (*kinds)();                                      ///< kinds of all objects
  const ScriptVerb* describe;                                                  ///< tostring() of all objects of sterna
  ScriptValue (*run)(const ScriptVerb& verb, const ScriptCall& call);          ///< runs the verb, or takes its result from the cache; models get their key
  ScriptValue (*placeholder)(const ScriptCall& call, std::string_view gives);  ///< see placeholder() of script_check.h
  void (*set_option)(const Option& option, std::string_view text);             ///< sets an option from a text as users type it on the command line
  std::string (*hint_for_global)(std::string_view name);                       ///< suggestion for an unknown global; empty: no name is near
};

}  // namespace sterna::scripting
