#include "geom/base/parallel.h"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include "geom/base/error.h"

namespace sterna {
namespace {

TEST(Parallel, EveryIndexOnceForAnyThreadCount) {
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    std::vector<int> hits(100001);
    parallel_for(
        context, hits.size(), [&](std::size_t i) { ++hits[i]; }, 37);
    EXPECT_TRUE(std::all_of(hits.begin(), hits.end(), [](int h) { return h == 1; }));
  }
}

/// Number of different threads in a loop whose chunks wait until `required` threads are inside the loop or 20 s have passed.
std::size_t threads_inside(const RunContext& context, std::size_t required) {
  std::mutex mutex;
  std::condition_variable arrival;
  std::set<std::thread::id> seen;
  parallel_for(
      context, required,
      [&](std::size_t) {
        std::unique_lock lock(mutex);
        seen.insert(std::this_thread::get_id());
        arrival.notify_all();
        arrival.wait_for(lock, std::chrono::seconds(20), [&] { return seen.size() >= required; });
      },
      1);
  return seen.size();
}

TEST(Parallel, SevenThreadsRunBesideContextsOfFewer) {
  const RunContext of_the_machine;
  const RunContext two({.threads = 2});
  const RunContext seven({.threads = 7});
  const RunContext one({.threads = 1});
  const RunContext five({.threads = 5});
  EXPECT_EQ(threads_inside(seven, 7), 7u);
  EXPECT_EQ(threads_inside(five, 5), 5u);
  EXPECT_EQ(threads_inside(two, 2), 2u);
}

TEST(Parallel, ContextUsesAtMostItsThreads) {
  const RunContext seven({.threads = 7});
  const RunContext two({.threads = 2});
  std::mutex mutex;
  std::set<std::thread::id> seen;
  parallel_for(
      two, 200,
      [&](std::size_t) {
        const std::scoped_lock lock(mutex);
        seen.insert(std::this_thread::get_id());
      },
      1);
  EXPECT_LE(seen.size(), 2u);
}

TEST(Parallel, ReductionIsBitIdenticalForAnyThreads) {
  std::vector<double> values(200000);
  std::mt19937_64 random(7);
  for (double& v : values) v = static_cast<double>(random()) * 1e-3;
  std::vector<double> sums;
  for (const int threads : {1, 2, 7}) {
    const RunContext context({.threads = threads});
    sums.push_back(parallel_reduce(
        context, values.size(), 0.0,
        [&](std::size_t b, std::size_t e) {
          double s = 0.0;
          for (std::size_t i = b; i < e; ++i) s += values[i];
          return s;
        },
        [](double a, double b) { return a + b; }));
  }
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_EQ(sums[0], sums[2]);
}

TEST(Parallel, SortMatchesTheSerialOne) {
  std::mt19937_64 random(3);
  for (const std::size_t n : {0u, 1u, 32768u, 32769u, 300007u}) {
    std::vector<std::uint64_t> values(n);
    for (auto& v : values) v = random();
    std::vector<std::uint64_t> expected = values;
    std::sort(expected.begin(), expected.end());
    parallel_sort(RunContext({.threads = 2}), values, std::less<>{});
    EXPECT_EQ(values, expected);
  }
}

TEST(Parallel, TheLowestChunksExceptionReachesTheCaller) {
  const RunContext context({.threads = 2});
  try {
    parallel_for(
        context, 1000,
        [](std::size_t i) {
          if (i % 100 == 50) throw std::runtime_error(std::to_string(i));
        },
        10);
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "50");
  }
}

TEST(Parallel, StopRequestEndsTheLoop) {
  std::stop_source source;
  const RunContext context({.threads = 2, .stop = source.get_token()});
  try {
    parallel_for(
        context, 1000000,
        [&](std::size_t i) {
          if (i == 5) source.request_stop();
        },
        10);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

TEST(CompensatedSum, KeepsSmallTermsBesideLargeOnes) {
  CompensatedSum sum;
  sum.add(1e16);
  for (int i = 0; i < 1000; ++i) sum.add(1.0);
  sum.add(-1e16);
  EXPECT_EQ(sum.value(), 1000.0);
}

/// A stage's record holds the CPU seconds of the whole process; if one of two threads works, the threads are half busy.
TEST(StageTimer, TellsHowBusyTheThreadsWere) {
  const RunContext context({.threads = 2});
  {
    const StageTimer timer(context, "work");
    const auto start = std::chrono::steady_clock::now();
    volatile double sum = 0.0;
    while (std::chrono::steady_clock::now() - start < std::chrono::milliseconds(60)) sum = sum + 1.0;
  }
  {
    const StageTimer timer(context, "sleep");
    std::this_thread::sleep_for(std::chrono::milliseconds(60));
  }
  ASSERT_EQ(context.times().size(), 2u);
  const StageTime work = context.times()[0], sleep = context.times()[1];
  EXPECT_GT(work.processor_seconds, 0.0);
  EXPECT_GT(work.busy_share(2), sleep.busy_share(2));
  EXPECT_LE(work.busy_share(1), 1.0);
}

}  // namespace
}  // namespace sterna
