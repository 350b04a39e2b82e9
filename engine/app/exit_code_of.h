#pragma once

#include <functional>
#include <string>

#include "engine/app/exit_code.h"

namespace poesy::app {

/// Says what is wrong on stderr; the code. Under a launcher the first process alone speaks, for all have the same to
/// say.
int complain(const std::string& problem, ExitCode code);

/// The action's exit code; that of what it throws, which is said on stderr.
int exit_code_of(const std::function<int()>& action);

}  // namespace poesy::app
