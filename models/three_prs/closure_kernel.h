#pragma once

#include "models/three_prs/closure_kernel_equations.h"
#include "models/three_prs/first_order_kernel.h"

namespace poesy::three_prs {

template <class T>
void ClosureKernel<T>::begin(std::size_t g) {
  Group& group = group_[g];
  for (int k = 0; k < 9; ++k) group.E[k] = T(k % 4 == 0 ? 1.0 : 0.0);
  for (int k = 0; k < 3; ++k) group.dr[k] = T(0.0);
  T step[6];
  const Mask taken = first_step(group, step);
  move(group, step, taken);
  group.smallest = T(__builtin_inf());
  group.active = select(taken, T(1.0), T(0.0));
  end(g, kAllLanes, SolveStatus::non_finite, 0);
}

template <class T>
void ClosureKernel<T>::move(Group& group, const T* step, Mask lanes) const {
  const T angle2 = simd::dot3(step, step);
  T r[9], E[9];
  simd::rotation_matrix(step, angle2, simd::exp_coefficients(angle2), r);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      E[3 * row + column] = madd(r[3 * row + 2], group.E[6 + column],
                                 madd(r[3 * row + 1], group.E[3 + column], r[3 * row] * group.E[column]));
    }
  }
  for (int k = 0; k < 9; ++k) group.E[k] = select(lanes, E[k], group.E[k]);
  for (int k = 0; k < 3; ++k) group.dr[k] = select(lanes, group.dr[k] + step[3 + k], group.dr[k]);
}

/// One iteration of a group. Returns whether any of its lanes goes on.
template <class T>
bool ClosureKernel<T>::round(std::size_t g, std::uint32_t iteration) {
  Group& group = group_[g];
  T step[6];
  const Mask taken = (group.active > T(0.5)) & newton_step(group, step);
  move(group, step, taken);
  T change = abs(step[0]);
  for (int k = 1; k < 6; ++k) change = max(change, abs(step[k]));
  const Mask converged = taken & (change < T(options_.tolerance));
  const Mask falling = (change > T(options_.rounding)) | (change < group.smallest);
  const Mask on = taken & !(converged | !falling);
  const Mask stagnated = taken & !(converged | falling);
  group.smallest = min(group.smallest, change);
  group.active = select(on, T(1.0), T(0.0));
  end(g, bits(converged), SolveStatus::converged, iteration);
  end(g, bits(stagnated), SolveStatus::stagnated, iteration);
  return any(on);
}

template <class T>
void ClosureKernel<T>::end(std::size_t g, unsigned lanes, SolveStatus status, std::uint32_t iterations) const {
  if (lanes == 0) return;
  for (std::size_t lane = 0; lane < kLanes && g * kLanes + lane < tile_.count; ++lane) {
    if ((lanes >> lane & 1u) == 0) continue;
    tile_.status[g * kLanes + lane] = status;
    tile_.iterations[g * kLanes + lane] = iterations;
  }
}

template <class T>
void ClosureKernel<T>::store(std::size_t g) {
  const Group& group = group_[g];
  const auto log = simd::rotation_log(group.E);
  const T tool[3] = {T(pose_.tool[0]), T(pose_.tool[1]), T(pose_.tool[2])};
  T vectors[kVectorRows];
  for (int k = 0; k < 3; ++k) {
    vectors[k] = log.w[k];
    vectors[3 + k] = group.dr[k];
    vectors[6 + k] = group.dr[k] + (simd::dot3(group.E + 3 * k, tool) - tool[k]);
  }
  store_responses(vectors, tile_, g * kLanes);
  const Mask wide = !(group.E[0] + group.E[4] + group.E[8] > T(0.0));
  end(g, bits(wide), SolveStatus::non_finite, 0);
}

template <class T>
std::size_t ClosureKernel<T>::solve() {
  const std::size_t groups = (tile_.count + kLanes - 1) / kLanes;
  for (std::size_t i = 0; i < kLimbs; ++i) {
    for (std::size_t g = 0; g < groups; ++g) {
      const bool known = g > 0 && !pose_.limb[i].varies;
      group_[g].limb[i] = known ? group_[0].limb[i] : limb_with_errors(pose_.limb[i], g * kLanes);
    }
  }
  std::size_t live[kTile];
  for (std::size_t g = 0; g < groups; ++g) {
    begin(g);
    live[g] = g;
  }
  std::size_t left = groups;
  for (std::uint32_t iteration = 1; iteration <= options_.max_iterations && left > 0; ++iteration) {
    std::size_t kept = 0;
    for (std::size_t n = 0; n < left; ++n) {
      if (round(live[n], iteration)) live[kept++] = live[n];
    }
    left = kept;
  }
  for (std::size_t n = 0; n < left; ++n) {
    end(live[n], bits(group_[live[n]].active > T(0.5)), SolveStatus::iteration_cap, options_.max_iterations);
  }
  for (std::size_t g = 0; g < groups; ++g) store(g);
  std::size_t given_up = 0;
  for (std::size_t b = 0; b < tile_.count; ++b) given_up += tile_.iterations[b] == 0 ? 1 : 0;
  return given_up;
}

template <class T>
std::size_t close_tile(const ClosurePose& pose, const ClosureOptions& options, const Tile& tile, double* scratch) {
  return ClosureKernel<T>(pose, options, tile, scratch).solve();
}

}  // namespace poesy::three_prs
