#include "engine/optimise/convex_programme.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/optimise/dual_path.h"
#include "engine/optimise/pairs.h"

namespace poesy {
namespace {

constexpr double kNegligible = 1e-9;  ///< a multiplier below this share of the sum of all multipliers counts as 0
/// When negligible multipliers are set to 0, the gap between cost and lower bound may grow to twice its value plus this
/// share of the cost.
constexpr double kGoodGap = 1e-11;

const Process& process_of(const AllocationProblem& problem, const SizedProblem& sized, std::size_t part) {
  return problem.parts[part][sized.processes[part].front().index];
}

/// The tolerance whose size_of() is `size`, within the bounds of the process. At a bound it is exactly the bound's
/// tolerance.
double tolerance_within(const Process& process, double size, Stacking stacking) {
  if (size == size_of(process.hi, stacking)) return process.hi;
  if (size <= size_of(process.lo, stacking)) return process.lo;
  return std::clamp(tolerance_of(size, stacking), process.lo, process.hi);
}

/// Sets the tolerances of the inner parts of pairs in `tolerance`, which has those of the outer parts. sizes: [parts].
void set_inner(const AllocationProblem& problem, const SizedProblem& sized, std::span<const double> sizes,
               std::span<double> tolerance) {
  for (const Within& pair : sized.pairs) {
    const InnerProcess& inner = *sized.processes[pair.outer].front().inner;
    const double most = tolerance_of(pair.share, sized.stacking) * tolerance[pair.outer];
    const double size = sizes[pair.inner];
    tolerance[pair.inner] =
        inner.left_out ? most : tolerance_within(problem.parts[pair.inner][inner.index], size, sized.stacking);
  }
}

/// [parts] The lowest sizes of the processes. In a pair, the inner part has the same share of the outer part's size as
/// in `sizes`, if its bounds allow this, because the smallest inner part may use more of a limit than a larger one.
std::vector<double> lowest_like(const SizedProblem& sized, std::span<const double> sizes) {
  std::vector<double> lo;
  for (const auto& processes : sized.processes) lo.push_back(processes.front().lo);
  for (const Within& pair : sized.pairs) {
    const InnerProcess& inner = *sized.processes[pair.outer].front().inner;
    const double most = inner.left_out ? pair.share * lo[pair.outer] : std::fmin(inner.hi, pair.share * lo[pair.outer]);
    const double like = sizes[pair.outer] > 0.0 ? sizes[pair.inner] / sizes[pair.outer] * lo[pair.outer] : most;
    lo[pair.inner] = inner.left_out ? most : std::fmin(most, std::fmax(inner.lo, like));
  }
  return lo;
}

/// [parts] The tolerances of the sizes lo + keep (sizes - lo), where lo are the sizes from lowest_like().
std::vector<double> tolerances_of(const AllocationProblem& problem, const SizedProblem& sized,
                                  std::span<const double> sizes, double keep) {
  std::vector<double> tolerance(sizes.size());
  std::vector<double> kept(sizes.begin(), sizes.end());
  if (keep != 1.0) {
    const std::vector<double> lo = lowest_like(sized, sizes);
    for (std::size_t i = 0; i < sizes.size(); ++i) kept[i] = lo[i] + keep * (sizes[i] - lo[i]);
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    tolerance[i] = tolerance_within(process_of(problem, sized, i), kept[i], sized.stacking);
  }
  set_inner(problem, sized, kept, tolerance);
  return tolerance;
}

/// The largest s from 0 to 1 for which the sizes lo + s (sizes - lo) keep all limits, where lo are the sizes from
/// lowest_like().
double share_within(const SizedProblem& sized, std::span<const double> sizes) {
  const double room = 1.0 - 4.0 * rounding_margin(sized.parts());
  const std::vector<double> lo = lowest_like(sized, sizes);
  double share = 1.0;
  for (std::size_t l = 0; l < sized.limits; ++l) {
    const double least = dot(sized.row(l), lo);
    const double use = dot(sized.row(l), sizes);
    if (use > room && use > least) share = std::fmin(share, std::fmax(0.0, (room - least) / (use - least)));
  }
  return share;
}

/// [parts] The tolerances of these sizes. If they break a limit, because of rounding, all sizes move towards the lowest
/// sizes. None if even the lowest sizes break a limit.
std::optional<std::vector<double>> tolerances_within(const AllocationProblem& problem, const SizedProblem& sized,
                                                     std::span<const double> sizes) {
  for (const double keep : {1.0, share_within(sized, sizes), 0.0}) {
    std::vector<double> tolerance = tolerances_of(problem, sized, sizes, keep);
    if (problem.limits.count() == 0 || worst_use(problem.limits, tolerance).share <= 1.0) return tolerance;
  }
  return std::nullopt;
}

double cost_of(const AllocationProblem& problem, const SizedProblem& sized, std::span<const double> tolerance) {
  double cost = 0.0;
  const auto is_inner = [&](std::size_t part) {
    return std::ranges::any_of(sized.pairs, [&](const Within& pair) { return pair.inner == part; });
  };
  for (std::size_t i = 0; i < tolerance.size(); ++i) {
    if (!is_inner(i)) cost += process_of(problem, sized, i).cost.at(tolerance[i]);
  }
  for (const Within& pair : sized.pairs) {
    const InnerProcess& inner = *sized.processes[pair.outer].front().inner;
    if (!inner.left_out) cost += inner.cost.at(tolerance[pair.inner]);
  }
  return cost;
}

/// The multipliers of the limits in a working set, in the same order, and the lower bound on the cost that they prove.
struct DualCertificate {
  std::vector<std::size_t> working_set;
  std::vector<double> multipliers;
  double bound;
};

DualCertificate certify(const SizedProblem& sized, std::vector<std::size_t> working_set,
                        std::vector<double> multipliers) {
  const std::vector<ProcessRange> all(sized.parts(), {0, 1});
  const double bound = lower_bound(sized, all, working_set, multipliers);
  return {std::move(working_set), std::move(multipliers), bound};
}

/// The certificate `whole` with negligible multipliers set to 0, if its lower bound stays about as good; otherwise
/// `whole`. cost: cost of the solution.
DualCertificate without_negligible(const SizedProblem& sized, const DualCertificate& whole, double cost) {
  const double sum = std::accumulate(whole.multipliers.begin(), whole.multipliers.end(), 0.0);
  DualCertificate less = whole;
  for (double& multiplier : less.multipliers) multiplier = multiplier < kNegligible * sum ? 0.0 : multiplier;
  less = certify(sized, std::move(less.working_set), std::move(less.multipliers));
  return cost - less.bound <= 2.0 * (cost - whole.bound) + kGoodGap * std::abs(cost) ? less : whole;
}

/// Adds a multiplier for each tight limit (SizedProblem::tight): the smallest one at which the lowest sizes have the
/// least cost + price x size for the parts that affect the limit and are in no pair. A multiplier that is zero or
/// infinite is not added. The lower bound does not change, because these parts are fixed at their lowest sizes.
void add_tight_limits(const AllocationProblem& problem, const SizedProblem& sized, DualCertificate& found) {
  for (std::size_t l = 0; l < sized.limits; ++l) {
    if (!sized.tight[l]) continue;
    double multiplier = 0.0;
    for (std::size_t i = 0; i < sized.parts(); ++i) {
      const Process& process = process_of(problem, sized, i);
      if (sized.row(l)[i] == 0.0 || process.lo == process.hi || is_in_pair(sized, i)) continue;
      double others = process.cost.curve(sized.processes[i].front().lo, sized.stacking).slope;
      for (std::size_t k = 0; k < found.working_set.size(); ++k) {
        others += found.multipliers[k] * sized.row(found.working_set[k])[i];
      }
      multiplier = std::fmax(multiplier, -others / sized.row(l)[i]);
    }
    if (multiplier == 0.0 || !std::isfinite(multiplier)) continue;
    found.working_set.push_back(l);
    found.multipliers.push_back(multiplier);
  }
}

}  // namespace

std::vector<double> limit_multipliers(const ToleranceLimits& limits, std::span<const std::size_t> working_set,
                                      std::span<const double> multipliers) {
  std::vector<double> of_limit(limits.count(), 0.0);
  const double sum = std::accumulate(multipliers.begin(), multipliers.end(), 0.0);
  for (std::size_t k = 0; k < working_set.size(); ++k) {
    const std::size_t l = working_set[k];
    if (multipliers[k] >= kNegligible * sum) of_limit[l] = multipliers[k] / limits.room[l];
  }
  return of_limit;
}

std::optional<ConvexSolution> solve_convex(const AllocationProblem& problem, const SizedProblem& sized,
                                           std::span<const std::size_t> working_set) {
  std::vector<double> sizes = lowest_like(sized, std::vector<double>(sized.parts()));
  DualCertificate found = certify(sized, {}, {});
  const auto single = [](const auto& processes) { return processes.front().single(); };
  if (!std::ranges::all_of(sized.processes, single)) {
    const std::vector<ProcessRange> all(sized.parts(), {0, 1});
    DualPath path(sized, {working_set.begin(), working_set.end()});
    const PathPoint end = path.follow(all, {}, {});
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = end.parts[i].size;
    found = {path.working_set(), end.multipliers, end.lower_bound};
  }
  auto tolerance = tolerances_within(problem, sized, sizes);
  if (!tolerance) return std::nullopt;
  ConvexSolution solution;
  solution.allocation.tolerance = *std::move(tolerance);
  for (const auto& processes : sized.processes) solution.allocation.process.push_back(processes.front().index);
  for (const Within& pair : sized.pairs) {
    const InnerProcess& inner = *sized.processes[pair.outer].front().inner;
    solution.allocation.process[pair.inner] = inner.index;
    if (inner.left_out) solution.allocation.left_out.push_back(pair.inner);
  }
  solution.allocation.cost = cost_of(problem, sized, solution.allocation.tolerance);
  found = without_negligible(sized, found, solution.allocation.cost);
  add_tight_limits(problem, sized, found);
  solution.lower_bound = std::fmin(found.bound, solution.allocation.cost);
  solution.multiplier = limit_multipliers(problem.limits, found.working_set, found.multipliers);
  return solution;
}

}  // namespace poesy
