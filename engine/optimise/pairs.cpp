#include "engine/optimise/pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// The processes of a pair, which describe both parts: all combinations of a process of the outer part and one of the
/// inner part that fits in it, with bounds tightened so that the inner part fits; then each process of the outer part
/// with the inner part left out, if `pair` allows that.
std::vector<SizedProcess> processes_of_pair(const Within& pair, const std::vector<SizedProcess>& outer,
                                            const std::vector<SizedProcess>& inner) {
  std::vector<SizedProcess> both;
  for (const SizedProcess& a : outer) {
    for (const SizedProcess& b : inner) {
      POESY_EXPECTS((a.single() || !a.cost.is_constant()) && (b.single() || !b.cost.is_constant()));
      if (b.lo > pair.share * a.hi) continue;
      const double lo = std::fmin(a.hi, std::fmax(a.lo, b.lo / pair.share));
      const InnerProcess within{b.cost,     b.lo, std::fmin(b.hi, pair.share * a.hi), b.index, pair.inner,
                                pair.share, false};
      both.push_back({a.cost, lo, a.hi, a.index, within});
    }
  }
  const bool is_choice = pair.left_out == LeftOut::by_choice;
  const double most = is_choice ? kInfinity : inner.front().lo / pair.share;
  for (const SizedProcess& a : outer) {
    if (pair.left_out == LeftOut::never || a.lo > most) continue;
    const double hi = std::fmin(a.hi, most);
    const InnerProcess none{CostLaw::constant(0.0), 0.0, pair.share * hi, 0, pair.inner, pair.share, true};
    both.push_back({a.cost, a.lo, hi, a.index, none});
  }
  POESY_EXPECTS(!both.empty());
  return both;
}

/// The largest growth, from 0, of the size of a pair's outer part that the limits allow; infinite if no limit stops the
/// growth.
struct PairGrowth {
  double alone = kInfinity;     ///< if only the outer part grows
  double together = kInfinity;  ///< if the inner part also grows, by share x the growth of the outer part
};

/// The largest growth at which the pair uses at most the share most[l] of the room of each limit l.
PairGrowth pair_growth(const SizedProblem& problem, const Within& pair, std::span<const double> most) {
  PairGrowth growth;
  for (std::size_t l = 0; l < problem.limits; ++l) {
    const Effects effects = problem.effects_on(l, pair.outer);
    const double together = effects.own + pair.share * effects.inner;
    if (effects.own > 0.0) growth.alone = std::fmin(growth.alone, most[l] / effects.own * (1.0 + 1e-9));
    if (together > 0.0) growth.together = std::fmin(growth.together, most[l] / together * (1.0 + 1e-9));
  }
  return growth;
}

double least_use_of_pair(const SizedProblem& problem, const Within& pair, std::size_t l) {
  double least = kInfinity;
  for (const SizedProcess& process : problem.processes[pair.outer]) {
    least = std::fmin(least, process.least_use(problem.effects_on(l, pair.outer)));
  }
  return least;
}

}  // namespace

void join_pairs(SizedProblem& problem) {
  for (const Within& pair : problem.pairs) {
    POESY_EXPECTS(problem.stacking == Stacking::root_sum_square && pair.share > 0.0 && pair.inner != pair.outer);
    auto& inner = problem.processes[pair.inner];
    auto& outer = problem.processes[pair.outer];
    outer = processes_of_pair(pair, outer, inner);
    inner = {{CostLaw::constant(0.0), 0.0, 0.0, 0}};
  }
}

bool is_in_pair(const SizedProblem& problem, std::size_t part) {
  return std::ranges::any_of(problem.pairs, [&](const Within& p) { return p.inner == part || p.outer == part; });
}

void fix_free_pairs(SizedProblem& problem, std::vector<std::size_t>& unbounded) {
  const std::vector<double> all(problem.limits, 1.0);
  for (const Within& pair : problem.pairs) {
    const PairGrowth growth = pair_growth(problem, pair, all);
    bool ends = true;
    for (SizedProcess& process : problem.processes[pair.outer]) {
      const InnerProcess& inner = *process.inner;
      const bool together = growth.together == kInfinity && (inner.left_out || inner.hi == kInfinity);
      const bool alone = growth.alone == kInfinity && !inner.left_out;
      if (!together && !alone) continue;
      ends = ends && process.hi < kInfinity;
      process.lo = process.hi;
    }
    if (!ends) unbounded.push_back(pair.outer);
  }
}

std::optional<std::size_t> tighten_pair(SizedProblem& problem, const Within& pair, std::span<const double> left) {
  auto& processes = problem.processes[pair.outer];
  // [limits] The largest share of each limit's room that the pair may use; the margins cover rounding.
  std::vector<double> most;
  for (std::size_t l = 0; l < problem.limits; ++l) {
    most.push_back((least_use_of_pair(problem, pair, l) + left[l]) * (1.0 + 1e-9) + 4.0 * kEpsilon);
  }
  for (std::size_t l = 0; l < problem.limits; ++l) {
    if (least_use_of_pair(problem, pair, l) > most[l]) return l;
    const Effects effects = problem.effects_on(l, pair.outer);
    std::erase_if(processes, [&](const SizedProcess& process) { return process.least_use(effects) > most[l]; });
  }
  const PairGrowth growth = pair_growth(problem, pair, most);
  for (SizedProcess& process : processes) {
    InnerProcess& inner = *process.inner;
    const double together = std::fmin(growth.together, inner.hi / inner.share);
    process.hi = std::fmin(process.hi, inner.left_out ? together : growth.alone + together);
    process.hi = std::fmax(process.hi, process.lo);
    inner.hi = std::fmax(inner.lo, std::fmin(inner.hi, inner.share * process.hi));
  }
  return std::nullopt;
}

bool fix_at_least_use(SizedProblem& problem, const Within& pair, std::size_t l) {
  const Effects effects = problem.effects_on(l, pair.outer);
  const double least = least_use_of_pair(problem, pair, l);
  auto& processes = problem.processes[pair.outer];
  std::erase_if(processes, [&](const SizedProcess& process) { return process.least_use(effects) > least; });
  bool is_finite = false;
  for (SizedProcess& process : processes) {
    InnerProcess& inner = *process.inner;
    if (effects.own + (inner.left_out ? inner.share * effects.inner : 0.0) > 0.0) process.hi = process.lo;
    inner.hi = std::fmax(inner.lo, std::fmin(inner.hi, inner.share * process.hi));
    if (effects.inner < 0.0 && !inner.left_out) inner.lo = inner.hi;
    if (effects.inner > 0.0 && !inner.left_out) inner.hi = inner.lo;
    const auto cost = [&](const CostLaw& law, double size) { return law.at(tolerance_of(size, problem.stacking)); };
    is_finite =
        is_finite || (std::isfinite(cost(process.cost, process.hi)) && std::isfinite(cost(inner.cost, inner.hi)));
  }
  return is_finite;
}

}  // namespace poesy
