#include "engine/stats/first_order.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

constexpr std::size_t kGridInBin = 128;
constexpr std::size_t kFewestBins = 4;
constexpr double kSamplesForBin = 16.0;  ///< least average number of samples in a bin; with fewer, bins are merged
constexpr double kFewestInBin = 4.0;     ///< least number of samples in each bin
static_assert(kFewestBins * kSamplesForBin == kFewestIndexSamples);

constexpr int kMostBins = static_cast<int>(kEffectBins);
static_assert(kMostBins <= 32, "Strata::ends has a bit for each");
using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostBins, 1>;
using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostBins, kMostBins>;

double square(double x) { return x * x; }
double cube(double x) { return x * x * x; }

/// Maps [0, 1] to [0, 1] with zero slope at both ends. So a grid of mapped points is finest at the ends, where the
/// quantile function may be infinite.
double graded(double t) { return square(t) * (3.0 - 2.0 * t); }

/// Statistics of the samples in bins of equal probability of an error, and the distribution of the error in these bins.
struct Strata {
  Vector count;      ///< [bins] number of samples; the lists below also have one entry for each bin
  Vector mean;       ///< mean of the response, minus the average of this mean over the bins
  Vector variance;   ///< sample variance of the response
  Vector of_mean;    ///< sampling variance of `mean`
  Vector steps;      ///< 1 / difference of the mean error between the two neighbouring bins; 0 without neighbours
  Vector spread;     ///< variance of the error within the bin
  Vector asymmetry;  ///< third central moment of the error within the bin
  /// One bit for each bin: 1 if the mean error decreases from this bin to the next, which happens between the two
  /// halves of a shifted distribution. No slope is computed across such a step.
  std::uint32_t ends = 0;

  Eigen::Index bins() const { return count.size(); }
  Eigen::Index below(Eigen::Index b) const { return b == 0 || is_end(b - 1) ? b : b - 1; }
  Eigen::Index above(Eigen::Index b) const { return b == bins() - 1 || is_end(b) ? b : b + 1; }
  bool is_end(Eigen::Index b) const { return (ends >> b & 1) != 0; }
  /// The slope of the response over the error in a bin.
  double slope(Eigen::Index b) const { return (mean[above(b)] - mean[below(b)]) * steps[b]; }
};

/// Replaces each pair of neighbouring bins by one bin, in the first half of `bins`.
void halve(std::span<BinSums> bins) {
  for (std::size_t b = 0; b < bins.size() / 2; ++b) {
    const BinSums& first = bins[2 * b];
    const BinSums& second = bins[2 * b + 1];
    bins[b] = {first.count + second.count, first.sum + second.sum, first.square + second.square};
  }
}

void halve(BinSpread& spread, std::size_t bins) {
  for (std::size_t b = 0; b < bins / 2; ++b) {
    const std::size_t first = 2 * b;
    const double half = 0.5 * (spread.mean[first + 1] - spread.mean[first]);
    const double variance = 0.5 * (spread.variance[first] + spread.variance[first + 1]);
    spread.third[b] = 0.5 * (spread.third[first] + spread.third[first + 1]) +
                      1.5 * half * (spread.variance[first + 1] - spread.variance[first]);
    spread.mean[b] = spread.mean[first] + half;
    spread.variance[b] = variance + square(half);
  }
}

Strata strata_of(std::span<const BinSums> sums, const BinSpread& spread) {
  const auto bins = static_cast<Eigen::Index>(sums.size());
  Strata strata;
  for (Vector* values : {&strata.count, &strata.mean, &strata.variance, &strata.of_mean, &strata.steps, &strata.spread,
                         &strata.asymmetry}) {
    values->resize(bins);
  }
  for (std::size_t b = 0; b + 1 < sums.size(); ++b) {
    if (spread.mean[b + 1] < spread.mean[b]) strata.ends |= std::uint32_t{1} << b;
  }
  for (Eigen::Index b = 0; b < bins; ++b) {
    const auto at = static_cast<std::size_t>(b);
    const auto [count, sum, squares] = sums[at];
    strata.count[b] = count;
    strata.mean[b] = sum / count;
    strata.variance[b] = std::max(0.0, squares - sum * sum / count) / (count - 1.0);
    strata.of_mean[b] = strata.variance[b] / count;
    const double step =
        spread.mean[static_cast<std::size_t>(strata.above(b))] - spread.mean[static_cast<std::size_t>(strata.below(b))];
    strata.steps[b] = step == 0.0 ? 0.0 : 1.0 / step;
    strata.spread[b] = spread.variance[at];
    strata.asymmetry[b] = spread.third[at];
  }
  strata.mean.array() -= strata.mean.mean();
  return strata;
}

/// The matrix F of the quadratic form mean' F mean that is the variance of the bins' means.
Matrix form_of_steps(Eigen::Index bins) {
  const double share = 1.0 / static_cast<double>(bins);
  Matrix form = Matrix::Constant(bins, bins, -share * share);
  form.diagonal().array() += share;
  return form;
}

/// The matrix of form_of_steps(), plus the variance of a straight line over the error within each bin.
Matrix form_of_lines(const Strata& strata) {
  Matrix form = form_of_steps(strata.bins());
  for (Eigen::Index b = 0; b < strata.bins(); ++b) {
    const double weight = strata.spread[b] * square(strata.steps[b]) / static_cast<double>(strata.bins());
    const Eigen::Index low = strata.below(b);
    const Eigen::Index high = strata.above(b);
    form(low, low) += weight;
    form(high, high) += weight;
    form(low, high) -= weight;
    form(high, low) -= weight;
  }
  return form;
}

/// The sum of a_ij b_ij v_i v_j over i and j.
double product(const Matrix& a, const Matrix& b, const Vector& v) { return v.dot(a.cwiseProduct(b) * v); }

/// Sets `signal` and `noise`. lines, steps: the matrices of the quadratic forms that give `between` and `total` from
/// the means of the bins.
void set_normal_parts(const Strata& strata, const Matrix& lines, const Matrix& steps, BinnedVariance& found) {
  const Vector& of_mean = strata.of_mean;
  const Vector a = lines * strata.mean;
  const Vector c = steps * strata.mean;
  const std::array forms{product(lines, lines, of_mean), -2.0 * product(lines, steps, of_mean),
                         product(steps, steps, of_mean)};
  const std::array effects{of_mean.dot(a.cwiseProduct(a)), -2.0 * of_mean.dot(a.cwiseProduct(c)),
                           of_mean.dot(c.cwiseProduct(c))};
  for (std::size_t k = 0; k < 3; ++k) {
    found.signal[k] = 4.0 * (effects[k] - forms[k]);
    found.noise[k] = 2.0 * forms[k];
  }
  for (Eigen::Index b = 0; b < strata.bins(); ++b) {
    // variance of the sample variance, for normal samples
    const double of_variance = 2.0 * square(strata.variance[b]) / (strata.count[b] + 1.0);
    const double in_between = lines(b, b) / strata.count[b];
    const double in_total = 1.0 / static_cast<double>(strata.bins()) - steps(b, b) / strata.count[b];
    found.noise[0] += of_variance * square(in_between);
    found.noise[1] += of_variance * 2.0 * in_between * in_total;
    found.noise[2] += of_variance * square(in_total);
  }
}

/// Sets `tails`. The fourth moment of all samples is known, and therefore also the sum of E[k4(u)] and 4 E[d k3(u)].
/// Here d is the effect, and k3 and k4 are the third and fourth cumulants within the bin of u. The second term has two
/// parts: one of the straight lines, and one of the deviations from the lines. The part of the deviations is estimated
/// as if their skewness were the same in all bins.
void set_tails(const Strata& strata, const Moments& all, BinnedVariance& found) {
  const auto n = static_cast<double>(all.count());
  const double deviation = std::sqrt(all.variance() * (n - 1.0) / n);
  if (!(deviation > 0.0)) return;
  const Vector share = strata.count / n;
  const double centre = share.dot(strata.mean);
  double fourth = all.kurtosis() * square(square(deviation));
  double third = all.skewness() * cube(deviation);
  double of_lines = 0.0;  // estimate of E[d k3(u)] from the straight lines
  double of_rest = 0.0;   // estimate from the deviations from the lines, if their skewness were 1
  double rest = 0.0;
  for (Eigen::Index b = 0; b < strata.bins(); ++b) {
    const double d = strata.mean[b] - centre;
    const double count = strata.count[b];
    const double within = strata.variance[b] * (count - 1.0) / count;
    const double slope = strata.slope(b);
    const double line = cube(slope) * strata.asymmetry[b];
    const double scatter = std::max(0.0, strata.variance[b] - square(slope) * strata.spread[b]);
    const double scatter3 = scatter * std::sqrt(scatter);
    fourth -= share[b] * (square(square(d)) + 6.0 * square(d) * within +
                          3.0 * square(strata.variance[b]) * (count - 1.0) / (count + 1.0));
    third -= share[b] * (cube(d) + 3.0 * d * within + line);
    of_lines += share[b] * d * line;
    of_rest += share[b] * d * scatter3;
    rest += share[b] * scatter3;
  }
  const double product = of_lines + (rest > 0.0 ? third / rest * of_rest : 0.0);
  found.tails = {0.0, -4.0 * product / n, fourth / n};
}

double at(const std::array<double, 3>& polynomial, double x) {
  return polynomial[0] + x * (polynomial[1] + x * polynomial[2]);
}

/// The variance of a sum, from the variances of its terms and their dependence.
class VarianceOfSum {
 public:
  explicit VarianceOfSum(Dependence dependence) : dependence_(dependence) {}

  void add(double variance) { sum_ += dependence_ == Dependence::independent ? variance : std::sqrt(variance); }
  double value() const { return dependence_ == Dependence::independent ? sum_ : square(sum_); }

 private:
  Dependence dependence_;
  double sum_ = 0.0;
};

}  // namespace

std::vector<double> bin_spread_grid() {
  std::vector<double> uniforms;
  for (std::size_t b = 0; b < kEffectBins; ++b) {
    for (std::size_t k = 0; k < kGridInBin; ++k) {
      const double in_bin = graded((static_cast<double>(k) + 0.5) / kGridInBin);
      uniforms.push_back((static_cast<double>(b) + in_bin) / kEffectBins);
    }
  }
  return uniforms;
}

BinSpread bin_spread(std::span<const double> quantiles) {
  POESY_EXPECTS(quantiles.size() == kEffectBins * kGridInBin);
  std::array<double, kGridInBin> weights{};
  for (std::size_t k = 0; k < kGridInBin; ++k) {
    const auto cell = static_cast<double>(k);
    weights[k] = graded((cell + 1.0) / kGridInBin) - graded(cell / kGridInBin);
  }
  BinSpread spread;
  for (std::size_t b = 0; b < kEffectBins; ++b) {
    const std::span<const double> values = quantiles.subspan(b * kGridInBin, kGridInBin);
    for (std::size_t k = 0; k < kGridInBin; ++k) spread.mean[b] += weights[k] * values[k];
    for (std::size_t k = 0; k < kGridInBin; ++k) {
      const double off = values[k] - spread.mean[b];
      spread.variance[b] += weights[k] * square(off);
      spread.third[b] += weights[k] * cube(off);
    }
  }
  return spread;
}

BinnedVariance binned_variance(const std::array<BinSums, kEffectBins>& sums, const Moments& all,
                               const BinSpread& spread) {
  BinnedVariance found;
  found.samples = all.count();
  std::array<BinSums, kEffectBins> merged = sums;
  BinSpread merged_spread = spread;
  std::span<BinSums> bins = merged;
  const auto too_few = [&] {
    return static_cast<double>(found.samples) < kSamplesForBin * static_cast<double>(bins.size()) ||
           std::ranges::min(bins, {}, &BinSums::count).count < kFewestInBin;
  };
  while (bins.size() >= kFewestBins && too_few()) {
    halve(bins);
    halve(merged_spread, bins.size());
    bins = bins.first(bins.size() / 2);
  }
  if (bins.size() < kFewestBins) {
    found.between = found.total = kNaN;
    return found;
  }
  const Strata strata = strata_of(bins, merged_spread);
  const Matrix lines = form_of_lines(strata);
  const Matrix steps = form_of_steps(strata.bins());
  found.between = strata.mean.dot(lines * strata.mean) - lines.diagonal().dot(strata.of_mean);
  found.total = strata.mean.dot(steps * strata.mean) - steps.diagonal().dot(strata.of_mean) + strata.variance.mean();
  set_normal_parts(strata, lines, steps, found);
  set_tails(strata, all, found);
  return found;
}

Estimate first_order_index(std::span<const BinnedVariance> parts, Dependence dependence, double conf_level) {
  double between = 0.0;
  double total = 0.0;
  for (const BinnedVariance& part : parts) {
    between += part.between;
    total += part.total;
  }
  if (!(total > 0.0)) return {kNaN, {kNaN, kNaN}};
  const double index = between / total;
  VarianceOfSum without_effect(dependence);
  VarianceOfSum with_effect(dependence);
  VarianceOfSum growth(dependence);
  for (const BinnedVariance& part : parts) {
    const double noise = at(part.noise, index) + std::max(0.0, at(part.tails, index));
    without_effect.add(noise);
    with_effect.add(std::max(0.0, noise + at(part.signal, index)));
    growth.add(4.0 * square(part.total) / static_cast<double>(part.samples));
  }
  // The variance of an estimate grows with the true index S by about 4 (1 - S) (1 - 3 S) / n. So an index S is
  // compatible with the estimate if (estimate - S)^2 <= z^2 (variance + growth (S - estimate)), or if noise alone
  // explains the difference.
  const double z = two_sided_normal_quantile(conf_level);
  const double inside = std::clamp(index, 0.0, 1.0);
  const double shift = 0.5 * square(z / total) * (1.0 - inside) * (1.0 - 3.0 * inside) * growth.value();
  const double half = std::sqrt(square(shift) + square(z / total) * with_effect.value());
  const double least = z / total * std::sqrt(without_effect.value());
  return {index, {index + std::min(-least, shift - half), index + std::max(least, shift + half)}};
}

}  // namespace poesy
