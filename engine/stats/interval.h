#pragma once

namespace poesy {

/// A confidence interval; NaN at both ends where there are too few samples.
struct Interval {
  double low;
  double high;
};

}  // namespace poesy
