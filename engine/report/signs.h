#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/table.h"

/// The signs of a drawing in texts, and words in their place for terminals that cannot show these signs.
namespace poesy {

inline constexpr std::string_view kDiameter = "\u2300";         ///< The sign before a diameter.
inline constexpr std::string_view kSphereDiameter = "S\u2300";  ///< The sign before the diameter of a sphere.
inline constexpr std::string_view kPlusMinus = "\u00b1";        ///< The sign before the tolerance of a distance.
inline constexpr std::string_view kTimes = "\u00d7";            ///< The sign between two factors.

/// The text with words in place of its signs: "position", "dia 0.02 mm", "+-0.01 mm".
std::string with_words(std::string_view text);

/// The text with typographic signs: a minus sign before numbers, arrows, and plus-minus. Browsers break no line at
/// these signs.
std::string typographic(std::string_view text);

/// Replaces signs by words in all cells and notes of these tables.
void use_words(std::span<Table> tables);

/// The boxes of a tolerance frame, from left to right: the sign, the zone, and one box for each of the datums in "A|B".
/// zone: size of the zone as text; if it is a diameter, with the sign of a diameter in front.
std::vector<std::string> frame_boxes(std::string_view sign, std::string zone, std::string_view datums);

}  // namespace poesy
