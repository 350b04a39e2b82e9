#include "engine/stats/main_effects.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"

namespace poesy {
namespace {

constexpr std::size_t kTogether = EffectRow{}.size() / 2;  ///< number of responses in a row

/// The number of samples that are added together. Their rows, and the sums of a few errors, fit the first-level cache.
constexpr std::size_t kPiece = 256;

/// For each error, adds the row of each sample (numbers of four responses) to the sums of the bin in which the sample's
/// value of this error lies. bins: number of the bin for each error and sample; those of the next error begin `stride`
/// entries later. sums: [errors x bins]. Four errors are added at a time: successive additions then go to different
/// rows of sums, so none has to wait until the previous one is stored.
POESY_EACH_INSTRUCTION_SET void add_rows(std::span<const EffectRow> rows, const std::uint8_t* bins, std::size_t stride,
                                         std::size_t errors, EffectRow* sums) {
  const auto add = [&](const EffectRow& row, std::size_t error, std::size_t sample) {
    EffectRow& sum = sums[error * kEffectBins + bins[error * stride + sample]];
    for (std::size_t j = 0; j < row.size(); ++j) sum[j] += row[j];
  };
  constexpr std::size_t kErrors = 4;
  const std::size_t whole = errors / kErrors * kErrors;
  for (std::size_t p = 0; p < whole; p += kErrors) {
    for (std::size_t s = 0; s < rows.size(); ++s) {
      const EffectRow row = rows[s];
      for (std::size_t k = 0; k < kErrors; ++k) add(row, p + k, s);
    }
  }
  for (std::size_t p = whole; p < errors; ++p) {
    for (std::size_t s = 0; s < rows.size(); ++s) {
      const EffectRow row = rows[s];
      add(row, p, s);
    }
  }
}

/// The values of the samples with counts = 1.
std::vector<double> only_counting(std::span<const double> values, std::span<const std::uint8_t> counts) {
  std::vector<double> kept;
  kept.reserve(values.size());
  for (std::size_t b = 0; b < values.size(); ++b) {
    if (counts[b] != 0) kept.push_back(values[b]);
  }
  return kept;
}

/// Returns true if samples in a bin can give these sums. square: mean square of (response - shift) over all samples.
/// After blocks with different shifts were merged, the rounding errors of the sums are in proportion to this mean
/// square.
bool possible(const BinSums& bin, double square) {
  constexpr double kRounding = 1e-9;
  if (bin.count == 0.0) return bin.sum == 0.0 && bin.square == 0.0;
  return std::isfinite(bin.square) && bin.square >= -kRounding * bin.count * square &&
         bin.sum * bin.sum <= bin.count * (bin.square + kRounding * (bin.square + bin.count * square)) +
                                  std::numeric_limits<double>::min();
}

}  // namespace

EffectBins::EffectBins(std::span<const double> uniforms, std::size_t errors)
    : bins_(uniforms.size()), filled_(errors * kEffectBins) {
  POESY_EXPECTS(errors > 0 && uniforms.size() % errors == 0);
  for (std::size_t k = 0; k < uniforms.size(); ++k) {
    bins_[k] = static_cast<std::uint8_t>(static_cast<int>(uniforms[k] * static_cast<double>(kEffectBins)));
    POESY_EXPECTS(bins_[k] < kEffectBins);
  }
  for (std::size_t p = 0; p < errors; ++p) {
    for (const std::uint8_t bin : bins().subspan(p * samples(), samples())) ++filled_[p * kEffectBins + bin];
  }
}

MainEffectSums::MainEffectSums(std::size_t errors, std::size_t responses)
    : errors_(errors),
      counts_(errors * kEffectBins),
      moments_(responses),
      shift_(responses),
      sums_((responses + kTogether - 1) / kTogether * errors * kEffectBins) {
  POESY_EXPECTS(errors > 0 && responses > 0);
}

void MainEffectSums::add(const EffectBins& bins, std::span<const double> responses,
                         std::span<const std::uint8_t> counts) {
  const std::size_t block = bins.samples();
  POESY_EXPECTS(bins.errors() == errors_ && counts.size() == block && responses.size() == moments_.size() * block);
  add_counts(bins, counts);
  add_moments(responses, counts);
  std::array<EffectRow, kPiece> rows;
  for (std::size_t first = 0; first < block; first += kPiece) {
    const std::span piece = std::span(rows).first(std::min(kPiece, block - first));
    for (std::size_t r = 0; r < moments_.size(); r += kTogether) {
      std::ranges::fill(piece, EffectRow{});
      for (std::size_t k = r; k < std::min(r + kTogether, moments_.size()); ++k) {
        const double* values = &responses[k * block + first];
        for (std::size_t s = 0; s < piece.size(); ++s) {
          const double off = counts[first + s] != 0 ? values[s] - shift_[k] : 0.0;
          piece[s][place(k)] = off;
          piece[s][place(k) + 1] = off * off;
        }
      }
      add_rows(piece, &bins.bins()[first], block, errors_, &sums_[first_row(r, 0)]);
    }
  }
}

void MainEffectSums::add_counts(const EffectBins& bins, std::span<const std::uint8_t> counts) {
  for (std::size_t k = 0; k < counts_.size(); ++k) counts_[k] += bins.filled()[k];
  for (std::size_t b = 0; b < counts.size(); ++b) {
    if (counts[b] != 0) continue;
    for (std::size_t p = 0; p < errors_; ++p) --counts_[p * kEffectBins + bins.bins()[p * counts.size() + b]];
  }
}

void MainEffectSums::add_moments(std::span<const double> responses, std::span<const std::uint8_t> counts) {
  const bool all_count = std::ranges::find(counts, 0) == counts.end();
  for (std::size_t r = 0; r < moments_.size(); ++r) {
    const std::span<const double> values = responses.subspan(r * counts.size(), counts.size());
    const Moments block = Moments::of(all_count ? values : only_counting(values, counts));
    if (moments_[r].count() == 0) shift_[r] = block.mean();
    moments_[r].merge(block);
  }
}

void MainEffectSums::merge(const MainEffectSums& other) {
  POESY_EXPECTS(other.errors_ == errors_ && other.moments_.size() == moments_.size());
  if (other.samples() == 0) return;
  if (samples() == 0) {
    *this = other;
    return;
  }
  for (std::size_t r = 0; r < moments_.size(); ++r) {
    moments_[r].merge(other.moments_[r]);
    const double shift = other.shift_[r] - shift_[r];
    const std::size_t first = first_row(r, 0);
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      const auto count = static_cast<double>(other.counts_[k]);
      const double sum = other.sums_[first + k][place(r)];
      sums_[first + k][place(r)] += sum + count * shift;
      sums_[first + k][place(r) + 1] += other.sums_[first + k][place(r) + 1] + shift * (2.0 * sum + count * shift);
    }
  }
  for (std::size_t k = 0; k < counts_.size(); ++k) counts_[k] += other.counts_[k];
}

std::size_t MainEffectSums::first_row(std::size_t response, std::size_t error) const {
  return (response / kTogether * errors_ + error) * kEffectBins;
}

std::size_t MainEffectSums::place(std::size_t response) { return 2 * (response % kTogether); }

std::array<BinSums, kEffectBins> MainEffectSums::bins_of(std::size_t response, std::size_t error) const {
  std::array<BinSums, kEffectBins> bins;
  for (std::size_t b = 0; b < kEffectBins; ++b) {
    const EffectRow& row = sums_[first_row(response, error) + b];
    bins[b] = {static_cast<double>(counts_[error * kEffectBins + b]), row[place(response)], row[place(response) + 1]};
  }
  return bins;
}

BinnedVariance MainEffectSums::variance(std::size_t response, std::size_t error, const BinSpread& spread) const {
  return binned_variance(bins_of(response, error), moments_[response], spread);
}

std::array<Estimate, kEffectBins> MainEffectSums::curve(std::size_t response, std::size_t error,
                                                        double conf_level) const {
  const std::array<BinSums, kEffectBins> bins = bins_of(response, error);
  std::array<Estimate, kEffectBins> curve;
  for (std::size_t b = 0; b < kEffectBins; ++b) {
    const auto [count, sum, squares] = bins[b];
    const std::uint64_t samples = counts_[error * kEffectBins + b];
    const double mean = shift_[response] + sum / count;
    const double deviation = std::sqrt(std::max(0.0, squares - sum * sum / count) / (count - 1.0));
    curve[b] = stratified_mean({{&samples, 1}, {&mean, 1}, {&deviation, 1}}, conf_level);
  }
  return curve;
}

void MainEffectSums::state(Archive& archive) {
  for (std::uint64_t& count : counts_) archive.number(count);
  for (std::size_t r = 0; r < moments_.size(); ++r) {
    archive.object(moments_[r]);
    archive.real(shift_[r]);
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      archive.reals(std::span(sums_[first_row(r, 0) + k]).subspan(place(r), 2));
    }
  }
  if (archive.reads()) check();
}

void MainEffectSums::check() const {
  for (std::size_t r = 0; r < moments_.size(); ++r) {
    if (moments_[r].count() != samples() || !std::isfinite(shift_[r])) {
      throw BytesError("has responses of different samples");
    }
    const double off = moments_[r].mean() - shift_[r];
    const double deviation = moments_[r].count() < 2 ? 0.0 : moments_[r].standard_deviation();
    const double square = off * off + deviation * deviation;
    for (std::size_t p = 0; p < errors_; ++p) {
      double count = 0.0;
      for (const BinSums& bin : bins_of(r, p)) {
        if (!possible(bin, square)) throw BytesError("has sums that no samples in a bin give");
        count += bin.count;
      }
      if (count != static_cast<double>(samples())) throw BytesError("has errors of different samples");
    }
  }
}

}  // namespace poesy
