#pragma once

#include <any>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/model.h"
#include "engine/report/report_kind.h"
#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/run/outlook.h"
#include "engine/run/result.h"
#include "engine/run/run_options.h"
#include "engine/study/study.h"
#include "engine/study/study_kind.h"

/// The interface of a kind of study. Each kind has a folder, with a row of this type beside its run.
namespace poesy {

/// The result of a study.
struct StudyResult {
  std::any found;                         ///< of the kind's own type: SensitivityResult, for instance
  std::optional<LimitVerdicts> verdicts;  ///< verdicts on the limits that the study states; empty without limits
  std::vector<std::string> row_names;     ///< names of the rows of errors to which a verdict may refer
  std::optional<Study> confirming = std::nullopt;       ///< a study that confirms the result, if there is one
  std::optional<DrawingResult> drawing = std::nullopt;  ///< what features do, if they scatter in their zones

  /// The result. Precondition: it is of this type.
  template <class Found>
  const Found& as() const {
    return std::any_cast<const Found&>(found);
  }
};

/// A study that is run. Refers to all members.
struct StudyRun {
  const Study& study;         ///< the study
  const Model& model;         ///< the model of its mechanism
  const PoseSet& poses;       ///< the poses that it selects
  const RunOptions& options;  ///< threads, ranks, progress and checkpoints

  /// The run's checkpoints. Precondition: options.checkpoints is set.
  Checkpoints& checkpoints() const { return *options.checkpoints; }
  /// Whether this process makes the result: of several ranks only the first does.
  bool makes_result() const { return options.team == nullptr || options.team->leads(); }
};

/// How studies of a kind are run.
struct RunKind {
  /// Runs a study. Empty when it was stopped, for a shard, and on the ranks after rank 0.
  std::optional<StudyResult> (*run)(const StudyRun&);
  /// Estimates the work of a run without doing it.
  Outlook (*outlook)(const Study&, const Model&, const PoseSet&);
  /// The largest number of shards of a study at this many poses; null: its steps need all poses.
  std::size_t (*most_shards)(const Study&, std::size_t poses);
  bool confirms = false;  ///< whether it writes a study that confirms the result
};

/// The most_shards of a kind that is divided by poses.
inline std::size_t shards_by_pose(const Study&, std::size_t poses) { return poses; }

/// The solves of errors that were given instead of drawn: their addresses and errors. Refers to the result.
struct GivenErrors {
  std::string_view word;           ///< the word for what has a name: "case"
  std::vector<std::string> names;  ///< the names; empty if there are none
  std::size_t samples =
      0;  ///< number of solves at each pose, addressed by number; 0: the position of the name is the row of errors
  Pairing pairing =
      Pairing::every_pose_with_every_row;  ///< how poses and rows are paired: a row is a sample, or a pose
  std::span<const double> values;          ///< [rows x P] SI
};

/// The options of `poesy tolerances`.
struct TolerancesOptions {
  std::string result;                    ///< path of the result
  std::string response;                  ///< the response that they are for; empty: not named
  std::optional<std::string> limit;      ///< limit on the root mean square of the response: "0.05 mm"
  std::optional<std::string> reference;  ///< error relative to which equal effects are set: "NAME" or "NAME=0.1 mm"
  std::string folder;                    ///< folder for the files; empty: RESULT_tolerances
  bool extrapolate = false;              ///< whether to set tolerances although an index changes with size
};

/// How a kind of study sets tolerances: writes them with the studies that test them, and returns the output of `poesy
/// tolerances`, wrapped at `width`. Throws InputError, FileError.
using SetTolerances = std::string (*)(const StoredResult& result, const TolerancesOptions& options,
                                      const Catalog& catalog, std::size_t width);

/// A kind of study: how its studies are read, run, stored and shown.
struct Kind {
  const StudyKind& study;    ///< the keys of its study files
  RunKind run;               ///< how its studies are run
  const FileKind& file;      ///< how its results are stored
  const ReportKind& report;  ///< how tables and reports show its results
  /// The solves of given errors; null: errors are drawn, or solves have no addresses.
  GivenErrors (*given_errors)(const StoredResult& result) = nullptr;
  SetTolerances set_tolerances = nullptr;  ///< null: it sets no tolerances
};

}  // namespace poesy
