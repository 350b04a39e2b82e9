#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/stats/first_order.h"
#include "engine/stats/moments.h"

/// The effect of each error alone, from the samples of any Monte Carlo run. Samples are divided into bins of the
/// uniform u from which an error was drawn; the means of the bins show the response as a function of that error while
/// all others vary. P errors, R responses, B samples of a block.
namespace poesy {

/// The bins of the samples of a block. With the same machines at all poses they are the same at each pose, so make them
/// once.
class EffectBins {
 public:
  /// uniforms: [P x B], row-major, from which the errors are made; sample b of error p belongs to bin floor(32 u).
  /// Preconditions: errors = P > 0; 0 <= u < 1.
  EffectBins(std::span<const double> uniforms, std::size_t errors);

  std::size_t errors() const { return filled_.size() / kEffectBins; }  ///< The number of errors, P.
  std::size_t samples() const { return bins_.size() / errors(); }      ///< The number of samples, B.
  std::span<const std::uint8_t> bins() const { return bins_; }         ///< [P x B], each below kEffectBins.
  std::span<const std::uint32_t> filled() const { return filled_; }    ///< [P x bins] samples in each bin.

 private:
  std::vector<std::uint8_t> bins_;
  std::vector<std::uint32_t> filled_;
};

/// Four responses of a sample, or their sums: y - shift and its square, alternating. A row fills a line of the cache;
/// one that is in two lines takes twice the time.
struct alignas(64) EffectRow : std::array<double, 8> {};

/// Sums over the samples of each bin, for each response and error. First-order indices and main-effect curves are
/// computed from them. Memory: 512 bytes for each response (rounded up to a multiple of four) and error, and 256 for
/// each error, whatever the number of samples.
class MainEffectSums {
 public:
  MainEffectSums(std::size_t errors, std::size_t responses);  ///< Empty sums. Precondition: P > 0 and R > 0.

  /// Adds the samples of a block. responses: [R x B], row-major as in OutcomeBlock; they must be finite for samples
  /// that count. counts: [B] 1 if the sample counts; 0 if not, and its responses are ignored. Takes about 0.3 ns for
  /// each response, error and sample (four responses; D58).
  void add(const EffectBins& bins, std::span<const double> responses, std::span<const std::uint8_t> counts);
  /// Adds the sums of later samples. Merging in the same order gives the same bits. Precondition: the same P and R.
  void merge(const MainEffectSums& other);

  std::uint64_t samples() const { return moments_.front().count(); }  ///< The number of samples that count.

  /// The variance of a response and its part by one error. spread: of that error, or empty (first_order.h).
  BinnedVariance variance(std::size_t response, std::size_t error, const BinSpread& spread) const;

  /// The main effect as a curve: E[y | u in bin] with Student's interval. Each interval alone contains its mean at this
  /// level; all together do so less often. With eight samples in a bin (256 in all), 95 % intervals contain 94 to 95 %
  /// of the means of linear responses, 93 to 94 % of folded and 84 to 91 % of lognormal ones; with 32 in a bin 95, 94
  /// and 89 to 93 %. NaN without samples; NaN at both ends with one sample. Precondition: 0 < conf_level < 1.
  std::array<Estimate, kEffectBins> curve(std::size_t response, std::size_t error, double conf_level) const;

  void state(Archive& archive);  ///< Reads or writes every bit.

 private:
  void add_counts(const EffectBins& bins, std::span<const std::uint8_t> counts);
  void add_moments(std::span<const double> responses, std::span<const std::uint8_t> counts);
  std::array<BinSums, kEffectBins> bins_of(std::size_t response, std::size_t error) const;
  /// The first row of the sums of a response for an error, and the position of the response in a row.
  std::size_t first_row(std::size_t response, std::size_t error) const;
  static std::size_t place(std::size_t response);
  void check() const;  ///< Throws BytesError for sums that no samples can have.

  std::size_t errors_;
  std::vector<std::uint64_t> counts_;  ///< [P x bins] samples
  std::vector<Moments> moments_;       ///< [R] all samples, whatever their bins
  /// [R] The mean of the first block of samples. It is near enough to the mean of all samples that plain sums of the
  /// differences, which are the fastest, do not cancel.
  std::vector<double> shift_;
  std::vector<EffectRow> sums_;  ///< [R / 4 x P x bins]
};

}  // namespace poesy
