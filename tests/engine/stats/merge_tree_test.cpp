#include "engine/stats/merge_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace poesy {
namespace {

/// A sum whose last bits tell in which order it was made.
struct Sum {
  double value = 0.0;

  void merge(const Sum& later) { value = 1.0000001 * value + later.value; }
  void write(ByteWriter& to) const { to.real(value); }
};

Sum leaf(std::size_t n) { return {std::sin(static_cast<double>(n) + 0.1)}; }

MergeTree<Sum> range(std::size_t first, std::size_t end) {
  MergeTree<Sum> tree;
  for (std::size_t n = first; n < end; ++n) tree.add(n, leaf(n));
  return tree;
}

void append(MergeTree<Sum>& tree, const MergeTree<Sum>& later, std::size_t end) {
  ByteWriter to;
  later.write(to);
  const Bytes bytes = to.take();
  ByteReader from(bytes);
  tree.read(from, end, [](ByteReader& reader, std::size_t, std::size_t) { return Sum{reader.real()}; });
  from.expect_end();
}

TEST(MergeTree, HasTheSameBitsForAnyDivision) {
  for (std::size_t leaves = 1; leaves <= 21; ++leaves) {
    const double whole = range(0, leaves).total().value;
    for (std::size_t a = 0; a <= leaves; ++a) {
      for (std::size_t b = a; b <= leaves; ++b) {
        MergeTree<Sum> tree;
        for (const auto& [first, end] : {std::pair{std::size_t{0}, a}, {a, b}, {b, leaves}}) {
          append(tree, range(first, end), leaves);
        }
        EXPECT_EQ(tree.end(), leaves);
        EXPECT_EQ(std::move(tree).total().value, whole) << leaves << " " << a << " " << b;
      }
    }
  }
}

TEST(MergeTree, HoldsOneSumForEachBinaryDigit) {
  ByteWriter to;
  range(0, 1023).write(to);
  const Bytes bytes = to.take();
  ByteReader from(bytes);
  EXPECT_EQ(from.number(), 10u);
}

TEST(MergeTree, RefusesWhatDoesNotFollow) {
  MergeTree<Sum> tree = range(0, 3);
  EXPECT_THROW(append(tree, range(4, 5), 8), BytesError);
  MergeTree<Sum> other;
  EXPECT_THROW(append(other, range(0, 3), 2), BytesError);
}

}  // namespace
}  // namespace poesy
