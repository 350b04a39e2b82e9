#include "engine/random/normal_share.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "engine/base/instruction_sets.h"

namespace poesy {
namespace {

/// c[0] + c[1] x + ... + c[n-1] x^(n-1).
template <std::size_t n>
[[gnu::always_inline]] inline double power_series(const double (&c)[n], double x) {
  double sum = c[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) sum = sum * x + c[k];
  return sum;
}

/// e^x for -700 < x <= 0, almost to the last digit: 2^n e^r with |r| <= log(2) / 2 and the Taylor series of e^r.
[[gnu::always_inline]] inline double exponential(double x) {
  constexpr double kRound = 0x1.8p52;  // adding it rounds to a whole number
  constexpr double kLog2High = 6.93147180369123816490e-01;
  constexpr double kLog2Low = 1.90821492927058770002e-10;
  constexpr double kInverse[] = {
      1.0,        1.0,         1.0 / 2,      1.0 / 6,       1.0 / 24,       1.0 / 120,       1.0 / 720,
      1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
  const double shifted = x * 1.44269504088896338700 + kRound;
  const double n = shifted - kRound;
  const double r = (x - n * kLog2High) - n * kLog2Low;
  const std::uint64_t power = (std::bit_cast<std::uint64_t>(shifted) + 1023) << 52;  // the low bits of `shifted` are n
  return power_series(kInverse, r) * std::bit_cast<double>(power);
}

/// The share of a standard normal above a, for 0 <= a <= 8.3. It is computed from Mills' ratio. Mills' ratio times (a +
/// 4) is approximated, with a relative error of 5e-17, by a polynomial in (a - 4) / (a + 4) that was interpolated with
/// 50 digits at Chebyshev nodes.
[[gnu::always_inline]] inline double share_beyond(double a) {
  constexpr double kSeries[] = {0.75528513041575152,     -0.60789664197189219,    0.38713740074222225,
                                -0.18652185795966197,    0.060396574890266341,    -0.0075401889661925407,
                                -0.0034796923436974702,  0.0016308184572875913,   0.00013334388535596775,
                                -0.00023109537086515378, -1.9043833307616457e-06, 3.5153156676720419e-05,
                                7.0441906602585685e-07,  -5.9786920165432944e-06, -6.7132296152016007e-07,
                                1.1269880691887907e-06,  5.275575752098381e-07,   7.8218842504112072e-08};
  const double inverse = 1.0 / (a + 4.0);
  return exponential(-0.5 * a * a) * power_series(kSeries, (a - 4.0) * inverse) * inverse;
}

POESY_EACH_INSTRUCTION_SET void replace_by_shares(double* values, std::size_t count) {
  constexpr double kMost = 8.2;
  for (std::size_t k = 0; k < count; ++k) {
    const double beyond = share_beyond(std::min(std::abs(values[k]), kMost));
    values[k] = values[k] < 0.0 ? beyond : 1.0 - beyond;
  }
}

}  // namespace

void normal_shares(std::span<double> values) { replace_by_shares(values.data(), values.size()); }

}  // namespace poesy
