#include "engine/run/sensitivity.h"

#include "engine/base/contract.h"
#include "engine/stats/sensitivity_index.h"

namespace poesy {
namespace {

void append(const Estimate& estimate, std::vector<double>& value, std::vector<double>& low, std::vector<double>& high) {
  value.push_back(estimate.value);
  low.push_back(estimate.interval.low);
  high.push_back(estimate.interval.high);
}

/// One response of one factor: its indices at all poses and over them.
void append_row(std::span<const UnitStats> cells, std::size_t response, double sigma, SensitivityResult& result) {
  std::vector<LocalIndex> at_poses;
  at_poses.reserve(cells.size());
  for (const UnitStats& cell : cells) {
    const Moments& moments = cell.responses[response];
    append(local_index(moments, sigma, result.conf_level), result.local, result.local_ci_low, result.local_ci_high);
    result.count.push_back(static_cast<double>(moments.count()));
    result.mean.push_back(moments.mean());
    result.std.push_back(moments.standard_deviation());
    at_poses.push_back(local_index_with_error(moments, sigma));
  }
  append(global_index(at_poses, result.conf_level), result.global, result.global_ci_low, result.global_ci_high);
}

}  // namespace

SensitivityResult sensitivity_result(const Plan& plan, std::span<const UnitStats> cells, double conf_level) {
  SensitivityResult result;
  result.factors = plan.factors().size();
  result.poses = plan.poses().size();
  result.conf_level = conf_level;
  POESY_EXPECTS(cells.size() == result.factors * result.poses && !cells.empty());
  result.responses = cells.front().responses.size();
  for (std::size_t r = 0; r < result.responses; ++r) {
    for (std::size_t p = 0; p < result.factors; ++p) {
      append_row(cells.subspan(p * result.poses, result.poses), r, plan.distributions()[p].standard_deviation(),
                 result);
    }
  }
  for (const UnitStats& cell : cells) result.solves.push_back(cell.solves);
  return result;
}

}  // namespace poesy
