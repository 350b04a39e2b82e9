#include "engine/stats/quantile_sketch.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/contract.h"

namespace poesy {
namespace {

static_assert(std::numeric_limits<double>::is_iec559);

/// Of 52 fraction bits these do not matter: a bucket spans 2^-8 of its power of two, its middle is off by half of that.
constexpr int kIgnoredBits = 44;
/// The bucket of the smallest normal number; below it the exponent's bits are zero.
constexpr std::size_t kFirstNormal = std::size_t{1} << (52 - kIgnoredBits);
/// The bucket of the largest finite number.
constexpr std::size_t kLast = (std::size_t{0x7ff} << (52 - kIgnoredBits)) - 1;

std::size_t bucket(double value) {
  return static_cast<std::size_t>(std::bit_cast<std::uint64_t>(std::abs(value)) >> kIgnoredBits);
}

double middle(std::size_t bucket) {
  const auto lower = static_cast<std::uint64_t>(bucket) << kIgnoredBits;
  return std::bit_cast<double>(lower | (std::uint64_t{1} << (kIgnoredBits - 1)));
}

/// The smallest k >= 1 with k / n >= q. q n may be rounded past a whole number.
std::uint64_t rank(double q, std::uint64_t n) {
  const auto whole = static_cast<double>(n);
  double k = std::clamp(std::ceil(q * whole), 1.0, whole);
  if (k > 1.0 && (k - 1.0) / whole >= q) k -= 1.0;
  if (k < whole && k / whole < q) k += 1.0;
  return static_cast<std::uint64_t>(k);
}

/// Buckets from the smallest to the largest that is used; none to begin with.
struct Reach {
  std::size_t lowest = std::numeric_limits<std::size_t>::max();
  std::size_t highest = 0;

  void include(std::size_t bucket) {
    lowest = std::min(lowest, bucket);
    highest = std::max(highest, bucket);
  }
};

}  // namespace

void QuantileSketch::Store::reach(std::size_t lowest, std::size_t highest) {
  if (lowest > highest) return;
  if (counts.empty()) {
    first = lowest;
    counts.resize(highest - lowest + 1);
    return;
  }
  if (lowest < first) {
    counts.insert(counts.begin(), first - lowest, 0);
    first = lowest;
  }
  if (highest >= first + counts.size()) counts.resize(highest - first + 1);
}

void QuantileSketch::Store::merge(const Store& other) {
  if (other.counts.empty()) return;
  reach(other.first, other.first + other.counts.size() - 1);
  const std::size_t offset = other.first - first;
  for (std::size_t k = 0; k < other.counts.size(); ++k) counts[offset + k] += other.counts[k];
  total += other.total;
}

double QuantileSketch::Store::magnitude(std::uint64_t k) const {
  POESY_EXPECTS(k >= 1 && k <= total);
  std::size_t at = 0;
  for (std::uint64_t below = counts[0]; below < k; below += counts[at]) ++at;
  return middle(first + at);
}

void QuantileSketch::Store::write(ByteWriter& to) const {
  to.number(counts.size());
  if (counts.empty()) return;
  to.number(first);
  for (const std::uint64_t count : counts) to.number(count);
}

QuantileSketch::Store QuantileSketch::Store::read(ByteReader& from) {
  Store store;
  store.counts.resize(from.count(1));
  if (store.counts.empty()) return store;
  store.first = static_cast<std::size_t>(from.number_up_to(kLast));
  if (store.first < kFirstNormal || store.counts.size() > kLast - store.first + 1) {
    throw BytesError("a histogram has buckets for numbers that do not exist");
  }
  for (std::uint64_t& count : store.counts) {
    count = from.number_up_to(std::numeric_limits<std::uint64_t>::max() - store.total);
    store.total += count;
  }
  return store;
}

void QuantileSketch::add(std::span<const double> values) {
  Reach below_zero;
  Reach above_zero;
  for (const double value : values) {
    POESY_EXPECTS(std::isfinite(value));
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    const std::size_t at = bucket(value);
    if (at >= kFirstNormal) (value < 0.0 ? below_zero : above_zero).include(at);
  }
  negative_.reach(below_zero.lowest, below_zero.highest);
  positive_.reach(above_zero.lowest, above_zero.highest);
  for (const double value : values) {
    const std::size_t at = bucket(value);
    if (at < kFirstNormal) {
      ++zeros_;
      continue;
    }
    Store& store = value < 0.0 ? negative_ : positive_;
    ++store.counts[at - store.first];
    ++store.total;
  }
}

void QuantileSketch::merge(const QuantileSketch& other) {
  negative_.merge(other.negative_);
  positive_.merge(other.positive_);
  zeros_ += other.zeros_;
  min_ = std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
}

std::uint64_t QuantileSketch::count() const { return negative_.total + zeros_ + positive_.total; }

double QuantileSketch::quantile(double q) const {
  POESY_EXPECTS(q >= 0.0 && q <= 1.0);
  const std::uint64_t n = count();
  if (n == 0) return std::numeric_limits<double>::quiet_NaN();
  const std::uint64_t k = rank(q, n);
  if (k == 1) return min_;
  if (k == n) return max_;
  double value = 0.0;
  if (k <= negative_.total) {
    value = -negative_.magnitude(negative_.total - k + 1);
  } else if (k > negative_.total + zeros_) {
    value = positive_.magnitude(k - negative_.total - zeros_);
  }
  return std::clamp(value, min_, max_);
}

void QuantileSketch::write(ByteWriter& to) const {
  negative_.write(to);
  positive_.write(to);
  to.number(zeros_);
  to.real(min_);
  to.real(max_);
}

QuantileSketch QuantileSketch::read(ByteReader& from) {
  QuantileSketch sketch;
  sketch.negative_ = Store::read(from);
  sketch.positive_ = Store::read(from);
  constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();
  if (sketch.negative_.total > kMost - sketch.positive_.total) throw BytesError("a histogram counts too much");
  sketch.zeros_ = from.number_up_to(kMost - sketch.negative_.total - sketch.positive_.total);
  sketch.min_ = from.real();
  sketch.max_ = from.real();
  const bool has_range = std::isfinite(sketch.min_) && std::isfinite(sketch.max_) && sketch.min_ <= sketch.max_;
  const QuantileSketch nothing;
  const bool has_none = sketch.min_ == nothing.min_ && sketch.max_ == nothing.max_;
  if (sketch.count() == 0 ? !has_none : !has_range) throw BytesError("a histogram has no range");
  return sketch;
}

}  // namespace poesy
