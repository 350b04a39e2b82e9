#include "engine/stats/chebyshev_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/base/contract.h"
#include "engine/base/instruction_sets.h"

namespace poesy {
namespace {

constexpr std::size_t kNodes = ChebyshevSeries::kNodes;
constexpr std::size_t kTail = 3;    ///< number of last coefficients that show whether a series has converged
constexpr std::size_t kLanes = 32;  ///< number of points at which a series is summed at the same time

/// The values of the Chebyshev polynomials T_n at the nodes, [n x node].
using Polynomials = std::array<std::array<double, kNodes>, kNodes>;

const Polynomials& polynomials() {
  static const Polynomials table = [] {
    Polynomials made;
    for (std::size_t n = 0; n < kNodes; ++n) {
      for (std::size_t k = 0; k < kNodes; ++k) {
        made[n][k] = std::cos(std::numbers::pi / kNodes * static_cast<double>(n) * (static_cast<double>(k) + 0.5));
      }
    }
    return made;
  }();
  return table;
}

/// Sums a series at kLanes points by Clenshaw's recurrence.
POESY_EACH_INSTRUCTION_SET void sum_lanes(const double* terms, std::size_t count, const double* x, double* sums) {
  std::array<double, kLanes> last{};
  std::array<double, kLanes> before{};
  for (std::size_t n = count - 1; n > 0; --n) {
    for (std::size_t k = 0; k < kLanes; ++k) {
      const double next = 2.0 * x[k] * last[k] - before[k] + terms[n];
      before[k] = last[k];
      last[k] = next;
    }
  }
  for (std::size_t k = 0; k < kLanes; ++k) sums[k] = x[k] * last[k] - before[k] + terms[0];
}

}  // namespace

const std::array<double, kNodes>& ChebyshevSeries::nodes() { return polynomials()[1]; }

ChebyshevSeries::ChebyshevSeries(std::span<const double> values) {
  POESY_EXPECTS(values.size() == kNodes);
  double largest = 0.0;
  for (std::size_t n = 0; n < kNodes; ++n) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kNodes; ++k) sum += polynomials()[n][k] * values[k];
    terms_.push_back((n == 0 ? 1.0 : 2.0) / kNodes * sum);
    largest = std::max(largest, std::abs(terms_.back()));
    if (n + kTail >= kNodes) tail_ = std::max(tail_, std::abs(terms_.back()));
  }
  const double rounding = std::numeric_limits<double>::epsilon() * largest;
  while (!terms_.empty() && std::abs(terms_.back()) <= rounding) terms_.pop_back();
}

void ChebyshevSeries::evaluate(std::span<const double> x, std::span<double> values) const {
  POESY_EXPECTS(x.size() == values.size());
  if (terms_.empty()) {
    std::ranges::fill(values, 0.0);
    return;
  }
  const std::size_t whole = x.size() / kLanes * kLanes;
  for (std::size_t b = 0; b < whole; b += kLanes) sum_lanes(terms_.data(), terms_.size(), &x[b], &values[b]);
  std::array<double, kLanes> rest{};
  std::array<double, kLanes> sums;
  std::ranges::copy(x.subspan(whole), rest.begin());
  sum_lanes(terms_.data(), terms_.size(), rest.data(), sums.data());
  std::copy_n(sums.begin(), x.size() - whole, values.begin() + static_cast<std::ptrdiff_t>(whole));
}

}  // namespace poesy
