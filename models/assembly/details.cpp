#include "models/assembly/details.h"

#include <cmath>

#include "engine/linalg/decompositions.h"

namespace poesy::assembly {
namespace {

/// The matrix M [rows x 6] of a response: to first order, the response is the root mean square over the pairs of limbs
/// of |M delta_mu|, where delta_mu is the mismatch of a pair.
Eigen::MatrixXd judged_of_pair(const Nominal& pose, std::size_t response) {
  if (response == 0) return linalg::cholesky_root(pose.W);  // response `gap`
  if (response == 1) return Eigen::MatrixXd::Identity(3, 6);
  Eigen::MatrixXd linear(3, 6);  // linear mismatch v + omega x origin
  linear << -lie::hat<double>(pose.bodies[kPlatform].p), lie::Matrix3<double>::Identity();
  return linear;
}

}  // namespace

std::vector<double> pair_mismatch(const AssemblyModel& model, std::span<const Screw> mismatch,
                                  chain::Fidelity fidelity) {
  std::vector<double> values;
  for (const chain::LimbPair& pair : model.pairs) {
    const Screw& k = mismatch[pair.k];
    const Screw& i = mismatch[pair.i];
    const bool is_linear = fidelity == chain::Fidelity::first_order;
    const Screw apart = is_linear ? Screw(k - i) : lie::log(lie::exp(k) * lie::exp(i).inverse());
    values.insert(values.end(), apart.begin(), apart.end());
  }
  return values;
}

std::vector<double> norm_of_details(const AssemblyModel& model, std::size_t response, std::span<const double> pose) {
  if (model.pairs.empty() || response >= kDeformations) return {};
  const std::size_t pairs = model.pairs.size();
  return chain::repeated(judged_of_pair(model.at(pose), response), pairs, 1.0 / std::sqrt(static_cast<double>(pairs)));
}

}  // namespace poesy::assembly
