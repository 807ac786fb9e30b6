// Checks a script without meshing. Every verb reads its table; heavy verbs end there and return a placeholder for their result. A mistake is noted, and the
// script continues with a placeholder, so that one check finds many mistakes.
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
  std::set<std::filesystem::path> outputs;                       ///< files that the script would have written; later verbs may read them
  std::map<std::string, ScriptValue, std::less<>> placeholders;  ///< placeholders by kind of object; created on first use
  bool makes_geometry = false;                                   ///< models, and surfaces of files, are made as in a run; meshes are not made, and nothing is
                                                                 ///< written
};

/// Returns true if a heavy verb is executed although the run only checks: the run makes geometry, and no argument is a placeholder.
bool is_geometry_made(const ScriptCall& call, const ScriptVerb& verb);

/// Thrown when a verb has completed its checks and the run only checks. Not an error.
struct ChecksDone {};

/// Ends a verb that has nothing more to check if the run only checks. To be called before work and before writing. Verbs with is_heavy end in
/// TableReader::finish().
void finish_checks(const ScriptCall& call);

/// Returns a placeholder for the result of the verb, of the kind ScriptVerb::gives; nil if that is empty.
ScriptValue placeholder(const ScriptCall& call, std::string_view gives);
/// Returns true if the value is a placeholder, so that its names and numbers are meaningless.
bool is_placeholder(const ScriptCall& call, const ScriptValue& value);

/// Notes a file that is written; a later verb may read it.
void note_output(const ScriptCall& call, const std::filesystem::path& path);
/// Checks an input file of a heavy verb if the run only checks (light verbs read their files).
/// \throws Error(file_not_found) for a missing file that would not have been written before.
void check_input(const ScriptCall& call, const InputPath& file);

}  // namespace sterna::scripting
