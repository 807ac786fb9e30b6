// Estimate of the remaining time of some work from its reported progress fractions.
#pragma once

#include <optional>
#include <string>

#include "geom/base/run_context.h"

namespace sterna::scripting {

/// Tracks the progress of successive pieces of work. Times are from any clock of the caller, in seconds.
class TimeLeft {
 public:
  /// Records the state at a time. A new piece of work begins with a fraction of zero after one close to 1, or with a decreasing fraction in another first
  /// stage. If a part is repeated and the fraction decreases within a stage, the largest fraction so far is used.
  void note(const ProgressState& state, double seconds);
  /// Returns the remaining seconds from the latest note; empty before k_least_share of the work and k_least_seconds, when there is too little information.
  std::optional<double> estimate() const;
  double share() const { return share_; }

  static constexpr double k_least_share = 0.02;
  static constexpr double k_least_seconds = 1.0;

 private:
  bool is_begun_ = false;
  std::string work_;  ///< first name of the stage
  double start_ = 0.0;
  double share_ = 0.0;
  double at_share_ = 0.0;  ///< seconds from the start until the present fraction was reached
  double now_ = 0.0;       ///< seconds from the start
};

}  // namespace sterna::scripting
