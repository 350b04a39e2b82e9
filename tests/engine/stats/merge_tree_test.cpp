#include "engine/stats/merge_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace poesy {
namespace {

/// A sum whose last bits depend on the order of the merges.
struct Sum {
  double value = 0.0;

  void merge(const Sum& later) { value = 1.0000001 * value + later.value; }
  void state(Archive& archive) { archive.real(value); }
};

Sum leaf(std::size_t n) { return {1.0 / (static_cast<double>(n) + 1.1)}; }

MergeTree<Sum> range(std::size_t first, std::size_t end) {
  MergeTree<Sum> tree;
  for (std::size_t n = first; n < end; ++n) tree.add(n, leaf(n));
  return tree;
}

Bytes written(MergeTree<Sum> tree) {
  ByteWriter to;
  Archive archive(to);
  tree.state(archive, tree.end(), Sum());
  return to.take();
}

void append(MergeTree<Sum>& tree, const MergeTree<Sum>& later, std::size_t end) {
  const Bytes bytes = written(later);
  ByteReader from(bytes);
  Archive archive(from);
  tree.state(archive, end, Sum());
  from.expect_end();
}

TEST(MergeTree, HasTheSameBitsForAnyDivision) {
  for (const std::size_t leaves : {1U, 7U, 8U, 9U, 15U, 16U, 21U, 63U, 64U, 65U, 137U}) {
    const double whole = range(0, leaves).total().value;
    for (std::size_t a = 0; a <= leaves; ++a) {
      for (std::size_t b = a; b <= leaves; b += 1 + leaves / 60) {
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

TEST(MergeTree, MergesEightBranchesOneAfterTheOther) {
  Sum branch = leaf(8);
  for (std::size_t n = 9; n < 16; ++n) branch.merge(leaf(n));
  Sum first = leaf(0);
  for (std::size_t n = 1; n < 8; ++n) first.merge(leaf(n));
  Sum last = leaf(16);
  last.merge(leaf(17));
  first.merge(branch);
  first.merge(last);
  EXPECT_EQ(range(0, 18).total().value, first.value);
}

TEST(MergeTree, HoldsOneSumForEachOctalDigit) {
  for (const std::size_t leaves : {1U, 7U, 8U, 63U, 64U, 511U, 512U, 4095U, 100'000U}) {
    const auto most = static_cast<std::uint64_t>(std::floor(std::log2(static_cast<double>(leaves)) / 3.0 + 1.0));
    EXPECT_EQ(MergeTree<Sum>::most_nodes(leaves), most) << leaves;
    EXPECT_LE(range(0, leaves).nodes().size(), most) << leaves;
  }
  EXPECT_EQ(range(0, 511).nodes().size(), 3u);
}

TEST(MergeTree, HoldsSevenMoreForEachDigitWhereItBeginsLater) {
  for (const std::size_t first : {1U, 9U, 73U, 585U}) EXPECT_LE(range(first, 4000).nodes().size(), 8u * 4u) << first;
}

TEST(MergeTree, RefusesWhatDoesNotFollow) {
  MergeTree<Sum> tree = range(0, 3);
  EXPECT_THROW(append(tree, range(4, 5), 8), BytesError);
  MergeTree<Sum> other;
  EXPECT_THROW(append(other, range(0, 3), 2), BytesError);
}

/// Reads a stored state with one node. first, leaves: the first leaf of the node and its number of leaves.
void read_node(std::uint64_t first, std::uint64_t leaves) {
  ByteWriter to;
  for (const std::uint64_t number : {std::uint64_t{1}, first, leaves}) to.number(number);
  to.real(1.0);
  const Bytes bytes = to.take();
  ByteReader from(bytes);
  Archive archive(from);
  MergeTree<Sum>().state(archive, 1000, Sum());
}

TEST(MergeTree, RefusesSumsOfNoBranches) {
  for (const auto& [first, leaves] : {std::pair{0U, 8U}, {8U, 8U}, {64U, 40U}, {64U, 3U}, {5U, 1U}}) {
    EXPECT_NO_THROW(read_node(first, leaves)) << first << " " << leaves;
  }
  for (const auto& [first, leaves] : {std::pair{0U, 0U}, {0U, 9U}, {1U, 8U}, {1U, 2U}, {8U, 16U}, {0U, 152U}}) {
    EXPECT_THROW(read_node(first, leaves), BytesError) << first << " " << leaves;
  }
}

}  // namespace
}  // namespace poesy
