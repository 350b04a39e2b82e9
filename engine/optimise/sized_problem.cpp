#include "engine/optimise/sized_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "engine/base/contract.h"
#include "engine/base/eight_sums.h"
#include "engine/optimise/pairs.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

std::vector<std::vector<SizedProcess>> processes_by_size(const AllocationProblem& problem) {
  const Stacking stacking = problem.limits.stacking;
  std::vector<std::vector<SizedProcess>> processes(problem.parts.size());
  for (std::size_t i = 0; i < processes.size(); ++i) {
    for (std::size_t p = 0; p < problem.parts[i].size(); ++p) {
      const Process& process = problem.parts[i][p];
      POESY_EXPECTS(process.lo >= 0.0 && process.hi >= process.lo);
      processes[i].push_back({process.cost, size_of(process.lo, stacking), size_of(process.hi, stacking), p});
    }
    POESY_EXPECTS(!processes[i].empty());
    std::ranges::sort(processes[i], {}, [](const SizedProcess& a) { return std::tuple(a.lo, a.hi, a.index); });
  }
  return processes;
}

std::vector<double> lowest_tolerances(const SizedProblem& problem) {
  std::vector<double> tolerance = lowest(problem, all_processes(problem));
  for (double& t : tolerance) t = tolerance_of(t, problem.stacking);
  return tolerance;
}

/// The least combined effect of all parts on limit l, in the unit of its room.
double least_need(const ToleranceLimits& limits, const SizedProblem& problem, std::size_t l) {
  if (problem.pairs.empty()) return limits.need(l, lowest_tolerances(problem));
  const auto all = all_processes(problem);
  return limits.room[l] * least_use(problem, l, all, lowest(problem, all));
}

/// The limit that is exceeded most if each pair has the sizes that use this limit least, and all other parts have their
/// lowest sizes. None if each limit alone can be kept.
std::optional<Infeasible> find_infeasible_with_pairs(const ToleranceLimits& limits, const SizedProblem& problem) {
  std::optional<Infeasible> worst;
  for (std::size_t l = 0; l < limits.count(); ++l) {
    const double room = limits.room[l];
    const double need = room > 0.0 ? least_need(limits, problem, l) : kInfinity;
    if (need > room && (!worst || need * worst->room > worst->need * room)) worst = {l, need, room};
  }
  return worst;
}

/// The limit that the lowest sizes exceed most; none if they keep all limits.
std::optional<Infeasible> find_infeasible(const ToleranceLimits& limits, const SizedProblem& problem) {
  if (limits.count() == 0) return std::nullopt;
  if (!problem.pairs.empty()) return find_infeasible_with_pairs(limits, problem);
  const std::vector<double> tolerance = lowest_tolerances(problem);
  const LimitUse worst = worst_use(limits, tolerance);
  if (worst.share <= 1.0) return std::nullopt;
  return Infeasible{worst.limit, limits.need(worst.limit, tolerance), limits.room[worst.limit]};
}

std::vector<double> largest_effects(std::span<const double> effects, std::size_t parts) {
  std::vector<double> largest(parts, 0.0);
  for (std::size_t k = 0; k < effects.size(); k += parts) {
    for (std::size_t i = 0; i < parts; ++i) {
      const double effect = std::abs(effects[k + i]);
      largest[i] = effect > largest[i] ? effect : largest[i];
    }
  }
  return largest;
}

/// Fixes parts without effect at their largest sizes, and processes of constant cost at their lowest sizes. Returns the
/// parts without effect that have no largest size.
std::vector<std::size_t> fix_free_parts(SizedProblem& problem) {
  std::vector<std::size_t> unbounded;
  for (std::size_t i = 0; i < problem.parts(); ++i) {
    if (is_in_pair(problem, i)) continue;
    const bool effect = problem.largest_effect[i] > 0.0;
    bool ends = true;
    for (SizedProcess& process : problem.processes[i]) {
      if (effect && process.cost.is_constant()) process.hi = process.lo;
      if (effect) continue;
      ends = ends && process.hi < kInfinity;
      process.lo = process.hi;
    }
    if (!ends) unbounded.push_back(i);
  }
  fix_free_pairs(problem, unbounded);
  return unbounded;
}

/// Bounds each size by the largest one that the limits allow if all other parts are at their lowest sizes. A margin for
/// rounding is added, so that no allowed size is lost. Returns a limit that every process of a pair breaks, or none.
std::optional<std::size_t> tighten_bounds(SizedProblem& problem) {
  const auto all = all_processes(problem);
  const std::vector<double> lo = lowest(problem, all);
  std::vector<double> largest(problem.parts(), kInfinity);
  std::vector<double> left_of_limit;
  for (std::size_t l = 0; l < problem.limits; ++l) {
    const auto row = problem.row(l);
    const double left = std::fmax(0.0, 1.0 - least_use(problem, l, all, lo));
    left_of_limit.push_back(left);
    for (std::size_t i = 0; i < largest.size(); ++i) {
      if (row[i] > 0.0) largest[i] = std::fmin(largest[i], lo[i] + left / row[i] * (1.0 + 1e-9));
    }
  }
  for (std::size_t i = 0; i < largest.size(); ++i) {
    if (is_in_pair(problem, i)) continue;
    auto& processes = problem.processes[i];
    // The margin covers the rounding of `lo` and of the room that is left.
    const double most = largest[i] * (1.0 + 4.0 * kEpsilon);
    if (most == kInfinity) continue;
    std::erase_if(processes, [&](const SizedProcess& process) { return process.lo > most; });
    for (SizedProcess& process : processes) process.hi = std::fmin(process.hi, most);
  }
  for (const Within& pair : problem.pairs) {
    if (const auto l = tighten_pair(problem, pair, left_of_limit)) return l;
  }
  return std::nullopt;
}

/// Finds the tight limits (SizedProblem::tight) and fixes the parts that affect them at their lowest sizes. Returns the
/// first tight limit for which the cost of a fixed part is infinite, or none.
std::optional<std::size_t> fix_tight_limits(SizedProblem& problem) {
  auto all = all_processes(problem);
  const std::vector<double> lo = lowest(problem, all);
  for (std::size_t l = 0; l < problem.limits; ++l) {
    const auto row = problem.row(l);
    if (least_use(problem, l, all, lo) <= 1.0 - 4.0 * rounding_margin(problem.parts())) continue;
    problem.tight[l] = 1;
    for (const Within& pair : problem.pairs) {
      const Effects effects = problem.effects_on(l, pair.outer);
      if ((effects.own != 0.0 || effects.inner != 0.0) && !fix_at_least_use(problem, pair, l)) return l;
    }
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i] == 0.0 || is_in_pair(problem, i)) continue;
      auto& processes = problem.processes[i];
      std::erase_if(processes, [&](const SizedProcess& process) { return process.lo > lo[i]; });
      for (SizedProcess& process : processes) process.hi = process.lo;
      const auto finite = [&](const SizedProcess& process) {
        return std::isfinite(process.cost.at(tolerance_of(process.lo, problem.stacking)));
      };
      if (std::ranges::none_of(processes, finite)) return l;
    }
    all = all_processes(problem);
  }
  return std::nullopt;
}

}  // namespace

double SizedProcess::fixed_cost() const { return inner ? cost.fixed() + inner->cost.fixed() : cost.fixed(); }

double SizedProcess::least_use(const Effects& effects) const {
  if (!inner) return effects.own * lo;
  if (inner->left_out) return (effects.own + inner->share * effects.inner) * lo;
  const double size = effects.inner < 0.0 ? std::fmin(inner->hi, inner->share * lo) : inner->lo;
  return effects.own * lo + effects.inner * size;
}

Effects SizedProblem::effects_on(std::size_t l, std::size_t part) const {
  const auto& inner = processes[part].front().inner;
  return {row(l)[part], inner ? row(l)[inner->part] : 0.0};
}

std::vector<double> effects_by_room(const AllocationProblem& problem) {
  const ToleranceLimits& limits = problem.limits;
  POESY_EXPECTS(limits.effects.size() == limits.count() * limits.parts);
  std::vector<char> may_be_negative(limits.parts, 0);
  for (const Within& pair : problem.pairs) may_be_negative[pair.inner] = 1;
  std::vector<double> effects = limits.effects;
  for (std::size_t l = 0; l < limits.count(); ++l) {
    for (std::size_t i = 0; i < limits.parts; ++i) {
      double& effect = effects[l * limits.parts + i];
      POESY_EXPECTS(std::isfinite(effect) && (effect >= 0.0 || may_be_negative[i]));
      effect /= limits.room[l];
    }
  }
  return effects;
}

std::vector<ProcessRange> all_processes(const SizedProblem& problem) {
  std::vector<ProcessRange> all;
  for (const auto& processes : problem.processes) all.push_back({0, processes.size()});
  return all;
}

double rounding_margin(std::size_t parts) { return (static_cast<double>(parts) + 16.0) * kEpsilon; }

double dot(std::span<const double> a, std::span<const double> b) {
  Sums sums{};
  const std::size_t whole = a.size() - a.size() % kSums;
  for (std::size_t k = 0; k < whole; k += kSums) {
    for (std::size_t s = 0; s < kSums; ++s) sums[s] += a[k + s] * b[k + s];
  }
  for (std::size_t k = whole; k < a.size(); ++k) sums[k - whole] += a[k] * b[k];
  return total(sums);
}

std::vector<double> lowest(const SizedProblem& problem, std::span<const ProcessRange> allowed) {
  std::vector<double> lo;
  for (std::size_t i = 0; i < allowed.size(); ++i) lo.push_back(problem.processes[i][allowed[i].first].lo);
  for (const Within& pair : problem.pairs) lo[pair.outer] = 0.0;
  return lo;
}

double least_use(const SizedProblem& problem, std::size_t l, std::span<const ProcessRange> allowed,
                 std::span<const double> lo) {
  double use = dot(problem.row(l), lo);
  for (const Within& pair : problem.pairs) {
    const Effects effects = problem.effects_on(l, pair.outer);
    double least = kInfinity;
    for (std::size_t p = allowed[pair.outer].first; p < allowed[pair.outer].last; ++p) {
      least = std::fmin(least, problem.processes[pair.outer][p].least_use(effects));
    }
    use += least;
  }
  return use;
}

std::variant<SizedProblem, Infeasible, Unbounded> sized_problem(const AllocationProblem& problem,
                                                                std::span<const double> effects) {
  const ToleranceLimits& limits = problem.limits;
  POESY_EXPECTS(limits.parts == problem.parts.size());
  SizedProblem sized{limits.stacking,
                     limits.count(),
                     effects,
                     largest_effects(effects, limits.parts),
                     processes_by_size(problem),
                     std::vector<char>(limits.count(), 0),
                     problem.pairs};
  join_pairs(sized);
  if (const auto worst = find_infeasible(limits, sized)) return *worst;
  Unbounded unbounded{fix_free_parts(sized)};
  if (!unbounded.parts.empty()) return unbounded;
  const auto infeasible_at = [&](std::size_t l) { return Infeasible{l, least_need(limits, sized, l), limits.room[l]}; };
  if (const auto l = tighten_bounds(sized)) return infeasible_at(*l);
  if (const auto l = fix_tight_limits(sized)) return infeasible_at(*l);
  return sized;
}

std::optional<SizedProblem> with_processes(const SizedProblem& problem, std::span<const std::size_t> choice) {
  SizedProblem chosen = {problem.stacking, problem.limits, problem.effects, problem.largest_effect, {},
                         problem.tight,    problem.pairs};
  for (std::size_t i = 0; i < problem.parts(); ++i) chosen.processes.push_back({problem.processes[i][choice[i]]});
  const auto all = all_processes(chosen);
  const std::vector<double> lo = lowest(chosen, all);
  const double margin = rounding_margin(chosen.parts());
  for (std::size_t l = 0; l < chosen.limits; ++l) {
    if (least_use(chosen, l, all, lo) > 1.0 + margin) return std::nullopt;
  }
  if (fix_tight_limits(chosen)) return std::nullopt;
  return chosen;
}

}  // namespace poesy
