#pragma once

#include <cstddef>
#include <span>

#include "engine/optimise/sized_problem.h"

/// The sizes at least cost + price x size, for given prices: the minimum inside Lagrange's bound.
namespace poesy {

/// The prices of a unit of size: sums over the limits of multiplier x effect.
struct Prices {
  double own;          ///< of the part, >= 0
  double inner = 0.0;  ///< of the inner part of a pair; may be negative, but own + share x inner is not
};

/// The best sizes of one process.
struct ProcessResponse {
  double size;              ///< in [lo, hi]
  double cost;              ///< cost of the sizes
  double lagrangian;        ///< cost + price x size, which is least at these sizes
  double inner_size = 0.0;  ///< of the inner part of a pair, within its bounds and the outer part
};

/// The best response of a process.
ProcessResponse process_response(const SizedProcess& process, const Prices& prices, Stacking stacking);

/// The inner part of a pair in a best response.
struct InnerResponse {
  double price = 0.0;              ///< price of a unit of its size
  double size = 0.0;               ///< mean of the mix
  double inverse_curvature = 0.0;  ///< decrease of its size per unit of its price
  double cross = 0.0;              ///< decrease of its size per unit of the outer part's price, and the reverse
  double deviation = 0.0;          ///< standard deviation of its sizes in the mix
};

/// The best response of a part, or of both parts of a pair, at given multipliers. If several processes are allowed it
/// is a mix of them.
struct BestResponse {
  double price = 0.0;              ///< price of a unit of its size: sum over the limits of multiplier x effect
  double size = 0.0;               ///< mean of the mix
  double inverse_curvature = 0.0;  ///< decrease of the size per unit of price
  double cost = 0.0;               ///< mean of the mix
  double lagrangian = 0.0;         ///< least cost + price x size over all sizes of all processes
  double deviation = 0.0;          ///< standard deviation of the sizes of the mix
  std::size_t main = 0;            ///< position of the process with the largest weight
  InnerResponse inner;             ///< zeros for a part in no pair

  Prices prices() const { return {price, inner.price}; }  ///< The prices of both parts.
};

/// The best response of a part to prices. Processes are mixed by weights exp(-lagrangian / mu), as in a Boltzmann
/// distribution of temperature mu.
BestResponse best_response(std::span<const SizedProcess> processes, ProcessRange allowed, const Prices& prices,
                           double mu, Stacking stacking);

}  // namespace poesy
