#pragma once

#include "models/chain/block_kernel_equations.h"

namespace poesy::chain {

/// Leaves in mu_ what joints could take away of kept_ at nominal displacements: J0 N0^-1 J0^T W kept.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::part_of_joints() {
  const auto column = [&](std::size_t a) {
    Screw screw;
    for (std::size_t k = 0; k < 3; ++k) {
      screw.w[k] = T(start_.columns[6 * a + k]);
      screw.v[k] = T(start_.columns[6 * a + k + 3]);
    }
    return screw;
  };
  gradient();
  for (std::size_t i = 0; i < limbs(); ++i) {
    for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) f_[a] = kernel::dot(column(a), pull_[i]);
  }
  for (std::size_t i = 0; i < limbs(); ++i) {
    Screw& motion = pull_[i];
    for (int k = 0; k < 3; ++k) motion.w[k] = motion.v[k] = T(0.0);
    for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
      T x(0.0);
      for (std::size_t b = 0; b < joints(); ++b) x = madd(T(start_.inverse[a * joints() + b]), f_[b], x);
      kernel::subtract(-x, column(a), motion);
    }
  }
  for (std::size_t n = 0; n < pairs(); ++n) {
    for (int k = 0; k < 3; ++k) {
      mu_[n].w[k] = pull_[chain_.pair[n].i].w[k] - pull_[chain_.pair[n].k].w[k];
      mu_[n].v[k] = pull_[chain_.pair[n].i].v[k] - pull_[chain_.pair[n].k].v[k];
    }
  }
}

/// Where N - 4 C is positive definite for the part of the residual that joints could take away.
template <class T, class Shape, class Measure>
typename T::MaskType BlockKernel<T, Shape, Measure>::closes() {
  if (start_.columns == nullptr) return T(1.0) < T(0.0);
  for (std::size_t n = 0; n < pairs(); ++n) kept_[n] = mu_[n];
  part_of_joints();
  gradient();
  newton_matrix();
  for (std::size_t n = 0; n < pairs(); ++n) mu_[n] = kept_[n];
  return is_positive(5.0, 4.0);
}

/// Which of these lanes, that have converged, are doubted.
template <class T, class Shape, class Measure>
unsigned BlockKernel<T, Shape, Measure>::doubted(unsigned converged) {
  // Of the nodes of a fit it is enough that Gauss-Newton contracts.
  const unsigned unclear = options_.method == KernelMethod::newton_direct ? 0 : converged & ~clear_;
  if constexpr (Measure::kWeighted) return unclear;
  return unclear == 0 ? 0 : unclear & ~bits(closes());
}

}  // namespace poesy::chain
