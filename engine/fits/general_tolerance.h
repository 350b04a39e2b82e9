#pragma once

#include <optional>

/// General tolerances: what a drawing means by "ISO 2768" where it states no tolerance.
namespace poesy {

/// The classes of ISO 2768-1, from fine to very coarse.
enum class GeneralLengthClass { f, m, c, v };

/// T in metres, the drawing means +-T, of a distance with this nominal size in metres (ISO 2768-1:1989, Table 1). None
/// where the standard has no value: below 0.5 mm, above 4 m, f above 2 m, v up to 3 mm.
std::optional<double> general_length_tolerance(double nominal_size, GeneralLengthClass of);

/// The classes of ISO 2768-2, from the finest.
enum class GeneralZoneClass { H, K, L };

/// The zones of which ISO 2768-2 has tables.
enum class GeneralZone {
  flatness,          ///< Table 1, by the longer side or the diameter
  perpendicularity,  ///< Table 2, by the length of the shorter side
  symmetry,          ///< Table 3, by the length of the shorter feature
  runout             ///< Table 4, for every length
};

/// The width of the zone in metres, for a length in metres (ISO 2768-2:1989, Tables 1 to 4). None for lengths of 0 or
/// above 3 m.
std::optional<double> general_zone(GeneralZone zone, double length, GeneralZoneClass of);

}  // namespace poesy
