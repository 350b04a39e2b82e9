#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace poesy {

// The score of an error with size t is S(e) = d ln f(e; t) / d ln t: how its density changes while all its values grow
// in proportion. For any event with probability P, dP/dt = E[1_event S] / t (likelihood ratio; Rubinstein 1986, Math.
// Comput. Simul. 28, 365-379). The growth score is that of a finite step, f(e; g t) / f(e; t) - 1: its mean over the
// event is the change of P if the error grows by a factor g.

/// The factor by which an error grows where results state a change of the yield.
inline constexpr double kErrorGrowth = 1.1;

/// Means of the powers of a score over all machines; the mean of the score is 0.
struct ScoreMoments {
  double square;  ///< E[S^2]
  double cube;    ///< E[S^3]
};

/// The score of a normal error e = c + t z: z^2 - 1; if it is truncated at c +- w: z^2 - 1 + (2 w/t) phi(w/t) / (2
/// Phi(w/t) - 1).
struct NormalScore {
  double sigma;         ///< t, of the normal before truncation, > 0
  double half_width;    ///< w, the largest possible distance from the mean; infinite for the normal
  double centre = 0.0;  ///< c, the mean, about which the error grows

  double ends() const;  ///< The term that truncation adds to z^2 - 1.
  /// The growth score of z = (e - c) / t is factor exp(exponent z^2) - 1: for the normal exp(z^2 (1 - 1/g^2) / 2) / g
  /// - 1.
  /// @{
  double growth_factor() const;
  static constexpr double growth_exponent() { return 0.5 * (1.0 - 1.0 / (kErrorGrowth * kErrorGrowth)); }
  /// @}
};

/// The score of an error of any shape whose size grows about its mean. If the ends of the range move with the size,
/// there is no score in the strict sense. The score is then valid for events whose probability, given the error, is a
/// polynomial of degree kDegree. With the orthonormal polynomials p_k of the error's distribution and its mean c,
///
///     S(e) = sum over k = 1 .. kDegree of E[p_k'(e) (e - c)] p_k(e)
///
/// For the uniform this is the sum of (2k + 1) P_k over k = 2, 4, 6 (Legendre); for a normal it is z^2 - 1 for every
/// degree from 2 on. The part of the event's probability beyond that degree is left out; theory.md states the bias. The
/// growth score has E[p_k(c + g (e - c))] instead of the first factor.
class PolynomialScore {
 public:
  static constexpr std::size_t kDegree = 6;  ///< A higher degree adds more noise than it removes bias (theory.md).

  /// points, weights: [n] in the unit of the error; weighted means of polynomials up to degree 3 kDegree must equal
  /// those of the error. degree: of the score, at most kDegree; it is lower if there are no more distinct points.
  /// Precondition: weights are positive and sum to 1; at least two distinct points.
  PolynomialScore(std::span<const double> points, std::span<const double> weights, std::size_t degree = kDegree);

  double sigma() const { return sigma_; }                          ///< The standard deviation of the points: t.
  double operator()(double error) const;                           ///< The score S.
  double growth(double error) const;                               ///< The growth score.
  double parabola(double error) const;                             ///< The part of S up to degree 2.
  ScoreMoments moments() const { return moments_; }                ///< The moments of S over all errors.
  ScoreMoments growth_moments() const { return growth_moments_; }  ///< The moments of the growth score.

 private:
  using Factors = std::array<double, kDegree>;

  /// x: [n] points from -1 to 1; centre: their mean.
  void find_polynomials(std::span<const double> x, std::span<const double> weights, double centre, std::size_t degree);
  /// The sum of factors[k] q_(k+1) up to this degree.
  double sum_at(double error, const Factors& factors, std::size_t degree) const;

  double sigma_;
  double middle_;        ///< middle of the points' range
  double inverse_half_;  ///< 1 / half of that range
  // Monic polynomials q_k of (e - middle) / half: q_(k+1) = (x - centre_k) q_k - ratio_k q_(k-1).
  Factors centres_{};
  Factors ratios_{};
  Factors factors_{};  ///< factors of q_(k+1) in S; 0 beyond the degree that the points allow
  Factors grown_{};    ///< the same for the growth score
  ScoreMoments moments_{};
  ScoreMoments growth_moments_{};
};

/// The score of an error of a NormalBlock.
struct BlockScore {
  double sigma;         ///< t, > 0
  double centre = 0.0;  ///< c, the mean
};

/// The score of one error; std::monostate if it is not known.
using ErrorScore = std::variant<std::monostate, NormalScore, PolynomialScore, BlockScore>;

/// The size t by which a yield is differentiated; 0 if the score is not known.
double size_of(const ErrorScore& score);

/// A block of k correlated normal errors e_i = c_i + t_i z_i with correlation R. The score by t_i, for constant R and
/// constant sizes of the others, is z_i (R^-1 z)_i - 1.
struct NormalBlock {
  std::vector<std::size_t> errors;  ///< [k] positions among all errors; each of them has a BlockScore
  std::vector<double> triangle;     ///< L, [k x k] row-major, L L^T = R

  /// Replaces the normal scores z [k] of a machine by z_i (R^-1 z)_i - 1.
  void replace(std::span<double> z) const;
};

/// The scores of P errors that vary together.
struct ErrorScores {
  std::vector<ErrorScore> each;          ///< [P]
  std::vector<NormalBlock> blocks = {};  ///< no error is in two of them
};

/// The moments of the score of the error at this position. In a NormalBlock they are 1 + r and 2 + 6 r with r =
/// (R^-1)_ii, because the score is a product of two normals of variances 1 and r and covariance 1. Precondition: the
/// error has a PolynomialScore or a BlockScore.
ScoreMoments score_moments(const ErrorScores& scores, std::size_t error);
/// The moments of the growth score. For an error of a NormalBlock this is (g - 1) S, because the ratio of the densities
/// may have no variance if errors are strongly correlated.
ScoreMoments growth_moments(const ErrorScores& scores, std::size_t error);

}  // namespace poesy
