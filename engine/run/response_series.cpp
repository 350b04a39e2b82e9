#include "engine/run/response_series.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/array.h"

namespace poesy {
namespace {

/// The permitted error of a response that is computed from a series, as a share of the largest magnitude of the
/// response at the nodes.
constexpr double kPrecise = 1e-14;

/// The relative rounding error of a square at a node, and of a series through such squares.
constexpr double kRounding = 4.0 * std::numeric_limits<double>::epsilon();

double largest_magnitude(std::span<const double> values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

double square(double value) { return value * value; }

}  // namespace

ResponseSeries::ResponseSeries(const Model& model) : responses_(model.description().responses) {
  for (std::size_t r = 0; r < responses_.size(); ++r) least_.push_back(model.rounding(r));
}

std::array<double, ResponseSeries::kSolves> ResponseSeries::errors(double range) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  std::array<double, kSolves> list{};
  for (std::size_t k = 0; k < kNodes; ++k) list[k] = range * ChebyshevSeries::nodes()[k];
  for (std::size_t k = 1; k < kChecks; ++k) {
    const double multiple = kGoldenRatio * static_cast<double>(k);
    list[kNodes + k] = range * (2.0 * (multiple - std::floor(multiple)) - 1.0);
  }
  return list;
}

bool ResponseSeries::form(double range, std::span<const double> solved) {
  range_ = range;
  rows_.assign(responses_.size(), {});
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    if (!form_row(r, solved)) return false;
  }
  return is_certified(solved);
}

/// Returns true if response r is the norm of its components in all solves, and each component has its own series. A
/// response that a study defines may weigh its components, so that it is not their norm.
bool ResponseSeries::is_norm(std::size_t r, std::span<const double> solved) const {
  const std::vector<std::size_t>& components = responses_[r].components;
  const auto has_sign = [&](std::size_t c) { return c < r && rows_[c].form == Form::itself; };
  if (components.empty() || !std::ranges::all_of(components, has_sign)) return false;
  const ArrayView<const double, axis::Response, axis::Sample> all(solved, {rows_.size(), kSolves});
  for (std::size_t k = 0; k < kSolves; ++k) {
    double sum = 0.0;
    for (const std::size_t c : components) sum += square(all(c, k));
    if (!(std::abs(std::sqrt(sum) - all(r, k)) <= rows_[r].precise)) return false;
  }
  return true;
}

/// Forms the series of response r. Returns false if the series does not converge. all: [responses x kSolves].
bool ResponseSeries::form_row(std::size_t r, std::span<const double> all) {
  const std::span<const double> solved = all.subspan(r * kSolves, kSolves);
  const double largest = largest_magnitude(solved.first(kNodes));
  Row& row = rows_[r];
  row.precise = std::max(kPrecise * largest, least_[r]);
  if (largest <= least_[r]) return true;  // the response is only rounding: its series has no terms and gives 0
  if (is_norm(r, all)) {
    row.form = Form::norm;
    return true;
  }
  std::array<double, kNodes> values;
  std::ranges::copy(solved.first(kNodes), values.begin());
  double precise = row.precise;
  if (responses_[r].is_magnitude()) {
    const bool is_zero = solved[kNodes] <= row.precise;  // the error is 0 at the first check
    row.form = is_zero ? Form::root_over_error : Form::root;
    for (std::size_t k = 0; k < kNodes; ++k) {
      values[k] = square(is_zero ? values[k] / ChebyshevSeries::nodes()[k] : values[k]);
    }
    row.rounding = kRounding * largest_magnitude(values);
    precise *= 2.0 * largest;
  }
  row.series = ChebyshevSeries(values);
  return row.series.tail() <= precise;
}

bool ResponseSeries::is_certified(std::span<const double> solved) {
  std::vector<double> values(rows_.size() * kChecks);
  std::vector<std::size_t> left;
  const std::array<double, kSolves> solved_errors = errors(range_);
  evaluate(std::span(solved_errors).last(kChecks), values, left);
  const ArrayView<const double, axis::Response, axis::Sample> series(values, {rows_.size(), kChecks});
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::span<const double> solves = solved.subspan(r * kSolves, kSolves).last(kChecks);
    for (std::size_t k = 0; k < kChecks; ++k) {
      if (is_left_[k] != 0) continue;
      const double difference = series(r, k) - solves[k];
      if (!(std::abs(difference) <= rows_[r].precise)) return false;
    }
  }
  return true;
}

/// Computes response r as the norm of its components. responses: [responses x errors]; the rows before r are computed
/// already.
void ResponseSeries::take_norm(std::size_t r, std::span<double> responses) const {
  const std::size_t count = x_.size();
  const ArrayView<double, axis::Response, axis::Sample> all(responses, {rows_.size(), count});
  const std::span<double> values = all.row(r);
  std::ranges::fill(values, 0.0);
  for (const std::size_t c : responses_[r].components) {
    const std::span<const double> component = all.row(c);
    for (std::size_t b = 0; b < count; ++b) values[b] += square(component[b]);
  }
  for (double& value : values) value = std::sqrt(value);
}

/// Replaces the values of a series by the responses: their roots, or with Form::root_over_error their roots times the
/// magnitude of the scaled error (x_). Sets is_left_ where a root y is not precise: rounding changes it by the rounding
/// error of y^2 divided by 2 y.
void ResponseSeries::take_root(const Row& row, std::span<double> values) {
  for (std::size_t b = 0; b < values.size(); ++b) {
    const double size = row.form == Form::root_over_error ? std::abs(x_[b]) : 1.0;
    values[b] = size * std::sqrt(std::max(values[b], 0.0));
    if (square(size) * row.rounding > 2.0 * row.precise * values[b]) is_left_[b] = 1;
  }
}

void ResponseSeries::evaluate(std::span<const double> errors, std::span<double> responses,
                              std::vector<std::size_t>& left) {
  const std::size_t count = errors.size();
  x_.resize(count);
  is_left_.resize(count);
  for (std::size_t b = 0; b < count; ++b) {
    x_[b] = errors[b] / range_;
    is_left_[b] = std::abs(x_[b]) <= 1.0 ? 0 : 1;
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const std::span<double> values = responses.subspan(r * count, count);
    if (rows_[r].form == Form::norm) {
      take_norm(r, responses);
      continue;
    }
    rows_[r].series.evaluate(x_, values);
    if (rows_[r].form != Form::itself) take_root(rows_[r], values);
  }
  for (std::size_t b = 0; b < count; ++b) {
    if (is_left_[b] != 0) left.push_back(b);
  }
}

}  // namespace poesy
