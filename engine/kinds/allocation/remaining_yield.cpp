// The last stages of the search: predict the yield with each part coarser, make parts coarser to use remaining yield,
// and round tolerances down.

#include <algorithm>
#include <functional>
#include <numeric>

#include "engine/base/nan.h"
#include "engine/kinds/allocation/near_limit.h"
#include "engine/kinds/allocation/search_constants.h"
#include "engine/kinds/allocation/search_stages.h"
#include "engine/kinds/allocation/variations.h"

namespace poesy::allocation {
namespace {

/// A part whose tolerance becomes coarser by a small step. From this step, the effect of the part's next possible
/// tolerance is extrapolated.
struct CoarserPart {
  std::size_t part;
  double step;   ///< factor by which the step multiplies the tolerance T of the part
  double steps;  ///< increase of T^2 up to the next possible tolerance, divided by the increase of T^2 in one step
};

std::vector<double> try_varied(const SearchProblem& problem, const ToleranceDesign& design, const NearLimit& near,
                               std::span<const Variation> variations) {
  const StudyRun& run = problem.run;
  const Study study = machine_study(problem, design.seed, design.candidate.point.tolerance);
  const auto calibration = problem.calibration_of(study);
  return unless_stopped(try_variations(Plan(study, run.poses), run.model, study.analysis.limits, near.machines(),
                                       variations, run.options, calibration.get()));
}

/// The predicted share of good machines if the part gets its next possible tolerance. added: number of rejects that one
/// step adds.
double yield_with(const ToleranceDesign& design, const CoarserPart& coarser, double added) {
  const double rejects = static_cast<double>(rejects_of(design.screened.load)) + coarser.steps * added;
  return std::clamp(1.0 - rejects / static_cast<double>(design.load.size()), 0.0, 1.0);
}

/// For parts that hardly change the loads of machines: predicts the yield if only one of these parts is coarser, and
/// writes it into `yield` [all parts]. Uses more machines than probe(), and machines with mirrored errors.
void probe_small(const SearchProblem& problem, const ToleranceDesign& design, std::span<const CoarserPart> parts,
                 std::vector<double>& yield) {
  const NearLimit many(design.screened.numbers, design.screened.load, kProbesOfSmall);
  std::vector<Variation> variations;
  for (const CoarserPart& one : parts) {
    for (const double factor : {one.step, -1.0, -one.step}) {
      variations.push_back(problem.programme.variation(design.candidate.point, one.part, factor));
    }
  }
  const std::vector<double> loads = try_varied(problem, design, many, variations);
  for (std::size_t v = 0; v < parts.size(); ++v) {
    const auto of = [&](std::size_t variation) { return many.of_variation(loads, 3 * v + variation); };
    yield[parts[v].part] = yield_with(design, parts[v], many.added_rejects(of(0), of(1), of(2)));
  }
}

/// Predicts the yield for each of these parts if only this part is coarser. Returns the list `yield` [all parts] with
/// the predictions written into it; NaN if a part cannot be coarser. If the next possible tolerance of a part is much
/// larger, too few machines are near enough to the limit to show its effect. Then the added rejects of a small step are
/// extrapolated in proportion to the increase of T^2.
std::vector<double> probe(const SearchProblem& problem, const ToleranceDesign& design,
                          std::span<const std::size_t> parts, std::vector<double> yield) {
  const NearLimit few(design.screened.numbers, design.screened.load, kProbes);
  const TolerancePoint& point = design.candidate.point;
  std::vector<CoarserPart> coarser;
  std::vector<Variation> variations;
  for (const std::size_t i : parts) {
    yield[i] = kNaN;
    const auto next = problem.programme.coarser(point, i, kCoarserStep);
    if (!next) continue;
    const double whole = next->tolerance[i] / point.tolerance[i];
    const double step = std::min(whole, kCoarserStep);
    coarser.push_back({i, step, (whole * whole - 1.0) / (step * step - 1.0)});
    variations.push_back(problem.programme.variation(point, i, step));
  }
  const std::vector<double> loads = try_varied(problem, design, few, variations);
  std::vector<CoarserPart> small;
  for (std::size_t v = 0; v < coarser.size(); ++v) {
    const auto with_part = few.of_variation(loads, v);
    if (few.change(with_part) < kSmallEffect * (coarser[v].step - 1.0)) small.push_back(coarser[v]);
    yield[coarser[v].part] = yield_with(design, coarser[v], few.added_rejects(with_part));
  }
  probe_small(problem, design, small, yield);
  return yield;
}

std::vector<std::size_t> all_parts(const SearchProblem& problem) {
  std::vector<std::size_t> all(problem.programme.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

Probed probe_all(const SearchProblem& problem, ToleranceDesign design) {
  const std::vector<double> unknown(problem.programme.size(), kNaN);
  std::vector<double> yield = probe(problem, design, all_parts(problem), unknown);
  return {std::move(design), std::move(yield)};
}

/// Selects the parts that could each be made coarser alone at a lower cost, without more rejects than the design may
/// have. If all of these parts together would add too many rejects, selects only those that add the fewest.
std::vector<std::size_t> idle_parts(const SearchProblem& problem, const Probed& probed,
                                    std::span<const std::size_t> parts) {
  const auto& [design, coarser_yield] = probed;
  if (problem.options.aim != Aim::least_cost) return {};
  const double count = static_cast<double>(design.load.size());
  const double least_yield = 1.0 - static_cast<double>(problem.allowed.design) / count;
  std::vector<std::size_t> idle;
  for (const std::size_t i : parts) {
    const auto next = problem.programme.coarser(design.candidate.point, i, kCoarserStep);
    if (next && next->cost < design.candidate.point.cost && coarser_yield[i] >= least_yield) idle.push_back(i);
  }
  std::ranges::stable_sort(idle, std::ranges::greater(), [&](std::size_t i) { return probed.coarser_yield[i]; });
  const double yield = 1.0 - static_cast<double>(rejects_of(design.screened.load)) / count;
  double left = yield - least_yield;
  std::size_t taken = 0;
  while (taken < idle.size() && (left -= yield - coarser_yield[idle[taken]]) >= 0.0) ++taken;
  idle.resize(std::min(idle.size(), std::max<std::size_t>(taken, 1)));
  return idle;
}

/// Makes each of these parts coarser in growing steps, until a further step would break the yield or the part cannot be
/// coarser. Then scales the other parts to the yield. None if the cost does not fall, if the yield is not kept, or if a
/// machine that was screened out is rejected (misses_rejects()).
std::optional<Probed> loosen(const SearchProblem& problem, const Probed& from, std::vector<std::size_t> idle) {
  Probed loose = from;
  std::vector<bool> stays(problem.programme.size(), false);
  double step = kFirstCoarsening;
  for (std::size_t round = 0; round < kMaxCoarsenings && !idle.empty(); ++round, step *= step) {
    TolerancePoint& point = loose.design.candidate.point;
    for (const std::size_t i : idle) {
      if (auto next = problem.programme.coarser(point, i, step)) point = *std::move(next);
      stays[i] = true;
    }
    loose.design.screened = try_screened(problem, loose.design, point);
    loose.coarser_yield = probe(problem, loose.design, idle, std::move(loose.coarser_yield));
    idle = idle_parts(problem, loose, idle);
  }
  loose.design = scale_screened(problem, loose.design, stays);
  const bool keeps_yield = rejects_of(loose.design.screened.load) <= problem.allowed.design;
  const bool saves = loose.design.candidate.point.cost < from.design.candidate.point.cost;
  if (!keeps_yield || !saves || misses_rejects(problem, loose.design)) return std::nullopt;
  loose.design = with_screened_loads(std::move(loose.design));
  return loose;
}

}  // namespace

Probed use_remaining_yield(const SearchProblem& problem, ToleranceDesign from, StageLog& log) {
  const std::vector<std::size_t> all = all_parts(problem);
  Probed probed = probe_all(problem, std::move(from));
  bool better = false;
  for (std::size_t round = 0; round < kMaxCoarseningRounds; ++round) {
    std::vector<std::size_t> idle = idle_parts(problem, probed, all);
    if (idle.empty()) break;
    auto loose = loosen(problem, probed, std::move(idle));
    if (!loose) break;
    probed = *std::move(loose);
    probed.coarser_yield = probe(problem, probed.design, all, std::move(probed.coarser_yield));
    better = true;
  }
  const ToleranceDesign& design = probed.design;
  if (better) {
    log.add("coarser where nothing breaks", design.candidate, design.load.size(), rejects_of(design.load));
  }
  return probed;
}

Probed round_down(const SearchProblem& problem, Probed from, StageLog& log) {
  TolerancePoint rounded = problem.programme.rounded(from.design.candidate.point);
  if (rounded.tolerance == from.design.candidate.point.tolerance) return from;
  Candidate candidate = from.design.candidate;
  candidate.point = std::move(rounded);
  ToleranceDesign design = try_all(problem, std::move(candidate), from.design.seed);
  log.add(std::string(kRoundedDown), design.candidate, design.load.size(), rejects_of(design.load));
  return probe_all(problem, std::move(design));
}

}  // namespace poesy::allocation
