// The stages of the search that scale tolerances until machines have the yield that the study asks for.

#include <algorithm>
#include <cmath>

#include "engine/base/nan.h"
#include "engine/kinds/allocation/search_constants.h"
#include "engine/kinds/allocation/search_stages.h"

namespace poesy::allocation {
namespace {

/// Whether all tolerances are above zero, so that the parts can be made.
bool can_be_made(const TolerancePoint& point) {
  return std::ranges::find(point.tolerance, 0.0) == point.tolerance.end();
}

std::vector<bool> none_stays(const SearchProblem& problem) {
  return std::vector<bool>(problem.programme.size(), false);
}

/// A candidate that was chosen under changed limits on root mean squares.
struct Rescaled {
  Candidate candidate;
  bool moved;  ///< true if the tolerances changed, or if the limits were tightened as far as rescale() wants
};

/// Divides the limits on root mean squares by the deciding load (deciding_load()) and chooses tolerances under them. If
/// no tolerances keep such small limits, uses the smallest limits that some tolerances keep.
Rescaled rescale(const SearchProblem& problem, const Linearisation& linearisation, const Candidate& from, double load) {
  const TrustRegion region{from.point.tolerance, kMaxGrowth};
  const double share = from.share / std::clamp(load * (1.0 + 0.25 * kLoadTolerance), 0.25, 4.0);
  std::optional<Candidate> next = choose(problem, linearisation, share, region);
  const bool feasible = next.has_value();
  if (!feasible && load > 1.0) next = choose_by_least_share(problem, linearisation, share, from.share, region);
  if (!next) return {from, false};
  const bool moved = (feasible && load > 1.0) || next->point.tolerance != from.point.tolerance;
  return {*std::move(next), moved};
}

/// Changes tolerances until a pilot, which is a trial of only a part of the machines, has about the yield that the
/// study asks for. Measures mean squares again after large changes of tolerances.
Linearised approach_yield(const SearchProblem& problem, Linearised from, StageLog& log) {
  auto [linearisation, candidate] = std::move(from);
  const Study& study = problem.run.study;
  const std::size_t machines = std::max<std::size_t>(study.analysis.samples / kPilotOf, 1);
  for (std::size_t trial = 0; trial < kMaxTrials; ++trial) {
    const auto pilot = loads_of(problem, study.seed, candidate.point.tolerance, machines);
    if (trial == 0) log.add("tried on machines", candidate, machines, rejects_of(pilot));
    const double load = deciding_load(pilot, problem.allowed.design / kPilotOf);
    if (std::abs(std::log(load)) < kRelinearise) break;
    const TolerancePoint before = candidate.chosen;
    auto [next, moved] = rescale(problem, linearisation, candidate, load);
    candidate = std::move(next);
    if (!moved) {
      candidate.point = load > 1.0 ? problem.programme.lowest() : before;
      break;
    }
    if (largest_ratio(candidate.point.tolerance, linearisation.at) < 1.0 + kRelinearise) continue;
    const std::vector<double> at = candidate.point.tolerance;
    linearisation = measure(problem, at, kDrawsAmongOthers);
    auto again = choose(problem, linearisation, candidate.share, {at, kMaxGrowth});
    if (again) {
      candidate = *std::move(again);
    } else {
      candidate.point = problem.programme.lowest();
    }
  }
  return {std::move(linearisation), std::move(candidate)};
}

/// A tightened design, and whether it keeps the yield.
struct Tightened {
  ToleranceDesign design;
  bool meets_yield;
};

/// Tightens tolerances, for a study in which limits on root mean squares do not lead to the yield. This happens if only
/// few machines decide and their errors hardly change a mean square, for example if an error has no effect until it is
/// large. Tightens the parts whose errors are significantly larger in rejected machines; if there are none, tightens
/// all parts.
Tightened tighten_rejecting_parts(const SearchProblem& problem, Candidate from, StageLog& log) {
  ToleranceDesign design{std::move(from), problem.run.study.seed, {}, {}};
  for (std::size_t trial = 0; trial < kMaxTrials; ++trial) {
    design = try_all(problem, std::move(design.candidate), design.seed);
    const double load = deciding_load(design.load, problem.allowed.design);
    if (load <= 1.0) {
      design = scale_screened(problem, design, none_stays(problem));
      log.add("finer where machines fail", design.candidate, design.load.size(), rejects_of(design.screened.load));
      return {std::move(design), true};
    }
    std::vector<std::uint32_t> rejected;
    for (std::size_t s = 0; s < design.load.size(); ++s) {
      if (design.load[s] > 1.0) rejected.push_back(static_cast<std::uint32_t>(s));
    }
    const PartScores scores = part_scores(problem, design, rejected);
    std::vector<bool> rejects = scores.is_sure;
    for (std::size_t i = 0; i < rejects.size(); ++i) rejects[i] = rejects[i] && scores.of_part[i] > 0.0;
    const bool none = std::ranges::find(rejects, true) == rejects.end();
    std::vector<double> tighter = design.candidate.point.tolerance;
    for (std::size_t i = 0; i < tighter.size(); ++i) {
      if (none || rejects[i]) tighter[i] /= std::clamp(load, 1.05, 2.0);
    }
    problem.programme.keep_void(design.candidate.point, tighter);
    TolerancePoint next = problem.programme.at_most(tighter);
    if (next.tolerance == design.candidate.point.tolerance) break;
    design.candidate.point = std::move(next);
  }
  return {std::move(design), false};
}

/// Tries the lowest tolerances as the last resort. rejects: number of rejects at the smallest tolerances tried before.
ToleranceDesign tighten_to_lowest(const SearchProblem& problem, double share, std::uint64_t rejects, StageLog& log) {
  const TolerancePoint lowest = problem.programme.lowest();
  // These tolerances do not solve an optimisation problem, so they have no lower bound and no multipliers.
  ToleranceDesign design{{lowest, {lowest, kNaN, {}}, share}, problem.run.study.seed, {}, {}};
  design.load = loads_of(problem, design.seed, lowest.tolerance);
  if (rejects_of(design.load) > problem.allowed.design) refuse_lowest(problem, rejects_of(design.load));
  if (!can_be_made(lowest)) refuse_perfect(problem, rejects);
  log.add("the lowest tolerances", design.candidate, design.load.size(), rejects_of(design.load));
  return design;
}

}  // namespace

Scaled scale_to_yield(const SearchProblem& problem, Settled from, StageLog& log) {
  auto [linearisation, candidate] =
      approach_yield(problem, {std::move(from.linearisation), std::move(from.candidate)}, log);
  ToleranceDesign design = try_all(problem, std::move(candidate), problem.run.study.seed);
  std::optional<Candidate> best;
  double load = deciding_load(design.load, problem.allowed.design);
  for (std::size_t trial = 0; trial < kMaxTrials; ++trial) {
    const Candidate& now = design.candidate;
    if (load <= 1.0 && can_be_made(now.point) && (!best || now.share > best->share)) best = now;
    if (load <= 1.0 && load >= 1.0 - kLoadTolerance) break;
    auto [next, moved] = rescale(problem, linearisation, now, load);
    if (!moved) break;
    design.candidate = std::move(next);
    load = deciding_load(try_screened(problem, design, design.candidate.point).load, problem.allowed.design);
  }
  if (!best || best->share < kBlindShare * from.feasible.share) {
    Tightened tightened = tighten_rejecting_parts(problem, from.feasible, log);
    if (tightened.meets_yield && (!best || tightened.design.candidate.point.cost < best->point.cost)) {
      return {std::move(linearisation), std::move(tightened.design)};
    }
    if (!best) {
      const std::uint64_t rejects = rejects_of(tightened.design.load);
      ToleranceDesign lowest = tighten_to_lowest(problem, from.feasible.share, rejects, log);
      return {std::move(linearisation), std::move(lowest)};
    }
    design.load = loads_of(problem, design.seed, best->point.tolerance);
  }
  design.candidate = *std::move(best);
  design.screened = try_screened(problem, design, design.candidate.point);
  log.add("scaled to the yield", design.candidate, design.load.size(), rejects_of(design.screened.load));
  return {std::move(linearisation), std::move(design)};
}

ToleranceDesign scale_to_other_machines(const SearchProblem& problem, const ToleranceDesign& from, StageLog& log) {
  const std::uint64_t seed = seed_of_others(problem.run.study, SampleIndex(1));
  ToleranceDesign design = from;
  for (std::size_t trial = 0; trial < kMaxTrials; ++trial) {
    const std::vector<double> at = design.candidate.point.tolerance;
    design = try_all(problem, std::move(design.candidate), seed);
    design = with_screened_loads(scale_screened(problem, design, none_stays(problem)));
    const bool moved = largest_ratio(design.candidate.point.tolerance, at) >= 1.0 + kRelinearise;
    if (!misses_rejects(problem, design) && !moved) break;
  }
  log.add("scaled to other machines", design.candidate, design.load.size(), rejects_of(design.load));
  return design;
}

}  // namespace poesy::allocation
