#pragma once

#include "models/chain/block_kernel_equations.h"

namespace poesy::chain {

template <class T, class Shape>
BlockKernel<T, Shape>::BlockKernel(const KernelChain& chain, const KernelSamples& samples, const KernelStart& start,
                                   const KernelOptions& options, const KernelOutcome& outcome, double* scratch)
    : chain_(chain),
      samples_(samples),
      start_(start),
      options_(options),
      outcome_(outcome),
      capacity_(kernel_capacity(samples.count)) {
  const auto take = [&scratch](std::size_t doubles) {
    double* taken = scratch;
    scratch += doubles;
    return taken;
  };
  const auto take_lanes = [&take](std::size_t numbers) { return take(numbers * kMostLanes); };
  segment_ = reinterpret_cast<Motion*>(take_lanes(12 * chain.segments));
  pose_ = reinterpret_cast<Motion*>(take_lanes(12 * chain.limbs));
  column_ = reinterpret_cast<Screw*>(take_lanes(6 * chain.joints));
  mu_ = reinterpret_cast<Screw*>(take_lanes(6 * chain.pairs));
  pull_ = reinterpret_cast<Screw*>(take_lanes(6 * chain.limbs));
  joint_ = reinterpret_cast<T*>(take_lanes(chain.joints));
  f_ = reinterpret_cast<T*>(take_lanes(chain.joints));
  step_ = reinterpret_cast<T*>(take_lanes(chain.joints));
  gauss_newton_ = reinterpret_cast<T*>(take_lanes(chain.joints));
  n_ = reinterpret_cast<T*>(take_lanes(chain.joints * chain.joints));
  m_ = reinterpret_cast<T*>(take_lanes(chain.joints * chain.joints));
  work_ = reinterpret_cast<T*>(take_lanes(chain.joints * chain.joints + chain.joints));
  pivot_ = reinterpret_cast<T*>(take_lanes(chain.joints));
  value_ = take(samples.varied * capacity_);
  q_ = take(chain.joints * capacity_);
  memory_ = take(kernel_memory(chain) * capacity_);
  smallest_ = take(capacity_);
  flat_ = take(capacity_);
  index_ = reinterpret_cast<std::uint32_t*>(take(capacity_));
  left_ = index_ + capacity_;
}

template <class T, class Shape>
void BlockKernel<T, Shape>::solve() {
  load_constant_segments();
  for (std::size_t b = 0; b < samples_.count; ++b) left_[b] = static_cast<std::uint32_t>(b);
  const std::uint32_t cap = options_.max_iterations;
  if (options_.method == KernelMethod::gauss_newton) {
    run<KernelPass::published>(samples_.count, cap);
  } else {
    std::size_t left = run<KernelPass::direct>(samples_.count, cap < kDirectIterations ? cap : kDirectIterations);
    if (options_.method == KernelMethod::newton) {
      left = run<KernelPass::follow>(left, kFollowFactor * cap);
      run<KernelPass::rescue>(left, cap);
    }
  }
  for (std::size_t at = 0; at < samples_.count; at += kLanes) judge(at);
}

/// Computes the coordinates y of a first-order map (KernelMap) for all samples and stores them in memory_, one row for
/// each coordinate.
template <class T, class Shape>
void BlockKernel<T, Shape>::map_rows(const KernelMap& map) {
  load_all();
  for (std::size_t first = 0; first < map.rows; first += kMapRows) {
    for (std::size_t row = first; row < first + kMapRows; ++row) {
      for (std::size_t at = 0; at < samples_.count; at += kLanes) {
        T(map.constant[row]).store(memory_ + row * capacity_ + at);
      }
    }
    std::size_t v = 0;
    for (; v + kMapErrors <= samples_.varied; v += kMapErrors) add_mapped<kMapErrors>(map, first, v);
    for (; v < samples_.varied; ++v) add_mapped<1>(map, first, v);
  }
}

template <class T, class Shape>
void BlockKernel<T, Shape>::map(const KernelMap& map) {
  map_rows(map);
  for (std::size_t at = 0; at < samples_.count; at += kLanes) {
    map.rows == kMapRows ? finish_mapped<kMapRows>(map, at) : finish_mapped<0>(map, at);
  }
}

/// Adds the first-order effects of varied errors v to v + errors - 1 to kMapRows coordinates of all samples. The
/// function reads few rows of sample values at a time, so that the hardware prefetcher can follow them.
template <class T, class Shape>
template <std::size_t errors>
void BlockKernel<T, Shape>::add_mapped(const KernelMap& map, std::size_t first, std::size_t v) {
  T effect[errors][kMapRows];
  for (std::size_t e = 0; e < errors; ++e) {
    for (std::size_t n = 0; n < kMapRows; ++n) effect[e][n] = T(map.effects[(v + e) * map.rows + first + n]);
  }
  const auto add = [&](const double* values, std::size_t stride, std::size_t at) {
    double* rows = memory_ + first * capacity_ + at;
    T sum[kMapRows];
    for (std::size_t n = 0; n < kMapRows; ++n) sum[n] = T::load(rows + n * capacity_);
    for (std::size_t e = 0; e < errors; ++e) {
      const T value = T::load(values + e * stride);
      for (std::size_t n = 0; n < kMapRows; ++n) sum[n] = madd(effect[e][n], value, sum[n]);
    }
    for (std::size_t n = 0; n < kMapRows; ++n) sum[n].store(rows + n * capacity_);
  };
  std::size_t at = 0;
  for (; at + kLanes <= samples_.count; at += kLanes)
    add(samples_.values + v * samples_.stride + at, samples_.stride, at);
  if (at < samples_.count) add(value_ + v * capacity_ + at, capacity_, at);
}

/// Computes the mismatch delta_mu, the responses and the status of one batch of samples from the coordinates y of their
/// mismatch (see KernelMap). known_rows: number of coordinates if it is known at compile time, else 0.
template <class T, class Shape>
template <std::size_t known_rows>
void BlockKernel<T, Shape>::finish_mapped(const KernelMap& map, std::size_t at) {
  const std::size_t rows = known_rows != 0 ? known_rows : map.rows;
  const auto y = [&](std::size_t row) { return T::load(memory_ + row * capacity_ + at); };
  T size(0.0);
  for (std::size_t row = 0; row < rows; ++row) size = size + abs(y(row));
  const unsigned finite = bits(size < T(1e300));
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const bool is_finite = (finite >> lane & 1u) != 0;
    outcome_.status[at + lane] = is_finite ? SolveStatus::converged : SolveStatus::non_finite;
    outcome_.iterations[at + lane] = 1;
  }
  for (std::size_t n = 0; n < 6 * pairs(); ++n) {
    T sum(0.0);
    for (std::size_t row = 0; row < rows; ++row) sum = madd(T(map.delta_mu[n * rows + row]), y(row), sum);
    sum.store(outcome_.delta_mu + n * outcome_.stride + at);
  }
  judge(at);
}

/// Computes the responses of a batch of samples (Du et al. 2022, Eqs. 45-50): the means over the pairs of the angular
/// and of the linear norms, and the largest norm of a pair's whole mismatch [omega; v].
template <class T, class Shape>
void BlockKernel<T, Shape>::judge(std::size_t at) {
  T angular(0.0), linear(0.0), largest(0.0);
  for (std::size_t n = 0; n < pairs(); ++n) {
    T mu[6];
    for (std::size_t k = 0; k < 6; ++k) mu[k] = T::load(outcome_.delta_mu + (6 * n + k) * outcome_.stride + at);
    const T angular2 = kernel::dot3(mu, mu);
    const T linear2 = kernel::dot3(mu + 3, mu + 3);
    angular = angular + sqrt(angular2);
    linear = linear + sqrt(linear2);
    largest = max(largest, angular2 + linear2);
  }
  const T share(1.0 / static_cast<double>(pairs()));
  (angular * share).store(outcome_.responses + at);
  (linear * share).store(outcome_.responses + outcome_.stride + at);
  sqrt(largest).store(outcome_.responses + 2 * outcome_.stride + at);
}

/// Solves the samples listed in left_[0 .. count). Replaces the list by the samples that were not solved, and returns
/// their number.
template <class T, class Shape>
template <KernelPass pass>
std::size_t BlockKernel<T, Shape>::run(std::size_t count, std::uint32_t rounds) {
  constexpr bool published = pass == KernelPass::published;
  constexpr bool last_pass = published || pass == KernelPass::rescue;
  if (count == 0) return 0;
  begin(count, pass == KernelPass::direct);
  std::size_t left = 0;
  std::size_t active = count;
  // The published rule evaluates the residual once more after the last step.
  const std::uint32_t evaluations = published ? rounds + 1 : rounds;
  for (std::uint32_t round = 0; round < evaluations && active > 0; ++round) {
    const bool last_round = round + 1 == evaluations;
    const std::uint32_t iterations = spent_ + round + (published ? 0 : 1);
    std::size_t kept = 0;
    pad(active);
    for (std::size_t at = 0; at < active; at += kLanes) {
      Verdict verdict;
      if constexpr (published) {
        verdict = published_round(at, round, last_round);
      } else {
        verdict = newton_round<pass>(at, round);
      }
      for (std::size_t lane = 0; lane < kLanes && at + lane < active; ++lane) {
        if (!verdict.ended(lane) && !last_round) {
          move<pass>(at + lane, kept++);
        } else if (last_pass || verdict.solved(lane)) {
          finish(at, lane, verdict.status(lane), iterations);
        } else {
          left_[left++] = index_[at + lane];
        }
      }
    }
    active = kept;
  }
  spent_ += rounds;
  return left;
}

/// Prepares value() for all samples in their original order. Whole batches are later read directly from samples_. The
/// samples of an incomplete last batch are copied to value_, and its unused lanes are filled with copies of the last
/// sample.
template <class T, class Shape>
void BlockKernel<T, Shape>::load_all() {
  const std::size_t count = samples_.count;
  in_place_ = count - count % kLanes;
  for (std::size_t v = 0; v < samples_.varied; ++v) {
    const double* from = samples_.values + v * samples_.stride;
    double* to = value_ + v * capacity_;
    for (std::size_t b = in_place_; b < count; ++b) to[b] = from[b];
    for (std::size_t b = count; b % kLanes != 0; ++b) to[b] = from[count - 1];
  }
  for (std::size_t b = 0; b < count; ++b) index_[b] = static_cast<std::uint32_t>(b);
}

/// The values of the v-th varied error in the samples from `at` on, one in each lane.
template <class T, class Shape>
T BlockKernel<T, Shape>::value(std::size_t v, std::size_t at) const {
  return at < in_place_ ? T::load(samples_.values + v * samples_.stride + at) : T::load(value_ + v * capacity_ + at);
}

template <class T, class Shape>
void BlockKernel<T, Shape>::begin(std::size_t count, bool predicted) {
  in_place_ = 0;
  for (std::size_t b = 0; b < count; ++b) {
    index_[b] = left_[b];
    for (std::size_t v = 0; v < samples_.varied; ++v) {
      value_[v * capacity_ + b] = samples_.values[v * samples_.stride + left_[b]];
    }
    smallest_[b] = 1e308;
    flat_[b] = 0.0;
  }
  if (predicted && start_.fits > 0) {
    pad(count);
    for (std::size_t at = 0; at < count; at += kLanes) predict(at);
    return;
  }
  for (std::size_t j = 0; j < joints(); ++j) {
    for (std::size_t b = 0; b < count; ++b) q_[j * capacity_ + b] = chain_.joint[j].start;
  }
}

/// Sets the starting points of a batch. A sample within the range of a fit starts at the sum of the fit's Chebyshev
/// series, by Clenshaw's recurrence. Samples outside all ranges start from nominal displacements.
template <class T, class Shape>
void BlockKernel<T, Shape>::predict(std::size_t at) {
  for (std::size_t j = 0; j < joints(); ++j) joint_[j] = T(chain_.joint[j].start);
  for (std::size_t n = 0; n < start_.fits; ++n) {
    const KernelFit& fit = start_.fit[n];
    const T x = (value(0, at) - T(fit.center)) * T(1.0 / fit.half_width);
    const auto inside = !(abs(x) > T(1.0));
    if (!any(inside)) continue;
    select(inside, T(-1.0), T::load(flat_ + at)).store(flat_ + at);
    const T twice = x + x;
    for (std::size_t j = 0; j < joints(); ++j) {
      const double* c = fit.coefficients + j * kStartTerms;
      T one(0.0), two(0.0);
      for (std::size_t k = kStartTerms; k-- > 1;) {
        const T sum = madd(twice, one, T(c[k]) - two);
        two = one;
        one = sum;
      }
      joint_[j] = select(inside, madd(x, one, T(c[0]) - two), joint_[j]);
    }
  }
  for (std::size_t j = 0; j < joints(); ++j) joint_[j].store(q_ + j * capacity_ + at);
}

/// Fills the unused lanes of the last batch with copies of the last sample. The results of these lanes are not used.
template <class T, class Shape>
void BlockKernel<T, Shape>::pad(std::size_t count) {
  const std::size_t rows = samples_.varied + joints() + kernel_memory(chain_) + 2;
  for (std::size_t b = count; b % kLanes != 0; ++b) {
    // value_, q_, memory_, smallest_ and flat_ are contiguous.
    for (std::size_t row = 0; row < rows; ++row) value_[row * capacity_ + b] = value_[row * capacity_ + count - 1];
  }
}

template <class T, class Shape>
void BlockKernel<T, Shape>::evaluate(std::size_t at) {
  for (std::size_t j = 0; j < joints(); ++j) joint_[j] = T::load(q_ + j * capacity_ + at);
  vary_segments(at, chain_.segments);
  residuals();
  gradient();
  gauss_newton_matrix();
}

template <class T, class Shape>
typename T::MaskType BlockKernel<T, Shape>::finite_residual() const {
  T sum(0.0);
  for (std::size_t n = 0; n < pairs(); ++n) {
    for (int k = 0; k < 3; ++k) sum = sum + abs(mu_[n].w[k]) + abs(mu_[n].v[k]);
  }
  return sum < T(1e300);
}

template <class T, class Shape>
T BlockKernel<T, Shape>::largest(const T* x) const {
  T size(0.0);
  for (std::size_t j = 0; j < joints(); ++j) size = max(size, abs(x[j]));
  return size;
}

template <class T, class Shape>
void BlockKernel<T, Shape>::take_step(std::size_t at, const T* x) {
  for (std::size_t j = 0; j < joints(); ++j) (joint_[j] + x[j]).store(q_ + j * capacity_ + at);
}

template <class T, class Shape>
auto BlockKernel<T, Shape>::published_round(std::size_t at, std::uint32_t round, bool last_round) -> Verdict {
  evaluate(at);
  T change(0.0);
  for (std::size_t n = 0; n < pairs(); ++n) {
    for (int k = 0; k < 3; ++k) {
      double* w = memory_ + (6 * n + static_cast<std::size_t>(k)) * capacity_ + at;
      double* v = w + 3 * capacity_;
      change = max(change, max(abs(mu_[n].w[k] - T::load(w)), abs(mu_[n].v[k] - T::load(v))));
      mu_[n].w[k].store(w);
      mu_[n].v[k].store(v);
    }
  }
  Verdict verdict;
  verdict.non_finite = bits(!finite_residual());
  if (round > 0) {
    const T smallest = T::load(smallest_ + at);
    const T flat = select(change < smallest, T(0.0), T::load(flat_ + at) + T(1.0));
    min(change, smallest).store(smallest_ + at);
    flat.store(flat_ + at);
    verdict.converged = bits(change < T(options_.tolerance));
    verdict.stagnated = bits((!(change > T(options_.rounding_level))) & (flat > T(2.5)));
  }
  if (last_round) return verdict;
  verdict.singular = bits(!gauss_newton_step(step_));
  take_step(at, step_);
  return verdict;
}

template <class T, class Shape>
template <KernelPass pass>
auto BlockKernel<T, Shape>::newton_round(std::size_t at, std::uint32_t round) -> Verdict {
  evaluate(at);
  const auto finite = finite_residual();
  Verdict verdict;
  auto near = T(0.0) < T(1.0);
  if constexpr (pass == KernelPass::follow) {
    verdict.singular = bits(!gauss_newton_step(gauss_newton_));
    verdict.non_finite = bits(!finite);
    verdict.refused = bits(cycles(at, round));
    const T size = largest(gauss_newton_);
    verdict.stagnated = bits(size < T(kRestingStep));
    near = size < T(kNearStep);
    if (!any(near)) {
      // Far from a root the Newton step is not computed, because it would not be used.
      take_step(at, gauss_newton_);
      return verdict;
    }
  }
  newton_matrix();
  auto safe = near & finite;
  if constexpr (pass == KernelPass::direct) {
    // If a fit gave the start, contracts() is not needed for the first step: this step is small and stays on the branch
    // of the fit's nodes, at which all steps were safe.
    const auto fitted = T::load(flat_ + at) * T(round == 0 ? 1.0 : 0.0) < T(0.0);
    if (any(!fitted)) safe = safe & (fitted | contracts());
  } else if constexpr (pass == KernelPass::follow) {
    safe = safe & contracts();
  }
  safe = safe & newton_step(step_);
  const T size = largest(step_);
  safe = safe & (size < T(pass == KernelPass::follow ? kFollowStep : options_.largest_step));
  auto converged = safe & (size < T(options_.last_step));
  if constexpr (pass == KernelPass::rescue) {
    T away(0.0);
    for (std::size_t j = 0; j < joints(); ++j) away = max(away, abs(joint_[j] - T(chain_.joint[j].start)));
    converged = converged & (away < T(kSameBranch));
  }
  verdict.converged = bits(converged);
  if constexpr (pass == KernelPass::direct) {
    verdict.refused = bits(!safe);
  } else if (any(!safe)) {
    T damping(1.0);
    if constexpr (pass == KernelPass::rescue) {
      damping = T(0.5);
      verdict.singular = bits((!safe) & (!gauss_newton_step(gauss_newton_)));
      verdict.non_finite = bits(!finite);
    }
    for (std::size_t j = 0; j < joints(); ++j) step_[j] = select(safe, step_[j], damping * gauss_newton_[j]);
  }
  take_step(at, step_);
  if (any(converged)) carry_residual(step_, converged);
  return verdict;
}

/// The lanes in which Gauss-Newton cycles: the displacements are again those of the last round whose number was a power
/// of two.
template <class T, class Shape>
typename T::MaskType BlockKernel<T, Shape>::cycles(std::size_t at, std::uint32_t round) {
  const bool remember = (round & (round - 1)) == 0;
  T distance(0.0);
  for (std::size_t j = 0; j < joints(); ++j) {
    double* then = memory_ + j * capacity_ + at;
    if (round > kFirstMemory) distance = max(distance, abs(joint_[j] - T::load(then)));
    if (remember) joint_[j].store(then);
  }
  if (round <= kFirstMemory) return T(1.0) < T(0.0);
  return distance < T(kSamePlace);
}

template <class T, class Shape>
void BlockKernel<T, Shape>::finish(std::size_t at, std::size_t lane, SolveStatus status, std::uint32_t iterations) {
  const std::size_t sample = index_[at + lane];
  const double* mu = reinterpret_cast<const double*>(mu_);
  for (std::size_t n = 0; n < 6 * pairs(); ++n) {
    outcome_.delta_mu[n * outcome_.stride + sample] = mu[n * kLanes + lane];
  }
  if (outcome_.displacements != nullptr) {
    for (std::size_t j = 0; j < joints(); ++j) {
      outcome_.displacements[j * outcome_.stride + sample] = q_[j * capacity_ + at + lane];
    }
  }
  outcome_.status[sample] = status;
  outcome_.iterations[sample] = iterations;
}

/// Moves the data of an unfinished sample from column `from` to column `to` of all rows, so that all unfinished samples
/// are contiguous.
template <class T, class Shape>
template <KernelPass pass>
void BlockKernel<T, Shape>::move(std::size_t from, std::size_t to) {
  if (from == to) return;
  index_[to] = index_[from];
  const std::size_t needed = samples_.varied + joints();
  const bool remembers = pass == KernelPass::published || pass == KernelPass::follow;
  const std::size_t rows = remembers ? needed + kernel_memory(chain_) + 2 : needed;
  for (std::size_t row = 0; row < rows; ++row) value_[row * capacity_ + to] = value_[row * capacity_ + from];
}

}  // namespace poesy::chain
