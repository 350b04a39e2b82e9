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

/// What a kind of study promises. Each has a folder, with a row of this type beside its run.
namespace poesy {

/// What a study found.
struct StudyResult {
  std::any found;                         ///< of the kind's own type: SensitivityResult, for instance
  std::optional<LimitVerdicts> verdicts;  ///< what became of the limits that the study states; empty without any
  std::vector<std::string> row_names;     ///< of the rows of errors that a verdict may speak of
  std::optional<Study> confirming = std::nullopt;  ///< that anyone may run to confirm what was found; or nothing

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
  bool confirms = false;  ///< whether it writes a study beside the result that confirms it
};

/// A study divides at its poses.
inline std::size_t shards_by_pose(const Study&, std::size_t poses) { return poses; }

/// Solves of errors that were given and not drawn: how they are addressed, and their errors. Refers to the result.
struct GivenErrors {
  std::string_view word;           ///< for what a name stands: "case"
  std::vector<std::string> names;  ///< that there are
  std::size_t samples = 0;         ///< solves with a number at each pose; 0: the name's position is its row of errors
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< of poses with rows: a row is a sample, or a pose
  std::span<const double> values;                        ///< [rows x P] SI
};

/// Which tolerances are asked for, as the command line says it.
struct TolerancesOptions {
  std::string result;                    ///< path of the result
  std::string response;                  ///< that they are for; empty: none was named
  std::optional<std::string> limit;      ///< on the root mean square of the response: "0.05 mm"
  std::optional<std::string> reference;  ///< the error from which equal effects are counted: "NAME" or "NAME=0.1 mm"
  std::string folder;                    ///< for what is written; empty: RESULT_tolerances
  bool extrapolate = false;              ///< although an index changes with size
};

/// How a kind of study sets tolerances: writes them with the studies that test them, and gives what `poesy tolerances`
/// prints, broken at `width`. Throws InputError, FileError.
using SetTolerances = std::string (*)(const StoredResult& result, const TolerancesOptions& options,
                                      const Catalog& catalog, std::size_t width);

/// A kind of study: how its studies are read, run, stored and shown.
struct Kind {
  const StudyKind& study;    ///< what it adds to study files
  RunKind run;               ///< how its studies are run
  const FileKind& file;      ///< how files keep what they found
  const ReportKind& report;  ///< how tables and reports show it
  /// Its solves one by one; null: they were drawn, or they have no addresses.
  GivenErrors (*given_errors)(const StoredResult& result) = nullptr;
  SetTolerances set_tolerances = nullptr;  ///< null: it has no tolerances
};

}  // namespace poesy
