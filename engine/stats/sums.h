#pragma once

#include <algorithm>

#include "engine/base/contract.h"

/// Functions on lists and arrays of accumulators, element by element.
namespace poesy {

/// Calls visit(one, other) for each pair of corresponding elements of two lists, in order. Precondition: the lists have
/// the same number of elements.
template <class Ones, class Others, class Visit>
void for_each_pair(Ones& ones, const Others& others, const Visit& visit) {
  POESY_EXPECTS(ones.size() == others.size());
  std::ranges::for_each(ones, [&, other = others.begin()](auto& one) mutable { visit(one, *other++); });
}

/// Merges the elements of `later` into those of `sums`.
template <class Sums>
void merge_each(Sums& sums, const Sums& later) {
  for_each_pair(sums, later, [](auto& sum, const auto& other) { sum.merge(other); });
}

}  // namespace poesy
