#include "engine/stats/linear_fit.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/linalg/decompositions.h"

namespace poesy {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

template <class List>
void add_each(List& sums, const List& other) {
  for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += other[k];
}

}  // namespace

LinearFit joined(std::span<const LinearFit> fits) {
  POESY_EXPECTS(!fits.empty());
  LinearFit all = fits.front();
  const auto append = [](std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  for (const LinearFit& fit : fits.subspan(1)) {
    POESY_EXPECTS(fit.errors == all.errors);
    append(all.offset, fit.offset);
    append(all.slope, fit.slope);
    append(all.slope_variance, fit.slope_variance);
    append(all.rest, fit.rest);
  }
  return all;
}

LinearFitSums::LinearFitSums(std::size_t errors, std::size_t rows)
    : errors_(errors), x_(errors), xx_(errors * errors), shift_(rows), y_(rows), yy_(rows), xy_(rows * errors) {
  POESY_EXPECTS(errors > 0 && rows > 0);
}

void LinearFitSums::add(std::span<const double> errors, std::span<const double> numbers,
                        std::span<const std::uint8_t> counts) {
  const std::size_t block = counts.size();
  POESY_EXPECTS(errors.size() == errors_ * block && numbers.size() == shift_.size() * block);
  std::vector<double> x(errors_);
  std::vector<double> y(shift_.size());
  for (std::size_t b = 0; b < block; ++b) {
    if (counts[b] == 0) continue;
    for (std::size_t p = 0; p < errors_; ++p) x[p] = errors[p * block + b];
    for (std::size_t k = 0; k < y.size(); ++k) y[k] = numbers[k * block + b];
    add_machine(x, y);
  }
}

void LinearFitSums::add_machine(std::span<const double> x, std::span<const double> numbers) {
  if (machines_ == 0) shift_.assign(numbers.begin(), numbers.end());
  ++machines_;
  for (std::size_t p = 0; p < errors_; ++p) {
    x_[p] += x[p];
    double* const row = &xx_[p * errors_];
    for (std::size_t q = 0; q <= p; ++q) row[q] += x[p] * x[q];
  }
  for (std::size_t k = 0; k < shift_.size(); ++k) {
    const double off = numbers[k] - shift_[k];
    y_[k] += off;
    yy_[k] += off * off;
    double* const row = &xy_[k * errors_];
    for (std::size_t p = 0; p < errors_; ++p) row[p] += off * x[p];
  }
}

/// Changes the sums of one fitted number to those for another shift.
void LinearFitSums::move_shift(std::size_t row, double shift) {
  const auto count = static_cast<double>(machines_);
  const double by = shift_[row] - shift;
  yy_[row] += by * (2.0 * y_[row] + count * by);
  y_[row] += count * by;
  for (std::size_t p = 0; p < errors_; ++p) xy_[row * errors_ + p] += by * x_[p];
  shift_[row] = shift;
}

void LinearFitSums::merge(const LinearFitSums& later) {
  POESY_EXPECTS(later.errors_ == errors_ && later.shift_.size() == shift_.size());
  if (later.machines_ == 0) return;
  if (machines_ == 0) {
    *this = later;
    return;
  }
  LinearFitSums other = later;
  for (std::size_t k = 0; k < shift_.size(); ++k) other.move_shift(k, shift_[k]);
  machines_ += other.machines_;
  add_each(x_, other.x_);
  add_each(xx_, other.xx_);
  add_each(y_, other.y_);
  add_each(yy_, other.yy_);
  add_each(xy_, other.xy_);
}

std::optional<LinearFit> LinearFitSums::fit() const {
  const std::size_t unknowns = errors_ + 1;
  if (machines_ < 2 * unknowns) return std::nullopt;
  const auto n = static_cast<double>(machines_);
  const auto size = static_cast<Eigen::Index>(errors_);
  const Eigen::Map<const Eigen::VectorXd> x(x_.data(), size);
  LinearFit found;
  found.errors = errors_;
  found.machines = machines_;
  found.products.resize(errors_ * errors_);
  Eigen::Map<Matrix> products(found.products.data(), size, size);
  products = Eigen::Map<const Matrix>(xx_.data(), size, size).selfadjointView<Eigen::Lower>();
  // The equations use sums about the means, so that the offset is not one of their unknowns.
  const Eigen::MatrixXd inverse = linalg::inverse(products - x * x.transpose() / n);
  products /= n;
  if (!inverse.allFinite()) return std::nullopt;
  for (std::size_t k = 0; k < shift_.size(); ++k) {
    const Eigen::Map<const Eigen::VectorXd> xy(&xy_[k * errors_], size);
    const Eigen::VectorXd about_mean = xy - x * (y_[k] / n);
    const Eigen::VectorXd slope = inverse * about_mean;
    const double rest = yy_[k] - y_[k] * y_[k] / n - slope.dot(about_mean);
    found.rest.push_back(std::max(0.0, rest) / (n - static_cast<double>(unknowns)));
    found.offset.push_back(shift_[k] + (y_[k] - slope.dot(x)) / n);
    found.slope.insert(found.slope.end(), slope.begin(), slope.end());
    for (Eigen::Index p = 0; p < size; ++p) found.slope_variance.push_back(inverse(p, p) * found.rest.back());
  }
  return found;
}

void LinearFitSums::state(Archive& archive) {
  archive.number(machines_);
  for (std::vector<double>* sums : {&x_, &xx_, &shift_, &y_, &yy_, &xy_}) {
    archive.reals(*sums);
    const bool finite = std::ranges::all_of(*sums, [](double one) { return std::isfinite(one); });
    archive.expect(finite, "has sums of a fit that no machines give");
  }
}

}  // namespace poesy
