// Every script in tests/data/scripts is wrong; its comments "-- expect ..." give the error code and parts of the message.
#include <fstream>

#include "geom/base/error.h"
#include "scripting/interpreter/script_run.h"
#include "tests/support/data.h"

namespace sterna::scripting {
namespace {

struct Expectation {
  std::string code;
  std::vector<std::string> parts;
};

Expectation expectation_of(const std::filesystem::path& script) {
  constexpr std::string_view k_mark = "-- expect ";
  Expectation expected;
  std::ifstream file(script);
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with(k_mark)) continue;
    line.erase(0, k_mark.size());
    if (expected.code.empty()) {
      expected.code = line.substr(0, line.find(' '));
      line.erase(0, line.find(' ') + 1);
    }
    expected.parts.push_back(line);
  }
  return expected;
}

TEST(ScriptMistakes, EachHasItsMessageAtFileAndLine) {
  int n_scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::corpus() / "scripts")) {
    if (entry.path().extension() != ".lua") continue;
    ++n_scripts;
    SCOPED_TRACE(entry.path().filename().string());
    const Expectation expected = expectation_of(entry.path());
    ASSERT_FALSE(expected.parts.empty()) << "the script says nothing of what to expect";
    try {
      run_script({.script = entry.path(), .overrides = {}, .print = [](std::string_view) {}, .on_mesh = {}}, RunContext({.threads = 1}));
      ADD_FAILURE() << "ran without an error";
    } catch (const Error& error) {
      EXPECT_EQ(to_string(error.code()), expected.code) << error.what();
      for (const std::string& part : expected.parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << "missing: " << part << "\nin: " << error.what();
    }
  }
  EXPECT_GE(n_scripts, 60);
}

}  // namespace
}  // namespace sterna::scripting
