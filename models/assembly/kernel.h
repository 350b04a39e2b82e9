#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include "models/assembly/kernel_constant.h"
#include "models/assembly/kernel_meet.h"
#include "models/assembly/kernel_own.h"

namespace poesy::assembly {

/// Solves the equations of Solver for batches of samples of an assembly. A sample starts at the first-order solution,
/// or at the state that the series of KernelStart gives. The wrenches of the limbs are unknowns of their own. If
/// they were computed as C^-1 xi, with compliance C and mismatch xi, rounding errors of xi would appear as forces, and
/// only samples with small errors would converge. The type `Step` is ConstantStep, MeetStep or OwnStep; a round is one
/// iteration. A lane depends only on its own sample, and does not change any more after has_settled() is true for it.
template <class T, class Step>
class AssemblyKernel {
 public:
  /// Both arguments must outlive this object.
  AssemblyKernel(const KernelProblem& problem, const KernelBlock& block)
      : problem_(problem),
        block_(block),
        reporter_(problem, block, kRounding),
        outcome_(problem),
        state_(problem, block),
        step_(problem) {}

  void solve() {  ///< Solves all samples and writes their outcomes.
    for (std::size_t at = 0; at < block_.count; at += T::kLanes) solve_batch(at);
  }

 private:
  using Mask = typename T::MaskType;

  void solve_batch(std::size_t at) {
    state_.begin(at);
    before_ = {.places = T(problem_.start.is_used ? 1e300 : 1.0), .wrenches = T(1e300)};
    Mask active = T(0.0) < T(1.0);
    Mask left = active;
    Mask doubtful = state_.start_move() > T(kFarStart);
    T iterations(0.0);
    for (int n = 0; n < problem_.most_rounds && any(active); ++n) {
      iterations = select(active, iterations + T(1.0), iterations);
      const LaneChange<T> change = step_.round(state_, active, n);
      const Mask settled = active & has_settled(change) & !change.refused;
      if (n > 0) doubtful = doubtful | (active & is_slow(change));
      before_ = change;
      left = left & !settled;
      active = active & !(settled | change.refused);
    }
    left = left | !state_.is_finite();  // the largest of several changes may hide one that is NaN
    if (block_.states != nullptr) state_.store(block_.states + at);
    state_.report(outcome_);
    reporter_.write(outcome_, at);
    end(at, left, doubtful, iterations);
  }

  /// The lanes in which the largest move of bodies and joints in this round is more than three quarters of that in the
  /// round before, and is not rounding.
  Mask is_slow(const LaneChange<T>& change) const {
    return (change.places > T(kMoves)) & (change.places > T(kSlow) * before_.places);
  }

  /// The lanes that need no further round. In such a lane this round moved bodies and joints by at most the tolerance,
  /// and changed wrenches by no more than rounding; or the changes are small, and shrink so fast that the changes of
  /// the next round would be within these limits.
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

  void end(std::size_t at, Mask left, Mask doubtful, T iterations) const {
    // Samples that start from the series are not doubtful, because the series is smooth and so leads to no other
    // solution.
    put_ends(bits(left), problem_.start.is_used ? 0 : bits(doubtful), T::kLanes, block_.ends + at);
    double counted[T::kLanes];
    iterations.store(counted);
    for (std::size_t lane = 0; lane < T::kLanes; ++lane) {
      block_.iterations[at + lane] = static_cast<std::uint32_t>(counted[lane]);
    }
  }

  /// A displacement or mismatch (in units of the reach, or rad) below this is written as 0. Rounding leaves numbers of
  /// 1e-16 and smaller. Without this limit, the values of a response that is zero would extend over so many orders of
  /// magnitude that their statistics would take long.
  static constexpr double kRounding = 1e-20;
  /// The change of the wrenches counts as rounding if the square of the relative change is at most this.
  static constexpr double kWrenches = 1e-24;
  /// If the square of the relative change of the wrenches is below this, the change of the next round is predicted.
  static constexpr double kShortWrenches = 1e-14;
  /// A lane that is not yet within its limit (tolerance or rounding) has settled if the change that is predicted for
  /// the next round is below 0.1 of this limit; square of 0.1.
  static constexpr double kNext = 1e-2;
  /// If the square of (move of this round / tolerance) is below this, the move of the next round is predicted.
  static constexpr double kShort = 1e12;
  static constexpr double kFarStart = 0.25;   ///< a lane is doubtful if its start_move() is above this
  static constexpr double kMoves = 1e-20;     ///< a move whose square is below this is close to rounding, and not slow
  static constexpr double kSlow = 0.5625;     ///< a move is slow if its square exceeds this share of the last square
  static constexpr double kFarthest = 100.0;  ///< a lane has not settled if the square of its move is above this

  const KernelProblem& problem_;
  const KernelBlock& block_;
  KernelReporter<T> reporter_;
  LaneOutcome<T> outcome_;
  LaneAssembly<T> state_;
  Step step_;
  LaneChange<T> before_;  ///< changes of the previous round
};

/// Solves a block of samples with batches of T.
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
