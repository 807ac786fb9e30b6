// Series of small cases: folders, resuming, failures, locks, stops.
#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <set>
#include <thread>

#include "scripting/report/report_page.h"
#include "scripting/series/case_runners.h"
#include "tests/scripting/report/page_json.h"
#include "tests/scripting/series/series_fixture.h"
#include "tests/support/sanitizers.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Four cases, each with a mesh around a box; p.fail makes one of them fail.
constexpr const char* k_small = R"lua(
local wall = read_surface "box.stl"
local size = require "sizes"
local results = series{ "small",
  over = { height = {0.01, 0.02}, layers = {2, 3} },
  run = jobs{ 2, threads = 1 },
  case = function(p)
    print("case " .. p.name .. " is number " .. p.index)
    if p.layers == 3 and p.height == 0.02 then error("no such thing") end
    volume_mesh{ wall, layers = p.layers, first_height = p.height, farfield = sphere{ radius = size.radius } }:write "mesh.su2"
    return { volume = p.height * 2, text = "x" }
  end }
print(#results.cases, results.failed, results.cases[1].result.volume, results.cases[1].verdict)
)lua";

class Series : public SeriesFixture {
 protected:
  void SetUp() override { prepare(folder_); }
  void prepare(const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    std::filesystem::copy(test::corpus() / "scripts" / "box.stl", folder / "box.stl");
    std::ofstream(folder / "sizes.lua") << "return { radius = 20 }";
  }
  /// Number of cases that ran, according to the log.
  static std::size_t n_run(const test::ProcessResult& result) {
    std::size_t n = 0;
    for (std::size_t at = 0; (at = result.errors.find("small ", at)) != std::string::npos; ++at) ++n;
    std::size_t kept = 0;
    for (std::size_t at = 0; (at = result.errors.find("from an earlier run", at)) != std::string::npos; ++at) ++kept;
    return n - kept;
  }
};

TEST_F(Series, EveryCaseHasFolderWithItsFiles) {
  const test::ProcessResult result = run(k_small);
  EXPECT_EQ(result.status, 1) << result.errors;  // one case fails
  EXPECT_THAT(result.output, HasSubstr("4\t1\t0.02\tVALID"));
  EXPECT_THAT(result.output, HasSubstr("series small: 4 cases"));
  const std::string folder = "small/height=0.01_layers=2/";
  for (const char* name :
       {"case.json", "log.txt", "mesh.su2", "mesh.su2.json", "quality.json", "status.json", "measure.json", "script/case.lua", "script/sizes.lua"})
    EXPECT_TRUE(std::filesystem::exists(folder_ / (folder + name))) << name;
  EXPECT_EQ(text_of(folder + "script/case.lua"), k_small);
  EXPECT_THAT(text_of(folder + "log.txt"), HasSubstr("case height=0.01_layers=2 is number 1"));
  EXPECT_THAT(text_of(folder + "status.json"), HasSubstr("\"status\": \"done\""));
  EXPECT_THAT(text_of(folder + "status.json"), HasSubstr("box.stl"));
  const std::string failed = text_of("small/height=0.02_layers=3/status.json");
  EXPECT_THAT(failed, HasSubstr("\"code\": \"script_failed\""));
  EXPECT_THAT(failed, HasSubstr("case.lua:9: no such thing"));
  EXPECT_THAT(text_of("small/series.json"), HasSubstr("\"failed\": 1"));
  EXPECT_THAT(text_of("small/series.csv"), HasSubstr("case,height,layers,status,verdict,cells,quality,worst,"));
  EXPECT_THAT(text_of("small/series.csv"), HasSubstr(",warnings,seconds,reused,error\n"));
  EXPECT_THAT(text_of("small/series.csv"), HasSubstr("\nheight=0.01_layers=2,0.01,2,done,VALID,"));
}

/// More than one gate warns, the worse one behind the other in the order of gates.
TEST_F(Series, TableAndLogNameTheSameWorstValue) {
  run(R"(local wall = surface_mesh{ aircraft{ wing{ name = "wing", symmetric = true, trailing_edge = 0, sections = {
  { y = 0, chord = 1, airfoil = "naca0012" }, { y = 2, chord = 0.5, sweep = 20*deg } } } }, max_edge = 0.3 }
series{ "small", over = { height = { 1e-3 } },
  case = function(p) volume_mesh{ wall, layers = 4, first_height = p.height, farfield = sphere{ radius = 20 } }:write "mesh.su2" end })");
  const auto mesh = nlohmann::json::parse(text_of("small/height=0.001/status.json"))["mesh"];
  const std::string worst = mesh["worst"], log = text_of("small/height=0.001/log.txt");
  // Which gates warn depends on the triangles of the tip; two of them are needed, or nothing is to be chosen.
  const std::string quality = mesh["quality"], failed = quality.substr(0, quality.find(';'));
  EXPECT_THAT(failed, testing::MatchesRegex("warn: [A-Z0-9]+ [A-Z0-9 ]+"));
  const std::size_t blank = worst.find(' '), line = log.find("  worst  ");
  ASSERT_NE(blank, std::string::npos) << worst;
  ASSERT_NE(line, std::string::npos) << log;
  const std::string first = log.substr(line, log.find('\n', line) - line), first_gate = failed.substr(6, failed.find(' ', 6) - 6);
  EXPECT_THAT(first, HasSubstr(worst.substr(blank) + " ("));
  EXPECT_THAT(first, testing::Not(HasSubstr(first_gate + " warn"))) << "the worst value is that of a later gate";
}

/// The page has a table of all cases, including failed ones, with the results of each: embedded pictures, linked pages.
TEST_F(Series, EndsWithAPageThatComparesItsCases) {
  STERNA_NEEDS(!report_page().empty(), "the report page (npm or its registry, when this was built)");
  run(k_small);
  const nlohmann::json page = test::page_json(folder_ / "small/series.html");
  EXPECT_EQ(page["schema"], "sterna-series-1");
  ASSERT_EQ(page["cases"].size(), 4u);
  EXPECT_EQ(page["parameters"].dump(), "[\"height\",\"layers\"]");
  int n_failed = 0;
  for (const auto& c : page["cases"]) {
    EXPECT_TRUE(c["parameters"].contains("height"));
    if (c["state"] == "failed") {
      ++n_failed;
      EXPECT_THAT(c["error"].get<std::string>(), HasSubstr("no such thing"));
      continue;
    }
    EXPECT_EQ(c["verdict"], "VALID");
    EXPECT_GT(c["figures"]["cells"].get<int>(), 0);
    EXPECT_TRUE(c["figures"].contains("orthogonality"));
    EXPECT_TRUE(c["gates"].contains("G5")) << c["gates"].dump();
  }
  EXPECT_EQ(n_failed, 1);
}

TEST_F(Series, WhatIsDoneIsTakenAsItIs) {
  run(k_small);
  const auto first = snapshot(folder_ / "small");
  const test::ProcessResult again = run(k_small);
  EXPECT_EQ(again.status, 1);
  EXPECT_EQ(n_run(again), 0u) << again.errors;
  EXPECT_EQ(difference(first, snapshot(folder_ / "small")), "");

  // An output that was changed or lost is made again; a foreign file stays.
  std::ofstream(folder_ / "small/height=0.01_layers=2/mesh.su2") << "damaged";
  std::filesystem::remove(folder_ / "small/height=0.01_layers=3/mesh.su2.json");
  std::ofstream(folder_ / "small/height=0.01_layers=3/notes.txt") << "mine";
  EXPECT_EQ(n_run(run(k_small)), 2u);
  EXPECT_EQ(text_of("small/height=0.01_layers=3/notes.txt"), "mine");
  std::filesystem::remove(folder_ / "small/height=0.01_layers=3/notes.txt");
  auto second = snapshot(folder_ / "small");
  second.erase("height=0.01_layers=3/status.json");  // lists the foreign file
  auto expected = first;
  expected.erase("height=0.01_layers=3/status.json");
  EXPECT_EQ(difference(expected, second), "");
}

TEST_F(Series, CaseInputsDecideWhetherItRunsAgain) {
  run(k_small);
  EXPECT_EQ(n_run(run(k_small, {"--seed", "7"})), 4u);
  EXPECT_EQ(n_run(run(k_small, {"--seed", "7", "--tasks", "1", "--threads", "2"})), 0u);
  EXPECT_EQ(n_run(run(k_small, {"--seed", "7", "--set", "envelope.max_growth=1.3"})), 4u);
  run(k_small);
  std::ofstream(folder_ / "sizes.lua") << "return { radius = 21 }";
  EXPECT_EQ(n_run(run(k_small)), 4u);
  std::ofstream(folder_ / "box.stl", std::ios::app) << "\n";
  EXPECT_EQ(n_run(run(k_small)), 4u);
  const std::string retry = std::string(k_small).replace(std::string(k_small).find("over ="), 0, "retry = true, ");
  EXPECT_EQ(n_run(run(retry)), 1u);  // the failed case: retry is not part of the key
  EXPECT_EQ(n_run(run(k_small)), 0u);
}

TEST_F(Series, WhereCasesRunDecidesNothing) {
  const std::string script =
      "series{ \"small\", over = { x = {1, 2} }, cache = false, case = function(p)\n  if p.x == 2 then error(\"two\") end\n  return { y = p.x }\nend";
  EXPECT_EQ(n_run(run(script + " }")), 2u);
  EXPECT_EQ(n_run(run(script + " }")), 0u);
  EXPECT_EQ(n_run(run(script + ",\n  run = jobs{ 1, threads = 1 }, -- here\n}")), 0u);
  EXPECT_EQ(n_run(run(script + ", retry = false }")), 0u);
  EXPECT_EQ(n_run(run(script + " }", {"--retry"})), 1u);
  EXPECT_EQ(n_run(run(script + " }")), 0u);
  EXPECT_EQ(n_run(run(script + " }\nlocal retry = true")), 2u);  // not an entry of the series
}

TEST_F(Series, FailuresOfTheMachineAreTriedAgain) {
  const std::string script =
      "local box = read_surface 'box.stl'\nseries{ 'small', over = { x = {1, 2} }, cache = false, case = function(p)\n"
      "  if p.x == 2 then box:write('../../out/box.stl') else error('one') end\nend }";
  std::ofstream(folder_ / "out") << "a file where a folder is needed, as on a disk that is full";
  const test::ProcessResult first = run(script);
  EXPECT_EQ(first.status, 1);
  EXPECT_THAT(text_of("small/x=2/status.json"), AllOf(HasSubstr("write_failed"), HasSubstr("\"of_machine\": true")));
  EXPECT_THAT(text_of("small/x=1/status.json"), Not(HasSubstr("of_machine")));
  EXPECT_EQ(n_run(run(script)), 1u);
  std::filesystem::remove(folder_ / "out");
  EXPECT_EQ(n_run(run(script)), 1u);
  EXPECT_THAT(text_of("small/x=2/status.json"), HasSubstr("\"status\": \"done\""));
  EXPECT_EQ(n_run(run(script)), 0u);
}

TEST_F(Series, TasksAndThreadsDoNotChangeAByte) {
  run(k_small);
  const std::filesystem::path other = folder_ / "other";
  prepare(other);
  run(k_small, {"--tasks", "1", "--threads", "2"}, other);
  EXPECT_EQ(difference(snapshot(folder_ / "small"), snapshot(other / "small")), "");
}

TEST_F(Series, ASecondSeriesKnowsTheFirst) {
  const std::string script = R"lua(
local first = series{ "first", over = { x = range(1, 3) }, cache = false, case = function(p) return { square = p.x^2 } end }
local sum = 0
for _, c in ipairs(first.cases) do sum = sum + c.result.square end
local second = series{ "second", over = { y = {sum} }, case = function(p) return { y = p.y, first = first.cases[2].name } end }
print(second.cases[1].result.y, second.cases[1].result.first)
)lua";
  const test::ProcessResult result = run(script);
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_THAT(result.output, HasSubstr("14.0\tx=2"));
}

TEST_F(Series, TheReferenceRunsFirstAndTheOthersWait) {
  const std::string script = R"lua(
series{ "s", over = { x = {1, 2, 3} }, run = jobs{ 2, threads = 1 }, reference = { x = 3 }, case = function(p)
  if p.x == FAIL then error("broken") end
  return p.x
end }
)lua";
  const auto with = [&](const std::string& x) { return std::string(script).replace(script.find("FAIL"), 4, x); };
  const test::ProcessResult good = run(with("0"));
  EXPECT_EQ(good.status, 0) << good.errors;
  EXPECT_LT(good.errors.find("x=3"), good.errors.find("x=1"));
  EXPECT_THAT(text_of("s/x=1/status.json"), HasSubstr("s/x=3/status.json"));  // an input of the other cases
  const test::ProcessResult bad = run(with("3"));
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.errors, HasSubstr("x=1: failed: the reference case x=3 gave no result"));
}

TEST_F(Series, ACaseReadsBackWhatItWrote) {
  const std::string script = R"lua(
local wall = read_surface "box.stl"
series{ "s", over = { x = {1, 2} }, case = function(p)
  wall:write "parts/copy.stl"
  return read_surface("parts/copy.stl").triangles
end }
)lua";
  const test::ProcessResult result = run(script);
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_TRUE(std::filesystem::exists(folder_ / "s/x=1/parts/copy.stl"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "parts"));
}

TEST_F(Series, NothingRunsInAWorkerAfterItsCase) {
  const std::string script = R"lua(
local wall = read_surface "box.stl"
pcall(series, { "s", over = { x = {1} }, case = function(p) return p.x end })
pcall(function() wall:write "after.stl" end)
)lua";
  run(script);
  EXPECT_EQ(text_of("s/x=1/log.txt").find("after.stl"), std::string::npos);
  EXPECT_THAT(text_of("s/x=1/status.json"), HasSubstr("done"));
}

// ---- Stopped and killed --------------------------------------------------------------------------------------------------------------------

constexpr const char* k_endless = R"lua(
series{ "small", over = { x = {1, 2, 3} }, run = jobs{ 2, threads = 1 }, case = function(p)
  if p.x > 1 then while true do end end
end }
)lua";

/// Waits until `n` workers run.
std::vector<pid_t> wait_for_workers(pid_t main, std::size_t n) {
  for (;;) {
    const std::vector<pid_t> workers = test::children_of(main);
    if (workers.size() >= n) return workers;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

/// Returns true if the process is neither dead nor a zombie.
bool is_running(pid_t process) {
  const std::string stat = contents("/proc/" + std::to_string(process) + "/stat");
  const std::size_t name_end = stat.rfind(')');
  return name_end != std::string::npos && stat.compare(name_end, 4, ") Z ") != 0;
}

bool wait_for(const std::filesystem::path& file, const std::string& text) {
  for (int i = 0; i < 5000; ++i) {
    if (contents(file).find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return false;
}

TEST_F(Series, CtrlCStopsWorkersAndKeepsFinishedCases) {
  write(k_endless, folder_);
  test::StartedProcess main("/bin/sh", {"-c", "exec \"$0\" run case.lua 2> errors.txt", test::sterna_program().string()}, folder_);
  ASSERT_TRUE(wait_for(folder_ / "small/x=1/status.json", "done"));
  ASSERT_TRUE(wait_for(folder_ / "small/x=3/status.json", "running"));
  const std::vector<pid_t> workers = test::children_of(main.pid());
  EXPECT_EQ(workers.size(), 2u);
  const auto start = std::chrono::steady_clock::now();
  main.signal(SIGINT);
  EXPECT_EQ(main.wait(), 130);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 1.5);  // 1 s, plus the delay of a loaded machine
  for (const pid_t worker : workers) EXPECT_FALSE(is_running(worker));
  EXPECT_THAT(text_of("small/x=2/status.json"), HasSubstr("\"killed\": \"stopped on request\""));
  EXPECT_THAT(text_of("small/x=1/status.json"), HasSubstr("done"));
  EXPECT_THAT(text_of("errors.txt"), AllOf(HasSubstr("1 of 3 cases are complete and stored in"), HasSubstr("run the same command to continue")));
}

TEST_F(Series, AKilledCaseDoesNotStopTheOthers) {
  const std::string script = R"lua(
series{ "small", over = { x = {1, 2, 3} }, run = jobs{ 1, threads = 1 }, case = function(p)
  local wall = read_surface "box.stl"
  wall:write "mark.stl"
  if p.x == 2 and not pcall(read_surface, "go.stl") then while true do end end
end }
)lua";
  write(script, folder_);
  test::StartedProcess main(test::sterna_program(), {"run", "case.lua"}, folder_);
  ASSERT_TRUE(wait_for(folder_ / "small/x=2/status.json", "running"));
  kill(wait_for_workers(main.pid(), 1).front(), SIGKILL);
  EXPECT_EQ(main.wait(), 1);
  EXPECT_THAT(text_of("small/x=2/status.json"), HasSubstr("signal 9 (Killed)"));
  EXPECT_THAT(text_of("small/x=3/status.json"), HasSubstr("done"));
  std::filesystem::copy(folder_ / "box.stl", folder_ / "go.stl");  // affects only case 2 and the other cases that would read the file
  const test::ProcessResult again = run(script);
  EXPECT_EQ(again.status, 0) << again.errors;
  EXPECT_EQ(n_run(again), 1u) << again.errors;
}

TEST_F(Series, WorkersAndLockEndWithMainProcess) {
  write(k_endless, folder_);
  test::StartedProcess main(test::sterna_program(), {"run", "case.lua"}, folder_);
  ASSERT_TRUE(wait_for(folder_ / "small/x=3/status.json", "running"));
  const std::vector<pid_t> workers = test::children_of(main.pid());

  // While the series runs, a second run of it is refused at once, with the reason.
  const test::ProcessResult second = run(k_endless);
  EXPECT_EQ(second.status, 1);
  EXPECT_THAT(second.errors, HasSubstr("another run uses this folder: process " + std::to_string(main.pid()) + " on "));
  EXPECT_LT(second.seconds, test::k_is_sanitized ? 60.0 : 3.0);

  main.signal(SIGKILL);
  main.wait();
  const std::string quick = std::string(k_endless).replace(std::string(k_endless).find("p.x > 1"), 7, "p.x > 9");
  EXPECT_EQ(run(quick).status, 0);
  for (const pid_t worker : workers) EXPECT_FALSE(is_running(worker));
}

// ---- Wrong scripts -------------------------------------------------------------------------------------------------------------------------

TEST_F(Series, SaysWhatIsWrongWithItsTable) {
  const test::ProcessResult result = run("series{ over = { alpha = print }, run = 2, reference = { a = 1 }, cases = function() end, cache = 7 }");
  EXPECT_EQ(result.status, 2);
  EXPECT_THAT(result.errors, HasSubstr("case.lua:1: series: 6 problems in this table"));
  EXPECT_THAT(result.errors, HasSubstr("needs a name as the first entry"));
  EXPECT_THAT(result.errors, HasSubstr("over: alpha: a function cannot be a parameter"));
  EXPECT_THAT(result.errors, HasSubstr("run: expected jobs{ 2 } or slurm{ partition = \"cfd\" }, not a number"));
  EXPECT_THAT(result.errors, HasSubstr("case is missing"));
  EXPECT_THAT(result.errors, HasSubstr("unknown key \"cases\", did you mean \"case\"?"));
  EXPECT_THAT(result.errors, HasSubstr("cache: expected true, false or the name of a folder, not a number"));
  EXPECT_THAT(run("series{ 'a', over = { x = {1, 2} }, reference = { x = 3 }, case = function() end }").errors,
              HasSubstr("reference: no case has these parameters: {\"x\":3}"));
  EXPECT_THAT(run("series{ 'a/b', over = { x = {1} }, case = function() end }").errors, HasSubstr("\"a/b\" is not a valid name"));
  EXPECT_THAT(run("local o = { 'a', over = { x = {1} }, case = function() end } series(o) series(o)").errors, HasSubstr("there is a series \"a\" already"));
  EXPECT_THAT(run("series{ 'a', over = { x = {1} }, case = function() series{ 'b', over = { x = {1} }, case = function() end } end }").errors,
              HasSubstr("a case cannot contain another series"));
  EXPECT_THAT(run("jobs{ 2.5 }").errors, HasSubstr("tasks"));
  EXPECT_THAT(run("slurm{ options = { mem = print } }").errors, HasSubstr("options.mem: expected a string, a number or true, not a function"));
}

/// The program may be replaced while a series runs: the result of a worker from another build must not count as a failure of this build.
TEST(CaseRunners, WorkerOfOtherBuildIsReported) {
  const std::filesystem::path folder = test::scratch();
  const RunContext context;
  const CaseTask task{.of = nullptr, .folder = folder / "case", .key = "ours"};
  const CaseStatus otherwise{.state = CaseState::failed, .key = "ours", .code = "script_failed", .message = "the worker ended without a message"};
  std::filesystem::create_directories(task.folder);
  write_status({.state = CaseState::done, .key = "of last week", .result = "null"}, task.folder);
  prepare(task, context);
  EXPECT_EQ(settle(task, otherwise, context).message, "the worker ended without a message");  // a status left from an earlier run is ignored
  prepare(task, context);
  write_status({.state = CaseState::done, .key = "theirs", .result = "null"}, task.folder);
  const CaseStatus status = settle(task, otherwise, context);
  EXPECT_EQ(status.state, CaseState::killed);
  EXPECT_EQ(status.key, "ours");
  EXPECT_NE(status.message.find("another build of sterna"), std::string::npos);
  EXPECT_EQ(read_status(task.folder, context).state, CaseState::killed);
}

}  // namespace
}  // namespace sterna::scripting
