#pragma once

#include <string>

#include "engine/app/exit_code.h"
#include "engine/run/result.h"
#include "engine/study/study.h"

namespace poesy::app {

/// The exit code of a command that is done. Where more samples failed than the study allows, says so on stderr: the
/// limit, the share reached, and `remedy`, where to look. study_path names the study.
ExitCode judge_failures(const Study& study, const SolveCounts& solves, const std::string& study_path,
                        const std::string& remedy);

}  // namespace poesy::app
