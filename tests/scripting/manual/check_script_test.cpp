// Checks of a script without meshing, command-line arguments, envelope steps called one by one, help of objects, tracebacks.
#include <gmock/gmock.h>

#include "scripting/interpreter/script_help.h"
#include "scripting/interpreter/script_objects.h"
#include "scripting/lua/script_check.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

class CheckScript : public ScriptFixture {
 protected:
  std::vector<std::string> problems(const std::string& text, OptionOverrides arguments = {}) {
    std::ofstream(folder_ / "case.lua") << text;
    ScriptCheck check;
    check_script({.script = folder_ / "case.lua", .overrides = {}, .print = {}, .on_mesh = {}, .arguments = std::move(arguments)}, check,
                 RunContext({.threads = 1}));
    std::vector<std::string> found;
    for (const ErrorHandle& problem : check.problems) found.emplace_back(problem->what());
    return found;
  }
  std::string run_with(const std::string& text, OptionOverrides arguments) {
    std::ofstream(folder_ / "case.lua") << text;
    std::string printed;
    run_script({.script = folder_ / "case.lua",
                .overrides = {},
                .print = [&](std::string_view line) { printed += std::string(line) + "\n"; },
                .on_mesh = {},
                .arguments = std::move(arguments)},
               RunContext({.threads = 1}));
    return printed;
  }
  std::string error_with(const std::string& text, OptionOverrides arguments) {
    try {
      run_with(text, std::move(arguments));
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }
};

constexpr const char* k_whole_case = R"(
local body = fuselage{ name = "body", frames = { { x = 0, diameter = 0.4 }, { x = 4, diameter = 1.2 } } }
local plane = aircraft{ body }:rotate{ pitch = 4*deg }:rename{ anything = "else" }
plane:write "plane.step"
local again = read_cad "plane.step"
local wall = surface_mesh{ again["wing*"], max_edge = 0.4 }
print(wall.triangles, wall.patches[1], wall.min_angle < 1, #plane.components)
local pre = inspect{ wall, first_height = 1e-3 }
if not pre.ok then error(pre.findings[1].text) end
print(#pre.findings, pre.coverage)
local env = make_envelope{ wall, first_height = 1e-3 }
local tets = tetrahedra{ env, farfield = sphere{ radius = 50 } }
local mesh = finish_mesh{ env, tets }
mesh:check(); mesh:write("a.su2", "a.cgns"); print(mesh.cells, mesh.coverage)
local m = volume_mesh{ wall, first_height = 1e-5, sources = { box{ {0,0,0}, {1,1,1}, size = 0.1 } } }
read_mesh "a.su2"; half(plane); union{ plane, again }; env:write "env.sterna"
local kept = read_stages "env.sterna"
tetrahedra{ kept.envelope }
)";

TEST_F(CheckScript, ACorrectScriptIsCorrectAndWritesNothing) {
  EXPECT_THAT(problems(k_whole_case), testing::IsEmpty());
  EXPECT_THAT(problems("local c = envelope.classify{ surface_mesh{ box{ {0,0,0}, {1,1,1} } } } local e = envelope.initial{ surface_mesh{ box{ {0,0,0}, {1,1,1} "
                       "} }, c, first_height = 1e-3 }\n"
                       "for _, step in ipairs{ 'smooth', 'untangle', 'unwarp', 'retract', 'optimise' } do e = envelope[step]{ e } end e:write 'e.vtu'"),
              testing::IsEmpty());
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) files.push_back(entry.path().filename().string());
  EXPECT_EQ(files, std::vector<std::string>{"case.lua"});
}

/// Values that a solver requires are checked before the mesh is made, not after.
TEST_F(CheckScript, SolversSayWhatTheyNeedBeforeMeshing) {
  const std::string mesh = "local m = volume_mesh{ surface_mesh{ box{ {0,0,0}, {1,1,1} } }, first_height = 1e-3 }\n";
  EXPECT_THAT(problems(mesh + "m:su2_config{ 'a.cfg', reynolds = 1e6, length = 1 }"),
              testing::ElementsAre(testing::AllOf(HasSubstr("case.lua:2: mesh:su2_config"), HasSubstr("Mach number is unknown"))));
  EXPECT_THAT(problems(mesh + "m:foam_case{ 'a', mach = 0.5, reynolds = 1e6, length = 1 }"),
              testing::ElementsAre(testing::AllOf(HasSubstr("case.lua:2: mesh:foam_case"), HasSubstr("state of the gas"))));
  EXPECT_THAT(
      problems(mesh + "m:foam_case{ 'a', reynolds = 1e6, length = 1, kinds = { top = 'slipp' }, boundaries = { prop = { trust = 1 } }, monitor = {'w'} }"),
      testing::ElementsAre(testing::AllOf(HasSubstr("kinds[\"top\"]"), HasSubstr("did you mean \"thrust\"?"), HasSubstr("write monitor = \"w\""))));
  EXPECT_THAT(
      problems(mesh + "m:su2_config{ 'a.cfg', mach = 0.5, altitude = 0, length = 1, reference_area = 1 } m:foam_case{ 'a', reynolds = 1e6, length = 1 }"),
      testing::IsEmpty());
}

TEST_F(CheckScript, ShippedScriptsAreCorrect) {
  std::size_t n_scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::source_folder() / "scripts")) {
    if (entry.path().extension() != ".lua") continue;
    ++n_scripts;
    ScriptCheck check;
    check_script({.script = entry.path(), .overrides = {}, .print = {}, .on_mesh = {}}, check, RunContext({.threads = 1}));
    for (const ErrorHandle& problem : check.problems) ADD_FAILURE() << entry.path().filename() << ": " << problem->what();
  }
  EXPECT_GE(n_scripts, 10u);
}

TEST_F(CheckScript, PlaceholdersWorkEverywhereAndDecideNothing) {
  EXPECT_THAT(
      problems("local m = aircraft{ fuselage{ name = 'body', frames = { { x = 0, diameter = 0.4 }, { x = 4, diameter = 1.2 } } } }:measures()\n"
               "assert(m.wings.wing.span > 3 and m.volume == 7)\n"
               "print(string.format('%.2f m, %d', -m.wings.wing.span / 2 + 1, m.components.body.box[2][3]), 'area ' .. m.area, math.sqrt(m.area), #m.wings)\n"
               "for name, part in pairs(m.components) do print(('%s %g'):format(name, part.area)) end\n"
               "for i, corner in ipairs(m.components.body.box) do assert(corner[1] < i) end\n"
               "local list = {} for _, p in pairs(m.wings) do table.insert(list, p.name) end print(table.concat(list, ', '))\n"
               "local s = sphere{ radius = m.volume ^ (1/3) }\n"
               "volume_mesh{ surface_mesh{ box{ {0,0,0}, {1,1,1} } }, first_height = m.volume * 1e-6, farfield = s }"),
      testing::IsEmpty());
}

TEST_F(CheckScript, AMistakeInsideATableHidesNoneOutside) {
  const auto found = problems("local w = surface_mesh{ box{ {0,0,0}, {1,1,1} } }\nvolume_mesh{ w, first_height = 1e-3, farfeild = sphere{ radus = 100 } }\n");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_THAT(found[0], testing::AllOf(HasSubstr("case.lua:2: sphere"), HasSubstr("\"radus\", did you mean \"radius\"?")));
  EXPECT_THAT(found[1], testing::AllOf(HasSubstr("case.lua:2: volume_mesh"), HasSubstr("\"farfeild\", did you mean \"farfield\"?")));
}

TEST_F(CheckScript, LuaErrorReportsUncheckedLines) {
  const auto found = problems("local settings = {}\nprint(settings.wing.span)\nvolume_mesh{}\n");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0], testing::AllOf(HasSubstr("case.lua:2:"), HasSubstr("the script was not checked after this line")));
  EXPECT_THAT(problems("assert(1 == 2, 'as the user says')\n"), testing::ElementsAre(HasSubstr("as the user says")));  // no placeholder values occur here
}

TEST_F(CheckScript, AnUnknownNameDoesNotEndTheSearch) {
  const auto found = problems(
      "local model = read_smxx 'a.smx'\n"
      "local wall = surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_egde = 0.1 }\n"
      "local a, b = parsec + 1, parsec * 2\n"
      "local f = io.open('x')\n"
      "volume_mesh{ wall, first_height = 1e-3, layerz = 3 }\n");
  ASSERT_EQ(found.size(), 5u);
  EXPECT_THAT(found[0], testing::AllOf(HasSubstr("case.lua:1: unknown name (global 'read_smxx')"), HasSubstr("did you mean read_smx?")));
  EXPECT_THAT(found[1], testing::AllOf(HasSubstr("case.lua:2: surface_mesh"), HasSubstr("did you mean \"max_edge\"?")));
  EXPECT_THAT(found[2], HasSubstr("case.lua:3: unknown name (global 'parsec')"));  // reported once
  EXPECT_THAT(found[3], testing::AllOf(HasSubstr("case.lua:4: unknown name (global 'io')"), HasSubstr("require for modules beside the script")));
  EXPECT_THAT(found[4], testing::AllOf(HasSubstr("case.lua:5: volume_mesh"), HasSubstr("did you mean \"layers\"?")));
  EXPECT_THAT(problems("local ok = pcall(function() return parsec end) assert(not ok)"), testing::IsEmpty());  // the script itself tests for the name
}

TEST_F(CheckScript, DeflectionsAreLookedForInTheFile) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string file = (test::shared_data() / "cpacs" / "d150.xml").string();
  EXPECT_THAT(problems("read_cpacs{ '" + file + "', deflections = { Elevatr = 5*deg } }"),
              testing::ElementsAre(testing::AllOf(HasSubstr("case.lua:1: read_cpacs"), HasSubstr("did you mean \"Elevator\"?"))));
  EXPECT_THAT(problems("read_cpacs{ '" + file + "', deflections = { Elevator = 5*deg } }"), testing::IsEmpty());
}

TEST_F(CheckScript, AllScriptMistakesAreFoundAtOnce) {
  const auto found = problems(
      "local wall = read_surface{ 'absent.stl' }\n"
      "local m = volume_mesh{ wall, layer = 30, first_height = 40*deg, max_growth = 7 }\n"
      "m:write 'a.docx'\n"
      "local tets = tetrahedra{ wall }\n"
      "m:chekc()\n");
  ASSERT_EQ(found.size(), 5u);
  EXPECT_THAT(found[0], testing::AllOf(HasSubstr("case.lua:1: read_surface"), HasSubstr("absent.stl")));
  EXPECT_THAT(found[1], testing::AllOf(HasSubstr("case.lua:2: volume_mesh"), HasSubstr("did you mean \"layers\"?"), HasSubstr("max_growth: 7 is not allowed")));
  EXPECT_THAT(found[2], testing::AllOf(HasSubstr("case.lua:3:"), HasSubstr("a.docx")));
  EXPECT_THAT(found[3], HasSubstr("case.lua:4: tetrahedra: entry 1: expected an envelope"));
  EXPECT_THAT(found[4], testing::AllOf(HasSubstr("case.lua:5:"), HasSubstr("did you mean \"check\"?")));
}

TEST_F(CheckScript, SeriesFunctionRunsOnceWithoutMeshing) {
  const std::string good =
      "local first = series{ 'first', over = { x = {2, 3} }, run = jobs{ 2 }, case = function(p)\n"
      "  local wall = surface_mesh{ box{ {0,0,0}, {1,1,p.x} }, max_edge = 0.5 }\n"
      "  local mesh = volume_mesh{ wall, layers = 3, first_height = y_plus{ 1, mach = 0.3, altitude = 0, length = 1 } }:write(p.name .. '.su2')\n"
      "  mesh:su2_config{ p.name .. '.cfg', mach = 0.3, altitude = 0, length = 1, reference_area = 1 }\n"
      "  return { square = p.x^2, cells = mesh.cells }\n"
      "end }\n"
      "print(first.done + first.cases[2].result.square)\n"
      "series{ 'second', over = zip{ a = range(1, 3), b = {4, 5, 6} }, run = slurm{ partition = 'cfd' }, case = function(p) return wall end }\n";
  EXPECT_THAT(problems("wall = 1 " + good), testing::IsEmpty());
  const auto found = problems(
      "series{ 's', over = { x = {1, 2} }, case = function(p)\n"
      "  local mesh = volume_mesh{ surface_mesh{ box{ {0,0,0}, {1,1,1} } }, layer = 3, first_height = y_plus{ 1, match = 0.3 } }\n"
      "  return mesh.cels\n"
      "end, rum = jobs{ 2 } }\n"
      "series{ 's', over = { x = {1, 2} }, case = function(p)\n"
      "  local mesh = volume_mesh{ surface_mesh{ box{ {0,0,0}, {1,1,1} } }, layer = 3, first_height = y_plus{ 1, match = 0.3 } }\n"
      "  return mesh.cels\n"
      "end }\n");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_THAT(found[0], testing::AllOf(HasSubstr("case.lua:1: series"), HasSubstr("did you mean \"run\"?")));
  EXPECT_THAT(found[1], testing::AllOf(HasSubstr("case.lua:6: y_plus"), HasSubstr("did you mean \"mach\"?")));
  EXPECT_THAT(found[2], testing::AllOf(HasSubstr("case.lua:6: volume_mesh"), HasSubstr("did you mean \"layers\"?")));
  EXPECT_THAT(found[3], testing::AllOf(HasSubstr("case.lua:7:"), HasSubstr("did you mean \"cells\"?")));
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder_)) files.push_back(entry.path().filename().string());
  EXPECT_EQ(files, std::vector<std::string>{"case.lua"});
}

TEST_F(CheckScript, WhatAScriptCatchesIsNoMistake) {
  EXPECT_THAT(problems("local ok, e = pcall(read_surface, 'absent.stl') assert(not ok and e.code == 'file_not_found')"), testing::IsEmpty());
}

TEST_F(CheckScript, IsACommand) {
  std::ofstream(folder_ / "case.lua") << "volume_mesh{ layers = -1 }\nread_surfaces 'a.stl'\n";
  const test::ProcessResult result = test::run_process(test::sterna_program(), {"check-script", "case.lua"}, folder_);
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, testing::AllOf(HasSubstr("case.lua:1: volume_mesh: 3 problems"), HasSubstr("did you mean read_surface?")));
  EXPECT_THAT(result.output, HasSubstr("case.lua: 2 problems"));
  std::ofstream(folder_ / "case.lua") << "print(args.alpha)";
  EXPECT_EQ(test::run_process(test::sterna_program(), {"check-script", "case.lua"}, folder_).status, 0);
}

// ---- args ----------------------------------------------------------------------------------------------------------------------------------

TEST_F(CheckScript, ArgumentsHaveTheTypeOfTheirDefaults) {
  const std::string text = "local p = args{ alpha = 0, height = 1*mm, half = false, name = 'polar', n = 3 } print(p.alpha, p.height, p.half, p.name, p.n)";
  EXPECT_EQ(run_with(text, {}), "0\t0.001\tfalse\tpolar\t3\n");
  EXPECT_EQ(run_with(text, {{"alpha", "4"}, {"height", "2.5mm"}, {"half", "true"}, {"name", "12"}}), "4\t0.0025\ttrue\t12\t3\n");
  EXPECT_EQ(run_with("print(args.alpha + 1, args{ 'alpha' }.alpha)", {{"alpha", "4"}}), "5\t4\n");
}

TEST_F(CheckScript, WrongArgumentsAreErrorsWithASuggestion) {
  EXPECT_THAT(error_with("args{ alpha = 0 }", {{"alhpa", "4"}}), HasSubstr("this script has no argument alhpa, did you mean alpha?"));
  EXPECT_THAT(error_with("args{ alpha = 0, half = true }", {{"alpha", "steep"}, {"half", "2"}}),
              testing::AllOf(HasSubstr("argument alpha=steep: expected a number"), HasSubstr("argument half=2: expected true or false")));
  EXPECT_THAT(error_with("args{ 'alpha' }", {}), HasSubstr("argument alpha is missing: sterna run case.lua alpha=VALUE"));
  EXPECT_THAT(error_with("print(args.alpha)", {{"alhpa", "4"}}), HasSubstr("argument alpha was not given, but alhpa was"));
  std::ofstream(folder_ / "case.lua") << "print(args{ alpha = 0 }.alpha)";
  EXPECT_EQ(test::run_process(test::sterna_program(), {"run", "case.lua", "alpha=4"}, folder_).output, "4\n");
  EXPECT_EQ(test::run_process(test::sterna_program(), {"run", "case.lua", "alpha"}, folder_).status, 2);
}

TEST_F(CheckScript, ScriptAndModulesMayDeclareArguments) {
  std::ofstream(folder_ / "parts.lua") << "local c = args{ span = 10 } return c";
  for (const std::string text : {"local g = args{ level = 'coarse' } local m = require 'parts' print(g.level, m.span)",
                                 "local m = require 'parts' local g = args{ level = 'coarse' } print(g.level, m.span)"}) {
    EXPECT_EQ(run_with(text, {}), "coarse\t10\n");
    EXPECT_EQ(run_with(text, {{"span", "12"}, {"level", "fine"}}), "fine\t12\n");
    EXPECT_THAT(error_with(text, {{"spam", "12"}}), HasSubstr("this script has no argument spam, did you mean span?"));
    EXPECT_THAT(error_with(text, {{"span", "wide"}}), HasSubstr("argument span=wide: expected a number"));
  }
  EXPECT_EQ(run_with("local g = args{ span = 10, level = 'coarse' } local m = require 'parts' print(g.span, m.span)", {{"span", "12"}}), "12\t12\n");
  EXPECT_EQ(run_with("require 'parts' print(args{ level = 'coarse' }.level, args.height)", {{"height", "2"}}), "coarse\t2\n");
  EXPECT_THAT(error_with("args{ span = 11 } require 'parts'", {}),
              testing::AllOf(HasSubstr("parts.lua:1: args"), HasSubstr("argument span: "), HasSubstr("case.lua:1 declares it with another default")));
  EXPECT_THAT(error_with("require 'parts' args{ span = number{ 10, min = 6 } }", {}), HasSubstr("other limits"));
}

TEST_F(CheckScript, UnknownArgumentsAreRefusedBeforeWorkBegins) {
  std::ofstream(folder_ / "parts.lua") << "return args{ span = 10 }";
  // A function that is never called might still declare the argument: the error comes at the end of the script.
  EXPECT_THAT(error_with("args{ level = 1 } local function later() args{ deep = 1 } end", {{"deeep", "2"}}), HasSubstr("no argument deeep"));
  // No other statement can declare the argument: the error comes before the first verb that takes time.
  EXPECT_THAT(error_with("args{ level = 1 } require 'parts' volume_mesh{}", {{"spam", "2"}}), HasSubstr("no argument spam"));
}

TEST_F(CheckScript, WorkersOfASeriesGetTheArguments) {
  std::ofstream(folder_ / "case.lua") << "local p = args{ alpha = 0, name = '' }\nlocal r = series{ 's', over = { x = {1, 2} }, cache = false, case = "
                                         "function(q) return { y = p.alpha + q.x, name = p.name } end }\n"
                                         "print(r.cases[1].result.y, r.cases[2].result.y, r.cases[2].result.name)";
  const test::ProcessResult result =
      test::run_process(test::sterna_program(), {"run", "case.lua", "alpha=-4", "name=a b=c", "--set", "envelope.layers=3"}, folder_);
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("-3\t-2\ta b=c\n"));
  EXPECT_EQ(test::run_process(test::sterna_program(), {"run", "case.lua", "alhpa=4"}, folder_).status, 2);
}

// ---- Envelope step by step ------------------------------------------------------------------------------------------------------------------------

TEST_F(CheckScript, ManualStepsRefusePartsInOwnFrames) {
  const std::string two = "local wall = surface_mesh{ box{ {0,0,0}, {1,1,1} }, box{ {4,0,0}, {5,1,1} }:rotate{ pitch = 10*deg }, max_edge = 0.5 }\n";
  EXPECT_THAT(error(two + "envelope.classify{ wall }"),
              testing::AllOf(HasSubstr("envelope.classify: the wall has 2 parts with envelopes made in their own frames"),
                             HasSubstr("make_envelope{ wall, ... } performs all steps")));
  EXPECT_THAT(error("local wall = surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge = 0.5 }:move{ 0, 0, 1 } envelope.classify{ wall }"),
              HasSubstr("the wall has 1 part with envelopes made in their own frames"));
}

TEST_F(CheckScript, OrderedStepsGiveBytesOfOneVerb) {
  const std::string wall = "local wall = surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge = 0.3 }\n";
  run(wall + "local env = make_envelope{ wall, layers = 4, first_height = 0.01, max_growth = 1.3 } env:write(" + out("one.sterna") +
      ") finish_mesh{ env, tetrahedra{ env, farfield = sphere{ radius = 5 } } }:write(" + out("one.su2") + ")");
  const std::string printed = run(wall +
                                  "local class = envelope.classify{ wall } print(class)\n"
                                  "local env = envelope.initial{ wall, class, layers = 4, first_height = 0.01, max_growth = 1.3 } print(env, env.step)\n"
                                  "env = envelope.smooth{ env }; env = envelope.untangle{ env }\n"
                                  "env:write(" +
                                  out("between.sterna") + ") env = read_stages(" + out("between.sterna") +
                                  ").envelope print(env.step)\n"
                                  "env = envelope.unwarp{ env }; env = envelope.retract{ env }; env = envelope.optimise{ env } print(env)\n"
                                  "env:write(" +
                                  out("steps.sterna") + ") env:write(" + out("env.vtu") +
                                  ") finish_mesh{ env, tetrahedra{ env, farfield = sphere{ radius = 5 } } }:write(" + out("steps.su2") + ")");
  EXPECT_THAT(printed,
              testing::AllOf(HasSubstr("Classification: "), HasSubstr("Envelope, initial: "), HasSubstr("\tinitial\n"), HasSubstr("untangled\nEnvelope: ")));
  EXPECT_EQ(text_of("one.su2"), text_of("steps.su2"));
}

TEST_F(CheckScript, UnfinishedEnvelopesAreRefusedWithReason) {
  const std::string first =
      "local wall = surface_mesh{ union{ box{ {0,0,0}, {1,1,1} }, box{ {0.4,0.4,0.5}, {0.6,0.6,2} } }, max_edge = 0.2 } local class = envelope.classify{ "
      "wall "
      "}\n"
      "local env = envelope.initial{ wall, class, layers = 4, first_height = 0.05, max_thickness = 0.6 }\n";
  EXPECT_THAT(error(first + "tetrahedra{ class }"), HasSubstr("the envelope has no heights yet"));
  EXPECT_THAT(error(first + "tetrahedra{ env }"),
              testing::AllOf(HasSubstr("only initial"), HasSubstr("of its elements are invalid"), HasSubstr("envelope.unwarp{ env }")));
  EXPECT_THAT(error(first + "envelope.retract{ env }"), HasSubstr("expected an envelope that is unwarped at least; this envelope is initial only"));
  EXPECT_THAT(error("envelope.smoth{}"), HasSubstr("did you mean envelope.smooth?"));
  EXPECT_THAT(error(first + "envelope.smooth{ env, height_sweep = 3 }"), HasSubstr("did you mean \"height_sweeps\"?"));
}

// ---- Help, tracebacks ------------------------------------------------------------------------------------------------------------------------

TEST_F(CheckScript, HelpKnowsVerbsObjectsAndOptions) {
  EXPECT_THAT(run("help(surface_mesh{ box{ {0,0,0}, {1,1,1} } })"),
              testing::AllOf(HasSubstr("surface: A triangulated surface"), HasSubstr("surface:write"), HasSubstr("is_closed: ")));
  EXPECT_THAT(run("help 'mesh'"), testing::AllOf(HasSubstr("mesh:check"), HasSubstr("coverage: ")));
  EXPECT_THAT(run("help 'surface:write'"), HasSubstr("Writes a surface."));
  EXPECT_THAT(run("help 'first_height'"), testing::AllOf(HasSubstr("volume_mesh: first_height = required"), HasSubstr("make_envelope: first_height")));
  EXPECT_THAT(run("help(args)"), HasSubstr("alpha=4"));
  EXPECT_THAT(run("help(sphere{ radius = 3 })"), HasSubstr("Spherical farfield"));
  EXPECT_THAT(error("help 'first_hieght'"), HasSubstr("did you mean \"first_height\"?"));
}

TEST_F(CheckScript, FieldsAreThoseThatAreDocumented) {
  const std::string setup =
      "local model = box{ {0,0,0}, {1,1,1} } local surface = surface_mesh{ model, max_edge = 0.5 } local envelope = make_envelope{ surface, layers = 2, "
      "first_height = 0.02 }\n"
      "local tetrahedra = tetrahedra{ envelope, farfield = sphere{ radius = 5 } } local mesh = finish_mesh{ envelope, tetrahedra } local airfoil = airfoil "
      "'naca0012'\n"
      "local component = wing{ sections = { { y = 0, chord = 1, airfoil = 'naca0012' }, { y = 2 } } } local _, error = pcall(sphere, { radius = -1 })\n"
      "local all = { model = model, surface = surface, envelope = envelope, tetrahedra = tetrahedra, mesh = mesh, airfoil = airfoil, component = component, "
      "error = error }\n";
  for (const ObjectKind& kind : object_kinds()) {
    const std::string name(kind.name);
    // The message about a missing field lists the existing fields.
    const std::string message =
        run(setup + "if all." + name + " then print(select(2, pcall(function() return all." + name + ".no_such_field end)).message) end");
    if (message.empty()) continue;  // a kind of object that this test cannot make
    const std::string list = ", " + message.substr(message.find("try: ") + 5, message.find('\n', message.find("try: ")) - message.find("try: ") - 5) + ", ";
    int n_there = 0;
    for (const FieldDoc& field : kind.fields) n_there += list.find(", " + std::string(field.name) + ", ") != std::string::npos ? 1 : 0;
    EXPECT_EQ(n_there + static_cast<int>(kind.methods().size()), std::count(list.begin(), list.end(), ',') - 1)
        << name << " has fields that are not documented: " << list;
  }
}

TEST_F(CheckScript, ErrorsOutOfFunctionsHaveATraceback) {
  const std::string text = error("local function inner(r)\n  return sphere{ radius = r }\nend\nlocal function outer()\n  return (inner(-1))\nend\nouter()\n");
  EXPECT_THAT(text, testing::AllOf(HasSubstr("case.lua:2: sphere"), HasSubstr("called from, innermost first:"), HasSubstr("case.lua:5: in"),
                                   HasSubstr("case.lua:7: in the script")));
  EXPECT_THAT(error("sphere{ radius = -1 }"), testing::Not(HasSubstr("called from")));
}

}  // namespace
}  // namespace sterna::scripting
