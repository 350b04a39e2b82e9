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

/// Errors that are fitted by one number: each error is its weight times the number.
struct FittedErrors {
  std::string name;                       ///< name of the combination; that of the error if it is one alone
  std::vector<FactorIndex> factors = {};  ///< at least one, no repetition
  std::vector<double> weights = {};       ///< SI unit of the error per SI unit of the number; none is 0
  Dimension dimension;                    ///< of the number: that of its first error
  Place place = {};                       ///< for messages
};

/// The unknown place of the measuring device.
enum class MeasuringFrame {
  known,   ///< it measures in the base's frame
  height,  ///< its zero of heights is unknown
  plane,   ///< heights are measured from a plane, whose height and two slopes are unknown
  rigid    ///< all of its frame is unknown
};

/// What is unknown about the place of the platform that is measured.
enum class MeasuredTarget {
  known,  ///< nothing
  point,  ///< the point
  rigid   ///< the point and its axes
};

/// What is known of the fitted errors before anything is measured.
enum class PriorKnowledge {
  none,       ///< nothing: least squares
  tolerances  ///< their distributions in [errors]
};

/// The standard deviations of measured values.
enum class NoiseLevel {
  given,     ///< as stated
  estimated  ///< as stated up to one factor, which follows from the residual
};

/// The standard deviation of values that are measured of one quantity.
struct StatedNoise {
  std::string what;  ///< name of a response, or "distance"
  double sd;         ///< SI, at least 0
};

/// An expression in parameters of the geometry and fitted errors.
struct ControllerNumber {
  std::string name;  ///< name in the controller
  std::string text;  ///< the expression
  Place place;       ///< of the expression
};

/// The table [analysis.calibration].
struct CalibrationTable {
  std::vector<FittedErrors> fit;                           ///< [k], no two of the same direction
  std::vector<std::string> measured = {};                  ///< responses, "pose" or "distance", for studies
  std::vector<StatedNoise> noise = {};                     ///< noise of measured quantities
  std::optional<PoseSelection> poses = std::nullopt;       ///< poses of measurements in studies; none: the study's
  std::vector<std::array<std::size_t, 2>> pairs = {};      ///< poses between which distances are measured
  std::size_t repeats = 1;                                 ///< each value is the mean of so many
  MeasuringFrame frame = MeasuringFrame::known;            ///< the place of the measuring device
  MeasuredTarget target = MeasuredTarget::known;           ///< what is measured of the platform
  PriorKnowledge prior = PriorKnowledge::none;             ///< what is known of the fitted errors
  NoiseLevel sd = NoiseLevel::given;                       ///< whether the noise is known
  std::vector<std::string> coordinates = {};               ///< commanded coordinates; empty: those of the pose
  std::vector<std::vector<std::string>> motors = {};       ///< drives that move together; empty: each is one
  std::vector<double> present = {};                        ///< [k] in the controller while it measured, SI; empty: none
  std::vector<ControllerNumber> controller = {};           ///< numbers to be typed in
  std::size_t next = 0;                                    ///< poses to measure next
  std::optional<PoseSelection> candidates = std::nullopt;  ///< poses from which these are; none: the study's
  /// Errors whose distribution [errors] states and that the study varies, ascending.
  std::vector<FactorIndex> with_tolerance = {};
  Place place = {};              ///< for messages
  Place coordinates_place = {};  ///< for messages about coordinates and motors
};

std::string_view name(MeasuringFrame frame);   ///< The word in a study file.
std::string_view name(MeasuredTarget target);  ///< The word in a study file.
std::string_view name(PriorKnowledge prior);   ///< The word in a study file.
std::string_view name(NoiseLevel level);       ///< The word in a study file.

}  // namespace poesy
