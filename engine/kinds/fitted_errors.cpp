#include "engine/kinds/fitted_errors.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace poesy {
namespace {

using calibration::Matrix;
using calibration::Vector;

constexpr double kUsualLength = 1e-3;  // m: scale of a fitted length that contains an error without a tolerance

Eigen::Index position(std::size_t at) { return static_cast<Eigen::Index>(at); }

Matrix covariance_of(const ErrorModel& errors, const std::vector<FactorIndex>& factors) {
  const auto sd = [&](std::size_t n) { return errors.by_factor[factors[n].value].standard_deviation(); };
  Matrix covariance = Matrix::Zero(position(factors.size()), position(factors.size()));
  for (std::size_t n = 0; n < factors.size(); ++n) covariance(position(n), position(n)) = sd(n) * sd(n);
  for (const CorrelatedErrors& block : errors.correlated) {
    const Eigen::Map<const Matrix> correlation(block.correlation.data(), position(block.factors.size()),
                                               position(block.factors.size()));  // a symmetric matrix
    for (std::size_t i = 0; i < factors.size(); ++i) {
      for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto a = std::ranges::find(block.factors, factors[i]);
        const auto b = std::ranges::find(block.factors, factors[j]);
        if (i == j || a == block.factors.end() || b == block.factors.end()) continue;
        covariance(position(i), position(j)) =
            correlation(a - block.factors.begin(), b - block.factors.begin()) * sd(i) * sd(j);
      }
    }
  }
  return covariance;
}

/// The rows of the matrix F (FittedDirections) for these errors.
Matrix rows_of(const Matrix& F, const std::vector<FactorIndex>& factors) {
  Matrix rows(position(factors.size()), F.cols());
  for (std::size_t n = 0; n < factors.size(); ++n) rows.row(position(n)) = F.row(position(factors[n].value));
  return rows;
}

/// [errors x fitted errors] The matrix F (FittedDirections): column j has the weights of the errors in fitted error j.
/// For a fitted error that is a single error, one weight is 1 and the others are 0.
Matrix columns_of(std::span<const FittedErrors> fit, std::size_t factors) {
  Matrix F = Matrix::Zero(position(factors), position(fit.size()));
  for (std::size_t j = 0; j < fit.size(); ++j) {
    for (std::size_t n = 0; n < fit[j].factors.size(); ++n) {
      F(position(fit[j].factors[n].value), position(j)) = fit[j].weights[n];
    }
  }
  return F;
}

bool has_tolerance(const CalibrationTable& table, FactorIndex factor) {
  return std::ranges::binary_search(table.with_tolerance, factor);
}

/// The errors that have a tolerance and occur in a fitted error, ascending.
std::vector<FactorIndex> fitted_with_tolerance(const CalibrationTable& table) {
  std::set<FactorIndex> list;
  for (const FittedErrors& fitted : table.fit) {
    for (const FactorIndex factor : fitted.factors) {
      if (has_tolerance(table, factor)) list.insert(factor);
    }
  }
  return {list.begin(), list.end()};
}

/// The matrix F (FittedDirections) of these fitted errors, with the scales, difference steps and prior of its columns.
/// known: mean and covariance from the tolerances, from which scales and prior are computed.
FittedColumns made_columns(std::span<const FittedErrors> fit, const CalibrationTable& table,
                           const ToleranceKnowledge& known, const calibration::ExactMachine& machine) {
  FittedColumns columns;
  columns.has_tolerances = true;
  Matrix F = columns_of(fit, machine.errors());
  const Matrix root = known.factors.empty() ? Matrix(0, F.cols()) : Matrix(known.root * rows_of(F, known.factors));
  Vector scale(F.cols());
  for (std::size_t j = 0; j < fit.size(); ++j) {
    const bool is_known =
        std::ranges::all_of(fit[j].factors, [&](FactorIndex factor) { return has_tolerance(table, factor); });
    columns.has_tolerances = columns.has_tolerances && is_known;
    const double usual = fit[j].dimension == Dimension::length ? kUsualLength : kUsualLength / machine.reach();
    scale(position(j)) = is_known ? 1.0 / root.col(position(j)).norm() : usual;
  }
  const Vector step = calibration::difference_steps(machine, F);
  columns.directions = {std::move(F), std::move(scale), step};
  columns.prior = {root, known.factors.empty() ? Vector(0) : Vector(known.root * known.mean)};
  return columns;
}

}  // namespace

ToleranceKnowledge tolerance_knowledge(const ErrorModel& errors, std::vector<FactorIndex> factors) {
  ToleranceKnowledge known;
  known.mean = Vector(position(factors.size()));
  for (std::size_t n = 0; n < factors.size(); ++n) {
    known.mean(position(n)) = errors.by_factor[factors[n].value].mean();
  }
  if (!factors.empty()) {
    known.root = linalg::inverse(linalg::cholesky_root(covariance_of(errors, factors))).transpose();
  }
  known.factors = std::move(factors);
  return known;
}

FittedColumns fitted_columns(const Study& study, const CalibrationTable& table,
                             const calibration::ExactMachine& machine) {
  const ToleranceKnowledge known = tolerance_knowledge(study.errors, fitted_with_tolerance(table));
  FittedColumns columns = made_columns(table.fit, table, known, machine);
  if (table.prior == PriorKnowledge::none) columns.prior = {};
  return columns;
}

FittedColumns all_columns(const Study& study, const CalibrationTable& table, const calibration::ExactMachine& machine) {
  const std::vector<Factor>& factors = study.model().factors;
  std::vector<FittedErrors> all;
  for (const FactorIndex factor : table.with_tolerance) {
    all.push_back({factors[factor.value].name, {factor}, {1.0}, factors[factor.value].dimension, {}});
  }
  for (const FittedErrors& fitted : table.fit) {
    FittedErrors rest{fitted.name, {}, {}, fitted.dimension, {}};
    for (std::size_t n = 0; n < fitted.factors.size(); ++n) {
      if (has_tolerance(table, fitted.factors[n])) continue;
      rest.factors.push_back(fitted.factors[n]);
      rest.weights.push_back(fitted.weights[n]);
    }
    if (!rest.factors.empty()) all.push_back(std::move(rest));
  }
  return made_columns(all, table, tolerance_knowledge(study.errors, table.with_tolerance), machine);
}

}  // namespace poesy
