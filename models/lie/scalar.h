#pragma once

#include <type_traits>

namespace poesy::lie {

// These functions let one formula work on a number and on a batch of numbers (lanes). A comparison gives a mask,
// `select` chooses in each lane, and `any` tells whether a lane exists that needs a rare branch.

template <class T>
requires std::is_floating_point_v<T>
constexpr T select(bool mask, T yes, T no) { return mask ? yes : no; }

constexpr bool any(bool mask) { return mask; }

}  // namespace poesy::lie
