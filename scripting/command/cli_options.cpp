#include "scripting/command/cli_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>

#include "geom/base/error.h"

namespace sterna::scripting {
namespace {

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

}  // namespace

void add_set_option(CLI::App& command, OptionOverrides& overrides) {
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&overrides](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) overrides.push_back(split_assignment(text));
          },
          "any option of any stage, e.g. --set envelope.layers=24")
      ->type_name("STAGE.OPTION=VALUE")
      ->allow_extra_args(false)
      ->take_all();
}

void add_schema_options(CLI::App& command, const OptionTable& table, OptionOverrides& overrides, const std::string& note) {
  for (const Option& option : table) {
    const std::string name(option.name);
    std::string help = std::string(option.help) + "; " + option.default_text();
    if (const std::string range = option.range_text(); !range.empty()) help += "; " + range;
    // If the option is given twice, both values are kept, and set_options refuses them if they differ.
    CLI::Option* added = command.add_option_function<std::vector<std::string>>(
        "--" + kebab(name),
        [&overrides, name](const std::vector<std::string>& texts) {
          for (const std::string& text : texts) overrides.emplace_back(name, text.empty() ? "true" : text);
        },
        help);
    added->group("Options of stage " + std::string(option.stage) + (note.empty() ? "" : ", " + note));
    added->type_name(type_name(option));
    added->allow_extra_args(false)->take_all();
    if (option.kind == OptionKind::boolean) added->expected(0, 1);
  }
}

std::vector<std::string> given_options(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0)
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

void add_patch_option(CLI::App& command, std::vector<std::pair<std::string, OptionOverrides>>& patches, const std::string& help, const std::string& name) {
  command
      .add_option_function<std::vector<std::string>>(
          name,
          [&patches, name](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
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
            }
          },
          help)
      ->type_name("NAMES:OPTION=VALUE,...")
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace sterna::scripting
