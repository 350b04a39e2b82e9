// The stage of the search that moves tolerances along the gradient of the yield.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/kinds/allocation/search_constants.h"
#include "engine/kinds/allocation/search_stages.h"

namespace poesy::allocation {
namespace {

/// [parts] The share of each part in a weighted sum of the mean squares that parts cause under all limits. The weight
/// of a limit is its multiplier.
std::vector<double> shares_by_multipliers(const ToleranceLimits& limits, const Candidate& candidate) {
  std::vector<double> shares(limits.parts, 0.0);
  for (std::size_t l = 0; l < limits.count(); ++l) {
    const double multiplier = candidate.chosen.multiplier[l];
    if (multiplier == 0.0) continue;
    for (std::size_t i = 0; i < shares.size(); ++i) {
      const double tolerance = candidate.point.tolerance[i];
      shares[i] += multiplier * limits.row(l)[i] * tolerance * tolerance;
    }
  }
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share = sum > 0.0 ? share / sum : 1.0 / static_cast<double>(shares.size());
  return shares;
}

/// The machines from which the gradient of the yield is estimated: the screened machines with the largest loads. The
/// load of a machine is its largest ratio of a response to its limit.
std::vector<std::uint32_t> machines_of_largest_load(const SearchProblem& problem, const ToleranceDesign& design) {
  const auto& [numbers, load] = design.screened;
  const std::size_t share = std::min<std::size_t>(kMaxGradientMachines, design.load.size() / 30);
  const std::size_t wanted = std::min(numbers.size(), std::max<std::size_t>(problem.allowed.design, share));
  const double least = deciding_load(load, wanted);
  std::vector<std::uint32_t> machines;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    if (load[k] > least) machines.push_back(numbers[k]);
  }
  return machines;
}

/// A limit on one weighted sum of T^2 over the parts, which replaces all limits. At the present tolerances, the
/// contribution of a part to this sum is proportional to the part's score among the machines with the largest loads. If
/// the score is not significant, the contribution is given by `shares` [parts], the parts' shares in the mean squares.
/// None if no score is positive, because too few machines are screened.
std::optional<ToleranceLimits> gradient_limit(const SearchProblem& problem, const ToleranceDesign& design,
                                              std::span<const double> shares) {
  const auto [scores, is_sure] = part_scores(problem, design, machines_of_largest_load(problem, design));
  const std::vector<double>& tolerance = design.candidate.point.tolerance;
  double all = 0.0;
  for (const double score : scores) all += std::max(0.0, score);
  if (all <= 0.0) return std::nullopt;
  ToleranceLimits limit{.parts = problem.programme.size(), .effects = {}, .room = {1.0}};
  for (std::size_t i = 0; i < limit.parts; ++i) {
    const double size = tolerance[i] * tolerance[i];
    const double weight = (is_sure[i] ? scores[i] : all * shares[i]) / all;
    limit.effects.push_back(size > 0.0 ? weight / size : 0.0);
  }
  problem.programme.keep_allowed(limit);
  limit.room.front() = limit.need(0, tolerance);
  return limit;
}

/// Chooses tolerances under this limit, and scales the limit until the screened machines keep the yield. None if these
/// tolerances save too little of the cost, or if no tolerances keep the limit.
std::optional<ToleranceDesign> fit_gradient(const SearchProblem& problem, const ToleranceDesign& from,
                                            ToleranceLimits limit) {
  const TolerancePoint& before = from.candidate.point;
  for (std::size_t fit = 0; fit < kMaxFits; ++fit) {
    const ChoiceOfTolerances choice = problem.programme.choose(limit, {before.tolerance, kGradientGrowth});
    const auto* chosen = std::get_if<ChosenTolerances>(&choice);
    if (chosen == nullptr) return std::nullopt;
    ScreenedMachines screened = try_screened(problem, from, *chosen);
    const double load = deciding_load(screened.load, problem.allowed.design);
    if (load <= 1.0 && chosen->cost < (1.0 - kMinSaving) * before.cost) {
      ToleranceDesign design = from;
      design.candidate.point = *chosen;
      design.screened = std::move(screened);
      return design;
    }
    if ((load <= 1.0 && load >= 1.0 - kLoadTolerance) || !std::isfinite(load)) return std::nullopt;
    limit.room.front() /= load * load * (1.0 + 0.25 * kLoadTolerance);
  }
  return std::nullopt;
}

}  // namespace

ToleranceDesign improve(const SearchProblem& problem, const Linearisation& linearisation, ToleranceDesign from,
                        StageLog& log) {
  if (problem.options.aim != Aim::least_cost || problem.programme.size() < 2) return from;
  const ToleranceLimits limits =
      problem.programme.limits(linearisation.squares, linearisation.at, from.candidate.share);
  bool better = false;
  for (std::size_t step = 0; step < kMaxGradientSteps; ++step) {
    const std::vector<double> shares = shares_by_multipliers(limits, from.candidate);
    const std::optional<ToleranceLimits> limit = gradient_limit(problem, from, shares);
    auto next = limit ? fit_gradient(problem, from, *limit) : std::nullopt;
    if (!next) break;
    from = *std::move(next);
    better = true;
  }
  if (better) {
    log.add("by the gradient of the yield", from.candidate, from.load.size(), rejects_of(from.screened.load));
  }
  return from;
}

}  // namespace poesy::allocation
