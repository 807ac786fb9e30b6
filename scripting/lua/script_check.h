// Checking a script without meshing: every verb reads its table, the heavy ones end there and give an object that stands for what they would have made. A
// mistake is noted, and the script goes on with such an object, so that one check finds many.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "geom/base/schema.h"
#include "scripting/lua/input_path.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// An option that a verb's table has set.
struct OptionSet {
  std::string attempted;  ///< "case.lua:5: volume_mesh"
  std::string option;     ///< "envelope.layers"
  OptionValue value;
};

struct ScriptCheck {
  std::vector<ErrorHandle> problems;  ///< in the order of the script
  std::vector<OptionSet> options;
  std::set<std::filesystem::path> outputs;                    ///< that the script would have written: later verbs may read them
  std::map<std::string, ScriptValue, std::less<>> stand_ins;  ///< by kind of object; made when first asked for
  bool makes_geometry = false;                                ///< models and surfaces of files are made, as in a run; meshes are not, nothing is written
};

/// Whether a heavy verb is done although the run only checks: it makes geometry, and of nothing that only stands for something.
bool is_geometry_made(const ScriptCall& call, const ScriptVerb& verb);

/// Thrown where a verb has checked everything and the run only checks. No error.
struct ChecksDone {};

/// Ends a verb that has nothing more to check, where the run only checks: before work, before writing. Verbs with is_heavy end in TableReader::finish().
void finish_checks(const ScriptCall& call);

/// What the verb would have given, as ScriptVerb::gives says; nil where it says nothing.
ScriptValue stand_in(const ScriptCall& call, std::string_view gives);
/// Whether the value stands for another one, so that its names and numbers say nothing.
bool is_stand_in(const ScriptCall& call, const ScriptValue& value);

/// Notes a file that is written; a later verb may read it.
void note_output(const ScriptCall& call, const std::filesystem::path& path);
/// Of a heavy verb, where the run only checks (light ones read their files):
/// \throws Error(file_not_found) for a file that is not there and would not have been written before.
void check_input(const ScriptCall& call, const InputPath& file);

}  // namespace sterna::scripting
