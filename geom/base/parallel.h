// Deterministic parallel loops over oneTBB. Chunks have a fixed size that does not depend on the number of threads, partial results are combined in chunk
// order, and sorts need a total order. Results therefore have the same bytes for any number of threads.
// The TBB headers stay in parallel.cpp (or, for the tsan preset, a std::thread back end behind the same functions).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "geom/base/run_context.h"

namespace sterna {

namespace detail {

/// Non-owning reference to a callable void(std::size_t begin, std::size_t end).
class RangeFunction {
 public:
  template <class F>
  RangeFunction(const F& f) : object_(&f), call_([](const void* o, std::size_t b, std::size_t e) { (*static_cast<const F*>(o))(b, e); }) {}
  void operator()(std::size_t begin, std::size_t end) const { call_(object_, begin, end); }

 private:
  const void* object_;
  void (*call_)(const void*, std::size_t, std::size_t);
};

}  // namespace detail

/// Default number of elements per chunk; large enough to hide the cost of a task (about 1 us).
inline constexpr std::size_t k_default_chunk = 2048;

/// Calls f(begin, end) once for each chunk [i*chunk, min((i+1)*chunk, n)), in any order, on the context's threads.
/// Exceptions of f reach the caller; if several are thrown, that of the lowest chunk. Checks for a stop between chunks.
void parallel_chunks(const RunContext& context, std::size_t n, std::size_t chunk, detail::RangeFunction f);

/// Calls f(i) for every i in [0, n).
template <class F>
void parallel_for(const RunContext& context, std::size_t n, const F& f, std::size_t chunk = k_default_chunk) {
  parallel_chunks(context, n, chunk, [&f](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) f(i);
  });
}

/// Computes map(begin, end) -> R for each chunk, then R = combine(R, R) from the first chunk to the last, starting from `initial`.
template <class R, class Map, class Combine>
R parallel_reduce(const RunContext& context, std::size_t n, R initial, const Map& map, const Combine& combine, std::size_t chunk = k_default_chunk) {
  if (n == 0) return initial;
  std::vector<std::unique_ptr<R>> parts((n + chunk - 1) / chunk);
  parallel_chunks(context, n, chunk, [&](std::size_t begin, std::size_t end) { parts[begin / chunk] = std::make_unique<R>(map(begin, end)); });
  R result = std::move(initial);
  for (auto& part : parts) result = combine(std::move(result), std::move(*part));
  return result;
}

/// Concatenates the lists to which collect(begin, end, list) appends, one list per chunk, from the first chunk to the last.
template <class T, class Collect>
std::vector<T> parallel_collect(const RunContext& context, std::size_t n, const Collect& collect, std::size_t chunk = k_default_chunk) {
  return parallel_reduce(
      context, n, std::vector<T>{},
      [&](std::size_t begin, std::size_t end) {
        std::vector<T> list;
        collect(begin, end, list);
        return list;
      },
      [](std::vector<T> all, const std::vector<T>& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
      },
      chunk);
}

/// Sorts [data, data+n).
/// \pre less is a total order (no two different elements are equivalent), so that the result is unique.
template <class T, class Less>
void parallel_sort(const RunContext& context, std::vector<T>& values, const Less& less) {
  constexpr std::size_t k_run = 1 << 15;
  const std::size_t n = values.size();
  if (n <= k_run) {
    std::sort(values.begin(), values.end(), less);
    return;
  }
  parallel_chunks(context, n, k_run, [&](std::size_t begin, std::size_t end) {
    std::sort(values.begin() + static_cast<std::ptrdiff_t>(begin), values.begin() + static_cast<std::ptrdiff_t>(end), less);
  });
  std::vector<T> other(n);
  for (std::size_t width = k_run; width < n; width *= 2) {
    parallel_chunks(context, n, 2 * width, [&](std::size_t begin, std::size_t end) {
      const std::size_t middle = std::min(begin + width, end);
      const auto at = [&](std::size_t i) { return values.begin() + static_cast<std::ptrdiff_t>(i); };
      std::merge(at(begin), at(middle), at(middle), at(end), other.begin() + static_cast<std::ptrdiff_t>(begin), less);
    });
    values.swap(other);
  }
}

/// Runs two independent functions, possibly at the same time.
void parallel_invoke(const RunContext& context, const std::function<void()>& f, const std::function<void()>& g);

/// Sum with a running compensation (Neumaier 1974), so that the error does not depend on the number of terms.
class CompensatedSum {
 public:
  void add(double value) {
    const double t = sum_ + value;
    correction_ += std::abs(sum_) >= std::abs(value) ? (sum_ - t) + value : (value - t) + sum_;
    sum_ = t;
  }
  void add(const CompensatedSum& other) {
    add(other.sum_);
    correction_ += other.correction_;
  }
  double value() const { return sum_ + correction_; }

 private:
  double sum_ = 0.0;
  double correction_ = 0.0;
};

}  // namespace sterna
