#include "models/chain/residual_space.h"

#include <cmath>

#include "engine/base/contract.h"
#include "engine/linalg/decompositions.h"

namespace poesy::chain {
namespace {

/// The incidence matrix [pairs, limbs]: 1 if the limb is limb k of the pair, -1 if it is limb i, else 0.
Eigen::MatrixXd incidence_of(const ParallelChain& chain) {
  Eigen::MatrixXd incidence = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(chain.pairs.size()),
                                                    static_cast<Eigen::Index>(chain.limbs.size()));
  for (std::size_t n = 0; n < chain.pairs.size(); ++n) {
    incidence(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(chain.pairs[n].k)) = 1.0;
    incidence(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(chain.pairs[n].i)) = -1.0;
  }
  return incidence;
}

/// For L limbs, the matrix N [L - 1, L] with N^T N = incidence^T incidence. N removes the motion that all limbs have in
/// common.
Eigen::MatrixXd independent_rows(const Eigen::MatrixXd& incidence) {
  const auto [values, vectors] = linalg::eigen_decomposition(incidence.transpose() * incidence);
  const Eigen::Index limbs = incidence.cols();
  POESY_EXPECTS(limbs < 2 || values[1] > 1e-9);
  Eigen::MatrixXd rows(limbs - 1, limbs);
  for (Eigen::Index row = 0; row + 1 < limbs; ++row) {
    rows.row(row) = std::sqrt(values[row + 1]) * vectors.col(row + 1).transpose();
  }
  return rows;
}

}  // namespace

ResidualSpace::ResidualSpace(const ParallelChain& chain)
    : independent_(independent_rows(incidence_of(chain))),
      of_pairs_(incidence_of(chain) * linalg::pseudo_inverse(independent_)),
      of_limb_(chain.limbs.size()) {
  const std::size_t rows = 6 * (chain.limbs.size() - 1);
  const std::size_t joints = chain.passive_joints();
  dimensions_ = rows > joints ? rows - joints : 0;
  columns_.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(joints));
  for (Eigen::MatrixXd& of_limb : of_limb_) of_limb.resize(static_cast<Eigen::Index>(dimensions_), 6);
  delta_mu_.resize(6 * of_pairs_.rows(), static_cast<Eigen::Index>(dimensions_));
}

void ResidualSpace::prepare(const FirstOrder& first_order) {
  if (dimensions_ == 0) return;
  find_basis(first_order);
  for (std::size_t limb = 0; limb < of_limb_.size(); ++limb) {
    of_limb_[limb].setZero();
    for (Eigen::Index row = 0; row < independent_.rows(); ++row) {
      of_limb_[limb] += independent_(row, static_cast<Eigen::Index>(limb)) * basis_.middleRows<6>(6 * row).transpose();
    }
  }
  delta_mu_.setZero();
  for (Eigen::Index n = 0; n < of_pairs_.rows(); ++n) {
    for (Eigen::Index row = 0; row < of_pairs_.cols(); ++row) {
      delta_mu_.middleRows<6>(6 * n) += of_pairs_(n, row) * basis_.middleRows<6>(6 * row);
    }
  }
}

void ResidualSpace::find_basis(const FirstOrder& first_order) {
  for (Eigen::Index a = 0; a < columns_.cols(); ++a) {
    const lie::Screw<double>& column = first_order.column(static_cast<std::size_t>(a));
    const auto limb = static_cast<Eigen::Index>(first_order.limb_of_joint(static_cast<std::size_t>(a)));
    for (Eigen::Index row = 0; row < independent_.rows(); ++row) {
      columns_.col(a).segment<6>(6 * row) = independent_(row, limb) * column;
    }
  }
  basis_ = linalg::orthogonal_complement(columns_);
}

void ResidualSpace::add(const FirstOrder& first_order, const FrameEntry& entry, double error,
                        std::span<double> y) const {
  POESY_EXPECTS(y.size() == dimensions_);
  Eigen::Map<Eigen::VectorXd> sum(y.data(), static_cast<Eigen::Index>(y.size()));
  sum.noalias() += error * of_limb_[first_order.limb_of_frame(entry.frame)].lazyProduct(first_order.motion(entry));
}

void ResidualSpace::add(std::size_t limb, const lie::Screw<double>& motion, std::span<double> y) const {
  POESY_EXPECTS(y.size() == dimensions_);
  Eigen::Map<Eigen::VectorXd> sum(y.data(), static_cast<Eigen::Index>(y.size()));
  sum.noalias() += of_limb_[limb].lazyProduct(motion);
}

}  // namespace poesy::chain
