#include "geom/base/alongside.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "tests/support/error_of.h"

namespace sterna {
namespace {

std::size_t sum_of_squares(const RunContext& context) {
  return parallel_reduce(
      context, 100000, std::size_t{0},
      [](std::size_t begin, std::size_t end) {
        std::size_t sum = 0;
        for (std::size_t i = begin; i < end; ++i) sum += i * i;
        return sum;
      },
      std::plus<>{});
}

/// The result can be taken only from an object that is given up.
template <class Work>
concept CanTakeTwice = requires(Work& work) {
  work.take();
};
static_assert(!CanTakeTwice<Alongside<int>>);
static_assert(!std::is_copy_constructible_v<Alongside<int>>);

TEST(Alongside, GivesTheSameResultForAnyThreadCount) {
  const std::size_t expected = sum_of_squares(RunContext({.threads = 1}));
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    Alongside<std::size_t> work(context, sum_of_squares);
    EXPECT_EQ(sum_of_squares(context), expected);  // both at once
    EXPECT_EQ(std::move(work).take(), expected);
  }
}

TEST(Alongside, LeavesOneThreadToTheCaller) {
  Alongside<int> work(RunContext({.threads = 4}), [](const RunContext& side) { return side.threads(); });
  EXPECT_EQ(std::move(work).take(), 3);
}

TEST(Alongside, MayHaveAllThreads) {
  const RunContext context({.threads = 4});
  Alongside<int> work(context, 4, [](const RunContext& side) { return side.threads() + static_cast<int>(sum_of_squares(side) % 2); });
  const std::size_t own = sum_of_squares(context);
  EXPECT_EQ(std::move(work).take(), 4 + static_cast<int>(own % 2));
}

TEST(Alongside, ThrowsWhatTheWorkHasThrown) {
  Alongside<int> work(RunContext({.threads = 2}), [](const RunContext&) -> int { throw Error({.code = ErrorCode::bad_argument, .problem = "as wanted"}); });
  test::expect_error(ErrorCode::bad_argument, "as wanted", [&] { (void)std::move(work).take(); });
}

TEST(Alongside, IsStoppedWhenItIsNotWanted) {
  std::atomic<bool> has_started = false;
  const auto start = std::chrono::steady_clock::now();
  {
    Alongside<int> work(RunContext({.threads = 2}), [&](const RunContext& side) {
      has_started = true;
      while (true) side.check_stop();
      return 0;
    });
    while (!has_started) std::this_thread::yield();
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));  // without cancellation the loop would never end
}

}  // namespace
}  // namespace sterna
