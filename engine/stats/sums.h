#pragma once

#include <algorithm>
#include <type_traits>

#include "engine/base/archive.h"
#include "engine/base/contract.h"

/// Lists and arrays of accumulators, element by element.
namespace poesy {

/// Calls visit(one, other) for the elements of both, in order. Precondition: as many of both.
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

/// The state of every element, where both directions know how many there are.
template <class Sums>
void state_of_each(Archive& archive, Sums& sums) {
  for (auto& sum : sums) archive.object(sum);
}

/// The same of elements whose class has no state, but write() and read().
template <class Values>
void packed_of_each(Archive& archive, Values& values) {
  for (auto& value : values) {
    if (archive.reads()) {
      value = std::remove_reference_t<decltype(value)>::read(archive.reader());
    } else {
      value.write(archive.writer());
    }
  }
}

}  // namespace poesy
