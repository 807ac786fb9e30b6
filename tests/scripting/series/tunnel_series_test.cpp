// The wind-tunnel series writes the same bytes when killed at random moments and resumed, with 1 and 2 tasks, in another order, and with every mode of the
// cache.
#include "tests/scripting/series/tunnel_series.h"

#include <gmock/gmock.h>

#include <csignal>
#include <random>
#include <thread>

#include "tests/scripting/series/series_fixture.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;
using Snapshot = std::map<std::string, std::string>;

class TunnelSeries : public SeriesFixture {
 protected:
  std::filesystem::path polar() const { return folder_ / "polar"; }
};

TEST_F(TunnelSeries, GivesTheSameBytesHoweverItIsRun) {
  STERNA_NEEDS_SHARED_DATA();
  const std::filesystem::path cached = folder_ / "cached";
  const test::ProcessResult first = run(tunnel_series("cache = false,"), {"--tasks", "2", "--threads", "2"});
  ASSERT_EQ(first.status, 1) << first.errors;
  EXPECT_THAT(first.output, HasSubstr("12\t2\t0"));
  const Snapshot plain = snapshot(polar());
  EXPECT_THAT(plain.at("alpha=4_beta=0_layers=4_rise=3/status.json"), HasSubstr("\"failed\""));
  EXPECT_THAT(plain.at("alpha=4_beta=0_layers=-4_rise=0/status.json"), HasSubstr("layers"));

  // One task, cases in reverse order, cold cache.
  run(tunnel_series("", true), {"--tasks", "1", "--threads", "2"}, cached);
  EXPECT_EQ(difference(results_only(plain), results_only(snapshot(cached / "polar"))), "");
  // The same with the cache filled by that run.
  std::filesystem::remove_all(cached / "polar");
  run(tunnel_series("", true), {"--tasks", "2", "--threads", "2"}, cached);
  EXPECT_EQ(difference(results_only(plain), results_only(snapshot(cached / "polar"))), "");
}

/// Kills the main process or a worker at random moments until the series finishes by itself.
int run_with_kills(std::mt19937& random, const std::filesystem::path& folder) {
  int n_kills = 0;
  for (int attempt = 0; attempt < 6; ++attempt) {
    test::StartedProcess main(test::sterna_program(), {"run", "case.lua", "--tasks", "2", "--threads", "2"}, folder);
    std::this_thread::sleep_for(std::chrono::milliseconds(std::uniform_int_distribution<int>(50, 2500)(random)));
    const std::vector<pid_t> workers = test::children_of(main.pid());
    if (main.has_ended()) return n_kills;
    ++n_kills;
    if (attempt % 2 == 0 || workers.empty()) main.signal(SIGKILL);
    else kill(workers[std::uniform_int_distribution<std::size_t>(0, workers.size() - 1)(random)], SIGKILL);
    if (attempt % 2 == 0 || workers.empty()) main.wait();
    else if (main.wait() == 1 && attempt > 2) return n_kills;
  }
  return n_kills;
}

TEST_F(TunnelSeries, ResumesAfterAKillAtARandomMoment) {
  STERNA_NEEDS_SHARED_DATA();
  const std::filesystem::path killed = folder_ / "killed";
  const std::string script = tunnel_series();
  run(script, {"--tasks", "2", "--threads", "2"});
  const Snapshot expected = snapshot(polar());
  for (const unsigned seed : {1u, 2u}) {
    std::mt19937 random(seed);
    std::filesystem::remove_all(killed);
    write(script, killed);
    EXPECT_GE(run_with_kills(random, killed), 1);
    const test::ProcessResult last = run(script, {"--tasks", "2", "--threads", "2"}, killed);
    EXPECT_EQ(last.status, 1) << last.errors;
    EXPECT_EQ(difference(expected, snapshot(killed / "polar")), "") << "seed " << seed;
  }
}

}  // namespace
}  // namespace sterna::scripting
