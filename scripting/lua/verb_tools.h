// What the bodies of verbs share: reading their arguments, file names, fields of objects.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geom/base/error.h"
#include "scripting/lua/input_path.h"
#include "scripting/lua/script_call.h"
#include "scripting/lua/table_reader.h"

namespace sterna::scripting {

/// Throws Error(bad_argument) at the call's place.
[[noreturn]] void reject(const ScriptCall& call, std::string problem, std::string hint = {});

/// The table of a call of the form verb{...}; a single text, as in read_surface "a.stl", counts as its first entry.
ScriptTable table_argument(const ScriptCall& call, std::size_t index, std::string_view usage);

/// The object of a method or field.
template <class Handle>
const Handle& self(const ScriptCall& call) {
  if (!call.arguments.empty())
    if (const auto* handle = std::get_if<Handle>(&call.arguments.front())) return *handle;
  reject(call, "is a method", "call it with a colon: object:" + std::string(call.verb.substr(call.verb.find(':') + 1)) + "(...)");
}

/// Relative names are looked for in the current folder first, then beside the script.
InputPath find_input(const ScriptCall& call, const std::string& name);
/// Where a file of this name is written: relative names go to the session's output folder, below which missing folders are made. What a case has written it can
/// read back by the same name.
std::filesystem::path output_path(const ScriptCall& call, const std::string& name);
/// The unnamed entries of a table as names of input files; notes problems.
std::vector<InputPath> file_names(const ScriptCall& call, TableReader& reader);
/// mesh:write("a.su2", "b.vtu") or mesh:write{...}: the names after the object; in a table also the options of the schema.
std::vector<std::filesystem::path> output_names(const ScriptCall& call, const OptionTable& schema = {});

/// The command line's --set values for these options; they win over the script.
void apply_overrides(const ScriptCall& call, const OptionTable& options);

using Fields = std::vector<std::pair<std::string, ScriptValue>>;
/// The value of object.name among the fields; a wrong name is an error with a suggestion.
ScriptValue select_field(const ScriptCall& call, Fields fields, std::span<const ScriptVerb> methods);

}  // namespace sterna::scripting
