#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "engine/optimise/sized_problem.h"

/// The prices of limits at which tolerances cost least. With a price on the use of each limit every part has its best
/// size by itself, and the sum of what parts and limits then cost, less the prices, is never above the least cost:
/// Lagrange's bound.
namespace poesy {

/// Processes of a part that are allowed: [first, last) of its menu, at least one.
struct MenuRange {
  std::size_t first;  ///< by its place in the menu
  std::size_t last;   ///< the one after the last, > first

  std::size_t size() const { return last - first; }  ///< How many.
};

/// What a process does at a price on its size.
struct Offer {
  double size;   ///< the best one within its bounds
  double cost;   ///< of that size
  double total;  ///< cost + price x size
};

/// The best size of a process. Precondition: price >= 0.
Offer offer(const SizedProcess& process, double price, Stacking stacking);

/// What a part does at some prices. Where several processes are allowed it is a mix of them.
struct PartAnswer {
  double price = 0.0;    ///< of its size: sum over the limits of price x effect
  double size = 0.0;     ///< mean of the mix
  double give = 0.0;     ///< by how much the size falls per unit of price
  double cost = 0.0;     ///< mean of the mix
  double least = 0.0;    ///< least of cost + price x size over all sizes of all processes
  double scatter = 0.0;  ///< standard deviation of the sizes of the mix
  std::size_t main = 0;  ///< the process with the largest weight, by its place in the menu
};

/// The answer of a part to a price on its size. Processes are mixed by weights exp(-(cost + price x size) / mixing).
PartAnswer answer(std::span<const SizedProcess> menu, MenuRange allowed, double price, double mixing,
                  Stacking stacking);

/// A lower bound on the cost, from any prices [K] >= 0 of the limits `rows` [K]: no tolerances within these bounds and
/// the limits cost less. What rounding may have added is taken off.
double lower_bound(const SizedProblem& problem, std::span<const MenuRange> allowed, std::span<const std::size_t> rows,
                   std::span<const double> prices);

/// When to leave the path before its end. Without anything: at its end.
struct PathTarget {
  double cutoff = std::numeric_limits<double>::infinity();  ///< a lower bound this high is enough
  bool only_to_branch = false;  ///< enough also where the bound can be seen never to reach the cutoff
};

/// Where the path ended.
struct PathPoint {
  /// [N] Their sizes keep all limits, unless rounding ended the path too soon: where the lowest bounds leave hardly
  /// anything of a limit.
  std::vector<PartAnswer> parts;
  std::vector<double> prices;  ///< [K] of PricePath::rows()
  double lower = 0.0;          ///< lower_bound() at these prices
  double cost = 0.0;           ///< of the mixes: no less than the least cost with mixes, where limits are kept
};

/// Follows the prices that maximise Lagrange's bound plus mu x (sum of the prices' logarithms), with processes mixed at
/// temperature mu, while mu falls to zero: there every limit has price x slack = mu, so sizes are within the limits and
/// the cost is at most (limits + sum of the log numbers of processes) x mu above the bound. The function is concave and
/// has as many variables as limits that matter; Newton's method finds each of its maxima. Limits join when sizes break
/// them.
class PricePath {
 public:
  /// Refers to the problem. These limits take part from the beginning.
  explicit PricePath(const SizedProblem& problem, std::vector<std::size_t> rows = {});

  /// From prices [<= K] of the first of rows(). Precondition: the smallest allowed sizes keep every limit.
  PathPoint follow(std::span<const MenuRange> allowed, std::span<const double> start, const PathTarget& target);

  const std::vector<std::size_t>& rows() const { return rows_; }  ///< [K] limits that took part so far

 private:
  void join(std::size_t row);
  void begin(std::span<const double> start, double mu);
  void respond(double mu);
  bool is_centred(double mu) const;
  bool centre(double mu);
  bool find_direction(double mu);
  void move(double mu);
  bool join_broken(double mu);
  PathPoint here() const;

  const SizedProblem& problem_;
  double room_;  ///< of every limit: 1 but for a margin
  std::span<const MenuRange> allowed_;
  std::vector<std::size_t> rows_;
  std::vector<char> joined_;         ///< [L]
  std::vector<double> work_;         ///< [K x N] their effects
  std::vector<double> prices_;       ///< [K]
  std::vector<double> slack_;        ///< [K] of the limits at these prices
  std::vector<double> direction_;    ///< [K] of Newton, over the prices
  std::vector<PartAnswer> answers_;  ///< [N]
  std::vector<double> sizes_;        ///< [N]
};

}  // namespace poesy
