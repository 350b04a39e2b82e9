#pragma once

#include "models/chain/block_kernel_passes.h"

namespace poesy::chain {

template <class T, class Shape>
void BlockKernel<T, Shape>::move_platform(const KernelPlatform& platform) {
  if (platform.map != nullptr) {
    map_rows(*platform.map);
  } else {
    load_constant_segments();
    load_all();
  }
  for (std::size_t at = 0; at < samples_.count; at += kLanes) {
    finish_platform(platform, platform_motion(platform, at), at);
  }
}

/// The motion xi of the platform for one batch of samples. To first order, map_rows() has stored xi in memory_;
/// otherwise xi is the mean motion of the limbs at their solved displacements.
template <class T, class Shape>
auto BlockKernel<T, Shape>::platform_motion(const KernelPlatform& platform, std::size_t at) -> Screw {
  Screw sum;
  if (platform.map != nullptr) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum.w[k] = T::load(memory_ + k * capacity_ + at);
      sum.v[k] = T::load(memory_ + (k + 3) * capacity_ + at);
    }
    return sum;
  }
  Motion nominal;
  for (int k = 0; k < 9; ++k) nominal.r[k] = T(platform.nominal[k]);
  for (int k = 0; k < 3; ++k) nominal.p[k] = T(platform.nominal[9 + k]);
  for (std::size_t j = 0; j < joints(); ++j) joint_[j] = T::load(platform.displacements + j * outcome_.stride + at);
  vary_segments(at, chain_.segments);
  for (int k = 0; k < 3; ++k) sum.w[k] = sum.v[k] = T(0.0);
  for (std::size_t i = 0; i < limbs(); ++i) {
    limb_pose(i, pose_[i]);
    const Screw own = log(kernel::divide(pose_[i], nominal));
    for (int k = 0; k < 3; ++k) {
      sum.w[k] = sum.w[k] + own.w[k];
      sum.v[k] = sum.v[k] + own.v[k];
    }
  }
  const T share(1.0 / static_cast<double>(limbs()));
  for (int k = 0; k < 3; ++k) {
    sum.w[k] = share * sum.w[k];
    sum.v[k] = share * sum.v[k];
  }
  return sum;
}

/// Computes the displacement D p - p = V (w x p + v) of a point p by the motion D = exp([w; v]), and its length. V = 1
/// + b hat(w) + c hat(w)^2 is the left Jacobian; to first order V = 1. rows: address for the x components of this
/// batch; those of y and z follow at distances of one stride.
template <class T, class Shape>
void BlockKernel<T, Shape>::displace(const Screw& motion, const double* point, bool is_linear, double* rows,
                                     double* length) const {
  const T p[3] = {T(point[0]), T(point[1]), T(point[2])};
  T d[3] = {motion.v[0], motion.v[1], motion.v[2]};
  kernel::add_cross(motion.w, p, d);
  if (!is_linear) {
    const auto [b, c] = simd::left_jacobian_coefficients(kernel::dot3(motion.w, motion.w));
    T once[3], twice[3];
    kernel::cross(motion.w, d, once);
    kernel::cross(motion.w, once, twice);
    for (int k = 0; k < 3; ++k) d[k] = madd(c, twice[k], madd(b, once[k], d[k]));
  }
  for (std::size_t k = 0; k < 3; ++k) d[k].store(rows + k * outcome_.stride);
  sqrt(kernel::dot3(d, d)).store(length);
}

template <class T, class Shape>
void BlockKernel<T, Shape>::finish_platform(const KernelPlatform& platform, const Screw& motion, std::size_t at) const {
  const auto row = [&](std::size_t n) { return platform.responses + n * outcome_.stride + at; };
  const bool is_linear = platform.map != nullptr;
  displace(motion, platform.nominal + 9, is_linear, row(0), row(6));
  for (std::size_t k = 0; k < 3; ++k) motion.w[k].store(row(3 + k));
  sqrt(kernel::dot3(motion.w, motion.w)).store(row(7));
  if (platform.has_tool) displace(motion, platform.tool, is_linear, row(8), row(11));
}

}  // namespace poesy::chain
