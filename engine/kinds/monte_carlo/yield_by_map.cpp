#include "engine/kinds/monte_carlo/yield_by_map.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "engine/base/nan.h"
#include "engine/kinds/monte_carlo/yield.h"
#include "engine/random/weighted_points.h"
#include "engine/stats/indices.h"
#include "engine/stats/linear_limits.h"
#include "engine/stats/mapped_gradient.h"
#include "engine/stats/mean_square_shares.h"

namespace poesy::monte_carlo {
namespace {

/// The positions of the components of one vector, at all poses, in the list of all fitted components.
std::vector<std::size_t> rows_of(const MachineTable& table, const LimitedVector& vector) {
  std::vector<std::size_t> rows;
  for (std::size_t m = 0; m < table.plan().poses().size(); ++m) {
    for (std::size_t k = 0; k < vector.rows; ++k) rows.push_back(m * table.vectors().rows() + vector.first_row + k);
  }
  return rows;
}

std::vector<ErrorEffect> effects_on(const MachineTable& table, std::size_t response) {
  const Plan& plan = table.plan();
  std::vector<ErrorEffect> errors;
  for (const Distribution& error : plan.distributions()) {
    const double sigma = error.standard_deviation();
    errors.push_back({.block = 0, .rounding = sigma * index_rounding(table.rounding()[response], sigma)});
  }
  for (std::size_t n = 0; n < plan.correlated().size(); ++n) {
    for (const std::size_t p : plan.correlated()[n].slots) errors[p].block = n + 1;
  }
  return errors;
}

/// The limit on a vector at one pose, with the vector as a linear function of the errors in SI.
LinearLimit limit_at(const MachineTable& table, const LinearFit& fit, const LimitedVector& vector, std::size_t pose) {
  const std::size_t rows = table.vectors().rows();
  const ArrayView<const double, axis::Pose, axis::VectorRow, axis::Factor> slopes(
      fit.slope, {table.plan().poses().size(), rows, fit.errors});
  const ArrayView<const double, axis::Pose, axis::VectorRow> offsets(fit.offset, {table.plan().poses().size(), rows});
  LinearLimit limit{vector.rows, vector.limit, {}, {}};
  for (std::size_t k = vector.first_row; k < vector.first_row + vector.rows; ++k) {
    limit.offset.push_back(offsets(pose, k));
    limit.slope.insert(limit.slope.end(), slopes.row(pose, k).begin(), slopes.row(pose, k).end());
  }
  limit = with_fewest_rows(limit);
  const ArrayView<double, axis::VectorRow, axis::Factor> slope(limit.slope, {limit.rows, fit.errors});
  for (std::size_t k = 0; k < limit.rows; ++k) {
    for (std::size_t p = 0; p < fit.errors; ++p) {
      const Distribution& error = table.plan().distributions()[p];
      slope(k, p) /= error.standard_deviation();
      limit.offset[k] -= slope(k, p) * error.mean();
    }
  }
  return limit;
}

LinearLimits limits_of(const MachineTable& table, const LinearFit& fit) {
  std::vector<LinearLimit> limits;
  for (std::size_t m = 0; m < table.plan().poses().size(); ++m) {
    for (const LimitedVector& vector : table.vectors().each()) limits.push_back(limit_at(table, fit, vector, m));
  }
  return {fit.errors, std::move(limits)};
}

std::vector<std::optional<MappedError>> mapped_errors(const MachineTable& table) {
  // Degree of the score by which the gradient is corrected for machines that the linear map judges wrongly.
  constexpr std::size_t kDegree = 2;
  std::vector<std::optional<MappedError>> errors;
  for (std::size_t p = 0; p < table.errors(); ++p) {
    errors.emplace_back();
    if (!std::holds_alternative<PolynomialScore>(table.scores().each[p])) continue;
    const Distribution& error = table.plan().distributions()[p];
    std::vector<double> quantiles = ErrorRange::grid();
    error.transform(quantiles);
    const WeightedPoints points = weighted_points(error);
    errors.back().emplace(MappedError{ErrorRange(std::move(quantiles), error.mean()),
                                      PolynomialScore(points.points, points.weights, kDegree)});
  }
  return errors;
}

/// Draws the errors of consecutive machines again, as the study drew them.
Array<double, axis::Factor, axis::Sample> errors_of(const Plan& plan, std::size_t first, std::size_t count) {
  Array<double, axis::Factor, axis::Sample> values({plan.factors().size(), count});
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    plan.draw_uniforms(p, PoseIndex(0), SampleIndex(first), values.row(p));
  }
  plan.transform(values.all(), count);
  return values;
}

void set_shares(const MachineTable& table, const LinearFit& fit, double conf_level, YieldResult& yield) {
  for (const LimitedVector& vector : table.vectors().each()) {
    const MeanSquareShares shares = mean_square_shares(fit, rows_of(table, vector), table.plan().poses().size(),
                                                       effects_on(table, vector.response), conf_level);
    yield.linear_share(vector.response) = shares.linear;
    yield.offset(vector.response) = shares.offset;
    yield.offset_share(vector.response) = shares.offset_share;
    for (std::size_t p = 0; p < table.errors(); ++p) {
      set_estimate(shares.each[p], yield.mean_square_share, yield.mean_square_share_ci_low,
                   yield.mean_square_share_ci_high, vector.response, p);
    }
  }
}

/// Whether the linear map judges only few machines wrongly as good or rejected. If it misjudges many, the correction by
/// a score of low degree is not good enough.
bool judges_well(const MappedGradient& gradient, std::span<const std::uint8_t> rejected) {
  constexpr double kMost = 0.3;  // number of misjudged machines that is allowed in addition to kAnyway, as a share of
                                 // the rejects, or of the good machines if there are fewer of these
  constexpr double kAnyway = 4.0;
  const auto rejects = static_cast<double>(std::ranges::count(rejected, 1));
  const double fewer = std::min(rejects, static_cast<double>(rejected.size()) - rejects);
  return static_cast<double>(gradient.misjudged()) <= kAnyway + kMost * fewer;
}

void set_gradient(const MachineTable& table, const LinearFit& fit, std::span<const std::uint8_t> rejected,
                  double conf_level, YieldResult& yield) {
  constexpr std::size_t kBlock = 50;
  MappedGradient gradient(limits_of(table, fit), mapped_errors(table));
  for (std::size_t first = 0; first < rejected.size(); first += kBlock) {
    const std::size_t count = std::min(kBlock, rejected.size() - first);
    gradient.add(errors_of(table.plan(), first, count), rejected.subspan(first, count));
  }
  if (!judges_well(gradient, rejected)) return;
  for (std::size_t p = 0; p < table.errors(); ++p) {
    if (!std::holds_alternative<PolynomialScore>(table.scores().each[p])) continue;
    set_estimate(gradient.gradient(p, conf_level), yield.gradient, yield.gradient_ci_low, yield.gradient_ci_high, p);
    set_estimate(within(gradient.change(p, conf_level), -yield.value, 1.0 - yield.value), yield.change,
                 yield.change_ci_low, yield.change_ci_high, p);
    yield.change_sd_without_effect(p) = kNaN;
  }
}

}  // namespace

void set_first_order(const MachineTable& table, const std::optional<LinearFit>& fit,
                     std::span<const std::uint8_t> rejected, double conf_level, YieldResult& yield) {
  for (auto* list : {&yield.mean_square_share, &yield.mean_square_share_ci_low, &yield.mean_square_share_ci_high}) {
    *list = decltype(yield.mean_square_share)({table.responses(), table.errors()}, kNaN);
  }
  for (auto* list : {&yield.linear_share, &yield.offset, &yield.offset_share}) {
    *list = decltype(yield.linear_share)({table.responses()}, kNaN);
  }
  if (!fit) return;
  set_shares(table, *fit, conf_level, yield);
  if (!rejected.empty()) set_gradient(table, *fit, rejected, conf_level, yield);
}

}  // namespace poesy::monte_carlo
