#pragma once

#include <string>
#include <vector>

#include "engine/result/result_file.h"

namespace poesy {

/// Notes on limits that are more than 30 times larger or smaller than the root mean square of their response, if all
/// machines or no machine is good. The likely cause is a limit or a sigma in a wrong unit. Limits on a spread are left
/// out. Precondition: the result is that of a Monte Carlo study.
std::vector<std::string> far_limit_notes(const StoredResult& result);

}  // namespace poesy
