#include "models/assembly/first_order.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;

}  // namespace

FirstOrder::FirstOrder(const Assembly& assembly, const Nominal& pose, std::span<const std::size_t> ranks)
    : assembly_(&assembly), equations_(assembly, pose) {
  equations_.set(pose.limbs, ranks);
  Matrix load(6 * static_cast<Index>(pose.load.size()), 1);
  for (std::size_t b = 0; b < pose.load.size(); ++b) load.middleRows<6>(6 * static_cast<Index>(b)) = pose.load[b];
  Matrix mismatch(6 * static_cast<Index>(pose.mismatch.size()), 1);
  for (std::size_t e = 0; e < pose.mismatch.size(); ++e) {
    mismatch.middleRows<6>(6 * static_cast<Index>(e)) = pose.mismatch[e];
  }
  by_load_ = equations_.solve(mismatch, load);
  is_regular_ = by_load_.wrenches.allFinite() && by_load_.twists.allFinite();
}

Balance FirstOrder::effect(const Matrix& xi) const {
  return equations_.solve(xi, Matrix::Zero(6 * static_cast<Index>(assembly_->bodies.size()), xi.cols()));
}

}  // namespace poesy::assembly
