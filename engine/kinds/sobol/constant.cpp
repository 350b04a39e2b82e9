#include "engine/kinds/sobol/constant.h"

#include <algorithm>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/run/response_rounding.h"
#include "engine/stats/indices.h"

namespace poesy {
namespace {

/// Of each component of all details its dimension, [D].
std::vector<Dimension> detail_dimensions(const ModelDescription& model) {
  std::vector<Dimension> list;
  for (const Detail& detail : model.details) {
    for (const std::string& unit : component_units(detail)) list.push_back(dimension_of(unit));
  }
  return list;
}

/// Of a row its standard deviations at the poses, [M].
std::vector<double> deviations(const IndexPanel& panel, const PanelSums& sums, std::size_t row) {
  std::vector<double> list;
  for (std::size_t m = 0; m < panel.poses; ++m) {
    list.push_back(sums.moments[row * panel.poses + m].standard_deviation());
  }
  return list;
}

void fill_with_nan(std::vector<double>& values, std::size_t first, std::size_t count) {
  std::fill_n(values.begin() + static_cast<std::ptrdiff_t>(first), count, kNaN);
}

void leave_out(SobolIndices& indices, std::size_t first, std::size_t count) {
  for (auto* values :
       {&indices.S1, &indices.S1_ci_low, &indices.S1_ci_high, &indices.ST, &indices.ST_ci_low, &indices.ST_ci_high}) {
    fill_with_nan(*values, first, count);
  }
}

}  // namespace

std::vector<double> row_rounding(const IndexPanel& panel, const Plan& plan, const Model& model) {
  std::vector<double> list = joint_rounding(plan, model);
  if (panel.details == 0) return list;
  const std::vector<Response>& responses = model.description().responses;
  const double least = std::ranges::min(list);
  for (const Dimension dimension : detail_dimensions(model.description())) {
    double rounding = least;
    for (std::size_t r = 0; r < responses.size(); ++r) {
      if (responses[r].dimension == dimension) rounding = std::max(rounding, list[r]);
    }
    list.push_back(rounding);
  }
  return list;
}

std::vector<std::uint8_t> varying_quantities(const IndexPanel& panel, const PanelSums& sums,
                                             std::span<const double> rounding) {
  std::vector<std::uint8_t> varies;
  for (std::size_t q = 0; q < panel.quantities(); ++q) {
    const auto component_varies = [&](std::size_t row) {
      return !is_constant(deviations(panel, sums, row), rounding[row]);
    };
    varies.push_back(std::ranges::any_of(panel.components(q), component_varies) ? 1 : 0);
  }
  return varies;
}

void leave_out_constant(const IndexPanel& panel, const PanelSums& sums, std::span<const double> rounding,
                        SobolResult& found) {
  const std::size_t groups = panel.groups.size();
  const std::size_t poses = panel.poses;
  for (std::size_t r = 0; r < panel.responses; ++r) {
    const std::vector<double> at_poses = deviations(panel, sums, r);
    for (std::size_t m = 0; m < poses; ++m) {
      if (!is_constant(std::span(at_poses).subspan(m, 1), rounding[r])) continue;
      for (std::size_t g = 0; g < groups; ++g) leave_out(found.at_poses, (r * groups + g) * poses + m, 1);
    }
  }
  std::vector<std::uint8_t> varies = varying_quantities(panel, sums, rounding);
  for (std::size_t q = 0; q < varies.size(); ++q) {
    if (varies[q] != 0) continue;
    const bool is_response = q < panel.responses;
    if (!is_response) {
      leave_out(found.of_vectors, (q - panel.responses) * groups, groups);
      continue;
    }
    leave_out(found.aggregated, q * groups, groups);
    for (auto* values : {&found.S2, &found.S2_ci_low, &found.S2_ci_high}) {
      if (!values->empty()) fill_with_nan(*values, q * groups * groups, groups * groups);
    }
    for (auto* values : {&found.Sh, &found.Sh_ci_low, &found.Sh_ci_high}) {
      if (!values->empty()) fill_with_nan(*values, q * groups, groups);
    }
  }
  const auto vectors = varies.begin() + static_cast<std::ptrdiff_t>(panel.responses);
  found.varies.assign(varies.begin(), vectors);
  found.vector_varies.assign(vectors, varies.end());
  if (std::ranges::find(found.varies, 0) == found.varies.end()) found.varies.clear();
  if (std::ranges::find(found.vector_varies, 0) == found.vector_varies.end()) found.vector_varies.clear();
}

}  // namespace poesy
