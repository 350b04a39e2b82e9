#pragma once

#include "models/chain/block_kernel_passes.h"

namespace poesy::chain {

/// Solves a chain whose limbs can all hold the platform in one pose, so that errors move the platform and deform
/// nothing. With xi_i the motion from the first limb's platform to that of limb i, a step x and the platform's motion X
/// minimise
///     sum |xi_i + C_i x_i - X|^2,   C_i the columns of limb i's passive joints,
/// by a projection P_i = 1 - C_i (C_i^T C_i)^-1 C_i^T for each limb, and 6 equations sum P_i X = sum P_i xi_i. Screws
/// are measured by the motion of the platform's points (see measured()). At the solution the minimum is zero, so that
/// steps converge quadratically with new projections. Projections are computed in every fourth round and used in four.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::solve_meeting() {
  load_all();
  const std::uint32_t cap = options_.max_iterations;
  Meeting meeting;
  for (std::size_t at = 0; at < samples_.count; at += kLanes) {
    const std::size_t count = samples_.count - at;
    unsigned open = count < kLanes ? (1u << count) - 1u : (1u << kLanes) - 1u;
    start<KernelPass::direct>(at);
    for (std::uint32_t round = 0; open != 0; ++round) {
      const Verdict verdict = round % kMatrixRounds == 0 ? meeting_round<true>(meeting) : meeting_round<false>(meeting);
      advance(at);
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if ((open >> lane & 1u) == 0 || (!verdict.ended(lane) && round + 1 < cap)) continue;
        open &= ~(1u << lane);
        finish(at, lane, verdict.status(lane), round + 1);
      }
    }
  }
}

/// Writes one step of all limbs to step_, with new projections or with those of an earlier round.
template <class T, class Shape, class Measure>
template <bool is_new>
auto BlockKernel<T, Shape, Measure>::meeting_round(Meeting& meeting) -> Verdict {
  T pull[6];
  for (int row = 0; row < 6; ++row) {
    pull[row] = T(0.0);
    for (int column = 0; is_new && column <= row; ++column) meeting.matrix[row][column] = T(0.0);
  }
  if constexpr (is_new) meeting.margin = T(1.0);
  for (std::size_t i = 0; i < limbs(); ++i) {
    limb_pose<is_new>(i, pose_[i]);
    if constexpr (is_new) project_limb(i, meeting);
    if (i == 0) {
      for (int k = 0; k < 3; ++k) pull_[0].w[k] = pull_[0].v[k] = T(0.0);
    } else {
      pull_[i] = measured(log(kernel::divide(pose_[i], pose_[0])));
      add_pull(i, pull);
    }
  }
  if constexpr (is_new) factor_platform(meeting);
  Screw motion;
  solve_platform(meeting, pull, motion);
  T left2(0.0), length2(0.0);
  for (std::size_t i = 0; i < limbs(); ++i) step_limb(i, motion, left2, length2);
  const T scale(1.0 / chain_.reach);
  const T left = sqrt(left2) * scale;
  const T length = sqrt(length2) * scale;
  const auto finite = (left < T(1e300)) & (length < T(1e300));
  auto small = length < T(options_.last_step);
  if constexpr (!is_new) small = small & (length * length < T(0.01 * options_.tolerance) * meeting.length);
  meeting.length = length;
  Verdict verdict;
  verdict.non_finite = bits(!finite);
  verdict.singular = bits(!(meeting.margin > T(0.0)));
  verdict.converged = bits(finite & small & (left < T(kMet)));
  return verdict;
}

/// Adds the limb's projection. Stores its factors: C, measured, in row_; L of C^T C = L L^T in m_, with 1 / diagonal in
/// pivot_; the rows y = L^-1 C^T in rows_; and the diagonal of C^T C in gauss_newton_.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::project_limb(std::size_t i, Meeting& meeting) {
  const std::size_t size = joints();
  const std::size_t first = first_joint(i), end = first_joint(i + 1);
  const double rounding = 4.0 * static_cast<double>(size) * 2.220446049250313e-16;
  T* const factor = limb_factor(i);
  for (std::size_t a = first; a < end; ++a) {
    Screw y = row_[a] = measured(column_[a]);
    T* l = factor + (a - first) * (end - first) - first;
    T pivot(0.0);
    for (std::size_t b = first; b <= a; ++b) {
      T sum = kernel::dot(y, row_[b]);
      for (std::size_t n = 0; n < chain_.idle_freedoms; ++n) {
        sum = sum + T(chain_.idle[n * size + a] * chain_.idle[n * size + b]);
      }
      const T* of_b = factor + (b - first) * (end - first) - first;
      for (std::size_t k = first; k < b; ++k) sum = nmadd(l[k], of_b[k], sum);
      if (b < a) {
        l[b] = sum * pivot_[b];
      } else {
        pivot = sum;
      }
    }
    gauss_newton_[a] = kernel::dot(y, y);
    meeting.margin = min(meeting.margin, nmadd(T(rounding), gauss_newton_[a], pivot));
    pivot_[a] = T(1.0) / sqrt(pivot);
    for (std::size_t k = first; k < a; ++k) kernel::subtract(l[k], rows_[k], y);
    T entry[6];
    for (int n = 0; n < 3; ++n) {
      entry[n] = rows_[a].w[n] = y.w[n] * pivot_[a];
      entry[n + 3] = rows_[a].v[n] = y.v[n] * pivot_[a];
    }
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column <= row; ++column) {
        meeting.matrix[row][column] = nmadd(entry[row], entry[column], meeting.matrix[row][column]);
      }
    }
  }
}

/// The place of the limb's factor L in m_, by rows.
template <class T, class Shape, class Measure>
T* BlockKernel<T, Shape, Measure>::limb_factor(std::size_t i) const {
  std::size_t before = 0;
  for (std::size_t n = 0; n < i; ++n)
    before += (first_joint(n + 1) - first_joint(n)) * (first_joint(n + 1) - first_joint(n));
  return m_ + before;
}

/// Adds P_i xi_i to pull.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::add_pull(std::size_t i, T* pull) const {
  Screw rest = pull_[i];
  for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
    kernel::subtract(kernel::dot(rows_[a], pull_[i]), rows_[a], rest);
  }
  for (int n = 0; n < 3; ++n) {
    pull[n] = pull[n] + rest.w[n];
    pull[n + 3] = pull[n + 3] + rest.v[n];
  }
}

/// Replaces the sum of P_i by its factor L, L L^T.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::factor_platform(Meeting& meeting) const {
  constexpr double kRounding = 1e-13;
  auto& matrix = meeting.matrix;
  for (int row = 0; row < 6; ++row) {
    matrix[row][row] = matrix[row][row] + T(static_cast<double>(limbs()));
    for (int column = 0; column <= row; ++column) {
      T sum = matrix[row][column];
      for (int k = 0; k < column; ++k) sum = nmadd(matrix[row][k], matrix[column][k], sum);
      if (column < row) {
        matrix[row][column] = sum * meeting.pivot[column];
      } else {
        meeting.margin = min(meeting.margin, sum - T(kRounding));
        meeting.pivot[row] = T(1.0) / sqrt(sum);
      }
    }
  }
}

/// Solves for the platform's motion X, measured.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::solve_platform(const Meeting& meeting, const T* pull, Screw& motion) const {
  T x[6];
  for (int row = 0; row < 6; ++row) {
    T value = pull[row];
    for (int k = 0; k < row; ++k) value = nmadd(meeting.matrix[row][k], x[k], value);
    x[row] = value * meeting.pivot[row];
  }
  for (int row = 6; row-- > 0;) {
    T value = x[row];
    for (int k = row + 1; k < 6; ++k) value = nmadd(meeting.matrix[k][row], x[k], value);
    x[row] = value * meeting.pivot[row];
  }
  for (int k = 0; k < 3; ++k) {
    motion.w[k] = x[k];
    motion.v[k] = x[k + 3];
  }
}

/// Computes the step of a limb. Adds the square of the remaining residual to left2; raises length2 to the square of the
/// step's length.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::step_limb(std::size_t i, const Screw& motion, T& left2, T& length2) {
  const std::size_t first = first_joint(i), end = first_joint(i + 1);
  Screw apart;
  for (int k = 0; k < 3; ++k) {
    apart.w[k] = motion.w[k] - pull_[i].w[k];
    apart.v[k] = motion.v[k] - pull_[i].v[k];
  }
  Screw rest = apart;
  const T* factor = limb_factor(i);
  for (std::size_t a = first; a < end; ++a) {
    step_[a] = kernel::dot(rows_[a], apart);
    kernel::subtract(step_[a], rows_[a], rest);
  }
  left2 = left2 + kernel::dot(rest, rest);
  for (std::size_t a = end; a-- > first;) {
    T value = step_[a];
    for (std::size_t b = a + 1; b < end; ++b) {
      value = nmadd(factor[(b - first) * (end - first) + (a - first)], step_[b], value);
    }
    step_[a] = value * pivot_[a];
    length2 = max(length2, step_[a] * step_[a] * gauss_newton_[a]);
  }
}

/// A screw in coordinates with the square x^T W x: the displacement of the middle of the platform's points, and the
/// rotation times U, where U^T U is the moment of the points about the middle. With the published weight, the screw
/// itself.
template <class T, class Shape, class Measure>
auto BlockKernel<T, Shape, Measure>::measured(const Screw& screw) const -> Screw {
  if constexpr (!Measure::kWeighted) return screw;
  const T middle[3] = {T(chain_.middle[0]), T(chain_.middle[1]), T(chain_.middle[2])};
  Screw moved = screw;
  kernel::add_cross(screw.w, middle, moved.v);
  const double* U = chain_.spread;
  moved.w[0] = madd(T(U[2]), screw.w[2], madd(T(U[1]), screw.w[1], T(U[0]) * screw.w[0]));
  moved.w[1] = madd(T(U[4]), screw.w[2], T(U[3]) * screw.w[1]);
  moved.w[2] = T(U[5]) * screw.w[2];
  return moved;
}

}  // namespace poesy::chain
