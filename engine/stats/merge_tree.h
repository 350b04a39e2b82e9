#pragma once

#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/contract.h"

namespace poesy {

/// Merges numbered leaves in an order that their numbers alone decide: leaf 2k with leaf 2k + 1, these pairs likewise,
/// and so on. So a sum of floating-point numbers has the same bits however the leaves were divided into ranges, if the
/// ranges are put together in their order. Holds one sum for each binary digit of the number of leaves, and up to twice
/// as many where it does not begin at leaf 0.
/// Sum is a value with merge(const Sum&), whose argument holds later leaves.
template <class Sum>
class MergeTree {
 public:
  /// Some leaves, merged.
  struct Node {
    std::size_t first;   ///< leaf; a multiple of `leaves`
    std::size_t leaves;  ///< a power of two
    Sum sum;             ///< of these leaves
  };

  /// The next leaves. Precondition: they come right after those that are here, if any are.
  void add(Node node) {
    POESY_EXPECTS(nodes_.empty() || node.first == end());
    nodes_.push_back(std::move(node));
    while (nodes_.size() > 1 && are_siblings(nodes_[nodes_.size() - 2], nodes_.back())) {
      Node& earlier = nodes_[nodes_.size() - 2];
      earlier.sum.merge(nodes_.back().sum);
      earlier.leaves *= 2;
      nodes_.pop_back();
    }
  }
  /// One more leaf.
  void add(std::size_t leaf, Sum sum) { add(Node{leaf, 1, std::move(sum)}); }

  bool empty() const { return nodes_.empty(); }                             ///< Whether no leaf was added.
  std::size_t first() const { return empty() ? 0 : nodes_.front().first; }  ///< The first leaf; 0 where there is none.
  /// The number of the leaf after the last.
  std::size_t end() const { return empty() ? 0 : nodes_.back().first + nodes_.back().leaves; }

  /// All leaves together, from the last node on, which is the smallest. Precondition: there is a leaf.
  Sum total() && {
    POESY_EXPECTS(!empty());
    while (nodes_.size() > 1) {
      nodes_[nodes_.size() - 2].sum.merge(nodes_.back().sum);
      nodes_.pop_back();
    }
    return std::move(nodes_.front().sum);
  }

  /// The same of a copy.
  Sum total() const& {
    MergeTree copy = *this;
    return std::move(copy).total();
  }

  /// Every node, and back.
  void write(ByteWriter& to) const {
    to.number(nodes_.size());
    for (const Node& node : nodes_) {
      to.number(node.first);
      to.number(node.leaves);
      node.sum.write(to);
    }
  }

  /// Adds what write() wrote of the next leaves, up to leaf `end`; read(from, first, leaves) reads a sum of so many
  /// leaves. Throws BytesError for what cannot follow.
  template <class Read>
  void read(ByteReader& from, std::size_t end_of_all, const Read& read) {
    for (std::uint64_t left = from.number(); left > 0; --left) {
      const auto first = static_cast<std::size_t>(from.number_up_to(end_of_all));
      const auto leaves = static_cast<std::size_t>(from.number_up_to(end_of_all - first));
      if (!std::has_single_bit(leaves) || first % leaves != 0) throw BytesError("has sums of no whole branch");
      if (!empty() && first != end()) throw BytesError("has sums that do not follow each other");
      add(Node{first, leaves, read(from, first, leaves)});
    }
  }

 private:
  static bool are_siblings(const Node& a, const Node& b) {
    return a.leaves == b.leaves && a.first % (2 * a.leaves) == 0;
  }

  std::vector<Node> nodes_;
};

}  // namespace poesy
