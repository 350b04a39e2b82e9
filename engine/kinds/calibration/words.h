#pragma once

#include <string>
#include <vector>

#include "engine/kinds/calibration/result.h"

namespace poesy {

/// "heights.csv: 12 heights, 3 distances at 13 poses; 7 fitted errors, 8 degrees of freedom"
std::string measured_text(const CalibrationResult& found);
/// How large the residual is, and what the chi-square test says of it. Empty if the noise is not known.
std::string residual_text(const CalibrationResult& found);
/// Sentences about the estimates: what is not determined, what moves together, what is below the noise.
std::vector<std::string> estimate_notes(const CalibrationResult& found);
/// Sentences about what is left.
std::vector<std::string> left_notes(const CalibrationResult& found);
/// "to type in: delta_radius 95.0000 -> 95.1139 +- 0.1394 mm"; empty without numbers for the controller.
std::string typed_text(const CalibrationResult& found);
/// Warnings: contradictions, outliers, estimates far outside their tolerances.
std::vector<std::string> calibration_warnings(const CalibrationResult& found);

}  // namespace poesy
