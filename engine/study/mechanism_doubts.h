#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// A clause as a question to the user: "CLAUSE; is that meant?"
std::string asked_back(std::string_view clause);

/// Questions about the values that a study gives to parameters of the geometry, one line each. A value is questioned if
/// its sign differs from that of the published value (for a mechanism from a file, the file's value), or if it is ten
/// times larger or smaller, or more. If the published value is zero, there is no question.
std::vector<std::string> geometry_doubts(const MechanismChoice& mechanism);

/// Questions about the mechanism of a study, one line each: geometry_doubts(), and one for each property in
/// Model::unusual_geometry(). model: the mechanism.
std::vector<std::string> mechanism_doubts(const MechanismChoice& mechanism, const Model& model);

/// Questions about the boxes in which a study seeks poses, one line each: a box that looks as if a sign or a unit were
/// wrong (unusual_workspace()); and one about a response that is relative to a pose outside the mechanism's workspace.
/// poses: the poses that [poses] selects.
std::vector<std::string> workspace_doubts(const Study& study, const PoseSet& poses);

/// Questions about the standard deviations of drawn errors, at most one for lengths and one for angles. A question
/// names the first error whose standard deviation is more than a tenth of Model::error_bound() or, for an angle, more
/// than an eighteenth of it (10 deg if the bound is half a turn). A further question is about the first value of given
/// machines that is more than half of the bound, because it may be a size instead of a deviation. There are no
/// questions if the kind of study varies no errors or has StudyKind::finds_sizes. model: the mechanism of the study.
std::vector<std::string> size_doubts(const Study& study, const Model& model);

/// A question if the first pose of a study and one of up to 40 other poses that are tried are on different sides of
/// singular poses (Model::are_separated()); empty if not.
std::string sides_doubt(const Model& model, const PoseSet& poses);

/// A question if features of the drawing vary with the size of all lengths although they have zones
/// (ErrorModel::unused_zone); empty if there are none.
std::string zones_doubt(const Study& study);

/// A warning if the study corrects the drives at each pose (`calibrated = true`), but limits the displacement of a
/// point that is far from the points for which this correction is best (Model::metric_points()). A point is far from
/// them if their root mean square distance from the point is more than a twentieth of the distance from the point to
/// the farthest joint. Empty if no such point is limited. Also empty if the mechanism is not from a file, because its
/// points cannot be changed, or if its platform has six degrees of freedom, because the correction then removes the
/// displacement of every point to first order. model: the mechanism of the study.
std::string correction_doubt(const Study& study, const Model& model);

}  // namespace poesy
