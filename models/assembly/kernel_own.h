#pragma once

// Included only by kernels.cpp, which is compiled once for each instruction set.

#include <type_traits>

#include "models/assembly/kernel_blocks.h"
#include "models/assembly/kernel_state.h"

namespace poesy::assembly {

/// Calls work(number of passive joints) with a constant.
template <class Work>
void with_passive(std::size_t passive, Work work) {
  switch (passive) {
    case 0:
      return work(std::integral_constant<std::size_t, 0>());
    case 1:
      return work(std::integral_constant<std::size_t, 1>());
    case 2:
      return work(std::integral_constant<std::size_t, 2>());
    case 3:
      return work(std::integral_constant<std::size_t, 3>());
    case 4:
      return work(std::integral_constant<std::size_t, 4>());
    case 5:
      return work(std::integral_constant<std::size_t, 5>());
    default:
      return work(std::integral_constant<std::size_t, kMostOwnJoints>());
  }
}

/// Rounds of Newton's method: with the matrix of each sample's own, made in the first round and then in every fourth.
/// Limbs have regular C. With S the columns of J, ad xi for the bracket with the mismatch and D = S - 1/2 ad xi S, the
/// equations of one limb,
///
///     p + dp = C^-1 (xi + D dq + (1 - 1/2 ad xi) V_a - (1 + 1/2 ad xi) V_b)
///     S_j^T (p + dp) + sum over k < j of [S_k, S_j]^T p dq_k + [V_a, S_j]^T p = 0,
///
/// are solved for dq, a matrix as large as the limb has passive joints; what is left of all limbs are six equations
/// for each body. Freedoms that move nothing make the limb's matrix singular: constant terms of rank one keep them
/// where they are. A lane is refused where a pivot is not safely positive, for then no stable equilibrium is near.
template <class T>
class OwnStep {
 public:
  using Mask = typename T::MaskType;  ///< a truth value for each lane

  /// It must outlive this.
  explicit OwnStep(const KernelProblem& problem)
      : problem_(problem), limbs_(problem.limbs.size()), matrix_(problem), twists_(6 * problem.bodies.size(), T(0.0)) {}

  /// Moves the lanes that go on.
  LaneChange<T> round(LaneAssembly<T>& state, Mask active, int number) {
    const bool is_new = number % kMatrixRounds == 0;
    LaneChange<T> change;
    if (is_new) matrix_.clear();
    for (std::size_t k = 6; k < twists_.size(); ++k) twists_[k] = T(problem_.load[k]);
    for (std::size_t e = 0; e < limbs_.size(); ++e) {
      with_passive(problem_.limbs[e].passive, [&](auto n) { visit<n>(state, e, is_new); });
    }
    if (is_new) safe_ = matrix_.factor() & limbs_are_safe();
    matrix_.solve(twists_);
    for (std::size_t e = 0; e < limbs_.size(); ++e) {
      with_passive(problem_.limbs[e].passive, [&](auto n) { step<n>(state, e, active, change); });
    }
    change.places = max(change.places, state.move_bodies(twists_, active));
    change.refused = !safe_;
    return change;
  }

 private:
  using Motion = LaneMotion<T>;
  static constexpr int kMatrixRounds = 4;

  /// What belongs to the last matrix, unless it says otherwise. Rows of joints have six entries.
  struct Limb {
    T columns[6 * kMostOwnJoints];               ///< S, at the present state
    T open[6];                                   ///< xi, at the present state
    T rest[6];                                   ///< C^-1 xi - p, at the present state
    T alone[kMostOwnJoints];                     ///< dq if no body moves, at the present state
    T xi[6];                                     ///< xi
    T stiff[6 * kMostOwnJoints];                 ///< C^-1 S
    T turned[6 * kMostOwnJoints];                ///< D
    T inverse[kMostOwnJoints * kMostOwnJoints];  ///< of the limb's matrix
    T by_to[6 * kMostOwnJoints];                 ///< dq by V_b
    T by_from[6 * kMostOwnJoints];               ///< dq by V_a
    Mask safe;                                   ///< where its pivots are
  };

  Mask limbs_are_safe() const {
    Mask safe = limbs_.front().safe;
    for (const Limb& limb : limbs_) safe = safe & limb.safe;
    return safe;
  }

  /// C^-1 times a twist.
  static void stiffness_times(const KernelLimb& limb, const T* twist, T* wrench) {
    if (limb.is_diagonal) {
      for (int k = 0; k < 6; ++k) wrench[k] = T(limb.stiffness[7 * k]) * twist[k];
      return;
    }
    for (int row = 0; row < 6; ++row) {
      const double* of = &limb.stiffness[static_cast<std::size_t>(6 * row)];
      T sum = T(of[0]) * twist[0];
      for (int k = 1; k < 6; ++k) sum = madd(T(of[k]), twist[k], sum);
      wrench[row] = sum;
    }
  }

  /// [a, b] of two twists.
  static void bracket(const T* a, const T* b, T* made) {
    simd::cross(a, b, made);
    simd::cross(a, b + 3, made + 3);
    simd::add_cross(a + 3, b, made + 3);
  }

  /// The h with h^T x = p^T [a, x] for every twist x.
  static void bracket_transposed(const T* a, const T* p, T* h) {
    simd::cross(p, a, h);
    simd::add_cross(p + 3, a + 3, h);
    simd::cross(p + 3, a, h + 3);
  }

  /// Mismatch of a limb at the present state, its part of the matrix if that is new, and of the right side.
  template <std::size_t n>
  void visit(const LaneAssembly<T>& state, std::size_t e, bool is_new) {
    const KernelLimb& limb = problem_.limbs[e];
    Limb& of = limbs_[e];
    const T* p = &state.wrenches[6 * e];
    const Motion end = state.walk(e, [&](const KernelJoint& joint, const Motion& g) {
      if (joint.passive >= 0) twist_of(joint, g, of.columns + 6 * joint.passive);
    });
    log_of(end, state.bodies[limb.to], of.open);
    T pull[6];
    stiffness_times(limb, of.open, pull);
    for (int k = 0; k < 6; ++k) of.rest[k] = pull[k] - p[k];
    if (is_new) set_matrix<n>(limb, p, of);
    T felt[kMostOwnJoints];
    for (std::size_t j = 0; j < n; ++j) felt[j] = -dot6(of.columns + 6 * j, pull);
    T moved[6] = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    for (std::size_t j = 0; j < n; ++j) {
      T dq = of.inverse[n * j] * felt[0];
      for (std::size_t k = 1; k < n; ++k) dq = madd(of.inverse[n * j + k], felt[k], dq);
      of.alone[j] = dq;
      for (std::size_t k = 0; k < 6; ++k) moved[k] = madd(of.turned[6 * j + k], dq, moved[k]);
    }
    T by_joints[6];
    stiffness_times(limb, moved, by_joints);
    for (std::size_t k = 0; k < 6; ++k) pull[k] = pull[k] + by_joints[k];
    for (std::size_t k = 0; k < 6; ++k) {
      if (limb.to != 0) twists_[6 * limb.to + k] = twists_[6 * limb.to + k] + pull[k];
      if (limb.from != 0) twists_[6 * limb.from + k] = twists_[6 * limb.from + k] - pull[k];
    }
  }

  /// The limb's matrix, and what it gives to that of the bodies.
  template <std::size_t n>
  void set_matrix(const KernelLimb& limb, const T* p, Limb& of) {
    for (int k = 0; k < 6; ++k) of.xi[k] = of.open[k];
    T turning[6 * kMostOwnJoints];  // h_j, by which a joint's column turns
    for (std::size_t j = 0; j < n; ++j) {
      const T* column = of.columns + 6 * j;
      bracket(of.xi, column, of.turned + 6 * j);
      for (std::size_t k = 0; k < 6; ++k) of.turned[6 * j + k] = nmadd(T(0.5), of.turned[6 * j + k], column[k]);
      stiffness_times(limb, column, of.stiff + 6 * j);
      bracket_transposed(column, p, turning + 6 * j);
    }
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        T sum = T(limb.idle[n * j + k]) + dot6(of.stiff + 6 * j, of.turned + 6 * k);
        if (k < j) sum = sum - dot6(of.columns + 6 * k, turning + 6 * j);
        of.inverse[n * j + k] = sum;
      }
    }
    of.safe = invert<n>(of.inverse);
    set_by_bodies<n>(limb, turning, of);
    T block[36];
    if (limb.to != 0) {
      pull_by<n>(limb, of, of.by_to, -1.0, block);
      matrix_.add(limb.to, limb.to, block, -1.0);
      if (limb.from != 0) matrix_.add(limb.from, limb.to, block, 1.0);
    }
    if (limb.from != 0) {
      pull_by<n>(limb, of, of.by_from, 1.0, block);
      matrix_.add(limb.from, limb.from, block, 1.0);
      if (limb.to != 0) matrix_.add(limb.to, limb.from, block, -1.0);
    }
  }

  /// The inverse of a matrix [n x n] in its place, without exchange of rows. Returns where pivots are safe.
  template <std::size_t n>
  static Mask invert(T* matrix) {
    Mask safe = T(0.0) < T(1.0);
    T diagonal[kMostOwnJoints];
    for (std::size_t k = 0; k < n; ++k) diagonal[k] = matrix[(n + 1) * k];
    for (std::size_t k = 0; k < n; ++k) {
      T* of_k = matrix + n * k;
      safe = safe & (of_k[k] > T(kSafePivot) * diagonal[k]) & (diagonal[k] > T(0.0));
      const T pivot = T(1.0) / of_k[k];
      of_k[k] = T(1.0);
      for (std::size_t j = 0; j < n; ++j) of_k[j] = of_k[j] * pivot;
      for (std::size_t i = 0; i < n; ++i) {
        if (i == k) continue;
        T* row = matrix + n * i;
        const T factor = row[k];
        row[k] = T(0.0);
        for (std::size_t j = 0; j < n; ++j) row[j] = nmadd(factor, of_k[j], row[j]);
      }
    }
    return safe;
  }

  /// dq by the bodies' twists.
  template <std::size_t n>
  void set_by_bodies(const KernelLimb& limb, const T* turning, Limb& of) {
    T to[6 * kMostOwnJoints];
    T from[6 * kMostOwnJoints];
    for (std::size_t j = 0; j < n; ++j) {
      T bent[6];
      bracket_transposed(of.xi, of.stiff + 6 * j, bent);
      for (std::size_t k = 0; k < 6; ++k) {
        to[6 * j + k] = madd(T(0.5), bent[k], of.stiff[6 * j + k]);
        from[6 * j + k] = turning[6 * j + k] - nmadd(T(0.5), bent[k], of.stiff[6 * j + k]);
      }
    }
    if (limb.to != 0) multiply<n>(of.inverse, to, of.by_to);
    if (limb.from != 0) multiply<n>(of.inverse, from, of.by_from);
  }

  /// [n x n] times [n x 6]
  template <std::size_t n>
  static void multiply(const T* a, const T* b, T* made) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < 6; ++k) {
        T sum = a[n * j] * b[k];
        for (std::size_t m = 1; m < n; ++m) sum = madd(a[n * j + m], b[6 * m + k], sum);
        made[6 * j + k] = sum;
      }
    }
  }

  /// The limb's wrench by the twist of one of its bodies, [6 x 6]: C^-1 (D by_body + sign - 1/2 ad xi).
  template <std::size_t n>
  static void pull_by(const KernelLimb& limb, const Limb& of, const T* by_body, double sign, T* block) {
    const T* xi = of.xi;
    for (int column = 0; column < 6; ++column) {
      T unit[6];
      for (int k = 0; k < 6; ++k) unit[k] = T(k == column ? 1.0 : 0.0);
      T moved[6];
      bracket(xi, unit, moved);
      for (int k = 0; k < 6; ++k) moved[k] = madd(T(-0.5), moved[k], T(sign) * unit[k]);
      for (std::size_t j = 0; j < n; ++j) {
        const T dq = by_body[6 * j + static_cast<std::size_t>(column)];
        for (std::size_t k = 0; k < 6; ++k) moved[k] = madd(of.turned[6 * j + k], dq, moved[k]);
      }
      T wrench[6];
      stiffness_times(limb, moved, wrench);
      for (int k = 0; k < 6; ++k) block[6 * k + column] = wrench[k];
    }
  }

  /// Moves wrench and joints of a limb in the lanes that go on.
  template <std::size_t n>
  void step(LaneAssembly<T>& state, std::size_t e, Mask active, LaneChange<T>& change) {
    const KernelLimb& limb = problem_.limbs[e];
    const Limb& of = limbs_[e];
    const T* to = &twists_[6 * limb.to];
    const T* from = &twists_[6 * limb.from];
    T both[6];
    T moved[6];
    for (int k = 0; k < 6; ++k) both[k] = from[k] + to[k];
    bracket(of.xi, both, moved);
    for (int k = 0; k < 6; ++k) moved[k] = madd(T(-0.5), moved[k], from[k] - to[k]);
    for (std::size_t j = 0; j < n; ++j) {
      T dq = of.alone[j];
      if (limb.to != 0) dq = dq + dot6(of.by_to + 6 * j, to);
      if (limb.from != 0) dq = dq + dot6(of.by_from + 6 * j, from);
      for (std::size_t k = 0; k < 6; ++k) moved[k] = madd(of.turned[6 * j + k], dq, moved[k]);
      T& q = state.displacements[limb.first_joint + j];
      q = select(active, q + dq, q);
      change.places = max(change.places, dq * dq);
    }
    T pull[6];
    stiffness_times(limb, moved, pull);
    T* p = &state.wrenches[6 * e];
    for (int k = 0; k < 6; ++k) {
      const T dp = of.rest[k] + pull[k];
      change.wrenches = madd(dp, dp, change.wrenches);
      p[k] = select(active, p[k] + dp, p[k]);
    }
  }

  const KernelProblem& problem_;
  std::vector<Limb> limbs_;
  BodyMatrix<T> matrix_;
  std::vector<T> twists_;  ///< [6 x bodies] right side, then the bodies' twists; the base's is 0
  Mask safe_;              ///< where the last matrix is
};

}  // namespace poesy::assembly
