// The subject of the ThreadSanitizer test: counts in a parallel_for of geom/base, once without protection ("race") and once per chunk ("clean").
#include <atomic>
#include <cstdio>
#include <string_view>

#include "geom/base/parallel.h"

namespace {

/// Two chunks on two threads meet and then both count. Without the meeting one thread may do all the work, and the loop's own hand-out of chunks
/// would order the increments: a race that depends on luck. The meeting is relaxed, so that it orders nothing itself.
std::size_t count_with_a_race(const sterna::RunContext& context) {
  std::size_t n = 0;
  std::atomic<int> n_arrived{0};
  sterna::parallel_for(
      context, 2,
      [&](std::size_t) {
        n_arrived.fetch_add(1, std::memory_order_relaxed);
        while (n_arrived.load(std::memory_order_relaxed) < 2) {
        }
        ++n;
      },
      1);
  return n;
}

/// The race-free twin: the same meeting, but each chunk counts for itself.
std::size_t count_cleanly(const sterna::RunContext& context) {
  std::atomic<int> n_arrived{0};
  return sterna::parallel_reduce(
      context, 2, std::size_t{0},
      [&](std::size_t begin, std::size_t end) {
        n_arrived.fetch_add(1, std::memory_order_relaxed);
        while (n_arrived.load(std::memory_order_relaxed) < 2) {
        }
        return end - begin;
      },
      [](std::size_t a, std::size_t b) { return a + b; }, 1);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const bool is_race = std::string_view(argv[1]) == "race";
  const sterna::RunContext context({.threads = 2});
  // ThreadSanitizer's own records are written without locks: of two accesses at the very same moment it may see one only (about 1 round in 100).
  for (int round = 0; round < 50; ++round) {
    const std::size_t n = is_race ? count_with_a_race(context) : count_cleanly(context);
    if (!is_race && n != 2) return 3;
  }
  std::puts("counted");
  return 0;
}
