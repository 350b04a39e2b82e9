#pragma once

#include <optional>

#include "engine/kinds/kind.h"
#include "engine/model/model.h"
#include "engine/run/outlook.h"
#include "engine/run/run_options.h"
#include "engine/run/shard.h"
#include "engine/study/study.h"

namespace poesy {

/// Runs a study of any kind at these poses. model: model of the study's mechanism. Returns nothing if the run was
/// stopped, for a shard, and on ranks other than rank 0.
std::optional<StudyResult> run_study(const Study& study, const Model& model, const PoseSet& poses,
                                     const RunOptions& options = {});

/// Runs a study at the poses that it selects, with the model that it names. Throws InputError as select_poses() does.
std::optional<StudyResult> run_study(const Study& study, const RunOptions& options = {});

/// Estimates the work of a run without running the study. The result keeps references to all arguments.
Outlook outlook(const Study& study, const Model& model, const PoseSet& poses);

/// Throws InputError if the study, at this number of poses, cannot be divided into as many shards as `shard.count`.
void check_shard(const Shard& shard, const Study& study, std::size_t poses);

}  // namespace poesy
