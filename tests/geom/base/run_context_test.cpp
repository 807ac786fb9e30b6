// Reports of a run during long steps.
#include "geom/base/run_context.h"

#include <gmock/gmock.h>

#include <chrono>
#include <string>
#include <vector>

namespace sterna {
namespace {

using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

TEST(RunContext, LongStepsReportAtDoublingTimes) {
  std::vector<std::string> warnings;
  const RunContext context({.threads = 1,
                            .log =
                                [&](LogLevel level, std::string_view text) {
                                  if (level == LogLevel::warning) warnings.emplace_back(text);
                                },
                            .long_step = 0.05});
  const auto work_for = [](const RunContext& part, double seconds) {
    for (const auto begin = Clock::now(); std::chrono::duration<double>(Clock::now() - begin).count() < seconds;) part.check_stop();
  };
  work_for(context, 0.1);  // no step
  EXPECT_TRUE(warnings.empty());
  const RunContext step = context.part("tetrahedra", 0.0, 1.0);
  work_for(step, 0.02);
  EXPECT_TRUE(warnings.empty());
  work_for(step.part("refinement", 0.0, 1.0), 0.1);  // parts of a step count together
  ASSERT_GE(warnings.size(), 1u);
  EXPECT_THAT(warnings.front(), HasSubstr("tetrahedra has taken 0 s so far, now at tetrahedra/refinement, and continues"));
  const std::size_t n = warnings.size();
  EXPECT_LE(n, 2u);
  work_for(step, 0.3);
  EXPECT_GT(warnings.size(), n);
  EXPECT_LE(warnings.size(), 4u);  // at 0.05, 0.1, 0.2, 0.4 s; fewer on a busy machine
  // The next step reports on its own, however long the previous step was silent.
  warnings.clear();
  work_for(context.part("improve", 0.0, 1.0), 0.07);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_THAT(warnings.front(), HasSubstr("improve has taken"));
}

}  // namespace
}  // namespace sterna
