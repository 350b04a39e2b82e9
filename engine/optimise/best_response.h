#pragma once

#include <cstddef>
#include <span>

#include "engine/optimise/sized_problem.h"

/// The best response of a part to prices: the size (T^2, or T for Stacking::worst_case) at which its cost + price x
/// size is least. The sum of these minima over all parts, minus the sum over the limits of multiplier x room, is
/// Lagrange's lower bound on the cost.
namespace poesy {

/// The prices per unit of size: the price of a part and, if it is the outer part of a pair (Within in least_cost.h),
/// that of the inner part. A price is the sum over the limits of multiplier x effect.
struct Prices {
  double own;  ///< price of the size of the part itself, >= 0
  /// Price of the size of the pair's inner part; 0 without a pair. It may be negative, but own + Within::share x inner
  /// is >= 0.
  double inner = 0.0;
};

/// The best sizes under one process: among the sizes that the process allows, those with the least cost + price x size.
/// For a pair, costs and price x size of both parts are added.
struct ProcessResponse {
  double size;              ///< best size of the part, in [lo, hi] of the process
  double cost;              ///< cost at the best sizes
  double lagrangian;        ///< cost + price x size at the best sizes
  double inner_size = 0.0;  ///< best size of a pair's inner part: within its bounds and at most Within::share x `size`
};

/// Finds the best sizes under this process (ProcessResponse).
ProcessResponse process_response(const SizedProcess& process, const Prices& prices, Stacking stacking);

/// The members of BestResponse for the inner part of a pair (Within in least_cost.h).
struct InnerResponse {
  double price = 0.0;              ///< price of a unit of the inner part's size
  double size = 0.0;               ///< mean size over the mixed processes
  double inverse_curvature = 0.0;  ///< decrease of the size per unit of the inner part's price
  /// Decrease of the inner part's size per unit of the outer part's price. It equals the decrease of the outer part's
  /// size per unit of the inner part's price.
  double cross = 0.0;
  double deviation = 0.0;  ///< standard deviation of the size over the mixed processes
};

/// The best sizes of a part, or of both parts of a pair, at given prices. If several processes are allowed, they are
/// mixed: sizes and costs are weighted means over the processes.
struct BestResponse {
  double price = 0.0;              ///< price of a unit of the part's own size
  double size = 0.0;               ///< mean size over the mixed processes
  double inverse_curvature = 0.0;  ///< decrease of the size per unit of the part's own price
  double cost = 0.0;               ///< mean cost over the mixed processes
  double lagrangian = 0.0;         ///< least cost + price x size over all sizes of all allowed processes
  double deviation = 0.0;          ///< standard deviation of the size over the mixed processes
  std::size_t main = 0;            ///< position of the process with the largest weight in the mix
  InnerResponse inner;             ///< inner part of a pair; zeros for a part that is in no pair

  /// The given prices of the part's size and of the inner part's size.
  Prices prices() const { return {price, inner.price}; }
};

/// Computes the best sizes at these prices. A process has a weight in the mix that is proportional to
/// exp(-ProcessResponse::lagrangian / mu), as in a Boltzmann distribution of temperature mu.
BestResponse best_response(std::span<const SizedProcess> processes, ProcessRange allowed, const Prices& prices,
                           double mu, Stacking stacking);

}  // namespace poesy
