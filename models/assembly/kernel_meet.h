#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include "models/assembly/kernel_blocks.h"
#include "models/assembly/kernel_state.h"

namespace poesy::assembly {

/// Makes the steps of problems in which no limb has a wrench, because the joints can bring the end of every limb to its
/// body. Let xi = log(g T^-1) be the mismatch between a limb's end, with the pose g, and its body, with the pose T. The
/// columns of S are the twists of the limb's passive joints. The twists V of the bodies and the displacements dq of the
/// passive joints minimise
///
///     sum over limbs from a to b of |xi + V_a - V_b + S dq|^2
///
/// Each limb has a projection P = 1 - S (S^T S)^-1 S^T: P xi is the part of xi that its passive joints cannot remove.
/// The six equations of a body contain the sums of P and of P xi over the limbs that begin or end at this body. The
/// norm | | of a twist is proportional to the root mean square displacement of the platform's points by this twist. At
/// the solution the minimum is zero, so steps with new projections converge quadratically. New projections are made in
/// the first, the fifth, the ninth round (iteration) and so on. Idle freedoms, motions of passive joints that move no
/// body, make S^T S singular; constant terms of rank one are added for them. A lane is refused, and its
/// sample left to another solver, if a pivot is not safely positive.
template <class T>
class MeetStep {
 public:
  using Mask = typename T::MaskType;  ///< a truth value for each lane

  /// The problem must outlive this object.
  explicit MeetStep(const KernelProblem& problem)
      : problem_(problem),
        limbs_(problem.limbs.size()),
        matrix_(problem, kSafe),
        twists_(6 * problem.bodies.size(), T(0.0)) {}

  /// Makes one iteration (round), which changes the state in the active lanes. Returns the changes. number: index of
  /// the round, counted from 0.
  LaneChange<T> round(LaneAssembly<T>& state, Mask active, int number) {
    const bool is_new = number % kMatrixRounds == 0;
    if (is_new) {
      matrix_.clear();
      safe_ = T(0.0) < T(1.0);
    }
    for (T& entry : twists_) entry = T(0.0);
    for (std::size_t e = 0; e < limbs_.size(); ++e) {
      with_passive(problem_.limbs[e].passive, [&](auto n) { visit<n>(state, e, is_new); });
    }
    if (is_new) safe_ = safe_ & matrix_.factor();
    matrix_.solve(twists_);
    LaneChange<T> change;
    for (std::size_t e = 0; e < limbs_.size(); ++e) {
      with_passive(problem_.limbs[e].passive, [&](auto n) { step<n>(state, e, active, change); });
    }
    for (std::size_t k = 6; k < twists_.size(); ++k) twists_[k] = T(problem_.unmeasured[k % 6]) * twists_[k];
    change.places = max(change.places, state.move_bodies(twists_, active));
    change.refused = !safe_;
    return change;
  }

 private:
  using Motion = LaneMotion<T>;
  static constexpr int kMatrixRounds = 4;
  static constexpr double kSafe = 1e-9;  ///< a pivot below this share of its diagonal entry is not safe

  /// The mismatch of a limb, and the data of its projection P = 1 - Y^T Y.
  struct Limb {
    T open[6];                                  ///< mismatch xi in measured coordinates (KernelProblem::measured)
    T rows[6 * kMostOwnJoints];                 ///< Y = L^-1 S^T with the Cholesky factor L: S^T S = L L^T
    T factor[kMostOwnJoints * kMostOwnJoints];  ///< Cholesky factor L, below the diagonal
    T pivots[kMostOwnJoints];                   ///< reciprocal diagonal of L
  };

  void measure(const T* twist, T* made) const {
    for (int k = 0; k < 6; ++k) made[k] = T(problem_.measured[k]) * twist[k];
  }

  /// Splits a twist x into rest = P x and along = Y x [n], with the limb's projection P = 1 - Y^T Y. n: number of the
  /// limb's passive joints.
  template <std::size_t n>
  static void project(const Limb& of, const T* x, T* along, T* rest) {
    for (int k = 0; k < 6; ++k) rest[k] = x[k];
    for (std::size_t j = 0; j < n; ++j) {
      along[j] = dot6(of.rows + 6 * j, x);
      for (std::size_t k = 0; k < 6; ++k) rest[k] = nmadd(along[j], of.rows[6 * j + k], rest[k]);
    }
  }

  /// Computes the mismatch of limb e, and adds the limb's contribution to the right side of the bodies' equations. In a
  /// round with new projections, also computes the limb's projection.
  template <std::size_t n>
  void visit(const LaneAssembly<T>& state, std::size_t e, bool is_new) {
    const KernelLimb& limb = problem_.limbs[e];
    Limb& of = limbs_[e];
    T open[6];
    if (is_new) {
      T columns[6 * kMostOwnJoints];
      const Motion end = state.walk(e, [&](const KernelJoint& joint, const Motion& g) {
        if (joint.passive < 0) return;
        T twist[6];
        twist_of(joint, g, twist);
        measure(twist, columns + 6 * joint.passive);
      });
      log_of(end, state.bodies[limb.to], open);
      set_rows<n>(limb, columns, of);
      add_projection<n>(limb, of);
    } else {
      log_of(state.walk(e, [](const KernelJoint&, const Motion&) {}), state.bodies[limb.to], open);
    }
    measure(open, of.open);
    T along[kMostOwnJoints];
    T rest[6];
    project<n>(of, of.open, along, rest);
    for (std::size_t k = 0; k < 6; ++k) {
      if (limb.to != 0) twists_[6 * limb.to + k] = twists_[6 * limb.to + k] + rest[k];
      if (limb.from != 0) twists_[6 * limb.from + k] = twists_[6 * limb.from + k] - rest[k];
    }
  }

  /// Computes the Cholesky factor L of S^T S, and Y = L^-1 S^T. columns: twists of the passive joints, the columns of
  /// S.
  template <std::size_t n>
  void set_rows(const KernelLimb& limb, const T* columns, Limb& of) {
    for (std::size_t a = 0; a < n; ++a) {
      T* row = of.rows + 6 * a;
      for (std::size_t k = 0; k < 6; ++k) row[k] = columns[6 * a + k];
      T* const of_a = of.factor + n * a;
      T pivot(0.0);
      T diagonal(0.0);
      for (std::size_t b = 0; b <= a; ++b) {
        T sum = T(limb.idle[n * a + b]) + dot6(columns + 6 * a, columns + 6 * b);
        if (b == a) diagonal = sum;
        for (std::size_t k = 0; k < b; ++k) sum = nmadd(of_a[k], of.factor[n * b + k], sum);
        if (b == a) {
          pivot = sum;
        } else {
          of_a[b] = sum * of.pivots[b];
        }
      }
      safe_ = safe_ & (pivot > T(kSafe) * diagonal);
      of.pivots[a] = T(1.0) / sqrt(pivot);
      for (std::size_t b = 0; b < a; ++b) {
        for (std::size_t k = 0; k < 6; ++k) row[k] = nmadd(of_a[b], of.rows[6 * b + k], row[k]);
      }
      for (std::size_t k = 0; k < 6; ++k) row[k] = row[k] * of.pivots[a];
    }
  }

  /// Adds a limb's projection P (see MeetStep) to the matrix of the equations of the bodies.
  template <std::size_t n>
  void add_projection(const KernelLimb& limb, const Limb& of) {
    T block[36];
    for (std::size_t row = 0; row < 6; ++row) {
      for (std::size_t k = 0; k <= row; ++k) {
        T sum(row == k ? 1.0 : 0.0);
        for (std::size_t j = 0; j < n; ++j) sum = nmadd(of.rows[6 * j + row], of.rows[6 * j + k], sum);
        block[6 * row + k] = sum;
        block[6 * k + row] = sum;
      }
    }
    if (limb.to != 0) matrix_.add(limb.to, limb.to, block, 1.0);
    if (limb.from == 0) return;
    matrix_.add(limb.from, limb.from, block, 1.0);
    if (limb.to == 0) return;
    matrix_.add(limb.to, limb.from, block, -1.0);
    matrix_.add(limb.from, limb.to, block, -1.0);
  }

  /// Moves the joints of limb e in the active lanes. The mismatch that remains after the step counts as a change,
  /// because the iteration must not end before limbs reach their bodies.
  template <std::size_t n>
  void step(LaneAssembly<T>& state, std::size_t e, Mask active, LaneChange<T>& change) {
    const KernelLimb& limb = problem_.limbs[e];
    const Limb& of = limbs_[e];
    T apart[6];
    for (std::size_t k = 0; k < 6; ++k) apart[k] = twists_[6 * limb.to + k] - twists_[6 * limb.from + k] - of.open[k];
    T dq[kMostOwnJoints];
    T rest[6];
    project<n>(of, apart, dq, rest);
    change.places = max(change.places, dot6(rest, rest));
    for (std::size_t a = n; a-- > 0;) {
      for (std::size_t b = a + 1; b < n; ++b) dq[a] = nmadd(of.factor[n * b + a], dq[b], dq[a]);
      dq[a] = dq[a] * of.pivots[a];
      T& q = state.displacements[limb.first_joint + a];
      q = select(active, q + dq[a], q);
      change.places = max(change.places, dq[a] * dq[a]);
    }
  }

  const KernelProblem& problem_;
  std::vector<Limb> limbs_;  ///< [limbs] mismatch and projection of each limb
  BodyMatrix<T> matrix_;
  /// [6 x bodies] First the right side, after the solution the twists of the bodies, in the coordinates of
  /// KernelProblem::measured; 0 for the base.
  std::vector<T> twists_;
  Mask safe_;  ///< lanes in which all pivots were safely positive when projections were last made
};

}  // namespace poesy::assembly
