#pragma once

#include <string>
#include <vector>

#include "engine/kinds/calibration/result.h"

namespace poesy {

/// What was measured and fitted: "heights.csv: 12 heights, 3 distances at 13 poses; 7 fitted errors, 8 degrees of
/// freedom"
std::string measured_text(const CalibrationResult& found);
/// The size of the residuals, and the result of the chi-square test. Empty if the noise is not known.
std::string residual_text(const CalibrationResult& found);
/// Sentences that name the estimates that are not determined, that are correlated, or that are below the noise.
std::vector<std::string> estimate_notes(const CalibrationResult& found);
/// Sentences about the displacement that remains after calibration.
std::vector<std::string> left_notes(const CalibrationResult& found);
/// A text on the probability that the machine keeps the limits; empty without limits.
std::string kept_text(const CalibrationResult& found);
/// "to type in: delta_radius 95.0000 -> 95.1139 +- 0.1394 mm"; empty without numbers for the controller.
std::string typed_text(const CalibrationResult& found);
/// Warnings about contradictions, outliers, and estimates far outside their tolerances.
std::vector<std::string> calibration_warnings(const CalibrationResult& found);

}  // namespace poesy
