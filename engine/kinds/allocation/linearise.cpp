// The first stages of the search: they solve the optimisation problem (ToleranceProgramme) with limits on root mean
// squares.

#include <algorithm>
#include <cmath>

#include "engine/kinds/allocation/search_constants.h"
#include "engine/kinds/allocation/search_stages.h"
#include "engine/random/normal_quantile.h"

namespace poesy::allocation {

Linearisation measure(const SearchProblem& problem, std::span<const double> tolerance, std::size_t draws,
                      std::span<const double> known) {
  const Study study = problem.programme.at(tolerance);
  const Study before = problem.programme.at(known.empty() ? tolerance : known);
  const auto calibration = problem.calibration_of(before);
  const StudyRun& run = problem.run;
  return {{tolerance.begin(), tolerance.end()},
          unless_stopped(mean_squares(Plan(study, run.poses), run.model, study.analysis.limits, calibration ? 0 : draws,
                                      run.options, calibration.get()))};
}

std::optional<Candidate> choose(const SearchProblem& problem, const Linearisation& linearisation, double share,
                                const TrustRegion& region) {
  const ToleranceProgramme& programme = problem.programme;
  const ChoiceOfTolerances choice =
      programme.choose(programme.limits(linearisation.squares, linearisation.at, share), region);
  if (const auto* unbounded = std::get_if<Unbounded>(&choice)) refuse_unbounded(problem, *unbounded);
  if (std::holds_alternative<Infeasible>(choice)) return std::nullopt;
  const auto& chosen = std::get<ChosenTolerances>(choice);
  return Candidate{chosen, chosen, share};
}

std::optional<Candidate> choose_by_least_share(const SearchProblem& problem, const Linearisation& linearisation,
                                               double low, double high, const TrustRegion& region) {
  while (high > 1.001 * low) {
    const double share = std::sqrt(low * high);
    (choose(problem, linearisation, share, region) ? high : low) = share;
  }
  return choose(problem, linearisation, high, region);
}

double largest_ratio(std::span<const double> a, std::span<const double> b) {
  double largest = 1.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] != b[i]) largest = std::max({largest, a[i] / b[i], b[i] / a[i]});
  }
  return largest;
}

Linearised linearise(const SearchProblem& problem, StageLog& log) {
  const ToleranceProgramme& programme = problem.programme;
  const std::vector<double> usual = programme.usual();
  std::vector<double> small = usual;
  for (double& tolerance : small) tolerance *= kLinearSize;
  Linearisation linearisation = measure(problem, small, 0, usual);
  // A standard normal number has a magnitude below this quantile with the probability `yield`.
  const double share = 1.0 / normal_quantile(1.0, 0.5 + 0.5 * problem.options.yield);
  std::optional<Candidate> candidate = choose(problem, linearisation, share, {});
  if (!candidate) {
    const ChoiceOfTolerances whole = programme.choose(programme.limits(linearisation.squares, small, 1.0), {});
    if (const auto* infeasible = std::get_if<Infeasible>(&whole)) refuse_infeasible(problem, *infeasible);
    candidate = choose_by_least_share(problem, linearisation, share, 1.0, {});
  }
  log.add("linear", *candidate, 0, 0);
  // The first linearisation does not see errors that act only together with others. Until their effects are measured,
  // their tolerances are at most those that follow from [errors] (`usual`).
  const ToleranceLimits limits = programme.limits(linearisation.squares, small, candidate->share);
  for (std::size_t i = 0; i < programme.size(); ++i) {
    bool acts = false;
    for (std::size_t l = 0; l < limits.count(); ++l) acts = acts || limits.row(l)[i] != 0.0;
    double& tolerance = candidate->point.tolerance[i];
    if (!acts) tolerance = std::min(tolerance, usual[i]);
  }
  programme.keep_within(candidate->point.tolerance);
  return {std::move(linearisation), *std::move(candidate)};
}

Settled settle(const SearchProblem& problem, Linearised from, StageLog& log) {
  auto [linearisation, candidate] = std::move(from);
  for (std::size_t round = 0; round < kMaxLinearisations; ++round) {
    const TolerancePoint before = candidate.point;
    linearisation = measure(problem, before.tolerance, kDrawsAmongOthers);
    const auto next = choose(problem, linearisation, candidate.share, {before.tolerance, kMaxGrowth});
    if (!next) {  // no tolerances are feasible: trials of machines will show whether the lowest tolerances keep the
                  // limits
      const Candidate lowest{problem.programme.lowest(), candidate.chosen, candidate.share};
      return {std::move(linearisation), lowest, std::move(candidate)};
    }
    candidate = *next;
    const double cost = candidate.point.cost;
    const bool cost_stays = !(std::abs(cost - before.cost) > kCostTolerance * std::abs(cost));
    if (cost_stays && largest_ratio(candidate.point.tolerance, before.tolerance) < 1.0 + 10.0 * kCostTolerance) break;
  }
  log.add("effects among the others", candidate, 0, 0);
  return {std::move(linearisation), candidate, candidate};
}

}  // namespace poesy::allocation
