#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace poesy {

/// The smallest eigenvalue of a symmetric matrix [k x k]. Precondition: k > 0.
double smallest_eigenvalue(std::span<const double> matrix);

/// A correlation is refused whose smallest eigenvalue is below this: its errors follow from each other.
inline constexpr double kLeastEigenvalue = 1e-9;

/// A lower triangle L [k x k], row-major, with L L^T = matrix (Cholesky). Precondition: symmetric, positive definite.
std::vector<double> lower_triangle(std::span<const double> matrix);

/// Normal scores z of k errors that depend on each other, each standard normal by itself: z' = L z with L L^T = R, the
/// correlation. With the quantile functions of the errors behind it this is the Gaussian copula (Nelsen 2006, An
/// Introduction to Copulas, ch. 2.5).
class NormalCopula {
 public:
  /// correlation: R, [k x k]. Precondition: symmetric, ones on its diagonal, positive definite.
  explicit NormalCopula(std::span<const double> correlation);

  std::size_t size() const { return size_; }                            ///< k.
  std::span<const double> correlation() const { return correlation_; }  ///< R, [k x k].

  /// Replaces independent standard normals, a row [B] for each error, by scores with the correlation R. A column
  /// depends on itself alone. The same bits on every instruction set. Precondition: k rows, all of one length.
  void correlate(std::span<const std::span<double>> rows) const;

 private:
  std::size_t size_;
  std::vector<double> correlation_;
  std::vector<double> triangle_;  ///< L
};

/// The normal scores of some errors of a copula, given those of its others: independent draws of the conditional
/// distribution, which is normal with mean R_ds R_ss^-1 z_s and covariance R_dd - R_ds R_ss^-1 R_sd, where s are the
/// shared and d the drawn ones.
class ConditionalScores {
 public:
  /// shared, drawn: positions among the copula's errors; each is in one of the two.
  ConditionalScores(const NormalCopula& copula, std::span<const std::size_t> shared,
                    std::span<const std::size_t> drawn);

  /// Fills the rows [B] of the drawn errors. shared: scores of the shared errors; normals: independent standard normals
  /// for the drawn ones. With nothing shared this is NormalCopula::correlate. Precondition: rows of one length that do
  /// not overlap.
  void fill(std::span<const std::span<const double>> shared, std::span<const std::span<const double>> normals,
            std::span<const std::span<double>> drawn) const;

 private:
  std::vector<double> slopes_;    ///< R_ds R_ss^-1, [d x s]
  std::vector<double> triangle_;  ///< of the conditional covariance, [d x d]
};

}  // namespace poesy
