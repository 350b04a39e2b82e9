#pragma once

#include <optional>
#include <variant>

#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/run/runner.h"
#include "engine/run/shard.h"
#include "engine/study/study.h"

namespace poesy {

/// What a study found, by its kind; CaseResult is that of kind "evaluate".
using StudyResult = std::variant<SensitivityResult, IdentificationResult, CaseResult, MonteCarloResult, CouplingResult>;

/// Runs a study of any kind at these poses; model is that of the study's mechanism. Empty when it was stopped, for a
/// shard, and on the ranks after rank 0.
std::optional<StudyResult> run_study(const Study& study, const Model& model, const PoseSet& poses,
                                     const RunOptions& options = {});

/// The same at the poses that the study selects, by the model that it names. Throws InputError as select_poses().
std::optional<StudyResult> run_study(const Study& study, const RunOptions& options = {});

/// Throws InputError unless the study, at so many poses, can be divided into so many shards.
void check_shard(const Shard& shard, const Study& study, std::size_t poses);

/// What became of the limits that the study states; empty where it states none.
std::optional<LimitVerdicts> verdicts_of(const StudyResult& result);

}  // namespace poesy
