#pragma once

namespace poesy {

/// A confidence interval; NaN at both ends where there are too few samples.
struct Interval {
  double low;
  double high;
};

/// An estimate with its interval.
struct Estimate {
  double value;
  Interval interval;
};

}  // namespace poesy
