#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/progress.h"
#include "engine/app/results.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/kind.h"
#include "engine/kinds/study_file.h"
#include "engine/report/frames_table.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "engine/result/described.h"
#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/run/outlook.h"
#include "engine/run/rows_within.h"
#include "engine/run/run_options.h"
#include "engine/storage/checkpoint.h"
#include "engine/study/bare_numbers.h"
#include "engine/study/study_file.h"
#include "engine/study/study_kind.h"
#include "engine/study/table_file.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

constexpr std::array<std::string_view, 3> kForms{"text", "json", "csv"};

struct EvaluateOptions {
  std::string study;
  std::string poses;  ///< path of the file of poses; empty: the study selects the poses
  std::string errors;
  /// Form in which the table of the mechanism's frames is printed, one of kForms; empty: the command solves errors
  /// instead.
  std::string frames;
  std::string result;
  std::size_t threads = 0;
  bool paired = false;
  bool quiet = false;
};

/// Warns of poses that are nearly singular. Such poses are not refused here, because the status of each sample tells
/// how its solve ended.
void warn_of_singular_poses(const std::string& path, const SelectedPoses& poses, double max_condition) {
  for (std::size_t m = 0; m < poses.condition.size(); ++m) {
    if (poses.condition[m] <= max_condition) continue;
    say(Message::warning, fmt::format("{}:{}: pose {} is singular or nearly so (condition number {:.3g})", path, m + 2,
                                      m + 1, poses.condition[m]));
  }
}

/// Prints a warning, unless it is empty.
void warn_of(const std::string& doubt) {
  if (!doubt.empty()) say(Message::warning, doubt);
}

/// Reads the poses of a file and warns of nearly singular ones.
SelectedPoses read_reachable_poses(const std::string& path, const Model& model) {
  PoseSelection selection;
  const double max_condition = std::exchange(selection.max_condition, std::numeric_limits<double>::infinity());
  selection.select = PoseSelection::Select::file;
  selection.file = path;
  selection.from_file = read_poses(path, model.description());
  selection.place = {path, 2, 0};
  SelectedPoses poses = select_poses(selection, model);
  warn_of_singular_poses(path, poses, max_condition);
  warn_of(outside_pose_text(path, selection.from_file, poses.poses, model.description()));
  return poses;
}

/// The poses of the file that the user names, or, if the user names none, the poses that the study selects; none if the
/// user stopped the search for them.
std::optional<SelectedPoses> poses_of(const EvaluateOptions& options, const Study& study, const Model& model) {
  if (!options.poses.empty()) {
    warn_of_mechanism(study, model);
    return read_reachable_poses(options.poses, model);
  }
  auto poses = find_poses(study, model, {.quiet = options.quiet, .stop = &catch_interrupts()});
  if (!poses) return std::nullopt;
  for (const std::string& doubt : all_doubts(study, model, *poses)) warn_of(doubt);
  return poses;
}

/// Tells the user that the command was stopped, and returns the exit code.
int interrupted() {
  say(Message::note, "interrupted; nothing was written");
  return kInterrupted;
}

/// Prints the frames of the mechanism without errors at these poses.
int print_frames(const EvaluateOptions& options, const Model& model, const PoseSet& poses) {
  if (std::ranges::find(kForms, options.frames) == kForms.end()) {
    throw InputError({}, "--frames: '" + printable(options.frames) + "' is not a form of a table",
                     suggestion(options.frames, kForms));
  }
  const std::optional<Table> table = frames_table(model, poses);
  if (!table) {
    throw InputError({}, "'" + model.description().name + "' does not say where its frames are", "leave out --frames");
  }
  print(options.frames == "json"  ? json_of(*table)
        : options.frames == "csv" ? csv_of(*table)
                                  : text_of(*table, output_width()));
  return kDone;
}

/// Throws InputError if there would be more solves than a result may have (kMostCells).
void check_size(const EvaluateOptions& options, const PoseSet& poses, const ErrorTable& errors) {
  if (options.paired) return;  // each row is solved at one pose, so there are no more solves than rows
  const double solves = static_cast<double>(poses.size()) * static_cast<double>(errors.rows);
  if (solves <= static_cast<double>(kMostCells)) return;
  throw InputError({options.errors},
                   fmt::format("{} rows of errors at {} poses are {} solves, but a result holds at most {}",
                               errors.rows, poses.size(), poses.size() * errors.rows, kMostCells),
                   "give fewer rows or poses, or --paired for row by row");
}

/// The input of an evaluation. The objects to which it refers must outlive it.
struct Evaluated {
  const Study& study;
  const Model& model;
  const SelectedPoses& poses;
  const ErrorTable& errors;
  Pairing pairing;
};

/// The memory for the outcomes and the errors of an evaluation, bytes.
std::size_t memory_of(const Evaluated& all) {
  const std::size_t rows = all.pairing == Pairing::row_by_row ? 1 : all.errors.rows;
  const std::size_t outcomes = outcome_bytes(all.model.description(), Outcomes::with_details);
  return all.poses.poses.size() * rows * outcomes + all.errors.values.size() * sizeof(double);
}

/// Solves the errors, prints and judges the outcomes, and returns the exit code. path: path to which the result is
/// written; empty: no result is written.
int solve(const EvaluateOptions& options, const Evaluated& all, const std::string& path) {
  const auto& [study, model, poses, errors, pairing] = all;
  const auto start = std::chrono::steady_clock::now();
  const std::size_t threads = resolved_threads(options.threads);
  std::optional<EvaluationResult> result;
  {
    ProgressPrinter printer(options.quiet);
    result = run_evaluation(model, study.solver, poses.poses, errors, pairing,
                            {.threads = threads,
                             .progress = [&](const Progress& progress) { printer(progress); },
                             .stop = &catch_interrupts()});
  }
  const double seconds = seconds_since(start);
  if (!result) return interrupted();
  const SolveCounts total = result->total();
  std::vector<std::uint8_t> within;
  if (const auto& limits = study.analysis.limits; !limits.empty()) {
    result->verdicts = judge_rows(limits, *result, pairing, study.not_converged);
    within = rows_within(limits, *result, pairing, study.not_converged);
  }
  evaluate::Evaluation found = evaluate::evaluation(*std::move(result), errors, pairing, model.description());
  found.within_limits = std::move(within);
  StoredResult shown = described(study, model, poses);
  shown.verdicts = found.solves.verdicts;
  shown.row_names = evaluate::row_names(errors.labels, pairing, errors.rows);
  shown.headline = chosen_or_all({}, shown.responses.size());
  if (!path.empty()) {
    evaluate::write_evaluation(path, study, poses, errors.factors, found, run_facts(seconds, threads, total.total()));
  }
  shown.found = std::move(found);
  warn_each(options.study, evaluate::kReport.far_limits(shown));
  print(fmt::format("{} solves, {}\n\n{}", total.total(), unsolved_in_short(total),
                    text_of(evaluate::evaluation_table(shown), output_width())));
  if (path.empty()) {
    return judge(study, total, shown, options.study,
                 {"-o RESULT.h5 keeps the result", "run it again with -o RESULT.h5 to see which failed"});
  }
  return judge(study, total, shown, options.study,
               {"the result is kept; see /limits in " + path, "the result is kept: see /evaluate/status in " + path});
}

/// Throws InputError if a response is relative to the previous pose, because with --paired the errors differ from pose
/// to pose.
void refuse_pose_before(const Study& study) {
  for (const OwnResponse& own : study.mechanism.responses) {
    if (!own.relative_to || !own.relative_to->is_previous()) continue;
    throw InputError(own.relative_to->place,
                     "'" + own.name + "' is relative to the pose before, which has other errors with --paired",
                     "leave out --paired or this response, or write relative_to = a pose");
  }
}

int evaluate(const EvaluateOptions& options) {
  const StudyUse use = options.poses.empty() ? StudyUse::evaluate_at_poses : StudyUse::evaluate;
  const Study study = read_study(options.study, registry(), use);
  if (study.mechanism.compared) {
    throw InputError(study.mechanism.place, "mechanism.fidelity is \"both\", but an evaluation solves at one fidelity",
                     fmt::format("write \"{}\"", fmt::join(study.model().fidelities, "\" or \"")));
  }
  if (options.paired) refuse_pose_before(study);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const std::optional<SelectedPoses> poses = poses_of(options, study, *model);
  if (!poses) return interrupted();
  if (!options.frames.empty()) return print_frames(options, *model, poses->poses);
  const ErrorTable errors = read_errors(options.errors, *model);
  for (const std::string& doubt : error_table_doubts(options.errors, errors, study)) warn_of(doubt);
  if (options.paired && poses->poses.size() != errors.rows) {
    throw InputError({options.errors}, fmt::format("{} rows of errors for {} poses", errors.rows, poses->poses.size()),
                     "--paired needs one row of errors for each pose");
  }
  if (options.paired && any_over_poses(study.analysis.limits)) {
    throw InputError({options.study}, "a limit is over the poses of a machine, but --paired has each row at one pose",
                     "leave out --paired, or write a limit at each pose");
  }
  check_size(options, poses->poses, errors);
  std::string path;
  std::optional<RunLock> lock;
  if (!options.result.empty()) {
    std::vector<std::string> inputs = inputs_of(options.study, study);
    inputs.push_back(options.errors);
    if (!options.poses.empty()) inputs.push_back(options.poses);
    path = check_result_path(options.result, inputs);
    lock.emplace(path);
  }
  const Pairing pairing = options.paired ? Pairing::row_by_row : Pairing::every_pose_with_every_row;
  const Evaluated all{study, *model, *poses, errors, pairing};
  try {
    return solve(options, all, path);
  } catch (const std::bad_alloc&) {
    throw too_little_memory(path, "this evaluation", memory_text(memory_of(all)));
  }
}

}  // namespace

Command& add_evaluate(Command& program) {
  const auto [command, options] = program.add_command("evaluate", "solve errors that somebody else sampled", evaluate);
  command
      .add_value("study", options.study, "STUDY.toml",
                 "study file; its [mechanism] and [solver] are used, and [poses] without --poses")
      ->required();
  command.add_value("--poses", options.poses, "P.csv",
                    "poses; the first line names the pose coordinates, with units (\"z [mm]\") or SI; default: those "
                    "of the study");
  CLI::Option* errors = command.add_value(
      "--errors", options.errors, "E.csv",
      "errors, a row is a sample; the first line names the factors, with units or SI; a column \"part\" "
      "(or name, serial, id, Part No., Teil, ...) names the rows, else the first column of different texts");
  errors->required();
  command
      .add_value(
          "--frames", options.frames, "FORM",
          "print where joints and frames are at these poses without errors, and solve nothing; FORM: " + either(kForms))
      ->each([errors](const std::string&) { errors->required(false); })
      ->excludes(errors);
  command.add_flag("--paired", options.paired, "row by row, instead of every pose with every row");
  command.add_value("-o,--output", options.result, "RESULT.h5", "result file; default: only the summary");
  command.add_whole_number("--threads", options.threads, "N", "number of threads; default: one per processor", 1, 1024);
  command.add_flag("--quiet", options.quiet, "no progress");
  command.examples = {
      {"every pose of the study with every row of errors", "poesy evaluate study.toml --errors e.csv"},
      {"every pose with every row of errors; prints the summary",
       "poesy evaluate study.toml --poses p.csv --errors e.csv"},
      {"the first pose with the first row, and so on; keeps every outcome",
       "poesy evaluate study.toml --poses p.csv --errors e.csv --paired -o r.h5"},
      {"where joints and frames are, without errors", "poesy evaluate study.toml --poses p.csv --frames csv"}};
  return command;
}

}  // namespace poesy::app
