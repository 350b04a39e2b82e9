#include "engine/run/response_rounding.h"

#include "engine/stats/indices.h"

namespace poesy {

std::vector<double> response_rounding(const Model& model) {
  std::vector<double> list;
  for (std::size_t r = 0; r < model.description().responses.size(); ++r) list.push_back(model.rounding(r));
  return list;
}

std::vector<double> joint_rounding(const Plan& plan, const Model& model) {
  std::vector<double> sigma;
  for (const Distribution& error : plan.distributions()) sigma.push_back(error.standard_deviation());
  std::vector<double> list;
  for (const double rounding : response_rounding(model)) list.push_back(joint_rounding(rounding, sigma));
  return list;
}

}  // namespace poesy
