#pragma once

#include <cmath>

#include "engine/stats/moments.h"

namespace poesy::test {

/// How often 95 % intervals hold the truth. One with NaN at an end holds nothing.
class Coverage {
 public:
  void add(const Interval& interval, double truth) {
    ++all_;
    if (interval.low > truth) ++too_high_;
    if (!(interval.high >= truth)) ++too_low_;
  }

  double too_high() const { return too_high_ / all_; }  ///< Share of intervals that lie above the truth.
  double too_low() const { return too_low_ / all_; }    ///< Below the truth, or with NaN.
  double share() const { return 1.0 - too_high() - too_low(); }
  /// Distance of the share from 0.95, in its standard errors.
  double z() const { return (share() - 0.95) / std::sqrt(0.95 * 0.05 / all_); }

 private:
  double all_ = 0.0;
  double too_high_ = 0.0;
  double too_low_ = 0.0;
};

}  // namespace poesy::test
