#include "scripting/terminal/time_left.h"

#include <algorithm>

namespace sterna::scripting {
namespace {

/// A fraction of zero after a fraction above this value means new work, not a repetition.
constexpr double k_over = 0.9;

}  // namespace

void TimeLeft::note(const ProgressState& state, double seconds) {
  const std::string work = state.stage.substr(0, state.stage.find('/'));
  if (!is_begun_ || (work != work_ && state.share < share_) || (state.share == 0.0 && share_ > k_over)) {
    *this = {};
    is_begun_ = true;
    start_ = seconds;
  }
  work_ = work;
  now_ = seconds - start_;
  if (state.share <= share_) return;
  share_ = state.share;
  at_share_ = now_;
}

std::optional<double> TimeLeft::estimate() const {
  if (share_ < k_least_share || now_ < k_least_seconds) return std::nullopt;
  const double whole = at_share_ / share_;  // progress fractions are assumed to be fractions of the time
  return std::max(0.0, whole - now_);
}

}  // namespace sterna::scripting
