#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/contract.h"

namespace poesy {

/// Merges numbered leaves (for instance the sums of blocks of samples) in an order that depends only on their numbers:
/// leaves 8k, 8k + 1, ... 8k + 7 are merged one after the other to a branch, then eight branches to a larger branch,
/// and so on. So a sum of floating-point numbers has the same bits however the leaves were divided into ranges, if the
/// ranges are merged in order. The tree keeps one sum for each octal digit of the number of leaves. If the first leaf
/// of the tree is not leaf 0, the tree keeps up to seven more sums for each digit. Sum is a value type with merge(const
/// Sum&), whose argument is the sum of later leaves.
template <class Sum>
class MergeTree {
 public:
  /// The merged sum of several leaves: of a whole branch, or of the first branches of a larger branch.
  struct Node {
    std::size_t first;   ///< index of the first leaf
    std::size_t leaves;  ///< number of leaves: a power of eight, times 2 to 7 if the node has several branches
    Sum sum;             ///< sum of these leaves
  };

  /// The largest number of nodes of a tree whose leaves are 0 to `leaves` - 1.
  static constexpr std::size_t most_nodes(std::size_t leaves) {
    std::size_t digits = 0;
    for (; leaves > 0; leaves /= kBranches) ++digits;
    return digits;
  }

  /// Adds the next leaves. Precondition: they follow the leaves that the tree already has.
  void add(Node node) {
    POESY_EXPECTS(nodes_.empty() || node.first == end());
    nodes_.push_back(std::move(node));
    while (nodes_.size() > 1 && goes_on(nodes_[nodes_.size() - 2], nodes_.back())) {
      Node& earlier = nodes_[nodes_.size() - 2];
      earlier.sum.merge(nodes_.back().sum);
      earlier.leaves += nodes_.back().leaves;
      nodes_.pop_back();
    }
  }
  /// Adds one leaf.
  void add(std::size_t leaf, Sum sum) { add(Node{leaf, 1, std::move(sum)}); }

  bool empty() const { return nodes_.empty(); }  ///< Returns true if no leaf was added.
  /// The index of the first leaf; 0 if there are none.
  std::size_t first() const { return empty() ? 0 : nodes_.front().first; }
  /// The index of the last leaf plus 1; 0 if there are none.
  std::size_t end() const { return empty() ? 0 : nodes_.back().first + nodes_.back().leaves; }

  /// The sum of all leaves, merged from the last node to the first. Precondition: there is a leaf.
  Sum total() && {
    POESY_EXPECTS(!empty());
    while (nodes_.size() > 1) {
      nodes_[nodes_.size() - 2].sum.merge(nodes_.back().sum);
      nodes_.pop_back();
    }
    return std::move(nodes_.front().sum);
  }

  /// The sum of all leaves; the tree stays as it is. Precondition: there is a leaf.
  Sum total() const& {
    MergeTree copy = *this;
    return std::move(copy).total();
  }

  /// The nodes, in the order of their leaves.
  std::span<const Node> nodes() const { return nodes_; }

  /// Reads or writes every node. When reading, the nodes are added as the next leaves, which must be below
  /// `end_of_all`. none: an empty sum; each sum that is read begins as a copy of it.
  void state(Archive& archive, std::size_t end_of_all, const Sum& none) {
    std::uint64_t count = nodes_.size();
    archive.number(count);
    for (std::size_t k = 0; k < count; ++k) {
      if (archive.reads()) {
        Node next{0, 0, none};
        node_state(archive, end_of_all, next);
        archive.expect(empty() || next.first == end(), "has sums that do not follow each other");
        add(std::move(next));
      } else {
        node_state(archive, end_of_all, nodes_[k]);
      }
    }
  }

 private:
  static constexpr std::size_t kBranches = 8;

  /// The largest power of eight that divides `leaves`. Precondition: leaves > 0.
  static std::size_t branch_of(std::size_t leaves) {
    std::size_t branch = 1;
    for (; leaves % kBranches == 0; leaves /= kBranches) branch *= kBranches;
    return branch;
  }
  /// Returns true if a node may have these leaves: a whole branch, or the first 2 to 7 branches of a larger branch.
  static bool is_node(std::size_t first, std::size_t leaves) {
    if (leaves == 0) return false;
    const std::size_t branch = branch_of(leaves);
    const std::size_t branches = leaves / branch;
    return branches < kBranches && first % (branches == 1 ? branch : branch * kBranches) == 0;
  }
  static void node_state(Archive& archive, std::size_t end_of_all, Node& node) {
    archive.number(node.first, end_of_all);
    archive.number(node.leaves, end_of_all - node.first);
    archive.expect(is_node(node.first, node.leaves), "has sums of no whole branch");
    archive.object(node.sum);
  }
  /// Returns true if b is one branch, and a and b together are the first branches of the same larger branch.
  static bool goes_on(const Node& a, const Node& b) {
    const bool is_branch = branch_of(b.leaves) == b.leaves;
    return is_branch && branch_of(a.leaves) == b.leaves && a.first % (b.leaves * kBranches) == 0;
  }

  std::vector<Node> nodes_;
};

}  // namespace poesy
