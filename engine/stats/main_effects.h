#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/stats/moments.h"

/// First-order indices and main effects of all errors from the samples of any Monte Carlo run: samples are put into
/// bins of the uniform u from which an error was drawn, and the means of the bins say how the response follows that
/// error while all others vary. P errors, R responses, B samples.
namespace poesy {

/// Bins of equal probability for each error.
inline constexpr std::size_t kEffectBins = 32;

/// The bin of each uniform, floor(32 u), into bins of the same length. Take them before the uniforms are turned into
/// errors; they are the same at every pose for machines that are used at all poses. Precondition: 0 <= u < 1.
void effect_bins(std::span<const double> uniforms, std::span<std::uint8_t> bins);

/// Where the values of an error lie in its bins: from it follows how much of a main effect happens within bins. Scale
/// does not matter. All zero (as constructed): nothing is known, and the bins are taken for steps.
struct BinSpread {
  std::array<double, kEffectBins> mean{};      ///< of the error in each bin
  std::array<double, kEffectBins> variance{};  ///< within each bin
};

/// The uniforms at which bin_spread() wants an error's quantile function: a fine grid, ascending.
std::vector<double> bin_spread_grid();
/// The spread of an error whose quantile function has these values on bin_spread_grid(). Precondition: finite values.
BinSpread bin_spread(std::span<const double> quantiles);

/// How much of the variance of a response one error makes alone, at one pose, and how sure that is.
struct BinnedVariance {
  std::uint64_t samples = 0;  ///< that count
  double between = 0.0;       ///< estimate of Var(E[y | u]), without what noise within bins adds; may be negative
  double total = 0.0;         ///< estimate of Var(y)
  double var_between = 0.0;   ///< squared standard error of between
  double var_total = 0.0;     ///< of total
  double covariance = 0.0;    ///< of both
};

/// Whether estimates at several poses are independent of each other.
enum class AcrossPoses {
  independent_draws,  ///< each pose has draws of its own
  same_machines       ///< the same machines are used at all poses: estimates depend on each other in an unknown way
};

/// First-order index S1 = Var(E[y | u]) / Var(y) of an error. For several poses numerators and denominators are added
/// up before they are divided (aggregated index), so that a pose counts by how much the response varies there.
Estimate first_order_index(std::span<const BinnedVariance> poses, AcrossPoses dependence, double conf_level);

/// A main effect as a curve over the bins.
struct EffectCurve {
  std::array<double, kEffectBins> mean{};      ///< E[y | u in bin]; NaN without samples
  std::array<Interval, kEffectBins> interval;  ///< Student's, of each bin by itself; NaN below two samples
};

/// Sums over the samples of each bin, for each response and error.
class MainEffectSums {
 public:
  /// errors: P. shift: [R] a value of each response in the middle of its samples, give or take a few standard
  /// deviations: sums are of what is left, so that nothing cancels.
  MainEffectSums(std::size_t errors, std::span<const double> shift);

  /// Adds B samples. bins: [P x B] as effect_bins() gives them. responses: [R x B], row-major as OutcomeBlock has them.
  /// counts: [B] 1 where the sample counts, else 0; its responses are then not looked at.
  void add(std::span<const std::uint8_t> bins, std::span<const double> responses, std::span<const std::uint8_t> counts);
  /// Adds what the other one added. Merging in the same order gives the same bits. Precondition: the same errors and
  /// shifts.
  void merge(const MainEffectSums& other);

  std::uint64_t samples() const { return samples_; }  ///< That count.

  /// What one error does to one response.
  BinnedVariance variance(std::size_t response, std::size_t error, const BinSpread& spread) const;
  /// The same as a curve. Precondition: 0 < conf_level < 1.
  EffectCurve curve(std::size_t response, std::size_t error, double conf_level) const;

  /// Every bit of the sums, and back.
  void write(ByteWriter& to) const;
  /// Of P errors, with the same shifts [R]. Throws BytesError for what no samples give.
  static MainEffectSums read(ByteReader& from, std::size_t errors, std::span<const double> shift);

 private:
  std::uint64_t samples_ = 0;
};

}  // namespace poesy
