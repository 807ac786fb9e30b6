// Functions shared by the bodies of verbs: reading their arguments, file names, fields of objects.
#pragma once

#include <filesystem>
#include <initializer_list>
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

/// \throws Error(bad_argument) with the location of the call
[[noreturn]] void reject(const ScriptCall& call, std::string problem, std::string hint = {});

/// Returns the table of a call verb{...}. If the argument is a single string, as in read_surface "a.stl", it becomes the first entry.
ScriptTable table_argument(const ScriptCall& call, std::size_t index, std::string_view usage);

/// Returns the object of a method or field.
template <class Handle>
const Handle& self(const ScriptCall& call) {
  if (!call.arguments.empty())
    if (const auto* handle = std::get_if<Handle>(&call.arguments.front())) return *handle;
  reject(call, "is a method", "call it with a colon: object:" + std::string(call.verb.substr(call.verb.find(':') + 1)) + "(...)");
}

/// Finds an input file: relative names are searched in the current folder first, then beside the script.
InputPath find_input(const ScriptCall& call, const std::string& name);
/// Returns the path to write a file of this name: relative names go to the session's output folder, where missing subfolders are created. A case can read back
/// its own files by the same name.
std::filesystem::path output_path(const ScriptCall& call, const std::string& name);
/// Returns the path of the output file that an entry of the table names; empty if there is no such entry. Notes problems. \param expected "the name of a .vtu
/// file"
std::filesystem::path output_entry(TableReader& reader, const ScriptCall& call, const std::string& name, std::string_view expected);
/// Checks that files can be written, before long work. Empty paths are left out. \throws Error(write_failed)
void require_writable(std::initializer_list<std::filesystem::path> files);
/// Returns the unnamed entries of a table as names of input files; notes problems.
std::vector<InputPath> file_names(const ScriptCall& call, TableReader& reader);
/// Returns the names after the object in mesh:write("a.su2", "b.vtu") or mesh:write{...}; a table may also contain the options of the schema.
std::vector<std::filesystem::path> output_names(const ScriptCall& call, const OptionTable& schema = {});

/// Applies the command line's --set values to these options; they win over the script.
void apply_overrides(const ScriptCall& call, const OptionTable& options);

using Fields = std::vector<std::pair<std::string, ScriptValue>>;
/// Returns the value of object.name among the fields; a wrong name is an error with a suggestion.
ScriptValue select_field(const ScriptCall& call, Fields fields, std::span<const ScriptVerb> methods);

}  // namespace sterna::scripting
