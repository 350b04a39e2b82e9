#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/report/table.h"

/// Signs of a drawing in texts, and words for terminals that cannot show them.
namespace poesy {

inline constexpr std::string_view kDiameter = "\u2300";         ///< Before a diameter.
inline constexpr std::string_view kSphereDiameter = "S\u2300";  ///< Before the diameter of a sphere.
inline constexpr std::string_view kPlusMinus = "\u00b1";        ///< Before the tolerance of a distance.

/// The text with words in the place of signs: "position", "dia 0.02 mm", "+-0.01 mm".
std::string with_words(std::string_view text);

/// Writes words in the place of signs into all cells.
void use_words(std::span<Table> tables);

/// The boxes of a tolerance frame: sign, zone, and each datum of "A|B". zone: with the sign of a diameter.
std::vector<std::string> frame_boxes(std::string_view sign, std::string zone, std::string_view datums);

}  // namespace poesy
