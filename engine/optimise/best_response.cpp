#include "engine/optimise/best_response.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A process has a weight in the mix that is proportional to exp(-lagrangian / mu). If its lagrangian exceeds the least
/// one by more than this multiple of mu, the weight counts as 0.
constexpr double kNegligibleExponent = 40.0;
constexpr int kMaxNewtonSteps = 100;  ///< largest number of Newton steps in common_size()

/// The size in [lo, hi] at which cost + price x size is least.
double size_within(const CostLaw& cost, double lo, double hi, double price, Stacking stacking) {
  if (lo == hi) return lo;
  return std::fmax(lo, std::fmin(hi, price > 0.0 ? cost.cheapest_size(price, stacking) : kInfinity));
}

/// The cost of both parts of a pair, and its derivatives with respect to the outer part's size, if the inner part has
/// the largest size that fits in it (share x size).
CostCurve common_curve(const SizedProcess& process, double size, Stacking stacking) {
  const double share = process.inner->share;
  const CostCurve outer = process.cost.curve(size, stacking);
  const CostCurve inner = process.inner->cost.curve(share * size, stacking);
  return {outer.value + inner.value, outer.slope + share * inner.slope,
          outer.curvature + share * share * inner.curvature};
}

/// The sizes of a pair's outer part, from lo to hi, for which the bounds of both parts allow the largest inner part
/// that fits: its size is share x size of the outer part.
struct CommonRange {
  double lo;
  double hi;
};

CommonRange common_range(const SizedProcess& process) {
  const InnerProcess& inner = *process.inner;
  const double lo = std::fmax(process.lo, inner.lo / inner.share);
  return {lo, std::fmax(lo, std::fmin(process.hi, inner.hi / inner.share))};
}

/// The size of a pair's outer part at which cost + price x size is least, if the inner part has the largest size that
/// fits in it (share x size). price: of the outer part, plus share x price of the inner part. Newton's method finds the
/// root -slope = price; it iterates in logarithms, because log(-slope) is nearly linear in log(size). An error of the
/// size changes the minimum only to second order.
double common_size(const SizedProcess& process, double price, Stacking stacking) {
  auto [lo, hi] = common_range(process);
  if (lo == hi || price <= 0.0 || common_curve(process, hi, stacking).slope + price <= 0.0) return hi;
  if (lo > 0.0 && common_curve(process, lo, stacking).slope + price >= 0.0) return lo;
  // Lower bounds: the size that is best for one of the two cost laws alone is at most the size that is best for their
  // sum.
  const double share = process.inner->share;
  double size = lo;
  if (!process.cost.is_constant()) size = std::fmax(size, process.cost.cheapest_size(price, stacking));
  if (!process.inner->cost.is_constant()) {
    size = std::fmax(size, process.inner->cost.cheapest_size(price / share, stacking) / share);
  }
  size = std::fmin(size, hi);
  for (int step = 0; step < kMaxNewtonSteps; ++step) {
    const CostCurve curve = common_curve(process, size, stacking);
    (curve.slope + price > 0.0 ? hi : lo) = size;
    const double change = std::log(-curve.slope / price) * -curve.slope / (size * curve.curvature);
    double next = size * std::exp(change);
    if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
    const bool ends = std::abs(next - size) <= 1e-9 * size;  // the next change is about the square of this one
    size = next;
    if (ends) break;
  }
  return size;
}

ProcessResponse pair_response(const SizedProcess& process, const Prices& prices, Stacking stacking) {
  const InnerProcess& inner = *process.inner;
  const auto cost_of = [&](const CostLaw& law, double size) { return law.at(tolerance_of(size, stacking)); };
  double size = 0.0;
  double within = 0.0;
  if (inner.left_out) {
    size = size_within(process.cost, process.lo, process.hi, prices.own + inner.share * prices.inner, stacking);
    within = inner.share * size;
  } else {
    size = size_within(process.cost, process.lo, process.hi, prices.own, stacking);
    within = size_within(inner.cost, inner.lo, inner.hi, prices.inner, stacking);
    if (within > inner.share * size) {
      size = common_size(process, prices.own + inner.share * prices.inner, stacking);
      within = inner.share * size;
    }
  }
  const double cost = cost_of(process.cost, size) + (inner.left_out ? 0.0 : cost_of(inner.cost, within));
  return {size, cost, cost + prices.own * size + prices.inner * within, within};
}

/// Derivatives of the best sizes with respect to prices, without their minus sign. own: of the part's size, with
/// respect to the part's price. inner: of the inner part's size, with respect to the inner part's price. cross: of the
/// size of one of the two parts, with respect to the price of the other part.
struct InverseCurvature {
  double own;
  double inner = 0.0;
  double cross = 0.0;
};

double inverse_curvature(const CostLaw& cost, double lo, double hi, double size, Stacking stacking) {
  return size > lo && size < hi ? 1.0 / cost.curve(size, stacking).curvature : 0.0;
}

InverseCurvature pair_curvature(const SizedProcess& process, const ProcessResponse& at, Stacking stacking) {
  const InnerProcess& inner = *process.inner;
  const double share = inner.share;
  if (!inner.left_out && at.inner_size != share * at.size) {
    return {inverse_curvature(process.cost, process.lo, process.hi, at.size, stacking),
            inverse_curvature(inner.cost, inner.lo, inner.hi, at.inner_size, stacking)};
  }
  double common = 0.0;
  if (inner.left_out) {
    common = inverse_curvature(process.cost, process.lo, process.hi, at.size, stacking);
  } else if (const auto [lo, hi] = common_range(process); at.size > lo && at.size < hi) {
    common = 1.0 / common_curve(process, at.size, stacking).curvature;
  }
  return {common, share * share * common, share * common};
}

/// The best sizes of a part that is in no pair, and their derivatives, for mix().
struct PlainPart {
  static ProcessResponse response(const SizedProcess& process, const Prices& prices, Stacking stacking) {
    const double size = size_within(process.cost, process.lo, process.hi, prices.own, stacking);
    const double cost = process.cost.at(tolerance_of(size, stacking));
    return {size, cost, cost + prices.own * size};
  }
  static InverseCurvature curvature(const SizedProcess& process, const ProcessResponse& at, Stacking stacking) {
    return {inverse_curvature(process.cost, process.lo, process.hi, at.size, stacking)};
  }
  static constexpr bool kHasInner = false;
};

/// The best sizes of both parts of a pair, and their derivatives, for mix().
struct PairOfParts {
  static ProcessResponse response(const SizedProcess& process, const Prices& prices, Stacking stacking) {
    return pair_response(process, prices, stacking);
  }
  static InverseCurvature curvature(const SizedProcess& process, const ProcessResponse& at, Stacking stacking) {
    return pair_curvature(process, at, stacking);
  }
  static constexpr bool kHasInner = true;
};

/// Sets the members of `part` that are means or deviations over the mixed processes. Sizes are summed relative to those
/// of the process with the largest weight, so that the variance does not lose digits.
template <class Kind>
void mix(std::span<const SizedProcess> processes, ProcessRange allowed, double mu, Stacking stacking,
         BestResponse& part) {
  const Prices prices = part.prices();
  const ProcessResponse main = Kind::response(processes[part.main], prices, stacking);
  double weights = 0.0;
  double cost = 0.0;
  double shift = 0.0;
  double inner_shift = 0.0;
  InverseCurvature inverse{0.0};
  InverseCurvature square{0.0};
  for (std::size_t p = allowed.first; p < allowed.last; ++p) {
    const ProcessResponse one = Kind::response(processes[p], prices, stacking);
    const double exponent = (one.lagrangian - part.lagrangian) / mu;
    if (!(exponent < kNegligibleExponent)) continue;
    const double weight = std::exp(-exponent);
    const InverseCurvature curvature = Kind::curvature(processes[p], one, stacking);
    const double own = one.size - main.size;
    weights += weight;
    inverse.own += weight * curvature.own;
    cost += weight * one.cost;
    shift += weight * own;
    square.own += weight * own * own;
    if constexpr (Kind::kHasInner) {
      const double inner = one.inner_size - main.inner_size;
      inverse.inner += weight * curvature.inner;
      inverse.cross += weight * curvature.cross;
      inner_shift += weight * inner;
      square.inner += weight * inner * inner;
      square.cross += weight * own * inner;
    }
  }
  const double mean = shift / weights;
  const double variance = std::fmax(0.0, square.own / weights - mean * mean);
  part.size = main.size + mean;
  part.cost = cost / weights;
  part.inverse_curvature = inverse.own / weights + variance / mu;
  part.deviation = std::sqrt(variance);
  if constexpr (Kind::kHasInner) {
    const double inner_mean = inner_shift / weights;
    const double inner_variance = std::fmax(0.0, square.inner / weights - inner_mean * inner_mean);
    part.inner.size = main.inner_size + inner_mean;
    part.inner.inverse_curvature = inverse.inner / weights + inner_variance / mu;
    part.inner.cross = inverse.cross / weights + (square.cross / weights - mean * inner_mean) / mu;
    part.inner.deviation = std::sqrt(inner_variance);
  }
}

template <class Kind>
BestResponse best_response_of(std::span<const SizedProcess> processes, ProcessRange allowed, const Prices& prices,
                              double mu, Stacking stacking) {
  const ProcessResponse first = Kind::response(processes[allowed.first], prices, stacking);
  BestResponse part{prices.own, first.size, 0.0, first.cost, first.lagrangian, 0.0, allowed.first, {}};
  part.inner = {prices.inner, first.inner_size, 0.0, 0.0, 0.0};
  if (allowed.size() == 1) {
    const InverseCurvature inverse = Kind::curvature(processes[allowed.first], first, stacking);
    part.inverse_curvature = inverse.own;
    part.inner.inverse_curvature = inverse.inner;
    part.inner.cross = inverse.cross;
    return part;
  }
  for (std::size_t p = allowed.first + 1; p < allowed.last; ++p) {
    const double lagrangian = Kind::response(processes[p], prices, stacking).lagrangian;
    if (lagrangian >= part.lagrangian) continue;
    part.lagrangian = lagrangian;
    part.main = p;
  }
  mix<Kind>(processes, allowed, mu, stacking, part);
  return part;
}

}  // namespace

ProcessResponse process_response(const SizedProcess& process, const Prices& prices, Stacking stacking) {
  if (process.inner) return PairOfParts::response(process, prices, stacking);
  return PlainPart::response(process, prices, stacking);
}

BestResponse best_response(std::span<const SizedProcess> processes, ProcessRange allowed, const Prices& prices,
                           double mu, Stacking stacking) {
  POESY_EXPECTS(allowed.size() > 0 && allowed.last <= processes.size());
  if (processes.front().inner) return best_response_of<PairOfParts>(processes, allowed, prices, mu, stacking);
  return best_response_of<PlainPart>(processes, allowed, prices, mu, stacking);
}

}  // namespace poesy
