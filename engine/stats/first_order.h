#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/stats/moments.h"

/// First-order indices of an error, estimated while all other errors vary too. The samples are divided into bins of the
/// uniform number from which the error was drawn. Formulas and coverage of the intervals: docs/theory.md and decision
/// D58 in docs/decisions.
namespace poesy {

/// The number of bins of equal probability into which samples are divided.
inline constexpr std::size_t kEffectBins = 32;

/// The least number of samples for an index: at least four bins with sixteen samples on average.
inline constexpr std::uint64_t kFewestIndexSamples = 64;

/// Sums over the responses of the samples in one bin.
struct BinSums {
  double count = 0.0;   ///< number of samples
  double sum = 0.0;     ///< sum of y - c over the responses y in the bin, with the same constant c for all bins
  double square = 0.0;  ///< sum of (y - c)^2 over these responses
};

/// The distribution of an error within the bins, in any unit. It is needed to estimate how much a main effect varies
/// within bins. If all numbers are zero (default), a main effect is taken as constant within each bin.
struct BinSpread {
  std::array<double, kEffectBins> mean{};      ///< mean of the error in each bin
  std::array<double, kEffectBins> variance{};  ///< variance of the error within each bin
  std::array<double, kEffectBins> third{};     ///< third central moment of the error within each bin
};

/// A fine, ascending grid of shares in (0, 1), at which bin_spread() needs the quantile function of an error.
std::vector<double> bin_spread_grid();
/// The distribution of an error within bins. quantiles: values of the error's quantile function on bin_spread_grid(),
/// finite.
BinSpread bin_spread(std::span<const double> quantiles);

/// The part of a response's variance that one error causes without the others, with the data for the interval of its
/// first-order index S. The sampling variance of the difference `between` - S `total` is a sum of three polynomials in
/// S: `signal`, `noise` and `tails`, each given by its coefficients of 1, S and S^2.
struct BinnedVariance {
  std::uint64_t samples = 0;  ///< number of samples that the estimate uses
  /// Estimate of Var(E[y | u]), without the bias from noise within bins; may be negative. E[y | u] is the mean of the
  /// response y for a given value of u, the uniform number from which the error is drawn.
  double between = 0.0;
  double total = 0.0;              ///< estimate of Var(y)
  std::array<double, 3> signal{};  ///< part from the product of the bins' noise and the effect
  std::array<double, 3> noise{};   ///< part from noise in the bins' means and variances, if samples are normal
  std::array<double, 3> tails{};   ///< part added by kurtosis and skewness within bins; used only if positive
};

/// Computes the estimates for one error from the sums of a response in bins of the error's uniform number u. all: the
/// moments of the response over all samples. Bins are merged to 16, 8 or 4 bins if there are fewer than 16 samples per
/// bin on average, or a bin has fewer than four. If even four bins have too few samples, `between` and `total` are NaN.
///
/// The response also varies within a bin with the error. This variance is estimated as that of a straight line over the
/// error: slope^2 times the variance of the error within the bin. The slope comes from the means of the two
/// neighbouring bins, the variance of the error from `spread`. This part is left out if `spread` is all zero. Two bins
/// are not neighbours if the error decreases from one to the next: a shifted distribution jumps back at u = 1/2, from
/// the largest error of its low half to the smallest one of its high half.
///
/// `between` underestimates Var(E[y | u]). Relative bias with 32 bins, first without a spread and then with one, for
/// these responses (z is a standard normal error):
/// - a straight line over a normal error -0.92 %, 0; over a uniform error -0.10 %, 0
/// - |z| -2.5 %, -0.007 %; z^2 -10 %, -3.2 %; exp(z / 2) -3.7 %, -1.3 %; exp(z) -18 %, -11 %
/// - the Ishigami function's first error -0.32 %, -0.006 %; its second error -1.28 %, -0.06 %
///
/// Most of the bias comes from the outermost bins of a normal error.
BinnedVariance binned_variance(const std::array<BinSums, kEffectBins>& sums, const Moments& all,
                               const BinSpread& spread);

/// Whether estimates depend on each other.
enum class Dependence {
  independent,  ///< the estimates come from separate draws, as at poses that each have new draws of the errors
  unknown       ///< the estimates come from the same draws, as at poses with the same machines, or for components of a
                ///< vector
};

/// The first-order index S1 = Var(E[y | u]) / Var(y) of an error, at one pose or aggregated. Numerators and
/// denominators of several poses are summed before the division, so each pose is weighted by the variance of its
/// response. For the components of a vector this gives the generalised index (Gamboa, Janon, Klein and Lagnoux 2014,
/// Electron. J. Stat. 8, 575-603). NaN if nothing varies, or if a part is NaN.
///
/// An index is not clipped to [0, 1]: that of an error without effect is as often negative as positive, so that sums
/// and means of indices are unbiased. The interval contains the indices that are compatible with the estimate.
/// Dependence::unknown adds standard errors instead of variances. This is exact if all parts vary together; otherwise
/// the interval is too wide.
///
/// Of 95 % intervals, 95 to 98 % contained the true index from 256 to 16 384 samples, for linear and folded responses
/// of normal errors and the Ishigami function, and up to 99.7 % for heavy tails or pure interaction. If the standard
/// error is below the bias of the bins (binned_variance), coverage is lower: 77 % for an index of 0.59 of exp(z) with
/// 16 384 samples. Tables: theory.md. Precondition: 0 < conf_level < 1.
Estimate first_order_index(std::span<const BinnedVariance> parts, Dependence dependence, double conf_level);

}  // namespace poesy
