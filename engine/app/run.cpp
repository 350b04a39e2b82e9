#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "engine/app/command.h"
#include "engine/app/exit_code.h"
#include "engine/app/interrupt.h"
#include "engine/app/progress.h"
#include "engine/app/resumable.h"
#include "engine/app/run_on_ranks.h"
#include "engine/app/run_study.h"
#include "engine/base/error.h"
#include "engine/io/result_file.h"
#include "engine/io/study_file.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

struct Options {
  std::string study;
  std::string result;
  std::size_t threads = 0;
  std::optional<std::uint64_t> seed;
  bool quiet = false;
  ResumeOptions resume;
  std::string program;  ///< as it was called
};

/// The command line that continues this run.
std::string resume_command(const Options& options, const Team* team) {
  std::vector<std::string> words;
  if (team != nullptr) words = {"mpirun", "-n", std::to_string(team->ranks().size())};
  words.insert(words.end(), {options.program, "run", options.study});
  const auto add = [&](const std::string& name, const std::string& value) { words.insert(words.end(), {name, value}); };
  if (!options.result.empty()) add("-o", options.result);
  if (options.threads != 0) add("--threads", std::to_string(options.threads));
  if (options.seed) add("--seed", std::to_string(*options.seed));
  if (options.resume.every != ResumeOptions().every) add("--checkpoint-every", options.resume.every);
  if (!options.resume.max_wall.empty()) add("--max-wall", options.resume.max_wall);
  if (options.resume.keep) words.emplace_back("--keep-checkpoint");
  if (options.quiet) words.emplace_back("--quiet");
  words.emplace_back("--resume");
  return shell_command(words);
}

/// study.toml gives study.h5 in the current folder.
std::string default_result(const std::string& study) {
  return std::filesystem::path(study).filename().replace_extension(".h5").string();
}

/// Says what came out; the exit code.
int finish(const Job& job, const std::string& study_path, const Ended& ended) {
  const std::uint64_t failed = ended.solves.not_converged();
  const std::string ranks = ended.facts.ranks > 1 ? fmt::format(" of {} ranks", ended.facts.ranks) : std::string();
  std::fputs(fmt::format("{}: {} solves in {:.2f} s on {} threads{}, {} not converged\n", job.path, ended.facts.solves,
                         ended.facts.wall_seconds, ended.facts.threads, ranks, failed)
                 .c_str(),
             stdout);
  if (job.study.not_converged != NotConverged::fail || failed == 0) return kDone;
  std::fputs(fmt::format("poesy: {}: {} samples did not converge and the study allows none; the result is kept in {}\n",
                         study_path, failed, job.path)
                 .c_str(),
             stderr);
  return kTooManyNotConverged;
}

/// run_study, and what is left to say about its checkpoints when it fails.
std::optional<Ended> run_to_end(const Job& job, ResumableRun& resumable, ProgressPrinter& printer) {
  try {
    auto ended = run_study(job);
    printer.finish();
    return ended;
  } catch (const BytesError& error) {
    printer.finish();
    resumable.refuse_state(error);
  } catch (const FileError&) {
    printer.finish();
    resumable.rescue();
    throw;
  }
}

Study study_of(const Options& options) {
  Study study = read_study(options.study, registry(), StudyUse::run);
  if (options.seed) study.seed = *options.seed;
  return study;
}

/// What ranks must have in common.
std::string text_of(const CheckpointIdentity& identity) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}", identity.poesy_version, identity.git_commit, identity.model,
                     identity.seed, identity.samples, identity.poses, identity.study);
}

/// What the ranks after rank 0 do.
void follow(const Options& options, std::size_t threads, Team& team) {
  const std::atomic<bool>& stop = catch_interrupts();
  const Study study = study_of(options);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  SelectedPoses poses = select_poses(study.poses, *model);
  if (!team.agree(text_of(identity_of(study, poses.poses)), threads, &stop)) {
    throw InputError({options.study}, "is not the same here as on rank 0, or its poses or poesy itself are not",
                     "give all ranks the same files and the same program");
  }
  const auto no_progress = [](const Progress& /*progress*/) {};
  run_study({study, *model, std::move(poses), {}, {threads, no_progress, &stop, nullptr, &team}, nullptr});
}

/// In one process, or as rank 0 of a team.
int run(const Options& options, std::size_t threads, Team* team) {
  const std::atomic<bool>& stop = catch_interrupts();
  const Study study = study_of(options);
  const std::string path = options.result.empty() ? default_result(options.study) : options.result;
  check_result_path(path);
  ResumableRun resumable(options.resume, path, resume_command(options, team));
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  SelectedPoses poses = select_poses(study.poses, *model);
  const CheckpointIdentity identity = identity_of(study, poses.poses);
  resumable.start(identity, options.quiet);
  if (team != nullptr && !team->agree(text_of(identity), threads, &stop)) return explain_leaving(*team);
  ProgressPrinter printer(options.quiet);
  const auto on_progress = [&](const Progress& progress) {
    printer(progress);
    resumable.check_time();
  };
  const Job job{
      study, *model, std::move(poses), path, {threads, on_progress, &stop, &resumable.checkpoints(), team}, &resumable};
  const std::optional<Ended> ended = run_to_end(job, resumable, printer);
  if (!ended) {
    const int code = team != nullptr ? explain_leaving(*team) : kInterrupted;
    resumable.explain_interruption();
    return code;
  }
  resumable.finish();
  return finish(job, options.study, *ended);
}

int run_alone_or_on_ranks(const Options& options) {
  const auto launch = find_launch();
  if (!launch || launch->size == 1) return run(options, resolved_threads(options.threads), nullptr);
  return run_on_ranks(*launch, [&](Team& team, std::size_t default_threads) -> int {
    const std::size_t threads = options.threads != 0 ? options.threads : default_threads;
    if (team.leads()) return run(options, threads, &team);
    follow(options, threads, team);
    return kDone;
  });
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("run", "run a study and write its result");
  command->add_option("study", options->study, "study file (TOML)")->required()->type_name("STUDY.toml");
  command->add_option("-o,--output", options->result, "result file; default: the study's name with .h5, here")
      ->type_name("RESULT.h5");
  command->add_option("--threads", options->threads, "number of threads, of each rank; default: one per processor")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1024}))
      ->type_name("N");
  command->add_option("--seed", options->seed, "seed, instead of the study's")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{0x7fffffffffffffff}))
      ->type_name("S");
  command->add_flag("--quiet", options->quiet, "no progress");
  options->resume.add_to(*command);
  command->footer(
      "Ctrl-C or SIGTERM stops a run so that --resume continues it; Ctrl-C again stops at once.\n"
      "Example: poesy run study.toml -o result.h5 --threads 2\n"
      "On several ranks: mpirun -n 4 poesy run study.toml -o result.h5");
  command->callback([options, &program, &action] {
    options->program = program.get_name();
    action = [options] { return run_alone_or_on_ranks(*options); };
  });
}

}  // namespace poesy::app
