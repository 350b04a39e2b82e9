#pragma once

#include "models/chain/block_kernel_equations.h"

namespace poesy::chain {

template <class T, class Shape, class Measure>
void BlockKernel<T, Shape, Measure>::solve_by_metric() {
  using enum KernelPass;
  load_all();
  const std::uint32_t cap = options_.max_iterations;
  for (std::size_t at = 0; at < samples_.count; at += kLanes) {
    const std::size_t count = samples_.count - at;
    const unsigned lanes = count < kLanes ? (1u << count) - 1u : (1u << kLanes) - 1u;
    spent_ = 0;
    if (options_.method == KernelMethod::gauss_newton) {
      iterate<published>(at, lanes, cap);
      continue;
    }
    unsigned left = iterate<direct>(at, lanes, cap < kDirectIterations ? cap : kDirectIterations);
    if (options_.method == KernelMethod::newton_direct) continue;
    if (left != 0) left = iterate<follow>(at, left, kFollowFactor * cap);
    if (left != 0) iterate<rescue>(at, left, cap);
  }
}

/// Iterates these lanes of a batch until each is done. Lanes that are done run on with the others, but their results
/// are not kept. Stores the results of solved lanes, in the last pass of all lanes; returns the lanes that are left.
template <class T, class Shape, class Measure>
template <KernelPass pass>
unsigned BlockKernel<T, Shape, Measure>::iterate(std::size_t at, unsigned open, std::uint32_t rounds) {
  constexpr bool newton = pass != KernelPass::published;
  constexpr bool last_pass = !newton || pass == KernelPass::rescue;
  start<pass>(at);
  clear_ = pass == KernelPass::direct ? kAllLanes : 0;
  if (pass == KernelPass::direct && start_.fits > 0 && start_.inverse != nullptr) open = finish_fitted(at, open);
  // Gauss-Newton also evaluates the residual after the last step.
  const std::uint32_t evaluations = newton ? rounds : rounds + 1;
  unsigned left = 0;
  T before(0.0);
  auto safe = T(1.0) < T(0.0);
  for (std::uint32_t round = 0; open != 0; ++round) {
    const bool last_round = round + 1 == evaluations;
    residuals();
    gradient();
    Verdict verdict;
    if constexpr (!newton) {
      verdict = gauss_newton_by_metric(at, round);
    } else if constexpr (pass == KernelPass::direct) {
      verdict = newton_by_metric(at, round, before, safe);
    } else {
      verdict = careful_by_metric<pass>(at);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const unsigned bit = 1u << lane;
      if ((open & bit) == 0 || (!verdict.ended(lane) && !last_round)) continue;
      open &= ~bit;
      if (last_pass || verdict.solved(lane)) {
        finish(at, lane, verdict.status(lane), spent_ + round + (newton ? 1 : 0));
      } else {
        left |= bit;
      }
    }
  }
  spent_ += rounds;
  return left;
}

/// The converged lanes that are doubted. For the nodes of a fit, contraction of Gauss-Newton is enough.
template <class T, class Shape, class Measure>
unsigned BlockKernel<T, Shape, Measure>::doubted(unsigned converged) const {
  return options_.method == KernelMethod::newton_direct ? 0 : converged & ~clear_;
}

/// Sets the start of a pass: the first pass starts from a fit, or in proportion to the errors; the others, like
/// Gauss-Newton, from nominal displacements.
template <class T, class Shape, class Measure>
template <KernelPass pass>
void BlockKernel<T, Shape, Measure>::start(std::size_t at) {
  if constexpr (pass == KernelPass::direct) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) flat_[at + lane] = 0.0;
    predict(at);
  } else {
    for (std::size_t j = 0; j < joints(); ++j) joint_[j] = T(chain_.joint[j].start);
  }
  vary_segments(at, chain_.segments);
}

/// Finishes the lanes whose fit is exact to rounding, and returns the others. One step with the matrix at nominal
/// displacements tells them apart.
template <class T, class Shape, class Measure>
unsigned BlockKernel<T, Shape, Measure>::finish_fitted(std::size_t at, unsigned open) {
  residuals();
  gradient();
  const T length = nominal_step(step_);
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

/// Computes the step with the matrix at nominal displacements. Returns its length.
template <class T, class Shape, class Measure>
T BlockKernel<T, Shape, Measure>::nominal_step(T* x) const {
  for (std::size_t a = 0; a < joints(); ++a) {
    T sum(0.0);
    for (std::size_t b = 0; b < joints(); ++b) sum = madd(T(start_.inverse[a * joints() + b]), f_[b], sum);
    x[a] = sum;
  }
  return step_length(x, [&](std::size_t a) { return T(start_.diagonal[a]); });
}

/// Computes a Newton step with new matrices. Returns the lanes where it is safe and Gauss-Newton contracts.
template <class T, class Shape, class Measure>
typename T::MaskType BlockKernel<T, Shape, Measure>::new_newton_step(T* x) {
  weigh();
  gauss_newton_matrix();
  newton_matrix();
  const auto safe = contracts();
  return safe & newton_step(x);
}

/// The first round from a start in proportion to the errors. The error of this start is about the square of the errors:
/// where it is small, the nominal matrix removes most of it, and Newton's matrix of the next round serves to the end.
/// Otherwise this is a Newton step. Returns the refused lanes.
template <class T, class Shape, class Measure>
unsigned BlockKernel<T, Shape, Measure>::first_step(T& length) {
  length = nominal_step(step_);
  const auto is_short = length < T(kShortStart);
  if (bits(is_short) == (1u << kLanes) - 1u) return 0;
  const auto safe = new_newton_step(gauss_newton_) & finite_residual();
  const T of_newton = step_length(gauss_newton_, [&](std::size_t a) { return n_[a * joints() + a]; });
  length = select(is_short, length, of_newton);
  for (std::size_t j = 0; j < joints(); ++j) step_[j] = select(is_short, step_[j], gauss_newton_[j]);
  return bits((!safe) & (!is_short));
}

/// One round of the first pass. before: the length of the last step; safe: the lanes where the current matrix is safe.
/// Both are of this batch.
template <class T, class Shape, class Measure>
auto BlockKernel<T, Shape, Measure>::newton_by_metric(std::size_t at, std::uint32_t round, T& before,
                                                      typename T::MaskType& safe) -> Verdict {
  const bool has_nominal = start_.fits == 0 && start_.inverse != nullptr;
  if (has_nominal && round == 0) {
    Verdict verdict;
    verdict.refused = first_step(before);
    advance(at);
    return verdict;
  }
  const bool is_new = round % kMatrixRounds == (has_nominal ? 1 : 0);
  if (is_new) {
    safe = new_newton_step(step_);
  } else {
    newton_step_again(step_);
  }
  const T length = step_length(step_, [&](std::size_t a) { return n_[a * joints() + a]; });
  auto small =
      (length * length < T(0.1 * options_.tolerance) * before) & (length < T(kShortLength * options_.tolerance));
  if (is_new) small = small | (length < T(options_.last_step));
  const auto converged = safe & finite_residual() & small;
  before = length;
  Verdict verdict;
  verdict.converged = bits(converged);
  verdict.refused = bits(!(safe & finite_residual()));
  if (any(converged)) carry_residual(step_, converged);
  verdict.doubted = doubted(verdict.converged);
  advance(at);
  return verdict;
}

/// One round with a new matrix. follow: Gauss-Newton's steps, and Newton's where they are short and safe and
/// Gauss-Newton contracts; rescue: Newton's wherever its matrix is safely positive, else half of Gauss-Newton's.
template <class T, class Shape, class Measure>
template <KernelPass pass>
auto BlockKernel<T, Shape, Measure>::careful_by_metric(std::size_t at) -> Verdict {
  constexpr bool follows = pass == KernelPass::follow;
  const auto diagonal = [&](std::size_t a) { return n_[a * joints() + a]; };
  const auto finite = finite_residual();
  weigh();
  gauss_newton_matrix();
  const auto regular = gauss_newton_step(gauss_newton_);
  newton_matrix();
  auto safe = finite;
  const auto contracting = contracts();
  if constexpr (follows) safe = safe & contracting;
  safe = safe & newton_step(step_);
  const T newton_length = step_length(step_, diagonal);
  if constexpr (follows) {
    safe = safe & (newton_length < T(kFollowStep)) & (step_length(gauss_newton_, diagonal) < T(kNearStep));
  }
  auto converged = safe & (newton_length < T(options_.last_step));
  Verdict verdict;
  if constexpr (follows) {
    // Gauss-Newton has converged although Newton is not safe if the coming change of the residual is small.
    T change2(0.0);
    for (std::size_t j = 0; j < joints(); ++j) change2 = madd(gauss_newton_[j], f_[j], change2);
    const T change = sqrt(change2 * T(1.0 / static_cast<double>(pairs()))) * T(1.0 / chain_.reach);
    verdict.stagnated = bits(regular & finite & !(change > T(options_.rounding_level)));
  } else {
    for (std::size_t j = 0; j < joints(); ++j) f_[j] = joint_[j] - T(chain_.joint[j].start);
    converged = converged & (step_length(f_, diagonal) < T(kSameBranch));
  }
  verdict.converged = bits(converged);
  verdict.singular = bits((!safe) & (!regular));
  verdict.non_finite = bits(!finite);
  const T damping(follows ? 1.0 : 0.5);
  for (std::size_t j = 0; j < joints(); ++j) step_[j] = select(safe, step_[j], damping * gauss_newton_[j]);
  if (any(converged)) carry_residual(step_, converged);
  verdict.doubted = doubted(verdict.converged);
  advance(at);
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
  advance(at);
  return verdict;
}

/// Responses: root mean squares over the pairs of |delta_mu|_W, of the angle, and of the displacement at the platform's
/// origin.
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
  // Rounding may make a sum that should be 0 negative.
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

/// The length of a step: the largest |x_a column_a|_W, divided by the reach. diagonal(a): the entry of N.
template <class T, class Shape, class Measure>
template <class Diagonal>
T BlockKernel<T, Shape, Measure>::step_length(const T* x, Diagonal diagonal) const {
  T largest2(0.0);
  for (std::size_t i = 0; i < limbs(); ++i) {
    const T share(1.0 / chain_.limb[i].meetings);
    for (std::size_t a = first_joint(i); a < first_joint(i + 1); ++a) {
      largest2 = max(largest2, x[a] * x[a] * diagonal(a) * share);
    }
  }
  return sqrt(largest2) * T(1.0 / chain_.reach);
}

}  // namespace poesy::chain
