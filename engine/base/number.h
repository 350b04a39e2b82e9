#pragma once

#include <cstdint>
#include <type_traits>
#include <variant>

namespace poesy {

/// A number in a table. Whole numbers have types of their own, because a double is exact only up to 2^53.
using Number = std::variant<double, std::int64_t, std::uint64_t>;

/// Converts a value to a number: a flag to 0 or 1, an enumeration to its underlying value.
template <class Value>
Number to_number(const Value& value) {
  if constexpr (std::is_same_v<Value, Number>) {
    return value;
  } else if constexpr (std::is_enum_v<Value>) {
    return to_number(static_cast<std::underlying_type_t<Value>>(value));
  } else if constexpr (std::is_floating_point_v<Value>) {
    return static_cast<double>(value);
  } else if constexpr (std::is_signed_v<Value>) {
    return static_cast<std::int64_t>(value);
  } else {
    return static_cast<std::uint64_t>(value);
  }
}

/// The double nearest to a number.
inline double to_double(const Number& number) {
  return std::visit([](auto value) { return static_cast<double>(value); }, number);
}

}  // namespace poesy
