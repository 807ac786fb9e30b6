// The arguments of a command as data, and the words that the user gives for them.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scripting/lua/held_options.h"
#include "scripting/lua/script_call.h"

namespace CLI {
class App;
}

namespace sterna::scripting {

/// Entries of --patch "wing*:max_edge=0.1,curvature_angle=8": pattern of names, options. If two patterns match, the one with more letters applies.
using PatchEntries = std::vector<std::pair<std::string, OptionOverrides>>;

/// The command line of one command. The key of an argument is its name without dashes: "output" for -o,--output.
struct CommandLine {
  std::map<std::string, std::vector<std::string>, std::less<>> words;
  std::map<std::string, bool, std::less<>> flags;
  std::map<std::string, PatchEntries, std::less<>> patches;
  OptionOverrides options;            ///< --layers 30 as {"layers", "30"}, then assignments of --set
  OptionOverrides set;                ///< assignments of --set
  OptionOverrides arguments;          ///< assignments NAME=VALUE for a script
  std::filesystem::path cache;        ///< --cache; empty: no cache
  std::optional<double> cache_limit;  ///< --cache-limit, bytes
  std::vector<std::string> given;     ///< names of the given options: "--json"

  const std::vector<std::string>& all(std::string_view key) const;
  /// Returns the word of an argument with one value; empty if it is not given.
  std::string word(std::string_view key) const { return all(key).empty() ? std::string() : all(key).front(); }
  bool flag(std::string_view key) const { return flags.contains(key) && flags.find(key)->second; }
  const PatchEntries& patches_of(std::string_view key) const;
};

/// One argument of a command, or a group of options, in the order of its help.
struct CommandArgument {
  enum class Takes { one, several, flag, whole, options, unit, set, cache, patches, other };
  Takes takes = Takes::one;
  std::string name;  ///< "-o,--output"; without dashes: a positional argument
  std::string help;  ///< for options of schemas: a note on the title of their group
  std::string type = {};
  bool is_required = false;
  bool is_hidden = false;
  bool is_set = false;                             ///< default of a flag
  int most = 0;                                    ///< largest whole number; 0: any positive number
  HeldOptions options = {};                        ///< options of schemas
  void (*add)(CLI::App&, CommandLine&) = nullptr;  ///< adds an argument of another form
};

/// Rows of the table of commands are made of these.
namespace argument {

CommandArgument file(std::string name, std::string help);   ///< positional, required
CommandArgument files(std::string name, std::string help);  ///< positional, required, one or more
CommandArgument output(std::string help);                   ///< -o,--output
CommandArgument outputs(std::string help);                  ///< -o,--output, may be given several times
CommandArgument text(std::string name, std::string help, std::string type = {});
CommandArgument texts(std::string name, std::string help, std::string type);  ///< may be given several times
CommandArgument flag(std::string name, std::string help, bool is_set = false);
CommandArgument whole(std::string name, std::string help, int most = 0, std::string type = {});
CommandArgument hidden(std::string name);  ///< not listed in the help
CommandArgument options(HeldOptions options, std::string note = {});
CommandArgument unit(std::string help);        ///< --unit, an option of another verb of the command
CommandArgument set();                         ///< --set STAGE.OPTION=VALUE
CommandArgument cache(std::string help = {});  ///< --cache, --cache-limit; with a help text, the limit also applies without --cache
CommandArgument patches(std::string help, std::string name = "--patch");
CommandArgument other(void (*add)(CLI::App&, CommandLine&));

}  // namespace argument

/// Adds the arguments to a command. `line` must outlive the command.
void add_arguments(CLI::App& command, const std::vector<CommandArgument>& arguments, CommandLine& line);
/// Completes the line of the command that the user has chosen: options of --set come after the others.
void complete_line(const CLI::App& command, CommandLine& line);

}  // namespace sterna::scripting
