#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/stats/moments.h"

/// First-order indices of an error from samples in bins of the uniform from which it was drawn, all other errors
/// varying too. Formulas and coverage of the intervals: theory.md, D58.
namespace poesy {

/// Bins of equal probability.
inline constexpr std::size_t kEffectBins = 32;

/// With fewer samples that count no index is formed, because each of at least four bins holds sixteen on average.
inline constexpr std::uint64_t kFewestIndexSamples = 64;

/// Sums over the samples of a response in one bin.
struct BinSums {
  double count = 0.0;   ///< samples
  double sum = 0.0;     ///< of y - c, with one c for all bins
  double square = 0.0;  ///< of (y - c)^2
};

/// How the values of an error lie in its bins. From it follows how much of a main effect happens within bins. The unit
/// does not matter. All zero (as constructed): nothing is known, and effects are taken for steps from bin to bin.
struct BinSpread {
  std::array<double, kEffectBins> mean{};      ///< of the error in each bin
  std::array<double, kEffectBins> variance{};  ///< within each bin
  std::array<double, kEffectBins> third{};     ///< third central moment within each bin
};

/// The uniforms at which bin_spread() wants the quantile function of an error: a fine grid, ascending.
std::vector<double> bin_spread_grid();
/// The spread of an error whose quantile function has these values on bin_spread_grid(). Precondition: they are finite.
BinSpread bin_spread(std::span<const double> quantiles);

/// How much of the variance of a response one error makes alone, and what the interval of an index needs. The three
/// polynomials, by powers of S, are parts of the variance of between - S total.
struct BinnedVariance {
  std::uint64_t samples = 0;       ///< that count
  double between = 0.0;            ///< estimate of Var(E[y | u]) without what noise within bins adds; may be negative
  double total = 0.0;              ///< estimate of Var(y)
  std::array<double, 3> signal{};  ///< noise of the bins' means times the effect
  std::array<double, 3> noise{};   ///< noise of the bins' means and variances alone, as if normal
  std::array<double, 3> tails{};   ///< what kurtosis and skewness within bins add; counts where it is positive
};

/// The variance from the sums of a response in the bins of an error. all: the moments of the same samples.
/// Takes 16, 8 or 4 bins where there are fewer than 16 samples for each, or a bin has fewer than four; NaN below
/// kFewestIndexSamples. The part of an effect that happens within bins is estimated too, as that of a straight line
/// over the error (spread) in each bin, whose slope is that between the neighbouring bins; bins between which the error
/// goes down, as in the middle of a shifted distribution, are no neighbours. Without a spread it is left out.
///
/// Bias of between with 32 bins, of its true value, without and with a spread: a straight line over a normal error
/// -0.92 %, 0; over a uniform error -0.10 %, 0; |z| -2.5 %, -0.007 %; the Ishigami function's first two errors -0.32 %,
/// -1.28 % and -0.006 %, -0.06 %; z^2 -10 %, -3.2 %; exp(z / 2) -3.7 %, -1.3 %; exp(z) -18 %, -11 %: what
/// happens in the outermost bins of a normal error is seen least.
BinnedVariance binned_variance(const std::array<BinSums, kEffectBins>& sums, const Moments& all,
                               const BinSpread& spread);

/// Whether estimates depend on each other.
enum class Dependence {
  independent,  ///< each is from draws of its own: poses of a study that draws for each pose
  unknown       ///< all are from the same draws: poses of machines that are used at all poses, components of a vector
};

/// First-order index S1 = Var(E[y | u]) / Var(y) of an error, at one pose or aggregated: numerators and denominators of
/// several poses are added up before they are divided, so a pose counts by how much the response varies there. Over the
/// components of a vector the same gives the generalised index (Gamboa, Janon, Klein and Lagnoux 2014, Electron. J.
/// Stat. 8, 575-603). NaN where nothing varies, or a part is not known.
///
/// An index is not clipped to [0, 1]: that of an error without effect is as often negative as positive, so that sums
/// and means of indices are right. Its interval holds the indices that are compatible with the estimate.
/// Dependence::unknown adds standard errors instead of variances, which is right where all parts go up and down
/// together, and wide elsewhere.
/// Of 95 % intervals, 95 to 98 % held the true index from 256 to 16 384 samples, for linear and folded responses of
/// normal errors and the Ishigami function, and up to 99.7 % for what is heavy-tailed or all interaction. Where the
/// standard error falls below the bias of the bins (binned_variance) they hold it less often: 77 % for an index of 0.59
/// of exp(z) with 16 384 samples. Tables: theory.md. Precondition: 0 < conf_level < 1.
Estimate first_order_index(std::span<const BinnedVariance> parts, Dependence dependence, double conf_level);

}  // namespace poesy
