// How long the rest of some work takes, by the shares that it reports.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"

namespace sterna::scripting {

/// Follows the progress of one piece of work after the other. Times are the caller's: any clock, in seconds.
class TimeLeft {
 public:
  /// Notes the state at a time. A share of nought after one near the end, or one that falls where another first stage begins, begins a new piece of work; a
  /// share that falls within a stage (a part that is done again) counts as the largest so far.
  void note(const ProgressState& state, double seconds);
  /// Seconds from the latest note on; nothing before k_least_share of the work and k_least_seconds: too little is known.
  std::optional<double> estimate() const;
  double share() const { return share_; }

  static constexpr double k_least_share = 0.02;
  static constexpr double k_least_seconds = 1.0;

 private:
  bool is_begun_ = false;
  std::string work_;  ///< first name of the stage
  double start_ = 0.0;
  double share_ = 0.0;
  double at_share_ = 0.0;  ///< seconds from the start to where the share got there
  double now_ = 0.0;       ///< seconds from the start
};

}  // namespace sterna::scripting
