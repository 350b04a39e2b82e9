#include "engine/stats/bucket_scale.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"

namespace poesy {
namespace {

static_assert(std::numeric_limits<double>::is_iec559);

constexpr int kFractionBits = 52;
/// The number of leading bits of a double's fraction that determine the bucket: kCoarseBits below the octave of the
/// scale, kEvenBits in this octave.
constexpr int kCoarseBits = 7;
constexpr int kEvenBits = kCoarseBits + 1;
constexpr std::uint64_t kHidden = std::uint64_t{1} << kFractionBits;
constexpr std::uint64_t kInfinite = std::bit_cast<std::uint64_t>(std::numeric_limits<double>::infinity());

/// A whole number that has the order of the doubles: it increases with the value, and -0.0 is below 0.0.
[[gnu::always_inline]] inline std::int64_t ordinal(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits ^ ((bits >> 63) & std::numeric_limits<std::int64_t>::max());
}

/// The inverse of ordinal(), which is the same operation.
double with_ordinal(std::int64_t ordinal_number) {
  return std::bit_cast<double>(ordinal(std::bit_cast<double>(ordinal_number)));
}

/// Computes Extremes::of(). Precondition: there is at least one value.
POESY_EACH_INSTRUCTION_SET void find_extremes(std::span<const double> values, Extremes& found) {
  std::int64_t min = std::numeric_limits<std::int64_t>::max();
  std::int64_t max = std::numeric_limits<std::int64_t>::min();
  std::uint64_t above = kInfinite;
  std::uint64_t below = kInfinite;
  for (const double value : values) {
    min = std::min(min, ordinal(value));
    max = std::max(max, ordinal(value));
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const std::uint64_t magnitude = bits & ~BucketScale::kSign;
    const bool zero = magnitude < kHidden;
    const bool negative = bits != magnitude;
    above = std::min(above, zero || negative ? kInfinite : magnitude);
    below = std::min(below, zero || !negative ? kInfinite : magnitude);
  }
  found.count = values.size();
  found.min = with_ordinal(min);
  found.max = with_ordinal(max);
  found.least_above = std::bit_cast<double>(above);
  found.least_below = std::bit_cast<double>(below);
}

[[gnu::always_inline]] inline std::uint64_t key_of(double value, std::uint64_t octave) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const std::uint64_t exponent = (bits & ~BucketScale::kSign) >> kFractionBits;
  const std::uint64_t mantissa = (bits & (kHidden - 1)) | kHidden;
  const bool even = exponent >= octave;
  const std::uint64_t fraction_bits = even ? exponent - octave + kEvenBits : kCoarseBits;
  const std::uint64_t begin = even ? (octave << kCoarseBits) - (std::uint64_t{1} << kEvenBits)
                                   : (exponent << kCoarseBits) - (std::uint64_t{1} << kCoarseBits);
  return (begin + (mantissa >> (kFractionBits - fraction_bits))) | (bits & BucketScale::kSign);
}

POESY_EACH_INSTRUCTION_SET void fill_keys(std::span<const double> values, std::uint64_t octave,
                                          std::span<std::uint64_t> keys) {
  for (std::size_t k = 0; k < values.size(); ++k) keys[k] = key_of(values[k], octave);
}

/// The biased exponent of a double.
unsigned exponent_of(double magnitude) {
  return static_cast<unsigned>(std::bit_cast<std::uint64_t>(magnitude) >> kFractionBits);
}

/// The least octave with which keys() accepts the largest of these magnitudes. If this octave is above 1, the bucket of
/// the largest magnitude contains a single double.
unsigned least_octave(const Extremes& extremes) {
  constexpr unsigned kMostBelow = kFractionBits - kEvenBits;
  unsigned exponent = 0;
  if (extremes.has_above()) exponent = std::max(exponent, exponent_of(extremes.max));
  if (extremes.has_below()) exponent = std::max(exponent, exponent_of(-extremes.min));
  return exponent > kMostBelow ? exponent - kMostBelow : 1;
}

}  // namespace

Extremes Extremes::of(std::span<const double> values) {
  POESY_EXPECTS(std::ranges::all_of(values, [](double value) { return std::isfinite(value); }));
  Extremes found;
  if (!values.empty()) find_extremes(values, found);
  return found;
}

void Extremes::merge(const Extremes& other) {
  count += other.count;
  min = std::min(min, other.min);
  max = std::max(max, other.max);
  least_above = std::min(least_above, other.least_above);
  least_below = std::min(least_below, other.least_below);
}

void Extremes::state(Archive& archive) {
  archive.real(min, max, least_above, least_below);
  const bool finite = std::isfinite(min) && std::isfinite(max);
  archive.expect(finite && min <= max && count > 0, "numbers have no range");
  constexpr double kNormal = std::numeric_limits<double>::min();
  const auto possible = [&](double least, double most) {
    return most < kNormal ? least == std::numeric_limits<double>::infinity() : least >= kNormal && least <= most;
  };
  archive.expect(possible(least_above, max) && possible(least_below, -min), "numbers have a range without its ends");
}

void BucketScale::keys(std::span<const double> values, std::span<std::uint64_t> keys) const {
  fill_keys(values, octave_, keys);
}

std::uint64_t BucketScale::key(double value) const { return key_of(value, octave_); }

double BucketScale::edge(std::uint64_t bucket) const {
  if (bucket < first_even()) return std::bit_cast<double>(bucket << (kFractionBits - kCoarseBits));
  const std::uint64_t widths = bucket - first_even() + (std::uint64_t{1} << kEvenBits);
  constexpr int kBias = 1023;
  return std::ldexp(static_cast<double>(widths), static_cast<int>(octave_) - kBias - kEvenBits);
}

std::uint64_t BucketScale::page_of_coarser(std::uint64_t page) const {
  const std::uint64_t even = first_even() / kPageBuckets;
  return page < even ? page : even + (page - even) / 2;
}

PageRange pages_spanned(const Extremes& extremes, const BucketScale& scale, bool below) {
  if (below ? !extremes.has_below() : !extremes.has_above()) return {};
  const double most = below ? -extremes.min : extremes.max;
  const std::uint64_t first = scale.key(below ? extremes.least_below : extremes.least_above) / kPageBuckets;
  return {first, static_cast<std::size_t>(scale.key(most) / kPageBuckets - first + 1)};
}

bool fits(const BucketScale& scale, const Extremes& extremes) {
  if (scale.octave() < least_octave(extremes)) return false;
  const std::size_t above = pages_spanned(extremes, scale, false).count;
  const std::size_t below = pages_spanned(extremes, scale, true).count;
  return above + below <= kMostPagesSpanned;
}

BucketScale finest_fitting(const Extremes& extremes) {
  unsigned octave = least_octave(extremes);
  unsigned fitting = BucketScale::kCoarsest;
  while (octave < fitting) {
    const unsigned middle = octave + (fitting - octave) / 2;
    if (fits(BucketScale(middle), extremes)) {
      fitting = middle;
    } else {
      octave = middle + 1;
    }
  }
  return BucketScale(fitting);
}

}  // namespace poesy
