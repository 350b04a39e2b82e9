#include "models/assembly/loops.h"

#include <cmath>
#include <limits>

#include "engine/linalg/decompositions.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

Index index(std::size_t value) { return static_cast<Index>(value); }

/// [limbs + 1] The index of each limb's first passive joint among all passive joints, then the number of all passive
/// joints.
std::vector<Index> first_passive(std::span<const LimbState> limbs) {
  std::vector<Index> first{0};
  for (const LimbState& limb : limbs) first.push_back(first.back() + limb.passive.cols());
  return first;
}

/// A motion that moves an end of a limb: a column of the matrix B, and the index of its unknown in x.
struct Mover {
  enum class What { from, joint, to };
  What what;
  Index at;     ///< index in x
  Screw twist;  ///< twist; in B (see Loops) with the sign + if `what` is `to`, else -
};

std::vector<Mover> movers(const Limb& limb, const LimbState& state, Index first_joint, Index joints) {
  std::vector<Mover> list;
  const auto add_body = [&](std::size_t body, Mover::What what) {
    for (Index k = 0; body != kBase && k < 6; ++k) {
      list.push_back({what, joints + 6 * index(body - 1) + k, Screw::Unit(k)});
    }
  };
  add_body(limb.from, Mover::What::from);
  for (Index k = 0; k < state.passive.cols(); ++k) {
    list.push_back({Mover::What::joint, first_joint + k, state.passive.col(k)});
  }
  add_body(limb.to, Mover::What::to);
  return list;
}

/// The slopes of ln det N with respect to the errors of one limb's frames, if bodies and joints do not follow the
/// errors. A motion m in front of a joint changes the joint's column c by the bracket [m, c]. pulls: [6 x passive
/// joints], one wrench for each column c; the change of ln det N is the sum of the products of these wrenches with the
/// changes of their columns.
std::vector<Screw> slopes_in_front(const Limb& limb, const LimbState& state, const Matrix& pulls) {
  std::vector<Screw> slopes(limb.chain.frames(), Screw::Zero());
  Index k = state.passive.cols();
  for (std::size_t j = limb.chain.joints.size(); j-- > 0;) {
    slopes[j] = slopes[j + 1];
    if (limb.chain.joints[j].actuated) continue;
    --k;
    slopes[j] += lie::wrench_of_bracket(Screw(pulls.col(k)), Screw(state.passive.col(k)));
  }
  return slopes;
}

}  // namespace

Loops::Loops(const Assembly& assembly, const Nominal& pose, std::size_t idle)
    : assembly_(&assembly), pose_(&pose), root_(linalg::cholesky_root(pose.W)) {
  const Matrix B = motion_columns(assembly, pose.limbs, root_);
  const Vector scale = B.colwise().norm().cwiseInverse();
  const Matrix scaled = B * scale.asDiagonal();
  const linalg::EigenDecomposition split = linalg::eigen_decomposition(scaled.transpose() * scaled);
  const Index count = B.cols() - index(idle);
  const Vector values = split.values.tail(count);
  const double rounding = static_cast<double>(B.cols()) * std::numeric_limits<double>::epsilon();
  is_regular_ = values[0] > rounding * values[count - 1];
  motions_ = scale.asDiagonal() * split.vectors.rightCols(count) * values.cwiseSqrt().cwiseInverse().asDiagonal();
  weighed_ = B * motions_;
}

Vector Loops::taken_away(const Vector& mismatch) const { return weighed_ * (weighed_.transpose() * mismatch); }

/// Computes the slopes from d ln det N = trace(N^-1 dN) = 2 trace(N^-1 B^T W dB). The column of each joint contributes
/// one term.
std::vector<std::vector<Screw>> Loops::determinant_slopes() const {
  const std::size_t limbs = pose_->limbs.size();
  const std::vector<Index> first = first_passive(pose_->limbs);
  const Matrix pull = -2.0 * weighed_ * motions_.topRows(first.back()).transpose();  // [6 limbs x passive joints]
  std::vector<std::vector<Screw>> slopes;
  Vector by_motion = Vector::Zero(motions_.rows());  // slope of ln det N with respect to each unknown in x
  for (std::size_t e = 0; e < limbs; ++e) {
    const Limb& limb = assembly_->limbs[e];
    const LimbState& state = pose_->limbs[e];
    const Matrix of_limb = root_.transpose() * pull.block(6 * index(e), first[e], 6, state.passive.cols());
    slopes.push_back(slopes_in_front(limb, state, of_limb));
    Index k = 0;
    for (std::size_t j = 0; j < limb.chain.joints.size(); ++j) {
      if (!limb.chain.joints[j].actuated) {
        by_motion[first[e] + k] = slopes[e][j + 1].dot(state.passive.col(k));
        ++k;
      }
    }
    if (limb.from != kBase) by_motion.segment<6>(first.back() + 6 * index(limb.from - 1)) += slopes[e][0];
  }
  // Errors move the limbs' ends by the twists G. Bodies and joints follow by x = N^-1 B^T W G.
  const Vector given_way = weighed_ * (motions_.transpose() * by_motion);
  for (std::size_t e = 0; e < limbs; ++e) {
    for (Screw& slope : slopes[e]) slope += root_.transpose() * given_way.segment<6>(6 * index(e));
  }
  return slopes;
}

Matrix bend(const Assembly& assembly, std::span<const LimbState> limbs, std::span<const Screw> r, const Matrix6& W) {
  const std::vector<Index> first = first_passive(limbs);
  const Index size = first.back() + 6 * index(assembly.bodies.size() - 1);
  Matrix C = Matrix::Zero(size, size);
  for (std::size_t e = 0; e < limbs.size(); ++e) {
    const Screw pull = W * r[e];
    const std::vector<Mover> of_limb = movers(assembly.limbs[e], limbs[e], first[e], first.back());
    for (std::size_t n = 0; n < of_limb.size(); ++n) {
      const Mover& l = of_limb[n];
      const bool ends = l.what == Mover::What::to;
      // The motion l changes the mismatch xi by -(column of B) - beyond, where `beyond` (here multiplied by W) comes
      // from the inverse Jacobians of the logarithm.
      const Screw once = lie::bracket(r[e], l.twist);
      const Screw beyond = W * Screw(0.5 * once + (ends ? 1.0 : -1.0) / 12.0 * lie::bracket(r[e], once));
      for (std::size_t m = 0; m < of_limb.size(); ++m) {
        const Mover& k = of_limb[m];
        double entry = (k.what == Mover::What::to ? 1.0 : -1.0) * k.twist.dot(beyond);
        if (k.what == Mover::What::joint && n < m) entry += lie::bracket(l.twist, k.twist).dot(pull);
        C(k.at, l.at) += entry;
      }
    }
  }
  return 0.5 * (C + C.transpose());
}

}  // namespace poesy::assembly
