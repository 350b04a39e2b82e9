#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/kinds/calibration/result.h"

namespace poesy {

/// What was measured: "12 deviation_z, 3 distances"
std::string values_text(const CalibrationResult& found);
/// What was measured and fitted: "heights.csv: 12 heights, 3 distances at 13 poses; 7 fitted errors, 8 degrees of
/// freedom"
std::string measured_text(const CalibrationResult& found);
/// The size of the residuals, and the result of the chi-square test. Empty if the noise is not known.
std::string residual_text(const CalibrationResult& found);
/// What makes intervals less sure than they look: directions below the noise, and errors that are not fitted.
std::vector<std::string> unsure_notes(const CalibrationResult& found);
/// Sentences that name the estimates that are not determined, that are correlated, or that are below the noise.
std::vector<std::string> estimate_notes(const CalibrationResult& found);
/// A remaining displacement below this (m or rad) counts as rounding.
inline constexpr double kLeftRounding = 1e-12;

/// A component of the displacement that remains after calibration.
struct LeftComponent {
  std::size_t component;  ///< position on the axis `moved`
  NamedUnit named;        ///< name and SI unit
  double rms;             ///< root mean square over the poses, including the uncertainty, SI
};

/// The components of the remaining displacement that are more than rounding. Those of the tool point are left out if
/// they equal those of P, because there is no tool or the platform does not turn.
std::vector<LeftComponent> left_components(const CalibrationResult& found);

/// The length of the remaining displacement of the tool point (without a tool: of the platform's origin) over the
/// poses, including the uncertainty, SI.
struct LeftLength {
  NamedUnit named;    ///< "tip_position" or "position"
  std::size_t first;  ///< position of its x component on the axis `moved`; y and z follow
  double rms;         ///< root mean square over the poses
};

/// The length of the remaining displacement; none if that displacement is only rounding.
std::optional<LeftLength> left_length(const CalibrationResult& found);

/// Sentences about the displacement that remains after calibration.
std::vector<std::string> left_notes(const CalibrationResult& found);
/// A text on the probability that the machine keeps the limits; empty without limits.
std::string kept_text(const CalibrationResult& found);
/// "to type in: delta_radius 95.0000 -> 95.1139 +- 0.1394 mm", from the value while the machine was measured to the new
/// one; empty without numbers for the controller.
std::string typed_text(const CalibrationResult& found);
/// Whether the measurements contradict the fitted errors by the chi-square test.
bool is_contradicted(const CalibrationResult& found);
/// Warnings about contradictions, outliers, and estimates far outside their tolerances.
std::vector<std::string> calibration_warnings(const CalibrationResult& found);

}  // namespace poesy
