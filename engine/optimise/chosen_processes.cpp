#include "engine/optimise/chosen_processes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/optimise/price_path.h"

namespace poesy {
namespace {

constexpr double kNothing = 1e-9;   ///< of the sum of all prices: no price of a limit that matters
constexpr double kGoodGap = 1e-11;  ///< over the cost

const Process& process_of(const AllocationProblem& problem, const SizedProblem& sized, std::size_t part) {
  return problem.parts[part][sized.menus[part].front().process];
}

/// The tolerance of a size: exactly that of a bound where the size is at one.
double tolerance_within(const Process& process, const SizedProcess& sized, double size, Stacking stacking) {
  if (size <= sized.lo) return size == size_of(process.hi, stacking) ? process.hi : process.lo;
  const double tolerance = tolerance_of(size, stacking);
  return size == size_of(process.hi, stacking) ? process.hi : std::clamp(tolerance, process.lo, process.hi);
}

/// Tolerances of sizes [N], of which this share of what is above the lowest bounds is kept.
std::vector<double> tolerances_of(const AllocationProblem& problem, const SizedProblem& sized,
                                  std::span<const double> sizes, double keep) {
  std::vector<double> tolerance(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const SizedProcess& menu = sized.menus[i].front();
    const double size = keep == 1.0 ? sizes[i] : menu.lo + keep * (sizes[i] - menu.lo);
    tolerance[i] = tolerance_within(process_of(problem, sized, i), menu, size, sized.stacking);
  }
  return tolerance;
}

/// The share of what is above the lowest bounds that limits leave.
double share_within(const SizedProblem& sized, std::span<const double> sizes) {
  const double room = 1.0 - 4.0 * rounding_margin(sized.parts());
  const std::vector<double> lo = lowest(sized);
  double share = 1.0;
  for (std::size_t l = 0; l < sized.limits; ++l) {
    const double least = dot(sized.row(l), lo);
    const double use = dot(sized.row(l), sizes);
    if (use > room && use > least) share = std::fmin(share, std::fmax(0.0, (room - least) / (use - least)));
  }
  return share;
}

bool is_within(const ToleranceLimits& limits, std::span<const double> tolerance) {
  return limits.count() == 0 || worst_use(limits, tolerance).share <= 1.0;
}

/// Tolerances of sizes [N] that keep the limits, drawn towards the lowest bounds where rounding would break one.
std::optional<std::vector<double>> tolerances_within(const AllocationProblem& problem, const SizedProblem& sized,
                                                     std::span<const double> sizes) {
  std::vector<double> tolerance = tolerances_of(problem, sized, sizes, 1.0);
  if (is_within(problem.limits, tolerance)) return tolerance;
  tolerance = tolerances_of(problem, sized, sizes, share_within(sized, sizes));
  if (is_within(problem.limits, tolerance)) return tolerance;
  tolerance = tolerances_of(problem, sized, sizes, 0.0);
  if (is_within(problem.limits, tolerance)) return tolerance;
  return std::nullopt;
}

double cost_of(const AllocationProblem& problem, const SizedProblem& sized, std::span<const double> tolerance) {
  double cost = 0.0;
  for (std::size_t i = 0; i < tolerance.size(); ++i) cost += process_of(problem, sized, i).cost.at(tolerance[i]);
  return cost;
}

/// Prices and the lower bound that follows from them.
struct Proof {
  std::vector<std::size_t> rows;
  std::vector<double> prices;
  double bound;
};

Proof proof(const SizedProblem& sized, std::vector<std::size_t> rows, std::vector<double> prices) {
  const std::vector<MenuRange> all(sized.parts(), {0, 1});
  const double bound = lower_bound(sized, all, rows, prices);
  return {std::move(rows), std::move(prices), bound};
}

/// Without the prices that are nothing.
Proof without_nothing(const SizedProblem& sized, const Proof& whole, double cost) {
  const double sum = std::accumulate(whole.prices.begin(), whole.prices.end(), 0.0);
  Proof less = whole;
  for (double& price : less.prices) price = price < kNothing * sum ? 0.0 : price;
  less = proof(sized, std::move(less.rows), std::move(less.prices));
  return cost - less.bound <= 2.0 * (cost - whole.bound) + kGoodGap * std::abs(cost) ? less : whole;
}

/// The least prices of full limits at which their parts are best off at their lowest bounds. Left out where that takes
/// an infinite price. The bound stays as it is, because these parts have no other size in it.
void add_full_limits(const AllocationProblem& problem, const SizedProblem& sized, Proof& found) {
  for (std::size_t l = 0; l < sized.limits; ++l) {
    if (!sized.full[l]) continue;
    double price = 0.0;
    for (std::size_t i = 0; i < sized.parts(); ++i) {
      const Process& process = process_of(problem, sized, i);
      if (sized.row(l)[i] == 0.0 || process.lo == process.hi) continue;
      double others = process.cost.curve(sized.menus[i].front().lo, sized.stacking).slope;
      for (std::size_t k = 0; k < found.rows.size(); ++k) others += found.prices[k] * sized.row(found.rows[k])[i];
      price = std::fmax(price, -others / sized.row(l)[i]);
    }
    if (price == 0.0 || !std::isfinite(price)) continue;
    found.rows.push_back(l);
    found.prices.push_back(price);
  }
}

}  // namespace

std::vector<double> multipliers(const ToleranceLimits& limits, std::span<const std::size_t> rows,
                                std::span<const double> prices) {
  std::vector<double> multiplier(limits.count(), 0.0);
  const double sum = std::accumulate(prices.begin(), prices.end(), 0.0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (prices[k] >= kNothing * sum) multiplier[rows[k]] = prices[k] / limits.room[rows[k]];
  }
  return multiplier;
}

std::optional<ChosenAllocation> allocate_chosen(const AllocationProblem& problem, const SizedProblem& sized,
                                                std::span<const std::size_t> rows) {
  std::vector<double> sizes = lowest(sized);
  Proof found = proof(sized, {}, {});
  const auto single = [](const auto& menu) { return menu.front().single(); };
  if (!std::ranges::all_of(sized.menus, single)) {
    const std::vector<MenuRange> all(sized.parts(), {0, 1});
    PricePath path(sized, {rows.begin(), rows.end()});
    const PathPoint end = path.follow(all, {}, {});
    for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] = end.parts[i].size;
    found = {path.rows(), end.prices, end.lower};
  }
  auto tolerance = tolerances_within(problem, sized, sizes);
  if (!tolerance) return std::nullopt;
  ChosenAllocation chosen;
  chosen.allocation.tolerance = std::move(*tolerance);
  for (const auto& menu : sized.menus) chosen.allocation.process.push_back(menu.front().process);
  chosen.allocation.cost = cost_of(problem, sized, chosen.allocation.tolerance);
  found = without_nothing(sized, found, chosen.allocation.cost);
  add_full_limits(problem, sized, found);
  chosen.lower_bound = std::fmin(found.bound, chosen.allocation.cost);
  chosen.multiplier = multipliers(problem.limits, found.rows, found.prices);
  chosen.rows = std::move(found.rows);
  return chosen;
}

}  // namespace poesy
