#include "engine/kinds/sensitivity/indices.h"

#include <array>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/run/result.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

void append(const Estimate& estimate, std::vector<double>& value, std::vector<double>& low, std::vector<double>& high) {
  value.push_back(estimate.value);
  low.push_back(estimate.interval.low);
  high.push_back(estimate.interval.high);
}

std::vector<LocalIndex> local_indices(std::span<const Moments> at_poses, double sigma) {
  std::vector<LocalIndex> indices;
  indices.reserve(at_poses.size());
  for (const Moments& moments : at_poses) indices.push_back(local_index_with_error(moments, sigma));
  return indices;
}

/// The corrected index of one response of one factor, where it can be told from rounding.
Estimate told_index(std::span<const LocalIndex> poses, double rounding, double conf_level) {
  const Estimate index = corrected_global_index(poses, conf_level);
  return is_too_small_to_tell(index.value, rounding) ? Estimate{kNaN, {kNaN, kNaN}} : index;
}

/// Room for all numbers of the result, of which only those that are written take memory.
void reserve(SensitivityResult& result) {
  const std::size_t of_factors = result.responses * result.factors;
  for (std::vector<double>* list :
       {&result.local, &result.local_ci_low, &result.local_ci_high, &result.count, &result.mean, &result.std}) {
    list->reserve(of_factors * result.poses);
  }
}

/// One response of one factor: its indices at all poses and over them.
void append_row(std::span<const Moments> at_poses, std::size_t response, double sigma, SensitivityResult& result) {
  for (const Moments& moments : at_poses) {
    append(local_index(moments, sigma, result.conf_level), result.local, result.local_ci_low, result.local_ci_high);
    result.count.push_back(static_cast<double>(moments.count()));
    result.mean.push_back(moments.mean());
    result.std.push_back(moments.standard_deviation());
  }
  const std::vector<LocalIndex> indices = local_indices(at_poses, sigma);
  append(global_index(indices, result.conf_level), result.global, result.global_ci_low, result.global_ci_high);
  append(told_index(indices, index_rounding(result, response, sigma), result.conf_level), result.global_corrected,
         result.global_corrected_ci_low, result.global_corrected_ci_high);
}

}  // namespace

std::vector<double> background_responses(const Plan& plan, const Model& model) {
  const std::size_t responses = model.description().responses.size();
  const std::size_t poses = plan.poses().size();
  const auto evaluator = model.evaluator(plan.solver());
  const std::array zero{0.0};
  std::array status{SolveStatus::converged};
  std::array iterations{std::uint32_t{0}};
  std::vector<double> outcome(responses);
  std::vector<double> background(responses * poses);
  for (std::size_t m = 0; m < poses; ++m) {
    evaluator->evaluate({plan.poses()[PoseIndex(m)], plan.background(), plan.factors().first(1), zero, 1},
                        {outcome, status, iterations, {}});
    for (std::size_t r = 0; r < responses; ++r) {
      background[r * poses + m] = counts(status[0], plan.not_converged()) ? outcome[r] : kNaN;
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

SensitivityResult sensitivity_result(const Plan& plan, CellStats cells, std::vector<double> background,
                                     std::vector<double> rounding, double conf_level) {
  SensitivityResult result;
  result.factors = plan.factors().size();
  result.poses = plan.poses().size();
  result.conf_level = conf_level;
  POESY_EXPECTS(cells.size() == result.factors * result.poses && cells.size() > 0);
  result.responses = cells.responses.size();
  POESY_EXPECTS(background.size() == result.responses * result.poses);
  result.background = std::move(background);
  POESY_EXPECTS(rounding.size() == result.responses);
  result.rounding = std::move(rounding);
  reserve(result);
  for (std::size_t r = 0; r < result.responses; ++r) {
    const std::vector<Moments> response = std::exchange(cells.responses[r], {});
    for (std::size_t p = 0; p < result.factors; ++p) {
      append_row(std::span(response).subspan(p * result.poses, result.poses), r,
                 plan.distributions()[p].standard_deviation(), result);
    }
  }
  for (std::size_t cell = 0; cell < cells.size(); ++cell) {
    append_failures(cell / result.poses, PoseIndex(cell % result.poses), cells.failed[cell], result.failures);
  }
  result.solves = std::move(cells.solves);
  return result;
}

double index_rounding(const SensitivityResult& result, std::size_t response, double sigma) {
  return index_rounding(result.rounding[response], sigma);
}

ResponseStudy response_study(const SensitivityResult& result, std::span<const double> sigma, std::size_t response) {
  POESY_EXPECTS(sigma.size() == result.factors && result.background.size() == result.responses * result.poses);
  const auto part = [&](const std::vector<double>& values, std::size_t length) {
    return std::span(values).subspan(response * length, length);
  };
  const std::size_t cells = result.factors * result.poses;
  std::vector<double> index;
  for (std::size_t p = 0; p < result.factors; ++p) {
    index.push_back(
        told_from_rounding(result.global[response * result.factors + p], index_rounding(result, response, sigma[p])));
  }
  return {.index = std::move(index),
          .sigma = sigma,
          .count = part(result.count, cells),
          .mean = part(result.mean, cells),
          .std = part(result.std, cells),
          .background = part(result.background, result.poses)};
}

Tolerances response_tolerances(const SensitivityResult& result, std::span<const double> sigma, std::size_t response,
                               const std::optional<ReferenceError>& reference) {
  return tolerances(response_study(result, sigma, response), reference);
}

}  // namespace poesy
