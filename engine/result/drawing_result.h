#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/array.h"

namespace poesy {

namespace axis {
using Feature = Axis<"feature">;  ///< Features of a drawing, of all limbs.
}  // namespace axis

/// What the features of a drawing do in their zones, to first order; SI. Only features whose errors vary, and nothing
/// of other errors. NaN for a response that is neither signed nor the norm of signed ones, and where a pose is not
/// solved.
struct DrawingResult {
  /// A text for each feature.
  using Texts = Array<std::string, axis::Feature>;
  /// A number for each feature.
  using Sizes = Array<double, axis::Feature>;
  /// A number for each response and feature, over the poses.
  using OfFeatures = Array<double, axis::Response, axis::Feature>;
  /// A number for each response and pose.
  using AtPoses = Array<double, axis::Response, axis::Pose>;

  std::vector<std::string> names;            ///< "rail_1"
  Texts label;                               ///< "rail"
  Array<std::uint64_t, axis::Feature> limb;  ///< from 1
  Texts kind;                                ///< "axis", "rectangle", "round", "point" or "distance"
  Sizes length;                              ///< length of an axis, first side or diameter of a plane; else 0
  Texts location;                            ///< key of the zone of location, "tolerance" or "clearance"; "-": none
  Sizes location_zone;                       ///< as written
  Texts location_datums;                     ///< "A|B"; "-": none
  Texts orientation;                         ///< key of the zone of orientation; "-": none
  Sizes orientation_zone;                    ///< as written
  Texts orientation_datums;                  ///< "A"; "-": none
  Sizes sigmas;                              ///< half a zone in standard deviations
  OfFeatures effect;                         ///< root mean square over the poses
  OfFeatures share;                          ///< of the mean square of all features together
  AtPoses rms;                               ///< root mean square of all features, locations divided evenly
  AtPoses rms_worst_division;                ///< the same with each location divided at worst
  AtPoses worst_case;                        ///< largest value with all features in their zones
  OfFeatures worst_share;                    ///< each feature's part of it at the pose where it is largest

  std::size_t features() const { return names.size(); }  ///< Their number.
};

}  // namespace poesy
