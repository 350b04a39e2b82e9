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

}  // namespace poesy
