#pragma once

#include <cstddef>
#include <span>

#include "engine/optimise/sized_problem.h"

/// The sizes of a part at which cost + price x size is least, for given prices (its best response). Lagrange's lower
/// bound on the cost is computed from the sum of these minima.
namespace poesy {

/// The price of a unit of a part's own size, and the price of a unit of the size of the inner part of its pair (Within
/// in least_cost.h). A price is the sum over the limits of multiplier x effect.
struct Prices {
  double own;          ///< price of the part's own size, >= 0
  double inner = 0.0;  ///< price of the size of the pair's inner part, 0 without a pair; may be negative, but own +
                       ///< Within::share x inner is >= 0
};

/// The best sizes under one process: of the sizes that it allows, those with the least cost + price x size (of a part,
/// and of the inner part of its pair).
struct ProcessResponse {
  double size;              ///< size at which cost + price x size is least, in [lo, hi]
  double cost;              ///< cost at these sizes
  double lagrangian;        ///< least value of cost + price x size, which is that at these sizes
  double inner_size = 0.0;  ///< size of a pair's inner part: within its bounds and at most share x size
};

/// Finds the sizes that the process allows at which cost + price x size is least.
ProcessResponse process_response(const SizedProcess& process, const Prices& prices, Stacking stacking);

/// The part of BestResponse that is about the inner part of a pair (Within in least_cost.h).
struct InnerResponse {
  double price = 0.0;              ///< price of a unit of the inner part's size
  double size = 0.0;               ///< mean size over the mixed processes
  double inverse_curvature = 0.0;  ///< decrease of the size per unit of the inner part's price
  /// Decrease of the inner part's size per unit of the outer part's price. It equals the decrease of the outer part's
  /// size per unit of the inner part's price.
  double cross = 0.0;
  double deviation = 0.0;  ///< standard deviation of the size over the mixed processes
};

/// The sizes at which cost + price x size is least, for a part or for both parts of a pair, at given prices. If several
/// processes are allowed, sizes and costs are weighted means over them (a mix).
struct BestResponse {
  double price = 0.0;              ///< price of a unit of the part's own size
  double size = 0.0;               ///< mean size over the mixed processes
  double inverse_curvature = 0.0;  ///< decrease of the size per unit of the part's own price
  double cost = 0.0;               ///< mean cost over the mixed processes
  double lagrangian = 0.0;         ///< least cost + price x size over all sizes of all processes
  double deviation = 0.0;          ///< standard deviation of the size over the mixed processes
  std::size_t main = 0;            ///< position of the process with the largest weight
  InnerResponse inner;             ///< inner part of a pair; zeros for a part that is in no pair

  /// The two given prices: that of the part's own size, and that of the size of the inner part of its pair (Within).
  Prices prices() const { return {price, inner.price}; }
};

/// Computes the best sizes for these prices. The weight of a process in the mix is proportional to exp(-lagrangian /
/// mu), as in a Boltzmann distribution of temperature mu.
BestResponse best_response(std::span<const SizedProcess> processes, ProcessRange allowed, const Prices& prices,
                           double mu, Stacking stacking);

}  // namespace poesy
