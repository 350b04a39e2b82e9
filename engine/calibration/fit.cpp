#include "engine/calibration/fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/base/contract.h"

namespace poesy::calibration {
namespace {

constexpr int kMostSteps = 30;
constexpr int kMostHalvings = 20;
constexpr double kShortest = 1e-9;  // the iteration ends if every scaled number changes by less than this in a step
// The iteration also ends if a step changes all values together by less than this share of their noise. Such a step
// moves each estimate by at most this share of its standard deviation.
constexpr double kShortestInNoise = 1e-8;
// Used instead of kShortestInNoise if derivatives come from an expansion, which is not exact.
constexpr double kShortestByExpansion = 1e-5;
constexpr double kRounding = 1e-15;  // m or rad: rounding error of an exact solve
// A sum of squares that grows by less than this share counts as not growing.
constexpr double kRoundingOfSum = 1e-10;
constexpr double kGrowthByExpansion = 1e-6;  // used instead of kRoundingOfSum with an expansion
constexpr double kRankOfFrame = 1e-9;        // singular values and pivots below this share of the largest count as 0
// m, rad or a slope: step of each number of phi (see Derivatives) for finite differences
constexpr double kStepOfPlace = 1e-4;
// Step of a fitted number for finite differences, as a share of the machine's reach or in rad. The truncation error
// (fourth power of the step) is below 1e-13, and the rounding error (that of a solve divided by the step) is about
// 2e-12.
constexpr double kStep = 5e-4;

/// The points of a central difference of fourth order, in steps, and their weights.
/// @{
constexpr std::array<double, 4> kPoints{-2.0, -1.0, 1.0, 2.0};
constexpr std::array<double, 4> kWeights{1.0 / 12.0, -8.0 / 12.0, 8.0 / 12.0, -1.0 / 12.0};
/// @}

Matrix with_rows(const Matrix& top, const Matrix& bottom) {
  Matrix all(top.rows() + bottom.rows(), top.cols());
  all << top, bottom;
  return all;
}

Vector joined(const Vector& top, const Vector& bottom) {
  Vector all(top.size() + bottom.size());
  all << top, bottom;
  return all;
}

/// Divides each row by the standard deviation of its value.
Matrix over(const Matrix& rows, const Vector& sd) { return sd.cwiseInverse().asDiagonal() * rows; }

/// The Gauss-Newton step of theta, the fitted numbers of the errors, divided by their scale. residual, prior_residual:
/// see Point.
Vector scaled_step(const ScaledFit& at, const Vector& residual, const Matrix& prior, const Vector& prior_residual) {
  if (prior.rows() == 0) {
    const auto r = static_cast<Eigen::Index>(at.rank);
    const Matrix V = at.V.leftCols(r);
    const Vector squares = at.singular_values.head(r).array().square();
    return V * (V.transpose() * (at.reduced.transpose() * residual)).cwiseQuotient(squares);
  }
  const Vector of_measurements = residual - at.frame * (at.frame.transpose() * residual);
  return linalg::least_squares(with_rows(at.reduced, prior), Matrix(joined(of_measurements, prior_residual)));
}

/// A point of the iteration: estimates theta and phi (see Derivatives) and their residuals.
struct Point {
  Vector theta;
  Vector phi;
  std::vector<Displacement> displacements = {};  ///< displacements at the poses of the measurement
  Vector residual = {};                          ///< residuals of the measured values divided by their noise
  Vector prior_residual = {};                    ///< centre - root theta (see Prior)

  double sum() const { return residual.squaredNorm() + prior_residual.squaredNorm(); }
};

/// The iteration of a fit.
class Path {
 public:
  explicit Path(const FitProblem& problem)
      : problem_(&problem),
        function_(problem.measurement, problem.directions),
        measured_(problem.measurement.measured()) {
    const Vector none = Vector::Zero(problem.directions.F.cols());
    auto displacements = problem.expansion == nullptr
                             ? problem.measurement.displacements(Vector(problem.directions.F * none))
                             : std::optional(problem.expansion->without_errors());
    has_begun_ = displacements.has_value();
    if (has_begun_) here_ = point(none, problem.measurement.start(), *std::move(displacements));
  }

  bool has_begun() const { return has_begun_; }
  const Point& here() const { return here_; }
  std::optional<Derivatives> derivatives() const {
    if (problem_->expansion == nullptr) return function_.derivatives(here_.theta, here_.phi);
    return problem_->expansion->derivatives(problem_->measurement, here_.theta, here_.displacements, here_.phi);
  }

  /// Makes a step, or a half, a quarter, ... of it, with which the sum of squares does not grow. Returns true if that
  /// step was so short that the fit has converged. Returns none if there is no such step.
  std::optional<bool> step(const Derivatives& derivatives) {
    const Vector& scale = problem_->directions.scale;
    const ScaledFit at = scaled_fit(derivatives, problem_->sd, scale);
    const Matrix prior = problem_->prior.root * scale.asDiagonal();
    const Vector of_theta = scaled_step(at, here_.residual, prior, here_.prior_residual);
    const Vector of_phi = places_step(derivatives, here_.residual - at.A * of_theta);
    const double growth = problem_->expansion == nullptr ? kRoundingOfSum : kGrowthByExpansion;
    const double shortest = problem_->expansion == nullptr ? kShortestInNoise : kShortestByExpansion;
    for (int n = 0; n <= kMostHalvings; ++n) {
      const double share = std::ldexp(1.0, -n);
      auto there = point(here_.theta + share * scale.cwiseProduct(of_theta), here_.phi + share * of_phi);
      if (!there || !(there->sum() <= here_.sum() * (1.0 + growth) + 100.0 * least_sum())) continue;
      here_ = *std::move(there);
      return share * of_theta.cwiseAbs().maxCoeff() < kShortest ||
             share * (at.reduced * of_theta).norm() < std::max(shortest, 10.0 * std::sqrt(least_sum()));
    }
    return std::nullopt;
  }

 private:
  /// The sum of squares (see Point::sum) that rounding alone may cause.
  double least_sum() const { return (kRounding * problem_->sd.cwiseInverse()).squaredNorm(); }

  std::optional<Point> point(const Vector& theta, const Vector& phi) const {
    auto displacements = problem_->measurement.displacements(Vector(problem_->directions.F * theta));
    if (!displacements) return std::nullopt;
    return point(theta, phi, *std::move(displacements));
  }

  Point point(Vector theta, Vector phi, std::vector<Displacement> displacements) const {
    Point found{std::move(theta), std::move(phi), std::move(displacements)};
    found.residual =
        (measured_ - problem_->measurement.values_of(found.displacements, found.phi)).cwiseQuotient(problem_->sd);
    found.prior_residual = problem_->prior.root.rows() == 0
                               ? Vector()
                               : Vector(problem_->prior.centre - problem_->prior.root * found.theta);
    return found;
  }

  /// The step of phi, the numbers of the measuring device's frame and of the target. left: residuals after the step of
  /// theta, the fitted numbers of the errors.
  Vector places_step(const Derivatives& derivatives, const Vector& left) const {
    if (derivatives.places.cols() == 0) return Vector(0);
    const Matrix columns = over(derivatives.places, problem_->sd);
    const Vector norms = columns.colwise().norm().cwiseMax(1e-300);
    const Matrix unit = columns * norms.cwiseInverse().asDiagonal();
    return linalg::least_squares(unit, left, kRankOfFrame).cwiseQuotient(norms);
  }

  const FitProblem* problem_;
  FittedMeasurement function_;
  Vector measured_;
  Point here_;
  bool has_begun_ = false;
};

}  // namespace

Vector difference_steps(const ExactMachine& machine, const Matrix& F) {
  const std::vector<Factor>& factors = machine.model().description().factors;
  Vector steps = Vector::Constant(F.cols(), 1e300);
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const bool is_length = factors[static_cast<std::size_t>(f)].dimension == Dimension::length;
    const double most = kStep * (is_length ? machine.reach() : 1.0);
    for (Eigen::Index j = 0; j < F.cols(); ++j) {
      if (F(f, j) != 0.0) steps(j) = std::min(steps(j), most / std::abs(F(f, j)));
    }
  }
  return steps;
}

std::optional<Vector> FittedMeasurement::values(const Vector& theta, const Vector& phi) const {
  const auto displacements = measurement_->displacements(Vector(directions_->F * theta));
  if (!displacements) return std::nullopt;
  return measurement_->values_of(*displacements, phi);
}

std::optional<Derivatives> FittedMeasurement::derivatives(const Vector& theta, const Vector& phi) const {
  const Eigen::Index k = directions_->F.cols();
  const auto points = static_cast<Eigen::Index>(kPoints.size());
  Matrix tried = (directions_->F * theta).replicate(1, k * points + 1);
  const Vector& steps = directions_->step;
  for (Eigen::Index j = 0; j < k; ++j) {
    for (Eigen::Index n = 0; n < points; ++n) {
      tried.col(j * points + n) += kPoints[static_cast<std::size_t>(n)] * steps(j) * directions_->F.col(j);
    }
  }
  const auto displacements = measurement_->displacements(tried);
  if (!displacements) return std::nullopt;
  const auto m = static_cast<Eigen::Index>(measurement_->size());
  Derivatives found{Matrix::Zero(m, k), Matrix::Zero(m, phi.size())};
  for (Eigen::Index j = 0; j < k; ++j) {
    for (Eigen::Index n = 0; n < points; ++n) {
      const Vector values = measurement_->values_of((*displacements)[static_cast<std::size_t>(j * points + n)], phi);
      found.errors.col(j) += kWeights[static_cast<std::size_t>(n)] / steps(j) * values;
    }
  }
  for (Eigen::Index j = 0; j < phi.size(); ++j) {
    for (std::size_t n = 0; n < kPoints.size(); ++n) {
      Vector place = phi;
      place(j) += kPoints[n] * kStepOfPlace;
      found.places.col(j) += kWeights[n] / kStepOfPlace * measurement_->values_of(displacements->back(), place);
    }
  }
  return found;
}

ScaledFit scaled_fit(const Derivatives& derivatives, const Vector& sd, const Vector& scale) {
  ScaledFit found;
  found.A = over(derivatives.errors, sd) * scale.asDiagonal();
  const Matrix places = over(derivatives.places, sd);
  found.frame = Matrix(places.rows(), 0);
  if (places.cols() > 0) {
    const Matrix unit = places * places.colwise().norm().cwiseMax(1e-300).cwiseInverse().asDiagonal();
    found.frame = linalg::range_and_complement(unit, linalg::rank(unit, kRankOfFrame)).range;
  }
  found.reduced = found.A - found.frame * (found.frame.transpose() * found.A);
  auto svd = linalg::right_singular_vectors(found.reduced);
  found.singular_values = std::move(svd.values);
  found.V = std::move(svd.V);
  const double least = found.singular_values.size() == 0 ? 0.0 : kUnseen * found.singular_values(0);
  found.rank = static_cast<std::size_t>((found.singular_values.array() > least).count());
  return found;
}

FitResult fit(const FitProblem& problem) {
  FitResult result;
  Path path(problem);
  result.solved = path.has_begun();
  while (result.solved && !result.converged && result.steps < kMostSteps) {
    const auto derivatives = path.derivatives();
    const auto is_last = derivatives ? path.step(*derivatives) : std::nullopt;
    if (!is_last) break;
    result.converged = *is_last;
    ++result.steps;
  }
  auto derivatives = result.solved ? path.derivatives() : std::nullopt;
  result.solved = derivatives.has_value();
  if (!result.solved) return result;
  result.derivatives = *std::move(derivatives);
  result.scaled = scaled_fit(result.derivatives, problem.sd, problem.directions.scale);
  result.theta = path.here().theta;
  result.phi = path.here().phi;
  result.residual = path.here().residual.cwiseProduct(problem.sd);
  result.noise_sum = path.here().residual.squaredNorm();
  result.sum = path.here().sum();
  return result;
}

}  // namespace poesy::calibration
