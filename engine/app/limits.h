#pragma once

#include <optional>
#include <string>

#include "engine/app/exit_code.h"
#include "engine/io/result_file.h"

namespace poesy::app {

/// Prints PASS or FAIL for each limit of a result; the exit code. Where a limit is not kept, says so on stderr: which,
/// the value that was found, and `remedy`, where to look. study_path names the study.
ExitCode judge_limits(const StoredResult& result, const std::string& study_path, const std::string& remedy);

/// As much of a study's result as judge_limits needs.
StoredResult with_verdicts(const Study& study, const SelectedPoses& poses,
                           const std::optional<LimitVerdicts>& verdicts);

}  // namespace poesy::app
