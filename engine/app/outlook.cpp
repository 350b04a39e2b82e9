#include "engine/app/outlook.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "engine/io/content_hash.h"
#include "engine/io/h5.h"
#include "engine/run/cases.h"
#include "engine/run/coupling_rows.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/linearity.h"
#include "engine/run/monte_carlo.h"
#include "engine/run/monte_carlo_collector.h"
#include "engine/run/rounds.h"
#include "engine/run/runner.h"
#include "engine/run/separation.h"

namespace poesy::app {
namespace {

// What a state takes of some numbers (base/bytes.h): whole numbers up to two million take three bytes at the most.
constexpr std::size_t kWholeNumber = 3;
constexpr std::size_t kStoredMoments = kWholeNumber + 4 * sizeof(double);
constexpr std::size_t kStoredSolves = (kStatusNames.size() + 2) * kWholeNumber;
/// What /solver has of a cell: failures, mean and most iterations, samples by status.
constexpr std::size_t kSolverColumns = (2 + kStatusNames.size()) * sizeof(double) + sizeof(std::uint32_t);
/// A list of its own on the heap, as glibc keeps it.
constexpr std::size_t kAllocation = 2 * sizeof(void*);

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

/// Runs pieces of a study for about a quarter of a second. run_piece(at) runs one that begins at this share of the
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

/// So many of each.
MemoryOutlook times(std::size_t count, const MemoryOutlook& each) {
  return {count * each.accumulators, count * each.state, count * each.result, count * each.file};
}

/// Seconds that one thread takes for each byte of a result file: HDF5 composes it, it is hashed and copied.
double composing_seconds() {
  constexpr std::size_t kNumbers = 1 << 17U;
  const std::vector<double> numbers(kNumbers, 1.0);
  const auto start = std::chrono::steady_clock::now();
  h5::File file = h5::File::in_memory();
  file.write<double>("/numbers", {kNumbers}, numbers);
  static_cast<void>(content_sha256(file));
  const std::size_t bytes = file.image().size();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / static_cast<double>(bytes);
}

/// Seconds that one thread takes to separate the errors of a sensitivity study, for the pose in the middle times poses.
double separation_seconds(const Study& study, const Model& model, const PoseSet& poses) {
  if (!model.description().separation) return 0.0;
  const auto middle = poses[PoseIndex(poses.size() / 2)];
  const PoseSet one(poses.coordinates(), std::vector<double>(middle.begin(), middle.end()));
  const auto start = std::chrono::steady_clock::now();
  static_cast<void>(separate_errors(model, one, study.analysis.factors, standard_deviations(study)));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return seconds * static_cast<double>(poses.size());
}

MemoryOutlook sensitivity_memory(const Study& study, const Plan& plan, std::size_t fidelities) {
  const std::size_t responses = study.model().responses.size();
  const std::size_t numbers = 6 * responses * sizeof(double);  // local, its interval, count, mean, std
  const std::size_t separated = study.model().separation ? 5 * sizeof(double) : 0;
  const std::size_t last_units = plan.samples() % Plan::kUnitSamples != 0 ? 2 : 1;  // kept apart from whole ones
  MemoryOutlook of_cell{last_units * (sizeof(UnitStats) + kAllocation + responses * sizeof(Moments)),
                        fidelities * (responses * kStoredMoments + kStoredSolves),
                        fidelities * (numbers + sizeof(SolveCounts)) + separated,
                        numbers + kSolverColumns + separated + (fidelities - 1) * sizeof(double)};
  return times(plan.cells(), of_cell);
}

Outlook sensitivity_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const Plan plan(study, poses);
  const std::size_t fidelities = study.mechanism.compared ? 2 : 1;
  const double once = sampling_seconds(plan, UnitEvaluator(plan, model));
  const double of_two_sizes = once * index_change_solves(plan) / static_cast<double>(plan.solves());
  Outlook expected{
      fmt::format("{} errors x {} poses x {} samples{} = {}", plan.factors().size(), poses.size(), samples_text(plan),
                  fidelities == 2 ? " x 2 fidelities" : "", solves_text(plan, fidelities)),
      sensitivity_memory(study, plan, fidelities), once + of_two_sizes, separation_seconds(study, model, poses),
      least_share(plan)};
  if (fidelities == 1) return expected;
  const std::unique_ptr<Model> other = build_model(at_compared_fidelity(study.mechanism));
  expected.thread_seconds += sampling_seconds(plan, UnitEvaluator(plan, *other));
  return expected;
}

MemoryOutlook monte_carlo_memory(const Study& study, const Plan& plan) {
  constexpr std::size_t kNumbers = 8;  // mean, its interval, std, min, max, count, rms
  const std::size_t responses = study.model().responses.size();
  // Quantiles with both ends of their intervals, and the magnitude that a share of the draws is judged by.
  const std::size_t of_sketch = 3 * study.analysis.quantiles.size() + (study.analysis.judge == Judge::share ? 1 : 0);
  const std::size_t numbers = responses * (kNumbers + of_sketch) * sizeof(double);
  const MemoryOutlook of_pose{responses * sizeof(Moments) + sizeof(FailedSamples) + sizeof(SolveCounts) + sizeof(Bytes),
                              responses * (kStoredMoments + (2 + of_sketch) * sizeof(double)) + kStoredSolves,
                              numbers + sizeof(SolveCounts), numbers + kSolverColumns};
  MemoryOutlook memory = times(plan.poses().size(), of_pose);
  if (!plan.adaptive()) return memory;
  // Packed sketches of finished poses, for the next round.
  constexpr std::size_t kPackedSketch = 6000;
  const std::size_t kept =
      std::min(plan.poses().size() * responses * kPackedSketch, MonteCarloCollector::kMostKeptBytes);
  memory.accumulators += kept;
  memory.state += kept;
  return memory;
}

Outlook monte_carlo_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const Plan plan(study, poses);
  return {fmt::format("{} poses x {} samples of {} errors together = {}", poses.size(), samples_text(plan),
                      plan.factors().size(), solves_text(plan, 1)),
          monte_carlo_memory(study, plan), sampling_seconds(plan, PoseUnitEvaluator(plan, model)), 0.0,
          least_share(plan)};
}

/// Bytes of the outcomes of one row of errors at one pose.
std::size_t outcome_bytes(const ModelDescription& model, Outcomes outcomes) {
  std::size_t numbers = model.responses.size();
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : model.details) numbers += detail.components.size();
  }
  return numbers * sizeof(double) + sizeof(SolveStatus) + sizeof(std::uint32_t);
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
  const std::size_t outcomes = errors * groups * poses.size() * outcome_bytes(study.model(), Outcomes::responses);
  return {fmt::format("{} errors x {} groups x {} poses = {} solves, and more for couplings", errors, groups,
                      poses.size(), errors * groups * poses.size()),
          {outcomes, outcomes, 0, 0},
          table_seconds(poses, [&](const PoseSet& some) {
            static_cast<void>(run_identification(study, model, some, {1, {}, {}}));
          })};
}

Outlook cases_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const ErrorTable table = case_table(study.analysis.cases);
  const std::size_t outcomes = table.rows * poses.size() * outcome_bytes(study.model(), Outcomes::with_details);
  // The file has cases before poses: a transposed copy of the outcomes.
  return {fmt::format("{} cases x {} poses = {} solves", table.rows, poses.size(), table.rows * poses.size()),
          {outcomes, outcomes, outcomes, outcomes},
          table_seconds(poses, [&](const PoseSet& some) {
            static_cast<void>(
                run_evaluation(model, study.solver, some, table, Pairing::every_pose_with_every_row, {1, {}, {}}));
          })};
}

Outlook coupling_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const CouplingStudy& coupling = study.analysis.coupling;
  const CouplingRows rows = coupling_rows(coupling, study.model());
  const ErrorTable table = coupling_table(coupling, study.model());
  const std::size_t outcomes = table.rows * poses.size() * outcome_bytes(study.model(), Outcomes::responses);
  const std::size_t curves =
      6 * sizeof(double) * coupling.sizes() * rows.subsets.size() * study.model().responses.size() * poses.size();
  // The state is copied while it grows, and one of the six curves while it is hashed.
  return {fmt::format("{} sizes x {} sets of errors x {} poses = {} solves", coupling.sizes(), rows.errors.size(),
                      poses.size(), table.rows * poses.size()),
          {2 * outcomes + curves / 6, outcomes, curves + coupling.sizes() * poses.size() * sizeof(SolveCounts),
           curves + coupling.sizes() * poses.size() * kSolverColumns},
          table_seconds(poses, [&](const PoseSet& some) {
            static_cast<void>(run_evaluation(model, study.solver, some, table, Pairing::every_pose_with_every_row,
                                             {1, {}, {}}, Outcomes::responses));
          })};
}

Outlook of_solves(const Study& study, const Model& model, const PoseSet& poses) {
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

}  // namespace

Outlook outlook(const Study& study, const Model& model, const PoseSet& poses) {
  Outlook expected = of_solves(study, model, poses);
  expected.serial_seconds += static_cast<double>(expected.memory.file) * composing_seconds();
  return expected;
}

}  // namespace poesy::app
