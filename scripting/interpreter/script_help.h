// Contents of help(), and of the manual on verbs and objects. All of it is generated from the tables of verbs and objects, so that it is always up to date.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scripting/interpreter/script_objects.h"
#include "scripting/lua/script_call.h"

namespace sterna::scripting {

/// One option of a verb, parsed from the output of its options_help().
struct OptionDoc {
  std::string name;
  std::string value;  ///< default with unit: "0.5", "20 deg", "automatic (0.1 body lengths) [m]", "required [m]"
  std::string range;  ///< "1 .. 1000", "one of a, b"; may be empty
  std::string help;
};
/// The options in a verb's help in their order, with the line of text above them (empty: none).
struct OptionGroup {
  std::string title;
  std::vector<OptionDoc> options;
};
std::vector<OptionGroup> option_groups(const ScriptVerb& verb);
/// Returns the names of all options of a verb, each once, in order.
std::vector<std::string> option_names(const ScriptVerb& verb);

/// Returns the global verbs and the methods of all kinds of objects.
std::vector<const ScriptVerb*> all_verbs();
/// Finds "volume_mesh", "mesh:check" or "check"; null if there is none.
const ScriptVerb* find_verb(std::string_view name);
/// Returns the examples of a usage line, which are separated by "  or  ".
std::vector<std::string> examples_of(const ScriptVerb& verb);

/// Return the output of help() for a verb or a kind of object.
std::string help_text(const ScriptVerb& verb);
std::string help_text(const ObjectKind& kind);
/// Returns all verbs with one sentence each.
std::string help_text();

/// Returns the help on a verb, an object or an option by its name; empty if there is none.
std::string help_if_known(const std::string& name);
/// The same, but an unknown name is an error.
/// \throws Error(bad_argument) with the nearest name if there is none
std::string help_on_name(const std::string& name, const std::string& attempted);

/// Runs the verb help.
ScriptValue print_help(const ScriptCall& call);

}  // namespace sterna::scripting
