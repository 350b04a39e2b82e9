#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"

namespace poesy {

/// A clause as a question to the user: "CLAUSE; is that meant?"
std::string asked_back(std::string_view clause);

/// Questions about a mechanism whose geometry is unusual (Model::unusual_geometry), one line each.
std::vector<std::string> mechanism_doubts(const Model& model);

}  // namespace poesy
