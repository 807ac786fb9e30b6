#include "scripting/command/command_line.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <sstream>

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

using Texts = std::vector<std::string>;

/// Returns "output" for "-o,--output" and "surface" for "surface".
std::string key_of_argument(const std::string& name) {
  const std::size_t at = name.find("--");
  return at == std::string::npos ? name : name.substr(at + 2, name.find(',', at) == std::string::npos ? std::string::npos : name.find(',', at) - at - 2);
}

std::string kebab(std::string_view name) {
  std::string text(name);
  std::replace(text.begin(), text.end(), '_', '-');
  return text;
}

/// Returns "NUMBER[deg]": the unit is that of a number given without one.
std::string type_name(const Option& option) {
  if (option.kind == OptionKind::boolean) return "[true|false]";
  if (option.kind == OptionKind::string) return "TEXT";
  if (option.unit == Unit::none) return "NUMBER";
  return "NUMBER[" + std::string(option.unit == Unit::radian ? "deg" : to_string(option.unit)) + "]";
}

/// Splits "stage.option=value" into name and value.
std::pair<std::string, std::string> split_assignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) throw CLI::ValidationError("--set", "\"" + text + "\" is not stage.option=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// Adds an option that may be given several times, each time with one value.
template <class Take>
CLI::Option* add_repeated(CLI::App& command, const std::string& name, const std::string& help, const std::string& type, Take take) {
  return command
      .add_option_function<Texts>(
          name,
          [take](const Texts& texts) {
            for (const std::string& text : texts) take(text);
          },
          help)
      ->type_name(type)
      ->allow_extra_args(false)
      ->take_all();
}

/// Adds one --kebab-name for each option of the schema, grouped by stage.
void add_schema_options(CLI::App& command, const OptionTable& table, OptionOverrides& overrides, const std::string& note) {
  for (const Option& option : table) {
    const std::string name(option.name);
    std::string help = std::string(option.help) + "; " + option.default_text();
    if (const std::string range = option.range_text(); !range.empty()) help += "; " + range;
    // If the option is given twice, both values are kept, and set_options refuses them if they differ.
    const bool is_boolean = option.kind == OptionKind::boolean;
    CLI::Option* added = add_repeated(command, "--" + kebab(name), help, type_name(option), [&overrides, name, is_boolean](const std::string& text) {
      overrides.emplace_back(name, is_boolean && text.empty() ? "true" : text);
    });
    added->group("Options of stage " + std::string(option.stage) + (note.empty() ? "" : ", " + note));
    if (is_boolean) added->expected(0, 1);
  }
}

void add_patch_option(CLI::App& command, const std::string& name, const std::string& help, PatchEntries& patches) {
  add_repeated(command, name, help, "NAMES:OPTION=VALUE,...", [&patches, name](const std::string& text) {
    const std::size_t equals = text.find('='), colon = text.rfind(':', equals);
    if (equals == std::string::npos || colon == std::string::npos || colon == 0)
      throw CLI::ValidationError(name, "\"" + text + "\" is not NAMES:OPTION=VALUE,OPTION=VALUE");
    auto& [names, options] = patches.emplace_back(text.substr(0, colon), OptionOverrides{});
    std::istringstream list(text.substr(colon + 1));
    for (std::string entry; std::getline(list, entry, ',');) {
      const std::size_t at = entry.find('=');
      if (at == std::string::npos || at == 0) throw CLI::ValidationError(name, "\"" + entry + "\" is not OPTION=VALUE");
      options.emplace_back(entry.substr(0, at), entry.substr(at + 1));
    }
  });
}

void add_set_option(CLI::App& command, OptionOverrides& overrides) {
  add_repeated(command, "--set", "any option of any stage, e.g. --set envelope.layers=24", "STAGE.OPTION=VALUE",
               [&overrides](const std::string& text) { overrides.push_back(split_assignment(text)); });
}

/// \param help of --cache, for a command that also has a cache without --cache
void add_cache_options(CLI::App& command, const std::string& help, CommandLine& line) {
  constexpr const char* k_help = "store results of stages in this folder and reuse them if all their inputs are unchanged; the output is the same";
  command.add_option("--cache", line.cache, help.empty() ? k_help : help)->type_name("FOLDER");
  CLI::Option* limit = command.add_option_function<double>(
      "--cache-limit", [&line](double bytes) { line.cache_limit = bytes; },
      "largest size of that folder in bytes; when exceeded, the least recently used results are removed; default: 20e9");
  if (help.empty()) limit->needs("--cache");
  limit->check(CLI::PositiveNumber)->type_name("BYTES");
}

/// An empty value is an error, because an argument with an empty value would have the effect of an argument that is not given. Scripts of shells pass empty
/// values for variables that are not set.
std::string refuse_empty(const std::string& text) { return text.empty() ? "the value is empty: give a value, or leave the argument out" : ""; }

/// Adds an argument whose values are words of the line.
CLI::Option* add_words(CLI::App& command, const CommandArgument& argument, CommandLine& line) {
  Texts& words = line.words[key_of_argument(argument.name)];
  const auto take_all = [&words](const Texts& texts) { words = texts; };
  const auto take = [&words](const std::string& text) { words = {text}; };
  if (argument.takes == CommandArgument::Takes::several) {
    CLI::Option* option = command.add_option_function<Texts>(argument.name, take_all, argument.help);
    option->check(refuse_empty);
    return argument.name.starts_with("-") ? option->allow_extra_args(false)->take_all() : option;
  }
  if (argument.takes == CommandArgument::Takes::whole)
    return command
        .add_option_function<int>(
            argument.name, [take](int number) { take(std::to_string(number)); }, argument.help)
        ->check(argument.most > 0 ? CLI::Validator(CLI::Range(1, argument.most)) : CLI::Validator(CLI::PositiveNumber));
  return command.add_option_function<std::string>(argument.name, take, argument.help)->check(refuse_empty);
}

void add_argument(CLI::App& command, const CommandArgument& argument, CommandLine& line) {
  using Takes = CommandArgument::Takes;
  switch (argument.takes) {
    case Takes::options: return add_schema_options(command, argument.options.table, line.options, argument.help);
    case Takes::set: return add_set_option(command, line.set);
    case Takes::cache: return add_cache_options(command, argument.help, line);
    case Takes::patches: return add_patch_option(command, argument.name, argument.help, line.patches[key_of_argument(argument.name)]);
    case Takes::other: return argument.add(command, line);
    case Takes::unit:
      command.add_option_function<std::string>(
          "--unit", [&line](const std::string& text) { line.options.emplace_back("unit", text); }, argument.help);
      return;
    case Takes::flag: {
      bool& value = line.flags[key_of_argument(argument.name)];
      value = argument.is_set;
      if (CLI::Option* flag = command.add_flag(argument.name, value, argument.help); argument.is_hidden) flag->group("");
      return;
    }
    case Takes::one:
    case Takes::several:
    case Takes::whole: break;
  }
  CLI::Option* option = add_words(command, argument, line);
  if (!argument.type.empty()) option->type_name(argument.type);
  if (argument.is_required) option->required();
  if (argument.is_hidden) option->group("");
}

}  // namespace

const std::vector<std::string>& CommandLine::all(std::string_view key) const {
  static const Texts none;
  const auto found = words.find(key);
  return found == words.end() ? none : found->second;
}

const PatchEntries& CommandLine::patches_of(std::string_view key) const {
  static const PatchEntries none;
  const auto found = patches.find(key);
  return found == patches.end() ? none : found->second;
}

namespace argument {

using Takes = CommandArgument::Takes;

CommandArgument file(std::string name, std::string help) { return {.name = std::move(name), .help = std::move(help), .is_required = true}; }
CommandArgument files(std::string name, std::string help) {
  return {.takes = Takes::several, .name = std::move(name), .help = std::move(help), .is_required = true};
}
CommandArgument output(std::string help) { return file("-o,--output", std::move(help)); }
CommandArgument outputs(std::string help) { return files("-o,--output", std::move(help)); }
CommandArgument text(std::string name, std::string help, std::string type) {
  return {.name = std::move(name), .help = std::move(help), .type = std::move(type)};
}
CommandArgument texts(std::string name, std::string help, std::string type) {
  return {.takes = Takes::several, .name = std::move(name), .help = std::move(help), .type = std::move(type)};
}
CommandArgument flag(std::string name, std::string help, bool is_set) {
  return {.takes = Takes::flag, .name = std::move(name), .help = std::move(help), .is_set = is_set};
}
CommandArgument whole(std::string name, std::string help, int most, std::string type) {
  return {.takes = Takes::whole, .name = std::move(name), .help = std::move(help), .type = std::move(type), .most = most};
}
CommandArgument hidden(std::string name) { return {.name = std::move(name), .is_hidden = true}; }
CommandArgument options(HeldOptions options, std::string note) {
  return {.takes = Takes::options, .name = {}, .help = std::move(note), .options = std::move(options)};
}
CommandArgument unit(std::string help) { return {.takes = Takes::unit, .name = {}, .help = std::move(help)}; }
CommandArgument set() { return {.takes = Takes::set}; }
CommandArgument cache(std::string help) { return {.takes = Takes::cache, .name = {}, .help = std::move(help)}; }
CommandArgument patches(std::string help, std::string name) { return {.takes = Takes::patches, .name = std::move(name), .help = std::move(help)}; }
CommandArgument other(void (*add)(CLI::App&, CommandLine&)) { return {.takes = Takes::other, .add = add}; }

}  // namespace argument

void add_arguments(CLI::App& command, const std::vector<CommandArgument>& arguments, CommandLine& line) {
  for (const CommandArgument& argument : arguments) add_argument(command, argument, line);
}

void complete_line(const CLI::App& command, CommandLine& line) {
  line.options.insert(line.options.end(), line.set.begin(), line.set.end());
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0)
      for (const std::string& name : option->get_lnames()) line.given.push_back("--" + name);
}

}  // namespace sterna::scripting
