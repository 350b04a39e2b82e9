#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/stats/first_order.h"
#include "engine/stats/moments.h"

/// What each error does by itself, from the samples of any Monte Carlo run: samples are put into bins of the uniform u
/// from which an error was drawn, and the means of the bins say how a response follows that error while all others
/// vary. P errors, R responses, B samples of a block.
namespace poesy {

/// The bins into which the samples of a block fall. With the same machines at all poses they are the same at each pose:
/// make them once.
class EffectBins {
 public:
  /// uniforms: [P x B], row-major, from which the errors are then made; sample b of error p goes to bin floor(32 u).
  /// Preconditions: errors = P > 0; 0 <= u < 1.
  EffectBins(std::span<const double> uniforms, std::size_t errors);

  std::size_t errors() const { return filled_.size() / kEffectBins; }  ///< P.
  std::size_t samples() const { return bins_.size() / errors(); }      ///< B.
  std::span<const std::uint8_t> bins() const { return bins_; }         ///< [P x B], each below kEffectBins.
  std::span<const std::uint32_t> filled() const { return filled_; }    ///< [P x bins] samples in each bin.

 private:
  std::vector<std::uint8_t> bins_;
  std::vector<std::uint32_t> filled_;
};

/// Four responses of a sample, or their sums: of y - shift and of its square, in turn. A row fills a line of the cache,
/// because one that lies in two lines takes twice the time.
struct alignas(64) EffectRow : std::array<double, 8> {};

/// Sums over the samples of each bin, for each response and error, for first-order indices and main-effect curves.
/// Memory: 512 bytes for each response and error, where the number of responses is rounded up to a multiple of four,
/// and 256 for each error, whatever the number of samples.
class MainEffectSums {
 public:
  MainEffectSums(std::size_t errors, std::size_t responses);  ///< P > 0 and R > 0; without samples.

  /// Adds the samples of a block. responses: [R x B], row-major as OutcomeBlock has them. counts: [B] 1 where the
  /// sample counts, 0 where it does not; its responses are then not looked at. Precondition: those that count are
  /// finite. Takes about 0.3 ns for each response, error and sample (four responses; D58).
  void add(const EffectBins& bins, std::span<const double> responses, std::span<const std::uint8_t> counts);
  /// Adds what the other one added. Merging in the same order gives the same bits. Precondition: the same P and R.
  void merge(const MainEffectSums& other);

  std::uint64_t samples() const { return moments_.front().count(); }  ///< That count.

  /// How much of the variance of a response one error makes alone. spread: of that error, or none (first_order.h).
  BinnedVariance variance(std::size_t response, std::size_t error, const BinSpread& spread) const;

  /// The main effect as a curve: E[y | u in bin] with Student's interval. Each interval by itself holds its mean at
  /// this level, all together do so less often. With eight samples in a bin (256 in all) intervals of 95 % hold 94 to
  /// 95 % of the means of linear, 93 to 94 % of folded and 84 to 91 % of lognormal responses, with 32 in a bin 95, 94
  /// and 89 to 93 %. NaN without samples; NaN at both ends below two. Precondition: 0 < conf_level < 1.
  std::array<Estimate, kEffectBins> curve(std::size_t response, std::size_t error, double conf_level) const;

  void state(Archive& archive);  ///< Every bit of the sums.

 private:
  void add_counts(const EffectBins& bins, std::span<const std::uint8_t> counts);
  void add_moments(std::span<const double> responses, std::span<const std::uint8_t> counts);
  std::array<BinSums, kEffectBins> bins_of(std::size_t response, std::size_t error) const;
  /// Where the sums of a response for an error begin, and the place of its own ones in a row.
  std::size_t first_row(std::size_t response, std::size_t error) const;
  static std::size_t place(std::size_t response);
  void check() const;  ///< Throws BytesError for sums that no samples give.

  std::size_t errors_;
  std::vector<std::uint64_t> counts_;  ///< [P x bins] samples
  std::vector<Moments> moments_;       ///< [R] of all samples, whatever their bins
  /// [R] mean of the first block of samples: near enough to the mean of all that plain sums of the differences do not
  /// cancel, and plain sums are what is added fastest.
  std::vector<double> shift_;
  std::vector<EffectRow> sums_;  ///< [R / 4 x P x bins]
};

}  // namespace poesy
