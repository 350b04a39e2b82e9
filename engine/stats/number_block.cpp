#include "engine/stats/number_block.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "engine/base/instruction_sets.h"

namespace poesy {
namespace {

/// The buckets that numbers of one sign need: from the bucket of the smallest magnitude to the bucket of the largest.
struct BucketRange {
  std::uint64_t first = 0;
  std::uint64_t count = 0;  ///< number of buckets; 0 without numbers of this sign
};

/// The code by which a number is stored: 0 for zero, then the buckets above zero, then those below.
struct Codes {
  BucketScale scale;
  BucketRange above;
  BucketRange below;

  explicit Codes(const Extremes& extremes)
      : scale(finest_fitting(extremes)),
        above(range(extremes.has_above(), extremes.least_above, extremes.max)),
        below(range(extremes.has_below(), extremes.least_below, -extremes.min)) {}

  BucketRange range(bool some, double least, double most) const {
    if (!some) return {};
    return {scale.key(least), scale.key(most) - scale.key(least) + 1};
  }
  std::uint64_t largest() const { return above.count + below.count; }
  std::size_t bytes() const { return largest() <= 0xffff ? 2 : 4; }

  std::uint32_t code(std::uint64_t key) const {
    const std::uint64_t bucket = key & ~BucketScale::kSign;
    if (bucket < BucketScale::kFirstNormal) return 0;
    const std::uint64_t at = key == bucket ? bucket - above.first : above.count + bucket - below.first;
    return static_cast<std::uint32_t>(1 + at);
  }
  /// The number with this code: the smallest magnitude in its bucket, with its sign.
  double number(std::uint32_t code) const {
    if (code == 0) return 0.0;
    const std::uint64_t at = code - 1;
    return at < above.count ? scale.edge(above.first + at) : -scale.edge(below.first + (at - above.count));
  }
};

/// Stores the lowest bytes of all codes, then the second bytes, and so on. In this order compilers can vectorise the
/// loops for every instruction set.
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

}  // namespace

NumberBlock::NumberBlock(std::span<const double> numbers)
    : values(numbers.begin(), numbers.end()), extremes(Extremes::of(numbers)) {}

void NumberBlock::sort_few() {
  if (values.size() <= kMostExact) std::ranges::sort(values);
}

void NumberBlock::write(ByteWriter& to) const {
  to.number(values.size());
  if (values.size() <= kMostExact) {
    to.reals(values);
    return;
  }
  write_state(extremes, to);
  const Codes codes(extremes);
  std::vector<std::uint64_t> keys(values.size());
  codes.scale.keys(values, keys);
  std::vector<std::uint32_t> each(keys.size());
  std::ranges::transform(keys, each.begin(), [&](std::uint64_t key) { return codes.code(key); });
  Bytes planes(each.size() * codes.bytes());
  to_planes(each, planes);
  to.raw(planes);
}

NumberBlock NumberBlock::read(ByteReader& from) {
  const std::size_t count = from.count(2);
  if (count <= kMostExact) {
    const std::vector<double> few = from.reals(count);
    if (!std::ranges::all_of(few, [](double value) { return std::isfinite(value); })) {
      throw BytesError("a number is not finite");
    }
    return NumberBlock(few);
  }
  NumberBlock block;
  block.extremes.count = count;
  Archive archive(from);
  block.extremes.state(archive);
  const Codes codes(block.extremes);
  std::vector<std::uint32_t> each(count);
  from_planes(from.raw(count * codes.bytes()), each);
  if (std::ranges::max(each) > codes.largest()) throw BytesError("a number is in no bucket");
  for (const std::uint32_t code : each) block.values.push_back(codes.number(code));
  return block;
}

}  // namespace poesy
