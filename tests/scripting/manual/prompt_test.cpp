// The prompt through a pipe, as a program would drive it; completion by direct calls of its function.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "scripting/interpreter/completion.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::Contains;
using testing::HasSubstr;

class Prompt : public testing::Test {
 protected:
  /// Returns the output of `sterna prompt` for these lines.
  test::ProcessResult say(const std::string& lines) {
    std::ofstream(folder_ / "input") << lines;
    return test::run_process("/bin/sh", {"-c", "exec '" + test::sterna_program().string() + "' prompt < input"}, folder_);
  }
  std::vector<std::string> after(const std::string& text) { return complete(text, state_).candidates; }

  const std::filesystem::path folder_ = test::scratch();
  ScriptState state_{{.script = folder_ / "prompt", .overrides = {}, .print = [](std::string_view) {}, .on_mesh = {}}, RunContext({.threads = 1})};
};

TEST_F(Prompt, PrintsExpressionsAndGoesOnAfterErrors) {
  const test::ProcessResult result =
      say("1 + 1\nx = box{ {0,0,0}, {1,1,1} }\nx\nvolume_mash{}\nfor i = 1, 2 do\n  print(i)\nend\nx.faces\nnil + 1\n'still here'\n");
  EXPECT_THAT(result.output, HasSubstr("2\nModel: 1 component, 6 faces"));
  EXPECT_THAT(result.output, HasSubstr("\n1\n2\n6\nstill here\n"));
  EXPECT_THAT(result.errors, testing::AllOf(HasSubstr("did you mean volume_mesh?"), HasSubstr("arithmetic on a nil value")));
}

TEST_F(Prompt, EndsAtExitAndAtInputEnd) {
  EXPECT_EQ(say("print 'a'\nexit\nprint 'b'\n").output, "a\n");
  EXPECT_EQ(say("print 'a'\n").status, 0);
  EXPECT_EQ(say("x = {\n").status, 2);
  EXPECT_EQ(say("").output, "");
}

TEST_F(Prompt, CompletesVerbsUnitsAndKeywords) {
  EXPECT_THAT(after("volume_m"), testing::ElementsAre("volume_mesh"));
  EXPECT_THAT(after("local wall = read_s"), testing::IsSupersetOf({"read_smx", "read_stages", "read_surface"}));
  EXPECT_THAT(after("whi"), testing::ElementsAre("while"));
  EXPECT_THAT(after("5*inc"), testing::ElementsAre("inch"));
  EXPECT_THAT(after("envelope.sm"), testing::ElementsAre("envelope.smooth"));
  EXPECT_THAT(after("string.fo"), testing::ElementsAre("string.format"));
}

TEST_F(Prompt, CompletesOptionsOfTheInnermostVerb) {
  EXPECT_THAT(after("volume_mesh{ wall, first_h"), testing::ElementsAre("first_height = "));
  EXPECT_THAT(after("volume_mesh{ wall, farfield = sphere{ rad"), testing::ElementsAre("radius = "));
  EXPECT_THAT(after("volume_mesh{ wall, farfield = { rad"), testing::ElementsAre("radius = "));
  EXPECT_THAT(after("volume_mesh{ wall,\n  farfield = sphere{ radius = 5 },\n  lay"), testing::ElementsAre("layers = "));
  EXPECT_THAT(after("volume_mesh{ wall, name = \"lay"), testing::IsEmpty());
  EXPECT_TRUE(complete("read_surface \"wi", state_).is_text);
  EXPECT_THAT(after("first_h"), testing::IsEmpty());
}

TEST_F(Prompt, CompletesNamesOfPatchesInTheirTexts) {
  state_.run("model = box{ {0,0,0}, {1,1,1}, name = 'fuselage' } other = box{ {2,0,0}, {3,1,1}, name = 'fin' }", "=test");
  EXPECT_THAT(after("surface_mesh{ model, patches = { [\"fu"), testing::ElementsAre("fuselage"));
  EXPECT_THAT(after("mesh:su2_config{ \"a.cfg\", monitor = \"f"), testing::ElementsAre("fin", "fuselage"));
  EXPECT_THAT(after("surface_mesh{ model, patches = { fin = { kind = \"f"), testing::IsEmpty());
  EXPECT_TRUE(complete("surface_mesh{ model, patches = { [\"fu", state_).is_text);
}

TEST_F(Prompt, CompletesMethodsAndFieldsOfValues) {
  state_.run("model = box{ {0,0,0}, {1,1,1} } design = { wing = model }", "=test");
  EXPECT_THAT(after("model:ro"), testing::ElementsAre("model:rotate"));
  EXPECT_THAT(after("print(model.is_"), testing::ElementsAre("model.is_closed"));
  EXPECT_THAT(after("design.wi"), testing::ElementsAre("design.wing"));
  EXPECT_THAT(after("design.wing:defo"), testing::ElementsAre("design.wing:deform"));
  EXPECT_THAT(after("model:rotate{ pit"), testing::ElementsAre("pitch = "));
  EXPECT_THAT(after("nothing:ro"), testing::IsEmpty());
  EXPECT_EQ(complete("print(model:ro", state_).start, 6u);
}

}  // namespace
}  // namespace sterna::scripting
