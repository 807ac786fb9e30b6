// Whole runs: with a cold or a warm cache, with one or several threads, every output is identical to the byte to that of a run without cache.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <thread>

#include "scripting/cache/stage_cache.h"
#include "scripting/interpreter/script_run.h"
#include "tests/support/data.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

using Files = std::map<std::string, std::string>;

class CachedRun : public testing::Test {
 protected:
  /// Runs a script whose outputs are named "OUT/..." and returns the outputs together with the printed text (as "printed").
  Files run(std::string text, bool is_cached, int threads = 1, const OptionOverrides& overrides = {}) {
    std::filesystem::remove_all(folder_ / "out");
    std::filesystem::create_directories(folder_ / "out");
    text = std::regex_replace(text, std::regex("OUT/"), (folder_ / "out").string() + "/");
    text = std::regex_replace(text, std::regex("IN/"), folder_.string() + "/");
    std::ofstream(folder_ / "case.lua") << text;
    log_.clear();
    Files files;
    const RunContext context({.threads = threads, .log = [&](LogLevel level, std::string_view line) {
                                log_ += (level == LogLevel::warning ? "warning: " : "") + std::string(line) + "\n";
                              }});
    const StageCache cache({.folder = folder_ / "cache"});
    run_script({.script = folder_ / "case.lua",
                .overrides = overrides,
                .print = [&](std::string_view line) { files["printed"] += std::string(line) + "\n"; },
                .cache = is_cached ? &cache : nullptr},
               context);
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out")) files[entry.path().filename().string()] = bytes_of(entry.path());
    return files;
  }
  static std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void expect_same(const Files& found, const Files& expected, const std::string& what) {
    EXPECT_EQ(found.size(), expected.size()) << what;
    for (const auto& [name, bytes] : expected) {
      const auto it = found.find(name);
      ASSERT_NE(it, found.end()) << what << ": " << name;
      EXPECT_TRUE(it->second == bytes) << what << ": " << name << " has other bytes";
    }
  }
  int n_reused() const {
    int n = 0;
    for (std::size_t at = 0; (at = log_.find(": from the cache", at)) != std::string::npos; ++at) ++n;
    return n;
  }
  std::map<std::string, int> entries() const {
    std::map<std::string, int> count;
    for (const CacheEntry& entry : StageCache::entries(folder_ / "cache")) ++count[entry.stage];
    return count;
  }

  const std::filesystem::path folder_ = test::scratch();
  std::string log_;
};

/// A capsule: written as STEP, read back, meshed, and written in every format.
const std::string k_model = "local m = box{ {0,0,0}, {2,1,1}, name='block' }:rotate{ pitch=5*deg } ";
const std::string k_case = k_model +
                           "local wall = surface_mesh{ m, max_edge=0.7 } print(wall) print(wall.length, wall.min_angle, wall.smooth_angle, wall.crossings) "
                           "wall:write 'OUT/wall.stl' wall:write 'OUT/wall.vtu' "
                           "local mesh = volume_mesh{ wall, layers=3, first_height=0.01, farfield=sphere{ radius=6, edge=3 } } "
                           "print(mesh) print(mesh.coverage, mesh.mean_height) mesh:check() "
                           "mesh:write('OUT/a.su2', 'OUT/a.vtu', 'OUT/a.cgns', 'OUT/a.sterna', 'OUT/a.taumesh', 'OUT/a.ugrid')";

TEST_F(CachedRun, CadOutputsAreEqualWithAndWithoutCache) {
  run(k_model + "m:write 'IN/block.step'", false);
  const std::string text = "local m = read_cad 'IN/block.step' " + k_case.substr(k_model.size());
  const Files without = run(text, false);
  EXPECT_GE(without.size(), 15u);
  EXPECT_THAT(without.at("a.su2.json"), HasSubstr("block.step"));
  expect_same(run(text, true), without, "cold");
  EXPECT_EQ(n_reused(), 0);
  EXPECT_EQ(entries(), (std::map<std::string, int>{{"read_cad", 1}, {"surface_mesh", 1}, {"envelope", 1}, {"volume_mesh", 1}}));
  expect_same(run(text, true), without, "warm");
  EXPECT_EQ(n_reused(), 3);
  EXPECT_THAT(log_, AllOf(HasSubstr("read_cad of "), HasSubstr("surface_mesh of block: from the cache"), HasSubstr("volume_mesh of ")));
  expect_same(run(text, true, 2), without, "warm, two threads");
  EXPECT_EQ(n_reused(), 3);
  // The same file under another path yields the same meshes, but manifests contain the path as the user wrote it.
  std::filesystem::create_directories(folder_ / "sub");
  std::filesystem::copy_file(folder_ / "block.step", folder_ / "sub" / "block.step");
  const Files moved = run(std::regex_replace(text, std::regex("IN/block"), "IN/sub/block"), true);
  EXPECT_EQ(n_reused(), 2) << "the model is read again, under its other name";
  EXPECT_TRUE(moved.at("a.su2") == without.at("a.su2"));
  EXPECT_THAT(moved.at("a.su2.json"), HasSubstr("sub/block.step"));
}

TEST_F(CachedRun, StagesRepeatFromTheFirstChangedOption) {
  const std::string more =
      "local mesh = volume_mesh{ surface_mesh{ box{ {0,0,0}, {2,1,1}, name='b' }, max_edge=EDGE }, layers=2, first_height=0.01, farfield=sphere{ radius=6, "
      "edge=3 }, improve_rounds=ROUNDS } mesh:write 'OUT/a.su2'";
  const auto text = [&](const std::string& edge, const std::string& rounds) {
    return std::regex_replace(std::regex_replace(more, std::regex("EDGE"), edge), std::regex("ROUNDS"), rounds);
  };
  run(text("0.7", "30"), true);
  const Files fewer = run(text("0.7", "2"), true);
  EXPECT_EQ(n_reused(), 2);
  EXPECT_THAT(log_, AllOf(HasSubstr("surface_mesh of b: from the cache"), HasSubstr("envelope of ")));
  expect_same(fewer, run(text("0.7", "2"), false), "envelope from the cache");
  run(text("0.6", "2"), true);
  EXPECT_EQ(n_reused(), 0);
  run(text("0.7", "2"), true, 1, {{"surface_mesh.max_edge", "0.7"}, {"improve.improve_rounds", "30"}});
  EXPECT_EQ(n_reused(), 2) << "options of the command line win, and count";
  EXPECT_THAT(log_, HasSubstr("volume_mesh of "));
}

TEST_F(CachedRun, ManualStepsAndStoredStagesGiveSameBytes) {
  const std::string text =
      k_model +
      "local w = surface_mesh{ m, max_edge=0.8 } local ff = sphere{ radius=6, edge=3 } "
      "local e = make_envelope{ w, layers=2, first_height=0.01, farfield=ff } local t = tetrahedra{ e, farfield=ff } local mesh = prisms{ e, t } "
      "e:write 'OUT/e.sterna' t:write 'OUT/t.sterna' mesh:write 'OUT/m.sterna' "
      "volume_mesh{ w, layers=2, first_height=0.01, farfield=ff, stages='OUT/s.sterna' }:write 'OUT/v.sterna'";
  const Files without = run(text, false);
  expect_same(run(text, true), without, "cold");
  EXPECT_THAT(log_, HasSubstr("envelope of ")) << "volume_mesh has it from make_envelope";
  expect_same(run(text, true), without, "warm");
  EXPECT_THAT(log_, AllOf(HasSubstr("envelope of "), HasSubstr("tetrahedra of "), HasSubstr("prisms of ")));
}

TEST_F(CachedRun, NewVerticesOfCachedWallLieOnModel) {
  const std::string text =
      "local w = surface_mesh{ cylinder{ {0,0,0}, {2,0,0}, radius=1, name='can' }, max_edge=0.6, curvature_angle=30*deg } "
      "volume_mesh{ w, layers=4, first_height=1e-3, farfield=sphere{ radius=15 }, improve_rounds=ROUNDS, sources={ sphere{ {3,0,0}, radius=1, size=0.15 } }, "
      "tetrahedra={ boundary_splits='always', radius_edge=1.6 } }:write 'OUT/a.su2'";
  run(std::regex_replace(text, std::regex("ROUNDS"), "3"), true);
  const std::string again = std::regex_replace(text, std::regex("ROUNDS"), "4");
  const Files warm = run(again, true);
  EXPECT_THAT(log_, HasSubstr("surface_mesh of can: from the cache"));
  EXPECT_THAT(warm.at("a.su2.json"), HasSubstr("boundary_triangles_added_by_splits"));
  expect_same(warm, run(again, false), "wall from the cache");
}

// ---- Models --------------------------------------------------------------------------------------------------------------------------------

/// Reads, unites, moves, halves, meshes and writes models, so that cached models are used in every way. FOUR is the value that a user changes between cases.
const std::string k_models =
    "local body = fuselage{ name='body', frames={ {x=0, height=0}, {x=1, height=1}, {x=4, height=1}, {x=6, height=0.1} } } "
    "local w = wing{ name='wing', symmetric=true, position={2, 0, -0.1}, sections={ { y=0, chord=1.4, airfoil='naca0012' }, { y=3, chord=0.7, "
    "airfoil='naca0012' } } } "
    "local plane = aircraft{ body, w } print(plane) "
    "local tank = read_cad 'IN/tank.step' print(tank, tank.report) "
    "local both = assembly{ plane, tank:move{ 2, 0, -3 } } local united = union{ tank, box{ {1, -0.2, -0.2}, {3, 0.2, 0.2}, name='bar' } } "
    "local m = assembly{ both, united:move{ 0, 0, FOUR } }:rotate{ pitch=3*deg } print(m) "
    "surface_mesh{ m, max_edge=0.7 }:write 'OUT/m.stl' ";

TEST_F(CachedRun, ModelsComeBackAsTheyWere) {
  run("cylinder{ {0,0,0}, {2,0,0}, radius=0.5, name='tank' }:write 'IN/tank.step'", false);
  const auto text = [](const std::string& four) { return std::regex_replace(k_models, std::regex("FOUR"), four); };
  const Files without = run(text("4"), false);
  expect_same(run(text("4"), true), without, "cold");
  const std::map<std::string, int> kept = entries();
  for (const char* stage : {"aircraft", "read_cad", "union"}) EXPECT_EQ(kept.count(stage), 1u) << stage;
  EXPECT_GE(kept.at("assembly"), 2);
  expect_same(run(text("4"), true), without, "warm");
  EXPECT_THAT(log_, AllOf(HasSubstr("aircraft: from the cache"), HasSubstr("read_cad of "), HasSubstr("union of "), HasSubstr("assembly of "),
                          Not(HasSubstr("runs again"))));
  const Files other = run(text("5"), false);
  EXPECT_FALSE(other.at("m.stl") == without.at("m.stl"));
  expect_same(run(text("5"), true), other, "another place of the union");
  EXPECT_THAT(log_, HasSubstr("union of "));
}

TEST_F(CachedRun, CachedModelMakesOpenCascadeShapeOnDemand) {
  run("cylinder{ {0,0,0}, {2,0,0}, radius=0.5, name='tank' }:write 'IN/tank.step'", false);
  const std::string read = "local tank = read_cad 'IN/tank.step' ";
  const auto text = [&](const std::string& name) {
    return read + "union{ tank, box{ {1, -0.2, -0.2}, {3, 0.2, 0.2}, name='" + name +
           "' } }:write('OUT/u.brep') tank:write('OUT/t.brep', 'OUT/t.step') half{ tank }:write 'OUT/h.brep' ";
  };
  run(read, true);
  for (const char* name : {"bar", "rod"}) {
    const Files without = run(text(name), false);
    expect_same(run(text(name), true), without, name);
    EXPECT_THAT(log_, AllOf(HasSubstr("read_cad of "), HasSubstr("read_cad: runs again")));
    expect_same(run(text(name), true), without, std::string(name) + ", warm");
    EXPECT_THAT(log_, HasSubstr("union of "));
  }
}

TEST_F(CachedRun, ComponentsCountAsTheyAreAtTheCall) {
  const std::string text =
      "local w = wing{ name='w', sections={ { y=0, chord=1, airfoil='naca0012' }, { y=2, chord=1, airfoil='naca0012' } } } "
      "local first = aircraft{ w } w:move{ 0, 0, 1 } local second = aircraft{ w } first:write 'OUT/first.brep' second:write 'OUT/second.brep' "
      "print(first.min[3], second.min[3])";
  const Files without = run(text, false);
  EXPECT_FALSE(without.at("first.brep") == without.at("second.brep"));
  expect_same(run(text, true), without, "cold");
  expect_same(run(text, true), without, "warm");
  EXPECT_THAT(log_, HasSubstr("aircraft: from the cache"));
}

TEST_F(CachedRun, RealModelsComeBackAsTheyWere) {
  STERNA_NEEDS_SHARED_DATA();
  for (const char* file :
       {"cad/tigl_simplewing_simplewing.brep", "cad/onera_m6_su2_geom_oneram6.IGS", "cad/gmsh_t106_blade_mesh_T106_V3.step", "cpacs/simpletest-nacelle.xml"}) {
    const std::string path = (test::shared_data() / file).string();
    const std::string text = std::string("local m = ") + (path.ends_with(".xml") ? "read_cpacs" : "read_cad") + " '" + path +
                             "' print(m) m:rotate{ pitch=2*deg }:write 'OUT/m.step'";
    const Files without = run(text, false);
    expect_same(run(text, true), without, std::string(file) + ", cold");
    EXPECT_EQ(n_reused(), 0) << file;
    expect_same(run(text, true), without, std::string(file) + ", warm");
    EXPECT_EQ(n_reused(), 1) << file << "\n" << log_;
  }
}

// ---- Functions -----------------------------------------------------------------------------------------------------------------------------

TEST_F(CachedRun, AFunctionCountsByWhatItReturns) {
  const auto text = [](const std::string& function) {
    return "local n = 0 local f = " + function +
           " local w = surface_mesh{ box{ {0,0,0}, {2,1,1}, name='b' }, max_edge=0.9, size=function(x, y, z) n = n + 1 return f(x, y, z) end } w:write "
           "'OUT/w.stl' print(n, w)";
  };
  const std::string f = "function(x, y, z) return 0.3 + 0.2*x end", other = "function(x, y, z) return x > 1 and 0.2 or 0.3 + 0.2*x end",
                    third = "function(x, y, z) return 0.4 end";
  const Files of_f = run(text(f), false), of_other = run(text(other), false), of_third = run(text(third), false);
  EXPECT_FALSE(of_f.at("w.stl") == of_other.at("w.stl"));
  expect_same(run(text(f), true), of_f, "cold");
  EXPECT_EQ(n_reused(), 0);
  expect_same(run(text(f), true), of_f, "warm: asked as often as without");
  EXPECT_EQ(n_reused(), 1);
  expect_same(run(text(other), true), of_other, "other values");
  EXPECT_EQ(n_reused(), 0);
  expect_same(run(text(third), true), of_third, "third function");
  EXPECT_EQ(n_reused(), 0);
  for (const auto& [function, files] : {std::pair{f, of_f}, {other, of_other}, {third, of_third}}) {
    expect_same(run(text(function), true), files, function);
    EXPECT_EQ(n_reused(), 1) << function;
  }
  const std::string twice = "function(x, y, z) return (0.6 + 0.4*x)/2 end";
  expect_same(run(text(twice), true), run(text(twice), false), "written in another way");
  run(text(twice), true);
  EXPECT_EQ(n_reused(), 1);
}

TEST_F(CachedRun, AFunctionWithAMemoryIsNotFooled) {
  const std::string text =
      "local n = 0 local w = surface_mesh{ box{ {0,0,0}, {2,1,1}, name='b' }, max_edge=0.9, size=function(x, y, z) n = n + 1 return n % 7 == PHASE and 0.35 or "
      "0.5 end } w:write 'OUT/w.stl' print(n, math.random())";
  for (const char* phase : {"0", "3", "0", "3", "5"}) {
    const std::string with_phase = std::regex_replace(text, std::regex("PHASE"), phase);
    expect_same(run(with_phase, true), run(with_phase, false), phase);
  }
}

TEST_F(CachedRun, FunctionErrorsDuringCacheLookupReachUser) {
  const std::string text =
      "local ok, e = pcall(surface_mesh, { box{ {0,0,0}, {2,1,1}, name='b' }, max_edge=0.9, size=function(x, y, z) if x > LIMIT then error('too far') end "
      "return 0.5 end }) print(ok, ok or e.message:match('too far'))";
  const auto printed = [&](const std::string& limit) { return run(std::regex_replace(text, std::regex("LIMIT"), limit), true).at("printed"); };
  EXPECT_EQ(printed("5"), "true\ttrue\n");
  EXPECT_EQ(printed("1"), "false\ttoo far\n");
  EXPECT_EQ(entries(), (std::map<std::string, int>{{"surface_mesh", 1}}));
}

TEST_F(CachedRun, ModelsAreWhatTheyWereMadeOf) {
  const auto reused = [&](const std::string& model) {
    run("local m = " + model + " surface_mesh{ m, max_edge=0.9 }", true);
    std::istringstream lines(log_);  // only lines for the whole surface count; a part that was only moved comes from the cache anyway
    for (std::string line; std::getline(lines, line);)
      if (line.find("surface_mesh of ") != std::string::npos && line.ends_with(": from the cache") && line.find("in its own frame") == std::string::npos)
        return true;
    return false;
  };
  const std::string box = "box{ {0,0,0}, {2,1,1}, name='b' }";
  EXPECT_FALSE(reused(box));
  EXPECT_TRUE(reused(box));
  EXPECT_TRUE(reused("box{ name='b', {0,0,0}, {4/2,1,1} }"));
  for (const std::string other : {"box{ {0,0,0}, {2,1,1.25}, name='b' }", "box{ {0,0,0}, {2,1,1}, name='c' }", "BOX:move{ 0, 0, 1 }", "BOX:rotate{ pitch=0.1 }",
                                  "BOX:rotate{ pitch=0.1, about={1,0,0} }", "BOX:scale(0.8)", "BOX:mirror{}", "BOX:rename{ b='d' }", "BOX:kinds{ b='slip' }",
                                  "assembly{ BOX, cylinder{ {4,0,0}, {5,0,0}, radius=0.5, name='c' } }",
                                  "BOX:deform{ function(x, y, z) return 0, 0, 0.1*x end }", "BOX:deform{ function(x, y, z) return 0, 0, 0.2*x end }",
                                  "wing{ name='w', sections={ { y=0, chord=1, airfoil='naca0012' }, { y=2, chord=1, airfoil='naca0012' } } }",
                                  "wing{ name='w', sections={ { y=0, chord=1, airfoil='naca0012' }, { y=2, chord=1, airfoil='naca0015' } } }"}) {
    const std::string model = std::regex_replace(other, std::regex("BOX"), box);
    EXPECT_FALSE(reused(model)) << model;
    EXPECT_TRUE(reused(model)) << model;
  }
  EXPECT_TRUE(reused(box + ":deform{ function(a, b, c) local s = 0.2*a return 0, 0, s/2 end }")) << "the same values";
  run("local w = wing{ name='w', sections={ { y=0, chord=1, airfoil='naca0012' }, { y=2, chord=1, airfoil='naca0012' } } } w:move{ 0, 0, 1 } surface_mesh{ w, "
      "max_edge=0.9 }",
      true);
  EXPECT_EQ(n_reused(), 0) << "components change in place";
}

// ---- Damage, other processes ---------------------------------------------------------------------------------------------------------------

TEST_F(CachedRun, DamagedEntriesOfARunAreMadeAnew) {
  const Files without = run(k_case, false);
  run(k_case, true);
  for (const std::size_t location : {0u, 30u, 60u, 500u}) {
    for (const CacheEntry& entry : StageCache::entries(folder_ / "cache")) {
      std::string bytes = bytes_of(entry.file);
      bytes[std::min(location, bytes.size() - 1)] ^= 1;
      if (location == 500u) bytes.resize(bytes.size() / 2);
      std::ofstream(entry.file, std::ios::binary) << bytes;
    }
    expect_same(run(k_case, true), without, "damaged at " + std::to_string(location));
    EXPECT_EQ(n_reused(), 0);
    EXPECT_THAT(log_, HasSubstr("warning: cache: "));
    expect_same(run(k_case, true), without, "made anew");
    EXPECT_EQ(n_reused(), 2);
  }
}

TEST_F(CachedRun, TwoProcessesAtOnceAndOneKilled) {
  std::ofstream(folder_ / "case.lua") << "volume_mesh{ surface_mesh{ box{ {0,0,0}, {2,1,1}, name='b' }, max_edge=0.5 }, layers=3, first_height=0.01, "
                                         "farfield=sphere{ radius=6, edge=2 } }:write 'a.su2'";
  const auto started = [&](const std::string& name, const std::vector<std::string>& more, double interrupt_after = -1.0) {
    std::filesystem::create_directories(folder_ / name);
    std::vector<std::string> arguments = {"run", "../case.lua", "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return test::run_process(test::sterna_program(), arguments, folder_ / name, interrupt_after);
  };
  ASSERT_EQ(started("plain", {}).status, 0);
  // The process is killed at several moments, one after the other. Its progress depends on the machine, and the last run may finish.
  for (const char* seconds : {"0.02", "0.05", "0.1", "0.2", "0.4"})
    test::run_process("/usr/bin/timeout", {"-s", "KILL", seconds, test::sterna_program().string(), "run", "../case.lua", "--cache", "../cache"},
                      folder_ / "plain");
  std::vector<std::thread> processes;
  std::vector<test::ProcessResult> results(2);
  for (int i = 0; i < 2; ++i)
    processes.emplace_back([&, i] { results[static_cast<std::size_t>(i)] = started("at_once_" + std::to_string(i), {"--cache", "../cache"}); });
  for (std::thread& process : processes) process.join();
  const test::ProcessResult last = started("last", {"--cache", "../cache"});
  for (const test::ProcessResult& result : {results[0], results[1], last}) {
    EXPECT_EQ(result.status, 0) << result.errors;
    EXPECT_THAT(result.errors, Not(HasSubstr("warning: cache")));
  }
  EXPECT_THAT(last.errors, HasSubstr("volume_mesh of "));
  for (const char* name : {"at_once_0", "at_once_1", "last"})
    for (const char* file : {"a.su2", "a.su2.json"}) EXPECT_TRUE(bytes_of(folder_ / name / file) == bytes_of(folder_ / "plain" / file)) << name << " " << file;
  EXPECT_THAT(test::run_process(test::sterna_program(), {"cache", "--folder", "cache", "--list"}, folder_).output,
              AllOf(HasSubstr("surface_mesh"), HasSubstr("envelope"), HasSubstr("volume_mesh")));
  EXPECT_THAT(test::run_process(test::sterna_program(), {"cache", "--folder", "cache", "--clear"}, folder_).output, HasSubstr("removed 3 entries"));
}

TEST_F(CachedRun, CommandLineMeshUsesTheCache) {
  run("surface_mesh{ box{ {0,0,0}, {2,1,1}, name='b' }, max_edge=0.7 }:write 'IN/b.stl' box{ {0,0,0}, {2,1,1}, name='b' }:write 'IN/b.step'", false);
  for (const std::string input : {"b.stl", "b.step"}) {
    const auto mesh = [&](const std::string& output, const std::vector<std::string>& more) {
      std::filesystem::create_directories(folder_ / output);
      std::vector<std::string> arguments = {"mesh",           input, "--layers", "2", "--first-height", "0.01", "--farfield", "sphere radius=6 edge=3", "-o",
                                            output + "/a.su2"};
      arguments.insert(arguments.end(), more.begin(), more.end());
      return test::run_process(test::sterna_program(), arguments, folder_);
    };
    EXPECT_EQ(mesh("plain", {}).status, 0);
    EXPECT_EQ(mesh("cold", {"--cache", "of_mesh"}).status, 0);
    const test::ProcessResult warm = mesh("warm", {"--cache", "of_mesh", "--stats", "stats.json"});
    EXPECT_THAT(warm.errors, HasSubstr("from the cache"));
    for (const char* folder : {"cold", "warm"})
      for (const char* file : {"a.su2", "a.su2.json"})
        EXPECT_TRUE(bytes_of(folder_ / folder / file) == bytes_of(folder_ / "plain" / file)) << input << " " << folder << " " << file;
  }
}

}  // namespace
}  // namespace sterna::scripting
