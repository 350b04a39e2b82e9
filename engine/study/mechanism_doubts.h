#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/study/study.h"

namespace poesy {

/// A clause as a question to the user: "CLAUSE; is that meant?"
std::string asked_back(std::string_view clause);

/// Questions about the values that a study gives to parameters of the geometry, one line each: a value of the other
/// sign than the mechanism's own value, or one that is more than ten times larger or smaller. A value of zero raises no
/// question.
std::vector<std::string> geometry_doubts(const MechanismChoice& mechanism);

/// Questions about the mechanism of a study, one line each: geometry_doubts(), and what is unusual in the geometry
/// (Model::unusual_geometry). model: the mechanism.
std::vector<std::string> mechanism_doubts(const MechanismChoice& mechanism, const Model& model);

/// Questions about the boxes in which a study seeks poses, one line each: a box that looks as if a sign or a unit were
/// wrong (unusual_workspace()). poses: the poses that [poses] selects.
std::vector<std::string> workspace_doubts(const Study& study, const PoseSet& poses);

/// Questions about the sizes of drawn errors, one for lengths and one for angles: the first standard deviation of more
/// than a tenth of Model::error_bound(), for angles of more than 10 deg. An allocation finds sizes itself, so it raises
/// none. model: the mechanism of the study.
std::vector<std::string> size_doubts(const Study& study, const Model& model);

/// A warning if the study corrects the drives at each pose (`calibrated = true`), which is best for the points of
/// Model::metric_points(), but limits the displacement of a point far from them. Far means that their root mean square
/// distance from this point is more than a twentieth of the largest distance of a joint from it. Empty if there is
/// nothing to warn of, if the mechanism is not from a file, so that its points cannot be changed, or if its platform
/// has six freedoms, because the correction then leaves nothing at any point to first order. model: the mechanism of
/// the study.
std::string correction_doubt(const Study& study, const Model& model);

}  // namespace poesy
