#pragma once

#include <type_traits>

namespace poesy::lie {

// Functions that let one formula serve a number and a batch of numbers: a comparison gives a mask, `select` chooses per
// lane, `any` tells whether some lane needs a rare branch.

template <class T>
requires std::is_floating_point_v<T>
constexpr T select(bool mask, T yes, T no) { return mask ? yes : no; }

constexpr bool any(bool mask) { return mask; }

}  // namespace poesy::lie
