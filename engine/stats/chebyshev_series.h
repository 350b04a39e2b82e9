#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace poesy {

/// A polynomial on [-1, 1] as a series of Chebyshev polynomials, c_0 T_0(x) + c_1 T_1(x) + ... (Trefethen 2013,
/// Approximation Theory and Approximation Practice, chapters 3 and 4).
class ChebyshevSeries {
 public:
  static constexpr std::size_t kNodes = 16;  ///< Number of nodes, which is also the largest number of terms.

  /// The nodes, which are the zeros of T_16: cos(pi (k + 1/2) / 16). None of them is 0.
  static const std::array<double, kNodes>& nodes();

  ChebyshevSeries() = default;  ///< The series without terms, which is 0.
  /// The polynomial through these values [kNodes] at the nodes. The last terms are left out if their coefficients are
  /// at most the rounding error (machine epsilon) of the largest coefficient.
  explicit ChebyshevSeries(std::span<const double> values);

  /// The largest magnitude of the last three coefficients, before terms were left out. It is small if the series has
  /// converged.
  double tail() const { return tail_; }
  /// Computes the values at the points x, which are in [-1, 1]. Each value depends only on its own point.
  void evaluate(std::span<const double> x, std::span<double> values) const;

 private:
  std::vector<double> terms_;
  double tail_ = 0.0;
};

}  // namespace poesy
