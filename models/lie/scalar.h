#pragma once

#include <type_traits>

namespace poesy::lie {

// With these functions the same formula works for a single number and for a batch of numbers. Each number of a batch is
// a lane. A comparison of batches gives a mask, which has a truth value for each lane. `select` chooses between two
// batches lane by lane, and `any` returns whether the mask is true in some lane. The functions here are those for
// single numbers.

template <class T>
requires std::is_floating_point_v<T>
constexpr T select(bool mask, T yes, T no) { return mask ? yes : no; }

constexpr bool any(bool mask) { return mask; }

}  // namespace poesy::lie
