#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/array.h"

namespace poesy {

namespace axis {
using Feature = Axis<"feature">;  ///< The features of a drawing, over all limbs.
}  // namespace axis

/// The first-order effect of the features of a drawing on the responses, if the features scatter in their tolerance
/// zones; SI. Features whose errors the study does not vary, and errors that belong to no feature, are left out. Values
/// are NaN for a response that is neither signed nor the norm of signed responses, and if a pose is not solved.
///
/// `share`, `rms` and `rms_worst_division` are NaN if the study correlates errors of features, because they count the
/// errors as independent.
struct DrawingResult {
  /// A text for each feature.
  using Texts = Array<std::string, axis::Feature>;
  /// A number for each feature.
  using Sizes = Array<double, axis::Feature>;
  /// A number for each response and feature, which summarises all poses.
  using OfFeatures = Array<double, axis::Response, axis::Feature>;
  /// A number for each response and pose.
  using AtPoses = Array<double, axis::Response, axis::Pose>;

  std::vector<std::string> names;            ///< names of the features with their limbs: "rail_1"
  Texts label;                               ///< names of the features in the drawing: "rail"
  Array<std::uint64_t, axis::Feature> limb;  ///< number of the limb, from 1
  Texts kind;                                ///< kind of feature: "axis", "rectangle", "round", "point" or "distance"
  Sizes length;                              ///< m, length of an axis, first side or diameter of a face; else 0
  Texts location;       ///< zone of location: its key, "tolerance" for a distance, or "clearance"; "-": none
  Sizes location_zone;  ///< m, width or diameter of the zone of location; t for a distance with the tolerance +-t; for
                        ///< a clearance the largest value
  Texts location_datums;     ///< datums of the zone of location: "A|B"; "-": none
  Texts orientation;         ///< key of the zone of orientation; "-": none
  Sizes orientation_zone;    ///< m, width or diameter of the zone of orientation on the drawing
  Texts orientation_datums;  ///< datums of the zone of orientation: "A"; "-": none
  /// Half of a zone divided by the standard deviation of a coordinate of an extreme point (end of an axis, corner of a
  /// plane); 0 for a clearance, and for uniform or boundary scatter.
  Sizes sigmas;
  OfFeatures effect;  ///< root mean square over the poses of the response if only this feature scatters
  OfFeatures share;   ///< share of this feature in the mean square of all features together
  /// Root mean square of the response from all features, if each zone of location is divided evenly between the errors
  /// that move the feature (middle) and those that turn it (tilt).
  AtPoses rms;
  /// Like `rms`, but if a feature has no zone of orientation, its zone of location is used by the middle alone or by
  /// the tilt alone, whichever is worse.
  AtPoses rms_worst_division;
  /// Largest magnitude of the response with all features in their zones; for a norm, the largest one that was found.
  AtPoses worst_case;
  OfFeatures worst_share;  ///< share of each feature in worst_case, at the pose where worst_case is largest

  std::size_t features() const { return names.size(); }  ///< The number of features.
};

}  // namespace poesy
