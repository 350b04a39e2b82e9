#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace poesy {

/// The smallest eigenvalue of a symmetric matrix [k x k]. Precondition: k > 0.
double smallest_eigenvalue(std::span<const double> matrix);

/// The least eigenvalue of a correlation. With a smaller one it is refused, because errors would follow from each
/// other.
inline constexpr double kLeastEigenvalue = 1e-9;

/// A lower triangle L [k x k], row-major, with L L^T = matrix (Cholesky). Precondition: symmetric, positive definite.
std::vector<double> lower_triangle(std::span<const double> matrix);

/// Normal scores z of k correlated errors, each standard normal alone: z' = L z with L L^T = R, the correlation.
/// Together with the quantile functions of the errors this is the Gaussian copula (Nelsen 2006, An Introduction to
/// Copulas, ch. 2.5).
class NormalCopula {
 public:
  /// correlation: R, [k x k]. Precondition: symmetric, ones on its diagonal, positive definite.
  explicit NormalCopula(std::span<const double> correlation);

  std::size_t size() const { return size_; }                            ///< The number of errors, k.
  std::span<const double> correlation() const { return correlation_; }  ///< R, [k x k].

  /// Replaces independent standard normals, a row [B] for each error, by scores with the correlation R. Columns are
  /// independent of each other. The same bits on every instruction set. Precondition: k rows of equal length.
  void correlate(std::span<const std::span<double>> rows) const;

 private:
  std::size_t size_;
  std::vector<double> correlation_;
  std::vector<double> triangle_;  ///< [k x k] L
};

/// Draws normal scores of some errors of a copula conditional on those of the others. The conditional distribution is
/// normal with mean R_ds R_ss^-1 z_s and covariance R_dd - R_ds R_ss^-1 R_sd, where s are the shared and d the drawn
/// errors.
class ConditionalScores {
 public:
  /// shared, drawn: positions among the copula's errors; each error is in exactly one of the two.
  ConditionalScores(const NormalCopula& copula, std::span<const std::size_t> shared,
                    std::span<const std::size_t> drawn);

  /// Fills the rows [B] of the drawn errors. shared: scores of the shared errors; normals: independent standard normals
  /// for the drawn ones. Without shared errors it equals NormalCopula::correlate(). Precondition: rows have equal
  /// length and do not overlap.
  void fill(std::span<const std::span<const double>> shared, std::span<const std::span<const double>> normals,
            std::span<const std::span<double>> drawn) const;

 private:
  std::vector<double> slopes_;    ///< [d x s] R_ds R_ss^-1
  std::vector<double> triangle_;  ///< [d x d] triangle of the conditional covariance
};

}  // namespace poesy
