#include "engine/kinds/sobol/constant.h"

#include <algorithm>

#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/run/response_rounding.h"
#include "engine/stats/indices.h"

namespace poesy::sobol {
namespace {

/// The dimension of each component of the model's additional outputs (Detail in model/model.h).
std::vector<Dimension> detail_dimensions(const ModelDescription& model) {
  std::vector<Dimension> list;
  for (const Detail& detail : model.details) {
    for (const std::string& unit : component_units(detail)) list.push_back(dimension_of(unit));
  }
  return list;
}

/// [poses] The standard deviation, SI, of a row of the panel (axis::PanelRow) at each pose.
std::vector<double> deviations(const PanelSums& sums, std::size_t row) {
  std::vector<double> list;
  for (const Moments& moments : sums.moments.row(row)) list.push_back(moments.standard_deviation());
  return list;
}

/// Sets the first-order and total indices at these positions to NaN.
template <class Indices, class... Positions>
void leave_out(Indices& indices, Positions... at) {
  indices.S1.leave_out(at...);
  indices.ST.leave_out(at...);
}

/// Copies flags into a list of a result. The list stays empty if all flags are 1.
template <class Flags>
void keep_flags(std::span<const std::uint8_t> from, Flags& flags) {
  const bool any = std::ranges::find(from, 0) != from.end();
  flags = any ? Flags({from.size()}, {from.begin(), from.end()}) : Flags();
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
    const auto component_varies = [&](std::size_t row) { return !is_constant(deviations(sums, row), rounding[row]); };
    varies.push_back(std::ranges::any_of(panel.components(q), component_varies) ? 1 : 0);
  }
  return varies;
}

void leave_out_constant(const IndexPanel& panel, const PanelSums& sums, std::span<const double> rounding,
                        Result& found) {
  const std::vector<std::uint8_t> varies = varying_quantities(panel, sums, rounding);
  for (std::size_t r = 0; r < panel.responses; ++r) {
    const std::vector<double> at_poses = deviations(sums, r);
    for (std::size_t m = 0; m < panel.poses; ++m) {
      if (!is_constant({&at_poses[m], 1}, rounding[r])) continue;
      for (std::size_t g = 0; g < panel.groups.size(); ++g) leave_out(found.at_poses, r, g, m);
    }
    if (varies[r] != 0) continue;
    leave_out(found.aggregated, r);
    if (!found.S2.empty()) found.S2.leave_out(r);
    if (!found.Sh.empty()) found.Sh.leave_out(r);
  }
  for (std::size_t v = 0; v < panel.vectors.size(); ++v) {
    if (varies[panel.responses + v] == 0) leave_out(found.of_vectors, v);
  }
  keep_flags(std::span(varies).first(panel.responses), found.varies);
  keep_flags(std::span(varies).subspan(panel.responses), found.vector_varies);
}

}  // namespace poesy::sobol
