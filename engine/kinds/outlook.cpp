#include "engine/kinds/outlook.h"

#include <algorithm>
#include <memory>
#include <string_view>
#include <utility>

#include "engine/kinds/coupling/options.h"
#include "engine/kinds/coupling/rows.h"
#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/evaluate/options.h"
#include "engine/kinds/identification/options.h"
#include "engine/kinds/monte_carlo/collector.h"
#include "engine/kinds/monte_carlo/options.h"
#include "engine/kinds/sensitivity/linearity.h"
#include "engine/kinds/sensitivity/options.h"
#include "engine/kinds/sensitivity/separation.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/pose_unit.h"
#include "engine/run/rounds.h"
#include "engine/run/runner.h"

namespace poesy {
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
  return least == plan.samples() ? std::to_string(least)
                                 : std::to_string(least) + " to " + std::to_string(plan.samples());
}

std::string solves_text(const Plan& plan, std::size_t fidelities) {
  const std::uint64_t most = fidelities * plan.solves();
  const std::size_t least = least_samples(plan);
  if (least == plan.samples()) return std::to_string(most) + " solves";
  return "at least " + std::to_string(most / plan.samples() * least) + " and at most " + std::to_string(most) +
         " solves";
}

/// "3 errors x "
std::string factor_text(std::size_t count, std::string_view things) {
  return std::to_string(count).append(" ").append(things);
}

double least_share(const Plan& plan) {
  return static_cast<double>(least_samples(plan)) / static_cast<double>(plan.samples());
}

/// All draws of the plan; a piece is a few of one unit.
template <class SolveUnit>
WorkOutlook sampling(const std::shared_ptr<const Plan>& plan, const std::shared_ptr<const Model>& model, double times) {
  struct Sampler {
    std::shared_ptr<const Plan> plan;
    std::shared_ptr<const Model> model;
    SolveUnit solve;
  };
  const auto sampler = std::make_shared<Sampler>(Sampler{plan, model, SolveUnit(*plan, *model)});
  return {[sampler](double at) {
            const Plan& all = *sampler->plan;
            WorkUnit unit = all.unit(static_cast<std::size_t>(at * static_cast<double>(all.units())));
            unit.count = std::min<std::size_t>(unit.count, 200);
            return static_cast<double>(sampler->solve(unit).solves.total()) / static_cast<double>(all.solves());
          },
          times};
}

/// A model that somebody else owns.
std::shared_ptr<const Model> borrowed(const Model& model) { return {std::shared_ptr<const Model>(), &model}; }

/// So many of each.
MemoryOutlook times(std::size_t count, const MemoryOutlook& each) {
  return {count * each.accumulators, count * each.state, count * each.result, count * each.file};
}

/// Separating the errors of a sensitivity study at one pose of all.
WorkOutlook separating(const Study& study, const Model& model, const PoseSet& poses) {
  return {[&](double at) {
    const auto pose = poses[PoseIndex(static_cast<std::size_t>(at * static_cast<double>(poses.size())))];
    const PoseSet one(poses.coordinates(), std::vector<double>(pose.begin(), pose.end()));
    static_cast<void>(separate_errors(model, one, study.analysis.factors, standard_deviations(study)));
    return 1.0 / static_cast<double>(poses.size());
  }};
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
  const auto plan = std::make_shared<const Plan>(study, poses);
  const std::size_t fidelities = study.mechanism.compared ? 2 : 1;
  const double with_changes = 1.0 + index_change_solves(*plan) / static_cast<double>(plan->solves());
  Outlook expected{.solves = factor_text(plan->factors().size(), "errors x ") + factor_text(poses.size(), "poses x ") +
                             samples_text(*plan) + " samples" + (fidelities == 2 ? " x 2 fidelities" : "") + " = " +
                             solves_text(*plan, fidelities),
                   .memory = sensitivity_memory(study, *plan, fidelities),
                   .shared = {sampling<UnitEvaluator>(plan, borrowed(model), with_changes)},
                   .by_one = {},
                   .least = least_share(*plan)};
  if (model.description().separation) expected.by_one.push_back(separating(study, model, poses));
  if (fidelities == 2) {
    const std::shared_ptr<const Model> other = build_model(at_compared_fidelity(study.mechanism));
    expected.shared.push_back(sampling<UnitEvaluator>(plan, other, 1.0));
  }
  return expected;
}

MemoryOutlook monte_carlo_memory(const Study& study, const Plan& plan) {
  constexpr std::size_t kNumbers = 8;  // mean, its interval, std, min, max, count, rms
  const std::size_t responses = study.model().responses.size();
  // Quantiles with both ends of their intervals, and the magnitude that a share of the draws is judged by.
  const MonteCarloOptions& asked = asked_of<MonteCarloOptions>(study.analysis);
  const std::size_t of_sketch = 3 * asked.quantiles.size() + (asked.judge == Judge::share ? 1 : 0);
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
  const auto plan = std::make_shared<const Plan>(study, poses);
  return {.solves = factor_text(poses.size(), "poses x ") + samples_text(*plan) + " samples of " +
                    factor_text(plan->factors().size(), "errors together = ") + solves_text(*plan, 1),
          .memory = monte_carlo_memory(study, *plan),
          .shared = {sampling<PoseUnitEvaluator>(plan, borrowed(model), 1.0)},
          .by_one = {},
          .least = least_share(*plan)};
}

/// Bytes of the outcomes of one row of errors at one pose.
std::size_t outcome_bytes(const ModelDescription& model, Outcomes outcomes) {
  std::size_t numbers = model.responses.size();
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : model.details) numbers += detail.components.size();
  }
  return numbers * sizeof(double) + sizeof(SolveStatus) + sizeof(std::uint32_t);
}

/// Work of a study that solves tables of errors: run_poses(poses) does it for a few of its poses.
template <class RunPoses>
WorkOutlook table_work(const PoseSet& poses, RunPoses run_poses) {
  return {[&poses, run_poses](double at) {
    const std::size_t count = std::min<std::size_t>(poses.size(), 4);
    std::vector<double> some;
    for (std::size_t k = 0; k < count; ++k) {
      const auto m = static_cast<std::size_t>(at * static_cast<double>(poses.size())) + k * poses.size() / count;
      const auto pose = poses[PoseIndex(m % poses.size())];
      some.insert(some.end(), pose.begin(), pose.end());
    }
    run_poses(PoseSet(poses.coordinates(), std::move(some)));
    return static_cast<double>(count) / static_cast<double>(poses.size());
  }};
}

/// Every pose with every row of errors.
WorkOutlook table_work(const Study& study, const Model& model, const PoseSet& poses, ErrorTable table,
                       Outcomes outcomes) {
  return table_work(poses, [&study, &model, table = std::move(table), outcomes](const PoseSet& some) {
    static_cast<void>(
        run_evaluation(model, study.solver, some, table, Pairing::every_pose_with_every_row, {.threads = 1}, outcomes));
  });
}

Outlook identification_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const std::size_t errors = study.analysis.factors.size();
  const std::size_t groups = asked_of<IdentificationOptions>(study.analysis).groups.size();
  const std::size_t solves = errors * groups * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::responses);
  return {.solves = factor_text(errors, "errors x ") + factor_text(groups, "groups x ") +
                    factor_text(poses.size(), "poses = ") + factor_text(solves, "solves, and more for couplings"),
          .memory = {.accumulators = outcomes, .state = outcomes},
          .shared = {table_work(
              poses,
              [&](const PoseSet& some) { static_cast<void>(run_identification(study, model, some, {.threads = 1})); })},
          .by_one = {}};
}

Outlook cases_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const ErrorTable table = case_table(asked_of<CaseOptions>(study.analysis).cases);
  const std::size_t solves = table.rows * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::with_details);
  // The file has cases before poses: a transposed copy of the outcomes.
  return {.solves = factor_text(table.rows, "cases x ") + factor_text(poses.size(), "poses = ") +
                    factor_text(solves, "solves"),
          .memory = {.accumulators = outcomes, .state = outcomes, .result = outcomes, .file = outcomes},
          .shared = {table_work(study, model, poses, table, Outcomes::with_details)},
          .by_one = {}};
}

Outlook coupling_outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const CouplingStudy& coupling = asked_of<CouplingStudy>(study.analysis);
  const CouplingRows rows = coupling_rows(coupling, study.model());
  const ErrorTable table = coupling_table(coupling, study.model());
  const std::size_t solves = table.rows * poses.size();
  const std::size_t outcomes = solves * outcome_bytes(study.model(), Outcomes::responses);
  const std::size_t cells = coupling.sizes() * poses.size();
  const std::size_t curves = 6 * sizeof(double) * cells * rows.subsets.size() * study.model().responses.size();
  // The state is copied while it grows, and one of the six curves while it is hashed.
  return {.solves = factor_text(coupling.sizes(), "sizes x ") + factor_text(rows.errors.size(), "sets of errors x ") +
                    factor_text(poses.size(), "poses = ") + factor_text(solves, "solves"),
          .memory = {.accumulators = 2 * outcomes + curves / 6,
                     .state = outcomes,
                     .result = curves + cells * sizeof(SolveCounts),
                     .file = curves + cells * kSolverColumns},
          .shared = {table_work(study, model, poses, table, Outcomes::responses)},
          .by_one = {}};
}

}  // namespace

Outlook outlook(const Study& study, const Model& model, const PoseSet& poses) {
  const StudyKind* kind = study.analysis.kind;
  if (kind == &kSensitivityStudy) return sensitivity_outlook(study, model, poses);
  if (kind == &kIdentificationStudy) return identification_outlook(study, model, poses);
  if (kind == &kEvaluateStudy) return cases_outlook(study, model, poses);
  if (kind == &kMonteCarloStudy) return monte_carlo_outlook(study, model, poses);
  return coupling_outlook(study, model, poses);
}

}  // namespace poesy
