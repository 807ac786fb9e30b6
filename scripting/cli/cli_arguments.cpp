// Arguments of single commands that have a form of their own. CLI11 is slow to compile, so few files include it.
#include <CLI/CLI.hpp>

#include <sstream>

#include "scripting/cli/command_table.h"
#include "scripting/interpreter/script_args.h"

namespace sterna::scripting {
namespace {

/// Largest accepted number of threads, as for --threads of all commands.
constexpr int k_most_threads = 1024;

}  // namespace

void add_script_arguments(CLI::App& command, CommandLine& line) {
  command
      .add_option_function<std::vector<std::string>>(
          "arguments",
          [&line](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) line.arguments.push_back(split_argument(text));
          },
          "arguments that the script reads with args{ alpha = 0 }, e.g. alpha=4 height=2mm half=true")
      ->type_name("NAME=VALUE ...");
}

void add_thread_numbers(CLI::App& command, CommandLine& line) {
  command
      .add_option_function<std::vector<int>>(
          "--threads",
          [&line](const std::vector<int>& numbers) {
            for (const int number : numbers) line.words["threads"].push_back(std::to_string(number));
          },
          "numbers of threads, one run each; a number given twice compares two equal runs; default: 1,2,7")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::Range(1, k_most_threads))
      ->type_name("N,N,...");
}

void add_picture_size(CLI::App& command, CommandLine& line) {
  command
      .add_option_function<std::string>(
          "--size",
          [&line](const std::string& text) {
            const std::size_t by = text.find('x');
            if (by == std::string::npos || by == 0 || by + 1 == text.size())
              throw CLI::ValidationError("--size", "\"" + text + "\" is not WIDTHxHEIGHT, such as 1600x1000");
            line.options.emplace_back("width", text.substr(0, by));
            line.options.emplace_back("height", text.substr(by + 1));
          },
          "width and height in pixels, 1600x1000")
      ->type_name("WIDTHxHEIGHT");
}

void add_flow_words(CLI::App& command, CommandLine& line) {
  command
      .add_option_function<std::string>(
          "--flow",
          [&line](const std::string& text) {
            std::istringstream words(text);
            for (std::string word; words >> word;) {
              const std::size_t equals = word.find('=');
              if (equals == std::string::npos || equals == 0) throw CLI::ValidationError("--flow", "\"" + word + "\" is not NAME=VALUE");
              line.options.emplace_back(word.substr(0, equals), word.substr(equals + 1));
            }
          },
          "flow conditions in one string, --flow \"mach=0.78 altitude=11000 length=4.2\"")
      ->type_name("CONDITIONS");
}

void add_patch_kinds(CLI::App& command, CommandLine& line) {
  command
      .add_option_function<std::vector<std::string>>(
          "--kind",
          [&line](const std::vector<std::string>& texts) {
            for (const std::string& text : texts)
              if (const std::size_t equals = text.rfind('='); equals == std::string::npos || equals == 0)
                throw CLI::ValidationError("--kind", "\"" + text + "\" is not NAMES=KIND");
            line.words["kind"] = texts;
          },
          "kind of patches with matching names for the solver, instead of the kind in the mesh, e.g. --kind \"top*=slip\"; may be given several times")
      ->type_name("NAMES=KIND")
      ->allow_extra_args(false)
      ->take_all();
}

}  // namespace sterna::scripting
