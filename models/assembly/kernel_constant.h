#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include "models/assembly/kernel_state.h"

namespace poesy::assembly {

/// Makes steps with the constant matrix of the nominal pose. The symbols are those of Equilibrium, with x = [dq; V]; dp
/// is the change of p, and B0 is B at the nominal pose:
///
///     [ C  B0 ; B0^T  0 ] [ dp ; x ] = [ xi - C p ; J^T p ; -load - sum of p ].
///
/// If limbs do not deform each other and no load acts, p is 0 and is omitted.
template <class T>
class ConstantStep {
 public:
  using Mask = typename T::MaskType;  ///< a truth value for each lane

  /// The problem must outlive this object.
  explicit ConstantStep(const KernelProblem& problem)
      : problem_(problem),
        mismatch_(6 * problem.limbs.size()),
        particular_(6 * problem.limbs.size(), T(0.0)),
        right_(problem.size),
        found_(problem.size),
        twists_(6 * problem.bodies.size(), T(0.0)) {}

  /// Makes one iteration (round), which changes the state in the active lanes. Returns the changes.
  LaneChange<T> round(LaneAssembly<T>& state, Mask active, int /*number*/) {
    for (T& row : right_) row = T(0.0);
    for (std::size_t b = 1; b < problem_.bodies.size(); ++b) {
      for (std::size_t k = 0; k < 6; ++k) add_to_body(b, k, T(-problem_.load[6 * b + k]));
    }
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) visit(state, e);
    solve_linear();
    for (std::size_t k = 6; k < twists_.size(); ++k) twists_[k] = found_[first_body_row() + k - 6];
    LaneChange<T> change;
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) step(state, e, active, change);
    change.places = max(change.places, state.move_bodies(twists_, active));
    return change;
  }

 private:
  using Motion = LaneMotion<T>;

  /// Computes the mismatch of limb e, and adds the limb's contribution to the right side of the equations.
  void visit(const LaneAssembly<T>& state, std::size_t e) {
    const KernelLimb& limb = problem_.limbs[e];
    const T* p = &state.wrenches[6 * e];
    T* rest = &particular_[6 * e];
    T* xi = &mismatch_[6 * e];
    if (!problem_.carries) {
      log_of(state.walk(e, [](const KernelJoint&, const Motion&) {}), state.bodies[limb.to], xi);
      set_right(limb, xi);
      return;
    }
    for (int k = 0; k < 6; ++k) rest[k] = T(0.0);
    const Motion end = state.walk(e, [&](const KernelJoint& joint, const Motion& g) {
      if (joint.passive >= 0) add_felt(limb, joint, g, p, rest);
    });
    log_of(end, state.bodies[limb.to], xi);
    T left[6];
    for (int k = 0; k < 6; ++k) {
      T sum = xi[k];
      for (int n = 0; n < 6; ++n) sum = nmadd(T(limb.compliance[6 * k + n]), p[n] + rest[n], sum);
      left[k] = sum;
    }
    set_right(limb, left);
    for (std::size_t k = 0; k < 6; ++k) {
      const T all = p[k] + rest[k];
      add_to_body(limb.to, k, -all);
      add_to_body(limb.from, k, all);
    }
  }

  /// Adds to `rest` the wrench that cancels the component of the limb's wrench p along a passive joint.
  static void add_felt(const KernelLimb& limb, const KernelJoint& joint, const Motion& g, const T* p, T* rest) {
    T twist[6];
    twist_of(joint, g, twist);
    const T felt = dot6(twist, p);
    const double* give = &limb.give[6 * static_cast<std::size_t>(joint.passive)];
    for (int k = 0; k < 6; ++k) rest[k] = nmadd(T(give[k]), felt, rest[k]);
  }

  /// Sets the limb's rows of the right side: the products of the twist `left` with the wrenches that the limb can
  /// carry.
  void set_right(const KernelLimb& limb, const T* left) {
    for (std::size_t m = 0; m < limb.carried; ++m) {
      T sum = T(limb.carry[m]) * left[0];
      for (std::size_t k = 1; k < 6; ++k) sum = madd(T(limb.carry[k * limb.carried + m]), left[k], sum);
      right_[limb.first_wrench + m] = sum;
    }
  }

  void add_to_body(std::size_t body, std::size_t k, T value) {
    if (body == 0) return;
    T& row = right_[first_body_row() + 6 * (body - 1) + k];
    row = row + value;
  }

  std::size_t first_body_row() const { return problem_.size - 6 * (problem_.bodies.size() - 1); }

  /// Solves the equations. If limbs have no wrenches, the bodies' rows of the right side are 0, and the wrench
  /// coordinates lambda are not computed.
  void solve_linear() {
    const std::size_t columns = problem_.carries ? problem_.size : first_body_row();
    for (std::size_t row = problem_.carries ? 0 : first_body_row(); row < problem_.size; ++row) {
      const double* of = &problem_.inverse[row * problem_.size];
      T even(0.0);
      T odd(0.0);
      std::size_t k = 0;
      for (; k + 1 < columns; k += 2) {
        even = madd(T(of[k]), right_[k], even);
        odd = madd(T(of[k + 1]), right_[k + 1], odd);
      }
      if (k < columns) even = madd(T(of[k]), right_[k], even);
      found_[row] = even + odd;
    }
  }

  /// Changes the wrench p of limb e in the active lanes. Adds C (p + dp) to the twist `wanted`. Returns the square of
  /// dp.
  T step_wrench(LaneAssembly<T>& state, std::size_t e, Mask active, T* wanted) {
    const KernelLimb& limb = problem_.limbs[e];
    T* p = &state.wrenches[6 * e];
    T square(0.0);
    T made[6];
    for (std::size_t k = 0; k < 6; ++k) {
      T change = particular_[6 * e + k];
      for (std::size_t m = 0; m < limb.carried; ++m) {
        change = madd(T(limb.carry[k * limb.carried + m]), found_[limb.first_wrench + m], change);
      }
      square = madd(change, change, square);
      made[k] = p[k] + change;
    }
    for (std::size_t k = 0; k < 6; ++k) {
      for (std::size_t n = 0; n < 6; ++n) wanted[k] = madd(T(limb.compliance[6 * k + n]), made[n], wanted[k]);
      p[k] = select(active, made[k], p[k]);
    }
    return square;
  }

  /// Changes wrench and joints of limb e in the active lanes.
  void step(LaneAssembly<T>& state, std::size_t e, Mask active, LaneChange<T>& change) {
    const KernelLimb& limb = problem_.limbs[e];
    T wanted[6];
    for (std::size_t k = 0; k < 6; ++k) {
      wanted[k] = twists_[6 * limb.to + k] - twists_[6 * limb.from + k] - mismatch_[6 * e + k];
    }
    if (problem_.carries) change.wrenches = change.wrenches + step_wrench(state, e, active, wanted);
    for (std::size_t j = 0; j < limb.passive; ++j) {
      T& q = state.displacements[limb.first_joint + j];
      T dq = T(limb.give[6 * j]) * wanted[0];
      for (std::size_t k = 1; k < 6; ++k) dq = madd(T(limb.give[6 * j + k]), wanted[k], dq);
      q = select(active, q + dq, q);
      change.places = max(change.places, dq * dq);
    }
  }

  const KernelProblem& problem_;
  std::vector<T> mismatch_;    ///< [6 x limbs] mismatch xi
  std::vector<T> particular_;  ///< [6 x limbs] part of dp that cancels the components of p along passive joints
  std::vector<T> right_;
  std::vector<T> found_;
  std::vector<T> twists_;  ///< [6 x bodies] twists of the bodies
};

}  // namespace poesy::assembly
