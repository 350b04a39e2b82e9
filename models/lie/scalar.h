#pragma once

#include <type_traits>

namespace poesy::lie {

// The vocabulary that lets one formula serve a number and a batch of numbers: a comparison gives a mask,
// `select` chooses per lane, `any` asks whether a rare branch is needed at all.

template <class T>
requires std::is_floating_point_v<T>
constexpr T select(bool mask, T yes, T no) { return mask ? yes : no; }

constexpr bool any(bool mask) { return mask; }

}  // namespace poesy::lie
