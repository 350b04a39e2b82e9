#include "models/assembly/equilibrium.h"

#include <algorithm>

#include "engine/linalg/decompositions.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;

Index index(std::size_t value) { return static_cast<Index>(value); }

}  // namespace

Equilibrium::Equilibrium(const Assembly& assembly, const Nominal& pose)
    : Equilibrium(assembly, pose, Transform{lie::Matrix3<double>::Identity(), pose.bodies[kPlatform].p}) {}

Equilibrium::Equilibrium(const Assembly& assembly, const Nominal& pose, const Transform& frame)
    : assembly_(&assembly),
      to_unit_(assembly::twists_in_units(frame, assembly.reach)),
      from_unit_(linalg::inverse(to_unit_)),
      unit_(0.0) {
  for (const Matrix6& compliance : pose.compliance) {
    compliance_.push_back(to_unit_ * compliance * to_unit_.transpose());
    unit_ = std::max(unit_, compliance_.back().cwiseAbs().maxCoeff());
  }
  if (unit_ == 0.0) unit_ = 1.0;
  for (Matrix6& compliance : compliance_) compliance /= unit_;
}

void Equilibrium::set(std::span<const LimbState> limbs, std::span<const std::size_t> ranks) {
  carry_.clear();
  give_.clear();
  first_.assign(1, 0);
  for (std::size_t e = 0; e < limbs.size(); ++e) {
    const Matrix columns = to_unit_ * limbs[e].passive;
    const linalg::RangeAndComplement split = linalg::range_and_complement(columns, ranks[e]);
    carry_.push_back(split.complement);
    const Matrix inside = split.range.transpose() * columns;
    const Matrix inverse = linalg::solve(inside * inside.transpose(), split.range.transpose());
    give_.push_back(inside.transpose() * inverse);
    first_.push_back(first_.back() + carry_.back().cols());
  }
  const Index wrenches = first_.back();
  const Index size = wrenches + 6 * index(assembly_->bodies.size() - 1);
  matrix_.setZero(size, size);
  for (std::size_t e = 0; e < limbs.size(); ++e) {
    const Index at = first_[e];
    const Index count = carry_[e].cols();
    matrix_.block(at, at, count, count) = carry_[e].transpose() * compliance_[e] * carry_[e];
    const auto touch = [&](std::size_t body, double sign) {
      if (body == kBase) return;
      const Index row = wrenches + 6 * index(body - 1);
      matrix_.block(row, at, 6, count) = sign * carry_[e];
      matrix_.block(at, row, count, 6) = sign * carry_[e].transpose();
    };
    touch(assembly_->limbs[e].from, -1.0);
    touch(assembly_->limbs[e].to, 1.0);
  }
}

Balance Equilibrium::solve(const Matrix& xi, const Matrix& load) const {
  const Index wrenches = first_.back();
  const auto bodies = index(assembly_->bodies.size());
  Matrix right(matrix_.rows(), xi.cols());
  for (std::size_t e = 0; e < carry_.size(); ++e) {
    right.middleRows(first_[e], carry_[e].cols()) = carry_[e].transpose() * to_unit_ * xi.middleRows(6 * index(e), 6);
  }
  for (Index b = 1; b < bodies; ++b) {
    right.middleRows(wrenches + 6 * (b - 1), 6) = -unit_ * from_unit_.transpose() * load.middleRows(6 * b, 6);
  }
  const Matrix found = linalg::solve(matrix_, right);
  Balance made{Matrix(xi.rows(), xi.cols()), Matrix::Zero(6 * bodies, xi.cols())};
  for (std::size_t e = 0; e < carry_.size(); ++e) {
    made.wrenches.middleRows(6 * index(e), 6) =
        to_unit_.transpose() * carry_[e] * found.middleRows(first_[e], carry_[e].cols()) / unit_;
  }
  for (Index b = 1; b < bodies; ++b) {
    made.twists.middleRows(6 * b, 6) = from_unit_ * found.middleRows(wrenches + 6 * (b - 1), 6);
  }
  return made;
}

Eigen::VectorXd Equilibrium::displacements(std::size_t limb, const Screw& wanted) const {
  return give_[limb] * (to_unit_ * wanted);
}

}  // namespace poesy::assembly
