#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/moments.h"

/// First-order indices and main effects of all errors from the samples of any Monte Carlo run: samples are put into
/// bins of the uniform u from which an error was drawn, and the means of the bins say how a response follows that error
/// while all others vary. P errors, R responses, B samples of a block. Formulas: THEORY.md; coverage: README.md, D58.
namespace poesy {

/// Bins of equal probability for each error.
inline constexpr std::size_t kEffectBins = 32;

/// The bins into which the samples of a block fall. With the same machines at all poses they are the same at each pose:
/// make them once.
class EffectBins {
 public:
  /// uniforms: [P x B], row-major, from which the errors are then made; sample b of error p goes to bin
  /// floor(32 u). Precondition: 0 <= u < 1, B = uniforms.size() / P.
  EffectBins(std::span<const double> uniforms, std::size_t errors);

  std::size_t errors() const { return filled_.size() / kEffectBins; }  ///< P.
  std::size_t samples() const { return samples_; }                     ///< B.
  std::span<const std::uint8_t> bins() const { return bins_; }         ///< [P x B], each below kEffectBins.
  std::span<const std::uint32_t> filled() const { return filled_; }    ///< [P x bins] samples in each bin.

 private:
  std::size_t samples_;
  std::vector<std::uint8_t> bins_;
  std::vector<std::uint32_t> filled_;
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

/// How much of the variance of a response one error makes alone, and what is needed for the interval of an index. The
/// three polynomials, by powers of S, are parts of the variance of between - S total.
struct BinnedVariance {
  std::uint64_t samples = 0;       ///< that count
  double between = 0.0;            ///< estimate of Var(E[y | u]) without what noise within bins adds; may be negative
  double total = 0.0;              ///< estimate of Var(y)
  std::array<double, 3> signal{};  ///< noise of the bins' means times the effect
  std::array<double, 3> noise{};   ///< noise of the bins' means and variances alone, as if normal
  std::array<double, 3> tails{};   ///< what kurtosis and skewness within bins add
};

/// Whether estimates depend on each other.
enum class Dependence {
  independent,  ///< each is from draws of its own: poses of a study that draws for each pose
  unknown       ///< all are from the same draws: poses of machines that are used at all poses, components of a vector
};

/// First-order index S1 = Var(E[y | u]) / Var(y) of an error, at one pose or aggregated: numerators and denominators of
/// several poses are added up before they are divided, so a pose counts by how much the response varies there. Over the
/// components of a vector the same gives the generalised index (Gamboa, Janon, Klein and Lagnoux 2014, Electron. J.
/// Stat. 8, 575-603). NaN where nothing varies, and NaN throughout where a part is not known.
///
/// An index is not clipped to [0, 1], because sums of indices would then be too large; that of an error without effect
/// is as often negative as positive. Its interval is the set of indices that are compatible with the estimate.
/// Dependence::unknown adds standard errors instead of variances, which is right if all are fully correlated and wide
/// otherwise. Precondition: 0 < conf_level < 1.
Estimate first_order_index(std::span<const BinnedVariance> parts, Dependence dependence, double conf_level);

/// Sums over the samples of each bin, for each response and error. Memory: 512 bytes for each response and error, where
/// the number of responses is rounded up to a multiple of four, whatever the number of samples.
class MainEffectSums {
 public:
  MainEffectSums(std::size_t errors, std::size_t responses);  ///< P and R; without samples.

  /// Adds the samples of a block. responses: [R x B], row-major as OutcomeBlock has them. counts: [B] 1 where the
  /// sample counts, 0 where it does not; its responses are then not looked at. Precondition: those that count are
  /// finite.
  void add(const EffectBins& bins, std::span<const double> responses, std::span<const std::uint8_t> counts);
  /// Adds what the other one added. Merging in the same order gives the same bits. Precondition: the same P and R.
  void merge(const MainEffectSums& other);

  std::uint64_t samples() const { return samples_; }  ///< That count.

  /// What one error does to one response. Takes fewer bins (16, 8, 4) where there are fewer than 16 samples for each,
  /// or a bin has fewer than four; NaN below 64 samples. What remains of an effect within bins is added as if it were a
  /// straight line over the error within each bin (spread), with the slope between the neighbouring bins.
  BinnedVariance variance(std::size_t response, std::size_t error, const BinSpread& spread) const;

  /// The main effect as a curve: E[y | u in bin] with Student's interval, bin by bin; each by itself holds its mean at
  /// this level, all together do so less often. NaN without samples; NaN at both ends below two.
  /// Precondition: 0 < conf_level < 1.
  std::array<Estimate, kEffectBins> curve(std::size_t response, std::size_t error, double conf_level) const;

  /// Every bit of the sums, and back.
  void write(ByteWriter& to) const;
  /// Of P errors and R responses. Throws BytesError for what no samples give.
  static MainEffectSums read(ByteReader& from, std::size_t errors, std::size_t responses);

 private:
  static constexpr std::size_t kTogether = 4;  ///< responses that are added in one go
  /// Of four responses, in one bin of one error: sums of y - shift and of its square, in turn.
  using Row = std::array<double, 2 * kTogether>;
  /// What is known of one response in one bin of one error.
  struct Bin {
    double count = 0.0;
    double sum = 0.0;     ///< of y - shift
    double square = 0.0;  ///< of (y - shift)^2
  };

  std::size_t responses() const { return moments_.size(); }
  std::array<Bin, kEffectBins> bins_of(std::size_t response, std::size_t error) const;

  std::size_t errors_;
  std::uint64_t samples_ = 0;
  std::vector<std::uint64_t> counts_;  ///< [P x bins] samples
  std::vector<Moments> moments_;       ///< [R] of all samples, whatever their bins
  /// [R] the mean of the first samples that were added. It is near enough to the mean of all for plain sums of the
  /// differences not to cancel, and plain sums are what vectors add fastest.
  std::vector<double> shift_;
  std::vector<Row> sums_;  ///< [R / 4 x P x bins]
};

}  // namespace poesy
