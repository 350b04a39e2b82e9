#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace poesy {

/// The smallest eigenvalue of a symmetric matrix with at least one row.
double smallest_eigenvalue(std::span<const double> matrix);

/// The least eigenvalue that a correlation matrix may have. With a smaller eigenvalue, one error would practically be a
/// linear function of the others.
inline constexpr double kLeastEigenvalue = 1e-9;

/// The Cholesky factor of a matrix: a lower triangle L [k x k], row-major, with L L^T = matrix. Precondition: the
/// matrix is symmetric and positive definite.
std::vector<double> lower_triangle(std::span<const double> matrix);

/// Makes normal scores of k correlated errors: z' = L z, where z are independent standard normals and L L^T = R is the
/// correlation matrix. Each score alone is standard normal. Together with the quantile functions of the errors this is
/// the Gaussian copula (Nelsen 2006, An Introduction to Copulas, ch. 2.5).
class NormalCopula {
 public:
  /// correlation: R [k x k]. Precondition: R is symmetric and positive definite, with ones on the diagonal.
  explicit NormalCopula(std::span<const double> correlation);

  std::size_t size() const { return size_; }                            ///< The number of errors, k.
  std::span<const double> correlation() const { return correlation_; }  ///< The correlation matrix R [k x k].

  /// Replaces independent standard normals by scores with the correlation R. rows: one for each error, with a score for
  /// each sample. Samples stay independent of each other. The result has the same bits on every instruction set.
  /// Precondition: k rows of equal length.
  void correlate(std::span<const std::span<double>> rows) const;

 private:
  std::size_t size_;
  std::vector<double> correlation_;
  std::vector<double> triangle_;  ///< [k x k] Cholesky factor L of R
};

/// Computes normal scores of some errors of a copula (d, drawn), given the scores of the other errors (s, shared). The
/// conditional distribution is normal with mean R_ds R_ss^-1 z_s and covariance R_dd - R_ds R_ss^-1 R_sd.
class ConditionalScores {
 public:
  /// shared, drawn: indices of errors in the copula; each error is in exactly one of the two lists.
  ConditionalScores(const NormalCopula& copula, std::span<const std::size_t> shared,
                    std::span<const std::size_t> drawn);

  /// Fills the rows of the drawn errors with a score for each sample. shared: scores of the shared errors; normals:
  /// independent standard normals for the drawn ones. Without shared errors the result is that of
  /// NormalCopula::correlate(). Precondition: rows have equal length and do not overlap.
  void fill(std::span<const std::span<const double>> shared, std::span<const std::span<const double>> normals,
            std::span<const std::span<double>> drawn) const;

 private:
  std::vector<double> slopes_;    ///< [d x s] R_ds R_ss^-1
  std::vector<double> triangle_;  ///< [d x d] Cholesky factor of the conditional covariance
};

}  // namespace poesy
