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

/// The interface of a kind of study. Each kind has a folder that defines one object of type Kind.
namespace poesy {

/// The result of a study.
struct StudyResult {
  std::any found;  ///< the result, as the type that this kind of study defines, such as sensitivity::Result
  std::optional<LimitVerdicts> verdicts;  ///< verdicts on the limits that the study states; empty without limits
  std::vector<std::string> row_names;  ///< names of the rows of the study's table of errors; a verdict may name a row
  /// A study that confirms the result with machines that were not used to find it; none if RunKind::confirms is false.
  std::optional<Study> confirming = std::nullopt;
  /// Effects of the features of the mechanism's drawing on the responses; none if no feature scatters.
  std::optional<DrawingResult> drawing = std::nullopt;
  /// [machines] 1 if the machine is rejected, otherwise 0. Empty without limits or without RunOptions::keep_rejected.
  /// Result files do not contain this list.
  std::vector<std::uint8_t> rejected = {};

  /// The result as this type. Precondition: `found` has this type.
  template <class Found>
  const Found& as() const {
    return std::any_cast<const Found&>(found);
  }
};

/// A study with everything that a run of it needs. The objects to which the members refer must outlive this one.
struct StudyRun {
  const Study& study;         ///< the study
  const Model& model;         ///< the model of the study's mechanism
  const PoseSet& poses;       ///< the poses that the study selects
  const RunOptions& options;  ///< threads, ranks, progress and checkpoints

  /// The run's checkpoints. Precondition: options.checkpoints is set.
  Checkpoints& checkpoints() const { return *options.checkpoints; }
  /// Whether this process returns the result. Of several ranks, only rank 0 does.
  bool makes_result() const { return options.team == nullptr || options.team->leads(); }
};

/// How studies of a kind are run.
struct RunKind {
  /// Runs a study. Returns nothing if the run was stopped, for a shard, and on ranks other than rank 0.
  std::optional<StudyResult> (*run)(const StudyRun&);
  /// Estimates the work of a run without running the study.
  Outlook (*outlook)(const Study&, const Model&, const PoseSet&);
  /// The largest number of shards for a study at this many poses; null if the kind cannot be divided into shards.
  std::size_t (*most_shards)(const Study&, std::size_t poses);
  bool confirms = false;  ///< whether StudyResult::confirming is set
};

/// The value of RunKind::most_shards for kinds whose shards are groups of poses.
inline std::size_t shards_by_pose(const Study&, std::size_t poses) { return poses; }

/// The errors of a result if the study states them instead of drawing them. A user of `poesy replay` names a solve by
/// the pose, and by the number or the name of a row of errors. Keeps a reference to the result.
struct GivenErrors {
  std::string_view word;           ///< what messages call a named row: "case"
  std::vector<std::string> names;  ///< names of the rows; empty if the rows have no names
  /// Number of solves at each pose if users name a solve by its number at the pose; 0 if they name it by its row of
  /// errors.
  std::size_t samples = 0;
  Pairing pairing = Pairing::every_pose_with_every_row;  ///< how poses and rows are combined
  std::span<const double> values;                        ///< [rows x errors of the result] values of the errors, SI
};

/// The options of `poesy tolerances`.
struct TolerancesOptions {
  std::string result;    ///< path of the result
  std::string response;  ///< name of the response for which tolerances are set; empty if the user names none
  std::optional<std::string> limit;  ///< limit on the root mean square of the response, such as "0.05 mm"
  /// Reference error, "NAME" or "NAME=0.1 mm": each tolerance is set so that its effect equals that of the tolerance of
  /// this error.
  std::optional<std::string> reference;
  std::string folder;        ///< folder for the files; if empty, NAME_tolerances for the result NAME.h5
  bool extrapolate = false;  ///< whether to set tolerances even if a sensitivity index changes with the
                             ///< size of the error
};

/// Sets tolerances from a result: writes them into a folder, with the studies that test them. Returns the output of
/// `poesy tolerances`, wrapped at `width` columns. Throws InputError, FileError.
using SetTolerances = std::string (*)(const StoredResult& result, const TolerancesOptions& options,
                                      const Catalog& catalog, std::size_t width);

/// A kind of study: how its studies are read, run, stored and shown.
struct Kind {
  const StudyKind& study;    ///< the keys of its study files
  RunKind run;               ///< how its studies are run
  const FileKind& file;      ///< how its results are stored
  const ReportKind& report;  ///< how tables and reports show its results
  /// Returns the errors that the study of a result states. Null if the kind draws errors, or if `poesy replay` cannot
  /// repeat its solves.
  GivenErrors (*given_errors)(const StoredResult& result) = nullptr;
  SetTolerances set_tolerances = nullptr;  ///< null if the kind sets no tolerances
};

}  // namespace poesy
