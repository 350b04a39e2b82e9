#include "engine/fits/preferred_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr double kRounding = 1e-12;

/// The numbers of R20, in hundredths. R10 has every second of them, R5 every fourth.
constexpr std::array<int, 20> kHundredths{100, 112, 125, 140, 160, 180, 200, 224, 250, 280,
                                          315, 355, 400, 450, 500, 560, 630, 710, 800, 900};

constexpr std::size_t stride(PreferredSeries series) {
  return series == PreferredSeries::r20 ? 1 : series == PreferredSeries::r10 ? 2 : 4;
}

/// hundredths x 10^(power - 2), as the double nearest to that decimal number.
double decimal(int hundredths, int power) {
  const int exponent = power - 2;
  const double size = std::pow(10.0, std::abs(exponent));
  return exponent < 0 ? hundredths / size : hundredths * size;
}

/// The largest power of ten that is not above the value, as an exponent. A value that is below a power of ten only by
/// rounding counts as that power.
int power_of(double value) {
  POESY_EXPECTS(value > 0.0 && std::isfinite(value));
  return static_cast<int>(std::floor(std::log10(value * (1.0 + kRounding))));
}

}  // namespace

std::string_view name(PreferredSeries series) {
  constexpr std::array<std::string_view, 3> kNames{"R5", "R10", "R20"};
  return kNames[static_cast<std::size_t>(series)];
}

std::optional<PreferredSeries> find_preferred_series(std::string_view wanted) {
  for (const PreferredSeries series : {PreferredSeries::r5, PreferredSeries::r10, PreferredSeries::r20}) {
    if (name(series) == wanted) return series;
  }
  return std::nullopt;
}

double preferred_at_most(double value, PreferredSeries series) {
  const int power = power_of(value);
  double found = decimal(kHundredths.front(), power);
  for (std::size_t k = 0; k < kHundredths.size(); k += stride(series)) {
    const double number = decimal(kHundredths[k], power);
    if (number <= value * (1.0 + kRounding)) found = number;
  }
  return found;
}

double preferred_at_least(double value, PreferredSeries series) {
  const int power = power_of(value);
  for (std::size_t k = 0; k < kHundredths.size(); k += stride(series)) {
    const double number = decimal(kHundredths[k], power);
    if (number >= value * (1.0 - kRounding)) return number;
  }
  return decimal(kHundredths.front(), power + 1);
}

}  // namespace poesy
