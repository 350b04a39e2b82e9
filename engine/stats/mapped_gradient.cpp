#include "engine/stats/mapped_gradient.h"

#include <utility>

#include "engine/base/contract.h"

namespace poesy {
namespace {

/// The relative step of a central difference for the derivative by ln t, the logarithm of the size t of an error.
constexpr double kStep = 1e-3;

/// How the probability that an error is in a range changes with the size t of the error.
struct RangeChange {
  double slope;   ///< derivative of the probability by ln t
  double growth;  ///< change of the probability if t grows by the factor kErrorGrowth
};

RangeChange change_in(const ErrorRange& error, double low, double high) {
  if (!(low < high)) return {0.0, 0.0};
  const auto inside = [&](double growth) { return error.below(high, growth) - error.below(low, growth); };
  return {(inside(1.0 + kStep) - inside(1.0 - kStep)) / (2.0 * kStep), inside(kErrorGrowth) - inside(1.0)};
}

Estimate estimate_of(const PowerSums& powers, std::uint64_t machines, const ScoreMoments& score, double conf_level) {
  const auto n = static_cast<double>(machines);
  const ScoreMoments added{kAddedRejects * score.square / n, 0.0};  // assumed further machines that the map misjudges
  return skewed_mean(powers, machines, added, n - 1.0, conf_level);
}

}  // namespace

MappedGradient::MappedGradient(LinearLimits limits, std::vector<std::optional<MappedError>> errors)
    : limits_(std::move(limits)), errors_(std::move(errors)), slope_(errors_.size()), growth_(errors_.size()) {
  for (const auto& error : errors_) reach_.push_back(error ? kErrorGrowth * error->range.length() : 0.0);
}

void MappedGradient::add(std::span<const double> errors, std::span<const std::uint8_t> rejected) {
  const std::size_t block = rejected.size();
  POESY_EXPECTS(errors.size() == errors_.size() * block);
  const LinearLimits::Machines by_map = limits_.machines(errors, reach_);
  machines_ += block;
  for (std::size_t b = 0; b < block; ++b) misjudged_ += rejected[b] == by_map.rejected[b] ? 0 : 1;
  for (std::size_t p = 0; p < errors_.size(); ++p) {
    if (!errors_[p]) continue;
    const auto& [range, score] = *errors_[p];
    for (std::size_t k = p * block; k < (p + 1) * block; ++k) {
      RangeChange change = change_in(range, by_map.low[k], by_map.high[k]);
      const int off = static_cast<int>(rejected[k - p * block]) - static_cast<int>(by_map.rejected[k - p * block]);
      if (off != 0) {
        change.slope -= off * score(errors[k]);
        change.growth -= off * score.growth(errors[k]);
      }
      slope_[p].add(change.slope);
      growth_[p].add(change.growth);
    }
  }
}

Estimate MappedGradient::gradient(std::size_t error, double conf_level) const {
  POESY_EXPECTS(errors_[error]);
  const PolynomialScore& score = errors_[error]->score;
  const auto [value, interval] = estimate_of(slope_[error], machines_, score.moments(), conf_level);
  return {value / score.sigma(), {interval.low / score.sigma(), interval.high / score.sigma()}};
}

Estimate MappedGradient::change(std::size_t error, double conf_level) const {
  POESY_EXPECTS(errors_[error]);
  return estimate_of(growth_[error], machines_, errors_[error]->score.growth_moments(), conf_level);
}

}  // namespace poesy
