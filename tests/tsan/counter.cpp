// The subject of the ThreadSanitizer test: counts in a parallel_for of geom/base, once without protection ("race") and once per chunk ("clean").
#include <cstdio>
#include <string_view>

#include "geom/base/parallel.h"

namespace {

constexpr std::size_t k_n = 4096;
constexpr std::size_t k_chunk = 16;  // many chunks, so that both threads get some

std::size_t count_with_a_race(const sterna::RunContext& context) {
  std::size_t n = 0;
  sterna::parallel_for(context, k_n, [&](std::size_t) { ++n; }, k_chunk);
  return n;
}

std::size_t count_cleanly(const sterna::RunContext& context) {
  return sterna::parallel_reduce(
      context, k_n, std::size_t{0}, [](std::size_t begin, std::size_t end) { return end - begin; }, [](std::size_t a, std::size_t b) { return a + b; }, k_chunk);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const bool is_race = std::string_view(argv[1]) == "race";
  // Several rounds: each starts new threads, so that one of them overlaps even on a busy machine.
  for (int round = 0; round < 20; ++round) {
    const sterna::RunContext context({.threads = 2});
    const std::size_t n = is_race ? count_with_a_race(context) : count_cleanly(context);
    if (!is_race && n != k_n) return 3;
  }
  std::puts("counted");
  return 0;
}
