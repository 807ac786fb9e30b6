// Runs scripts in a separate folder and collects their output, log and errors.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "geom/base/error.h"
#include "scripting/interpreter/script_run.h"
#include "tests/support/data.h"

namespace sterna::scripting {

class ScriptFixture : public testing::Test {
 protected:
  /// Runs the string as a script; returns its printed output. The log is in log_.
  std::string run(const std::string& text, const OptionOverrides& overrides = {}, int threads = 1) {
    std::ofstream(folder_ / "case.lua") << text;
    std::string printed;
    log_.clear();
    const RunContext context({.threads = threads, .log = [&](LogLevel level, std::string_view line) {
                                log_ += (level == LogLevel::warning ? "warning: " : "") + std::string(line) + "\n";
                              }});
    run_script(
        {.script = folder_ / "case.lua", .overrides = overrides, .print = [&](std::string_view line) { printed += std::string(line) + "\n"; }, .on_mesh = {}},
        context);
    return printed;
  }
  double number(const std::string& expression) { return std::stod(run("print(string.format('%.17g', " + expression + "))")); }
  std::string error(const std::string& text) {
    try {
      run(text);
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
  /// Returns the name of a file in the folder, as a Lua string.
  std::string out(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }
  std::string text_of(const std::string& name) const {
    std::ifstream file(folder_ / name);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  const std::filesystem::path folder_ = test::scratch();
  std::string log_;
};

}  // namespace sterna::scripting
