// Ctrl-C as a user sends it: the program stops within a second in any stage and leaves no incomplete file.
#include <gmock/gmock.h>

#include <fstream>

#include "scripting/terminal/exit_status.h"
#include "tests/support/data.h"
#include "tests/support/process.h"
#include "tests/support/sanitizers.h"

namespace sterna::scripting {
namespace {

struct Work {
  const char* name;
  const char* setup;  ///< a script that runs to its end before; may be empty
  const char* script;
  double after = 0.7;  ///< seconds until Ctrl-C
};
void PrintTo(const Work& work, std::ostream* out) { *out << work.name; }

class Interrupt : public testing::TestWithParam<Work> {};

/// One second, plus the time that a loaded machine takes to start and end a process.
constexpr double k_limit = test::k_is_sanitized ? 20.0 : 1.3;
/// Other tests run at the same time and may occupy the processors for longer than the limit; code that is slow by itself is slow in each attempt.
constexpr int k_attempts = 4;

TEST_P(Interrupt, EndsWithinASecondAndLeavesNothing) {
  const Work& work = GetParam();
  const std::filesystem::path folder = test::scratch();
  if (*work.setup) {
    std::ofstream(folder / "setup.lua") << work.setup;
    ASSERT_EQ(test::run_process(test::sterna_program(), {"run", "setup.lua"}, folder).status, 0);
  }
  std::ofstream(folder / "case.lua") << work.script << "\nprint 'ended'\n";
  const auto names = [&] {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
      if (!entry.path().filename().string().starts_with("written.vtu"))
        found.push_back(entry.path().lexically_relative(folder).string());  // complete, from the loop before
    std::sort(found.begin(), found.end());
    return found;
  };
  const std::vector<std::string> before = names();
  double quickest = 1e300;
  for (int attempt = 0; attempt < k_attempts && quickest >= k_limit; ++attempt) {
    test::ProcessResult result = test::run_process(test::sterna_program(), {"run", "case.lua"}, folder, work.after);
    for (double after = 0.5 * work.after; result.status == 0; after *= 0.5) {  // a fast machine had finished before: try earlier
      ASSERT_GT(after, 0.01) << "done before Ctrl-C could come";
      for (const std::string& name : names())
        if (!std::binary_search(before.begin(), before.end(), name)) std::filesystem::remove_all(folder / name);
      result = test::run_process(test::sterna_program(), {"run", "case.lua"}, folder, after);
    }
    EXPECT_EQ(result.status, k_exit_interrupted) << result.errors;
    EXPECT_THAT(result.errors, testing::HasSubstr("stopped on request"));
    EXPECT_THAT(result.output, testing::Not(testing::HasSubstr("went on")));
    EXPECT_EQ(names(), before);
    quickest = std::min(quickest, result.seconds_after_interrupt);
  }
  EXPECT_LT(quickest, k_limit);
  RecordProperty("seconds", std::to_string(quickest));
}

const Work k_work[] = {
    {"loop", "", "while true do end"},
    {"pcall", "", "while true do pcall(function() while true do end end) print 'went on' end"},
    {"xpcall", "", "while true do xpcall(function() while true do end end, function() while true do end end) print 'went on' end"},
    {"pcall_of_a_verb", "", "for i = 1, 1e9 do pcall(surface_mesh, { box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.003 }) print 'went on' end"},
    {"metamethod", "",
     "local t = setmetatable({}, { __index = function(t, k) return t[k + 1] end, __close = function() while true do end end }) do local c <close> = t while "
     "true do end end"},
    {"rep_and_gsub", "", "while true do string.rep('ab', 2^26):gsub('a', 'x') end"},
    {"pattern", "", "string.find(string.rep('a', 100000), '.-.-.-.-.-b')"},
    {"sort", "",
     "local t = {} for i = 1, 2^23 do t[i] = (i * 7919) % 1000003 end while true do table.sort(t) table.sort(t, function(a, b) return a > b end) end"},
    {"move", "", "table.move({}, 1, 2^40, 2)"},
    {"callback", "", "box{ {0, 0, 0}, {1, 1, 1} }:deform{ function() while true do end end }"},
    {"surface_mesh", "", "surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.002 }"},
    {"union", "",
     "local all = {} for i = 1, 12 do all[i] = body_of_revolution{ name = 'b' .. i, position = {0.3 * i, 0.1 * i, 0}, profile = { {0, 0}, {0.5, 0.6}, {1, "
     "0.8}, {2, 0.9}, {3, 0.5}, {4, 0} } } end union(all)"},
    {"envelope", "surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.012 }:write 'wall.stl'",
     "local wall = read_surface 'wall.stl' while true do make_envelope{ wall, first_height = 1e-4 } end", 1.5},
    {"tetrahedra", "make_envelope{ surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.03 }, layers = 3, first_height = 1e-2 }:write 'env.sterna'",
     "tetrahedra{ read_stages('env.sterna').envelope, sources = { box{ {-1, -1, -1}, {2, 2, 2}, size = 0.02 } } }", 2.0},
    {"reading", "local wall = surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.006 } wall:write 'wall.stl'",
     "for i = 1, 1e9 do read_surface 'wall.stl' end"},
    {"writing", "", "local wall = surface_mesh{ box{ {0, 0, 0}, {1, 1, 1} }, max_edge = 0.02 } for i = 1, 1e9 do wall:write 'written.vtu' end", 1.2},
};
INSTANTIATE_TEST_SUITE_P(Everything, Interrupt, testing::ValuesIn(k_work), [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace sterna::scripting
