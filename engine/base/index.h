#pragma once

#include <compare>
#include <cstddef>

namespace poesy {

/// A position in one kind of list. Positions of different lists are different types.
template <class List>
struct Index {
  std::size_t value = 0;  ///< counts from 0

  constexpr Index() = default;
  /// Explicit, so that positions of different lists do not mix.
  constexpr explicit Index(std::size_t position) : value(position) {}
  friend constexpr auto operator<=>(const Index&, const Index&) = default;  ///< Compares positions.
};

/// Position of an error source in its model's list of all error sources.
using FactorIndex = Index<struct FactorList>;
using PoseIndex = Index<struct PoseList>;      ///< Position of a pose in a study's pose set.
using SampleIndex = Index<struct SampleList>;  ///< Position of a sample in the stream of one (factor, pose).

}  // namespace poesy
