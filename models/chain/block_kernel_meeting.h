#pragma once

#include "models/chain/block_kernel_passes.h"

namespace poesy::chain {

/// Where every limb's platform can be in one place, so that errors move the platform and deform nothing. With xi_i the
/// motion from the first limb's platform to that of limb i, a step x and the platform's motion X minimise
///     sum |xi_i + C_i x_i - X|_W^2,   C_i the columns of limb i's passive joints,
/// by a projection P_i = W - W C_i (C_i^T W C_i)^-1 C_i^T W for each limb, and 6 equations sum P_i X = sum P_i xi_i. At
/// the solution nothing is left, so that steps converge quadratically: one that is small enough is the last one.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::solve_meeting() {
  load_all();
  const std::uint32_t cap = options_.max_iterations;
  for (std::size_t at = 0; at < samples_.count; at += kLanes) {
    const std::size_t count = samples_.count - at;
    unsigned open = count < kLanes ? (1u << count) - 1u : (1u << kLanes) - 1u;
    start<KernelPass::direct>(at);
    for (std::uint32_t round = 0; open != 0; ++round) {
      const Verdict verdict = meeting_round();
      take_step(at, step_);
      for (std::size_t j = 0; j < joints(); ++j) joint_[j] = joint_[j] + step_[j];
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if ((open >> lane & 1u) == 0 || (!verdict.ended(lane) && round + 1 < cap)) continue;
        open &= ~(1u << lane);
        finish(at, lane, verdict.status(lane), round + 1);
      }
    }
  }
}

/// One step of all limbs, into step_. mu_ is what is left of the pairs, to first order.
template <class T, class Shape, class Measure>
auto BlockKernel<T, Shape, Measure>::meeting_round() -> Verdict {
  Meeting all;
  for (int row = 0; row < 6; ++row) {
    all.pull[row] = T(0.0);
    for (int column = 0; column <= row; ++column) all.matrix[row][column] = T(0.0);
  }
  for (std::size_t i = 0; i < limbs(); ++i) {
    limb_pose(i, pose_[i]);
    if (i == 0) {
      for (int k = 0; k < 3; ++k) pull_[0].w[k] = pull_[0].v[k] = T(0.0);
    } else {
      pull_[i] = log(kernel::divide(pose_[i], pose_[0]));
    }
    project_limb(i, all);
  }
  T motion[6];
  all.margin = min(all.margin, solve_platform(all, motion));
  T left2(0.0), length2(0.0);
  for (std::size_t i = 0; i < limbs(); ++i) step_limb(i, motion, left2, length2);
  const T scale(1.0 / chain_.reach);
  const T left = sqrt(select(left2 < T(0.0), T(0.0), left2)) * scale;
  const T length = sqrt(length2) * scale;
  const auto finite = (left < T(1e300)) & (length < T(1e300));
  Verdict verdict;
  verdict.non_finite = bits(!finite);
  verdict.singular = bits(!(all.margin > T(0.0)));
  verdict.converged = bits(finite & (length < T(options_.last_step)) & (left < T(kMet)));
  carry_residual_of_pairs();
  return verdict;
}

/// Adds P_i and P_i xi_i. Leaves the limb's factors: L of C^T W C = L L^T in m_, with 1 / diagonal in pivot_, the rows
/// y = L^-1 C^T W in row_ and the diagonal of C^T W C in gauss_newton_.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::project_limb(std::size_t i, Meeting& all) {
  const std::size_t size = joints();
  const double rounding = 4.0 * static_cast<double>(size) * 2.220446049250313e-16;
  for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
    Screw y = by_metric(column_[a]);
    T* l = m_ + a * size;
    T pivot(0.0);
    for (std::size_t b = first_joint(i); b <= a; ++b) {
      T sum = kernel::dot(y, column_[b]);
      for (std::size_t n = 0; n < chain_.idle_freedoms; ++n) {
        sum = sum + T(chain_.idle[n * size + a] * chain_.idle[n * size + b]);
      }
      for (std::size_t k = first_joint(i); k < b; ++k) sum = nmadd(l[k], m_[b * size + k], sum);
      if (b < a) {
        l[b] = sum * pivot_[b];
      } else {
        pivot = sum;
      }
    }
    gauss_newton_[a] = kernel::dot(y, column_[a]);
    all.margin = min(all.margin, nmadd(T(rounding), gauss_newton_[a], pivot));
    pivot_[a] = T(1.0) / sqrt(pivot);
    for (std::size_t k = first_joint(i); k < a; ++k) {
      for (int n = 0; n < 3; ++n) {
        y.w[n] = nmadd(l[k], rows_[k].w[n], y.w[n]);
        y.v[n] = nmadd(l[k], rows_[k].v[n], y.v[n]);
      }
    }
    for (int n = 0; n < 3; ++n) {
      rows_[a].w[n] = y.w[n] * pivot_[a];
      rows_[a].v[n] = y.v[n] * pivot_[a];
    }
  }
  const Screw weighed = by_metric(pull_[i]);
  for (int row = 0; row < 6; ++row) {
    all.pull[row] = all.pull[row] + (row < 3 ? weighed.w[row] : weighed.v[row - 3]);
    for (int column = 0; column <= row; ++column)
      all.matrix[row][column] = all.matrix[row][column] + weight(row, column);
  }
  for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
    const T along = kernel::dot(rows_[a], pull_[i]);
    const T y[6] = {rows_[a].w[0], rows_[a].w[1], rows_[a].w[2], rows_[a].v[0], rows_[a].v[1], rows_[a].v[2]};
    for (int row = 0; row < 6; ++row) {
      all.pull[row] = nmadd(y[row], along, all.pull[row]);
      for (int column = 0; column <= row; ++column) {
        all.matrix[row][column] = nmadd(y[row], y[column], all.matrix[row][column]);
      }
    }
  }
}

/// The platform's motion; returns by how much the smallest pivot is above rounding.
template <class T, class Shape, class Measure>
T BlockKernel<T, Shape, Measure>::solve_platform(Meeting& all, T* motion) const {
  constexpr double kRounding = 1e-13;
  T margin(1.0);
  T inverse[6];
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column <= row; ++column) {
      T sum = all.matrix[row][column];
      for (int k = 0; k < column; ++k) sum = nmadd(all.matrix[row][k], all.matrix[column][k], sum);
      if (column < row) {
        all.matrix[row][column] = sum * inverse[column];
      } else {
        margin = min(margin, nmadd(T(kRounding), weight(row, row), sum));
        inverse[row] = T(1.0) / sqrt(sum);
      }
    }
    T value = all.pull[row];
    for (int k = 0; k < row; ++k) value = nmadd(all.matrix[row][k], motion[k], value);
    motion[row] = value * inverse[row];
  }
  for (int row = 6; row-- > 0;) {
    T value = motion[row];
    for (int k = row + 1; k < 6; ++k) value = nmadd(all.matrix[k][row], motion[k], value);
    motion[row] = value * inverse[row];
  }
  return margin;
}

/// The limb's step, the square of what it leaves, added, and of its length.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::step_limb(std::size_t i, const T* motion, T& left2, T& length2) {
  const std::size_t size = joints();
  Screw& apart = pull_[i];
  for (int k = 0; k < 3; ++k) {
    apart.w[k] = motion[k] - apart.w[k];
    apart.v[k] = motion[k + 3] - apart.v[k];
  }
  left2 = left2 + kernel::dot(apart, by_metric(apart));
  for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
    step_[a] = kernel::dot(rows_[a], apart);
    left2 = nmadd(step_[a], step_[a], left2);
  }
  for (std::size_t a = first_joint(i + 1); a-- > first_joint(i);) {
    T value = step_[a];
    for (std::size_t b = a + 1; b < first_joint(i + 1); ++b) value = nmadd(m_[b * size + a], step_[b], value);
    step_[a] = value * pivot_[a];
    length2 = max(length2, step_[a] * step_[a] * gauss_newton_[a]);
    for (int k = 0; k < 3; ++k) {
      apart.w[k] = nmadd(step_[a], column_[a].w[k], apart.w[k]);
      apart.v[k] = nmadd(step_[a], column_[a].v[k], apart.v[k]);
    }
  }
}

/// What the steps leave of each pair's residual, to first order.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::carry_residual_of_pairs() {
  for (std::size_t n = 0; n < pairs(); ++n) {
    const Screw& of_k = pull_[chain_.pair[n].k];
    const Screw& of_i = pull_[chain_.pair[n].i];
    for (int k = 0; k < 3; ++k) {
      mu_[n].w[k] = of_i.w[k] - of_k.w[k];
      mu_[n].v[k] = of_i.v[k] - of_k.v[k];
    }
  }
}

/// W x screw, or the screw itself as published.
template <class T, class Shape, class Measure>
auto BlockKernel<T, Shape, Measure>::by_metric(const Screw& screw) const -> Screw {
  if constexpr (Measure::kWeighted) return weighted(screw);
  return screw;
}

/// An entry of W.
template <class T, class Shape, class Measure>
T BlockKernel<T, Shape, Measure>::weight(int row, int column) const {
  if constexpr (Measure::kWeighted) return T(chain_.metric[6 * row + column]);
  return T(row == column ? 1.0 : 0.0);
}

}  // namespace poesy::chain
