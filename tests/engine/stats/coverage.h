#pragma once

#include <cmath>

#include "engine/stats/moments.h"

namespace poesy::test {

/// Counts how often 95 % intervals contain the true value. An interval with NaN at its upper end does not contain it.
class Coverage {
 public:
  void add(const Interval& interval, double truth) {
    ++all_;
    if (interval.low > truth) ++too_high_;
    if (!(interval.high >= truth)) ++too_low_;
  }

  double too_high() const { return too_high_ / all_; }  ///< Share of intervals that lie above the truth.
  double too_low() const { return too_low_ / all_; }    ///< Share of intervals that lie below the truth, or end in NaN.
  double share() const { return 1.0 - too_high() - too_low(); }
  /// Distance of share() from 0.95 in standard errors.
  double z() const { return (share() - 0.95) / std::sqrt(0.95 * 0.05 / all_); }

 private:
  double all_ = 0.0;
  double too_high_ = 0.0;
  double too_low_ = 0.0;
};

}  // namespace poesy::test
