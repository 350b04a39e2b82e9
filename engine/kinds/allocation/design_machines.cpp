// Functions on the design's machines (the machines with which tolerances are found) that several stages of the search
// use.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "engine/kinds/allocation/machine_loads.h"
#include "engine/kinds/allocation/search_constants.h"
#include "engine/kinds/allocation/search_stages.h"
#include "engine/random/stream.h"

namespace poesy::allocation {
namespace {

/// The next larger load after the deciding load (deciding_load()): the smallest load of the `rejects` worst machines.
/// Infinite if rejects = 0.
double load_before_deciding(const std::vector<double>& load, std::uint64_t rejects) {
  return rejects == 0 ? std::numeric_limits<double>::infinity() : deciding_load(load, rejects - 1);
}

/// The factor by which all tolerances are multiplied so that the deciding load, `deciding`, becomes slightly smaller
/// than 1. The next larger load, `before`, stays above 1, however close the two loads are.
double factor_to_limit(double deciding, double before) {
  constexpr double kWithin = 1.0 + 0.5 * kFinalLoadTolerance;
  const double between = before > deciding && std::isfinite(before) ? std::sqrt(before / deciding) : kWithin;
  return 1.0 / std::clamp(deciding * std::min(between, kWithin), 0.5, 2.0);
}

}  // namespace

Study machine_study(const SearchProblem& problem, std::uint64_t seed, std::span<const double> tolerance) {
  Study study = problem.programme.at(tolerance);
  study.seed = seed;
  return study;
}

std::vector<double> loads_of(const SearchProblem& problem, std::uint64_t seed, std::span<const double> tolerance,
                             std::optional<std::size_t> machines) {
  const StudyRun& run = problem.run;
  const Study study = machine_study(problem, seed, tolerance);
  const Plan plan = Plan(study, run.poses).with_samples(machines.value_or(study.analysis.samples));
  const auto calibration = problem.calibration_of(study);
  return unless_stopped(machine_loads(plan, run.model, study.analysis.limits, run.options, calibration.get())).load;
}

double deciding_load(std::vector<double> load, std::uint64_t rejects) {
  const auto at = load.begin() + static_cast<std::ptrdiff_t>(std::min<std::uint64_t>(rejects, load.size() - 1));
  std::ranges::nth_element(load, at, std::ranges::greater());
  return *at;
}

std::vector<std::uint32_t> screen(const SearchProblem& problem, std::span<const double> load) {
  const double least = kScreeningLoad * deciding_load({load.begin(), load.end()}, problem.allowed.design);
  std::vector<std::uint32_t> machines;
  for (std::size_t s = 0; s < load.size(); ++s) {
    if (load[s] >= least) machines.push_back(static_cast<std::uint32_t>(s));
  }
  return machines;
}

ScreenedMachines try_screened(const SearchProblem& problem, const ToleranceDesign& design,
                              const TolerancePoint& point) {
  const StudyRun& run = problem.run;
  const Study study = machine_study(problem, design.seed, point.tolerance);
  const auto calibration = problem.calibration_of(study);
  ScreenedMachines screened{screen(problem, design.load), {}};
  screened.load = unless_stopped(machine_loads(Plan(study, run.poses), run.model, study.analysis.limits,
                                               screened.numbers, run.options, calibration.get()))
                      .load;
  return screened;
}

ToleranceDesign try_all(const SearchProblem& problem, Candidate candidate, std::uint64_t seed) {
  ToleranceDesign design{std::move(candidate), seed, {}, {}};
  design.load = loads_of(problem, seed, design.candidate.point.tolerance);
  design.screened.numbers = screen(problem, design.load);
  for (const std::uint32_t machine : design.screened.numbers) design.screened.load.push_back(design.load[machine]);
  return design;
}

ToleranceDesign with_screened_loads(ToleranceDesign design) {
  const auto& [numbers, load] = design.screened;
  for (std::size_t k = 0; k < numbers.size(); ++k) design.load[numbers[k]] = load[k];
  return design;
}

bool misses_rejects(const SearchProblem& problem, const ToleranceDesign& design) {
  const std::size_t all = design.load.size();
  const std::size_t machines = std::max(all / kPilotOf, std::min(all, kMinPilot));
  const auto load = loads_of(problem, design.seed, design.candidate.point.tolerance, machines);
  for (std::size_t s = 0; s < load.size(); ++s) {
    if (load[s] > 1.0 && !std::ranges::binary_search(design.screened.numbers, s)) return true;
  }
  return false;
}

ToleranceDesign scale_screened(const SearchProblem& problem, const ToleranceDesign& from,
                               const std::vector<bool>& stays) {
  const std::uint64_t most = problem.allowed.design;
  ToleranceDesign best = from;
  double low = 0.0;  // the largest factor so far that keeps the yield
  double high = std::numeric_limits<double>::infinity();
  double factor = 1.0;
  double load = deciding_load(from.screened.load, most);
  double load_before = load_before_deciding(from.screened.load, most);
  for (std::size_t trial = 0; trial < kMaxTrials; ++trial) {
    (load <= 1.0 ? low : high) = factor;
    if (load <= 1.0 && load >= 1.0 - kFinalLoadTolerance && load_before > 1.0) break;
    factor *= factor_to_limit(load, load_before);
    if (factor <= low || factor >= high) factor = std::sqrt(low * high);
    if (factor <= low || factor >= high) break;
    std::vector<double> wanted = from.candidate.point.tolerance;
    for (std::size_t i = 0; i < wanted.size(); ++i) wanted[i] *= stays[i] ? 1.0 : factor;
    problem.programme.keep_void(from.candidate.point, wanted);
    const TolerancePoint next = problem.programme.at_most(wanted);
    if (next.tolerance == best.candidate.point.tolerance) break;
    ScreenedMachines screened = try_screened(problem, best, next);
    load = deciding_load(screened.load, most);
    load_before = load_before_deciding(screened.load, most);
    if (load > 1.0 || (low > 0.0 && next.cost > best.candidate.point.cost)) continue;
    best.candidate.point = next;
    best.screened = std::move(screened);
  }
  return low > 0.0 ? best : from;
}

PartScores part_scores(const SearchProblem& problem, const ToleranceDesign& design,
                       std::span<const std::uint32_t> machines) {
  const Study study = machine_study(problem, design.seed, design.candidate.point.tolerance);
  const Plan plan(study, problem.run.poses);
  std::vector<double> of_error(plan.factors().size(), 0.0);
  std::vector<double> draws(plan.factors().size());
  for (const std::uint32_t machine : machines) {
    for (std::size_t p = 0; p < draws.size(); ++p) {
      fill_uniforms(plan.address(p, PoseIndex(0)), SampleIndex(machine), std::span(&draws[p], 1));
    }
    plan.transform(draws, 1);
    for (std::size_t p = 0; p < draws.size(); ++p) {
      const double x = draws[p] / plan.distributions()[p].standard_deviation();
      of_error[p] += x * x - 1.0;
    }
  }
  // A coarser orientation leaves less of the location zone to the middle of the feature, which may raise the yield. So
  // the score of an orientation may also be significant if it is negative.
  std::vector<bool> may_fall(problem.programme.size(), false);
  for (const Within& pair : problem.programme.pairs()) may_fall[pair.inner] = true;
  PartScores scores;
  for (std::size_t i = 0; i < problem.programme.size(); ++i) {
    double sum = 0.0;
    double squares = 0.0;
    for (const auto& [p, growth] : problem.programme.growth(design.candidate.point, i)) {
      sum += growth * of_error[p];
      squares += growth * growth;
    }
    // In one machine, x^2 - 1 has the variance 2 for a normal error, and less for errors of other shapes.
    const double noise = std::sqrt(2.0 * static_cast<double>(machines.size()) * squares);
    scores.of_part.push_back(sum);
    scores.is_sure.push_back((may_fall[i] ? std::abs(sum) : sum) > kSignificance * noise);
  }
  return scores;
}

}  // namespace poesy::allocation
