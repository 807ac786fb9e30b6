// The kinds of objects that scripts hold: one table of their names, methods and fields, from which metatables, help(), the manual and completion are made.
#pragma once

#include <span>
#include <string_view>

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

std::span<const ObjectKind> object_kinds();
/// The kind of that name, or null.
const ObjectKind* object_kind(std::string_view name);
/// The kind of a value, or null where it is a number, a text, a table or a function.
const ObjectKind* kind_of(const ScriptValue& value);

}  // namespace sterna::scripting
