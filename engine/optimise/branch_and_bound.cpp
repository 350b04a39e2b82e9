#include "engine/optimise/branch_and_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <tuple>

#include "engine/optimise/convex_programme.h"
#include "engine/optimise/dual_path.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The position of a process for each part.
using Choice = std::vector<std::size_t>;

struct Node {
  double bound;        ///< no choice below this node costs less
  std::size_t number;  ///< how many nodes were made before this one
  std::vector<ProcessRange> allowed;
  std::vector<double> multipliers;  ///< multipliers of the parent node

  /// The order of a priority queue, in which the node with the lowest bound comes first.
  bool operator<(const Node& other) const { return std::tie(other.bound, other.number) < std::tie(bound, number); }
};

class BranchAndBound {
 public:
  BranchAndBound(const AllocationProblem& problem, const SizedProblem& sized, const SearchOptions& options)
      : problem_(problem), sized_(sized), options_(options), dual_path_(sized) {}

  LeastCost run();

 private:
  double cutoff() const;
  void push(double bound, std::vector<ProcessRange> allowed, std::vector<double> multipliers);
  void close(double bound) { closed_ = std::fmin(closed_, bound); }
  double solve_leaf(const Choice& choice);
  void expand(const Node& node);
  bool is_feasible(const std::vector<ProcessRange>& allowed) const;
  Choice round_down(const std::vector<ProcessRange>& allowed, const PathPoint& point) const;
  void raise_greedily(Choice& choice) const;
  void prune_by_bound(std::vector<ProcessRange>& allowed, const PathPoint& point, double bound);
  void branch(const std::vector<ProcessRange>& allowed, const PathPoint& point, double bound);

  const AllocationProblem& problem_;
  const SizedProblem& sized_;
  SearchOptions options_;
  DualPath dual_path_;
  std::priority_queue<Node> open_;
  std::map<Choice, double> solved_;   ///< lower bounds of the leaves that were solved
  std::vector<ConvexSolution> best_;  ///< the best solutions by cost, at most as many as are wanted
  std::vector<double> relaxed_;       ///< [L] multipliers at the root
  double closed_ = kInfinity;         ///< the lowest bound of what was pruned or solved
  std::size_t nodes_ = 0;             ///< nodes that were expanded
  std::size_t made_ = 0;
};

/// The cost from which on choices are discarded.
double BranchAndBound::cutoff() const {
  if (best_.size() <= options_.alternatives) return kInfinity;
  const double cost = best_.back().allocation.cost;
  return cost - options_.relative_gap * std::abs(cost);
}

void BranchAndBound::push(double bound, std::vector<ProcessRange> allowed, std::vector<double> multipliers) {
  open_.push({bound, made_++, std::move(allowed), std::move(multipliers)});
}

/// Solves for these processes and records the result. Returns its lower bound, or infinity if infeasible.
double BranchAndBound::solve_leaf(const Choice& choice) {
  if (const auto known = solved_.find(choice); known != solved_.end()) return known->second;
  double& bound = solved_[choice];
  bound = kInfinity;
  const auto chosen_problem = with_processes(sized_, choice);
  if (!chosen_problem) return bound;
  auto chosen = solve_convex(problem_, *chosen_problem, dual_path_.working_set());
  if (!chosen) return bound;
  bound = chosen->lower_bound;
  const auto order = [](const ConvexSolution& a, const ConvexSolution& b) {
    return std::tie(a.allocation.cost, a.allocation.process) < std::tie(b.allocation.cost, b.allocation.process);
  };
  best_.insert(std::ranges::upper_bound(best_, *chosen, order), std::move(*chosen));
  if (best_.size() > options_.alternatives + 1) best_.pop_back();
  return bound;
}

/// Whether the smallest sizes keep every limit.
bool BranchAndBound::is_feasible(const std::vector<ProcessRange>& allowed) const {
  std::vector<double> lo;
  for (std::size_t i = 0; i < allowed.size(); ++i) lo.push_back(sized_.processes[i][allowed[i].first].lo);
  const double most = 1.0 - 4.0 * rounding_margin(lo.size());
  for (std::size_t l = 0; l < sized_.limits; ++l) {
    if (!sized_.tight[l] && dot(sized_.row(l), lo) > most) return false;
  }
  return true;
}

/// A choice that keeps the limits: for each part the cheapest process that can make the size of the relaxation or a
/// smaller one.
Choice BranchAndBound::round_down(const std::vector<ProcessRange>& allowed, const PathPoint& point) const {
  Choice choice;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    std::size_t cheapest = allowed[i].first;
    double least = kInfinity;
    for (std::size_t p = allowed[i].first; p < allowed[i].last; ++p) {
      const SizedProcess& process = sized_.processes[i][p];
      if (process.lo > point.parts[i].size) break;
      const double cost = process.cost.at(tolerance_of(std::fmin(process.hi, point.parts[i].size), sized_.stacking));
      if (cost < least) std::tie(cheapest, least) = std::tuple(p, cost);
    }
    choice.push_back(cheapest);
  }
  return choice;
}

/// Improves a choice of single values greedily: the part that saves most takes its next larger value, as long as the
/// limits allow it.
void BranchAndBound::raise_greedily(Choice& choice) const {
  const auto at = [&](std::size_t i, std::size_t up) -> const SizedProcess& {
    return sized_.processes[i][choice[i] + up];
  };
  std::vector<double> sizes;
  for (std::size_t i = 0; i < choice.size(); ++i) {
    if (!at(i, 0).single()) return;
    sizes.push_back(at(i, 0).lo);
  }
  std::vector<double> left;
  for (std::size_t l = 0; l < sized_.limits; ++l) {
    left.push_back(1.0 - rounding_margin(sizes.size()) - dot(sized_.row(l), sizes));
  }
  for (bool raised = true; raised;) {
    raised = false;
    std::vector<std::pair<double, std::size_t>> savings;
    for (std::size_t i = 0; i < choice.size(); ++i) {
      if (choice[i] + 1 == sized_.processes[i].size() || !at(i, 1).single()) continue;
      const auto cost = [&](const SizedProcess& p) { return p.cost.at(tolerance_of(p.lo, sized_.stacking)); };
      const double saving = cost(at(i, 0)) - cost(at(i, 1));
      if (saving > 0.0) savings.emplace_back(-saving, i);
    }
    std::ranges::sort(savings);
    for (const auto& [saving, i] : savings) {
      const double more = at(i, 1).lo - at(i, 0).lo;
      std::size_t l = 0;
      while (l < left.size() && sized_.row(l)[i] * more <= left[l]) ++l;
      if (l < left.size()) continue;
      for (l = 0; l < left.size(); ++l) left[l] -= sized_.row(l)[i] * more;
      ++choice[i];
      raised = true;
      break;
    }
  }
}

/// Removes processes at the ends of the ranges that cannot belong to one of the best choices.
void BranchAndBound::prune_by_bound(std::vector<ProcessRange>& allowed, const PathPoint& point, double bound) {
  const double most = cutoff();
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const BestResponse& part = point.parts[i];
    const auto exceeds_cutoff = [&](std::size_t p) {
      const double with =
          bound + (process_response(sized_.processes[i][p], part.price, sized_.stacking).lagrangian - part.lagrangian);
      if (with < most) return false;
      close(with);
      return true;
    };
    while (allowed[i].size() > 1 && exceeds_cutoff(allowed[i].first)) ++allowed[i].first;
    while (allowed[i].size() > 1 && exceeds_cutoff(allowed[i].last - 1)) --allowed[i].last;
  }
}

/// Divides the range of the part whose mix spreads most, next to its main process, and queues both halves.
void BranchAndBound::branch(const std::vector<ProcessRange>& allowed, const PathPoint& point, double bound) {
  std::size_t part = allowed.size();
  double most = -1.0;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const double open = point.parts[i].price * point.parts[i].deviation;
    if (allowed[i].size() > 1 && open > most) std::tie(part, most) = std::tuple(i, open);
  }
  if (part == allowed.size()) {
    push(bound, allowed, point.multipliers);
    return;
  }
  const ProcessRange range = allowed[part];
  const std::size_t main = std::clamp(point.parts[part].main, range.first, range.last - 1);
  const bool above = point.parts[part].size > sized_.processes[part][main].lo;
  const std::size_t cut = (above || main == range.first) && main + 1 < range.last ? main + 1 : main;
  std::vector<ProcessRange> half = allowed;
  half[part] = {range.first, std::max(cut, range.first + 1)};
  push(bound, half, point.multipliers);
  half[part] = {std::max(cut, range.first + 1), range.last};
  push(bound, half, point.multipliers);
}

void BranchAndBound::expand(const Node& node) {
  std::vector<ProcessRange> allowed = node.allowed;
  if (std::ranges::all_of(allowed, [](const ProcessRange& range) { return range.size() == 1; })) {
    Choice choice;
    for (const ProcessRange& range : allowed) choice.push_back(range.first);
    close(std::fmax(node.bound, solve_leaf(choice)));
    return;
  }
  if (!is_feasible(allowed)) return;
  const bool root = nodes_ == 1;
  const PathPoint point = dual_path_.follow(allowed, node.multipliers, {cutoff(), !root});
  const double bound = std::fmax(node.bound, point.lower_bound);
  if (root) relaxed_ = limit_multipliers(problem_.limits, dual_path_.working_set(), point.multipliers);
  Choice choice = round_down(allowed, point);
  raise_greedily(choice);
  solve_leaf(choice);
  if (bound >= cutoff()) {
    close(bound);
    return;
  }
  // Pruning needs the bound of the same point as the multipliers. It may be lower than that of the parent node.
  prune_by_bound(allowed, point, point.lower_bound);
  branch(allowed, point, bound);
}

LeastCost BranchAndBound::run() {
  std::vector<ProcessRange> all;
  for (const auto& processes : sized_.processes) all.push_back({0, processes.size()});
  push(-kInfinity, std::move(all), {});
  while (!open_.empty() && (nodes_ < options_.max_nodes || best_.empty())) {
    if (open_.top().bound >= cutoff()) break;
    const Node node = open_.top();
    open_.pop();
    ++nodes_;
    expand(node);
  }
  if (!open_.empty()) close(open_.top().bound);
  const ConvexSolution& best =
      best_.front();  // not empty, because the search ends without a solution only after solving all choices
  LeastCost found{
      best.allocation, std::fmin(closed_, best.allocation.cost), {}, best.multiplier, relaxed_, {0, 0.0}, {}, nodes_};
  for (std::size_t k = 1; k < best_.size(); ++k) found.next.push_back(best_[k].allocation);
  return found;
}

}  // namespace

LeastCost branch_and_bound(const AllocationProblem& problem, const SizedProblem& sized, const SearchOptions& options) {
  return BranchAndBound(problem, sized, options).run();
}

}  // namespace poesy
