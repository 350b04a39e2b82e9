#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/exit_code.h"
#include "engine/io/study_file.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/runner.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// Solves per second of one thread, measured on units spread over the plan for about a quarter of a second.
double measured_rate(const Plan& plan, const Model& model) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kProbes = 64;
  UnitEvaluator evaluate(plan, model);
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  std::uint64_t solves = 0;
  for (std::size_t n = 0; n < kProbes && elapsed() < 0.25; ++n) {
    // The golden ratio spreads any number of probes evenly over the table.
    const double at = static_cast<double>(n) * 0.6180339887498949;
    WorkUnit unit = plan.unit(static_cast<std::size_t>((at - static_cast<double>(static_cast<std::size_t>(at))) *
                                                       static_cast<double>(plan.units())));
    unit.count = std::min<std::size_t>(unit.count, 200);
    solves += evaluate(unit).solves.total();
  }
  return static_cast<double>(solves) / elapsed();
}

double result_megabytes(const Plan& plan, const ModelDescription& model) {
  const std::size_t cells = plan.factors().size() * plan.poses().size();
  const std::size_t per_response = sizeof(Moments) + 6 * sizeof(double);
  return static_cast<double>(cells *
                             (model.responses.size() * per_response + sizeof(UnitStats) + sizeof(SolveCounts))) /
         1e6;
}

int check(const std::string& path) {
  const Study study = read_study(path, registry(), StudyUse::run);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const SelectedPoses poses = select_poses(study.poses, *model);
  const Plan plan(study, poses.poses);
  std::fputs(resolved_text(study).c_str(), stdout);
  const std::size_t threads = resolved_threads(0);
  const double seconds =
      static_cast<double>(plan.solves()) / (measured_rate(plan, *model) * static_cast<double>(threads));
  std::fputs(fmt::format("\n# valid: {} errors x {} poses x {} samples = {} solves\n"
                         "# memory for the result: about {:.3g} MB\n"
                         "# time: about {:.2g} s on {} threads of this machine\n",
                         plan.factors().size(), plan.poses().size(), plan.samples(), plan.solves(),
                         result_megabytes(plan, model->description()), seconds, threads)
                 .c_str(),
             stdout);
  for (const RejectedPoses& rejected : poses.rejected) {
    std::fputs(fmt::format("# rejected: {} candidate poses, {}\n", rejected.count, rejected.reason).c_str(), stdout);
  }
  return kDone;
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
  auto study = std::make_shared<std::string>();
  CLI::App* command =
      program.add_subcommand("check", "validate a study; print it resolved, with its solves, memory and time");
  command->add_option("study", *study, "study file (TOML)")->required()->type_name("STUDY.toml");
  command->footer("Example: poesy check study.toml");
  command->callback([study, &action] { action = [study] { return check(*study); }; });
}

}  // namespace poesy::app
