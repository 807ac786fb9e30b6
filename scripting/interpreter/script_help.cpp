#include "scripting/interpreter/script_help.h"

#include <algorithm>
#include <regex>
#include <sstream>

#include "geom/base/schema.h"
#include "scripting/interpreter/script_verbs.h"
#include "scripting/lua/verb_tools.h"

namespace sterna::scripting {
namespace {

/// Parses "  layers = 30  (1 .. 1000)", as written by options_help(); returns false for another line.
bool read_option_line(const std::string& line, OptionDoc& option) {
  if (!line.starts_with("  ") || line.starts_with("   ")) return false;
  const std::size_t end = line.find(" = ");
  if (end == std::string::npos || line.find(' ', 2) != end) return false;
  option.name = line.substr(2, end - 2);
  option.value = line.substr(end + 3);
  if (const std::size_t range = option.value.find("  ("); range != std::string::npos && option.value.ends_with(')')) {
    option.range = option.value.substr(range + 3, option.value.size() - range - 4);
    option.value.resize(range);
  }
  return true;
}

std::string short_name(const ScriptVerb& verb) { return std::string(verb.name.substr(verb.name.find(':') + 1)); }

/// Returns the verbs that have an option of that name, a line each.
std::string verbs_with_option(const std::string& name) {
  std::string text;
  for (const ScriptVerb* verb : all_verbs())
    for (const OptionGroup& group : option_groups(*verb))
      for (const OptionDoc& option : group.options)
        if (option.name == name)
          text += "  " + std::string(verb->name) + ": " + name + " = " + option.value + (option.range.empty() ? "" : "  (" + option.range + ")") + "\n      " +
                  option.help + "\n";
  return text;
}

}  // namespace

std::string help_on_options(const ScriptVerb& verb) {
  return verb.options_help ? verb.options_help() : verb.options ? options_help(verb.options().table) : std::string();
}

std::vector<OptionGroup> option_groups(const ScriptVerb& verb) {
  std::vector<OptionGroup> groups;
  std::istringstream text(help_on_options(verb));
  bool is_option = false;
  for (std::string line; std::getline(text, line);) {
    OptionDoc option;
    if (read_option_line(line, option)) {
      if (groups.empty()) groups.emplace_back();
      groups.back().options.push_back(std::move(option));
      is_option = true;
    } else if (is_option && line.starts_with("      ")) {
      groups.back().options.back().help = line.substr(6);
      is_option = false;
    } else {
      const std::size_t start = line.find_first_not_of(' ');
      if (start == std::string::npos) continue;
      if (groups.empty() || !groups.back().options.empty()) groups.emplace_back();
      groups.back().title += (groups.back().title.empty() ? "" : " ") + line.substr(start);
      is_option = false;
    }
  }
  return groups;
}

std::vector<std::string> option_names(const ScriptVerb& verb) {
  std::vector<std::string> names;
  for (const OptionGroup& group : option_groups(verb))
    for (const OptionDoc& option : group.options)
      if (std::find(names.begin(), names.end(), option.name) == names.end()) names.push_back(option.name);
  return names;
}

std::vector<const ScriptVerb*> all_verbs() {
  std::vector<const ScriptVerb*> verbs;
  for (const ScriptVerb& verb : script_verbs()) verbs.push_back(&verb);
  for (const ObjectKind& kind : object_kinds())
    for (const ScriptVerb& verb : kind.methods()) verbs.push_back(&verb);
  return verbs;
}

const ScriptVerb* find_verb(std::string_view name) {
  const std::vector<const ScriptVerb*> verbs = all_verbs();
  for (const ScriptVerb* verb : verbs)
    if (verb->name == name) return verb;
  for (const ScriptVerb* verb : verbs)
    if (short_name(*verb) == name) return verb;
  return nullptr;
}

std::vector<std::string> examples_of(const ScriptVerb& verb) {
  std::vector<std::string> examples;
  static const std::regex between("  or(, [a-z ]+,)?  ");
  const std::string usage(verb.usage);
  for (std::sregex_token_iterator it(usage.begin(), usage.end(), between, -1), end; it != end; ++it) examples.push_back(*it);
  return examples;
}

std::string help_text(const ScriptVerb& verb) {
  std::string text = std::string(verb.name) + ": " + std::string(verb.summary);
  for (const std::string& example : examples_of(verb)) text += "\n  " + example;
  if (const std::string options = help_on_options(verb); !options.empty()) text += "\noptions (name = default [unit] (range)):\n" + options;
  if (text.back() == '\n') text.pop_back();
  return text;
}

std::string help_text(const ObjectKind& kind) {
  std::string text = std::string(kind.name) + ": " + std::string(kind.summary);
  if (!kind.methods().empty()) text += "\nmethods:";
  for (const ScriptVerb& method : kind.methods())
    text += "\n  " + std::string(method.name) + ": " + std::string(method.summary) + "\n      " + std::string(method.usage);
  for (const ScriptVerb& verb : script_verbs())
    if (verb.name.starts_with(std::string(kind.name) + ".")) text += "\n  " + std::string(verb.name) + ": " + std::string(verb.summary);
  if (!kind.fields.empty()) text += "\nfields:";
  for (const FieldDoc& field : kind.fields) text += "\n  " + std::string(field.name) + ": " + std::string(field.help);
  return text;
}

std::string help_text() {
  std::string text;
  for (const ScriptVerb* verb : all_verbs()) text += std::string(verb->name) + ": " + std::string(verb->summary) + "\n  " + std::string(verb->usage) + "\n";
  text += "numbers:";
  for (const ScriptUnit& unit : script_units()) text += (&unit == script_units().data() ? " " : ", ") + std::string(unit.name);
  return text +
         ". help(volume_mesh) prints the options of a verb, help(wall) the methods and fields of an object, help \"first_height\" the verbs with an option.";
}

std::string help_if_known(const std::string& name) {
  std::string text;
  if (const ScriptVerb* verb = find_verb(name)) text = help_text(*verb);
  if (const ObjectKind* kind = object_kind(name)) text += (text.empty() ? "" : "\n\n") + help_text(*kind);
  if (!text.empty()) return text;
  text = verbs_with_option(name);
  return text.empty() ? text : "option " + name + "\n" + text.substr(0, text.size() - 1);
}

std::string help_on_name(const std::string& name, const std::string& attempted) {
  if (std::string text = help_if_known(name); !text.empty()) return text;
  std::vector<std::string> known;
  for (const ScriptVerb* verb : all_verbs()) {
    known.emplace_back(verb->name);
    for (const std::string& option : option_names(*verb)) known.push_back(option);
  }
  for (const ObjectKind& kind : object_kinds()) known.emplace_back(kind.name);
  const std::string nearest = nearest_name(name, known);
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = attempted,
               .problem = "there is no verb, object or option \"" + name + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"),
               .hint = "help() lists the verbs, `sterna manual` all verbs with their options"});
}

ScriptValue print_help(const ScriptCall& call) {
  if (call.arguments.empty()) {
    call.session.print(help_text());
    return std::monostate{};
  }
  const ScriptValue& about = call.arguments.front();
  if (const auto* verb = std::get_if<const ScriptVerb*>(&about)) call.session.print(help_text(**verb));
  else if (const ObjectKind* kind = kind_of(about)) call.session.print(help_text(*kind));
  else if (const auto* name = std::get_if<std::string>(&about)) call.session.print(help_on_name(*name, call.attempted()));
  else if (const auto* table = std::get_if<TableHandle>(&about);
           table && (*table)->fields.contains("shape") && std::holds_alternative<std::string>((*table)->fields.at("shape")))
    call.session.print(help_on_name(std::get<std::string>((*table)->fields.at("shape")), call.attempted()));
  else reject(call, "there is no help for " + std::string(type_text(about)), "help() lists the verbs; a misspelt name has the value nil");
  return std::monostate{};
}

}  // namespace sterna::scripting
