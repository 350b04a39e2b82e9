#pragma once

#include <compare>
#include <cstddef>

namespace poesy {

/// An index in a list. Indices in different kinds of lists have different types, so that they cannot be mixed up.
template <class List>
struct Index {
  std::size_t value = 0;  ///< index, from 0

  constexpr Index() = default;
  /// Explicit, so that a plain number does not become an index by accident.
  constexpr explicit Index(std::size_t position) : value(position) {}
  /// Compares two indices in the same kind of list.
  friend constexpr auto operator<=>(const Index&, const Index&) = default;
};

/// Index of an error in the list of all errors (factors) of its model.
using FactorIndex = Index<struct FactorList>;
using PoseIndex = Index<struct PoseList>;  ///< Index of a pose in a study's pose set.
/// Number of a sample, from 0, in the sequence of draws of a factor at a pose.
using SampleIndex = Index<struct SampleList>;

}  // namespace poesy
