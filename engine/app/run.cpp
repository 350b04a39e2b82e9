#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <optional>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/app/interrupt.h"
#include "engine/app/message.h"
#include "engine/app/progress.h"
#include "engine/app/resumable.h"
#include "engine/app/run_on_ranks.h"
#include "engine/app/run_study.h"
#include "engine/app/whole_number.h"
#include "engine/base/error.h"
#include "engine/io/error_words.h"
#include "engine/io/result_file.h"
#include "engine/io/study_file.h"
#include "engine/io/wording.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

struct RunCommandOptions {
  std::string study;
  std::string result;
  std::size_t threads = 0;
  std::optional<std::uint64_t> seed;
  std::optional<Shard> shard;
  bool quiet = false;
  ResumeOptions resume;
  std::string program;  ///< as it was called
};

/// The command line that continues this run.
std::string resume_command(const RunCommandOptions& options, const Team* team) {
  std::vector<std::string> words;
  if (team != nullptr) words = {"mpirun", "-n", std::to_string(team->ranks().size())};
  words.insert(words.end(), {options.program, "run", options.study});
  const auto add = [&](const std::string& name, const std::string& value) { words.insert(words.end(), {name, value}); };
  if (!options.result.empty()) add("-o", options.result);
  if (options.shard) add("--shard", to_string(*options.shard));
  if (options.threads != 0) add("--threads", std::to_string(options.threads));
  if (options.seed) add("--seed", std::to_string(*options.seed));
  if (options.resume.every != ResumeOptions().every) add("--checkpoint-every", options.resume.every);
  if (!options.resume.max_wall.empty()) add("--max-wall", options.resume.max_wall);
  if (options.resume.keep) words.emplace_back("--keep-checkpoint");
  if (options.quiet) words.emplace_back("--quiet");
  words.emplace_back("--resume");
  return shell_command(words);
}

/// study.toml gives study.h5 in the current folder, its second shard of five study.2-of-5.h5.
std::string default_result(const RunCommandOptions& options) {
  const std::filesystem::path stem = std::filesystem::path(options.study).filename().stem();
  if (!options.shard) return stem.string() + ".h5";
  return fmt::format("{}.{}-of-{}.h5", stem.string(), options.shard->index + 1, options.shard->count);
}

/// "2/5"
Shard parse_shard(const std::string& text) {
  const auto fail = [&]() {
    throw InputError({}, "--shard is '" + printable(text) + "'", "write K/N with K from 1 to N, e.g. 2/5");
  };
  const auto number = [&](std::string_view digits) {
    std::size_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error != std::errc() || end != digits.data() + digits.size()) fail();
    return value;
  };
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) fail();
  const std::size_t shard = number(std::string_view(text).substr(0, slash));
  const Shard parsed{shard - 1, number(std::string_view(text).substr(slash + 1))};
  if (shard == 0 || shard > parsed.count) fail();
  return parsed;
}

/// Cells or blocks that shards of the study can divide between them.
std::size_t divisible(const Study& study, std::size_t poses) {
  const bool by_factor = study.analysis.kind == Analysis::Kind::sensitivity;
  return by_factor ? study.analysis.factors.size() * poses : poses;
}

/// Throws unless this study can be divided so.
void check_shard(const Shard& shard, const Study& study, std::size_t poses) {
  if (study.analysis.kind == Analysis::Kind::identification) {
    throw InputError({}, "--shard divides no identification, each step of which needs all poses of the one before",
                     "run it whole, for it is small, or with mpirun");
  }
  if (study.analysis.adaptive) {
    throw InputError(
        {}, "--shard divides no study with adaptive samples: when an error has enough is decided over all poses",
        "write samples = N, or run it with mpirun");
  }
  if (const std::size_t most = divisible(study, poses); shard.count > most) {
    throw InputError(
        {}, fmt::format("--shard asks for {} shards, but this study divides into {} at most", shard.count, most),
        "take fewer shards");
  }
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

Study study_of(const RunCommandOptions& options) {
  Study study = read_study(options.study, registry(), StudyUse::run);
  if (options.seed) study.seed = *options.seed;
  return study;
}

/// What ranks must have in common.
std::string text_of(const CheckpointIdentity& identity) {
  return fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n{}\n{}", identity.poesy_version, identity.git_commit, identity.model,
                     identity.seed, identity.samples, identity.shard, identity.poses, identity.study);
}

/// What the ranks after rank 0 do.
void follow(const RunCommandOptions& options, std::size_t threads, Team& team) {
  const std::atomic<bool>& stop = catch_interrupts();
  const Study study = study_of(options);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  SelectedPoses poses = select_poses(study.poses, *model);
  if (!team.agree(text_of(identity_of(study, poses.poses, options.shard)), threads, &stop)) {
    throw InputError({options.study}, "is not the same here as on rank 0, or its poses or poesy itself are not",
                     "give all ranks the same files and the same program");
  }
  Checkpoints not_kept([] { return false; }, [](std::span<const Bytes>) {});
  const auto no_progress = [](const Progress&) {};
  run_study({study,
             *model,
             std::move(poses),
             {},
             {threads, no_progress, &stop, &not_kept, options.shard, options.resume.keep, &team},
             [] { return RunTime(); },
             threads});
}

/// The ranks never began. What an earlier run kept is kept; without one, a checkpoint of nothing is there to be
/// resumed.
int leave_before_the_start(const Team& team, ResumableRun& resumable) {
  const int code = explain_leaving(team);
  if (code != kInterrupted) return code;
  resumable.checkpoints().save();
  resumable.explain_interruption();
  return code;
}

/// In one process, or as rank 0 of a team.
int run(const RunCommandOptions& options, std::size_t threads, Team* team) {
  const std::atomic<bool>& stop = catch_interrupts();
  const Study study = study_of(options);
  const std::string path = options.result.empty() ? default_result(options) : options.result;
  check_result_path(path, std::span(&options.study, 1));
  ResumableRun resumable(options.resume, path, resume_command(options, team));
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  SelectedPoses poses = select_poses(study.poses, *model);
  if (options.shard) check_shard(*options.shard, study, poses.poses.size());
  const CheckpointIdentity identity = identity_of(study, poses.poses, options.shard);
  resumable.start(identity, options.quiet);
  if (team != nullptr && !team->agree(text_of(identity), threads, &stop))
    return leave_before_the_start(*team, resumable);
  if (const std::string held = held_errors_text(study); !held.empty() && !options.quiet) say(Message::note, held);
  ProgressPrinter printer(options.quiet);
  const auto on_progress = [&](const Progress& progress) {
    printer(progress);
    resumable.check_time();
  };
  const Job job{study,
                *model,
                std::move(poses),
                path,
                {threads, on_progress, &stop, &resumable.checkpoints(), options.shard, options.resume.keep, team},
                [&] { return resumable.time(); },
                team != nullptr ? team->threads() : threads,
                team != nullptr ? team->ranks().size() : 1};
  const std::optional<Ended> ended = run_to_end(job, resumable, printer);
  if (!ended) {
    const int code = team != nullptr ? explain_leaving(*team) : kInterrupted;
    resumable.explain_interruption();
    return code;
  }
  resumable.finish();
  return report_end(job, options.study, *ended);
}

int run_alone_or_on_ranks(const RunCommandOptions& options) {
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
  auto options = std::make_shared<RunCommandOptions>();
  CLI::App* command = program.add_subcommand("run", "run a study and write its result");
  command->add_option("study", options->study, "study file (TOML)")->required()->type_name("STUDY.toml");
  command->add_option("-o,--output", options->result, "result file; default: the study's name with .h5, in this folder")
      ->type_name("RESULT.h5");
  add_whole_number(*command, "--threads", "--threads", options->threads,
                   "number of threads, of each rank; default: one per processor", 1, 1024)
      ->type_name("N");
  add_whole_number(*command, "--seed", "--seed", options->seed, "seed, instead of the study's", 0, 0x7fffffffffffffff)
      ->type_name("S");
  options->resume.add_to(*command);
  command
      ->add_option_function<std::string>(
          "--shard", [options](const std::string& text) { options->shard = parse_shard(text); },
          "run this one of N shards only, to be put together by poesy merge")
      ->type_name("K/N")
      ->group("On a cluster");
  command->add_flag("--quiet", options->quiet, "no progress");
  command->footer(footer("Ctrl-C or SIGTERM stops a run so that --resume continues it; Ctrl-C again stops at once.\n",
                         {{"gives study.h5", "poesy run study.toml"},
                          {"stops after two hours, exit code 4; the same with --resume goes on",
                           "poesy run study.toml --max-wall \"2 h\""},
                          {"on several ranks, over MPI", "mpirun -n 4 poesy run study.toml -o result.h5"}}));
  command->callback([options, &program, &action] {
    options->program = program.get_name();
    action = [options] { return run_alone_or_on_ranks(*options); };
  });
}

}  // namespace poesy::app
