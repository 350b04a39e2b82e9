#include <fmt/format.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <new>
#include <optional>

#include "engine/app/command_line.h"
#include "engine/app/expected_time.h"
#include "engine/app/long_run.h"
#include "engine/app/mpi_ranks.h"
#include "engine/app/progress.h"
#include "engine/app/results.h"
#include "engine/app/resumable.h"
#include "engine/app/terminal.h"
#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/kinds/corner_machines.h"
#include "engine/kinds/registry.h"
#include "engine/kinds/study_file.h"
#include "engine/kinds/study_run.h"
#include "engine/result/checkpoint_identity.h"
#include "engine/result/result_file.h"
#include "engine/run/ranks/team.h"
#include "engine/run/run_options.h"
#include "engine/study/poses/corners.h"
#include "engine/study/poses/pose_selection.h"
#include "engine/study/study.h"
#include "engine/study/study_file.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// The number of processors for this process: those to which the launcher bound the process, or an equal share of the
/// machine's processors if the launcher did not bind the process.
std::size_t processors_of_rank(std::size_t ranks_on_this_machine) {
  const auto all = static_cast<std::size_t>(std::max(1L, sysconf(_SC_NPROCESSORS_ONLN)));
  cpu_set_t allowed;
  const bool known = pthread_getaffinity_np(pthread_self(), sizeof allowed, &allowed) == 0;
  const std::size_t bound = known ? static_cast<std::size_t>(CPU_COUNT(&allowed)) : all;
  return bound < all ? bound : std::max<std::size_t>(1, all / ranks_on_this_machine);
}

/// If a rank ended its work early, prints the reason. Returns the exit code. Precondition: the run was interrupted.
int say_why_a_rank_left(const Team& team) {
  if (!team.left()) return kInterrupted;
  constexpr std::array kCodes{kInterrupted, kBadInput, kFileTrouble, kInternalError};  // exit code for each LeaveReason
  return complain(team.left()->text, kCodes[static_cast<std::size_t>(team.left()->reason)]);
}

struct RunCommandOptions {
  std::string study;
  std::string result;
  std::size_t threads = 0;
  std::optional<std::uint64_t> seed;
  std::optional<Shard> shard;
  bool quiet = false;
  bool yes = false;  ///< true to start a long run without asking
  ResumeOptions resume;
  std::string program;  ///< name with which the program was called
};

/// The command line that starts this run again. team: the ranks of the run; null for one process.
std::string start_command_of(const RunCommandOptions& options, const Team* team) {
  std::vector<std::string> words;
  if (team != nullptr) words = {"mpirun", "-n", std::to_string(team->ranks().size())};
  words.insert(words.end(), {options.program, "run", options.study});
  if (options.shard) words.insert(words.end(), {"--shard", to_string(*options.shard)});
  return start_command(std::move(words), options);
}

/// The default path of a result in the current folder: study.h5 for study.toml, or study.2-of-5.h5 for its second shard
/// of five.
std::string default_result(const RunCommandOptions& options) {
  const std::filesystem::path stem = std::filesystem::path(options.study).filename().stem();
  if (!options.shard) return stem.string() + ".h5";
  return fmt::format("{}.{}-of-{}.h5", stem.string(), options.shard->index + 1, options.shard->count);
}

/// Reads the value of --shard, such as "2/5".
Shard parse_shard(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto shard = whole_number(std::string_view(text).substr(0, slash));
  const auto count = slash < text.size() ? whole_number(std::string_view(text).substr(slash + 1)) : std::nullopt;
  if (shard && count && *shard > 0 && *shard <= *count) return {*shard - 1, *count};
  throw InputError({}, "--shard is '" + printable(text) + "'", "write K/N with K from 1 to N, e.g. 2/5");
}

/// The error that says that there is not enough memory for a run.
FileError too_little_for_run(const std::string& path, const Study& study, const Model& model, const PoseSet& poses) {
  return too_little_memory(path, "this run", memory_text(outlook(study, model, poses).memory.peak()));
}

/// Runs the study and shows the progress. If the run fails, also tells the user whether the checkpoints are kept.
std::optional<RunOutcome> run_with_progress(Job& job, ResumableRun& resumable, bool quiet) {
  const auto act = [&] {
    ProgressPrinter printer(quiet);
    job.options.progress = [&](const Progress& progress) {
      printer(progress);
      resumable.check_time();
    };
    return run_to_file(job);
  };
  return run_to_end(resumable, act,
                    [&] { return too_little_for_run(job.path, job.study, job.model, job.poses.poses); });
}

Study study_of(const RunCommandOptions& options) {
  Study study = read_study(options.study, registry(), StudyUse::run);
  if (options.seed) study.seed = *options.seed;
  return study;
}

/// A text that identifies the run. All ranks must have the same text.
std::string text_of(const CheckpointIdentity& identity) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", identity.poesy_version, identity.git_commit, identity.model,
                     identity.seed, identity.samples, identity.shard, identity.poses, identity.study);
}

/// Takes part in the run on a rank other than rank 0. threads: number of threads of this rank.
void follow(const RunCommandOptions& options, std::size_t threads, Team& team) {
  const std::atomic<bool>& stop = catch_interrupts();
  const Study study = study_of(options);
  start_threads(threads);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const auto poses = find_poses(study, *model, {.quiet = true, .stop = &stop});
  if (!poses) return team.leave(LeaveReason::stopped, "stopped while it looked for poses");
  if (!team.agree(text_of(identity_of(study, poses->poses, options.shard)), threads, &stop)) {
    throw InputError({options.study}, "is not the same here as on rank 0, or its poses or poesy itself are not",
                     "give all ranks the same files and the same program");
  }
  Checkpoints not_kept;
  try {
    run_study(study, *model, poses->poses,
              {.threads = threads,
               .stop = &stop,
               .checkpoints = &not_kept,
               .shard = options.shard,
               .keep_checkpoint = options.resume.keep_checkpoint,
               .team = &team});
  } catch (const std::bad_alloc&) {
    throw too_little_for_run("", study, *model, poses->poses);
  }
}

/// Ends a run if the ranks did not begin their work, and returns the exit code. After an interrupt, the checkpoint of
/// an earlier run is kept; if there is none, an empty checkpoint is written, from which the run can be resumed.
int leave_before_the_start(const Team& team, ResumableRun& resumable) {
  const int code = say_why_a_rank_left(team);
  if (code != kInterrupted) return code;
  resumable.checkpoints().save();
  resumable.explain_interruption();
  return code;
}

int explained_interruption(const ResumableRun& resumable) {
  resumable.explain_interruption();
  return kInterrupted;
}

/// Says how many candidate poses are not in the study, and why. The message is a warning if the mechanism does not
/// reach some of them. Otherwise it is a note, because the study asked for their rejection.
void say_rejected(const Study& study, const SelectedPoses& poses, bool quiet) {
  const std::string text = study.poses.select == PoseSelection::Select::boundary
                               ? end_of_reach_text(poses.rejected)
                               : rejected_text(poses.rejected, poses.candidates);
  if (text.empty()) return;
  const bool is_warning = some_out_of_reach(poses.rejected);
  if (is_warning || !quiet) say(is_warning ? Message::warning : Message::note, text);
}

/// Says how many machines miss a limit only at a corner of the workspace, if there are such machines.
void say_corners(const Study& study, const Model& model, const PoseSet& poses) {
  const auto found = corner_machines(study, model, poses, feasible_corners(study.poses, model));
  if (found && found->only_at_corners() > 0) say(Message::note, corners_text(*found, study.model()));
}

/// Runs the study in one process, or as rank 0 of a team. team: null for one process.
int run(const RunCommandOptions& options, std::size_t threads, Team* team) {
  const std::atomic<bool>& stop = catch_interrupts();
  const Study study = study_of(options);
  const std::string named = options.result.empty() ? default_result(options) : options.result;
  const std::vector<std::string> inputs = inputs_of(options.study, study);
  const std::string path = check_result_path(named, inputs);
  if (kind_of(study).run.confirms) check_files_beside(path, inputs);
  start_threads(threads);  // early, because oneTBB ends the program if it cannot start a thread
  ResumableRun resumable(options.resume, path, start_command_of(options, team));
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  auto poses = find_poses(study, *model, {.quiet = options.quiet, .stop = &stop});
  if (!poses) return explained_interruption(resumable);
  if (options.shard) check_shard(*options.shard, study, poses->poses.size());
  const CheckpointIdentity identity = identity_of(study, poses->poses, options.shard);
  if (!options.yes && !resumable.continues() && !resumable.ends_within(kLongRun)) {
    const std::size_t all_threads = threads * (team != nullptr ? team->ranks().size() : 1);
    const double shards = options.shard ? static_cast<double>(options.shard->count) : 1.0;
    const double seconds = seconds_of_long_run(study, *model, poses->poses, all_threads) / shards;
    ask_about(seconds, options.study, all_threads, stop);
    if (stop) return explained_interruption(resumable);
  }
  resumable.start(identity, options.quiet);
  if (team != nullptr && !team->agree(text_of(identity), threads, &stop))
    return leave_before_the_start(*team, resumable);
  for (const std::string& doubt : all_doubts(study, *model, *poses)) say(Message::warning, doubt);
  say_rejected(study, *poses, options.quiet);
  for (const std::string& note : study_notes(study)) {
    if (!options.quiet) say(Message::note, note);
  }
  if (!options.quiet) say_corners(study, *model, poses->poses);
  Job job{.study = study,
          .model = *model,
          .poses = *std::move(poses),
          .path = path,
          .options = {.threads = threads,
                      .stop = &stop,
                      .checkpoints = &resumable.checkpoints(),
                      .shard = options.shard,
                      .keep_checkpoint = options.resume.keep_checkpoint,
                      .team = team},
          .time = [&] { return resumable.time(); },
          .threads = team != nullptr ? team->threads() : threads,
          .ranks = team != nullptr ? team->ranks().size() : 1};
  const std::optional<RunOutcome> outcome = run_with_progress(job, resumable, options.quiet);
  if (!outcome) {
    const int code = team != nullptr ? say_why_a_rank_left(*team) : kInterrupted;
    resumable.explain_interruption();
    return code;
  }
  resumable.finish();
  return report_outcome(job, options.study, *outcome);
}

/// Runs the study on this process alone, or on all ranks. Returns the exit code, which is the same on all ranks. Only
/// rank 0 prints.
int run_alone_or_on_ranks(const RunCommandOptions& options) {
  const auto launch = find_launch();
  if (!launch || launch->size == 1) return run(options, resolved_threads(options.threads), nullptr);
  const std::unique_ptr<LaunchedRanks> ranks = connect_ranks(*launch);
  const std::size_t processors = processors_of_rank(ranks->on_this_machine());
  const std::size_t threads = options.threads != 0 ? options.threads : processors;
  Team team(*ranks);
  if (!team.leads()) return team.follow([&] { follow(options, threads, team); });
  const int code = exit_code_of([&] { return run(options, threads, &team); });
  // The other ranks may need long to finish, so this rank waits only for a limited time.
  if (!team.dismiss(code, std::chrono::seconds(code == kDone ? 60 : 10))) ranks->abort(code);
  return code;
}

}  // namespace

Command& add_run(Command& program) {
  const auto [command, options] = program.add_command("run", "run a study and write its result", run_alone_or_on_ranks);
  command.add_value("study", options.study, "STUDY.toml", "study file (TOML)")->required();
  command.add_value("-o,--output", options.result, "RESULT.h5",
                    "result file; default: the study's name with .h5, in this folder");
  command.add_whole_number("--threads", options.threads, "N",
                           "number of threads, of each rank; default: one per processor", 1, 1024);
  command.add_whole_number("--seed", options.seed, "S", "seed, instead of the study's", 0, 0x7fffffffffffffff);
  options.resume.add_to(command);
  command
      .add_option_function<std::string>(
          "--shard", [&shard = options.shard](const std::string& text) { shard = parse_shard(text); },
          "run this one of N shards only, to be put together by poesy merge")
      ->type_name("K/N")
      ->group("On a cluster");
  command.add_flag("--quiet", options.quiet, "no progress");
  command.add_flag("--yes", options.yes, "start a run of more than a day without a question");
  command.notes = {"Ctrl-C or SIGTERM stops a run so that --resume continues it; Ctrl-C again stops at once."};
  command.examples = {
      {"gives study.h5", "poesy run study.toml"},
      {"stops after two hours, exit code 4; the same with --resume goes on", "poesy run study.toml --max-wall \"2 h\""},
      {"on several ranks, over MPI", "mpirun -n 4 poesy run study.toml -o result.h5"}};
  command.callback([&program, &called = options.program] { called = program.get_name(); });
  return command;
}

}  // namespace poesy::app
