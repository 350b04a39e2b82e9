#include "engine/app/results.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "engine/app/progress.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/kinds/confirming_study.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/result_file.h"
#include "engine/kinds/study_file.h"
#include "engine/kinds/study_run.h"
#include "engine/report/display.h"
#include "engine/report/solves.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "engine/result/described.h"
#include "engine/result/shard_file.h"
#include "engine/storage/file_writer.h"
#include "engine/study/bare_numbers.h"
#include "engine/study/calibration.h"
#include "engine/study/limit_keys.h"
#include "engine/study/mechanism_doubts.h"
#include "engine/study/outside_poses.h"
#include "engine/study/study_kind.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? std::string(name.data()) : std::string("unknown");
}

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const auto colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown";
}

/// Advice on how to make fewer samples fail. It is about the units of the poses if these are far outside the workspace,
/// about clearances and errors if most failed machines cannot be assembled, and otherwise about solver options and the
/// sizes of errors. The solver's method is named only for the metric "published" and for mechanisms without a metric,
/// because it matters only for these.
std::string advice(const Study& study, const PoseSet& poses, const SolveCounts& solves) {
  const std::string far = far_outside_clause(poses, study.model());
  if (!far.empty()) return "look at the units of the poses: " + far;
  if (mostly_impossible(solves)) return std::string(kAssemblyAdvice);
  const std::string& metric = study.model().metric;
  const bool newton_may_help = metric.empty() || metric == "published";
  if (study.solver.method == SolverOptions::Method::gauss_newton && newton_may_help) {
    return "take method = \"newton\", or raise solver.max_iterations";
  }
  return fmt::format("study smaller errors, or raise solver.max_iterations above {}", study.solver.max_iterations);
}

std::string warning_text(const Study& study, const PoseSet& poses, const SolveCounts& solves) {
  const double share = share_not_converged(solves);
  const bool many = share > kManyNotConverged;
  const std::string advised = advice(study, poses, solves);
  const std::uint64_t impossible = solves.not_assembled();
  if (impossible == 0) {
    return fmt::format("{:.3g} % of the samples did not converge and are left out; {}{}", 100.0 * share,
                       many ? "these are mostly large errors, so what is left may say far too little: " : "", advised);
  }
  const std::uint64_t others = solves.not_converged() - impossible;
  return fmt::format(
      "{:.3g} % of the samples are machines that cannot be assembled{}: a yield counts them as rejects, all else "
      "leaves "
      "them out; {}",
      100.0 * share_of(impossible, solves.total()),
      others == 0 ? std::string()
                  : fmt::format(", and the solves of another {:.3g} % did not converge",
                                100.0 * share_of(others, solves.total())),
      advised);
}

ExitCode judge_failures(const Study& study, const PoseSet& poses, const SolveCounts& solves,
                        const std::string& study_path, const std::string& remedy) {
  const std::uint64_t failed = solves.not_converged();
  if (failed == 0) return kDone;
  const double share = share_not_converged(solves);
  if (share > unremarkable_failure_share(study.max_not_converged) && study.not_converged == NotConverged::exclude) {
    say(Message::warning, warning_text(study, poses, solves));
  }
  if (share <= study.max_not_converged) return kDone;
  say(Message::error,
      fmt::format("{}: {} of {} samples {}, a share of {:.3g}, and solver.max_not_converged is {}{}; {}", study_path,
                  failed, solves.total(), why_unsolved(solves), share, shortest(study.max_not_converged),
                  study.max_not_converged == 0.0 ? " (not_converged = \"fail\" is the same)" : "", remedy));
  return kTooManyNotConverged;
}

/// Advice on how to decide an undecided yield, as a clause.
std::string more_machines(const Study& study) {
  if (study.errors.machines) return "give more machines, as rows of errors.machines";
  return "take more samples, whose number may grow with --resume if the checkpoint is kept";
}

/// Judges a yield, and returns the exit code. more: see more_machines(). certificate: true if the study found the
/// tolerances itself, and the yield is that of fresh machines that certify them.
ExitCode judge_yield(const YieldVerdict& yield, const std::string& more, bool certificate,
                     const std::string& study_path, const std::string& remedy) {
  using enum YieldVerdict::Decision;
  const std::string found =
      fmt::format("the yield is {} ({} to {} at {})", percent_text(yield.value), percent_text(yield.ci_low),
                  percent_text(yield.ci_high), percent_text(yield.conf_level));
  if (certificate && yield.decision == undecided) {
    say(Message::error, fmt::format("{}: the tolerances are not certified: {}, which does not tell whether it is {}; "
                                    "take more samples; {}",
                                    study_path, found, percent_text(yield.asked), remedy));
    return kLimitNotKept;
  }
  if (yield.decision == undecided) {
    say(Message::warning, fmt::format("{}: {}, which does not tell whether it is {}; {}", study_path, found,
                                      percent_text(yield.asked), more));
  }
  if (const std::string open = open_parts_text(yield); !open.empty()) {
    say(Message::warning, fmt::format("{}: {}", study_path, open));
  }
  if (yield.decision != not_kept) return kDone;
  say(Message::error,
      fmt::format("{}: {}, below the {} that is asked for; {}", study_path, found, percent_text(yield.asked), remedy));
  return kLimitNotKept;
}

ExitCode judge_limits(const Study& study, const StoredResult& result, const std::string& study_path,
                      const std::string& remedy) {
  const std::optional<Table> table = limits_table(result);
  if (!table) return kDone;
  print("\n" + text_of(*table, output_width()));
  const LimitVerdicts& verdicts = *result.verdicts;
  if (verdicts.yield) {
    // If a kind of study can be asked for a yield (StudyKind::ask_yield), the yield is that of the study's machines.
    // For any other kind, a yield in the result is a certificate.
    const bool certificate = study.analysis.kind != nullptr && study.analysis.kind->ask_yield == nullptr;
    return judge_yield(*verdicts.yield, more_machines(study), certificate, study_path, remedy);
  }
  for (const LimitVerdict& one : verdicts.limits) {
    if (one.passed) continue;
    const NamedUnit& response = result.responses[one.response];
    const Dimension dimension = dimension_of(response.unit);
    say(Message::error, fmt::format("{}: {} is {}, {} its limit of {}; {}", study_path, response.name,
                                    readable_text({one.value, dimension}, 4), one.limit.is_plain() ? "above" : "beyond",
                                    limit_text(one.limit, dimension), remedy));
  }
  return verdicts.passed() ? kDone : kLimitNotKept;
}

/// The outcome of a run after all its solves.
RunOutcome outcome_of(const Job& job) {
  const RunTime time = job.time();
  const SolveCounts solves = job.checkpoints().solves();
  RunOutcome outcome{solves, run_facts(time.wall, job.threads, solves.total() - solves.by_series())};
  outcome.facts.by_series = solves.by_series();
  outcome.facts.checkpoint_seconds = time.checkpoints;
  outcome.facts.ranks = job.ranks;
  return outcome;
}

}  // namespace

RunFacts run_facts(double wall_seconds, std::size_t threads, std::uint64_t solves) {
  RunFacts facts;
  facts.created = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  facts.host = host_name();
  facts.cpu = cpu_name();
  facts.threads = threads;
  facts.wall_seconds = wall_seconds;
  facts.solves = solves;
  return facts;
}

std::string samples_text(const RunFacts& facts) {
  if (facts.by_series == 0) return fmt::format("{} solves", facts.solves);
  return fmt::format("{} samples ({} solved, the others by series)", facts.samples(), facts.solves);
}

std::optional<SelectedPoses> find_poses(const Study& study, const Model& model, const SearchOptions& options) {
  ProgressLine line(options.quiet);
  const auto watch = [&](const PoseSearch& search) {
    if (options.stop != nullptr && *options.stop) return false;
    if (!line.is_due(ProgressLine::Clock::now())) return true;
    const auto cut = [&](std::size_t width) { return search_line(search).substr(0, width); };
    line.write([&] { return search_line(search); }, cut);
    return true;
  };
  try {
    return select_poses(study.poses, model, watch);
  } catch (const InputError&) {
    // A wrong size of the mechanism is a likely reason, and no later message would mention it.
    for (const std::string& doubt : geometry_doubts(study.mechanism)) say(Message::warning, doubt);
    throw;
  }
}

std::vector<std::string> inputs_of(const std::string& study_path, const Study& study) {
  std::vector<std::string> inputs{study_path};
  const auto add = [&](const std::string& name) {
    if (!name.empty()) inputs.push_back((std::filesystem::path(study_path).parent_path() / name).string());
  };
  add(study.poses.file);
  if (study.poses.trajectory) add(study.poses.trajectory->file);
  if (const auto& calibration = study.analysis.calibration; calibration != nullptr && calibration->poses) {
    add(calibration->poses->file);
  }
  if (study.mechanism.file) add(study.mechanism.file->name);
  return inputs;
}

void warn_each(const std::string& study_path, std::span<const std::string> notes) {
  for (const std::string& note : notes) say(Message::warning, fmt::format("{}: {}", study_path, note));
}

ExitCode judge(const Study& study, const SolveCounts& solves, const StoredResult& result, const std::string& study_path,
               const Remedies& remedies) {
  const ExitCode limits = judge_limits(study, result, study_path, remedies.limits);
  const ExitCode failures = judge_failures(study, result.poses, solves, study_path, remedies.failures);
  return failures != kDone ? failures : limits;
}

namespace {

/// The beginning of the names of files beside a result: RESULT_certificate.
std::string stem_beside(const std::filesystem::path& result) { return result.stem().string() + "_certificate"; }

/// The endings of the names of the files that may be written beside a result: the study that repeats the certificate,
/// and the files that this study may name.
constexpr std::array<std::string_view, 4> kBeside{".toml", "_mechanism.toml", "_poses.csv", "_measured.csv"};

/// The beginning of the comment in the study that repeats the certificate; the name of the result follows.
constexpr std::string_view kRepeats = "repeats the certificate of ";

/// The path of a file beside the result. end: ending of the file's name.
std::string path_beside(const std::filesystem::path& result, std::string_view end) {
  return (result.parent_path() / (stem_beside(result) + std::string(end))).string();
}

/// Returns true if a file beside the result belongs to an earlier run: the study that this run wrote beside the result
/// names the file.
bool is_of_earlier_study(const std::filesystem::path& result, const std::string& file) {
  const std::string study = path_beside(result, kBeside.front());
  std::error_code ignored;
  return has_mark(study, kRepeats) && has_mark(study, std::filesystem::path(file).filename().string()) &&
         std::filesystem::is_regular_file(file, ignored);
}

/// Writes the study that repeats the certificate, RESULT_certificate.toml, and the files that this study names, beside
/// the result. Returns the path of the study. The next run refuses to replace files that no such study names
/// (check_files_beside()), so neither this run nor a killed run may leave such files. For this reason, files that only
/// an earlier study named are removed first, and the study is written before the files that it names.
std::string write_beside(const Job& job, Study confirming) {
  const std::filesystem::path result(job.path);
  const std::string folder = result.has_parent_path() ? result.parent_path().string() : ".";
  const std::string stem = stem_beside(result);
  for (const std::string_view end : kBeside) {
    const std::string file = path_beside(result, end);
    remove_left_over(file);
    std::error_code ignored;
    if (end != kBeside.front() && is_of_earlier_study(result, file)) std::filesystem::remove(file, ignored);
  }
  name_files_beside(confirming, stem);
  const std::string comment = std::string(kRepeats) + printable_line(result.filename().string());
  const std::filesystem::path written = write_confirming_study(folder, stem, confirming, comment);
  write_files_beside(folder, confirming, job.poses.poses);
  return written.lexically_normal().string();
}

}  // namespace

void check_files_beside(const std::string& result, std::span<const std::string> inputs) {
  const std::filesystem::path path(result);
  // Returns true if an earlier run wrote the file: it is a study that repeats a certificate, or such a study names it.
  const auto is_ours = [&](std::string_view end, const std::string& file) {
    return end == kBeside.front() ? is_marked(file, kRepeats) : is_of_earlier_study(path, file);
  };
  for (const std::string_view end : kBeside) {
    const std::string file = path_beside(path, end);
    check_name_length(file);
    std::error_code ignored;  // a path that cannot be examined is treated as if there were no file
    for (const std::string& input : inputs) {
      if (!std::filesystem::equivalent(file, input, ignored)) continue;
      throw InputError({input}, "would be replaced by the study that confirms the result, " + file,
                       "give the result another name (-o)");
    }
    if (!stands(file) || is_ours(end, file)) continue;
    throw InputError({file},
                     "exists and was not written with this result, and the study that confirms it would replace it",
                     "move it away, or give the result another name (-o)");
  }
}

namespace {

/// Notes on limits far from the judged values (ReportKind::far_limits).
std::vector<std::string> far_limits_of(const Job& job, StudyResult& result) {
  const auto notes = kind_of(job.study).report.far_limits;
  if (notes == nullptr) return {};
  StoredResult seen = described(job.study, job.model, job.poses);
  seen.verdicts = result.verdicts;
  seen.found = std::move(result.found);  // moved back below, because a copy would take memory
  std::vector<std::string> list = notes(seen);
  result.found = std::move(seen.found);
  return list;
}

}  // namespace

std::optional<RunOutcome> run_to_file(const Job& job) {
  std::optional<StudyResult> result = run_study(job.study, job.model, job.poses.poses, job.options);
  if (!job.checkpoints().complete()) return std::nullopt;
  const bool writes = job.options.team == nullptr || job.options.team->leads();
  std::vector<std::string> far_limits;
  if (writes && result) far_limits = far_limits_of(job, *result);
  if (writes && result) {
    write_result(job.path, job.study, job.poses, std::move(result->found), outcome_of(job).facts,
                 result->drawing ? &*result->drawing : nullptr);
  }
  RunOutcome outcome = outcome_of(job);
  if (result) {
    outcome.verdicts = result->verdicts;
    outcome.row_names = result->row_names;
    outcome.far_limits = std::move(far_limits);
    if (writes && result->confirming) outcome.confirming = write_beside(job, *result->confirming);
  }
  if (const auto& shard = job.options.shard; shard && writes) {
    write_shard(job.path, job.study, job.poses, *shard, job.checkpoints().stages(), outcome.facts);
  }
  return outcome;
}

int report_outcome(const Job& job, const std::string& study_path, const RunOutcome& outcome) {
  const std::string ranks = outcome.facts.ranks > 1 ? fmt::format(" of {} ranks", outcome.facts.ranks) : std::string();
  print(fmt::format("{}: {} in {:.2f} s on {} {}{}, {}\n", printable_line(job.path), samples_text(outcome.facts),
                    outcome.facts.wall_seconds, outcome.facts.threads,
                    outcome.facts.threads == 1 ? "thread" : "threads", ranks, unsolved_in_short(outcome.solves)));
  if (!outcome.confirming.empty()) {
    print(fmt::format("{}: the study that repeats the certificate\n", printable_line(outcome.confirming)));
  }
  if (job.options.shard) return kDone;  // the limits are judged only in the result of the whole study
  const std::string remedy = fmt::format("the result is kept; see 'poesy show {}'", job.path);
  StoredResult result = described(job.study, job.model, job.poses);
  result.verdicts = outcome.verdicts;
  result.row_names = outcome.row_names;
  const ExitCode code = judge(job.study, outcome.solves, result, study_path, {remedy, remedy});
  warn_each(study_path, outcome.far_limits);
  return code;
}

std::string memory_text(std::size_t bytes) {
  constexpr std::size_t kMega = 1'000'000;
  return bytes < kMega ? "less than 1 MB" : fmt::format("about {} MB", bytes / kMega);
}

FileError too_little_memory(const std::string& path, const std::string& work, const std::string& needed) {
  return {path, fmt::format("there is not enough memory for {}: it takes {} besides the program's own", work, needed),
          "do it where there is more, raise the limit (ulimit -v), or ask for fewer poses or errors"};
}

void warn_of_mechanism(const Study& study, const Model& model) {
  for (const std::string& doubt : mechanism_doubts(study.mechanism, model)) say(Message::warning, doubt);
}

std::vector<std::string> all_doubts(const Study& study, const Model& model, const SelectedPoses& poses) {
  std::vector<std::string> list = mechanism_doubts(study.mechanism, model);
  std::ranges::copy(size_doubts(study, model), std::back_inserter(list));
  std::ranges::copy(doubts_of(study, poses), std::back_inserter(list));
  if (std::string doubt = zones_doubt(study); !doubt.empty()) list.push_back(std::move(doubt));
  if (std::string doubt = sides_doubt(model, poses.poses); !doubt.empty()) list.push_back(std::move(doubt));
  if (std::string doubt = correction_doubt(study, model); !doubt.empty()) list.push_back(std::move(doubt));
  return list;
}

std::vector<std::string> study_notes(const Study& study) {
  std::vector<std::string> notes{calibration_text(study), held_errors_text(study), left_out_text(study)};
  if (study.analysis.kind->note != nullptr) notes.push_back(study.analysis.kind->note(study));
  std::erase(notes, "");
  return notes;
}

StoredResult read_result_with_warning(const std::string& path) {
  StoredResult result = read_result(path);
  if (result.changed) say(Message::warning, path + " was changed since it was written; see poesy verify");
  return result;
}

}  // namespace poesy::app
