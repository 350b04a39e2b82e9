#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/app/command_line.h"
#include "engine/app/expected_time.h"
#include "engine/app/long_run.h"
#include "engine/app/progress.h"
#include "engine/app/results.h"
#include "engine/app/resumable.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/kinds/study_file.h"
#include "engine/kinds/study_run.h"
#include "engine/kinds/sweep/kind.h"
#include "engine/kinds/sweep/sweep.h"
#include "engine/report/solves.h"
#include "engine/report/table.h"
#include "engine/result/checkpoint_identity.h"
#include "engine/result/described.h"
#include "engine/result/result_file.h"
#include "engine/run/run_options.h"
#include "engine/storage/content_hash.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

struct SweepOptions {
  std::string study;
  std::vector<std::string> set;
  std::string result;
  std::string response;
  std::size_t threads = 0;
  std::optional<std::uint64_t> seed;
  bool quiet = false;
  bool yes = false;  ///< true to start a long sweep without asking
  ResumeOptions resume;
  std::string program;  ///< name with which the program was called
};

/// The command line that starts this sweep again.
std::string start_command_of(const SweepOptions& options) {
  std::vector<std::string> words{options.program, "sweep", options.study};
  for (const std::string& set : options.set) words.insert(words.end(), {"--set", set});
  if (!options.response.empty()) words.insert(words.end(), {"--response", options.response});
  return start_command(std::move(words), options);
}

/// The values of a design in words: "mechanism.geometry.R = 260 mm". given: the keys that the sweep changes, with their
/// values.
std::string words_of(std::span<const GivenKey> given) {
  std::string text;
  for (const GivenKey& one : given) text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", one.key, one.value);
  return printable(text, 200);
}

/// Calls act(). If it throws InputError, the values of the design are put in front of the message.
template <class Act>
auto naming(std::span<const GivenKey> given, const Act& act) {
  try {
    return act();
  } catch (const InputError& error) {
    throw InputError({}, fmt::format("with {}: {}", words_of(given), error.what()), "");
  }
}

/// Reads the study file, with the values of a design for the keys that the sweep changes.
Study study_with(const SweepOptions& options, std::span<const GivenKey> given) {
  Study study = naming(given, [&] { return read_study(options.study, registry(), StudyUse::run, given); });
  if (options.seed) study.seed = *options.seed;
  return study;
}

/// Collects warnings of what looks like a mistake in the designs. If several designs give the same warning, it is kept
/// once, with the first of these designs.
class DesignDoubts {
 public:
  void add(std::span<const GivenKey> given, const std::vector<std::string>& doubts) {
    for (const std::string& doubt : doubts) {
      if (std::ranges::find(doubts_, doubt) != doubts_.end()) continue;
      doubts_.push_back(doubt);
      designs_.push_back(words_of(given));
    }
  }

  /// Prints the first kMost warnings.
  void warn() const {
    constexpr std::size_t kMost = 3;
    for (std::size_t n = 0; n < std::min(kMost, doubts_.size()); ++n) {
      say(Message::warning, fmt::format("with {}: {}", designs_[n], doubts_[n]));
    }
    if (doubts_.size() <= kMost) return;
    say(Message::warning,
        fmt::format("{} more warnings are not shown; 'poesy check' prints those of one study", doubts_.size() - kMost));
  }

 private:
  std::vector<std::string> doubts_;
  std::vector<std::string> designs_;  ///< [warnings] values of the design that gave the warning, in words
};

/// Makes the design with these values: its study and its poses. Adds to `doubts` what looks like a mistake in the
/// design (all_doubts()). None if the user stopped the search for poses.
std::optional<sweep::SweptDesign> design_of(const SweepOptions& options, const std::vector<GivenKey>& given,
                                            const std::atomic<bool>& stop, DesignDoubts& doubts) {
  Study study = study_with(options, given);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  auto poses = naming(given, [&] { return find_poses(study, *model, {.quiet = options.quiet, .stop = &stop}); });
  if (!poses) return std::nullopt;
  doubts.add(given, all_doubts(study, *model, *poses));
  return sweep::SweptDesign{given, std::move(study), *std::move(poses)};
}

/// Makes all designs of a grid of values. Adds what looks like a mistake in a design to `doubts`. None if the user
/// stopped the search for poses.
std::optional<std::vector<sweep::SweptDesign>> designs_of(const SweepOptions& options,
                                                          std::span<const std::vector<GivenKey>> grid,
                                                          const std::atomic<bool>& stop, DesignDoubts& doubts) {
  std::vector<sweep::SweptDesign> designs;
  ProgressLine line(options.quiet);
  for (const std::vector<GivenKey>& given : grid) {
    if (stop) return std::nullopt;
    if (line.is_due(ProgressLine::Clock::now())) {
      const std::string text = validation_line(designs.size(), grid.size());
      line.write([&] { return text; }, [&](std::size_t width) { return text.substr(0, width); });
    }
    std::optional<sweep::SweptDesign> design = design_of(options, given, stop, doubts);
    if (!design) return std::nullopt;
    designs.push_back(*std::move(design));
  }
  sweep::check_sweep(designs, options.study);
  return designs;
}

/// The identity of a sweep, by which its checkpoints are recognised: that of the first design, but with the studies and
/// the poses of all designs.
CheckpointIdentity identity_of(std::span<const sweep::SweptDesign> designs) {
  CheckpointIdentity all;
  std::string poses;
  for (const sweep::SweptDesign& design : designs) {
    const CheckpointIdentity own = poesy::identity_of(design.study, design.poses.poses);
    const std::string studies = all.study + own.study + "\n";
    if (poses.empty()) all = own;
    all.study = studies;
    poses += own.poses;
  }
  all.poses = hex(sha256(std::as_bytes(std::span(poses))));
  return all;
}

double seconds_of(std::span<const sweep::SweptDesign> designs, std::size_t threads) {
  const sweep::SweptDesign& first = designs.front();
  const std::unique_ptr<Model> model = build_model(first.study.mechanism);
  return seconds_of_long_run(first.study, *model, first.poses.poses, threads, designs.size());
}

/// Runs all designs. If the run fails, also tells the user whether the checkpoints are kept.
std::optional<sweep::Result> run_with_progress(const SweepOptions& options, std::span<const sweep::SweptKey> keys,
                                               std::span<const sweep::SweptDesign> designs, const std::string& path,
                                               RunOptions run, ResumableRun& resumable) {
  const auto act = [&]() -> std::optional<sweep::Result> {
    ProgressPrinter printer(options.quiet);
    run.progress = [&](const Progress& progress) {
      printer(progress);
      resumable.check_time();
    };
    const auto begin = [&](std::size_t d) { printer.begin_design(d + 1, designs.size()); };
    std::optional<sweep::Result> found = sweep::run_sweep(keys, designs, options.response, run, begin);
    if (!found) return std::nullopt;
    const SolveCounts solves = total_of(found->solves);
    const RunTime time = resumable.time();
    RunFacts facts = run_facts(time.wall, run.threads, solves.total() - solves.by_series());
    facts.by_series = solves.by_series();
    facts.checkpoint_seconds = time.checkpoints;
    write_result(path, sweep::kKind.study.name, sweep::kFile, designs.front().study, designs.front().poses, *found,
                 facts);
    print(fmt::format("{}: {} designs, {} in {:.2f} s on {} {}, {}\n", printable_line(path), designs.size(),
                      samples_text(facts), facts.wall_seconds, facts.threads, facts.threads == 1 ? "thread" : "threads",
                      unsolved_in_short(solves)));
    print(
        fmt::format("Written: {}, with what the tables below show. The whole results of the designs are not written.\n",
                    printable_line(path)));
    return found;
  };
  const auto too_little = [&] {
    const sweep::SweptDesign& first = designs.front();
    const std::unique_ptr<Model> model = build_model(first.study.mechanism);
    return too_little_memory(path, "this sweep",
                             memory_text(outlook(first.study, *model, first.poses.poses).memory.peak()));
  };
  return run_to_end(resumable, act, too_little);
}

/// Prints the table of the designs, and returns the exit code. path: path of the result.
int report(const SweepOptions& options, const sweep::SweptDesign& first, const sweep::Result& found,
           const std::string& path) {
  StoredResult result = described(first.study, *build_model(first.study.mechanism), first.poses);
  result.kind = sweep::kKind.study.name;
  result.found = found;
  print("\n" + text_of(sweep::kReport.tables(result, {}), output_width()));
  std::vector<std::string> failed;
  for (std::size_t d = 0; d < found.designs(); ++d) {
    if (share_not_converged(found.solves[d]) > first.study.max_not_converged)
      failed.push_back(sweep::design_name(found, d));
  }
  if (!failed.empty()) {
    return complain(fmt::format("{}: more samples did not converge than solver.max_not_converged allows in {} of {} "
                                "designs, first {}; {} is written",
                                options.study, failed.size(), found.designs(), failed.front(), printable(path)),
                    kTooManyNotConverged);
  }
  if (std::ranges::any_of(found.verdict.all(), [](const std::string& verdict) { return verdict != "not kept"; })) {
    return kDone;
  }
  return complain(options.study + ": every design is beyond a limit of the study; " + printable(path) + " is written",
                  kLimitNotKept);
}

int interrupted(const ResumableRun& resumable) {
  resumable.explain_interruption();
  return kInterrupted;
}

/// Throws InputError if a swept key names a parameter of the mechanism's geometry, but lacks "geometry." in front of
/// the name, or a unit after the values. model: the study's mechanism.
void check_geometry_key(const std::string& set, const sweep::SweptKey& swept, const ModelDescription& model) {
  constexpr std::string_view kTable = "mechanism.geometry.";
  const bool is_whole = swept.key.starts_with(kTable);
  const std::string name = is_whole ? swept.key.substr(kTable.size()) : swept.key;
  const auto parameter = std::ranges::find(model.geometry, name, &GeometryParameter::name);
  if (parameter == model.geometry.end()) return;
  if (!is_whole) {
    throw InputError({}, "--set " + printable(set) + " names a parameter of the mechanism's geometry",
                     "write geometry." + printable(set));
  }
  const auto is_bare = [](const std::string& value) { return parse_number(value).has_value(); };
  if (parameter->dimension == Dimension::number || !std::ranges::all_of(swept.values, is_bare)) return;
  // The unit that the user probably meant is suggested first: m if all values of a length are small, otherwise the unit
  // of drawings (mm or deg).
  constexpr double kSmall = 10.0;
  std::array<std::string_view, 2> units{display_unit(parameter->dimension).name, si_unit(parameter->dimension)};
  const auto is_small = [](const std::string& value) { return std::abs(*parse_number(value)) < kSmall; };
  const bool is_length = parameter->dimension == Dimension::length;
  if (is_length && std::ranges::all_of(swept.values, is_small)) std::ranges::reverse(units);
  throw InputError(
      {}, "--set " + printable(set) + " has no unit",
      fmt::format("write it once, after the last number: {0}{1}, or {0}{2}", printable(set), units[0], units[1]));
}

/// Checks the swept keys that are parameters of the geometry (check_geometry_key()).
void check_geometry_keys(const SweepOptions& options, std::span<const sweep::SweptKey> keys) {
  std::optional<Study> study;
  try {
    study = read_study(options.study, registry(), StudyUse::run);
  } catch (const InputError&) {
    return;  // the values of --set may make the study valid; it is read again with these values
  }
  for (std::size_t k = 0; k < keys.size(); ++k) check_geometry_key(options.set[k], keys[k], study->model());
}

int sweep(const SweepOptions& options) {
  const std::atomic<bool>& stop = catch_interrupts();
  std::vector<sweep::SweptKey> keys;
  std::ranges::transform(options.set, std::back_inserter(keys), sweep::parse_swept);
  check_geometry_keys(options, keys);
  const std::vector<std::vector<GivenKey>> grid = sweep::grid_of(keys);
  const std::string stem = std::filesystem::path(options.study).stem().string();
  const Study first = study_with(options, grid.front());
  const std::string path =
      check_result_path(options.result.empty() ? stem + "_sweep.h5" : options.result, inputs_of(options.study, first));
  const std::size_t threads = resolved_threads(options.threads);
  start_threads(threads);  // early, because oneTBB ends the program if it cannot start a thread
  ResumableRun resumable(options.resume, path, start_command_of(options));
  DesignDoubts doubts;
  const auto designs = designs_of(options, grid, stop, doubts);
  if (!designs) return interrupted(resumable);
  if (!options.yes && !resumable.continues() && !resumable.ends_within(kLongRun)) {
    ask_about(seconds_of(*designs, threads), options.study, threads, stop);
    if (stop) return interrupted(resumable);
  }
  resumable.start(identity_of(*designs), options.quiet);
  doubts.warn();
  const auto found = run_with_progress(options, keys, *designs, path,
                                       {.threads = threads,
                                        .stop = &stop,
                                        .checkpoints = &resumable.checkpoints(),
                                        .keep_checkpoint = options.resume.keep_checkpoint},
                                       resumable);
  if (!found) return interrupted(resumable);
  resumable.finish();
  return report(options, designs->front(), *found, path);
}

}  // namespace

Command& add_sweep(Command& program) {
  const auto [command, options] =
      program.add_command("sweep", "run a study for several values of a key, and compare the designs", sweep);
  command.add_value("study", options.study, "STUDY.toml", "study file (TOML)")->required();
  command
      .add_value("--set", options.set, "KEY=VALUES",
                 "key of the study and its values: FROM:TO:STEP or A,B,C, with a unit after the last; given several "
                 "times, each combination is a design")
      ->required()
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command.add_value("-o,--output", options.result, "RESULT.h5",
                    "result file; default: the study's name with _sweep.h5, in this folder");
  command.add_value("--response", options.response, "NAME",
                    "response whose root mean square is compared; default: the one that ranks in the first design");
  command.add_whole_number("--threads", options.threads, "N", "number of threads; default: one per processor", 1, 1024);
  command.add_whole_number("--seed", options.seed, "S", "seed, instead of the study's", 0, 0x7fffffffffffffff);
  options.resume.add_to(command);
  command.add_flag("--quiet", options.quiet, "no progress");
  command.add_flag("--yes", options.yes, "start a sweep of more than a day without a question");
  command.notes = {
      "All designs draw the same errors, and each has the same bits as the run of its own study. One file is written, "
      "with the values, the figures of merit and their changes; the whole result of a design is what 'poesy run' "
      "writes for its values. The exit code is 6 if every design is beyond a limit that the study states."};
  command.examples = {{"ten base radii; geometry. means mechanism.geometry.",
                       "poesy sweep tricept.toml --set geometry.a=150:375:25mm -o radii.h5"},
                      {"every combination of two keys",
                       "poesy sweep study.toml --set geometry.a=200,250mm --set errors.linear.sigma=5,10,20um"}};
  command.callback([&program, &called = options.program] { called = program.get_name(); });
  return command;
}

}  // namespace poesy::app
