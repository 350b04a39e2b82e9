#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/optimise/best_response.h"
#include "engine/optimise/sized_problem.h"

/// The Lagrange dual of the least-cost problem, and its central path. If each limit has a multiplier, the best size of
/// each part (BestResponse) does not depend on the other parts. At the best sizes, the sum of the costs of all parts,
/// plus the sum over the limits of multiplier x (use - room), is a lower bound on the least cost. The use of a limit is
/// the combined effect of the sizes, its room the largest use that keeps it.
namespace poesy {

/// The lower bound on the cost that these multipliers prove: all tolerances that the allowed processes and the limits
/// permit cost at least this much. multipliers: one for each limit of the working set; other limits have the multiplier
/// 0. A margin for rounding is subtracted. Precondition: multipliers >= 0.
double lower_bound(const SizedProblem& problem, std::span<const ProcessRange> allowed,
                   std::span<const std::size_t> working_set, std::span<const double> multipliers);

/// When to stop following the central path. By default it is followed to its end.
struct PathTarget {
  /// Stop when the lower bound of the path reaches this value. Branch and bound sets it to the cost above which it
  /// prunes a node.
  double cutoff = std::numeric_limits<double>::infinity();
  /// Also stop when the lower bound will hardly reach the cutoff. Branch and bound then divides the node, whatever its
  /// exact bound is, so it sets this member for all nodes except the root. Do not set the member if the multipliers are
  /// needed exactly.
  bool only_to_branch = false;
};

/// The point of the central path at which DualPath::follow() stopped.
struct PathPoint {
  /// [parts] Best sizes of the parts. They keep all limits, except if rounding ended the path too soon. That may happen
  /// if the lowest bounds leave hardly any room in a limit. The element of a pair's outer part describes both parts;
  /// the element of the inner part contains only its size.
  std::vector<BestResponse> parts;
  std::vector<double> multipliers;  ///< [working set] multipliers, in the order of DualPath::working_set()
  double lower_bound = 0.0;         ///< lower_bound() at these multipliers
  /// Sum over the parts of the mean cost of their mixed processes. If the limits are kept, it is an upper bound on the
  /// least cost that mixing allows.
  double cost = 0.0;
};

/// The central path of the dual (interior-point method; Boyd and Vandenberghe 2004, Convex Optimization, chapter 11). A
/// point of the path maximises the lower bound plus mu x (sum of the logarithms of the multipliers), with processes
/// mixed at temperature mu. The parameter mu falls to zero along the path. At each point every limit has multiplier x
/// slack = mu with slack = room - use, so the sizes keep the limits. The cost exceeds the bound by at most mu x (number
/// of limits + sum over the parts of the logarithm of the number of processes). The maximised function is concave and
/// has one variable for each limit in the working set; Newton's method finds each maximum. A limit joins the working
/// set when the sizes at a point break it.
class DualPath {
 public:
  /// Keeps a reference to the problem. working_set: indices of the limits with which the working set begins.
  explicit DualPath(const SizedProblem& problem, std::vector<std::size_t> working_set = {});

  /// Follows the path with these allowed processes until the target is reached or the path ends. start: multipliers of
  /// the limits of working_set(), in their order, with which the path starts; the last ones may be missing.
  /// Precondition: the lowest allowed sizes keep every limit.
  PathPoint follow(std::span<const ProcessRange> allowed, std::span<const double> start, const PathTarget& target);

  /// [working set] The indices of the limits that have joined the working set so far.
  const std::vector<std::size_t>& working_set() const { return working_set_; }

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
  double room_;  ///< room of every limit: 1 minus a margin for rounding
  std::span<const ProcessRange> allowed_;
  std::vector<std::size_t> working_set_;
  std::vector<char> is_in_set_;  ///< [limits] 1 if a limit is in the working set, or is tight and so need not join it
  std::vector<double> effects_;  ///< [working set x parts] effects of the parts on the limits of the working set
  std::vector<double> multipliers_;      ///< [working set] multipliers of the limits of the working set
  std::vector<double> slack_;            ///< [working set] slack (room - use) of these limits at the best sizes
  std::vector<double> direction_;        ///< [working set] Newton's step, relative to the multipliers
  std::vector<BestResponse> responses_;  ///< [parts] best sizes of the parts at the multipliers
  std::vector<double> sizes_;            ///< [parts] sizes of the parts
  std::vector<double> inner_prices_;     ///< [parts] price of the inner part of a pair; 0 for other parts
};

}  // namespace poesy
