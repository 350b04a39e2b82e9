#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "engine/app/command.h"
#include "engine/app/exit_code.h"
#include "engine/app/facts.h"
#include "engine/app/interrupt.h"
#include "engine/app/progress.h"
#include "engine/app/resumable.h"
#include "engine/base/error.h"
#include "engine/io/result_file.h"
#include "engine/io/study_file.h"
#include "engine/run/cases.h"
#include "engine/run/coupling.h"
#include "engine/run/fidelity.h"
#include "engine/run/runner.h"
#include "engine/run/separation.h"
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
std::string resume_command(const Options& options) {
  std::vector<std::string> words{options.program, "run", options.study};
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

/// A study that is ready to run.
struct Job {
  const Study& study;
  const Model& model;
  SelectedPoses poses;
  std::string path;
  RunOptions options;
  const ResumableRun& kept;
};

/// How a study's solves ended, and what they took, in all parts of the run.
struct Ended {
  Ended(const Job& job, const SolveCounts& counts) : solves(counts) {
    const RunTime time = job.kept.time();
    facts = run_facts(time.wall, job.options.threads, counts.total());
    facts.checkpoint_seconds = time.checkpoints;
  }

  SolveCounts solves;
  RunFacts facts;
};

std::vector<double> sigma_of(const Plan& plan) {
  std::vector<double> sigma;
  for (const Distribution& distribution : plan.distributions()) sigma.push_back(distribution.standard_deviation());
  return sigma;
}

std::vector<Dimension> response_dimensions(const ModelDescription& model) {
  std::vector<Dimension> dimensions;
  for (const Response& response : model.responses) dimensions.push_back(response.dimension);
  return dimensions;
}

// Each runs a study of its kind and writes the result; nothing when it was interrupted.

/// The study at both of its fidelities, on the same draws.
std::optional<SensitivityResult> run_both_fidelities(const Job& job, const Plan& plan, SolveCounts& solves) {
  const Analysis& analysis = job.study.analysis;
  // Progress is that of both as one run. A first half that reports none was done by the run that is continued.
  std::uint64_t before = plan.solves();
  RunOptions options = job.options;
  options.progress = [&](const Progress& half) {
    before = half.before;
    job.options.progress({half.solves, 2 * half.total, half.not_converged, before});
  };
  auto first = run_sensitivity(plan, job.model, analysis.conf_level, options);
  if (!first) return std::nullopt;
  solves = first->total();
  options.progress = [&](const Progress& half) {
    job.options.progress({solves.total() + half.solves, 2 * half.total, solves.not_converged() + half.not_converged,
                          before + half.before});
  };
  const std::unique_ptr<Model> other = build_model(at_compared_fidelity(job.study.mechanism));
  const auto second = run_sensitivity(plan, *other, analysis.conf_level, options);
  if (!second) return std::nullopt;
  solves.merge(second->total());
  first->fidelity =
      compare_fidelities(*first, *second, response_dimensions(job.study.model()), sigma_of(plan), analysis.linearity);
  return first;
}

std::optional<Ended> run_sensitivity_study(const Job& job) {
  const Plan plan(job.study, job.poses.poses);
  SolveCounts solves;
  auto result = job.study.mechanism.compared
                    ? run_both_fidelities(job, plan, solves)
                    : run_sensitivity(plan, job.model, job.study.analysis.conf_level, job.options);
  if (!result) return std::nullopt;
  if (!result->fidelity) solves = result->total();
  if (job.model.description().separation) {
    result->separation = separate_errors(job.model, plan.poses(), plan.factors(), sigma_of(plan));
  }
  const Ended ended(job, solves);
  write_sensitivity(job.path, job.study, job.poses, *result, ended.facts);
  return ended;
}

std::optional<Ended> run_identification_study(const Job& job) {
  const auto result = run_identification(job.study, job.model, job.poses.poses, job.options);
  if (!result) return std::nullopt;
  const Ended ended(job, result->solves);
  write_identification(job.path, job.study, job.poses, *result, ended.facts);
  return ended;
}

std::optional<Ended> run_cases_study(const Job& job) {
  auto evaluation = run_evaluation(job.model, job.study.solver, job.poses.poses, case_table(job.study.analysis.cases),
                                   Pairing::every_pose_with_every_row, job.options);
  if (!evaluation) return std::nullopt;
  const Ended ended(job, evaluation->total());
  write_cases(job.path, job.study, job.poses, case_result(std::move(*evaluation), job.study.not_converged),
              ended.facts);
  return ended;
}

std::optional<Ended> run_monte_carlo_study(const Job& job) {
  const Plan plan(job.study, job.poses.poses);
  const auto result = run_monte_carlo(plan, job.model, job.study.analysis, job.options);
  if (!result) return std::nullopt;
  const Ended ended(job, result->total());
  write_monte_carlo(job.path, job.study, job.poses, *result, ended.facts);
  return ended;
}

std::optional<Ended> run_coupling_study(const Job& job) {
  const CouplingStudy& coupling = job.study.analysis.coupling;
  const ModelDescription& model = job.model.description();
  const auto evaluation = run_evaluation(job.model, job.study.solver, job.poses.poses, coupling_table(coupling, model),
                                         Pairing::every_pose_with_every_row, job.options, Outcomes::responses);
  if (!evaluation) return std::nullopt;
  const CouplingResult result = coupling_result(*evaluation, coupling, model, job.study.not_converged);
  const Ended ended(job, result.total());
  write_coupling(job.path, job.study, job.poses, result, ended.facts);
  return ended;
}

std::optional<Ended> run_study(const Job& job) {
  switch (job.study.analysis.kind) {
    case Analysis::Kind::sensitivity:
      return run_sensitivity_study(job);
    case Analysis::Kind::identification:
      return run_identification_study(job);
    case Analysis::Kind::evaluate:
      return run_cases_study(job);
    case Analysis::Kind::monte_carlo:
      return run_monte_carlo_study(job);
    case Analysis::Kind::coupling:
      break;
  }
  return run_coupling_study(job);
}

/// Says what came out; the exit code.
int finish(const Job& job, const std::string& study_path, const Ended& ended) {
  const std::uint64_t failed = ended.solves.not_converged();
  std::fputs(fmt::format("{}: {} solves in {:.2f} s on {} threads, {} not converged\n", job.path, ended.facts.solves,
                         ended.facts.wall_seconds, ended.facts.threads, failed)
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

int run(const Options& options) {
  const std::atomic<bool>& stop = catch_interrupts();
  Study study = read_study(options.study, registry(), StudyUse::run);
  if (options.seed) study.seed = *options.seed;
  const std::string path = options.result.empty() ? default_result(options.study) : options.result;
  check_result_path(path);
  ResumableRun resumable(options.resume, path, resume_command(options));
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  SelectedPoses poses = select_poses(study.poses, *model);
  resumable.start(identity_of(study, poses.poses), options.quiet);
  ProgressPrinter printer(options.quiet);
  const auto on_progress = [&](const Progress& progress) {
    printer(progress);
    resumable.check_time();
  };
  const Job job{study,
                *model,
                std::move(poses),
                path,
                {resolved_threads(options.threads), on_progress, &stop, &resumable.checkpoints()},
                resumable};
  const std::optional<Ended> ended = run_to_end(job, resumable, printer);
  if (!ended) {
    resumable.explain_interruption();
    return kInterrupted;
  }
  resumable.finish();
  return finish(job, options.study, *ended);
}

}  // namespace

void add_run(CLI::App& program, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("run", "run a study and write its result");
  command->add_option("study", options->study, "study file (TOML)")->required()->type_name("STUDY.toml");
  command->add_option("-o,--output", options->result, "result file; default: the study's name with .h5, here")
      ->type_name("RESULT.h5");
  command->add_option("--threads", options->threads, "number of threads; default: one per processor")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1024}))
      ->type_name("N");
  command->add_option("--seed", options->seed, "seed, instead of the study's")
      ->check(CLI::Range(std::uint64_t{0}, std::uint64_t{0x7fffffffffffffff}))
      ->type_name("S");
  command->add_flag("--quiet", options->quiet, "no progress");
  options->resume.add_to(*command);
  command->footer(
      "Ctrl-C or SIGTERM stops a run so that --resume continues it; Ctrl-C again stops at once.\n"
      "Example: poesy run study.toml -o result.h5 --threads 2");
  command->callback([options, &program, &action] {
    options->program = program.get_name();
    action = [options] { return run(*options); };
  });
}

}  // namespace poesy::app
