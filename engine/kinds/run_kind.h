#pragma once

#include <any>
#include <cstddef>
#include <optional>

#include "engine/run/outlook.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/study/study.h"

namespace poesy {

/// What a study found.
struct StudyResult {
  std::any found;                         ///< of the kind's own type: SensitivityResult, for instance
  std::optional<LimitVerdicts> verdicts;  ///< what became of the limits that the study states; empty without any

  /// What was found. Precondition: it is of this type.
  template <class Found>
  const Found& as() const {
    return std::any_cast<const Found&>(found);
  }
};

/// A study that is run. Refers to all of it.
struct StudyRun {
  const Study& study;         ///< what is asked
  const Model& model;         ///< of its mechanism
  const PoseSet& poses;       ///< that it selects
  const RunOptions& options;  ///< with checkpoints

  /// Those of the options, which are there.
  Checkpoints& checkpoints() const { return *options.checkpoints; }
  /// Whether this process makes the result out of what was solved: of several ranks the first.
  bool makes_result() const { return options.team == nullptr || options.team->leads(); }
};

/// How studies of a kind are run.
struct RunKind {
  /// Runs a study. Empty when it was stopped, for a shard, and on the ranks after rank 0.
  std::optional<StudyResult> (*run)(const StudyRun&);
  /// Counts what a run would do, without doing it.
  Outlook (*outlook)(const Study&, const Model&, const PoseSet&);
  /// Into how many shards a study at so many poses divides at the most; null: its steps need all poses.
  std::size_t (*most_shards)(const Study&, std::size_t poses);
};

/// A study divides at its poses.
inline std::size_t shards_by_pose(const Study&, std::size_t poses) { return poses; }

}  // namespace poesy
