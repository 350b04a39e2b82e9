#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace poesy {

// The score of an error e with density f and size t is S(e) = d ln f(e; t) / d ln t. The score states how the density
// changes while all values of the error grow in proportion. For any event with probability P, dP/dt = E[1_event S] / t
// (likelihood ratio; Rubinstein 1986, Math. Comput. Simul. 28, 365-379). The growth score G(e) = f(e; g t) / f(e; t) -
// 1 is the counterpart for a finite step: E[1_event G] is the change of P if the error grows by a factor g.

/// Results state the change of the yield if one error grows by this factor g.
inline constexpr double kErrorGrowth = 1.1;

/// Means of powers of a score S over all machines. The mean of S itself is 0.
struct ScoreMoments {
  double square;  ///< E[S^2]
  double cube;    ///< E[S^3]
};

/// The score of a normal error e = c + t z with mean c, standard deviation t and a standard normal z is z^2 - 1. If the
/// error is truncated at c +- w, the score is z^2 - 1 + (2 w/t) phi(w/t) / (2 Phi(w/t) - 1), where phi and Phi are the
/// density and the distribution function of z.
struct NormalScore {
  double sigma;         ///< size t: standard deviation before truncation, > 0
  double half_width;    ///< largest possible distance w from the mean; infinite if the normal is not truncated
  double centre = 0.0;  ///< mean c, about which the error grows

  double ends() const;  ///< The term (2 w/t) phi(w/t) / (2 Phi(w/t) - 1) of a truncated normal; 0 without truncation.
  /// The growth score at z = (e - c) / t is growth_factor() exp(growth_exponent() z^2) - 1. For a normal that is not
  /// truncated it is exp(z^2 (1 - 1/g^2) / 2) / g - 1, with g = kErrorGrowth.
  /// @{
  double growth_factor() const;
  double growth_square() const;  ///< The mean square of the growth score over all machines.
  static constexpr double growth_exponent() { return 0.5 * (1.0 - 1.0 / (kErrorGrowth * kErrorGrowth)); }
  /// @}
};

/// The score of an error of any distribution, for a size that grows about the mean of the error. This score replaces d
/// ln f / d ln t, which does not exist if the ends of the error's range move with the size. The score is valid for an
/// event if the probability of the event, given the error, is a polynomial of degree kDegree in the error. With the
/// orthonormal polynomials p_k of the error's distribution and its mean c,
///
///     S(e) = sum over k = 1 .. kDegree of E[p_k'(e) (e - c)] p_k(e)
///
/// For the uniform this is the sum of (2k + 1) P_k over k = 2, 4, 6, with the Legendre polynomials P_k. For a normal it
/// is z^2 - 1 for every degree from 2 on. The part of the event's probability beyond the degree is left out; theory.md
/// states the bias. The growth score has the factor E[p_k(c + g (e - c))] instead of E[p_k'(e) (e - c)].
class PolynomialScore {
 public:
  static constexpr std::size_t kDegree = 6;  ///< With a higher degree, added noise outweighs removed bias (theory.md).

  /// points, weights: [points] in the unit of the error; weighted means of polynomials up to degree 3 kDegree must
  /// equal those of the error. degree: the degree of the score, at most kDegree. The degree is lowered if there are too
  /// few distinct points. Precondition: weights are positive and sum to 1; at least two distinct points.
  PolynomialScore(std::span<const double> points, std::span<const double> weights, std::size_t degree = kDegree);

  double sigma() const { return sigma_; }  ///< The size of the error: the standard deviation of the points.
  double operator()(double error) const;   ///< The score S(error).
  double growth(double error) const;       ///< The growth score: the counterpart of S for growth by kErrorGrowth.
  double parabola(double error) const;     ///< The part of the score S(error) up to degree 2.
  ScoreMoments moments() const { return moments_; }  ///< The moments of the score over the distribution of the error.
  ScoreMoments growth_moments() const { return growth_moments_; }  ///< The moments of the growth score.

 private:
  using Factors = std::array<double, kDegree>;

  /// Finds the orthogonal polynomials of the points, and the factors of both scores. x: [points] the points, scaled to
  /// -1 to 1; centre: the weighted mean of x.
  void find_polynomials(std::span<const double> x, std::span<const double> weights, double centre, std::size_t degree);
  /// The sum over k of factors[k] q_(k+1) at an error, with the monic orthogonal polynomials q up to this degree.
  double sum_at(double error, const Factors& factors, std::size_t degree) const;

  double sigma_;
  double middle_;        ///< middle of the points' range
  double inverse_half_;  ///< 1 / half of the points' range
  // The recursion of monic polynomials q_k of x = (e - middle) / half: q_(k+1) = (x - centre_k) q_k - ratio_k q_(k-1).
  Factors centres_{};
  Factors ratios_{};
  Factors factors_{};  ///< factors of q_(k+1) in S; 0 beyond the degree that the points allow
  Factors grown_{};    ///< factors of q_(k+1) in the growth score
  ScoreMoments moments_{};
  ScoreMoments growth_moments_{};
};

/// The data of an error in a NormalBlock, which computes the score of this error.
struct BlockScore {
  double sigma;         ///< standard deviation t of the error, > 0
  double centre = 0.0;  ///< mean c of the error
};

/// The score of one error; std::monostate if it is not known.
using ErrorScore = std::variant<std::monostate, NormalScore, PolynomialScore, BlockScore>;

/// The size t of the error that has this score: the member `sigma` of the score; 0 if the score is not known.
double size_of(const ErrorScore& score);

/// A block of k correlated normal errors e_i = c_i + t_i z_i, where the z_i are standard normals with the correlation
/// matrix R. The score of error i (for constant R and constant sizes of the other errors) is z_i (R^-1 z)_i - 1.
struct NormalBlock {
  std::vector<std::size_t> errors;  ///< [k] indices among all errors; each of these errors has a BlockScore
  std::vector<double> triangle;     ///< [k x k] Cholesky factor L with L L^T = R, row-major

  /// Replaces the standard normals z [k] of a machine by the scores z_i (R^-1 z)_i - 1.
  void replace(std::span<double> z) const;
};

/// The scores of errors that vary together.
struct ErrorScores {
  std::vector<ErrorScore> each;          ///< [errors] score of each error
  std::vector<NormalBlock> blocks = {};  ///< blocks of correlated errors; no error is in two blocks
};

/// The moments of the score of one error, given by its index. For an error i of a NormalBlock they are E[S^2] = 1 + r
/// and E[S^3] = 2 + 6 r with r = (R^-1)_ii, because S + 1 is a product of two normals with variances 1 and r and
/// covariance 1. Precondition: the error has a PolynomialScore or a BlockScore.
ScoreMoments score_moments(const ErrorScores& scores, std::size_t error);
/// The moments of the growth score of one error. For an error of a NormalBlock the growth score is approximated by (g -
/// 1) S, with the score S and g = kErrorGrowth, because the ratio of the densities may have no variance if errors are
/// strongly correlated. Precondition: the error has a PolynomialScore or a BlockScore.
ScoreMoments growth_moments(const ErrorScores& scores, std::size_t error);
/// The mean square of the growth score of one error over all machines; NaN if the score is not known.
double growth_square(const ErrorScores& scores, std::size_t error);

}  // namespace poesy
