#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include "models/assembly/kernel_blocks.h"
#include "models/assembly/kernel_state.h"

namespace poesy::assembly {

/// A pivot below this share of its diagonal entry is not safe.
inline constexpr double kSafePivot = 1e-5;

/// Makes steps of Newton's method with a matrix for each sample. The matrix is computed anew in the first, the fifth,
/// the ninth round (iteration) and so on. The compliances C of the limbs must be regular. Consider a limb from body a
/// to body b. Its wrench is p, and xi = log(g T^-1) is the mismatch between its end, with the pose g, and body b, with
/// the pose T. The columns of S are the twists of the limb's passive joints. Let ad xi be the bracket with the
/// mismatch, E(x) = 1 + x/2 + x^2/12 the differential of the logarithm to second order, and D = E(-ad xi) S. V_a and
/// V_b are the twists of the bodies a and b, and dq are the displacements of the passive joints. The equations of the
/// limb,
///
///     p + dp = C^-1 (xi + D dq + E(-ad xi) V_a - E(ad xi) V_b)
///     S_j^T (p + dp) + sum over k < j of [S_k, S_j]^T p dq_k + [V_a, S_j]^T p = 0,
///
/// are solved for dq, with a matrix that has a row for each passive joint of the limb. Six equations for each body
/// remain. Idle freedoms, motions of passive joints that move no body, make the limb's matrix singular; constant terms
/// of rank one are added for them. A lane is refused, and its sample left to another solver, if a pivot is not
/// safely positive, because then no stable equilibrium is near.
template <class T>
class OwnStep {
 public:
  using Mask = typename T::MaskType;  ///< a truth value for each lane

  /// The problem must outlive this object.
  explicit OwnStep(const KernelProblem& problem)
      : problem_(problem),
        present_(problem.limbs.size()),
        limbs_(problem.limbs.size()),
        matrix_(problem, kSafePivot),
        twists_(6 * problem.bodies.size(), T(0.0)) {}

  /// Makes one iteration (round), which changes the state in the active lanes. Returns the changes. number: index of
  /// the round, counted from 0.
  LaneChange<T> round(LaneAssembly<T>& state, Mask active, int number) {
    const bool is_new = number % kMatrixRounds == 0;
    if (is_new) {
      matrix_.clear();
      safe_ = T(0.0) < T(1.0);
    }
    for (std::size_t k = 6; k < twists_.size(); ++k) twists_[k] = T(problem_.load[k]);
    for (std::size_t e = 0; e < limbs_.size(); ++e) {
      with_passive(problem_.limbs[e].passive, [&](auto n) { visit<n>(state, e, is_new); });
    }
    if (is_new) safe_ = safe_ & matrix_.factor();
    matrix_.solve(twists_);
    LaneChange<T> change;
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

  /// A limb in the present state. Each twist or wrench has six entries.
  struct Present {
    T columns[6 * kMostOwnJoints];  ///< columns of S: twists of the passive joints
    T open[6];                      ///< mismatch xi
    T rest[6];                      ///< C^-1 xi, the wrench that belongs to the mismatch, minus the present wrench p
    T alone[kMostOwnJoints];        ///< dq of the passive joints if no body moves
  };

  /// The matrix of a limb, and the state for which it was made.
  struct Limb {
    T xi[6];                                     ///< mismatch xi
    T columns[6 * kMostOwnJoints];               ///< columns of S: twists of the passive joints
    T turned[6 * kMostOwnJoints];                ///< columns of D = E(-ad xi) S, with E of OwnStep
    T inverse[kMostOwnJoints * kMostOwnJoints];  ///< inverse of the matrix of the equations for dq
    T by_to[6 * kMostOwnJoints];                 ///< dq of the passive joints per unit of V_b, the twist of body `to`
    T by_from[6 * kMostOwnJoints];               ///< dq per unit of V_a, the twist of body `from`
  };

  /// Computes the wrench that belongs to a twist between a limb's end and its body: C^-1 twist, with the compliance C.
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

  /// Computes the Lie bracket [a, b] of two twists.
  static void bracket(const T* a, const T* b, T* made) {
    simd::cross(a, b, made);
    simd::cross(a, b + 3, made + 3);
    simd::add_cross(a + 3, b, made + 3);
  }

  /// Computes E(-ad xi) x for a twist x, with the mismatch xi and E as in the class's comment.
  static void bend(const T* xi, const T* x, T* made) {
    T once[6];
    T twice[6];
    bracket(xi, x, once);
    bracket(xi, once, twice);
    for (int k = 0; k < 6; ++k) made[k] = madd(T(1.0 / 12.0), twice[k], nmadd(T(0.5), once[k], x[k]));
  }

  /// Computes the vector h for which h^T x = p^T [a, x] holds for every twist x. a: twist; p: wrench.
  static void bracket_transposed(const T* a, const T* p, T* h) {
    simd::cross(p, a, h);
    simd::add_cross(p + 3, a + 3, h);
    simd::cross(p + 3, a, h + 3);
  }

  /// Computes the mismatch of limb e, and adds the limb's contribution to the right side of the bodies' equations. In a
  /// round with new matrices, also adds its contribution to the bodies' matrix.
  template <std::size_t n>
  void visit(const LaneAssembly<T>& state, std::size_t e, bool is_new) {
    const KernelLimb& limb = problem_.limbs[e];
    Present& now = present_[e];
    const T* p = &state.wrenches[6 * e];
    const Motion end = state.walk(e, [&](const KernelJoint& joint, const Motion& g) {
      if (joint.passive >= 0) twist_of(joint, g, now.columns + 6 * joint.passive);
    });
    log_of(end, state.bodies[limb.to], now.open);
    T pull[6];
    stiffness_times(limb, now.open, pull);
    for (int k = 0; k < 6; ++k) now.rest[k] = pull[k] - p[k];
    Limb& of = limbs_[e];
    if (is_new) safe_ = safe_ & set_matrix<n>(limb, now, p, of);
    T felt[kMostOwnJoints];
    for (std::size_t j = 0; j < n; ++j) {
      felt[j] = -(dot6(now.columns + 6 * j, p) + dot6(of.columns + 6 * j, now.rest));
    }
    T moved[6] = {T(0.0), T(0.0), T(0.0), T(0.0), T(0.0), T(0.0)};
    for (std::size_t j = 0; j < n; ++j) {
      T dq = of.inverse[n * j] * felt[0];
      for (std::size_t k = 1; k < n; ++k) dq = madd(of.inverse[n * j + k], felt[k], dq);
      now.alone[j] = dq;
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

  /// Computes the limb's matrix, and adds the limb's contribution to the matrix of the bodies. Returns the lanes in
  /// which all pivots of the limb's matrix are safe.
  template <std::size_t n>
  Mask set_matrix(const KernelLimb& limb, const Present& now, const T* p, Limb& of) {
    for (int k = 0; k < 6; ++k) of.xi[k] = now.open[k];
    for (std::size_t k = 0; k < 6 * n; ++k) of.columns[k] = now.columns[k];
    T stiff[6 * kMostOwnJoints];  // C^-1 S: wrench per unit displacement of each joint
    // The vector h of bracket_transposed() for each column and the wrench p.
    T turning[6 * kMostOwnJoints];
    for (std::size_t j = 0; j < n; ++j) {
      const T* column = now.columns + 6 * j;
      bend(of.xi, column, of.turned + 6 * j);
      stiffness_times(limb, column, stiff + 6 * j);
      bracket_transposed(column, p, turning + 6 * j);
    }
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < n; ++k) {
        T sum = T(limb.idle[n * j + k]) + dot6(stiff + 6 * j, of.turned + 6 * k);
        if (k < j) sum = sum - dot6(now.columns + 6 * k, turning + 6 * j);
        of.inverse[n * j + k] = sum;
      }
    }
    const Mask safe = invert<n>(of.inverse);
    T to[6 * kMostOwnJoints];
    T from[6 * kMostOwnJoints];
    felt_by_bodies<n>(of.xi, stiff, turning, to, from);
    if (limb.to != 0) add_body<n>(limb, limb.to, of, to, of.by_to);
    if (limb.from != 0) add_body<n>(limb, limb.from, of, from, of.by_from);
    return safe;
  }

  /// Computes dq per unit twist of a body, and adds the effect of the limb's wrench to the matrix of the bodies. felt:
  /// moment or force on each of the n passive joints per unit twist of the body, [n x 6].
  template <std::size_t n>
  void add_body(const KernelLimb& limb, std::size_t body, const Limb& of, const T* felt, T* dq) {
    multiply<n>(of.inverse, felt, dq);
    T block[36];
    pull_by<n>(limb, of, dq, body == limb.to ? -1.0 : 1.0, block);
    if (limb.to != 0) matrix_.add(limb.to, body, block, -1.0);
    if (limb.from != 0) matrix_.add(limb.from, body, block, 1.0);
  }

  /// Inverts a matrix [n x n] in place, without row exchanges. Returns the lanes in which all pivots are safe.
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

  /// Computes the moment or force on each of the n passive joints per unit twist of the bodies b (`to`) and a (`from`),
  /// [n x 6] each. xi: mismatch. stiff: C^-1 S, the wrench per unit displacement of each joint. turning: the vector h
  /// (see bracket_transposed()) of each joint's twist.
  template <std::size_t n>
  static void felt_by_bodies(const T* xi, const T* stiff, const T* turning, T* to, T* from) {
    for (std::size_t j = 0; j < 6 * n; j += 6) {
      T once[6];
      T twice[6];
      bracket_transposed(xi, stiff + j, once);
      bracket_transposed(xi, once, twice);
      for (std::size_t k = 0; k < 6; ++k) {
        const T even = madd(T(1.0 / 12.0), twice[k], stiff[j + k]);
        to[j + k] = madd(T(0.5), once[k], even);
        from[j + k] = turning[j + k] - nmadd(T(0.5), once[k], even);
      }
    }
  }

  /// Computes the product of a [n x n] and b [n x 6].
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

  /// Computes the matrix sign E(-sign ad xi) [6 x 6], where sign is 1 or -1, xi is the mismatch, and E is as in the
  /// class's comment.
  static void bent_unit(const T* xi, double sign, T* made) {
    const T* w = xi;
    const T* v = xi + 3;
    const T share(sign / 12.0);
    const T across = nmadd(share, simd::dot3(w, w), T(sign));
    const T along = T(-2.0) * share * simd::dot3(w, v);
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) {
        const T same = share * w[row] * w[k];
        const T mixed = share * madd(w[row], v[k], v[row] * w[k]);
        made[6 * row + k] = row == k ? across + same : same;
        made[6 * (row + 3) + k] = row == k ? along + mixed : mixed;
        made[6 * row + k + 3] = T(0.0);
      }
    }
    subtract_half_cross(w, made);
    subtract_half_cross(v, made + 18);
    for (int row = 0; row < 3; ++row) {
      for (int k = 0; k < 3; ++k) made[6 * (row + 3) + k + 3] = made[6 * row + k];
    }
  }

  /// Subtracts hat(w) / 2 from a [3 x 3] block of a matrix with rows of six.
  static void subtract_half_cross(const T* w, T* block) {
    const T half(0.5);
    block[1] = madd(half, w[2], block[1]);
    block[2] = nmadd(half, w[1], block[2]);
    block[6] = nmadd(half, w[2], block[6]);
    block[8] = madd(half, w[0], block[8]);
    block[12] = madd(half, w[1], block[12]);
    block[13] = nmadd(half, w[0], block[13]);
  }

  /// Computes the limb's wrench per unit twist of one of its bodies, [6 x 6]: C^-1 (D by_body + bent_unit()). by_body:
  /// dq per unit twist of the body. sign: -1 for body b, 1 for body a.
  template <std::size_t n>
  static void pull_by(const KernelLimb& limb, const Limb& of, const T* by_body, double sign, T* block) {
    T moved[36];
    bent_unit(of.xi, sign, moved);
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t row = 0; row < 6; ++row) {
        for (std::size_t k = 0; k < 6; ++k) {
          moved[6 * row + k] = madd(of.turned[6 * j + row], by_body[6 * j + k], moved[6 * row + k]);
        }
      }
    }
    if (limb.is_diagonal) {
      for (int k = 0; k < 36; ++k) block[k] = T(limb.stiffness[k / 6 * 7]) * moved[k];
      return;
    }
    for (int row = 0; row < 6; ++row) {
      for (int k = 0; k < 6; ++k) {
        T sum = T(limb.stiffness[6 * row]) * moved[k];
        for (int m = 1; m < 6; ++m) sum = madd(T(limb.stiffness[6 * row + m]), moved[6 * m + k], sum);
        block[6 * row + k] = sum;
      }
    }
  }

  /// Changes wrench and joints of limb e in the active lanes.
  template <std::size_t n>
  void step(LaneAssembly<T>& state, std::size_t e, Mask active, LaneChange<T>& change) {
    const KernelLimb& limb = problem_.limbs[e];
    const Limb& of = limbs_[e];
    const Present& now = present_[e];
    const T* to = &twists_[6 * limb.to];
    const T* from = &twists_[6 * limb.from];
    T apart[6];
    T moved[6];
    T turned[6];
    for (int k = 0; k < 6; ++k) apart[k] = from[k] - to[k];
    bend(of.xi, apart, moved);
    bracket(of.xi, to, turned);
    for (int k = 0; k < 6; ++k) moved[k] = moved[k] - turned[k];
    for (std::size_t j = 0; j < n; ++j) {
      T dq = now.alone[j];
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
      const T dp = now.rest[k] + pull[k];
      change.wrenches = madd(dp, dp, change.wrenches);
      p[k] = select(active, p[k] + dp, p[k]);
    }
  }

  const KernelProblem& problem_;
  std::vector<Present> present_;  ///< [limbs] present state of each limb
  std::vector<Limb> limbs_;       ///< [limbs] matrix of each limb
  BodyMatrix<T> matrix_;
  std::vector<T> twists_;  ///< [6 x bodies] right side, then the twists of the bodies; 0 for the base
  Mask safe_;              ///< lanes in which all pivots of the last matrix were safely positive
};

}  // namespace poesy::assembly
