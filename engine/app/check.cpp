#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/duration.h"
#include "engine/app/exit_code.h"
#include "engine/io/study_file.h"
#include "engine/run/cases.h"
#include "engine/run/coupling_rows.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/monte_carlo.h"
#include "engine/run/rounds.h"
#include "engine/run/runner.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

/// What a study will ask of this machine.
struct Outlook {
  std::string solves;     ///< their number, and what it is the product of
  std::size_t bytes;      ///< of the result
  double thread_seconds;  ///< that one thread would take
  double least = 1.0;     ///< share of the solves that are made in any case
};

/// What adaptive samples leave open: "1000 to 100000".
std::string samples_text(const Plan& plan) {
  const std::size_t least = least_samples(plan);
  return least == plan.samples() ? std::to_string(least) : fmt::format("{} to {}", least, plan.samples());
}

std::string solves_text(const Plan& plan, std::size_t fidelities) {
  const std::uint64_t most = fidelities * plan.solves();
  const std::size_t least = least_samples(plan);
  if (least == plan.samples()) return fmt::format("{} solves", most);
  return fmt::format("at least {} and at most {} solves", most / plan.samples() * least, most);
}

double least_share(const Plan& plan) {
  return static_cast<double>(least_samples(plan)) / static_cast<double>(plan.samples());
}

/// Runs pieces of a study for about a quarter of a second. run_piece(at) runs one that stands at this share of the
/// study, 0 <= at < 1, and gives the share of the whole that it was.
template <class RunPiece>
double measured_seconds(const RunPiece& run_piece) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t kPieces = 64;
  const auto start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  double done = 0.0;
  for (std::size_t n = 0; n < kPieces && elapsed() < 0.25; ++n) {
    // The golden ratio spreads any number of pieces evenly.
    const double at = static_cast<double>(n) * 0.6180339887498949;
    done += run_piece(at - std::floor(at));
  }
  return elapsed() / done;
}

template <class Evaluate>
double sampling_seconds(const Plan& plan, Evaluate evaluate) {
  return measured_seconds([&](double at) {
    WorkUnit unit = plan.unit(static_cast<std::size_t>(at * static_cast<double>(plan.units())));
    unit.count = std::min<std::size_t>(unit.count, 200);
    return static_cast<double>(evaluate(unit).solves.total()) / static_cast<double>(plan.solves());
  });
}

Outlook sensitivity_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const Plan plan(study, poses);
  const std::size_t cells = plan.factors().size() * poses.size();
  const std::size_t per_response = sizeof(Moments) + 6 * sizeof(double);
  const std::size_t fidelities = study.mechanism.compared ? 2 : 1;
  Outlook expected{
      fmt::format("{} errors x {} poses x {} samples{} = {}", plan.factors().size(), poses.size(), samples_text(plan),
                  fidelities == 2 ? " x 2 fidelities" : "", solves_text(plan, fidelities)),
      fidelities * cells * (study.model().responses.size() * per_response + sizeof(UnitStats) + sizeof(SolveCounts)),
      sampling_seconds(plan, UnitEvaluator(plan, model)), least_share(plan)};
  if (fidelities == 1) return expected;
  const std::unique_ptr<Model> other = build_model(at_compared_fidelity(study.mechanism));
  expected.thread_seconds += sampling_seconds(plan, UnitEvaluator(plan, *other));
  return expected;
}

Outlook monte_carlo_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const Plan plan(study, poses);
  const std::size_t per_response = (7 + study.analysis.quantiles.size()) * sizeof(double);
  return {fmt::format("{} poses x {} samples of {} errors together = {}", poses.size(), samples_text(plan),
                      plan.factors().size(), solves_text(plan, 1)),
          poses.size() * (study.model().responses.size() * per_response + sizeof(SolveCounts)),
          sampling_seconds(plan, PoseUnitEvaluator(plan, model)), least_share(plan)};
}

/// Bytes that an evaluation of this many rows at each pose keeps.
std::size_t evaluation_bytes(const ModelDescription& model, std::size_t poses, std::size_t rows, Outcomes outcomes) {
  std::size_t numbers = model.responses.size();
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : model.details) numbers += detail.components.size();
  }
  return poses * rows * (numbers * sizeof(double) + sizeof(SolveStatus) + sizeof(std::uint32_t));
}

/// Seconds of a study that solves tables of errors, from run_poses(poses) for a few of its poses.
template <class RunPoses>
double table_seconds(const PoseSet& poses, const RunPoses& run_poses) {
  const std::size_t count = std::min<std::size_t>(poses.size(), 4);
  return measured_seconds([&](double at) {
    std::vector<double> some;
    for (std::size_t k = 0; k < count; ++k) {
      const auto m = static_cast<std::size_t>(at * static_cast<double>(poses.size())) + k * poses.size() / count;
      const auto pose = poses[PoseIndex(m % poses.size())];
      some.insert(some.end(), pose.begin(), pose.end());
    }
    run_poses(PoseSet(poses.coordinates(), std::move(some)));
    return static_cast<double>(count) / static_cast<double>(poses.size());
  });
}

Outlook identification_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const std::size_t errors = study.analysis.factors.size();
  const std::size_t groups = study.analysis.groups.size();
  return {fmt::format("{} errors x {} groups x {} poses = {} solves, and more for couplings", errors, groups,
                      poses.size(), errors * groups * poses.size()),
          evaluation_bytes(study.model(), poses.size(), errors * groups, Outcomes::responses),
          table_seconds(poses, [&](const PoseSet& some) {
            static_cast<void>(run_identification(study, model, some, {1, {}, {}}));
          })};
}

Outlook cases_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const ErrorTable table = case_table(study.analysis.cases);
  return {fmt::format("{} cases x {} poses = {} solves", table.rows, poses.size(), table.rows * poses.size()),
          evaluation_bytes(study.model(), poses.size(), table.rows, Outcomes::with_details),
          table_seconds(poses, [&](const PoseSet& some) {
            static_cast<void>(
                run_evaluation(model, study.solver, some, table, Pairing::every_pose_with_every_row, {1, {}, {}}));
          })};
}

Outlook coupling_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const CouplingStudy& coupling = study.analysis.coupling;
  const CouplingRows rows = coupling_rows(coupling, study.model());
  const ErrorTable table = coupling_table(coupling, study.model());
  const std::size_t kept = 6 * sizeof(double) * coupling.sizes() * rows.subsets.size() * study.model().responses.size();
  return {fmt::format("{} sizes x {} sets of errors x {} poses = {} solves", coupling.sizes(), rows.errors.size(),
                      poses.size(), table.rows * poses.size()),
          kept * poses.size(), table_seconds(poses, [&](const PoseSet& some) {
            static_cast<void>(run_evaluation(model, study.solver, some, table, Pairing::every_pose_with_every_row,
                                             {1, {}, {}}, Outcomes::responses));
          })};
}

Outlook outlook(const Study& study, const Model& model, const PoseSet& poses) {
  switch (study.analysis.kind) {
    case Analysis::Kind::sensitivity:
      return sensitivity_outlook(study, model, poses);
    case Analysis::Kind::identification:
      return identification_outlook(study, model, poses);
    case Analysis::Kind::evaluate:
      return cases_outlook(study, model, poses);
    case Analysis::Kind::monte_carlo:
      return monte_carlo_outlook(study, model, poses);
    case Analysis::Kind::coupling:
      break;
  }
  return coupling_outlook(study, model, poses);
}

/// What a trajectory asks of the mechanism; empty for other poses.
std::string trajectory_line(const SelectedPoses& poses, const ModelDescription& model) {
  if (poses.time.empty()) return {};
  std::string text = fmt::format("# trajectory: {} poses from {:.6g} s to {:.6g} s", poses.poses.size(),
                                 poses.time.front(), poses.time.back());
  for (std::size_t c = 0; c < model.pose_coordinates.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    const std::vector<double> values = poses.poses.column(c);
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    text += fmt::format(", {} {} to {}", coordinate.name, readable_text({*least, coordinate.dimension}, 6),
                        readable_text({*most, coordinate.dimension}, 6));
  }
  return text + "\n";
}

/// seconds: of all solves that there may be.
std::string time_text(const Outlook& expected, double seconds) {
  if (expected.least == 1.0) return "about " + readable_duration(seconds);
  return "at least about " + readable_duration(expected.least * seconds) + ", at most about " +
         readable_duration(seconds);
}

int check(const std::string& path) {
  const Study study = read_study(path, registry(), StudyUse::run);
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const SelectedPoses poses = select_poses(study.poses, *model);
  std::fputs(resolved_text(study).c_str(), stdout);
  const std::size_t threads = resolved_threads(0);
  const Outlook expected = outlook(study, *model, poses.poses);
  std::fputs(fmt::format("\n# valid: {}\n"
                         "# memory for the result: about {:.3g} MB\n"
                         "# time: {} on {} threads of this machine\n",
                         expected.solves, static_cast<double>(expected.bytes) / 1e6,
                         time_text(expected, expected.thread_seconds / static_cast<double>(threads)), threads)
                 .c_str(),
             stdout);
  std::fputs(trajectory_line(poses, study.model()).c_str(), stdout);
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
  command->footer(footer("", {{"is it valid, and how long will it take?", "poesy check study.toml"}}));
  command->callback([study, &action] { action = [study] { return check(*study); }; });
}

}  // namespace poesy::app
