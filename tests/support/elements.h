#pragma once

#include <vector>

#include "engine/base/array.h"

namespace poesy::test {

/// All elements of an array, row-major.
template <class T, class... Axes>
std::vector<T> elements(const Array<T, Axes...>& array) {
  return {array.begin(), array.end()};
}

}  // namespace poesy::test
