#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <optional>

#include "engine/app/command.h"
#include "engine/app/exit_code.h"
#include "engine/app/facts.h"
#include "engine/app/interrupt.h"
#include "engine/app/progress.h"
#include "engine/io/result_file.h"
#include "engine/io/study_file.h"
#include "engine/run/runner.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

struct Options {
  std::string study;
  std::string result;
  std::size_t threads = 0;
  std::optional<std::uint64_t> seed;
  bool quiet = false;
};

/// study.toml gives study.h5 in the current folder.
std::string default_result(const std::string& study) {
  return std::filesystem::path(study).filename().replace_extension(".h5").string();
}

int run(const Options& options) {
  Study study = read_study(options.study, registry(), StudyUse::run);
  if (options.seed) study.seed = *options.seed;
  const std::string path = options.result.empty() ? default_result(options.study) : options.result;
  check_result_path(path);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const SelectedPoses poses = select_poses(study.poses, *model);
  const Plan plan(study, poses.poses);
  const auto start = std::chrono::steady_clock::now();
  const std::size_t threads = resolved_threads(options.threads);
  std::optional<SensitivityResult> result;
  {
    ProgressPrinter printer(options.quiet);
    result = run_sensitivity(plan, *model, study.analysis.conf_level,
                             {threads, [&](const Progress& progress) { printer(progress); }, &catch_interrupts()});
  }
  if (!result) {
    std::fputs("poesy: interrupted; nothing was written, run the study again\n", stderr);
    return kInterrupted;
  }
  const RunFacts facts = run_facts(start, threads, plan.solves());
  write_sensitivity(path, study, poses, *result, facts);
  const std::uint64_t failed = result->total().not_converged();
  std::fputs(fmt::format("{}: {} solves in {:.2f} s on {} threads, {} not converged\n", path, facts.solves,
                         facts.wall_seconds, threads, failed)
                 .c_str(),
             stdout);
  if (study.not_converged != NotConverged::fail || failed == 0) return kDone;
  std::fputs(fmt::format("poesy: {}: {} samples did not converge and the study allows none; the result is kept, "
                         "see /solver/not_converged in {}\n",
                         options.study, failed, path)
                 .c_str(),
             stderr);
  return kTooManyNotConverged;
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
  command->footer("Example: poesy run study.toml -o result.h5 --threads 2");
  command->callback([options, &action] { action = [options] { return run(*options); }; });
}

}  // namespace poesy::app
