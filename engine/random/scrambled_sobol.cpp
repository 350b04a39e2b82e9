#include "engine/random/scrambled_sobol.h"

#include <array>
#include <bit>
#include <boost/random/sobol.hpp>

#include "engine/base/contract.h"
#include "engine/random/stream.h"

namespace poesy {

namespace {

constexpr std::size_t kDigits = 32;     // binary digits of a point before it is scrambled; further digits are zero
constexpr std::size_t kTreeDigits = 8;  // a tree of this many digits has 255 nodes, and a block of Philox 256 bits

using TreeBits = std::array<std::uint64_t, 4>;

/// The random bits of the tree for the eight digits that follow the first `count` digits of a coordinate. digits: these
/// first digits. The leading 1 in the number of the random block distinguishes the digits 0 from 00.
TreeBits tree_below(const StreamAddress& address, std::uint64_t digits, std::size_t count) {
  return random_block(address, std::uint64_t{1} << count | digits);
}

/// The bits that say which of eight digits of a coordinate are flipped. Whether a digit is flipped depends on all
/// digits before it: they lead from the root of a binary tree to a node, whose random bit is taken. Node 1 is the root;
/// the children of node n are 2 n (after the digit 0) and 2 n + 1 (after the digit 1).
std::uint32_t flips_along(const TreeBits& tree, std::uint32_t digits) {
  const std::uint32_t path = std::uint32_t{1} << kTreeDigits | digits;
  std::uint32_t flips = 0;
  for (std::size_t level = 0; level < kTreeDigits; ++level) {
    const std::uint32_t node = path >> (kTreeDigits - level);
    flips = flips << 1 | static_cast<std::uint32_t>(tree[node / 64] >> node % 64 & 1);
  }
  return flips;
}

/// The 32 scrambled digits of a coordinate, followed by 32 random digits. root: the tree of the first eight digits.
std::uint64_t scrambled(const StreamAddress& address, const TreeBits& root, std::uint32_t digits) {
  constexpr std::uint32_t kTreeMask = (std::uint32_t{1} << kTreeDigits) - 1;
  std::uint32_t flips = flips_along(root, digits >> (kDigits - kTreeDigits));
  for (std::size_t count = kTreeDigits; count < kDigits; count += kTreeDigits) {
    const TreeBits tree = tree_below(address, digits >> (kDigits - count), count);
    flips = flips << kTreeDigits | flips_along(tree, digits >> (kDigits - kTreeDigits - count) & kTreeMask);
  }
  const std::uint64_t below = tree_below(address, digits, kDigits)[0] >> kDigits;
  return std::uint64_t{digits ^ flips} << kDigits | below;
}

}  // namespace

ScrambledSobol::ScrambledSobol(std::size_t dimensions, std::uint64_t seed)
    : seed_(seed), directions_(dimensions * kDigits) {
  boost::random::sobol sequence(dimensions);
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    // Point n is the exclusive or of the direction numbers at the ones in its Gray code, n ^ n / 2. For n = 2^(digit +
    // 1) - 1 the Gray code has a single one, so point n is a direction number. Boost leaves out the origin, so n - 1
    // points precede point n.
    const std::uint64_t point = (std::uint64_t{2} << digit) - 1;
    sequence.seed(point - 1);
    for (std::size_t d = 0; d < dimensions; ++d) {
      directions_[d * kDigits + digit] = static_cast<std::uint32_t>(sequence() >> kDigits);
    }
  }
}

void ScrambledSobol::fill(const DesignColumn& column, SampleIndex first, std::span<double> uniforms) const {
  POESY_EXPECTS((column.dimension + 1) * kDigits <= directions_.size());
  POESY_EXPECTS(first.value + uniforms.size() <= kMostPoints);
  const StreamAddress address{.seed = seed_,
                              .purpose = Purpose::scrambled_sobol,
                              .factor = FactorIndex(column.dimension),
                              .pose = PoseIndex(column.replicate)};
  const std::uint32_t* directions = &directions_[column.dimension * kDigits];
  const TreeBits root = tree_below(address, 0, 0);
  std::uint32_t digits = 0;
  const std::uint64_t gray = first.value ^ first.value >> 1;
  for (std::size_t k = 0; k < kDigits; ++k) digits ^= (gray >> k & 1) != 0 ? directions[k] : 0;
  for (std::size_t k = 0; k < uniforms.size(); ++k) {
    // From one point to the next, one digit of the Gray code changes.
    if (k > 0) digits ^= directions[std::countr_zero(first.value + k)];
    uniforms[k] = uniform_from_bits(scrambled(address, root, digits));
  }
}

}  // namespace poesy
