#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/schema/given_key.h"

/// The keys and values over which a sweep varies a study, as the command line states them.
namespace poesy::sweep {

/// A key of a study with the values that it takes in the designs of a sweep.
struct SweptKey {
  std::string key;                  ///< full name: "mechanism.geometry.R"
  std::vector<std::string> values;  ///< values as texts, see GivenKey::value; at least two, all different
};

/// The largest number of designs in a sweep.
inline constexpr std::size_t kMostDesigns = 1000;

/// Reads "KEY=FROM:TO:STEP" or "KEY=A,B,C". A unit after the last number applies to all numbers without a unit. A key
/// that begins with "geometry." means "mechanism.geometry.". Commas within brackets, braces and quotes do not separate
/// values. Throws InputError.
SweptKey parse_swept(const std::string& text);

/// The designs: all combinations of values, where the value of the last key changes fastest. Throws InputError if a key
/// is given twice, or if there are more than kMostDesigns.
std::vector<std::vector<GivenKey>> grid_of(std::span<const SweptKey> keys);

/// A value as a number and a unit: 260 and "mm" for "260 mm". The number is NaN if the value is not a number.
struct SweptNumber {
  double number;     ///< number in this unit
  std::string unit;  ///< unit; empty if the value has none
};
SweptNumber number_of(const std::string& value);  ///< Reads a value as a number.

}  // namespace poesy::sweep
