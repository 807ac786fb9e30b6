// Gate G22 as a user runs it.
#include "scripting/cli/determinism.h"

#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "scripting/terminal/exit_status.h"
#include "tests/support/data.h"
#include "tests/support/error_of.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class Determinism : public testing::Test {
 protected:
  Determinism() {
    fs::create_directory(temporary);
    setenv("TMPDIR", temporary.c_str(), 1);
    fs::copy(test::corpus() / "scripts" / "box.stl", folder / "box.stl");
  }
  ~Determinism() override { unsetenv("TMPDIR"); }
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder); }
  void write(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  }
  bool is_left_clean() { return fs::is_empty(temporary); }

  const fs::path folder = test::scratch();
  const fs::path temporary = folder / "tmp";
};

TEST_F(Determinism, MeshesAreEqualForAnyNumberOfThreads) {
  // Reads a file of the folder and one that it wrote itself.
  write(folder / "scripts/case.lua",
        "local a = args{ layers = 2 } local wall = read_surface 'box.stl' wall:write 'wall.stl' local mesh = volume_mesh{ read_surface 'wall.stl', layers = "
        "a.layers, first_height = 1e-2, farfield = sphere{ radius = 20 } } "
        "mesh:write('box.su2', 'box.vtu') ");
  const test::ProcessResult result = sterna({"determinism", "scripts/case.lua", "layers=3", "--threads", "1,2,2"});
  ASSERT_EQ(result.status, k_exit_success) << result.errors << result.output;
  EXPECT_THAT(result.output, AllOf(HasSubstr("G22 determinism: pass, 5 files equal for 1, 2 and 2 threads"), HasSubstr("box.su2.json"), HasSubstr("wall.stl")));
  EXPECT_THAT(result.errors, AllOf(HasSubstr("run 1 of 3: 1 thread"), HasSubstr("run 3 of 3: 2 threads")));
  EXPECT_TRUE(is_left_clean());
  EXPECT_FALSE(fs::exists(folder / "box.su2"));
  const auto json = nlohmann::json::parse(sterna({"determinism", "--threads", "1,2", "scripts/case.lua", "--json"}).output);
  EXPECT_EQ(json["schema"], "sterna-determinism-1");
  EXPECT_EQ(json["state"], "pass");
  EXPECT_EQ(json["threads"], (std::vector{1, 2}));
  ASSERT_EQ(json["files"].size(), 5u);
  EXPECT_EQ(json["files"][0]["xxh3_128"].get<std::string>().size(), 32u);
}

/// HXT reads memory that it has not written, or has given back (the key of glibc's cache differs from run to run); glibc fills what it gives out and takes back
/// with the bytes that MALLOC_PERTURB_ asks for, which our own process must not see, either.
TEST_F(Determinism, MeshesDoNotDependOnMemoryContent) {
  STERNA_NEEDS_SHARED_DATA();
  const std::string wall = (test::shared_data() / "surfaces/clean/pygeo_bwb.stl").string();
  std::vector<std::string> meshes;
  for (const char* fill : {"0", "85", "170", "0", "0", "0"}) {
    setenv("MALLOC_PERTURB_", fill, 1);
    const test::ProcessResult result = sterna({"mesh", wall, "--layers", "10", "--first-height", "1e-4", "--engine", "hxt", "--quiet", "-o", "bwb.su2"});
    unsetenv("MALLOC_PERTURB_");
    ASSERT_EQ(result.status, k_exit_success) << result.errors;
    std::ifstream file(folder / "bwb.su2", std::ios::binary);
    meshes.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  for (const std::string& mesh : meshes) EXPECT_TRUE(mesh == meshes[0]);
}

TEST_F(Determinism, ComparisonsFindTheFirstByteAndMissingFiles) {
  const fs::path a = folder / "a", b = folder / "b";
  std::string text(200'000, 'x');
  for (const fs::path& run : {a, b}) {
    write(run / "same.txt", "same");
    write(run / "sub/other.bin", text);
    write(run / "page.html", run.string());
    write(run / "short.txt", run == a ? "abc" : "abcd");
    text[150'003] = 'y';
  }
  write(b / "more.txt", "1");
  write(a / "less.txt", "1");
  DeterminismReport report{.script = "case.lua", .threads = {1, 7}, .files = {}, .left_out = {}, .kept = {}};
  compare_run(a, a, 1, report);
  EXPECT_TRUE(report.is_pass());
  compare_run(a, b, 7, report);
  EXPECT_FALSE(report.is_pass());
  const std::string printed = to_text(report);
  EXPECT_THAT(printed, AllOf(HasSubstr("G22 determinism: FAIL, 4 of 5 files differ between 1 and 7 threads"), HasSubstr("first difference at byte 150 003"),
                             HasSubstr("not compared, because they contain times: page.html"), HasSubstr("first difference at byte 3\n"),
                             HasSubstr("more.txt: 1 thread did not write this file"), HasSubstr("      7 threads did not write this file")));
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["state"], "fail");
  EXPECT_EQ(json["files"][4]["file"], "sub/other.bin");
  EXPECT_EQ(json["files"][4]["differences"][0]["first_byte"], 150'003);
  EXPECT_EQ(json["files"][1]["xxh3_128"], nullptr);
}

TEST_F(Determinism, WhatDiffersFailsAndIsKept) {
  // A script that sees its place: the runs have folders of their own.
  write(folder / "case.lua",
        "local ok = pcall(read_surface, '../mark.stl') local w = read_surface 'box.stl' if ok then w = w:move{ 1, 0, 0 } end w:write 'wall.stl' w:write "
        "'../mark.stl'");
  const test::ProcessResult result = sterna({"determinism", "case.lua", "--threads", "1,1"});
  EXPECT_EQ(result.status, k_exit_failed) << result.errors;
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("G22 determinism: FAIL, 1 of 1 file differs between 1 and 1 threads"), HasSubstr("the runs are kept in " + temporary.string())));
  EXPECT_FALSE(is_left_clean());
}

TEST_F(Determinism, MistakesAndFailuresAreTold) {
  EXPECT_THAT(sterna({"determinism", "none.lua"}).errors, HasSubstr("there is no such file"));
  write(folder / "wrong.lua", "read_surface 'nothing.stl'");
  const test::ProcessResult wrong = sterna({"determinism", "wrong.lua"});
  EXPECT_EQ(wrong.status, k_exit_usage);
  EXPECT_THAT(wrong.errors, AllOf(HasSubstr("running wrong.lua with 1 thread"), HasSubstr("nothing.stl"), HasSubstr("are kept in")));
  write(folder / "empty.lua", "print 'nothing'");
  const test::ProcessResult empty = sterna({"determinism", "empty.lua", "--threads", "1,2"});
  EXPECT_EQ(empty.status, k_exit_failed);
  EXPECT_THAT(empty.output, HasSubstr("wrote no file to compare"));
  EXPECT_THAT(sterna({"determinism", "empty.lua", "--threads", "2"}).errors, HasSubstr("--threads 2,2"));
}

TEST_F(Determinism, AStopLeavesNothingBehind) {
  write(folder / "endless.lua", "read_surface('box.stl'):write 'wall.stl' while true do end");
  test::StartedProcess process(test::sterna_program(), {"determinism", "endless.lua"}, folder);
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  const auto has_begun = [&] {
    for (const auto& entry : fs::recursive_directory_iterator(temporary))
      if (entry.path().filename() == "wall.stl") return true;
    return false;
  };
  while (!has_begun() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  ASSERT_TRUE(has_begun());
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(), k_exit_interrupted);
  EXPECT_TRUE(is_left_clean());
}

}  // namespace
}  // namespace sterna::scripting
