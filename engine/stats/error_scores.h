#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <variant>
#include <vector>

namespace poesy {

// The score of an error by its size t says how its density changes while all its values grow in proportion,
// S(e) = d ln f(e; t) / d ln t. Then dP/dt = E[1_event S] / t for any event (likelihood ratio; Rubinstein 1986, Math.
// Comput. Simul. 28, 365-379). The growth score is that of a step and no slope, f(e; g t) / f(e; t) - 1: its mean over
// the event is what P changes by while the error grows by a factor g.

/// By what factor an error grows where a change of the yield is said.
inline constexpr double kErrorGrowth = 1.1;

/// Means of a score's powers over all machines; its own mean is 0.
struct ScoreMoments {
  double square;  ///< E[S^2]
  double cube;    ///< E[S^3]
};

/// Of a normal error e = t z: z^2 - 1; of one cut off at a fixed +-w: z^2 - 1 + (2 w/t) phi(w/t) / (2 Phi(w/t) - 1).
struct NormalScore {
  double sigma;       ///< t, of the normal before it is cut off, > 0
  double half_width;  ///< w, the largest possible error; infinite for the normal

  double ends() const;  ///< What cutting off adds to z^2 - 1.
  /// The growth score of z = e / t is factor exp(exponent z^2) - 1: for the normal exp(z^2 (1 - 1/g^2) / 2) / g - 1.
  /// @{
  double growth_factor() const;
  static constexpr double growth_exponent() { return 0.5 * (1.0 - 1.0 / (kErrorGrowth * kErrorGrowth)); }
  /// @}
};

/// Of an error of any shape whose size grows about its mean. Where the ends of a range move with it there is no score
/// in the strict sense, so it is taken for events whose probability, given the error, is a polynomial of degree
/// kDegree: with the orthonormal polynomials p_k of the error's distribution and its mean c,
///
///     S(e) = sum over k = 1 .. kDegree of E[p_k'(e) (e - c)] p_k(e)
///
/// For the uniform that is the sum of (2k + 1) P_k over k = 2, 4, 6 (Legendre), for a normal z^2 - 1 whatever the
/// degree from 2 on. What the event's probability has beyond that degree is left out: theory.md has the bias.
/// The growth score has E[p_k(c + g (e - c))] in the place of the first factor.
class PolynomialScore {
 public:
  static constexpr std::size_t kDegree = 6;  ///< Higher ones have more noise than they take off bias (theory.md).

  /// points, weights: [n] in the unit of the error, over which means of polynomials up to degree 3 kDegree are
  /// those of the error. Where n points or fewer are distinct, the degree is below that number. degree: of the score,
  /// at most kDegree. Precondition: weights are positive and sum to 1; at least two distinct points.
  PolynomialScore(std::span<const double> points, std::span<const double> weights, std::size_t degree = kDegree);

  double sigma() const { return sigma_; }                          ///< Standard deviation of the points: t.
  double operator()(double error) const;                           ///< S.
  double growth(double error) const;                               ///< The growth score.
  double parabola(double error) const;                             ///< The part of S up to degree 2.
  ScoreMoments moments() const { return moments_; }                ///< Of S over all errors.
  ScoreMoments growth_moments() const { return growth_moments_; }  ///< Of the growth score.

 private:
  using Factors = std::array<double, kDegree>;

  /// x: [n] points from -1 to 1; centre: their mean.
  void find_polynomials(std::span<const double> x, std::span<const double> weights, double centre, std::size_t degree);
  /// The sum of factors[k] q_(k+1) up to a degree.
  double sum_at(double error, const Factors& factors, std::size_t degree) const;

  double sigma_;
  double middle_;        ///< of the points' range
  double inverse_half_;  ///< of half that range
  // Monic polynomials q_k of (e - middle) / half: q_(k+1) = (x - centre_k) q_k - ratio_k q_(k-1).
  Factors centres_{};
  Factors ratios_{};
  Factors factors_{};  ///< of q_(k+1) in S; 0 beyond the degree that the points have
  Factors grown_{};    ///< likewise in the growth score
  ScoreMoments moments_{};
  ScoreMoments growth_moments_{};
};

/// Of an error of a NormalBlock.
struct BlockScore {
  double sigma;  ///< t, > 0
};

/// Of one error by itself; nothing where it is not known.
using ErrorScore = std::variant<std::monostate, NormalScore, PolynomialScore, BlockScore>;

/// By what a yield is differentiated: t; 0 where the score is not known.
double size_of(const ErrorScore& score);

/// k normal errors e_i = t_i z_i that depend on each other, with correlation R: the score by t_i is
/// z_i (R^-1 z)_i - 1, while R and the sizes of the others stay.
struct NormalBlock {
  std::vector<std::size_t> errors;  ///< [k] positions among all errors; each of them has a BlockScore
  std::vector<double> triangle;     ///< L, [k x k] row-major, L L^T = R

  /// Replaces the normal scores z [k] of a machine by those of the density.
  void replace(std::span<double> z) const;
};

/// What is known of P errors that vary together.
struct ErrorScores {
  std::vector<ErrorScore> each;          ///< [P]
  std::vector<NormalBlock> blocks = {};  ///< an error is in one at the most
};

/// Of the error at this position. In a NormalBlock: 1 + r and 2 + 6 r with r = (R^-1)_ii, because it is a product of
/// two normals of variances 1 and r and covariance 1. Precondition: the error has a PolynomialScore or a BlockScore.
ScoreMoments score_moments(const ErrorScores& scores, std::size_t error);
/// The same of the growth score; for an error of a NormalBlock it is (g - 1) S, because the ratio of the densities may
/// have no variance where errors are strongly correlated.
ScoreMoments growth_moments(const ErrorScores& scores, std::size_t error);

}  // namespace poesy
