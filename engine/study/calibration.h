#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/base/index.h"
#include "engine/base/units.h"
#include "engine/study/poses/pose_selection.h"

namespace poesy {

/// Errors that a calibration fits together by one number. Each of these errors is the number times the weight of the
/// error.
struct FittedErrors {
  std::string name;                       ///< name of the combination of errors, or of the single error
  std::vector<FactorIndex> factors = {};  ///< fitted errors, at least one, all different
  /// Weight of each error, SI unit of the error per SI unit of the number; none is 0.
  std::vector<double> weights = {};
  Dimension dimension;  ///< dimension of the number, the same as that of the first error
  Place place = {};     ///< place of the error or combination in the key `fit`, for messages
};

/// The unknown properties of the measuring device's frame.
enum class MeasuringFrame {
  known,   ///< nothing: the device measures in the base's frame
  height,  ///< the height of the device's zero (1 number)
  plane,   ///< height and two slopes of the plane from which the device measures heights (3 numbers)
  rigid    ///< position and orientation of the device's frame (6 numbers)
};

/// The unknown properties of the measured point of the platform.
enum class MeasuredTarget {
  known,  ///< nothing: the point is the tool's tip, or the platform's origin
  point,  ///< the position of the point (3 numbers)
  rigid   ///< position of the point and orientation of the measured target (6 numbers)
};

/// What is known of the fitted errors before anything is measured.
enum class PriorKnowledge {
  none,       ///< nothing; the errors are fitted by least squares
  tolerances  ///< the distributions of the fitted errors in [errors], used as a Bayesian prior
};

/// What is known about the standard deviations of measured values.
enum class NoiseLevel {
  given,  ///< the stated standard deviations are right
  /// All stated standard deviations are wrong by one common factor, which the fit estimates from its residual.
  estimated
};

/// The standard deviation of a single measurement of one quantity.
struct StatedNoise {
  std::string what;  ///< name of the response, or "distance"
  double sd;         ///< standard deviation, SI, at least 0
};

/// A number that the user types into the controller, as an expression in geometry parameters and fitted errors.
struct ControllerNumber {
  std::string name;  ///< name of the number in the controller
  std::string text;  ///< the expression as written
  Place place;       ///< place of the expression, for messages
};

/// Words that the key `measured` accepts in addition to names of responses.
/// @{
inline constexpr std::string_view kMeasuredDistance = "distance";
inline constexpr std::string_view kMeasuredPose = "pose";
/// @}

/// The table [analysis.calibration], which says how a machine is calibrated.
struct CalibrationTable {
  std::vector<FittedErrors> fit;  ///< the fitted numbers, linearly independent
  /// What is measured in a simulated calibration: names of responses, "pose" or "distance".
  std::vector<std::string> measured = {};
  std::vector<StatedNoise> noise = {};                ///< standard deviations of the measured quantities
  std::optional<PoseSelection> poses = std::nullopt;  ///< poses of a simulated measurement; none: the study's poses
  /// Pairs of poses (positions, from 0) between which distances are measured.
  std::vector<std::array<std::size_t, 2>> pairs = {};
  std::size_t repeats = 1;                        ///< number of measurements that are averaged to one value
  MeasuringFrame frame = MeasuringFrame::known;   ///< unknown properties of the measuring device's frame
  MeasuredTarget target = MeasuredTarget::known;  ///< unknown properties of the measured point of the platform
  PriorKnowledge prior = PriorKnowledge::none;    ///< what is known of the fitted errors before the measurement
  NoiseLevel sd = NoiseLevel::given;              ///< how well the standard deviations of measured values are known
  /// Coordinates that the controller commands; empty: the model's pose coordinates.
  std::vector<std::string> coordinates = {};
  /// Groups of drives (names of joints) that one motor moves; empty: each drive has its own.
  std::vector<std::vector<std::string>> motors = {};
  /// [fitted numbers] The values of the fitted numbers for which the controller already corrected while the machine was
  /// measured, SI; empty: none.
  std::vector<double> present = {};
  std::vector<ControllerNumber> controller = {};  ///< numbers to type into the controller
  std::size_t next = 0;                           ///< number of poses to propose for the next measurement
  /// Poses from which the poses to propose are chosen; none: the study's poses.
  std::optional<PoseSelection> candidates = std::nullopt;
  /// Errors for which [errors] states a distribution, ascending; see errors_with_tolerance().
  std::vector<FactorIndex> with_tolerance = {};
  Place place = {};              ///< place of the table, for messages
  Place measured_place = {};     ///< place of the key `measured`, for messages
  Place pairs_place = {};        ///< place of the key `pairs`, for messages
  Place coordinates_place = {};  ///< place of the keys `coordinates` and `motors`, for messages
};

std::string_view name(MeasuringFrame frame);   ///< The word for this value in a study file.
std::string_view name(MeasuredTarget target);  ///< The word for this value in a study file.
std::string_view name(PriorKnowledge prior);   ///< The word for this value in a study file.
std::string_view name(NoiseLevel level);       ///< The word for this value in a study file.

}  // namespace poesy
