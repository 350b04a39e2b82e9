#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/optimise/best_response.h"
#include "engine/optimise/sized_problem.h"

/// The Lagrange dual of the least cost, and its central path. For given multipliers of the limits, each part's best
/// size is independent of the others, and the sum of the parts' costs and of multiplier x (use - room) is a lower bound
/// on the least cost.
namespace poesy {

/// A lower bound on the cost from any multipliers [K] >= 0 of the limits `working_set` [K]: no tolerances within these
/// bounds and the limits cost less. It is lowered by what rounding may have added.
double lower_bound(const SizedProblem& problem, std::span<const ProcessRange> allowed,
                   std::span<const std::size_t> working_set, std::span<const double> multipliers);

/// When to stop following the path. By default it is followed to its end.
struct PathTarget {
  /// The path is left when its lower bound is this high. Set it to the cost of the best known choice, because a node
  /// with a higher bound is pruned.
  double cutoff = std::numeric_limits<double>::infinity();
  /// The path is also left when its bound can no longer reach the cutoff. Set it in branch and bound, which then
  /// divides the node whatever its exact bound is. Do not set it if the multipliers themselves are wanted.
  bool only_to_branch = false;
};

/// The end of the path.
struct PathPoint {
  /// [N] Their sizes keep all limits, unless rounding ended the path too soon; this may happen if the lowest bounds
  /// leave hardly any room of a limit. The inner part of a pair has a size only: the response of the outer part is that
  /// of both.
  std::vector<BestResponse> parts;
  std::vector<double> multipliers;  ///< [K] in the order of DualPath::working_set()
  double lower_bound = 0.0;         ///< lower_bound() at these multipliers
  double cost = 0.0;  ///< cost of the mixes; if the limits are kept, an upper bound on the least cost with mixes
};

/// The central path of the dual (interior-point method; Boyd and Vandenberghe 2004, Convex Optimization, chapter 11).
/// Its points maximise the lower bound plus mu x (sum of the logarithms of the multipliers), with processes mixed at
/// temperature mu, while mu falls to zero. At each point every limit has multiplier x slack = mu, so sizes keep the
/// limits and the cost is at most (limits + sum of the logarithms of the numbers of processes) x mu above the bound.
/// The function is concave, with one variable for each limit in the working set; Newton's method finds each maximum.
/// Limits join the working set when sizes break them.
class DualPath {
 public:
  /// Refers to the problem. The working set begins with these limits.
  explicit DualPath(const SizedProblem& problem, std::vector<std::size_t> working_set = {});

  /// Follows the path. start: multipliers [<= K] of the first limits of working_set(). Precondition: the smallest
  /// allowed sizes keep every limit.
  PathPoint follow(std::span<const ProcessRange> allowed, std::span<const double> start, const PathTarget& target);

  const std::vector<std::size_t>& working_set() const { return working_set_; }  ///< [K] limits that took part so far

 private:
  void add_limit(std::size_t limit);
  void begin(std::span<const double> start, double mu);
  void update_responses(double mu);
  std::vector<double> scaled_effects() const;
  bool is_centred(double mu) const;
  bool centre(double mu);
  bool find_newton_direction(double mu);
  void search_line(double mu);
  bool add_violated_limits(double mu);
  PathPoint here() const;

  const SizedProblem& problem_;
  double room_;  ///< room of every limit: 1 less a margin for rounding
  std::span<const ProcessRange> allowed_;
  std::vector<std::size_t> working_set_;
  std::vector<char> is_in_set_;          ///< [L]
  std::vector<double> effects_;          ///< [K x N] effects on the limits of the working set
  std::vector<double> multipliers_;      ///< [K]
  std::vector<double> slack_;            ///< [K] slack of the limits at these multipliers
  std::vector<double> direction_;        ///< [K] Newton's step over the multipliers
  std::vector<BestResponse> responses_;  ///< [N]
  std::vector<double> sizes_;            ///< [N]
  std::vector<double> inner_prices_;     ///< [N] price of the inner part of a pair; 0 for other parts
};

}  // namespace poesy
