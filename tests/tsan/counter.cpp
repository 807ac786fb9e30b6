// The subject of the ThreadSanitizer test: counts in a parallel_for of geom/base, once without protection ("race") and once per chunk ("clean").
#include <atomic>
#include <cstdio>
#include <string_view>

#include "geom/base/parallel.h"

namespace {

/// Two chunks on two threads wait for each other, then both count. Without this barrier one thread might do all the work, and the loop's own distribution of
/// chunks would order the increments, so that the race would depend on timing. The barrier is relaxed, so that it orders nothing itself.
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

/// The race-free counterpart: the same barrier, but each chunk has its own counter.
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
  // ThreadSanitizer writes its own records without locks: it may miss one of two simultaneous accesses (about 1 round in 100).
  for (int round = 0; round < 50; ++round) {
    const std::size_t n = is_race ? count_with_a_race(context) : count_cleanly(context);
    if (!is_race && n != 2) return 3;
  }
  std::puts("counted");
  return 0;
}
