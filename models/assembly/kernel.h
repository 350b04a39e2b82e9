#pragma once

// Included only by kernels.cpp, which is compiled once for each instruction set.

#include <vector>

#include "models/assembly/kernel_problem.h"
#include "models/simd/rotation.h"

namespace poesy::assembly {

/// Limbs against bodies, for batches of samples: the equations of Solver with the matrix of the nominal pose,
///
///     [ C  B0 ; B0^T  0 ] [ dp ; x ] = [ xi - C p ; -load - sum of p ; -J^T p ],
///
/// in which p is carried as an unknown: in its place C^-1 xi would turn rounding into force, and converge for small
/// errors alone. A lane depends on its own sample only: one that has settled stays where it is.
template <class T>
class AssemblyKernel {
 public:
  /// Both must outlive it.
  AssemblyKernel(const KernelProblem& problem, const KernelBlock& block)
      : problem_(problem),
        block_(block),
        bodies_(problem.bodies.size()),
        displacements_(problem.joints),
        wrenches_(6 * problem.limbs.size()),
        mismatch_(wrenches_.size()),
        particular_(wrenches_.size()),
        right_(problem.size),
        found_(problem.size),
        twists_(6 * problem.bodies.size()) {
    for (const KernelLimb& limb : problem.limbs) frames_.resize(frames_.size() + limb.frames.size());
  }

  void solve() {  ///< Writes what every sample gives.
    for (std::size_t at = 0; at < block_.count; at += T::kLanes) solve_batch(at);
  }

 private:
  using Mask = typename T::MaskType;

  struct Motion {
    T r[9];
    T p[3];
  };

  static Motion constant(const KernelMotion& motion) {
    Motion made;
    for (int k = 0; k < 9; ++k) made.r[k] = T(motion.r[k]);
    for (int k = 0; k < 3; ++k) made.p[k] = T(motion.p[k]);
    return made;
  }

  static Motion product(const Motion& a, const Motion& b) {
    Motion c;
    for (int row = 0; row < 3; ++row) {
      const T* of_a = a.r + 3 * row;
      for (int column = 0; column < 3; ++column) {
        c.r[3 * row + column] = madd(of_a[2], b.r[6 + column], madd(of_a[1], b.r[3 + column], of_a[0] * b.r[column]));
      }
      c.p[row] = madd(of_a[2], b.p[2], madd(of_a[1], b.p[1], madd(of_a[0], b.p[0], a.p[row])));
    }
    return c;
  }

  /// exp of the twist [w; v].
  static Motion motion_of(const T* twist) {
    const T* w = twist;
    const T* v = twist + 3;
    const T x = simd::dot3(w, w);
    const auto turn = simd::exp_coefficients(x);
    const auto left = simd::left_jacobian_coefficients(x);
    Motion made;
    simd::rotation_matrix(w, x, turn, made.r);
    T once[3];
    T twice[3];
    simd::cross(w, v, once);
    simd::cross(w, once, twice);
    for (int k = 0; k < 3; ++k) made.p[k] = madd(left.c, twice[k], madd(left.b, once[k], v[k]));
    return made;
  }

  // ---- frames with errors

  T entry(const KernelFrame& frame, int n, std::size_t at) const {
    const int row = frame.varied[n];
    if (row < 0) return T(frame.constant[n]);
    return T::load(block_.values + static_cast<std::size_t>(row) * block_.stride + at);
  }

  Motion frame_at(const KernelFrame& frame, std::size_t at) const {
    const Motion before = constant(frame.before);
    if (!frame.has_error) return before;
    T e[6];
    for (int n = 0; n < 6; ++n) e[n] = entry(frame, n, at);
    Motion error;
    if (frame.turns) {
      const T x = simd::dot3(e, e);
      auto turn = simd::exp_coefficients(x);
      if (frame.inverted) turn.a = -turn.a;
      simd::rotation_matrix(e, x, turn, error.r);
    } else {
      for (int k = 0; k < 9; ++k) error.r[k] = T(k % 4 == 0 ? 1.0 : 0.0);
    }
    for (int row = 0; row < 3; ++row) {
      error.p[row] = frame.inverted ? -simd::dot3(error.r + 3 * row, e + 3) : e[3 + row];
    }
    return product(product(before, error), constant(frame.behind));
  }

  // ---- one round

  void move(const KernelJoint& joint, T displacement, Motion& g) const {
    if (joint.slides || joint.advance != 0.0) {
      const T way = joint.slides ? displacement : T(joint.advance) * displacement;
      for (int row = 0; row < 3; ++row) g.p[row] = madd(g.r[3 * row + 2], way, g.p[row]);
    }
    if (joint.slides) return;
    const auto [sine, cosine] = simd::sin_cos(displacement);
    for (int row = 0; row < 3; ++row) {
      T* of = g.r + 3 * row;
      const T x = of[0];
      of[0] = madd(sine, of[1], cosine * x);
      of[1] = nmadd(sine, x, cosine * of[1]);
    }
  }

  /// The column of a passive joint times p: what it would do.
  static T work(const KernelJoint& joint, const Motion& g, const T* p) {
    const T axis[3] = {g.r[2], g.r[5], g.r[8]};
    if (joint.slides) return simd::dot3(axis, p + 3);
    T moment[3];
    simd::cross(g.p, axis, moment);
    T sum = simd::dot3(axis, p) + simd::dot3(moment, p + 3);
    if (joint.advance != 0.0) sum = madd(T(joint.advance), simd::dot3(axis, p + 3), sum);
    return sum;
  }

  /// Mismatch of the lanes that go on, and what is left of the limb's equations: its part of the right side, and the
  /// wrench that takes away what its passive joints feel.
  void visit(std::size_t e, const Motion* frames, Mask active) {
    const KernelLimb& limb = problem_.limbs[e];
    const T* p = &wrenches_[6 * e];
    T* rest = &particular_[6 * e];
    for (int k = 0; k < 6; ++k) rest[k] = T(0.0);
    Motion g = product(bodies_[limb.from], frames[0]);
    for (std::size_t j = 0; j < limb.joints.size(); ++j) {
      const KernelJoint& joint = limb.joints[j];
      if (joint.passive >= 0) {
        const T felt = -work(joint, g, p);
        const double* give = &limb.give[6 * static_cast<std::size_t>(joint.passive)];
        for (int k = 0; k < 6; ++k) rest[k] = madd(T(give[k]), felt, rest[k]);
      }
      move(joint, displacements_[limb.first_joint + j], g);
      g = product(g, frames[j + 1]);
    }
    T open[6];
    log_of(g, bodies_[limb.to], open);
    for (std::size_t k = 0; k < 6; ++k) mismatch_[6 * e + k] = select(active, open[k], mismatch_[6 * e + k]);
    T left[6];
    for (int k = 0; k < 6; ++k) {
      T sum = mismatch_[6 * e + static_cast<std::size_t>(k)];
      for (int n = 0; n < 6; ++n) sum = nmadd(T(limb.compliance[6 * k + n]), p[n] + rest[n], sum);
      left[k] = sum;
    }
    for (std::size_t m = 0; m < limb.carried; ++m) {
      T sum = T(limb.carry[m]) * left[0];
      for (std::size_t k = 1; k < 6; ++k) sum = madd(T(limb.carry[k * limb.carried + m]), left[k], sum);
      right_[limb.first_wrench + m] = sum;
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const T all = p[k] + rest[k];
      add_to_body(limb.to, k, -all);
      add_to_body(limb.from, k, all);
    }
  }

  void add_to_body(std::size_t body, std::size_t k, T value) {
    if (body == 0) return;
    T& row = right_[problem_.size - 6 * (bodies_.size() - body) + k];
    row = row + value;
  }

  /// log(a b^-1) as [w; v].
  static void log_of(const Motion& a, const Motion& b, T* twist) {
    Motion c;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) c.r[3 * row + column] = simd::dot3(a.r + 3 * row, b.r + 3 * column);
      c.p[row] = a.p[row];
    }
    for (int row = 0; row < 3; ++row) {
      for (int n = 0; n < 3; ++n) c.p[row] = nmadd(c.r[3 * row + n], b.p[n], c.p[row]);
    }
    const auto turn = simd::rotation_log(c.r);
    T once[3];
    T twice[3];
    simd::cross(turn.w, c.p, once);
    simd::cross(turn.w, once, twice);
    for (int k = 0; k < 3; ++k) {
      twist[k] = turn.w[k];
      twist[3 + k] = madd(turn.bend, twice[k], nmadd(T(0.5), once[k], c.p[k]));
    }
  }

  void solve_linear() {
    const std::size_t size = problem_.size;
    for (std::size_t row = 0; row < size; ++row) {
      const double* of = &problem_.inverse[row * size];
      T even = T(of[0]) * right_[0];
      T odd = size > 1 ? T(of[1]) * right_[1] : T(0.0);
      std::size_t k = 2;
      for (; k + 1 < size; k += 2) {
        even = madd(T(of[k]), right_[k], even);
        odd = madd(T(of[k + 1]), right_[k + 1], odd);
      }
      if (k < size) even = madd(T(of[k]), right_[k], even);
      found_[row] = even + odd;
    }
  }

  /// Moves wrench and joints of a limb in the lanes that go on. Returns the square of the wrench's change.
  T step(std::size_t e, Mask active) {
    const KernelLimb& limb = problem_.limbs[e];
    T* p = &wrenches_[6 * e];
    T change[6];
    T square(0.0);
    for (std::size_t k = 0; k < 6; ++k) {
      T sum = particular_[6 * e + k];
      for (std::size_t m = 0; m < limb.carried; ++m) {
        sum = madd(T(limb.carry[k * limb.carried + m]), found_[limb.first_wrench + m], sum);
      }
      change[k] = sum;
      square = madd(sum, sum, square);
    }
    T wanted[6];
    for (std::size_t k = 0; k < 6; ++k) {
      T sum = twists_[6 * limb.to + k] - twists_[6 * limb.from + k] - mismatch_[6 * e + k];
      for (std::size_t n = 0; n < 6; ++n) sum = madd(T(limb.compliance[6 * k + n]), p[n] + change[n], sum);
      wanted[k] = sum;
    }
    for (std::size_t k = 0; k < 6; ++k) p[k] = select(active, p[k] + change[k], p[k]);
    for (std::size_t j = 0; j < limb.joints.size(); ++j) {
      if (limb.joints[j].passive < 0) continue;
      const double* give = &limb.give[6 * static_cast<std::size_t>(limb.joints[j].passive)];
      T dq = T(give[0]) * wanted[0];
      for (int k = 1; k < 6; ++k) dq = madd(T(give[k]), wanted[k], dq);
      T& q = displacements_[limb.first_joint + j];
      q = select(active, q + dq, q);
    }
    return square;
  }

  /// Moves the bodies in the lanes that go on. Returns the largest square of a move.
  T move_bodies(Mask active) {
    T largest(0.0);
    for (std::size_t b = 1; b < bodies_.size(); ++b) {
      const T* twist = &twists_[6 * b];
      T square(0.0);
      for (int k = 0; k < 6; ++k) square = madd(twist[k], twist[k], square);
      largest = max(largest, square);
      const Motion moved = product(motion_of(twist), bodies_[b]);
      for (int k = 0; k < 9; ++k) bodies_[b].r[k] = select(active, moved.r[k], bodies_[b].r[k]);
      for (int k = 0; k < 3; ++k) bodies_[b].p[k] = select(active, moved.p[k], bodies_[b].p[k]);
    }
    return largest;
  }

  void begin(std::size_t at) {
    for (std::size_t b = 0; b < bodies_.size(); ++b) bodies_[b] = constant(problem_.bodies[b]);
    for (T& wrench : wrenches_) wrench = T(0.0);
    for (T& open : mismatch_) open = T(0.0);
    std::size_t frame = 0;
    for (const KernelLimb& limb : problem_.limbs) {
      for (std::size_t j = 0; j < limb.joints.size(); ++j) {
        displacements_[limb.first_joint + j] = T(limb.joints[j].displacement);
      }
      for (const KernelFrame& one : limb.frames) frames_[frame++] = frame_at(one, at);
    }
  }

  /// One round. Returns the lanes that settled in it.
  Mask round(Mask active) {
    for (T& row : right_) row = T(0.0);
    for (std::size_t b = 1; b < bodies_.size(); ++b) {
      for (std::size_t k = 0; k < 6; ++k) add_to_body(b, k, T(-problem_.load[6 * b + k]));
    }
    std::size_t frame = 0;
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
      visit(e, &frames_[frame], active);
      frame += problem_.limbs[e].frames.size();
    }
    solve_linear();
    const std::size_t first = problem_.size - 6 * (bodies_.size() - 1);
    for (std::size_t k = 0; k < 6; ++k) twists_[k] = T(0.0);
    for (std::size_t k = 6; k < twists_.size(); ++k) twists_[k] = found_[first + k - 6];
    T change(0.0);
    T whole(0.0);
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) change = change + step(e, active);
    const T moved = move_bodies(active);
    Mask settled = !(moved > T(problem_.tolerance * problem_.tolerance));
    if (problem_.wants_wrenches) {
      for (const T& wrench : wrenches_) whole = madd(wrench, wrench, whole);
      settled = settled & !(change > T(kWrenches * kWrenches) * whole);
    }
    return settled & (moved < T(kFarthest));
  }

  void solve_batch(std::size_t at) {
    begin(at);
    Mask active = T(0.0) < T(1.0);
    T iterations(0.0);
    for (int n = 0; n < problem_.most_rounds && any(active); ++n) {
      iterations = select(active, iterations + T(1.0), iterations);
      active = active & !round(active);
    }
    write(at, active, iterations);
  }

  void write(std::size_t at, Mask left, T iterations) {
    double* row = block_.rows + at;
    const auto put = [&](T value) {
      value.store(row);
      row += block_.stride;
    };
    for (const Motion& body : bodies_) {
      for (const T& value : body.r) put(value);
      for (const T& value : body.p) put(value);
    }
    for (const T& value : displacements_) put(value);
    for (const T& value : wrenches_) put(value);
    for (const T& value : mismatch_) put(value);
    const unsigned lanes = bits(left);
    double counted[T::kLanes];
    iterations.store(counted);
    for (std::size_t lane = 0; lane < T::kLanes; ++lane) {
      block_.ends[at + lane] = (lanes >> lane & 1u) != 0 ? KernelEnd::left : KernelEnd::converged;
      block_.iterations[at + lane] = static_cast<std::uint32_t>(counted[lane]);
    }
  }

  static constexpr double kWrenches = 1e-12;  ///< a change of all wrenches by this share is rounding
  static constexpr double kFarthest = 100.0;  ///< square of a move beyond which a lane has diverged

  const KernelProblem& problem_;
  const KernelBlock& block_;
  std::vector<Motion> frames_;  ///< of all limbs, with errors
  std::vector<Motion> bodies_;
  std::vector<T> displacements_;
  std::vector<T> wrenches_;    ///< [6 x limbs] p
  std::vector<T> mismatch_;    ///< [6 x limbs] xi
  std::vector<T> particular_;  ///< [6 x limbs] the part of dp that answers what passive joints feel
  std::vector<T> right_;
  std::vector<T> found_;
  std::vector<T> twists_;  ///< [6 x bodies]
};

/// Solves a block with batches of T.
template <class T>
void solve_assemblies(const KernelProblem& problem, const KernelBlock& block) {
  AssemblyKernel<T>(problem, block).solve();
}

}  // namespace poesy::assembly
