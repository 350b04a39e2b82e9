#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/stats/first_order.h"
#include "engine/stats/moments.h"

/// The main effect of each error, from the samples of any Monte Carlo run. Samples are divided into bins of the uniform
/// number u from which an error was drawn. The means of the bins show the response as a function of that error while
/// all others vary.
namespace poesy {

/// The bin of each sample of a block, for each error. If the same machines are used at all poses, the bins are the same
/// at each pose, so make them once.
class EffectBins {
 public:
  /// uniforms: [errors x samples], row-major, the uniform numbers u from which the errors are drawn. Sample b belongs
  /// to bin floor(32 u) of error p. Preconditions: errors > 0; 0 <= u < 1.
  EffectBins(std::span<const double> uniforms, std::size_t errors);

  std::size_t errors() const { return filled_.size() / kEffectBins; }  ///< The number of errors.
  std::size_t samples() const { return bins_.size() / errors(); }      ///< The number of samples.
  /// [errors x samples] The number of the bin of each sample, below kEffectBins.
  std::span<const std::uint8_t> bins() const { return bins_; }
  std::span<const std::uint32_t> filled() const { return filled_; }  ///< [errors x bins] number of samples in each bin.

 private:
  std::vector<std::uint8_t> bins_;
  std::vector<std::uint32_t> filled_;
};

/// Numbers for four responses y of a sample: y - shift and its square, alternating; or the sums of these numbers over
/// samples. A row is aligned with a cache line, because a row in two lines takes twice the time.
struct alignas(64) EffectRow : std::array<double, 8> {};

/// Sums over the samples of each bin, for each response and error. First-order indices and main-effect curves are
/// computed from them. Memory, for any number of samples: 512 bytes for each response (their number rounded up to a
/// multiple of four) and error, and 256 bytes for each error.
class MainEffectSums {
 public:
  MainEffectSums(std::size_t errors, std::size_t responses);  ///< Empty sums. Precondition: both numbers are positive.

  /// Adds the samples of a block. responses: [responses x samples], row-major as in OutcomeBlock; they must be finite
  /// for samples with counts = 1. counts: [samples] 1 if the sample is added to the sums, 0 if it is ignored. Takes
  /// about 0.3 ns for each response, error and sample (measured with four responses; decision D58).
  void add(const EffectBins& bins, std::span<const double> responses, std::span<const std::uint8_t> counts);
  /// Adds the sums of later samples. Merging in the same order gives the same bits. Precondition: the same errors and
  /// responses.
  void merge(const MainEffectSums& other);

  std::uint64_t samples() const { return moments_.front().count(); }  ///< The number of samples in the sums.

  /// The variance of a response, and the part of this variance that one error causes. spread: distribution of this
  /// error within bins, or all zero (first_order.h).
  BinnedVariance variance(std::size_t response, std::size_t error, const BinSpread& spread) const;

  /// The main effect as a curve: E[y | u in bin] with Student's interval. The level holds for each interval alone, not
  /// for all 32 together. Measured coverage of 95 % intervals with eight samples in a bin (256 in all): 94 to 95 % for
  /// linear, 93 to 94 % for folded, 84 to 91 % for lognormal responses. With 32 samples in a bin: 95 %, 94 %, and 89 to
  /// 93 %. The estimate of a bin without samples is NaN. With one sample, both ends of the interval are NaN.
  /// Precondition: 0 < conf_level < 1.
  std::array<Estimate, kEffectBins> curve(std::size_t response, std::size_t error, double conf_level) const;

  void state(Archive& archive);  ///< Reads or writes all sums, bit for bit.

 private:
  void add_counts(const EffectBins& bins, std::span<const std::uint8_t> counts);
  void add_moments(std::span<const double> responses, std::span<const std::uint8_t> counts);
  std::array<BinSums, kEffectBins> bins_of(std::size_t response, std::size_t error) const;
  /// The index in sums_ of the first row of sums for this response and error.
  std::size_t first_row(std::size_t response, std::size_t error) const;
  static std::size_t place(std::size_t response);
  void check() const;  ///< Throws BytesError for sums that no samples can have.

  std::size_t errors_;
  std::vector<std::uint64_t> counts_;  ///< [errors x bins] number of samples
  std::vector<Moments> moments_;       ///< [responses] moments of all samples
  /// [responses] The mean of the first block of samples. It is so near to the mean of all samples that no digits cancel
  /// in plain sums of the differences. Plain sums are the fastest.
  std::vector<double> shift_;
  std::vector<EffectRow> sums_;  ///< [responses / 4 x errors x bins] sums of four responses each
};

}  // namespace poesy
