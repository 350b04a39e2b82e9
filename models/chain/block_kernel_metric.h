#pragma once

#include "models/chain/block_kernel_equations.h"

namespace poesy::chain {

template <class T, class Shape, class Measure>
template <bool newton>
void BlockKernel<T, Shape, Measure>::solve_by_metric() {
  load_all();
  for (std::size_t at = 0; at < samples_.count; at += kLanes) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) flat_[at + lane] = 0.0;
    if constexpr (newton) {
      predict(at);
    } else {
      for (std::size_t j = 0; j < joints(); ++j) T(chain_.joint[j].nominal).store(q_ + j * capacity_ + at);
    }
  }
  for (std::size_t at = 0; at < samples_.count; at += kLanes) iterate<newton>(at);
}

/// A batch until its last lane is done. Those that are done earlier go on, and what becomes of them is not kept.
template <class T, class Shape, class Measure>
template <bool newton>
void BlockKernel<T, Shape, Measure>::iterate(std::size_t at) {
  for (std::size_t j = 0; j < joints(); ++j) joint_[j] = T::load(q_ + j * capacity_ + at);
  vary_segments(at);
  const std::size_t left = samples_.count - at;
  unsigned open = left < kLanes ? (1u << left) - 1u : (1u << kLanes) - 1u;
  if (newton && start_.fits > 0 && start_.inverse != nullptr) open = finish_fitted(at, open);
  // Gauss-Newton looks at the residual after the last step, too.
  const std::uint32_t rounds = options_.max_iterations + (newton ? 0 : 1);
  T before(0.0);
  auto safe = T(1.0) < T(0.0);
  for (std::uint32_t round = 0; open != 0; ++round) {
    residuals();
    gradient();
    Verdict verdict;
    if constexpr (newton) {
      verdict = newton_by_metric(at, round, before, safe);
    } else {
      verdict = gauss_newton_by_metric(at, round);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const bool is_open = (open >> lane & 1u) != 0;
      if (!is_open || (!verdict.ended(lane) && round + 1 < rounds)) continue;
      finish(at, lane, verdict.status(lane), round + (newton ? 1 : 0));
      open &= ~(1u << lane);
    }
  }
}

/// A fit is mostly exact to rounding: a step with the matrix at nominal displacements shows it. Finishes lanes where it
/// is, and returns those that are left.
template <class T, class Shape, class Measure>
unsigned BlockKernel<T, Shape, Measure>::finish_fitted(std::size_t at, unsigned open) {
  residuals();
  gradient();
  for (std::size_t a = 0; a < joints(); ++a) {
    T sum(0.0);
    for (std::size_t b = 0; b < joints(); ++b) sum = madd(T(start_.inverse[a * joints() + b]), f_[b], sum);
    step_[a] = sum;
  }
  const T length = step_length([&](std::size_t a) { return T(start_.diagonal[a]); });
  const auto there = finite_residual() & (length < T(10.0 * options_.tolerance));
  if (!any(there)) return open;
  carry_residual(step_, there);
  const unsigned ended = bits(there) & open;
  for (std::size_t j = 0; j < joints(); ++j) (joint_[j] + step_[j]).store(q_ + j * capacity_ + at);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if ((ended >> lane & 1u) != 0) finish(at, lane, SolveStatus::converged, 1);
  }
  return open & ~ended;
}

/// One round. before: the length of the last step; safe: where the matrix at hand is. Both are of this batch.
template <class T, class Shape, class Measure>
auto BlockKernel<T, Shape, Measure>::newton_by_metric(std::size_t at, std::uint32_t round, T& before,
                                                      typename T::MaskType& safe) -> Verdict {
  Verdict verdict;
  const auto finite = finite_residual();
  const bool is_new = round % kMatrixRounds == 0;
  if (is_new) {
    weigh();
    gauss_newton_matrix();
    newton_matrix();
    safe = newton_step(step_);
    if (any(!safe)) {
      verdict.singular = bits((!safe) & (!gauss_newton_step(gauss_newton_)));
      for (std::size_t j = 0; j < joints(); ++j) step_[j] = select(safe, step_[j], gauss_newton_[j]);
    }
  } else {
    newton_step_again(step_);
    for (std::size_t j = 0; j < joints(); ++j) step_[j] = select(safe, step_[j], T(0.0));
  }
  const T length = step_length([&](std::size_t a) { return n_[a * joints() + a]; });
  auto small = length * length < T(0.1 * options_.tolerance) * before;
  if (is_new) small = small | (length < T(options_.last_step));
  const auto converged = safe & finite & small;
  before = length;
  verdict.converged = bits(converged);
  verdict.non_finite = bits(!finite);
  take_step(at, step_);
  if (any(converged)) carry_residual(step_, converged);
  for (std::size_t j = 0; j < joints(); ++j) joint_[j] = joint_[j] + step_[j];
  return verdict;
}

template <class T, class Shape, class Measure>
auto BlockKernel<T, Shape, Measure>::gauss_newton_by_metric(std::size_t at, std::uint32_t round) -> Verdict {
  T change2(0.0);
  for (std::size_t n = 0; n < pairs(); ++n) {
    Screw change;
    for (int k = 0; k < 3; ++k) {
      double* w = memory_ + (6 * n + static_cast<std::size_t>(k)) * capacity_ + at;
      double* v = w + 3 * capacity_;
      change.w[k] = mu_[n].w[k] - T::load(w);
      change.v[k] = mu_[n].v[k] - T::load(v);
      mu_[n].w[k].store(w);
      mu_[n].v[k].store(v);
    }
    change2 = change2 + kernel::dot(change, weighted(change));
  }
  Verdict verdict;
  verdict.non_finite = bits(!finite_residual());
  if (round > 0) {
    const T change = sqrt(change2 * T(1.0 / static_cast<double>(pairs()))) * T(1.0 / chain_.reach);
    verdict.converged = bits(change < T(options_.tolerance));
    verdict.stagnated = bits(!(change > T(options_.rounding_level)));
  }
  if (round == options_.max_iterations) return verdict;
  weigh();
  gauss_newton_matrix();
  verdict.singular = bits(!gauss_newton_step(step_));
  take_step(at, step_);
  for (std::size_t j = 0; j < joints(); ++j) joint_[j] = joint_[j] + step_[j];
  return verdict;
}

/// Root mean squares over the pairs: of |delta_mu|_W, of the angle, and of the displacement at the platform's origin.
template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::judge_by_metric(std::size_t at) {
  const T origin[3] = {T(chain_.origin[0]), T(chain_.origin[1]), T(chain_.origin[2])};
  T gap2(0.0), angular2(0.0), linear2(0.0);
  for (std::size_t n = 0; n < pairs(); ++n) {
    const double* rows = outcome_.delta_mu + 6 * n * outcome_.stride + at;
    Screw mu;
    for (std::size_t k = 0; k < 3; ++k) {
      mu.w[k] = T::load(rows + k * outcome_.stride);
      mu.v[k] = T::load(rows + (k + 3) * outcome_.stride);
    }
    gap2 = gap2 + kernel::dot(mu, weighted(mu));
    angular2 = angular2 + kernel::dot3(mu.w, mu.w);
    kernel::add_cross(mu.w, origin, mu.v);
    linear2 = linear2 + kernel::dot3(mu.v, mu.v);
  }
  const T share(1.0 / static_cast<double>(pairs()));
  // Rounding may leave a gap of nothing below nothing.
  sqrt(select(gap2 < T(0.0), T(0.0), gap2) * share).store(outcome_.responses + at);
  sqrt(angular2 * share).store(outcome_.responses + outcome_.stride + at);
  sqrt(linear2 * share).store(outcome_.responses + 2 * outcome_.stride + at);
}

/// W x screw
template <class T, class Shape, class Measure>
auto BlockKernel<T, Shape, Measure>::weighted(const Screw& screw) const -> Screw {
  Screw product;
  for (int row = 0; row < 3; ++row) {
    const double* of_w = chain_.metric + 6 * row;
    const double* of_v = chain_.metric + 6 * (row + 3);
    T w = T(of_w[0]) * screw.w[0], v = T(of_v[0]) * screw.w[0];
    for (int k = 1; k < 3; ++k) {
      w = madd(T(of_w[k]), screw.w[k], w);
      v = madd(T(of_v[k]), screw.w[k], v);
    }
    for (int k = 0; k < 3; ++k) {
      w = madd(T(of_w[k + 3]), screw.v[k], w);
      v = madd(T(of_v[k + 3]), screw.v[k], v);
    }
    product.w[row] = w;
    product.v[row] = v;
  }
  return product;
}

template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::weigh() {
  for (std::size_t a = 0; a < joints(); ++a) row_[a] = weighted(column_[a]);
}

/// The largest |x_a column_a|_W over the reach, for the step x; diagonal(a): of N.
template <class T, class Shape, class Measure>
template <class Diagonal>
T BlockKernel<T, Shape, Measure>::step_length(Diagonal diagonal) const {
  T largest2(0.0);
  for (std::size_t i = 0; i < limbs(); ++i) {
    const T share(1.0 / chain_.limb[i].meetings);
    for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
      largest2 = max(largest2, step_[a] * step_[a] * diagonal(a) * share);
    }
  }
  return sqrt(largest2) * T(1.0 / chain_.reach);
}

}  // namespace poesy::chain
