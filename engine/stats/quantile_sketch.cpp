#include "engine/stats/quantile_sketch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"

namespace poesy {
namespace {

static_assert(std::numeric_limits<double>::is_iec559);

/// Of 52 fraction bits these do not matter: a bucket spans 2^-8 of its power of two, its middle is off by half of that.
constexpr int kIgnoredBits = 44;
/// The bucket of the smallest normal number; below it the exponent's bits are zero.
constexpr std::uint32_t kFirstNormal = std::uint32_t{1} << (52 - kIgnoredBits);
/// The bucket of the largest finite number.
constexpr std::uint32_t kLast = (std::uint32_t{0x7ff} << (52 - kIgnoredBits)) - 1;

constexpr std::uint32_t kSign = std::uint32_t{1} << (63 - kIgnoredBits);

/// BucketedValues are stored as codes: 0 for what is taken for zero, else 1 + 2 (bucket - lowest) + sign.
constexpr std::uint32_t most_code(std::uint32_t span) { return 2 * span + 2; }
constexpr std::size_t code_bytes(std::uint32_t span) { return most_code(span) <= 0xffff ? 2 : 4; }

double middle(std::size_t bucket) {
  const auto lower = static_cast<std::uint64_t>(bucket) << kIgnoredBits;
  return std::bit_cast<double>(lower | (std::uint64_t{1} << (kIgnoredBits - 1)));
}

/// The smallest magnitude of a bucket, which is where the bucket before it ends.
double edge(std::size_t bucket) { return std::bit_cast<double>(static_cast<std::uint64_t>(bucket) << kIgnoredBits); }

/// A whole number that ascends with the value: -0.0 is below 0.0.
[[gnu::always_inline]] inline std::int64_t ordinal(double value) {
  const auto bits = std::bit_cast<std::int64_t>(value);
  return bits ^ ((bits >> 63) & std::numeric_limits<std::int64_t>::max());
}

/// Its own inverse.
double with_ordinal(std::int64_t ordinal_number) {
  return std::bit_cast<double>(ordinal(std::bit_cast<double>(ordinal_number)));
}

/// Sets all members but the length of `buckets`.
POESY_EACH_INSTRUCTION_SET void sort_into_buckets(std::span<const double> values, BucketedValues& sorted) {
  std::uint32_t* buckets = sorted.buckets.data();
  std::int64_t min = std::numeric_limits<std::int64_t>::max();
  std::int64_t max = std::numeric_limits<std::int64_t>::min();
  for (std::size_t k = 0; k < values.size(); ++k) {
    buckets[k] = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(values[k]) >> kIgnoredBits);
    min = std::min(min, ordinal(values[k]));
    max = std::max(max, ordinal(values[k]));
  }
  std::uint32_t lowest = kSign;
  std::uint32_t highest = 0;
  std::uint32_t negatives = 0;
  std::uint32_t zeros = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const std::uint32_t bucket = buckets[k] & ~kSign;
    const bool zero = bucket < kFirstNormal;
    lowest = std::min(lowest, zero ? kSign : bucket);
    highest = std::max(highest, bucket);
    negatives += zero ? 0 : (buckets[k] & kSign) / kSign;
    zeros += zero ? 1 : 0;
  }
  sorted.lowest = lowest;
  sorted.highest = highest;
  sorted.negatives = negatives;
  sorted.positives = static_cast<std::uint32_t>(values.size()) - negatives - zeros;
  sorted.min = with_ordinal(min);
  sorted.max = with_ordinal(max);
}

/// Codes of buckets.
POESY_EACH_INSTRUCTION_SET void encode(std::span<const std::uint32_t> buckets, std::uint32_t lowest,
                                       std::span<std::uint32_t> codes) {
  for (std::size_t k = 0; k < buckets.size(); ++k) {
    const std::uint32_t bucket = buckets[k] & ~kSign;
    const std::uint32_t code = 1 + 2 * (bucket - lowest) + (buckets[k] & kSign) / kSign;
    codes[k] = bucket < kFirstNormal ? 0 : code;
  }
}

/// Turns codes into buckets, and counts their signs.
POESY_EACH_INSTRUCTION_SET void decode(BucketedValues& values) {
  std::uint32_t negatives = 0;
  std::uint32_t zeros = 0;
  for (std::uint32_t& bucket : values.buckets) {
    const std::uint32_t nonzero = bucket != 0 ? 1 : 0;
    const std::uint32_t offset = bucket - nonzero;
    const std::uint32_t sign = offset & 1U;
    bucket = nonzero * ((values.lowest + offset / 2) | (sign * kSign));
    negatives += sign;
    zeros += 1 - nonzero;
  }
  values.negatives = negatives;
  values.positives = static_cast<std::uint32_t>(values.buckets.size()) - negatives - zeros;
}

/// Their lowest bytes, then their second bytes, and so on: loops over whole vectors on any machine.
POESY_EACH_INSTRUCTION_SET void to_planes(std::span<const std::uint32_t> codes, std::span<std::byte> planes) {
  for (std::size_t plane = 0; plane * codes.size() < planes.size(); ++plane) {
    std::byte* bytes = planes.data() + plane * codes.size();
    for (std::size_t k = 0; k < codes.size(); ++k) bytes[k] = static_cast<std::byte>((codes[k] >> (8 * plane)) & 0xffU);
  }
}

POESY_EACH_INSTRUCTION_SET void from_planes(std::span<const std::byte> planes, std::span<std::uint32_t> codes) {
  for (std::size_t plane = 0; plane * codes.size() < planes.size(); ++plane) {
    const std::byte* bytes = planes.data() + plane * codes.size();
    for (std::size_t k = 0; k < codes.size(); ++k) codes[k] |= static_cast<std::uint32_t>(bytes[k]) << (8 * plane);
  }
}

/// `size` numbers with the old ones from `offset` on, in a list without room to spare.
template <class Number>
std::vector<Number> moved_up(const std::vector<Number>& old, std::size_t offset, std::size_t size) {
  std::vector<Number> moved(size);
  std::ranges::copy(old, moved.begin() + static_cast<std::ptrdiff_t>(offset));
  return moved;
}

}  // namespace

std::uint64_t quantile_rank(double q, std::uint64_t n) {
  const auto whole = static_cast<double>(n);
  double k = std::clamp(std::ceil(q * whole), 1.0, whole);
  // q n may be rounded past a whole number.
  if (k > 1.0 && (k - 1.0) / whole >= q) k -= 1.0;
  if (k < whole && k / whole < q) k += 1.0;
  return static_cast<std::uint64_t>(k);
}

BucketedValues::BucketedValues(std::span<const double> values) : buckets(values.size()) {
  POESY_EXPECTS(std::ranges::all_of(values, [](double value) { return std::isfinite(value); }));
  if (!values.empty()) sort_into_buckets(values, *this);
}

void BucketedValues::write(ByteWriter& to) const {
  to.number(buckets.size());
  if (buckets.empty()) return;
  to.real(min);
  to.real(max);
  const bool has_magnitudes = negatives != 0 || positives != 0;
  const std::uint32_t span = has_magnitudes ? highest - lowest : 0;
  to.number(has_magnitudes ? lowest : kFirstNormal);
  to.number(span);
  std::vector<std::uint32_t> codes(buckets.size());
  encode(buckets, has_magnitudes ? lowest : kFirstNormal, codes);
  Bytes planes(buckets.size() * code_bytes(span));
  to_planes(codes, planes);
  to.raw(planes);
}

BucketedValues BucketedValues::read(ByteReader& from) {
  BucketedValues values;
  values.buckets.resize(from.count(2));
  if (values.buckets.empty()) return values;
  values.min = from.real();
  values.max = from.real();
  if (!std::isfinite(values.min) || !(values.min <= values.max) || !std::isfinite(values.max)) {
    throw BytesError("numbers have no range");
  }
  values.lowest = static_cast<std::uint32_t>(from.number_up_to(kLast));
  if (values.lowest < kFirstNormal) throw BytesError("a bucket is for numbers that are taken for zero");
  const auto span = static_cast<std::uint32_t>(from.number_up_to(kLast - values.lowest));
  values.highest = values.lowest + span;
  from_planes(from.raw(values.buckets.size() * code_bytes(span)), values.buckets);
  if (std::ranges::max(values.buckets) > most_code(span)) throw BytesError("a number is in no bucket");
  decode(values);
  return values;
}

void QuantileSketch::Store::wrap(std::size_t k) {
  if (wraps.empty()) wraps.resize(low.size());
  ++wraps[k];
}

void QuantileSketch::Store::add(std::size_t k, std::uint64_t count) {
  const std::uint64_t sum = low[k] + count;
  low[k] = static_cast<std::uint16_t>(sum);
  if (sum <= std::numeric_limits<std::uint16_t>::max()) return;
  if (wraps.empty()) wraps.resize(low.size());
  wraps[k] += sum >> 16U;
}

void QuantileSketch::Store::reach(std::size_t lowest, std::size_t highest) {
  if (lowest > highest) return;
  if (low.empty()) first = lowest;
  const std::size_t begin = std::min(first, lowest);
  const std::size_t size = std::max(first + low.size(), highest + 1) - begin;
  if (size == low.size()) return;
  low = moved_up(low, first - begin, size);
  if (!wraps.empty()) wraps = moved_up(wraps, first - begin, size);
  first = begin;
}

void QuantileSketch::Store::merge(const Store& other) {
  if (other.low.empty()) return;
  reach(other.first, other.first + other.size() - 1);
  const std::size_t offset = other.first - first;
  for (std::size_t k = 0; k < other.size(); ++k) add(offset + k, other.count(k));
  total += other.total;
}

double QuantileSketch::Store::magnitude(std::uint64_t k) const {
  POESY_EXPECTS(k >= 1 && k <= total);
  std::size_t at = 0;
  for (std::uint64_t below = count(0); below < k; below += count(at)) ++at;
  return middle(first + at);
}

void QuantileSketch::Store::write(ByteWriter& to) const {
  to.number(size());
  if (low.empty()) return;
  to.number(first);
  for (std::size_t k = 0; k < size(); ++k) to.number(count(k));
}

QuantileSketch::Store QuantileSketch::Store::read(ByteReader& from) {
  Store store;
  store.low.resize(from.count(1));
  if (store.low.empty()) return store;
  store.first = static_cast<std::size_t>(from.number_up_to(kLast));
  if (store.first < kFirstNormal || store.size() > kLast - store.first + 1) {
    throw BytesError("a histogram has buckets for numbers that do not exist");
  }
  for (std::size_t k = 0; k < store.size(); ++k) {
    const std::uint64_t count = from.number_up_to(std::numeric_limits<std::uint64_t>::max() - store.total);
    store.add(k, count);
    store.total += count;
  }
  return store;
}

void QuantileSketch::add(const BucketedValues& values) {
  if (values.negatives != 0) negative_.reach(values.lowest, values.highest);
  if (values.positives != 0) positive_.reach(values.lowest, values.highest);
  const std::array<Store*, 2> stores{&positive_, &negative_};
  const std::array<std::uint16_t*, 2> counts{positive_.low.data(), negative_.low.data()};
  const std::array<std::size_t, 2> first{positive_.first, negative_.first};
  for (const std::uint32_t bits : values.buckets) {
    const std::uint32_t bucket = bits & ~kSign;
    // No branch on the sign, which is as good as random.
    const std::size_t sign = (bits & kSign) != 0 ? 1 : 0;
    if (bucket < kFirstNormal) continue;
    const std::size_t at = bucket - first[sign];
    if (++counts[sign][at] == 0) stores[sign]->wrap(at);
  }
  negative_.total += values.negatives;
  positive_.total += values.positives;
  zeros_ += values.buckets.size() - values.negatives - values.positives;
  min_ = std::min(min_, values.min);
  max_ = std::max(max_, values.max);
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
  return n == 0 ? std::numeric_limits<double>::quiet_NaN() : order_statistic(quantile_rank(q, n));
}

double QuantileSketch::order_statistic(std::uint64_t k) const {
  POESY_EXPECTS(k >= 1 && k <= count());
  if (k == 1) return min_;
  if (k == count()) return max_;
  double value = 0.0;
  if (k <= negative_.total) {
    value = -negative_.magnitude(negative_.total - k + 1);
  } else if (k > negative_.total + zeros_) {
    value = positive_.magnitude(k - negative_.total - zeros_);
  }
  return std::clamp(value, min_, max_);
}

std::vector<Bucket> QuantileSketch::buckets() const {
  std::vector<Bucket> filled;
  const auto add = [&](double lower, double upper, std::uint64_t values) {
    if (values == 0) return;
    const std::uint64_t before = filled.empty() ? 0 : filled.back().up_to;
    filled.push_back({std::max(lower, min_), std::min(upper, max_), values, before + values});
  };
  for (std::size_t k = negative_.size(); k-- > 0;) {
    add(-edge(negative_.first + k + 1), -edge(negative_.first + k), negative_.count(k));
  }
  add(0.0, 0.0, zeros_);
  for (std::size_t k = 0; k < positive_.size(); ++k) {
    add(edge(positive_.first + k), edge(positive_.first + k + 1), positive_.count(k));
  }
  return filled;
}

QuantileSketch QuantileSketch::magnitudes() const {
  if (count() == 0 || min_ >= 0.0) return *this;
  QuantileSketch folded;
  folded.positive_ = positive_;
  folded.positive_.merge(negative_);
  folded.zeros_ = zeros_;
  folded.min_ = std::max(0.0, -max_);
  folded.max_ = std::max(-min_, max_);
  return folded;
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
