#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/kinds/calibration/result.h"

namespace poesy::calibration {

/// Texts for a fit that did not converge: a warning, and what the user should do.
/// @{
inline constexpr std::string_view kNotConverged =
    "the fit did not converge, so no number of it is to be used or typed in";
inline constexpr std::string_view kNotConvergedRemedy =
    "look at the units of the columns of the measurements, fit fewer errors, or take prior = \"tolerances\"";
/// @}

/// A text on what was measured: "12 deviation_z, 3 distances".
std::string values_text(const Result& found);
/// A text on what was measured and fitted: "heights.csv: 12 deviation_z, 3 distances at 13 poses; 7 fitted errors, 8
/// degrees of freedom".
std::string measured_text(const Result& found);
/// A text on the size of the residuals and the result of the chi-square test. If the noise is 0, or the fit did not
/// converge, the text says so instead.
std::string residual_text(const Result& found);
/// Clauses on what the intervals do not show: combinations of fitted errors with effects below the noise, and errors
/// that are not fitted.
std::vector<std::string> unsure_notes(const Result& found);
/// Clauses on estimates that are not determined or are correlated, on the condition number, on effects below the noise,
/// and on errors that are not fitted.
std::vector<std::string> estimate_notes(const Result& found);
/// A displacement that remains after calibration counts as rounding if it is below this (m or rad).
inline constexpr double kLeftRounding = 1e-12;

/// A component of the displacement that remains after calibration.
struct LeftComponent {
  std::size_t component;  ///< index on the axis `moved`
  NamedUnit named;        ///< name and SI unit
  double rms;             ///< root mean square over the poses, including the standard deviation of the prediction, SI
};

/// The components of the remaining displacement that are more than rounding. A component of the tool point is left out
/// if it equals that of the platform's origin P, because there is no tool or the platform does not turn.
std::vector<LeftComponent> left_components(const Result& found);

/// The length of the remaining displacement of the tool point, or of the platform's origin if there is no tool.
struct LeftLength {
  NamedUnit named;    ///< "tip_position" or "position"
  std::size_t first;  ///< index of the x component on the axis `moved`; y and z follow
  double rms;         ///< root mean square over the poses, including the standard deviation of the prediction, m
};

/// The length of the remaining displacement; none if that displacement is only rounding.
std::optional<LeftLength> left_length(const Result& found);

/// Clauses on the displacement that remains after calibration, and on the limits.
std::vector<std::string> left_notes(const Result& found);
/// A clause on the probability that the machine keeps the limits; empty if that is unknown or there are no limits.
std::string kept_text(const Result& found);
/// The parameters to type into the controller, each with its value while the machine was measured and its new value:
/// "to type in: delta_radius 95.0000 -> 95.1139 +- 0.1394 mm". Empty without such parameters.
std::string typed_text(const Result& found);
/// Whether the chi-square test, which needs known noise, shows that the measurements contradict the fitted errors.
bool is_contradicted(const Result& found);
/// Warnings about outliers, measurements that contradict the fitted errors, and estimates far outside their tolerances.
std::vector<std::string> calibration_warnings(const Result& found);

}  // namespace poesy::calibration
