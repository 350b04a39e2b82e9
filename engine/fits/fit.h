#pragma once

#include <string_view>

/// Tolerance classes and fits of ISO 286, as drawings write them: "217 h6", "8 H7/g6".
namespace poesy {

/// The two limits of a size, as differences from its nominal.
struct SizeLimits {
  double lower;  ///< m
  double upper;  ///< m; at least `lower`

  friend bool operator==(const SizeLimits&, const SizeLimits&) = default;  ///< Whether both limits are equal.
};

/// The clearance of a hole and a shaft of one nominal size: the difference of their diameters. The sizes are normal
/// about the middles of their zones, and three standard deviations are half a zone.
struct Fit {
  double least;     ///< m
  double most;      ///< m
  double mean;      ///< m
  double variance;  ///< m^2
};

/// The limits of a nominal size with its tolerance class, "217 h6", in millimetres unless a unit of length follows the
/// number: "0.5 in H7". Holes H and shafts d, e, f, g, h (ISO 286-1:2010, Tables 2 to 5) of sizes up to 500 mm, in the
/// grades that ISO 286-1 has for the size. Throws std::invalid_argument with a clause that says what is wrong and what
/// is known: "'217 k6' ...".
SizeLimits size_limits(std::string_view text);

/// The fit of a hole and a shaft, "8 H7/g6". Otherwise as size_limits().
Fit fit(std::string_view text);

}  // namespace poesy
