#include "models/assembly/separation.h"

#include "engine/base/nan.h"
#include "engine/linalg/decompositions.h"
#include "models/chain/metric.h"
#include "models/chain/separation.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;

/// [6 x 6] The matrix from a twist of a limb's end to the twist of the platform.
Matrix6 platform_by_limb(const FirstOrder& first_order, Index limbs, Index limb) {
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(6 * limbs, 6);
  unit.middleRows<6>(6 * limb).setIdentity();
  return first_order.effect(unit).twists.middleRows<6>(6 * static_cast<Index>(kPlatform));
}

}  // namespace

Separation separation(const AssemblyModel& model, std::span<const double> pose) {
  const Nominal at = model.at(pose);
  const FirstOrder first_order(model.assembly, at, model.ranks);
  if (!first_order.is_regular()) {
    const std::vector<double> unknown(model.terms.size(), kNaN);
    return {unknown, unknown, unknown, unknown};
  }
  std::vector<chain::LimbMotions> limbs(at.limbs.size());
  for (std::size_t e = 0; e < limbs.size(); ++e) {
    const std::vector<chain::Joint>& joints = model.assembly.limbs[e].chain.joints;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      limbs[e].add(joints[j], at.limbs[e].twist(joints[j], j), at.limbs[e].before[j].p);
    }
    limbs[e].platform = platform_by_limb(first_order, static_cast<Index>(limbs.size()), static_cast<Index>(e));
  }
  std::vector<std::vector<chain::EndTwist>> errors;
  for (const chain::ErrorTerms& terms : model.terms) {
    std::vector<chain::EndTwist>& twists = errors.emplace_back();
    for (const chain::ErrorTerm& term : terms) chain::add_twist(term.limb, term_twist(model, at, term), twists);
  }
  return chain::separation_of(limbs, linalg::cholesky_root(at.W), chain::radius_of(model.assembly.points), errors);
}

SeparationDescription separation_description(const AssemblyModel& model) {
  std::string measure = "root mean square displacement of the platform's points";
  if (model.deforms) {
    measure +=
        model.pairs.empty() ? ", without the gap between limbs and bodies" : ", without the gap between its limbs";
  }
  return {std::move(measure), std::vector<std::string>(model.terms.size())};
}

}  // namespace poesy::assembly
