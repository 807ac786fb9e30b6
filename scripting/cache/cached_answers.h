// Caches results that depend on a function of a script. Such a function cannot be part of a key except by the values that it returns, and the points of
// evaluation depend on earlier values. An entry therefore stores its points. A lookup evaluates the script's own function at the same points in the same order
// as the computation would. If all values equal the stored ones, the entry is the result, because nothing else differs. A value that differs leads to another
// entry, whose key holds the values so far. The function receives exactly the same calls as without a cache, so even a function that counts its calls behaves
// the same.
#pragma once

#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "geom/base/vec3.h"
#include "scripting/cache/content_key.h"
#include "scripting/cache/stage_cache.h"

namespace sterna::scripting {

using SizeFunction = std::function<double(const Point&)>;

/// Points of evaluation of a function, and its values.
struct Transcript {
  std::vector<Point> questions;
  std::vector<double> answers;
};

/// A function whose first values are known.
class RecordedFunction {
 public:
  RecordedFunction(SizeFunction function, Transcript known) : function_(std::move(function)), transcript_(std::move(known)) {}
  double operator()(const Point& p) {
    if (n_calls_ < transcript_.questions.size()) {
      if (transcript_.questions[n_calls_] == p) return transcript_.answers[n_calls_++];
      is_as_known_ = false;  // cannot happen, because the points follow from the values; if it did, the function itself would give the right value
      transcript_.questions.resize(n_calls_);
      transcript_.answers.resize(n_calls_);
    }
    const double answer = function_(p);
    transcript_.questions.push_back(p);
    transcript_.answers.push_back(answer);
    ++n_calls_;
    return answer;
  }
  const Transcript& transcript() const { return transcript_; }
  bool is_as_known() const { return is_as_known_; }

 private:
  SizeFunction function_;
  Transcript transcript_;
  std::size_t n_calls_ = 0;
  bool is_as_known_ = true;
};

/// Returns the result of `make`, which calls the function, from the cache if possible, like cached() of stage_cache.h. `key` becomes the key of the result,
/// which includes the function's values; or it becomes empty.
/// \pre reuse.cache and key are set. Errors of the function are passed on.
template <class T>
T cached_by_answers(const Reuse& reuse, std::string_view stage, std::string_view what, std::optional<ContentKey>& key, const SizeFunction& function,
                    const RunContext& context, const std::function<T(const SizeFunction&)>& make, const std::function<void(ByteSink&, const T&)>& write,
                    const std::function<T(ByteSource&)>& read) {
  const auto same = [](double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; };
  Transcript known;          // evaluations of the function in this run so far
  std::size_t n_of_key = 0;  // number of these evaluations that are in the key
  for (;;) {
    Transcript stored;
    std::optional<T> value;
    const bool is_there = reuse.cache->find(
        stage, *key,
        [&](ByteSource& source) {
          read_value(source, stored.questions);
          read_value(source, stored.answers);
          if (stored.questions.size() != stored.answers.size()) source.refuse();
          value = read(source);
        },
        context);
    if (!is_there) break;
    std::size_t n_same = 0;
    for (; n_same < stored.questions.size(); ++n_same) {
      known.questions.push_back(stored.questions[n_same]);
      known.answers.push_back(function(stored.questions[n_same]));
      if (!same(known.answers.back(), stored.answers[n_same])) break;
    }
    KeyMaker next("answers");
    next.add(*key).add(std::vector<double>(known.answers.begin() + static_cast<std::ptrdiff_t>(n_of_key), known.answers.end()));
    key = next.key();
    n_of_key = known.answers.size();
    if (n_same < stored.questions.size()) continue;
    report_reuse(reuse, stage, what, context);
    return std::move(*value);
  }
  RecordedFunction requested(function, std::move(known));
  T value = make([&requested](const Point& p) { return requested(p); });
  if (!requested.is_as_known()) {
    context.warn(std::string(stage) + ": evaluated its function at other points than before: not cached");
    key.reset();
    return value;
  }
  const auto from = static_cast<std::ptrdiff_t>(n_of_key);
  const Transcript& all = requested.transcript();
  const std::vector<Point> questions(all.questions.begin() + from, all.questions.end());
  const std::vector<double> answers(all.answers.begin() + from, all.answers.end());
  reuse.cache->store(
      stage, *key,
      [&](ByteSink& sink) {
        write_value(sink, questions);
        write_value(sink, answers);
        write(sink, value);
      },
      context);
  key = KeyMaker("answers").add(*key).add(answers).key();
  return value;
}

}  // namespace sterna::scripting
