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

/// [parts] The position of the chosen process of each part.
using Choice = std::vector<std::size_t>;

struct Node {
  double bound;        ///< lower bound on the cost of all choices below this node
  std::size_t number;  ///< number of nodes that were made before this one
  std::vector<ProcessRange> allowed;
  /// [working set] multipliers at the parent node; further limits may have joined the working set since.
  std::vector<double> multipliers;

  /// The order of a priority queue, in which the node with the lowest bound comes first.
  bool operator<(const Node& other) const { return std::tie(other.bound, other.number) < std::tie(bound, number); }
};

/// The cost of a process at its largest sizes that use no more of any limit than the sizes in `most` do. In a pair, the
/// inner part is no larger than in `most`. The same holds for the excess of the outer part over the smallest size in
/// which the inner part fits. Infinite if a pair has no such sizes. Precondition for a process of a part in no pair:
/// process.lo <= most.size.
double cost_within(const SizedProcess& process, const BestResponse& most, Stacking stacking) {
  const auto cost = [&](const CostLaw& law, double size) { return law.at(tolerance_of(size, stacking)); };
  if (!process.inner) return cost(process.cost, std::fmin(process.hi, most.size));
  const InnerProcess& inner = *process.inner;
  const double within = std::fmin(inner.hi, std::fmin(most.inner.size, inner.share * process.hi));
  const double beyond = inner.left_out ? 0.0 : std::fmax(0.0, most.size - most.inner.size / inner.share);
  const double size = std::fmin(process.hi, within / inner.share + beyond);
  if (size < process.lo || (!inner.left_out && within < inner.lo)) return kInfinity;
  return cost(process.cost, size) + (inner.left_out ? 0.0 : cost(inner.cost, within));
}

/// The size of a pair's inner part in a process that allows only one size.
double inner_size(const SizedProcess& process) {
  return process.inner->left_out ? process.inner->share * process.lo : process.inner->lo;
}

/// The cost of a process that allows only one size.
double single_cost(const SizedProcess& process, Stacking stacking) {
  const double own = process.cost.at(tolerance_of(process.lo, stacking));
  if (!process.inner || process.inner->left_out) return own;
  return own + process.inner->cost.at(tolerance_of(inner_size(process), stacking));
}

/// A change of one part, or of one pair, to another process that costs less.
struct Raise {
  double saving;        ///< decrease of the cost
  std::size_t part;     ///< position of the part
  std::size_t process;  ///< position of the new process
};

/// The standard deviation of price x size over the mixed processes of a part, summed over both parts of a pair.
/// branch() splits the part with the largest value.
double spread_of(const BestResponse& part) {
  return part.price * part.deviation + std::abs(part.inner.price) * part.inner.deviation;
}

class BranchAndBound {
 public:
  BranchAndBound(const AllocationProblem& problem, const SizedProblem& sized, const SearchOptions& options)
      : problem_(problem), sized_(sized), options_(options), dual_path_(sized) {}

  std::optional<LeastCost> run();

 private:
  double cutoff() const;
  void push(double bound, std::vector<ProcessRange> allowed, std::vector<double> multipliers);
  void close(double bound) { closed_ = std::fmin(closed_, bound); }
  double solve_leaf(const Choice& choice);
  void expand(const Node& node);
  bool is_feasible(const std::vector<ProcessRange>& allowed) const;
  Choice round_down(const std::vector<ProcessRange>& allowed, const PathPoint& point) const;
  void raise_greedily(Choice& choice) const;
  std::vector<Raise> raises(const Choice& choice) const;
  void prune_by_bound(std::vector<ProcessRange>& allowed, const PathPoint& point, double bound);
  void branch(const std::vector<ProcessRange>& allowed, const PathPoint& point, double bound);

  const AllocationProblem& problem_;
  const SizedProblem& sized_;
  SearchOptions options_;
  DualPath dual_path_;
  std::priority_queue<Node> open_;
  /// Lower bound of each choice that solve_leaf() solved; infinity if no sizes keep the limits.
  std::map<Choice, double> solved_;
  /// The best solutions, ascending by cost; at most one more than SearchOptions::alternatives.
  std::vector<ConvexSolution> best_;
  std::vector<double> relaxed_;  ///< [limits] limit_multipliers() of the relaxation of the root
  /// Lowest lower bound among the nodes and processes that were pruned, and the choices that were solved.
  double closed_ = kInfinity;
  std::size_t nodes_ = 0;  ///< number of nodes that were expanded
  std::size_t made_ = 0;
};

/// The cost above which a choice need not be found: the cost of the worst choice that the result must contain, reduced
/// by the share SearchOptions::relative_gap. Infinity while too few choices are known.
double BranchAndBound::cutoff() const {
  if (best_.size() <= options_.alternatives) return kInfinity;
  const double cost = best_.back().allocation.cost;
  return cost - options_.relative_gap * std::abs(cost);
}

void BranchAndBound::push(double bound, std::vector<ProcessRange> allowed, std::vector<double> multipliers) {
  open_.push({bound, made_++, std::move(allowed), std::move(multipliers)});
}

/// Solves the convex programme of one choice and adds its solution to the best ones. Returns the lower bound on its
/// cost, or infinity if no sizes keep the limits.
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

/// Whether the lowest allowed sizes keep every limit.
bool BranchAndBound::is_feasible(const std::vector<ProcessRange>& allowed) const {
  const std::vector<double> lo = lowest(sized_, allowed);
  const double most = 1.0 - 4.0 * rounding_margin(lo.size());
  for (std::size_t l = 0; l < sized_.limits; ++l) {
    if (!sized_.tight[l] && least_use(sized_, l, allowed, lo) > most) return false;
  }
  return true;
}

/// A choice that keeps the limits if the sizes of the relaxation keep them: for each part, the process that is cheapest
/// at sizes that use no more of the limits than those of the relaxation (cost_within()). point: the solution of the
/// relaxation.
Choice BranchAndBound::round_down(const std::vector<ProcessRange>& allowed, const PathPoint& point) const {
  Choice choice;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    std::size_t cheapest = allowed[i].first;
    double least = kInfinity;
    for (std::size_t p = allowed[i].first; p < allowed[i].last; ++p) {
      const SizedProcess& process = sized_.processes[i][p];
      if (process.lo > point.parts[i].size && !process.inner) break;
      const double cost = cost_within(process, point.parts[i], sized_.stacking);
      if (cost < least) std::tie(cheapest, least) = std::tuple(p, cost);
    }
    choice.push_back(cheapest);
  }
  return choice;
}

/// Changes parts of a choice to cheaper processes, one part after the other, as long as the limits allow it. Does
/// nothing unless each process of the choice allows only one size. Each step makes the change with the largest saving
/// that the limits allow (raises()).
void BranchAndBound::raise_greedily(Choice& choice) const {
  std::vector<double> sizes(choice.size());
  for (std::size_t i = 0; i < choice.size(); ++i) {
    const SizedProcess& process = sized_.processes[i][choice[i]];
    if (!process.single()) return;
    sizes[i] += process.lo;
    if (process.inner) sizes[process.inner->part] += inner_size(process);
  }
  std::vector<double> left;
  for (std::size_t l = 0; l < sized_.limits; ++l) {
    left.push_back(1.0 - rounding_margin(sizes.size()) - dot(sized_.row(l), sizes));
  }
  for (bool raised = true; raised;) {
    raised = false;
    for (const Raise& raise : raises(choice)) {
      const SizedProcess& to = sized_.processes[raise.part][raise.process];
      const SizedProcess& from = sized_.processes[raise.part][choice[raise.part]];
      const auto more = [&](std::size_t l) {
        const double own = sized_.row(l)[raise.part] * (to.lo - from.lo);
        return to.inner ? own + sized_.row(l)[to.inner->part] * (inner_size(to) - inner_size(from)) : own;
      };
      std::size_t l = 0;
      while (l < left.size() && more(l) <= left[l]) ++l;
      if (l < left.size()) continue;
      for (l = 0; l < left.size(); ++l) left[l] -= more(l);
      choice[raise.part] = raise.process;
      raised = true;
      break;
    }
  }
}

/// The changes that make one part of a choice cheaper, the largest saving first. A part may change to the next process
/// in its list. The two parts of a pair change together, to any of their processes. Only processes that allow one size
/// are considered.
std::vector<Raise> BranchAndBound::raises(const Choice& choice) const {
  std::vector<Raise> found;
  for (std::size_t i = 0; i < choice.size(); ++i) {
    const auto& processes = sized_.processes[i];
    const bool is_pair = processes.front().inner.has_value();
    const std::size_t last = is_pair ? processes.size() : std::min(choice[i] + 2, processes.size());
    for (std::size_t p = is_pair ? 0 : choice[i] + 1; p < last; ++p) {
      if (!processes[p].single()) continue;
      const double saving =
          single_cost(processes[choice[i]], sized_.stacking) - single_cost(processes[p], sized_.stacking);
      if (saving > 0.0) found.push_back({saving, i, p});
    }
  }
  std::ranges::sort(found, [](const Raise& a, const Raise& b) {
    return std::tie(b.saving, a.part, a.process) < std::tie(a.saving, b.part, b.process);
  });
  return found;
}

/// Removes from both ends of each range the processes that cannot belong to a choice below the cutoff(). point, bound:
/// solution of the relaxation, and its lower bound.
void BranchAndBound::prune_by_bound(std::vector<ProcessRange>& allowed, const PathPoint& point, double bound) {
  const double most = cutoff();
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const BestResponse& part = point.parts[i];
    const auto exceeds_cutoff = [&](std::size_t p) {
      const double with = bound + (process_response(sized_.processes[i][p], part.prices(), sized_.stacking).lagrangian -
                                   part.lagrangian);
      if (with < most) return false;
      close(with);
      return true;
    };
    while (allowed[i].size() > 1 && exceeds_cutoff(allowed[i].first)) ++allowed[i].first;
    while (allowed[i].size() > 1 && exceeds_cutoff(allowed[i].last - 1)) --allowed[i].last;
  }
}

/// Splits the range of processes of the part with the largest spread_of() before or after its main process, and queues
/// a node for each half.
void BranchAndBound::branch(const std::vector<ProcessRange>& allowed, const PathPoint& point, double bound) {
  std::size_t part = allowed.size();
  double most = -1.0;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const double open = spread_of(point.parts[i]);
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
  // Pruning needs a bound and multipliers of the same point, so it takes the point's bound even if the parent's is
  // higher.
  prune_by_bound(allowed, point, point.lower_bound);
  branch(allowed, point, bound);
}

std::optional<LeastCost> BranchAndBound::run() {
  push(-kInfinity, all_processes(sized_), {});
  while (!open_.empty() && (nodes_ < options_.max_nodes || best_.empty())) {
    if (open_.top().bound >= cutoff()) break;
    const Node node = open_.top();
    open_.pop();
    ++nodes_;
    expand(node);
  }
  if (!open_.empty()) close(open_.top().bound);
  if (best_.empty()) return std::nullopt;
  const ConvexSolution& best = best_.front();
  LeastCost found{
      best.allocation, std::fmin(closed_, best.allocation.cost), {}, best.multiplier, relaxed_, {0, 0.0}, {}, nodes_};
  for (std::size_t k = 1; k < best_.size(); ++k) found.next.push_back(best_[k].allocation);
  return found;
}

}  // namespace

std::optional<LeastCost> branch_and_bound(const AllocationProblem& problem, const SizedProblem& sized,
                                          const SearchOptions& options) {
  return BranchAndBound(problem, sized, options).run();
}

}  // namespace poesy
