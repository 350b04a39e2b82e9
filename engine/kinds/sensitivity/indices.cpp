#include "engine/kinds/sensitivity/indices.h"

#include <array>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/result.h"
#include "engine/stats/indices.h"

namespace poesy::sensitivity {
namespace {

std::vector<LocalIndex> local_indices(std::span<const Moments> at_poses, double sigma) {
  std::vector<LocalIndex> indices;
  indices.reserve(at_poses.size());
  for (const Moments& moments : at_poses) indices.push_back(local_index_with_error(moments, sigma));
  return indices;
}

/// The corrected global index of one error for one response; NaN if the error is too small for its effect to be
/// distinguished from rounding.
Estimate told_index(std::span<const LocalIndex> poses, double rounding, double conf_level) {
  const Estimate index = corrected_global_index(poses, conf_level);
  return is_too_small_to_tell(index.value, rounding) ? Estimate{kNaN, {kNaN, kNaN}} : index;
}

/// The numbers of all cells (one error at one pose) for all responses, which are appended one by one. Memory is
/// reserved for all of them; it takes no space until it is written.
class CellNumbers {
 public:
  explicit CellNumbers(std::size_t cells) {
    for (std::vector<double>& list : numbers_) list.reserve(cells);
    count_.reserve(cells);
  }

  void add(const Moments& moments, const Estimate& index) {
    const std::array values{index.value, index.interval.low, index.interval.high, moments.mean(),
                            moments.standard_deviation()};
    for (std::size_t k = 0; k < values.size(); ++k) numbers_[k].push_back(values[k]);
    count_.push_back(moments.count());
  }

  void move_to(Result& result, const std::array<std::size_t, 3>& lengths) && {
    std::size_t k = 0;
    for (auto* cells : {&result.local, &result.local_ci_low, &result.local_ci_high, &result.mean, &result.std}) {
      *cells = {lengths, std::move(numbers_[k++])};
    }
    result.count = {lengths, std::move(count_)};
  }

 private:
  std::array<std::vector<double>, 5> numbers_;
  std::vector<std::uint64_t> count_;
};

/// Sets the global indices of one error for one response.
void set_global(std::span<const Moments> at_poses, std::size_t r, std::size_t p, double sigma, Result& result) {
  const auto set = [&](const Estimate& index, auto& value, auto& low, auto& high) {
    value(r, p) = index.value;
    low(r, p) = index.interval.low;
    high(r, p) = index.interval.high;
  };
  const std::vector<LocalIndex> indices = local_indices(at_poses, sigma);
  set(global_index(indices, result.conf_level), result.global, result.global_ci_low, result.global_ci_high);
  set(told_index(indices, index_rounding(result, r, sigma), result.conf_level), result.global_corrected,
      result.global_corrected_ci_low, result.global_corrected_ci_high);
}

}  // namespace

Array<double, axis::Response, axis::Pose> background_responses(const Plan& plan, const Model& model) {
  const auto evaluator = model.evaluator(plan.solver());
  const std::array zero{0.0};
  std::array status{SolveStatus::converged};
  std::array iterations{std::uint32_t{0}};
  std::vector<double> outcome(model.description().responses.size());
  Array<double, axis::Response, axis::Pose> background({outcome.size(), plan.poses().size()});
  for (std::size_t m = 0; m < plan.poses().size(); ++m) {
    evaluator->evaluate({plan.poses()[PoseIndex(m)], plan.background(), plan.factors().first(1), zero, 1},
                        {outcome, status, iterations, {}});
    for (std::size_t r = 0; r < outcome.size(); ++r) {
      background(r, m) = counts(status[0], plan.not_converged()) ? outcome[r] : kNaN;
    }
  }
  return background;
}

std::vector<Estimate> global_indices(const CellStats& at_poses, double sigma, double conf_level) {
  POESY_EXPECTS(at_poses.size() > 0);
  std::vector<Estimate> indices;
  for (const std::vector<Moments>& response : at_poses.responses) {
    indices.push_back(global_index(local_indices(response, sigma), conf_level));
  }
  return indices;
}

Result sensitivity_result(const Plan& plan, CellStats cells, Array<double, axis::Response, axis::Pose> background,
                          std::vector<double> rounding, double conf_level) {
  const std::size_t responses = cells.responses.size();
  const std::size_t factors = plan.factors().size();
  const std::size_t poses = plan.poses().size();
  POESY_EXPECTS(cells.size() == factors * poses && cells.size() > 0);
  Result result;
  result.conf_level = conf_level;
  POESY_EXPECTS(background.lengths() == (std::array{responses, poses}));
  result.background = std::move(background);
  result.rounding = {{responses}, std::move(rounding)};
  for (auto* indices : {&result.global, &result.global_ci_low, &result.global_ci_high, &result.global_corrected,
                        &result.global_corrected_ci_low, &result.global_corrected_ci_high}) {
    *indices = Result::Indices({responses, factors});
  }
  CellNumbers numbers(responses * cells.size());
  for (std::size_t r = 0; r < responses; ++r) {
    const Array<Moments, axis::Factor, axis::Pose> response({factors, poses}, std::exchange(cells.responses[r], {}));
    for (std::size_t p = 0; p < factors; ++p) {
      const double sigma = plan.distributions()[p].standard_deviation();
      for (const Moments& moments : response.row(p)) numbers.add(moments, local_index(moments, sigma, conf_level));
      set_global(response.row(p), r, p, sigma, result);
    }
  }
  std::move(numbers).move_to(result, {responses, factors, poses});
  result.solves = {{factors, poses}, std::move(cells.solves)};
  for (std::size_t cell = 0; cell < cells.failed.size(); ++cell) {
    const auto [factor, pose] = result.solves.positions(cell);
    append_failures(factor, PoseIndex(pose), cells.failed[cell], result.failures);
  }
  return result;
}

double index_rounding(const Result& result, std::size_t response, double sigma) {
  return index_rounding(result.rounding(response), sigma);
}

ResponseStudy response_study(const Result& result, std::span<const double> sigma, std::span<const double> error_mean,
                             std::size_t response) {
  const std::array lengths{result.factors(), result.poses()};
  POESY_EXPECTS(sigma.size() == result.factors());
  std::vector<double> index;
  for (std::size_t p = 0; p < result.factors(); ++p) {
    index.push_back(told_from_rounding(result.global(response, p), index_rounding(result, response, sigma[p])));
  }
  return {.index = std::move(index),
          .sigma = sigma,
          .count = {result.count.row(response), lengths},
          .mean = {result.mean.row(response), lengths},
          .std = {result.std.row(response), lengths},
          .background = result.background.row(response),
          .error_mean = error_mean};
}

Tolerances response_tolerances(const Result& result, std::span<const double> sigma, std::span<const double> error_mean,
                               std::size_t response, const std::optional<ReferenceError>& reference) {
  return tolerances(response_study(result, sigma, error_mean, response), reference);
}

}  // namespace poesy::sensitivity
