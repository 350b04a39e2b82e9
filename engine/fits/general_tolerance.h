#pragma once

#include <optional>

/// General tolerances of ISO 2768. If a drawing has a note "ISO 2768", they apply to all features for which it states
/// no tolerance.
namespace poesy {

/// The classes of ISO 2768-1: fine, medium, coarse, very coarse.
enum class GeneralLengthClass { f, m, c, v };

/// The general tolerance T (m) of a distance with this nominal size (m); the drawing means +-T (ISO 2768-1:1989, Table
/// 1). None if the standard has no value: below 0.5 mm, above 4 m, for class f above 2 m, for class v up to 3 mm.
std::optional<double> general_length_tolerance(double nominal_size, GeneralLengthClass of);

/// The classes of ISO 2768-2, the finest first.
enum class GeneralZoneClass { H, K, L };

/// The kinds of tolerance zones for which ISO 2768-2 has tables.
enum class GeneralZone {
  flatness,          ///< Table 1, which depends on the longer side or the diameter
  perpendicularity,  ///< Table 2, which depends on the length of the shorter side
  symmetry,          ///< Table 3, which depends on the length of the shorter feature
  runout             ///< Table 4, which has the same value for every length
};

/// The width of a zone (m) for a length (m) (ISO 2768-2:1989, Tables 1 to 4). None for a length of 0 or above 3 m.
std::optional<double> general_zone(GeneralZone zone, double length, GeneralZoneClass of);

}  // namespace poesy
