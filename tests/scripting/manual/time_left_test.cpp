// The estimate of the time left, on made-up and on recorded runs (tests/data/progress, by tools/record_progress).
#include "scripting/terminal/time_left.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/support/data.h"

namespace sterna::scripting {
namespace {

TEST(TimeLeft, EvenWorkEndsWhenItSays) {
  TimeLeft left;
  for (int i = 0; i <= 90; ++i) {
    left.note({"mesh", i / 100.0}, 1000.0 + i);
    if (i >= 20) {
      ASSERT_TRUE(left.estimate().has_value());
      EXPECT_NEAR(*left.estimate(), 100.0 - i, 1e-9);
    }
  }
}

TEST(TimeLeft, FallingShareWithinWorkIsNoNewWork) {
  TimeLeft left;
  left.note({"mesh/envelope", 0.0}, 0.0);
  left.note({"mesh/tetrahedra", 0.5}, 50.0);
  left.note({"mesh/prisms", 0.2}, 60.0);  // a part that is repeated
  EXPECT_NEAR(left.estimate().value(), 40.0, 1e-9);
  EXPECT_EQ(left.share(), 0.5);
}

TEST(TimeLeft, ANewPieceOfWorkBeginsAnew) {
  TimeLeft left;
  left.note({"mesh", 0.0}, 0.0);
  left.note({"mesh", 0.99}, 99.0);
  left.note({"mesh", 0.0}, 100.0);
  EXPECT_FALSE(left.estimate().has_value());
  left.note({"mesh", 0.25}, 110.0);
  EXPECT_NEAR(left.estimate().value(), 30.0, 1e-9);
  left.note({"write", 0.5}, 120.0);  // the stages of one command continue
  EXPECT_NEAR(left.estimate().value(), 20.0, 1e-9);
  left.note({"mesh", 0.1}, 121.0);
  EXPECT_FALSE(left.estimate().has_value());  // nothing is known about this stage yet
}

TEST(TimeLeft, SaysNothingBeforeItKnows) {
  TimeLeft left;
  left.note({"series", 0.0}, 0.0);
  left.note({"series", 0.01}, 5.0);
  EXPECT_FALSE(left.estimate().has_value());
}

/// After a fifth of any work longer than 20 s, the estimate is right within a third, plus 2 s for progress rounded to whole per cent and for a busy machine.
TEST(TimeLeft, IsRightWithinAThirdOnRecordedRuns) {
  std::size_t n_runs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::corpus() / "progress")) {
    if (entry.path().extension() != ".txt") continue;
    SCOPED_TRACE(entry.path().filename());
    std::ifstream file(entry.path());
    std::vector<std::pair<double, ProgressState>> notes;
    double end = 0.0;
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      double seconds = 0.0;
      std::string share, stage;
      words >> seconds >> share >> stage;
      if (share == "end") end = seconds;
      else notes.push_back({seconds, {stage, std::stod(share) / 100.0}});
    }
    ASSERT_GT(end, 20.0);
    ASSERT_GT(notes.size(), 4u);
    ++n_runs;
    TimeLeft left;
    for (const auto& [seconds, state] : notes) {
      left.note(state, seconds);
      if (seconds < 0.2 * end) continue;
      ASSERT_TRUE(left.estimate().has_value()) << "at " << seconds << " s";
      EXPECT_NEAR(*left.estimate(), end - seconds, (end - seconds) / 3.0 + 2.0) << "at " << seconds << " s of " << end << " s in " << state.stage;
    }
  }
  EXPECT_GE(n_runs, 2u);
}

}  // namespace
}  // namespace sterna::scripting
