#include "scripting/interpreter/script_run.h"

#include <gmock/gmock.h>
#include <chrono>
#include <fstream>
#include <span>
#include <sstream>
#include <thread>

#include "geom/base/error.h"
#include "scripting/interpreter/script_verbs.h"
#include "scripting/verbs/component_verbs.h"
#include "scripting/verbs/model_methods.h"
#include "tests/support/data.h"

namespace sterna::scripting {
namespace {

/// Runs the string as a script in a separate folder; returns its printed output.
std::string run_text(const std::string& text, RunSettings settings = {}, OptionOverrides overrides = {}) {
  const std::filesystem::path folder = test::scratch();
  std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder / "box.stl");
  std::ofstream(folder / "case.lua") << text;
  std::string printed;
  if (settings.threads == 0) settings.threads = 1;
  run_script({.script = folder / "case.lua",
              .overrides = std::move(overrides),
              .print = [&](std::string_view line) { printed += std::string(line) + "\n"; },
              .on_mesh = {}},
             RunContext(std::move(settings)));
  return printed;
}

Error error_of(const std::string& text, RunSettings settings = {}, OptionOverrides overrides = {}) {
  try {
    run_text(text, std::move(settings), std::move(overrides));
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "no error from: " << text;
  return Error({});
}

TEST(ScriptRun, SeesItsSandboxAndNothingElse) {
  EXPECT_EQ(run_text("for _, name in ipairs{ 'dofile', 'loadfile', 'load', 'io', 'os', 'debug', 'package', 'coroutine' } do print(rawget(_G, name)) end"),
            "nil\nnil\nnil\nnil\nnil\nnil\nnil\nnil\n");
  EXPECT_EQ(run_text("print(type(table.sort), type(string.format), type(math.pi), type(utf8.char), type(require))"),
            "function\tfunction\tnumber\tfunction\tfunction\n");
  EXPECT_EQ(run_text("print(mm, cm, inch, ft, 180*deg == math.pi)"), "0.001\t0.01\t0.0254\t0.3048\ttrue\n");
}

TEST(ScriptRun, RandomNumbersFollowFromTheSeedAlone) {
  const std::string three = "print(math.random(1000000), math.random(1000000), math.random())";
  EXPECT_EQ(run_text(three, {.seed = 5}), run_text(three, {.seed = 5}));
  EXPECT_NE(run_text(three, {.seed = 5}), run_text(three, {.seed = 6}));
  EXPECT_EQ(run_text("local a = math.random(1000000); math.randomseed(); print(a == math.random(1000000))"), "true\n");
}

TEST(ScriptRun, PairsHasSameOrderInEveryRun) {
  EXPECT_EQ(
      run_text("local s = '' for k, v in pairs{ wing = 1, body = 2, tail = 3, engine = 4, 5, 6, [2.5] = 7 } do s = s .. k .. '=' .. v .. ' ' end print(s)"),
      "1=5 2=6 2.5=7 body=2 engine=4 tail=3 wing=1 \n");
  EXPECT_EQ(run_text("local n = 0 for k, v in pairs{ [true] = 1, [print] = 2, a = 3 } do n = n + v end print(n)"), "6\n");
  EXPECT_EQ(run_text("local t = { a = 1, b = 2, c = 3 } local s = '' for k in pairs(t) do s = s .. k; t.b = nil end print(s)"), "ac\n");
  EXPECT_EQ(run_text("for k in pairs(setmetatable({}, { __pairs = function() return next, { x = 1 }, nil end })) do print(k) end"), "x\n");
  EXPECT_EQ(error_of("for k in pairs(nil) do end").code(), ErrorCode::script_failed);
}

TEST(ScriptRun, ModulesLieBesideTheScript) {
  const std::filesystem::path folder = test::scratch();
  std::ofstream(folder / "shape.lua") << "print 'loaded'; return { width = 3 }";
  std::ofstream(folder / "case.lua") << "print(require('shape').width + require('shape').width)";
  std::string printed;
  const auto print = [&](std::string_view line) { printed += std::string(line) + "\n"; };
  run_script({.script = folder / "case.lua", .overrides = {}, .print = print, .on_mesh = {}}, RunContext({.threads = 1}));
  EXPECT_EQ(printed, "loaded\n6\n");
  EXPECT_EQ(error_of("require '../secret'").code(), ErrorCode::bad_argument);
  EXPECT_EQ(error_of("require 'absent'").code(), ErrorCode::file_not_found);
}

TEST(ScriptRun, MemoryIsCapped) {
  const std::filesystem::path script = test::scratch() / "case.lua";
  // Lua's own allocations, and those of a verb that runs when the memory limit is reached.
  for (const char* text :
       {"local t = {} for i = 1, 1e9 do t[i] = string.rep('x', 1000) .. i end", "local t = {} while true do t[#t + 1] = sphere{ radius = 1 } end",
        "local t = {} while true do t[#t + 1] = { pairs = help } end", "string.rep('x', 1e9)"}) {
    std::ofstream(script) << text;
    try {
      run_script({.script = script, .overrides = {}, .print = [](std::string_view) {}, .on_mesh = {}, .memory_limit = std::size_t{4} << 20},
                 RunContext({.threads = 1}));
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::script_failed);
      EXPECT_NE(std::string(error.what()).find("4 MiB"), std::string::npos) << error.what();
    }
  }
}

TEST(ScriptRun, StopEndsEvenAScriptThatCatchesEverything) {
  std::stop_source source;
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    source.request_stop();
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(error_of("while true do pcall(function() while true do pcall(error) end end) end", {.stop = source.get_token()}).code(), ErrorCode::cancelled);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

TEST(ScriptRun, ErrorsOfVerbsAreValuesForPcall) {
  EXPECT_EQ(run_text("local ok, e = pcall(read_surface, 'absent.stl'); print(ok, e.code)"), "false\tfile_not_found\n");
  EXPECT_EQ(run_text("local ok, e = pcall(sphere, {radius = 'x'}); print(e.message == tostring(e))"), "true\n");
}

TEST(ScriptRun, ObjectsCannotBeTornApart) {
  EXPECT_EQ(run_text("local s = read_surface 'box.stl'; print(getmetatable(s), pcall(setmetatable, s, {}))").substr(0, 13), "locked\tfalse\t");
  // A method of one type called on an object of another type, and without any object.
  EXPECT_EQ(run_text("local s = read_surface 'box.stl'; print(pcall(s.write, {}), pcall(s.write), (pcall(s.write, 3)))").substr(0, 5), "false");
}

TEST(ScriptRun, InputsBesideScriptAreFoundAndPrinted) {
  EXPECT_EQ(run_text("local s = read_surface{ 'box.stl', unit = mm } print(s) print(s.triangles, s.vertices, s.is_closed, #s.patches, s.length)"),
            "TriMesh: 12 triangles, closed, 1 patch, 0.001 m long\n12\t8\ttrue\t1\t0.001\n");
  EXPECT_EQ(run_text("print(sphere{ radius = 2, edge = 0.5 })"), "sphere, edge 0.500000 m, radius 2.000000 m\n");
}

TEST(ScriptRun, SourcesAreValuesThatPrintThemselves) {
  EXPECT_EQ(run_text("print(box{ {-1, -2, -1}, {9, 2, 3}, size = 50*mm })"), "box, size 0.050000 m\n");
  EXPECT_EQ(run_text("print(sphere{ {0, 0, 0}, radius = 1, size = 0.5 })"), "sphere, radius 1 m, size 0.500000 m\n");
  EXPECT_EQ(run_text("local w = wake{ {1, 0, 0}, {2, 5, 0}, direction = {1, 0, 0}, length = 10, size = 0.1, size_end = 0.4 } print(w.size, #w)"), "0.1\t2\n");
}

TEST(ScriptRun, MistakesInSourcesAreToldWhereTheyAre) {
  const auto message = [](const std::string& text) { return std::string(error_of(text).what()); };
  EXPECT_THAT(message("box{ {0, 0, 0}, size = 1 }"), testing::HasSubstr("expected two points {x, y, z}"));
  EXPECT_THAT(message("box{ {0, 0, 0}, {1, 1, 1}, radius = 1 }"), testing::HasSubstr("unknown key \"radius\""));
  EXPECT_THAT(message("line{ {0, 0, 0}, {1, 1, 1}, size = -1 }"), testing::HasSubstr("size"));
  EXPECT_THAT(message("cylinder{ {0, 0, 0}, {1, 0, 0}, size = 1 }"), testing::HasSubstr("a cylinder needs a radius"));
  EXPECT_THAT(message("volume_mesh{ read_surface 'box.stl', first_height = 1e-3, sources = { 3 } }"),
              testing::HasSubstr("sources, entry 1: expected a source"));
  EXPECT_THAT(message("volume_mesh{ read_surface 'box.stl', first_height = 1e-3, sources = { size_samples 'absent.vtu' } }"), testing::HasSubstr("absent.vtu"));
}

TEST(ScriptRun, WakeSheetsAreCheckedWhereTheyAreMade) {
  EXPECT_EQ(run_text("local w = wake_sheet{ wing = 'main*', length = 1.5 } print(w.wing, w.length)"), "main*\t1.5\n");
  const auto message = [](const std::string& text) { return std::string(error_of(text).what()); };
  EXPECT_THAT(message("wake_sheet{ wings = 'main' }"), testing::HasSubstr("did you mean"));
  EXPECT_THAT(message("wake_sheet{ direction = {0, 0, 0} }"), testing::HasSubstr("zero length"));
  EXPECT_THAT(message("wake_sheet{ direction = {1, 0, 0}, alpha = 2*deg }"), testing::HasSubstr("direction and alpha, beta exclude each other"));
  // The half of a fin in the plane of symmetry has no sheet, and the model consists of nothing else.
  EXPECT_THAT(
      message("volume_mesh{ half(surface_mesh{ wing{ trailing_edge = 0.01, tip = 'flat', sections = { {chord = 1, airfoil = 'naca0012'}, {z = 2} } }:model(), "
              "max_edge = 0.2, min_edge = 0.03, curvature_angle = 40*deg }), layers = 3, first_height = 1e-3, wakes = 'auto' }"),
      testing::HasSubstr("all sheets would lie in planes"));
  EXPECT_THAT(message("volume_mesh{ read_surface 'box.stl', first_height = 1e-3, wakes = 'always' }"),
              testing::HasSubstr("wakes: expected \"auto\" or a list"));
  EXPECT_THAT(message("volume_mesh{ read_surface 'box.stl', first_height = 1e-3, wakes = { wake{ {1, 0, 0}, {2, 5, 0}, direction = {1, 0, 0}, length = 10, "
                      "height = 0.2, size = 0.05 } } }"),
              testing::HasSubstr("is a source of short edges"));
}

TEST(ScriptRun, ActuatorDiscsAreCheckedWhereTheyAreMade) {
  EXPECT_EQ(run_text("local d = actuator_disc{ name = 'prop', center = {-0.4, 0, 0}, radius = 120*cm } print(d.name, d.radius, d.center[1])"),
            "prop\t1.2\t-0.4\n");
  const auto message = [](const std::string& text) { return std::string(error_of(text).what()); };
  EXPECT_THAT(message("actuator_disc{ radius = 1 }"), testing::HasSubstr("needs center (centre of the disc)"));
  EXPECT_THAT(message("actuator_disc{ center = {0, 0, 0} }"), testing::HasSubstr("radius"));
  EXPECT_THAT(message("actuator_disc{ center = {0, 0, 0}, radius = 1, inner = 0.2 }"), testing::HasSubstr("unknown key \"inner\""));
  EXPECT_THAT(message("volume_mesh{ read_surface 'box.stl', first_height = 1e-3, interfaces = { 3 } }"),
              testing::HasSubstr("interfaces, entry 1: expected actuator_disc"));
}

TEST(ScriptRun, OverridesOfTheCommandLineWin) {
  EXPECT_EQ(run_text("print(read_surface{ 'box.stl', unit = mm }.length)", {}, {{"surface.unit", "2"}}), "2.0\n");
  EXPECT_EQ(error_of("print 'started'", {}, {{"surface.unti", "2"}}).code(), ErrorCode::unknown_option);
  EXPECT_EQ(error_of("print 'started'", {}, {{"envelope.layers", "-1"}}).code(), ErrorCode::bad_argument);
}

TEST(ScriptRun, HelpNamesEveryOptionWithItsRange) {
  const std::string text = run_text("help(volume_mesh) help() help 'mesh:check' help(read_surface) help(sphere)");
  for (const char* part : {"layers = automatic (from max_growth and the edge lengths of the walls)  (0 .. 1000, or automatic)", "first_height = required [m]",
                           "split_angle", "findings_per_kind = 10", "mesh:write", "radius = automatic"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
  EXPECT_EQ(error_of("help(3)").code(), ErrorCode::bad_argument);
}

TEST(ScriptRun, DeepRecursionAndWrongErrorValuesFailScript) {
  EXPECT_EQ(error_of("local function f() return 1 + f() end f()").code(), ErrorCode::script_failed);
  EXPECT_EQ(error_of("error({})").code(), ErrorCode::script_failed);
  EXPECT_EQ(error_of("error()").code(), ErrorCode::script_failed);
  EXPECT_EQ(error_of("print(setmetatable({}, {__tostring = function() error('inside') end}))").code(), ErrorCode::script_failed);
}

TEST(ScriptRun, ScriptOfEveryOptionNamesEveryOption) {
  std::ifstream file(test::source_folder() / "scripts" / "02_every_option.lua");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  surfmesh::StitchOptions surface;
  volmesh::MeshCase volume;
  UnionOptions unite;
  OptionTable table = all_options(surface, volume);
  for (Option& option : sterna::options_of(unite)) table.push_back(std::move(option));
  for (const Option& option : table) {
    const std::string name(option.name);
    const std::string without_stage = name.starts_with("farfield_") ? name.substr(9) : name;
    EXPECT_NE(text.find(" " + without_stage + " = "), std::string::npos) << name;
  }
  // All options listed by the help of a verb.
  std::size_t n_options = 0;
  for (const std::span<const ScriptVerb> verbs : {script_verbs(), mesh_methods(), model_methods(), component_methods()})
    for (const ScriptVerb& verb : verbs) {
      std::istringstream help(help_on_options(verb));
      for (std::string line; std::getline(help, line);) {
        const std::size_t start = line.find_first_not_of(' '), end = line.find(" = ");
        if (end == std::string::npos || line.find_first_of(' ', start) != end) continue;
        ++n_options;
        const std::string name = line.substr(start, end - start);
        const std::string without_stage = name.starts_with("farfield_") ? name.substr(9) : name;
        EXPECT_NE(text.find(" " + without_stage + " = "), std::string::npos) << verb.name << ": " << name;
      }
    }
  EXPECT_GT(n_options, 150u);
}

}  // namespace
}  // namespace sterna::scripting
