#pragma once

namespace poesy {

/// A confidence interval; NaN at both ends where there are too few samples.
struct Interval {
  double low;   ///< lower end
  double high;  ///< upper end
};

/// An estimate with its interval.
struct Estimate {
  double value;       ///< what is estimated
  Interval interval;  ///< of the value, at the level that was asked for
};

}  // namespace poesy
