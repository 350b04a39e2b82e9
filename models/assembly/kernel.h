#pragma once

// Included only by kernels.cpp, which is compiled once for each instruction set.

#include "models/assembly/kernel_constant.h"
#include "models/assembly/kernel_meet.h"
#include "models/assembly/kernel_own.h"

namespace poesy::assembly {

/// Limbs against bodies, for batches of samples: the equations of Solver, from where first order leads, in which p is
/// carried as an unknown: in its place C^-1 xi would turn rounding into force, and converge for small errors alone.
/// Step: ConstantStep, MeetStep or OwnStep. A lane depends on its own sample only: one that has settled stays where it
/// is.
template <class T, class Step>
class AssemblyKernel {
 public:
  /// Both must outlive it.
  AssemblyKernel(const KernelProblem& problem, const KernelBlock& block)
      : problem_(problem),
        block_(block),
        reporter_(problem, block),
        outcome_(problem),
        state_(problem, block),
        step_(problem) {}

  void solve() {  ///< Writes what every sample gives.
    for (std::size_t at = 0; at < block_.count; at += T::kLanes) solve_batch(at);
  }

 private:
  using Mask = typename T::MaskType;

  void solve_batch(std::size_t at) {
    state_.begin(at);
    before_ = {.places = T(problem_.start.is_used ? 1e300 : 1.0), .wrenches = T(1e300)};
    Mask active = T(0.0) < T(1.0);
    Mask left = active;
    T iterations(0.0);
    for (int n = 0; n < problem_.most_rounds && any(active); ++n) {
      iterations = select(active, iterations + T(1.0), iterations);
      const LaneChange<T> change = step_.round(state_, active, n);
      const Mask settled = active & has_settled(change) & !change.refused;
      before_ = change;
      left = left & !settled;
      active = active & !(settled | change.refused);
    }
    if (block_.states != nullptr) state_.store(block_.states + at);
    state_.report(outcome_);
    reporter_.write(outcome_, at);
    end(at, left, iterations);
  }

  /// Whether the next round would change no more than rounding: by this one's change, or where that is small enough to
  /// shrink on as it did in this round.
  Mask has_settled(const LaneChange<T>& change) const {
    const T tolerance(problem_.tolerance * problem_.tolerance);
    const auto rests = [](T now, T before, T limit, T small) {
      return (!(now > limit)) | ((now * now < T(kNext) * limit * before) & (now < small));
    };
    Mask settled = rests(change.places, before_.places, tolerance, T(kShort) * tolerance);
    if (problem_.wants_wrenches) {
      T whole(0.0);
      for (const T& wrench : state_.wrenches) whole = madd(wrench, wrench, whole);
      settled = settled & rests(change.wrenches, before_.wrenches, T(kWrenches) * whole, T(kShortWrenches) * whole);
    }
    return settled & (change.places < T(kFarthest));
  }

  void end(std::size_t at, Mask left, T iterations) const {
    const unsigned lanes = bits(left);
    double counted[T::kLanes];
    iterations.store(counted);
    for (std::size_t lane = 0; lane < T::kLanes; ++lane) {
      block_.ends[at + lane] = (lanes >> lane & 1u) != 0 ? KernelEnd::left : KernelEnd::converged;
      block_.iterations[at + lane] = static_cast<std::uint32_t>(counted[lane]);
    }
  }

  static constexpr double kWrenches = 1e-24;       ///< square of the share of all wrenches that is rounding
  static constexpr double kShortWrenches = 1e-14;  ///< square of such a share up to which the next one is foreseen
  static constexpr double kNext = 1e-2;       ///< square of the share of the tolerance that a next round may change
  static constexpr double kShort = 1e12;      ///< square of a change over the tolerance up to which it is foreseen
  static constexpr double kFarthest = 100.0;  ///< square of a move beyond which a lane has diverged

  const KernelProblem& problem_;
  const KernelBlock& block_;
  KernelReporter<T> reporter_;
  LaneOutcome<T> outcome_;
  LaneAssembly<T> state_;
  Step step_;
  LaneChange<T> before_;  ///< of the last round
};

/// Solves a block with batches of T.
template <class T>
void solve_assemblies(const KernelProblem& problem, const KernelBlock& block) {
  if (problem.start.is_used) return AssemblyKernel<T, ConstantStep<T>>(problem, block).solve();
  switch (problem.step) {
    case KernelStep::constant:
      return AssemblyKernel<T, ConstantStep<T>>(problem, block).solve();
    case KernelStep::meet:
      return AssemblyKernel<T, MeetStep<T>>(problem, block).solve();
    case KernelStep::own:
      return AssemblyKernel<T, OwnStep<T>>(problem, block).solve();
  }
}

}  // namespace poesy::assembly
