// What help() and the manual know of verbs and objects: all of it is read off the tables of verbs and objects, so that it cannot be stale.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scripting/interpreter/script_objects.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// One option of a verb, read from what its options_help() prints.
struct OptionDoc {
  std::string name;
  std::string value;  ///< default with unit: "0.5", "20 deg", "automatic (0.1 body lengths) [m]", "required [m]"
  std::string range;  ///< "1 .. 1000", "one of a, b"; may be empty
  std::string help;
};
/// The options in a verb's help in their order, under the line of text that stands before them (empty: none).
struct OptionGroup {
  std::string title;
  std::vector<OptionDoc> options;
};
std::vector<OptionGroup> option_groups(const ScriptVerb& verb);
/// Names of all options of a verb, each once, in order.
std::vector<std::string> option_names(const ScriptVerb& verb);

/// Global verbs and the methods of all kinds of objects.
std::vector<const ScriptVerb*> all_verbs();
/// "volume_mesh", "mesh:check" or "check"; null where there is none.
const ScriptVerb* find_verb(std::string_view name);
/// The examples of a usage line, which are separated by "  or  ".
std::vector<std::string> examples_of(const ScriptVerb& verb);

/// What help() prints of each.
std::string help_text(const ScriptVerb& verb);
std::string help_text(const ObjectKind& kind);
/// All verbs with one sentence each.
std::string help_text();

/// Of a verb, an object or an option by its name; empty where there is none.
std::string help_if_known(const std::string& name);
/// The same.
/// \throws Error(bad_argument) with the nearest name where there is none
std::string help_on_name(const std::string& name, const std::string& attempted);

/// The verb help.
ScriptValue print_help(const ScriptCall& call);

}  // namespace sterna::scripting
