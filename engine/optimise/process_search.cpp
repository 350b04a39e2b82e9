#include "engine/optimise/process_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <queue>
#include <tuple>

#include "engine/optimise/chosen_processes.h"
#include "engine/optimise/price_path.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One place of each part's menu.
using Places = std::vector<std::size_t>;

struct Node {
  double bound;        ///< no choice below this node costs less
  std::size_t number;  ///< in the order in which nodes were made
  std::vector<MenuRange> allowed;
  std::vector<double> prices;  ///< of the node above

  /// For a queue whose first is the lowest bound.
  bool operator<(const Node& other) const { return std::tie(other.bound, other.number) < std::tie(bound, number); }
};

class ProcessSearch {
 public:
  ProcessSearch(const AllocationProblem& problem, const SizedProblem& sized, const SearchOptions& options)
      : problem_(problem), sized_(sized), options_(options), path_(sized) {}

  LeastCost run();

 private:
  double cutoff() const;
  void push(double bound, std::vector<MenuRange> allowed, std::vector<double> prices);
  void close(double bound) { closed_ = std::fmin(closed_, bound); }
  double try_places(const Places& places);
  void expand(const Node& node);
  bool is_possible(const std::vector<MenuRange>& allowed) const;
  Places rounded_down(const std::vector<MenuRange>& allowed, const PathPoint& point) const;
  void raise(Places& places) const;
  void drop_what_is_dear(std::vector<MenuRange>& allowed, const PathPoint& point, double bound);
  void branch(const std::vector<MenuRange>& allowed, const PathPoint& point, double bound);

  const AllocationProblem& problem_;
  const SizedProblem& sized_;
  SearchOptions options_;
  PricePath path_;
  std::priority_queue<Node> open_;
  std::map<Places, double> tried_;      ///< with their lower bounds
  std::vector<ChosenAllocation> best_;  ///< by cost, as many as are wanted
  std::vector<double> relaxed_;         ///< [L] multipliers at the root
  double closed_ = kInfinity;           ///< the lowest bound of what was left
  std::size_t nodes_ = 0;
  std::size_t made_ = 0;
};

/// What costs this much or more need not be known.
double ProcessSearch::cutoff() const {
  if (best_.size() <= options_.alternatives) return kInfinity;
  const double cost = best_.back().allocation.cost;
  return cost - options_.relative_gap * std::abs(cost);
}

void ProcessSearch::push(double bound, std::vector<MenuRange> allowed, std::vector<double> prices) {
  open_.push({bound, made_++, std::move(allowed), std::move(prices)});
}

/// The least cost with these processes joins the best ones. Its lower bound; infinite where a limit is broken.
double ProcessSearch::try_places(const Places& places) {
  if (const auto known = tried_.find(places); known != tried_.end()) return known->second;
  double& bound = tried_[places];
  bound = kInfinity;
  const auto chosen_problem = with_chosen(sized_, places);
  if (!chosen_problem) return bound;
  auto chosen = allocate_chosen(problem_, *chosen_problem, path_.rows());
  if (!chosen) return bound;
  bound = chosen->lower_bound;
  const auto order = [](const ChosenAllocation& a, const ChosenAllocation& b) {
    return std::tie(a.allocation.cost, a.allocation.process) < std::tie(b.allocation.cost, b.allocation.process);
  };
  best_.insert(std::ranges::upper_bound(best_, *chosen, order), std::move(*chosen));
  if (best_.size() > options_.alternatives + 1) best_.pop_back();
  return bound;
}

/// Whether the smallest sizes keep every limit.
bool ProcessSearch::is_possible(const std::vector<MenuRange>& allowed) const {
  std::vector<double> lo;
  for (std::size_t i = 0; i < allowed.size(); ++i) lo.push_back(sized_.menus[i][allowed[i].first].lo);
  const double most = 1.0 - 4.0 * rounding_margin(lo.size());
  for (std::size_t l = 0; l < sized_.limits; ++l) {
    if (!sized_.full[l] && dot(sized_.row(l), lo) > most) return false;
  }
  return true;
}

/// A choice that keeps the limits: of each part the cheapest process that reaches down to its size.
Places ProcessSearch::rounded_down(const std::vector<MenuRange>& allowed, const PathPoint& point) const {
  Places places;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    std::size_t cheapest = allowed[i].first;
    double least = kInfinity;
    for (std::size_t p = allowed[i].first; p < allowed[i].last; ++p) {
      const SizedProcess& process = sized_.menus[i][p];
      if (process.lo > point.parts[i].size) break;
      const double cost = process.cost.at(tolerance_of(std::fmin(process.hi, point.parts[i].size), sized_.stacking));
      if (cost < least) std::tie(cheapest, least) = std::tuple(p, cost);
    }
    places.push_back(cheapest);
  }
  return places;
}

/// Takes the next larger single value of a part, that which saves most, for as long as limits leave room.
void ProcessSearch::raise(Places& places) const {
  const auto at = [&](std::size_t i, std::size_t up) -> const SizedProcess& { return sized_.menus[i][places[i] + up]; };
  std::vector<double> sizes;
  for (std::size_t i = 0; i < places.size(); ++i) {
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
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (places[i] + 1 == sized_.menus[i].size() || !at(i, 1).single()) continue;
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
      ++places[i];
      raised = true;
      break;
    }
  }
}

/// Processes at the ends of the ranges with which no choice can be among the best.
void ProcessSearch::drop_what_is_dear(std::vector<MenuRange>& allowed, const PathPoint& point, double bound) {
  const double enough = cutoff();
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const PartAnswer& part = point.parts[i];
    const auto is_dear = [&](std::size_t p) {
      const double with = bound + (offer(sized_.menus[i][p], part.price, sized_.stacking).total - part.least);
      if (with < enough) return false;
      close(with);
      return true;
    };
    while (allowed[i].size() > 1 && is_dear(allowed[i].first)) ++allowed[i].first;
    while (allowed[i].size() > 1 && is_dear(allowed[i].last - 1)) --allowed[i].last;
  }
}

/// Divides the range of the part whose mix leaves most open, beside its main process.
void ProcessSearch::branch(const std::vector<MenuRange>& allowed, const PathPoint& point, double bound) {
  std::size_t part = allowed.size();
  double most = -1.0;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    const double open = point.parts[i].price * point.parts[i].scatter;
    if (allowed[i].size() > 1 && open > most) std::tie(part, most) = std::tuple(i, open);
  }
  if (part == allowed.size()) {
    push(bound, allowed, point.prices);
    return;
  }
  const MenuRange range = allowed[part];
  const std::size_t main = std::clamp(point.parts[part].main, range.first, range.last - 1);
  const bool above = point.parts[part].size > sized_.menus[part][main].lo;
  const std::size_t cut = (above || main == range.first) && main + 1 < range.last ? main + 1 : main;
  std::vector<MenuRange> half = allowed;
  half[part] = {range.first, std::max(cut, range.first + 1)};
  push(bound, half, point.prices);
  half[part] = {std::max(cut, range.first + 1), range.last};
  push(bound, half, point.prices);
}

void ProcessSearch::expand(const Node& node) {
  std::vector<MenuRange> allowed = node.allowed;
  if (std::ranges::all_of(allowed, [](const MenuRange& range) { return range.size() == 1; })) {
    Places places;
    for (const MenuRange& range : allowed) places.push_back(range.first);
    close(std::fmax(node.bound, try_places(places)));
    return;
  }
  if (!is_possible(allowed)) return;
  const bool root = nodes_ == 1;
  const PathPoint point = path_.follow(allowed, node.prices, {cutoff(), !root});
  const double bound = std::fmax(node.bound, point.lower);
  if (root) relaxed_ = multipliers(problem_.limits, path_.rows(), point.prices);
  Places places = rounded_down(allowed, point);
  raise(places);
  try_places(places);
  if (bound >= cutoff()) {
    close(bound);
    return;
  }
  // What a price adds to a process is about the prices of this point, whose bound may be lower than that of a node
  // above.
  drop_what_is_dear(allowed, point, point.lower);
  branch(allowed, point, bound);
}

LeastCost ProcessSearch::run() {
  std::vector<MenuRange> all;
  for (const auto& menu : sized_.menus) all.push_back({0, menu.size()});
  push(-kInfinity, std::move(all), {});
  while (!open_.empty() && (nodes_ < options_.most_nodes || best_.empty())) {
    if (open_.top().bound >= cutoff()) break;
    const Node node = open_.top();
    open_.pop();
    ++nodes_;
    expand(node);
  }
  if (!open_.empty()) close(open_.top().bound);
  const ChosenAllocation& best = best_.front();  // there is one: the search ends without only when it has tried all
  LeastCost found{
      best.allocation, std::fmin(closed_, best.allocation.cost), {}, best.multiplier, relaxed_, {0, 0.0}, {}, nodes_};
  for (std::size_t k = 1; k < best_.size(); ++k) found.next.push_back(best_[k].allocation);
  return found;
}

}  // namespace

LeastCost search_processes(const AllocationProblem& problem, const SizedProblem& sized, const SearchOptions& options) {
  return ProcessSearch(problem, sized, options).run();
}

}  // namespace poesy
