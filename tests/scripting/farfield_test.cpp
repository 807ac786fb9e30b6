// Outer boundaries and half models in scripts and on the command line.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "geom/base/error.h"
#include "scripting/interpreter/script_run.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/verbs/farfield_verbs.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

class Farfield : public testing::Test {
 protected:
  Farfield() : folder(test::scratch()) { std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder / "box.stl"); }

  std::string run_text(const std::string& text) {
    std::ofstream(folder / "case.lua") << "local wall = read_surface 'box.stl'\nlocal function mesh(wall, far) return volume_mesh{ wall, layers = 4, "
                                          "first_height = 1e-3, farfield = far } end\n" +
                                              text;
    std::string printed;
    run_script({.script = folder / "case.lua", .overrides = {}, .print = [&](std::string_view line) { printed += std::string(line) + "\n"; }, .on_mesh = {}},
               RunContext({.threads = 2}));
    return printed;
  }
  std::string error_of(const std::string& text) {
    try {
      run_text(text);
    } catch (const Error& error) {
      return error.what();
    }
    ADD_FAILURE() << "no error from: " << text;
    return {};
  }

  std::filesystem::path folder;
};

TEST_F(Farfield, IsBoxOrCylinderOrSurface) {
  const std::string printed = run_text(
      "local function show(m) m:check() print(table.concat(m.patches, ' ')) end\n"
      "show(mesh(wall, box{ {-4, -4, -4}, {6, 4, 4}, edge = 2, sides = { x_min = 'inflow', x_max = { kind = 'outflow', name = 'exit', edge = 1 } } }))\n"
      "show(mesh(wall, cylinder{ {-4, 0, 0}, {6, 0, 0}, radius = 5, edge = 2 }))\n"
      "show(mesh(wall, 'box -4 -4 -4 6 4 4 edge=2 z_min=slip'))\n"
      "show(mesh(wall, sphere{ radius = 8, center = {1, 0, 0} }))\n"
      "show(mesh(wall, box{ {-4, -4, -4}, {6, 4, 4} }))\n");  // a solid: its surface is the farfield
  EXPECT_THAT(printed, HasSubstr("inflow"));
  EXPECT_THAT(printed, HasSubstr("exit"));
  EXPECT_THAT(printed, HasSubstr("slip"));
  EXPECT_THAT(printed, testing::Not(HasSubstr("INVALID")));
}

TEST_F(Farfield, HalfModelsAreMeshed) {
  const std::string printed = run_text(
      "local side = half{ wall, axis = 'y', at = 0.5 }\nprint(wall.is_closed, side.is_closed)\n"
      "local m = mesh(side, sphere{ radius = 10 })\nm:check()\nprint(table.concat(m.patches, ' '))");
  EXPECT_THAT(printed, HasSubstr("true\tfalse"));
  EXPECT_THAT(printed, HasSubstr("VALID"));
  EXPECT_THAT(printed, HasSubstr("symmetry"));
}

TEST_F(Farfield, MistakesAreToldAtTheirLine) {
  EXPECT_THAT(error_of("mesh(wall, sphere{ radius = 100, egde = 3 })"), HasSubstr("case.lua:3: sphere: unknown key \"egde\", did you mean \"edge\"?"));
  EXPECT_THAT(error_of("mesh(wall, box{ {0, 0}, {1, 1, 1}, edge = 2 })"), HasSubstr("case.lua:3: box: expected two points"));
  EXPECT_THAT(error_of("mesh(wall, box{ {-4, -4, -4}, {6, 4, 4}, edge = 2, sides = { x_min = 'inlet' } })"),
              HasSubstr("sides.x_min: \"inlet\" is not a patch kind"));
  EXPECT_THAT(error_of("mesh(wall, 'dodecahedron')"), HasSubstr("\"dodecahedron\" is not a farfield shape"));
  EXPECT_THAT(error_of("mesh(wall, 'none')"), HasSubstr("encloses no fluid"));
  EXPECT_THAT(error_of("mesh(wall, 3)"), HasSubstr("farfield: expected a table"));
  EXPECT_THAT(error_of("half{ wall, axis = 'z', at = 7 }"), HasSubstr("case.lua:3: half at z = 7 m: no part of the surface is on the side that is kept"));
  EXPECT_THAT(error_of("half{ wall, axes = 'z' }"), HasSubstr("did you mean \"axis\"?"));
  EXPECT_THAT(error_of("half(3)"), HasSubstr("half"));
}

TEST_F(Farfield, TextsAreOptions) {
  const auto of = [](const std::string& text) {
    std::string all;
    for (const auto& [name, value] : farfield_of_text(text)) all += name + "=" + value + ";";
    return all;
  };
  EXPECT_EQ(of("none"), "farfield_shape=none;");
  EXPECT_EQ(of("sphere 1 2 3mm radius=100 edge=20"),
            "farfield_shape=sphere;farfield_radius=100;farfield_edge=20;farfield_center_x=1;farfield_center_y=2;farfield_center_z=3mm;");
  EXPECT_EQ(of("tunnel.stl inlet=inflow"), "farfield_shape=surface;farfield_surface=tunnel.stl;farfield_sides=inlet=inflow;");
  EXPECT_EQ(of("box floor=terrain*"), "farfield_shape=box;farfield_floor=terrain*;");
  const auto refused = [](const std::string& text, const std::string& problem) {
    test::expect_error(ErrorCode::bad_argument, problem, [&] { (void)farfield_of_text(text); });
  };
  refused("", "\"\" is not a farfield shape");
  refused("cube", "\"cube\" is not a farfield shape");
  refused("box 1 2 3", "3 coordinates, expected 6 or none");
  refused("sphere 1", "1 coordinates, expected 3 or none");
  refused("box -1 -1 -1 1 1 1 x_min=inlet", "\"inlet\" is not a patch kind");
}

/// Writes hills of 6 x 5 m as an STL file, with normals up or down.
void write_terrain(const std::filesystem::path& path, bool is_down) {
  std::ofstream file(path);
  file << "solid terrain\n";
  const auto vertex = [&](int i, int j) { file << "vertex " << 0.5 * i << " " << 0.5 * j << " " << 0.3 * std::sin(0.7 * i) * std::cos(0.6 * j) << "\n"; };
  const auto facet = [&](int i, int j, int k, int l, int m, int n) {
    file << "facet normal 0 0 0\nouter loop\n";
    vertex(i, j);
    vertex(is_down ? m : k, is_down ? n : l);
    vertex(is_down ? k : m, is_down ? l : n);
    file << "endloop\nendfacet\n";
  };
  for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 10; ++j) {
      facet(i, j, i + 1, j, i + 1, j + 1);
      facet(i, j, i + 1, j + 1, i, j + 1);
    }
  file << "endsolid terrain\n";
}

TEST_F(Farfield, BoxAboveAnOpenSheet) {
  write_terrain(folder / "up.stl", false);
  write_terrain(folder / "down.stl", true);
  const std::string printed = run_text(
      "for _, name in ipairs{ 'up.stl', 'down.stl' } do\n"
      "  local m = mesh(read_surface{ name, allow_open = true }, box{ {0, 0, -1}, {6, 5, 3}, floor = 'terrain', sides = { x_min = 'inflow' } })\n"
      "  m:check() print(table.concat(m.patches, ' '))\nend\n"
      "print(pcall(mesh, read_surface{ 'up.stl', allow_open = true }, box{ {-1, 0, -1}, {6, 5, 3}, floor = 'terrain' }))\n");
  EXPECT_EQ(std::ranges::count(printed, '\n') > 2, true) << printed;
  EXPECT_THAT(printed, HasSubstr("VALID"));
  EXPECT_THAT(printed, testing::Not(HasSubstr("INVALID")));
  EXPECT_THAT(printed, HasSubstr("terrain"));
  EXPECT_THAT(printed, HasSubstr("inflow"));
  EXPECT_THAT(printed, HasSubstr("lie in none of the vertical sides of the box"));
  EXPECT_THAT(printed, HasSubstr("x_min at x = -1 m"));
  for (const bool is_auto : {false, true}) {
    std::vector<std::string> words = {"mesh", "down.stl",   "--layers", "4", "--first-height", "1e-3", "--farfield", "box floor=terrain x_max=outflow",
                                      "-o",   "terrain.su2"};
    if (is_auto) words.push_back("--auto");
    const test::ProcessResult made = test::run_process(test::sterna_program(), words, folder);
    EXPECT_EQ(made.status, k_exit_success) << made.errors;
    const test::ProcessResult info = test::run_process(test::sterna_program(), {"info", "terrain.su2"}, folder);
    for (const char* part : {"terrain", "outflow", "farfield"}) EXPECT_THAT(info.output, HasSubstr(part)) << is_auto;
  }
}

TEST_F(Farfield, OnTheCommandLine) {
  const test::ProcessResult mesh = test::run_process(test::sterna_program(),
                                                     {"mesh", "box.stl", "--layers", "4", "--first-height", "1e-3", "--half", "--set", "half.at=0.5",
                                                      "--farfield", "box -4 0.5 -4 6 4 4 edge=2 x_min=inflow", "-o", "half.su2"},
                                                     folder);
  EXPECT_EQ(mesh.status, k_exit_success) << mesh.errors;
  const test::ProcessResult info = test::run_process(test::sterna_program(), {"info", "half.su2"}, folder);
  for (const char* part : {"inflow", "symmetry", "farfield"}) EXPECT_THAT(info.output, HasSubstr(part));
  const test::ProcessResult half = test::run_process(test::sterna_program(), {"half", "box.stl", "--at", "0.5", "-o", "half.stl"}, folder);
  EXPECT_EQ(half.status, k_exit_success) << half.errors;
  EXPECT_TRUE(std::filesystem::exists(folder / "half.stl"));
}

}  // namespace
}  // namespace sterna::scripting
