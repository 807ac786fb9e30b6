#include "scripting/cli/shell_help.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "scripting/interpreter/script_help.h"
#include "scripting/terminal/exit_status.h"

namespace sterna::scripting {
namespace {

/// Returns the options that have a name and are listed in the help.
std::vector<const CLI::Option*> named_options(const CLI::App& app) {
  std::vector<const CLI::Option*> options;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty() && (!option->get_lnames().empty() || !option->get_snames().empty())) options.push_back(option);
  return options;
}

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : app.get_subcommands({}))
    if (!command->get_group().empty()) commands.push_back(command);
  return commands;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) text.replace(at, what.size(), by);
  return text;
}

/// Returns the text up to the first full stop: for one line of a menu.
std::string first_sentence(const std::string& text) {
  std::size_t end = text.find(". ");
  while (end != std::string::npos && end > 0 && text[end - 1] == '.') end = text.find(". ", end + 1);  // ".." is the sign of a range
  return replaced(text.substr(0, end), "\n", " ");
}

std::string names_of(const CLI::App& app) {
  std::string names;
  for (const CLI::Option* option : named_options(app)) {
    for (const std::string& name : option->get_lnames()) names += (names.empty() ? "--" : " --") + name;
    for (const std::string& name : option->get_snames()) names += (names.empty() ? "-" : " -") + name;
  }
  return names;
}

std::string bash_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : shown_commands(app)) {
    commands += (commands.empty() ? "" : " ") + command->get_name();
    cases += "    " + command->get_name() + ") options=\"" + names_of(*command) + "\" ;;\n";
  }
  return "# bash completion of sterna: sterna completion bash > /etc/bash_completion.d/sterna, or source it\n"
         "_sterna() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} commands=\"" +
         commands +
         "\" command= options= i\n"
         "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
         "    if [[ \" $commands \" == *\" ${COMP_WORDS[i]} \"* ]]; then command=${COMP_WORDS[i]}; break; fi\n"
         "  done\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "  if [[ $current == -* ]]; then COMPREPLY=($(compgen -W \"$options " +
         names_of(app) +
         "\" -- \"$current\"))\n"
         "  elif [[ -z $command ]]; then COMPREPLY=($(compgen -W \"$commands\" -- \"$current\"))\n"
         "  else compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -f -- \"$current\"))\n"
         "  fi\n"
         "}\n"
         "complete -F _sterna sterna\n";
}

/// Returns the text within single quotes; zsh's menus use colons and brackets as separators.
std::string zsh_quoted(const std::string& text) {
  return replaced(replaced(replaced(replaced(replaced(text, "\\", "\\\\"), "'", "'\\''"), ":", "\\:"), "[", "\\["), "]", "\\]");
}

std::string zsh_options(const CLI::App& app, const std::string& indent) {
  std::string text;
  for (const CLI::Option* option : named_options(app)) {
    std::vector<std::string> names;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
    for (const std::string& name : names)
      text += " \\\n" + indent + "'" + name + "[" + zsh_quoted(first_sentence(option->get_description())) + "]" +
              (takes_value(*option) ? ":value:_files" : "") + "'";
  }
  return text;
}

std::string zsh_completion(const CLI::App& app) {
  std::string commands, cases;
  for (const CLI::App* command : shown_commands(app)) {
    commands += "    '" + command->get_name() + ":" + zsh_quoted(first_sentence(command->get_description())) + "'\n";
    cases += "        " + command->get_name() + ") _arguments" + zsh_options(*command, "          ") + " '*:file:_files' ;;\n";
  }
  return "#compdef sterna\n# zsh completion of sterna: sterna completion zsh > a folder of $fpath/_sterna\n"
         "_sterna() {\n  local state line\n  local -a commands=(\n" +
         commands + "  )\n  _arguments -C" + zsh_options(app, "    ") +
         " \\\n    '1:command:->command' '*::rest:->rest'\n"
         "  case $state in\n    command) _describe command commands ;;\n    rest)\n      case $words[1] in\n" +
         cases + "      esac ;;\n  esac\n}\n_sterna \"$@\"\n";
}

std::string fish_quoted(const std::string& text) { return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'"; }

std::string fish_options(const CLI::App& app, const std::string& condition) {
  std::string text;
  for (const CLI::Option* option : named_options(app)) {
    text += "complete -c sterna" + condition;
    for (const std::string& name : option->get_lnames()) text += " -l " + name;
    for (const std::string& name : option->get_snames()) text += " -s " + name;
    text += (takes_value(*option) ? " -r -d " : " -d ") + fish_quoted(first_sentence(option->get_description())) + "\n";
  }
  return text;
}

std::string fish_completion(const CLI::App& app) {
  std::string text = "# fish completion of sterna: sterna completion fish > ~/.config/fish/completions/sterna.fish\n" + fish_options(app, "");
  for (const CLI::App* command : shown_commands(app)) {
    text +=
        "complete -c sterna -n __fish_use_subcommand -f -a " + command->get_name() + " -d " + fish_quoted(first_sentence(command->get_description())) + "\n";
    text += fish_options(*command, " -n '__fish_seen_subcommand_from " + command->get_name() + "'");
  }
  return text;
}

/// Returns the text of a page in roff: hyphens stay hyphens, and no line begins with a roff request.
std::string roff(const std::string& text) {
  const std::string escaped = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  std::string lines = replaced(replaced(escaped, "\n.", "\n\\&."), "\n'", "\n\\&'");
  return !lines.empty() && (lines.front() == '.' || lines.front() == '\'') ? "\\&" + lines : lines;
}

std::string roff_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;  // not listed
    text += ".TP\n.B " + roff(option->get_name(option->get_positional(), true)) + "\n";
    const std::string type = option->get_type_name();
    text += (type.empty() ? "" : roff(type) + ". ") + (option->get_description().empty() ? "\\&" : roff(option->get_description())) + "\n";
  }
  return text;
}

/// Returns "max-memory" and "envelope.max_growth" in the form used by scripts.
std::string script_name(std::string name) {
  if (const std::size_t dot = name.rfind('.'); dot != std::string::npos && !find_verb(name)) name.erase(0, dot + 1);
  std::ranges::replace(name, '-', '_');
  return name;
}

/// Returns the commands that have an option of that name, a line each; empty: none.
std::string help_on_option(const CLI::App& app, const std::string& name) {
  std::string text;
  for (const CLI::App* command : shown_commands(app))
    for (const CLI::Option* option : command->get_options())
      for (const std::string& known : option->get_lnames())
        if (known == name) text += "  sterna " + command->get_name() + " --" + known + ": " + option->get_description() + "\n";
  return text;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash_completion(app);
  if (shell == "zsh") return zsh_completion(app);
  if (shell == "fish") return fish_completion(app);
  throw Error(
      {.code = ErrorCode::bad_argument, .attempted = "completion", .problem = "no completion for the shell \"" + shell + "\"", .hint = "bash, zsh or fish"});
}

std::string man_page(const CLI::App& app) {
  std::string text = ".TH STERNA 1\n.SH NAME\n" + roff(app.get_description()).replace(0, app.get_name().size() + 1, app.get_name() + " \\-") +
                     "\n.SH SYNOPSIS\n.B sterna\n[options] command [arguments]\n.SH OPTIONS\nOptions of every command:\n" + roff_options(app) +
                     ".SH COMMANDS\n";
  for (const CLI::App* command : shown_commands(app)) {
    text += ".SS " + roff("sterna " + command->get_name()) + "\n" + roff(command->get_description()) + "\n" + roff_options(*command);
    if (!command->get_footer().empty()) text += ".PP\n" + roff(command->get_footer()) + "\n";
  }
  return text + ".SH EXIT STATUS\n" + roff(std::string(k_exit_status_help)) +
         "\n.SH SEE ALSO\n.B sterna manual\nprints the reference of verbs, objects and options of scripts, the same text as docs/lua.md.\n";
}

void add_shell_commands(CLI::App& app, const std::function<void(std::function<int(const CommandContext&)>)>& choose) {
  CLI::App* completion = app.add_subcommand("completion", "print a completion script for commands, options and file names of bash, zsh or fish");
  const CLI::Option* shell =
      completion->add_option("shell", "name of the shell")->required()->type_name("bash|zsh|fish")->check(CLI::IsMember({"bash", "zsh", "fish"}).name(""));
  completion->final_callback([&app, shell, choose] {
    choose([&app, shell](const CommandContext& context) {
      context.console.print(completion_script(app, shell->as<std::string>()));
      return k_exit_success;
    });
  });
  CLI::App* help = app.add_subcommand("help", "explain a command (as --help), or a verb, object or option of scripts (as help \"name\" in a script)");
  const CLI::Option* about = help->add_option("name", "name to explain: mesh, volume_mesh, max_growth ...; default: list of all commands")->type_name("NAME");
  help->final_callback([&app, about, choose] {
    choose([&app, about](const CommandContext& context) {
      const auto name = about->count() > 0 ? about->as<std::string>() : std::string();
      const auto commands = app.get_subcommands([&](const CLI::App* known) { return known->check_name(name); });
      const CLI::App* command = name.empty() ? &app : commands.empty() ? nullptr : commands.front();
      // app.help() would return the help of the running command.
      std::string text = command == &app ? app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal) : command ? command->help() : "";
      // A name may have two meanings: it may be both a command and a verb of scripts, or an option of both.
      if (name.empty() || (command && !find_verb(name))) return context.console.print(text), k_exit_success;
      if (!command) text = help_on_option(app, name);
      const std::string in_script = script_name(name), of_scripts = text.empty() ? help_on_name(in_script, "help " + name) : help_if_known(in_script);
      if (!of_scripts.empty()) text += (text.empty() ? "" : "\nIn scripts:\n\n") + of_scripts;
      context.console.print(text);
      return k_exit_success;
    });
  });
  app.add_subcommand("man", "print the man page sterna(1): sterna man > sterna.1")->final_callback([&app, choose] {
    choose([&app](const CommandContext& context) {
      context.console.print(man_page(app));
      return k_exit_success;
    });
  });
}

}  // namespace sterna::scripting
