// Pictures from the command line and from scripts: files, options, refused input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "geom/base/error.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/verbs/draw_command.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class DrawCommandLine : public testing::Test {
 protected:
  DrawCommandLine() { std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder_ / "box.stl"); }
  test::ProcessResult sterna(std::vector<std::string> arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
  const std::filesystem::path folder_ = test::scratch();
};

TEST_F(DrawCommandLine, WritesAPictureOfTheSizeAskedFor) {
  ASSERT_EQ(sterna({"draw", "box.stl", "-o", "box.png", "--size", "300x200", "--view", "top", "--color", "edge_length"}).status, 0);
  const std::string png = bytes_of(folder_ / "box.png");
  ASSERT_GT(png.size(), 100u);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  const auto number = [&](std::size_t at) { return (static_cast<unsigned char>(png[at + 2]) << 8) + static_cast<unsigned char>(png[at + 3]); };
  EXPECT_EQ(number(16), 300);
  EXPECT_EQ(number(20), 200);
  ASSERT_EQ(sterna({"draw", "box.stl", "-o", "again.png", "--size", "300x200", "--view", "top", "--color", "edge_length", "--threads", "1"}).status, 0);
  EXPECT_TRUE(bytes_of(folder_ / "again.png") == png);
}

TEST_F(DrawCommandLine, SaysWhatIsWrongAndWritesNothing) {
  const auto refused = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "draw");
    const test::ProcessResult result = sterna(arguments);
    EXPECT_NE(result.status, 0);
    return result.errors;
  };
  EXPECT_THAT(refused({"box.stl", "-o", "a.png", "--color", "edge_lenght"}), AllOf(HasSubstr("did you mean \"edge_length\""), HasSubstr("min_angle")));
  EXPECT_THAT(refused({"box.stl", "-o", "a.png", "--color", "skew"}), HasSubstr("no face of the mesh has a skew"));
  EXPECT_THAT(refused({"box.stl", "-o", "a.png", "--view", "ise"}), HasSubstr("did you mean \"iso\""));
  EXPECT_THAT(refused({"box.stl", "-o", "a.png", "--cut", "x=1"}), HasSubstr("a surface has no cells"));
  EXPECT_THAT(refused({"box.stl", "-o", "a.png", "--size", "300"}), HasSubstr("WIDTHxHEIGHT"));
  EXPECT_THAT(refused({"box.stl", "-o", "a.png", "--size", "3x200"}), HasSubstr("width"));
  EXPECT_THAT(refused({"box.stl", "-o", "a.jpg"}), HasSubstr(".png"));
  EXPECT_THAT(refused({"box.stl", "-o", "a.png", "--places"}), HasSubstr("volume mesh"));
  EXPECT_THAT(refused({"model.step", "-o", "a.png"}), HasSubstr("sterna surface"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png"));
}

TEST_F(DrawCommandLine, OfAVolumeMeshFromAScript) {
  std::ofstream(folder_ / "case.lua") << R"(
    local wall = read_surface{ "box.stl" }
    draw{ wall, "wall.png", width = 200, height = 150, view = { 225, 30 } }
    local mesh = volume_mesh{ wall, layers = 3, first_height = 0.01, farfield = sphere{ radius = 10 } }
    draw{ mesh, "mesh.png", width = 200, height = 150, color = "skew", places = true }
    draw{ mesh, "cut.png", width = 200, height = 150, cut = "section 50%" }
    mesh:write "mesh.su2"
    draw{ "mesh.su2", "file.png", width = 200, height = 150, cut = { x = 0.5 }, focus = { {0.5, 0.5, 0.5}, radius = 1 } }
    for _, wrong in ipairs{ function() draw{ mesh, "a.png", cut = "sction 50%" } end, function() draw{ mesh, "a.png", focus = { {1, 2} } } end, function() draw{ mesh } end,
                            function() draw{ box{ {0, 0, 0}, {1, 1, 1} }, "a.png" } end, function() draw{ mesh, "a.png", colour = "skew" } end } do
      local ok, message = pcall(wrong)
      assert(not ok)
      print(message)
    end
  )";
  const test::ProcessResult result = sterna({"run", "case.lua"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, AllOf(HasSubstr("did you mean \"section 50%\""), HasSubstr("focus = { {1, 2, 0}, radius = 0.5 }"), HasSubstr("entry 2"),
                                   HasSubstr("surface_mesh{ model }"), HasSubstr("color")));
  for (const char* name : {"wall.png", "mesh.png", "cut.png", "file.png"}) EXPECT_EQ(bytes_of(folder_ / name).substr(1, 3), "PNG") << name;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png"));
}

}  // namespace
}  // namespace sterna::scripting
