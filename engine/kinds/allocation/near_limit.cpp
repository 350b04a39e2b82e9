#include "engine/kinds/allocation/near_limit.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"

namespace poesy::allocation {
namespace {

/// The largest and the smallest half-width of the window. Machines outside the widest window are too far from the limit
/// to predict rejects. If the loads of all wanted machines are nearer to 1 than the smallest half-width, the window
/// contains more machines than wanted.
constexpr double kWidest = 0.2;
constexpr double kNarrowest = 0.02;

}  // namespace

NearLimit::NearLimit(std::span<const std::uint32_t> machines, std::span<const double> loads, std::size_t count)
    : window_(kWidest) {
  POESY_EXPECTS(machines.size() == loads.size());
  if (loads.size() > count) {
    std::vector<double> distances;
    for (const double load : loads) distances.push_back(std::abs(load - 1.0));
    const auto last = distances.begin() + static_cast<std::ptrdiff_t>(count);
    std::ranges::nth_element(distances, last);
    window_ = std::clamp(*last, kNarrowest, kWidest);
  }
  double rejects = 0.0;
  double by_degrees = 0.0;
  for (std::size_t k = 0; k < machines.size(); ++k) {
    rejects += loads[k] > 1.0 ? 1.0 : 0.0;
    by_degrees += reject(loads[k]);
    if (!is_near(loads[k])) continue;
    machines_.push_back(machines[k]);
    loads_.push_back(loads[k]);
  }
  if (rejects > 0.0) scale_ = rejects / by_degrees;
}

bool NearLimit::is_near(double load) const { return std::abs(load - 1.0) <= window_; }

/// The fraction of a reject that a machine with this load counts as. It is the integral of the biweight kernel, rises
/// from 0 to 1 across the window and has two continuous derivatives.
double NearLimit::reject(double load) const {
  const double u = std::clamp((load - 1.0) / window_, -1.0, 1.0);
  const double square = u * u;
  return 0.5 + u * (15.0 - square * (10.0 - 3.0 * square)) / 16.0;
}

double NearLimit::change(std::span<const double> loads) const {
  POESY_EXPECTS(loads.size() == loads_.size());
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t k = 0; k < loads.size(); ++k) {
    if (std::isinf(loads[k])) continue;
    squares += (loads[k] - loads_[k]) * (loads[k] - loads_[k]);
    ++count;
  }
  return count > 0.0 ? std::sqrt(squares / count) : 0.0;
}

double NearLimit::added_rejects(std::span<const double> coarser) const {
  POESY_EXPECTS(coarser.size() == loads_.size());
  double come = 0.0;
  for (std::size_t k = 0; k < loads_.size(); ++k) come += reject(coarser[k]) - reject(loads_[k]);
  return scale_ * come;
}

double NearLimit::added_rejects(std::span<const double> coarser, std::span<const double> mirrored,
                                std::span<const double> mirrored_coarser) const {
  POESY_EXPECTS(coarser.size() == loads_.size() && mirrored.size() == loads_.size() &&
                mirrored_coarser.size() == loads_.size());
  double come = 0.0;
  for (std::size_t k = 0; k < loads_.size(); ++k) {
    // If both machines of an antithetic pair are near the limit, the pair is counted twice, so its weight is one half.
    const double weight = is_near(mirrored[k]) ? 0.5 : 1.0;
    const double of_machine = reject(coarser[k]) - reject(loads_[k]);
    const double of_mirrored = reject(mirrored_coarser[k]) - reject(mirrored[k]);
    come += weight * (of_machine + of_mirrored);
  }
  return scale_ * come;
}

}  // namespace poesy::allocation
