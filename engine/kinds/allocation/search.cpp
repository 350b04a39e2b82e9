#include "engine/kinds/allocation/search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/nan.h"
#include "engine/kinds/allocation/search_constants.h"
#include "engine/kinds/allocation/search_stages.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "engine/stats/proportion.h"

namespace poesy::allocation {

AllowedRejects allowed_rejects(double yield, double confidence, std::uint64_t machines) {
  const auto holds = [&](std::uint64_t rejects) {
    return proportion_at_least(machines - rejects, machines, confidence) >= yield;
  };
  std::uint64_t low = 0;  // largest number so far with which the certificate holds
  std::uint64_t high = machines;
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    (holds(middle) ? low : high) = middle;
  }
  // The number d for the design is the largest with d + z sqrt(2 d) <= low, where z is the quantile of the standard
  // normal distribution at 99 %. The factor 2 is needed because the numbers of rejects of design and certificate both
  // scatter.
  const double half = 0.5 * normal_quantile(1.0, 0.99) * std::sqrt(2.0);
  const double root = std::sqrt(half * half + static_cast<double>(low)) - half;
  return {low, static_cast<std::uint64_t>(root * root)};
}

std::uint64_t seed_of_others(const Study& study, SampleIndex set) {
  const StreamAddress address{study.seed, Purpose::seed_of_others, FactorIndex(0), PoseIndex(0)};
  return random_bits(address, set) >> 1U;  // 63 bits, because the integers of a study file are signed
}

SearchProblem::SearchProblem(const StudyRun& study_run)
    : run(study_run),
      options(asked_of<Options>(run.study.analysis)),
      programme(run.study, run.model),
      allowed(allowed_rejects(options.yield, options.confidence, run.study.analysis.samples)),
      calibration(machine_calibration(run.study, run.model, run.poses)) {}

std::unique_ptr<const MachineCalibration> SearchProblem::calibration_of(const Study& study) const {
  return calibration ? std::make_unique<const MachineCalibration>(calibration->of(study)) : nullptr;
}

void StageLog::add(std::string name, const Candidate& candidate, std::uint64_t machines, std::uint64_t rejects) {
  const auto& [point, chosen, share] = candidate;
  const bool by_programme = point.tolerance == chosen.tolerance;
  stages.push_back({std::move(name), point.cost, by_programme ? chosen.lower_bound : kNaN, share, machines, rejects});
  tolerance.insert(tolerance.end(), point.tolerance.begin(), point.tolerance.end());
}

std::optional<FoundTolerances> find_tolerances(const SearchProblem& problem) {
  refuse_perfect_beyond(problem);
  try {
    FoundTolerances found;
    auto [linearisation, design] =
        scale_to_yield(problem, settle(problem, linearise(problem, found.log), found.log), found.log);
    found.coarser_yield.assign(problem.programme.size(), kNaN);
    if (!design.screened.numbers.empty()) {  // otherwise the tolerances are the lowest ones, and there is nothing to
                                             // improve
      design = improve(problem, linearisation, std::move(design), found.log);
      design = scale_to_other_machines(problem, design, found.log);
      Probed probed = round_down(problem, use_remaining_yield(problem, std::move(design), found.log), found.log);
      design = std::move(probed.design);
      found.coarser_yield = std::move(probed.coarser_yield);
    }
    found.linearisation = std::move(linearisation);
    found.design = std::move(design);
    return found;
  } catch (const SearchStopped&) {
    return std::nullopt;
  }
}

ToleranceLimits limits_of(const SearchProblem& problem, const FoundTolerances& found) {
  return problem.programme.limits(found.linearisation.squares, found.linearisation.at, found.design.candidate.share);
}

double predicted_cost(const SearchProblem& problem, const FoundTolerances& found, double share, double wider) {
  const ToleranceLimits limits =
      problem.programme.limits(found.linearisation.squares, found.linearisation.at, share, wider);
  const ChoiceOfTolerances choice =
      problem.programme.choose(limits, {found.design.candidate.point.tolerance, kMaxGrowth});
  const auto* chosen = std::get_if<ChosenTolerances>(&choice);
  return chosen == nullptr ? kNaN : problem.programme.rounded(*chosen).cost;
}

std::uint64_t rejects_of(std::span<const double> load) {
  return static_cast<std::uint64_t>(std::ranges::count_if(load, [](double one) { return one > 1.0; }));
}

}  // namespace poesy::allocation
