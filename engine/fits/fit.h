#pragma once

#include <string_view>

/// Tolerance classes and fits of ISO 286, as drawings write them: "217 h6", "8 H7/g6".
namespace poesy {

/// The two limits of a size, as differences from the nominal size.
struct SizeLimits {
  double lower;  ///< lower limit, m
  double upper;  ///< upper limit, m; at least `lower`

  friend bool operator==(const SizeLimits&, const SizeLimits&) = default;  ///< Returns true if both limits are equal.
};

/// The clearance of a hole and a shaft of one nominal size: the diameter of the hole minus that of the shaft. Each
/// diameter is normally distributed about the middle of its tolerance zone, and half the zone is three standard
/// deviations.
struct Fit {
  double least;     ///< smallest clearance, m
  double most;      ///< largest clearance, m
  double mean;      ///< mean clearance, m
  double variance;  ///< variance of the clearance, m^2
};

/// The limits of a nominal size with its tolerance class, such as "217 h6". The size is in millimetres unless a unit of
/// length follows the number: "0.5 in H7". The known classes are holes H and shafts d, e, f, g, h (ISO 286-1:2010,
/// Tables 2 to 5) of sizes up to 500 mm, in the grades that ISO 286-1 has for the size. Throws std::invalid_argument;
/// what() is a clause with the problem and the known classes: "'217 k6' has no zone of this table ...".
SizeLimits size_limits(std::string_view text);

/// The fit of a hole and a shaft, such as "8 H7/g6". Units, known classes and exceptions are those of size_limits().
Fit fit(std::string_view text);

}  // namespace poesy
