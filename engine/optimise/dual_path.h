#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/optimise/sized_problem.h"

/// The Lagrange dual of the least cost, and its central path. For given multipliers of the limits, each part's best
/// size is independent of the others, and the sum of the parts' costs and of multiplier x (use - room) is a lower bound
/// on the least cost.
namespace poesy {

/// The processes of a part that are allowed: [first, last) of its list, at least one.
struct ProcessRange {
  std::size_t first;  ///< position in SizedProblem::processes
  std::size_t last;   ///< one past the last position

  std::size_t size() const { return last - first; }  ///< The number of processes.
};

/// The best size of one process at a price on its size.
struct ProcessResponse {
  double size;        ///< in [lo, hi]
  double cost;        ///< cost of that size
  double lagrangian;  ///< cost + price x size, which is least at this size
};

/// The best response of a process. Precondition: price >= 0.
ProcessResponse process_response(const SizedProcess& process, double price, Stacking stacking);

/// The best response of a part at given multipliers. If several processes are allowed it is a mix of them.
struct BestResponse {
  double price = 0.0;              ///< price of a unit of its size: sum over the limits of multiplier x effect
  double size = 0.0;               ///< mean of the mix
  double inverse_curvature = 0.0;  ///< decrease of the size per unit of price
  double cost = 0.0;               ///< mean of the mix
  double lagrangian = 0.0;         ///< least cost + price x size over all sizes of all processes
  double deviation = 0.0;          ///< standard deviation of the sizes of the mix
  std::size_t main = 0;            ///< position of the process with the largest weight
};

/// The best response of a part to a price on its size. Processes are mixed by weights exp(-lagrangian / mu), as in a
/// Boltzmann distribution of temperature mu.
BestResponse best_response(std::span<const SizedProcess> processes, ProcessRange allowed, double price, double mu,
                           Stacking stacking);

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
  /// leave hardly any room of a limit.
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
};

}  // namespace poesy
