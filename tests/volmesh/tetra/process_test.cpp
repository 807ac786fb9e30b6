// Any kind of crash of the helper becomes an error; the parent is unharmed and no zombie remains.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "tests/support/data.h"
#include "tests/support/process.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/tetra/cases.h"

namespace sterna::volmesh {
namespace {

using test::Domain;
using test::domain_around;
using test::error_info_of;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr double k_prompt_seconds = 5.0;  ///< an event must become an error within this time

/// A case that keeps TetGen busy for seconds.
const Domain& slow_case() {
  static const Domain domain = domain_around(test::sphere(70));
  return domain;
}

class HelperProcess : public testing::Test {
 protected:
  ErrorInfo run(const Domain& domain, const TetraOptions& options, const RunContext& context = RunContext{}) {
    const auto start = Clock::now();
    const ErrorInfo error = error_info_of([&] { fill(domain.boundary(), nullptr, options, context); });
    seconds_ = std::chrono::duration<double>(Clock::now() - start).count();
    EXPECT_TRUE(test::has_no_children());
    return error;
  }
  /// Returns a folder where TetGen's helper is a file with this content.
  std::string folder_with(const std::string& name, const std::string& text) {
    const std::filesystem::path folder = test::scratch() / name;
    std::filesystem::create_directories(folder);
    const std::filesystem::path path = folder / "sterna-tet-tetgen";
    std::ofstream(path) << text;
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return folder.string();
  }
  /// Returns the same with a shell script.
  std::string script(const std::string& name, const std::string& text) { return folder_with(name, "#!/bin/sh\n" + text + "\n"); }
  double seconds_ = 0.0;
};

TEST_F(HelperProcess, MissingIsNamed) {
  const ErrorInfo error = run(domain_around(test::cube(1)), {.engine = "tetgen", .helper_folder = "/nowhere"});
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_missing);
  EXPECT_THAT(error.problem, HasSubstr("/nowhere/sterna-tet-tetgen"));
  EXPECT_THAT(error.hint, HasSubstr("sterna-tet-tetgen"));
  EXPECT_EQ(run(domain_around(test::cube(1)), {.engine = "tetgen", .helper_folder = "/"}).code, ErrorCode::tetra_engine_missing);
}

TEST_F(HelperProcess, NoProgramIsMissingToo) {
  EXPECT_EQ(run(domain_around(test::cube(1)), {.engine = "tetgen",
                                               .helper_folder = folder_with("not_a_program",
                                                                            "\x7f"
                                                                            "ELF nonsense")})
                .code,
            ErrorCode::tetra_engine_missing);
}

TEST_F(HelperProcess, IsQuotedWhenItGivesNoAnswer) {
  const ErrorInfo error =
      run(domain_around(test::cube(1)), {.engine = "tetgen", .helper_folder = script("mute", "echo out of paper; echo and of ink >&2; exit 3")});
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem, HasSubstr("exit status 3"));
  EXPECT_THAT(error.problem, HasSubstr("out of paper\nand of ink"));
}

TEST_F(HelperProcess, MayTalkALot) {
  const ErrorInfo error =
      run(domain_around(test::cube(1)), {.engine = "tetgen", .helper_folder = script("talker", "yes 0123456789 | head -c 3000000; exit 4")});
  EXPECT_THAT(error.problem, HasSubstr("exit status 4"));
  EXPECT_LT(error.problem.size(), 2000u);
}

TEST_F(HelperProcess, GarbageIsNoAnswer) {
  EXPECT_EQ(run(domain_around(test::cube(1)), {.engine = "tetgen", .helper_folder = script("garbage", "head -c 1000 /dev/zero >&4")}).code,
            ErrorCode::tetra_engine_failed);
  EXPECT_EQ(run(domain_around(test::cube(1)), {.engine = "tetgen", .helper_folder = script("silent", "exec >&- 2>&-; sleep 0.3")}).code,
            ErrorCode::tetra_engine_failed);
}

TEST_F(HelperProcess, ACutAnswerIsInvalid) {
  // The header of a valid reply (56 bytes: magic, ok, no points, one tetrahedron) without the announced data.
  const ErrorInfo error =
      run(domain_around(test::cube(1)),
          {.engine = "tetgen",
           .helper_folder = script(
               "cut",
               "printf 'STETREP3' >&4; head -c 8 /dev/zero >&4; printf '\\377\\377\\0\\0\\0\\0\\0\\0\\1\\0\\0\\0\\0\\0\\0\\0' >&4; head -c 24 /dev/zero >&4")});
  EXPECT_EQ(error.code, ErrorCode::tetra_result_invalid);
  EXPECT_THAT(error.problem, HasSubstr("bytes instead of"));
}

TEST_F(HelperProcess, ACrashIsNamed) {
  const ErrorInfo error = run(domain_around(test::cube(1)), {.engine = "tetgen", .helper_folder = script("crash", "echo last words; kill -SEGV $$")});
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem, HasSubstr("signal 11"));
  EXPECT_THAT(error.problem, HasSubstr("end of its output"));
  EXPECT_THAT(error.hint, HasSubstr("has no self-intersections"));
}

/// Requirements for the helper of each engine.
class EngineProcess : public HelperProcess, public testing::WithParamInterface<std::string> {};
INSTANTIATE_TEST_SUITE_P(Engine, EngineProcess, testing::Values("tetgen", "hxt"), [](const auto& test) { return test.param; });

TEST_P(EngineProcess, KilledFromOutside) {
  const Domain& domain = slow_case();
  Clock::time_point killed_at;
  std::jthread killer([&] {
    pid_t pid = 0;
    while ((pid = test::first_child()) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    killed_at = Clock::now();
    kill(pid, SIGKILL);
  });
  const ErrorInfo error = run(domain, {.engine = GetParam()});
  killer.join();
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem, HasSubstr("signal 9"));
  EXPECT_LT(std::chrono::duration<double>(Clock::now() - killed_at).count(), k_prompt_seconds);
}

TEST_P(EngineProcess, TimeLimit) {
  const ErrorInfo error = run(slow_case(), {.engine = GetParam(), .time_limit = 0.3});
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem, HasSubstr("time limit"));
  EXPECT_THAT(error.hint, HasSubstr("time_limit"));
  EXPECT_LT(seconds_, 0.3 + k_prompt_seconds);
}

TEST_P(EngineProcess, MemoryLimit) {
  // libgmsh alone takes 120 MB of address space.
  const double limit = GetParam() == "hxt" ? 1.6e8 : 3e7;
  const ErrorInfo error = run(slow_case(), {.engine = GetParam(), .memory_limit = limit});
  EXPECT_EQ(error.code, ErrorCode::tetra_engine_failed);
  EXPECT_THAT(error.problem, HasSubstr("out of memory"));
  EXPECT_THAT(error.problem, HasSubstr(GetParam() == "hxt" ? "160 MB" : "30 MB"));
  EXPECT_THAT(error.hint, HasSubstr("memory_limit"));
}

TEST_F(HelperProcess, HardlyAnyMemory) {
  // The memory limit is too small even for the request.
  EXPECT_EQ(run(slow_case(), {.engine = "tetgen", .memory_limit = 1e6}).code, ErrorCode::tetra_engine_failed);
}

TEST_F(HelperProcess, StopsWithTheContext) {
  const Domain& domain = slow_case();
  std::stop_source source;
  std::jthread stopper([&] {
    while (test::first_child() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    source.request_stop();
  });
  const ErrorInfo error = run(domain, {.engine = "tetgen"}, RunContext({.stop = source.get_token()}));
  EXPECT_EQ(error.code, ErrorCode::cancelled);
  EXPECT_LT(seconds_, k_prompt_seconds);
}

TEST_F(HelperProcess, LeavesNoDescriptorOpen) {
  const auto n_open = [] {
    const auto list = std::filesystem::directory_iterator("/proc/self/fd");
    return std::distance(begin(list), end(list));
  };
  const Domain domain = domain_around(test::cube(1));
  fill(domain.boundary(), nullptr, {}, RunContext{});
  const auto before = n_open();
  fill(domain.boundary(), nullptr, {}, RunContext{});
  run(domain, {.engine = "tetgen", .helper_folder = "/nowhere"});
  run(domain, {.engine = "tetgen", .helper_folder = script("mute", "exit 1")});
  EXPECT_EQ(n_open(), before);
}

}  // namespace
}  // namespace sterna::volmesh
