#include "engine/stats/quantile_sketch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"
#include "engine/stats/buckets.h"

namespace poesy {
namespace {

/// The pages (blocks of kPageBuckets buckets) of a scale that contain at least one number.
class MarkedPages {
 public:
  /// Finds the pages on the finest scale that fits.
  MarkedPages(std::span<const double> values, const Extremes& extremes) : scale_(finest_fitting(extremes)) {
    for (const std::size_t s : {0U, 1U}) {
      const PageRange range = pages_spanned(extremes, scale_, s == 1);
      sides_[s] = {range.first, std::vector<std::uint8_t>(range.count)};
    }
    std::vector<std::uint64_t> keys(values.size());
    scale_.keys(values, keys);
    for (const std::uint64_t key : keys) {
      const std::uint64_t bucket = key & ~BucketScale::kSign;
      if (bucket < BucketScale::kFirstNormal) continue;
      Side& side = sides_[key >> 63U];
      side.marks[bucket / kPageBuckets - side.first] = 1;
    }
  }

  const BucketScale& scale() const { return scale_; }
  std::size_t count() const {
    std::ptrdiff_t marked = 0;
    for (const Side& side : sides_) marked += std::ranges::count(side.marks, 1);
    return static_cast<std::size_t>(marked);
  }

  void coarsen() {
    for (Side& side : sides_) {
      if (side.marks.empty()) continue;
      const std::uint64_t first = scale_.page_of_coarser(side.first);
      const std::uint64_t last = scale_.page_of_coarser(side.first + side.marks.size() - 1);
      std::vector<std::uint8_t> marks(last - first + 1);
      for (std::size_t k = 0; k < side.marks.size(); ++k) {
        marks[scale_.page_of_coarser(side.first + k) - first] |= side.marks[k];
      }
      side = {first, std::move(marks)};
    }
    scale_ = scale_.coarser();
  }

 private:
  struct Side {
    std::uint64_t first = 0;  ///< index of the first page
    std::vector<std::uint8_t> marks{};
  };

  BucketScale scale_;
  std::array<Side, 2> sides_;  ///< pages of values above and below zero
};

/// The finest scale that a sketch may use for these numbers.
BucketScale scale_for(std::span<const double> values, const Extremes& extremes) {
  MarkedPages pages(values, extremes);
  while (pages.count() > QuantileSketch::kMostPages && !pages.scale().is_coarsest()) pages.coarsen();
  return pages.scale();
}

/// The extremes of the magnitudes of numbers with these extremes. zeros: whether some numbers are zero.
Extremes of_magnitudes(const Extremes& extremes, bool zeros) {
  Extremes folded{.count = extremes.count};
  folded.max = std::max(-extremes.min, extremes.max);
  folded.least_above = std::min(extremes.least_above, extremes.least_below);
  folded.min = zeros ? 0.0 : folded.least_above;
  return folded;
}

}  // namespace

std::uint64_t quantile_rank(double q, std::uint64_t n) {
  const auto whole = static_cast<double>(n);
  double k = std::clamp(std::ceil(q * whole), 1.0, whole);
  // Corrects the rank k if rounding moved the product of q and n past a whole number.
  if (k > 1.0 && (k - 1.0) / whole >= q) k -= 1.0;
  if (k < whole && k / whole < q) k += 1.0;
  return static_cast<std::uint64_t>(k);
}

void QuantileSketch::add(std::span<const double> values, const Extremes& extremes) {
  if (values.empty()) return;
  const bool counted = !keeps_all();
  extremes_.merge(extremes);
  if (counted) {
    fit();
    counts_.add(values);
    save_pages();
    return;
  }
  values_.insert(values_.end(), values.begin(), values.end());
  if (keeps_all()) return;
  counts_ = BucketCounts(scale_for(values_, extremes_));
  counts_.reach(extremes_);
  counts_.add(values_);
  values_ = {};
}

void QuantileSketch::fit() {
  while (!fits(counts_.scale(), extremes_) && !counts_.scale().is_coarsest()) counts_.coarsen();
  counts_.reach(extremes_);
}

void QuantileSketch::save_pages() {
  while (counts_.pages() > kMostPages && !counts_.scale().is_coarsest()) counts_.coarsen();
}

void QuantileSketch::merge(const QuantileSketch& other) {
  if (other.keeps_all()) {
    add(other.values_, other.extremes_);
    return;
  }
  if (keeps_all()) {
    QuantileSketch merged = other;
    merged.add(values_, extremes_);
    *this = std::move(merged);
    return;
  }
  extremes_.merge(other.extremes_);
  while (counts_.scale().octave() < other.counts_.scale().octave()) counts_.coarsen();
  fit();
  if (counts_.scale() == other.counts_.scale()) {
    counts_.merge(other.counts_);
  } else {
    BucketCounts coarse = other.counts_;
    while (coarse.scale() != counts_.scale()) coarse.coarsen();
    counts_.merge(coarse);
  }
  save_pages();
}

double QuantileSketch::quantile(double q) const {
  POESY_EXPECTS(q >= 0.0 && q <= 1.0);
  const std::uint64_t n = count();
  return n == 0 ? std::numeric_limits<double>::quiet_NaN() : order_statistic(quantile_rank(q, n));
}

double QuantileSketch::order_statistic(std::uint64_t k) const {
  POESY_EXPECTS(k >= 1 && k <= count());
  return poesy::order_statistic(buckets(), k);
}

std::vector<double> QuantileSketch::sorted() const {
  std::vector<double> values = values_;
  if (!std::ranges::is_sorted(values)) std::ranges::sort(values);
  return values;
}

std::vector<Bucket> QuantileSketch::buckets() const {
  std::vector<Bucket> filled;
  const auto add = [&](double lower, double upper, std::uint64_t values) {
    const std::uint64_t before = filled.empty() ? 0 : filled.back().up_to;
    filled.push_back({std::clamp(lower, extremes_.min, extremes_.max), std::clamp(upper, extremes_.min, extremes_.max),
                      values, before + values});
  };
  if (keeps_all()) {
    for (const double value : sorted()) {
      if (filled.empty() || filled.back().upper != value) {
        add(value + 0.0, value + 0.0, 1);  // turns -0.0 into 0.0
      } else {
        ++filled.back().count;
        ++filled.back().up_to;
      }
    }
    return filled;
  }
  const BucketScale& scale = counts_.scale();
  for (const auto& [bucket, count] : counts_.below()) add(-scale.edge(bucket + 1), -scale.edge(bucket), count);
  if (counts_.zeros() != 0) add(0.0, 0.0, counts_.zeros());
  for (const auto& [bucket, count] : counts_.above()) add(scale.edge(bucket), scale.edge(bucket + 1), count);
  return filled;
}

QuantileSketch QuantileSketch::magnitudes() const {
  if (count() == 0 || extremes_.min >= 0.0) return *this;
  QuantileSketch folded;
  if (keeps_all()) {
    std::vector<double> values = values_;
    for (double& value : values) value = std::abs(value);
    folded.add(values);
    return folded;
  }
  folded.extremes_ = of_magnitudes(extremes_, counts_.zeros() != 0);
  BucketCounts counts = counts_;
  while (!fits(counts.scale(), folded.extremes_) && !counts.scale().is_coarsest()) counts.coarsen();
  folded.counts_ = counts.folded(folded.extremes_);
  return folded;
}

void QuantileSketch::state(Archive& archive) {
  std::uint64_t values = count();
  archive.number(values);
  if (values <= kMostExact) {
    std::vector<double> kept = archive.reads() ? std::vector<double>() : sorted();
    archive.list(kept, static_cast<std::size_t>(values));
    const bool finite = std::ranges::all_of(kept, [](double value) { return std::isfinite(value); });
    archive.expect(finite, "a number is not finite");
    if (archive.reads()) add(kept);
    return;
  }
  extremes_.count = values;
  archive.object(extremes_);
  archive.packed(counts_, extremes_);
}

}  // namespace poesy
