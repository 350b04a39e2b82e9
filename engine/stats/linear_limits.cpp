#include "engine/stats/linear_limits.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/linalg/decompositions.h"

namespace poesy {

std::vector<double> ErrorRange::grid() {
  constexpr double kEnd = 0x1p-53;
  std::vector<double> list{kEnd};
  for (std::size_t k = 1; k < kCells; ++k) list.push_back(static_cast<double>(k) / kCells);
  list.push_back(1.0 - kEnd);
  return list;
}

ErrorRange::ErrorRange(std::vector<double> quantiles, double centre)
    : quantiles_(std::move(quantiles)), centre_(centre) {
  POESY_EXPECTS(quantiles_.size() == kCells + 1 && std::ranges::is_sorted(quantiles_));
}

double ErrorRange::below(double e) const {
  if (e <= quantiles_.front()) return 0.0;
  if (e >= quantiles_.back()) return 1.0;
  const auto above = std::ranges::upper_bound(quantiles_, e);
  const double high = *above;
  const double low = *std::prev(above);
  const auto cell = static_cast<double>(above - quantiles_.begin() - 1);
  return (cell + (e - low) / (high - low)) / kCells;
}

LinearLimit with_fewest_rows(const LinearLimit& limit) {
  constexpr double kLeast = 1e-12;  // smallest squared length of a row of offset and slopes, relative to the largest;
                                    // shorter rows are dropped
  using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto rows = static_cast<Eigen::Index>(limit.rows);
  if (rows == 1) return limit;
  Matrix all(rows, 1 + static_cast<Eigen::Index>(limit.slope.size()) / rows);
  all << Eigen::Map<const Eigen::VectorXd>(limit.offset.data(), rows),
      Eigen::Map<const Matrix>(limit.slope.data(), rows, all.cols() - 1);
  const auto [squares, axes] = linalg::eigen_decomposition(all * all.transpose());
  const Matrix turned = axes.transpose() * all;
  LinearLimit found{0, limit.limit, {}, {}};
  for (Eigen::Index k = 0; k < rows; ++k) {
    if (!(squares[k] > kLeast * squares[rows - 1])) continue;
    ++found.rows;
    found.offset.push_back(turned(k, 0));
    for (Eigen::Index p = 1; p < turned.cols(); ++p) found.slope.push_back(turned(k, p));
  }
  return found;
}

LinearLimits::LinearLimits(std::size_t errors, std::vector<LinearLimit> limits)
    : errors_(errors), limits_(std::move(limits)) {
  POESY_EXPECTS(std::ranges::all_of(limits_, [errors](const LinearLimit& limit) {
    return limit.offset.size() == limit.rows && limit.slope.size() == limit.rows * errors;
  }));
}

LinearLimits::Machines LinearLimits::machines(std::span<const double> errors, std::span<const double> reach) const {
  POESY_EXPECTS(reach.size() == errors_ && errors.size() % errors_ == 0);
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const std::size_t block = errors.size() / errors_;
  Machines found{std::vector<std::uint8_t>(block), std::vector<double>(errors.size(), -kFar),
                 std::vector<double>(errors.size(), kFar)};
  for (const LinearLimit& limit : limits_) {
    if (limit.limit.is_magnitude()) {
      add_limit(limit, errors, reach, found);
    } else {
      add_ends(limit, errors, reach, found);
    }
  }
  // So far the ranges are ranges of the change of an error. Adding the error to both ends gives the range of the error
  // itself.
  for (std::size_t k = 0; k < errors.size(); ++k) {
    found.low[k] += errors[k];
    found.high[k] += errors[k];
  }
  return found;
}

std::vector<double> LinearLimits::values_of(const LinearLimit& limit, std::span<const double> errors) const {
  const std::size_t block = errors.size() / errors_;
  std::vector<double> y(limit.rows * block);
  for (std::size_t k = 0; k < limit.rows; ++k) {
    double* const row = &y[k * block];
    std::fill_n(row, block, limit.offset[k]);
    for (std::size_t p = 0; p < errors_; ++p) {
      const double slope = limit.slope[k * errors_ + p];
      const double* const error = &errors[p * block];
      for (std::size_t b = 0; b < block; ++b) row[b] += slope * error[b];
    }
  }
  return y;
}

// Let y be the limited value, a its slope in one error, and d the change of this error: from <= y + a d <= to holds for
// d between (from - y) / a and (to - y) / a.
void LinearLimits::add_ends(const LinearLimit& limit, std::span<const double> errors, std::span<const double> reach,
                            Machines& found) const {
  POESY_EXPECTS(limit.rows == 1);
  const std::size_t block = found.rejected.size();
  const std::vector<double> y = values_of(limit, errors);
  const auto holds = [&](double value) { return limit.limit.holds(value); };
  for (std::size_t b = 0; b < block; ++b) {
    if (!holds(y[b])) found.rejected[b] = 1;
  }
  for (std::size_t p = 0; p < errors_; ++p) {
    if (reach[p] == 0.0) continue;
    const double slope = limit.slope[p];
    double* const low = &found.low[p * block];
    double* const high = &found.high[p * block];
    for (std::size_t b = 0; b < block; ++b) {
      if (slope == 0.0) {
        if (!holds(y[b])) low[b] = std::numeric_limits<double>::infinity();
        continue;
      }
      const double at_from = (limit.limit.from() - y[b]) / slope;
      const double at_to = (limit.limit.to() - y[b]) / slope;
      low[b] = std::max(low[b], std::min(at_from, at_to));
      high[b] = std::min(high[b], std::max(at_from, at_to));
    }
  }
}

// Let y be the limited vector, L the limit on its norm, a its slope in one error, and d the change of this error: |y +
// a d|^2 <= L^2 holds for d between the roots of a^2 d^2 + 2 (y . a) d + y^2 - L^2.
void LinearLimits::add_limit(const LinearLimit& limit, std::span<const double> errors, std::span<const double> reach,
                             Machines& found) const {
  const std::size_t block = found.rejected.size();
  const double most = limit.limit.to() * limit.limit.to();
  const std::vector<double> y = values_of(limit, errors);
  std::vector<double> square(block);
  for (std::size_t k = 0; k < limit.rows; ++k) {
    const double* const row = &y[k * block];
    for (std::size_t b = 0; b < block; ++b) square[b] += row[b] * row[b];
  }
  double largest = 0.0;
  for (std::size_t b = 0; b < block; ++b) {
    largest = std::max(largest, square[b]);
    if (square[b] > most) found.rejected[b] = 1;
  }
  std::vector<double> product(block);
  for (std::size_t p = 0; p < errors_; ++p) {
    if (reach[p] == 0.0) continue;
    double slope2 = 0.0;
    for (std::size_t k = 0; k < limit.rows; ++k) {
      slope2 += limit.slope[k * errors_ + p] * limit.slope[k * errors_ + p];
    }
    if (std::sqrt(largest) + std::sqrt(slope2) * reach[p] <= limit.limit.to())
      continue;  // no machine can reach the limit
    std::ranges::fill(product, 0.0);
    for (std::size_t k = 0; k < limit.rows; ++k) {
      const double slope = limit.slope[k * errors_ + p];
      for (std::size_t b = 0; b < block; ++b) product[b] += slope * y[k * block + b];
    }
    double* const low = &found.low[p * block];
    double* const high = &found.high[p * block];
    for (std::size_t b = 0; b < block; ++b) {
      const double discriminant = product[b] * product[b] - slope2 * (square[b] - most);
      if (!(slope2 > 0.0) || discriminant < 0.0) {
        if (square[b] > most) low[b] = std::numeric_limits<double>::infinity();
        continue;
      }
      const double root = std::sqrt(discriminant);
      low[b] = std::max(low[b], (-product[b] - root) / slope2);
      high[b] = std::min(high[b], (-product[b] + root) / slope2);
    }
  }
}

}  // namespace poesy
