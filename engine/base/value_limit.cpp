#include "engine/base/value_limit.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {

ValueLimit ValueLimit::between(double from, double to) {
  POESY_EXPECTS(from <= to);
  ValueLimit limit(to);
  limit.from_ = from;
  return limit;
}

ValueLimit ValueLimit::of_spread(double most) {
  ValueLimit limit(most);
  limit.is_spread_ = true;
  return limit;
}

ValueLimit ValueLimit::at_share(double share) const {
  POESY_EXPECTS(share > 0.0 && share <= 1.0 && !is_spread_);
  ValueLimit limit = *this;
  limit.share_ = share;
  return limit;
}

double ValueLimit::badness(double value) const {
  if (std::isnan(value)) return std::numeric_limits<double>::infinity();
  return is_magnitude() ? std::abs(value) : std::max(value - to_, from_ - value);
}

std::size_t ValueLimit::poses_beyond(std::size_t poses) const {
  constexpr double kRounding = 1e-9;  // so that a share of 0.9 leaves out 1 of 10 poses, although 1 - 0.9 is rounded
  return static_cast<std::size_t>(std::floor((1.0 - share_) * static_cast<double>(poses) + kRounding));
}

double ValueLimit::deciding(std::span<double> values, std::size_t poses) const {
  if (is_spread_) {
    if (values.empty() || std::ranges::any_of(values, [](double value) { return std::isnan(value); })) return kNaN;
    const auto [least, most] = std::ranges::minmax(values);
    return most - least;
  }
  const std::size_t beyond = poses_beyond(poses);
  if (beyond >= values.size()) return kNaN;
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(beyond);
  std::ranges::nth_element(values, place, std::ranges::greater(), [this](double value) { return badness(value); });
  return *place;
}

bool ValueLimit::keeps(std::span<double> values, std::size_t poses) const {
  if (values.empty() || values.size() <= poses_beyond(poses)) return true;
  return holds(deciding(values, poses));
}

}  // namespace poesy
