#pragma once

// Included only by kernels.cpp, which is compiled once for each instruction set.

#include "models/assembly/kernel_map.h"

namespace poesy::assembly {

/// Limbs against bodies, for batches of samples: the equations of Solver with the matrix of the nominal pose,
///
///     [ C  B0 ; B0^T  0 ] [ dp ; x ] = [ xi - C p ; -load - sum of p ; -J^T p ],
///
/// in which p is carried as an unknown: in its place C^-1 xi would turn rounding into force, and converge for small
/// errors alone. Where limbs do not deform each other and no load acts, p is 0 and is left out. A lane depends on its
/// own sample only: one that has settled stays where it is. The start is where first order leads.
template <class T>
class AssemblyKernel {
 public:
  /// Both must outlive it.
  AssemblyKernel(const KernelProblem& problem, const KernelBlock& block)
      : problem_(problem),
        block_(block),
        mapper_(problem, block, KernelMapper<T>::kAllRows),
        reporter_(problem, block),
        outcome_(problem),
        bodies_(problem.bodies.size()),
        displacements_(problem.joints),
        wrenches_(6 * problem.limbs.size(), T(0.0)),
        mismatch_(wrenches_.size()),
        particular_(wrenches_.size(), T(0.0)),
        right_(problem.size),
        found_(problem.size),
        twists_(6 * problem.bodies.size(), T(0.0)) {
    std::size_t segments = 0;
    for (const KernelLimb& limb : problem.limbs) {
      first_segment_.push_back(segments);
      segments += limb.segments.size();
    }
    segments_.resize(segments);
  }

  void solve() {  ///< Writes what every sample gives.
    for (std::size_t at = 0; at < block_.count; at += T::kLanes) solve_batch(at);
  }

 private:
  using Mask = typename T::MaskType;
  using Motion = LaneMotion<T>;

  /// Squares of what a round changed.
  struct Change {
    T places;    ///< of a body or joint, the largest
    T wrenches;  ///< of all
  };

  void solve_batch(std::size_t at) {
    begin(at);
    before_ = {T(1.0), T(1e300)};
    Mask active = T(0.0) < T(1.0);
    T iterations(0.0);
    for (int n = 0; n < problem_.most_rounds && any(active); ++n) {
      iterations = select(active, iterations + T(1.0), iterations);
      active = active & !round(active);
    }
    end(at, active, iterations);
  }

  /// Where first order leads.
  void begin(std::size_t at) {
    const T* coordinates = mapper_.coordinates(at);
    for (std::size_t b = 1; b < bodies_.size(); ++b) {
      bodies_[b] = product(motion_of(coordinates + 6 * (b - 1)), in_lanes<T>(problem_.bodies[b]));
    }
    if (problem_.carries) mapper_.wrenches(coordinates, wrenches_.data());
    const LaneErrors<T> errors(block_, at);
    const T* dq = coordinates + mapper_.first_joint();
    std::size_t segment = 0;
    std::size_t joint = 0;
    for (const KernelLimb& limb : problem_.limbs) {
      for (const KernelSegment& one : limb.segments) segments_[segment++] = errors.segment(one);
      for (const KernelJoint& one : limb.joints) {
        if (one.passive < 0) continue;
        displacements_[joint] = T(one.displacement) + dq[joint];
        ++joint;
      }
    }
  }

  /// Where the limb's end would be without forces. at_joint(joint, frame): called for each joint before its motion.
  template <class AtJoint>
  Motion walk(std::size_t e, AtJoint at_joint) const {
    const KernelLimb& limb = problem_.limbs[e];
    const Motion* segment = &segments_[first_segment_[e]];
    Motion g = limb.from == 0 ? *segment : product(bodies_[limb.from], *segment);
    for (const KernelJoint& joint : limb.joints) {
      at_joint(joint, g);
      const bool moves = joint.passive >= 0;
      const T displacement =
          moves ? displacements_[limb.first_joint + static_cast<std::size_t>(joint.passive)] : T(joint.displacement);
      move(joint, displacement, g);
      g = product(g, *++segment);
    }
    return g;
  }

  // ---- one round

  /// Mismatch of a limb, and what is left of its equations.
  void visit(std::size_t e) {
    const KernelLimb& limb = problem_.limbs[e];
    const T* p = &wrenches_[6 * e];
    T* rest = &particular_[6 * e];
    T* xi = &mismatch_[6 * e];
    if (!problem_.carries) {
      log_of(walk(e, [](const KernelJoint&, const Motion&) {}), bodies_[limb.to], xi);
      set_right(limb, xi);
      return;
    }
    for (int k = 0; k < 6; ++k) rest[k] = T(0.0);
    const Motion end = walk(e, [&](const KernelJoint& joint, const Motion& g) {
      if (joint.passive >= 0) add_felt(limb, joint, g, p, rest);
    });
    log_of(end, bodies_[limb.to], xi);
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

  /// Adds the wrench that takes away what a passive joint feels of p.
  static void add_felt(const KernelLimb& limb, const KernelJoint& joint, const Motion& g, const T* p, T* rest) {
    T twist[6];
    twist_of(joint, g, twist);
    const T felt = dot6(twist, p);
    const double* give = &limb.give[6 * static_cast<std::size_t>(joint.passive)];
    for (int k = 0; k < 6; ++k) rest[k] = nmadd(T(give[k]), felt, rest[k]);
  }

  /// The limb's part of the right side: what is left, along the wrenches that it can carry.
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

  std::size_t first_body_row() const { return problem_.size - 6 * (bodies_.size() - 1); }

  /// Without wrenches the rows of bodies are 0, and nobody asks for lambda.
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

  /// Moves the limb's wrench in the lanes that go on. Returns the square of its change.
  T step_wrench(std::size_t e, Mask active, T* wanted) {
    const KernelLimb& limb = problem_.limbs[e];
    T* p = &wrenches_[6 * e];
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

  /// Moves wrench and joints of a limb in the lanes that go on.
  void step(std::size_t e, Mask active, Change& change) {
    const KernelLimb& limb = problem_.limbs[e];
    T wanted[6];
    for (std::size_t k = 0; k < 6; ++k) {
      wanted[k] = twists_[6 * limb.to + k] - twists_[6 * limb.from + k] - mismatch_[6 * e + k];
    }
    if (problem_.carries) change.wrenches = change.wrenches + step_wrench(e, active, wanted);
    for (std::size_t j = 0; j < limb.passive; ++j) {
      T& q = displacements_[limb.first_joint + j];
      T dq = T(limb.give[6 * j]) * wanted[0];
      for (std::size_t k = 1; k < 6; ++k) dq = madd(T(limb.give[6 * j + k]), wanted[k], dq);
      q = select(active, q + dq, q);
      change.places = max(change.places, dq * dq);
    }
  }

  /// Moves the bodies in the lanes that go on.
  void move_bodies(Mask active, Change& change) {
    for (std::size_t b = 1; b < bodies_.size(); ++b) {
      const T* twist = &twists_[6 * b];
      change.places = max(change.places, dot6(twist, twist));
      const Motion moved = product(motion_of(twist), bodies_[b]);
      for (int k = 0; k < 9; ++k) bodies_[b].r[k] = select(active, moved.r[k], bodies_[b].r[k]);
      for (int k = 0; k < 3; ++k) bodies_[b].p[k] = select(active, moved.p[k], bodies_[b].p[k]);
    }
  }

  /// One round. Returns the lanes that settled in it.
  Mask round(Mask active) {
    for (T& row : right_) row = T(0.0);
    for (std::size_t b = 1; b < bodies_.size(); ++b) {
      for (std::size_t k = 0; k < 6; ++k) add_to_body(b, k, T(-problem_.load[6 * b + k]));
    }
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) visit(e);
    solve_linear();
    for (std::size_t k = 6; k < twists_.size(); ++k) twists_[k] = found_[first_body_row() + k - 6];
    Change change{T(0.0), T(0.0)};
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) step(e, active, change);
    move_bodies(active, change);
    const Mask settled = has_settled(change);
    before_ = change;
    return settled;
  }

  /// Whether the next round would change no more than rounding: by this one's change, or where that is small enough to
  /// shrink on as it did in this round.
  Mask has_settled(const Change& change) const {
    const T tolerance(problem_.tolerance * problem_.tolerance);
    const auto rests = [](T now, T before, T limit, T small) {
      return (!(now > limit)) | ((now * now < T(kNext) * limit * before) & (now < small));
    };
    Mask settled = rests(change.places, before_.places, tolerance, T(kShort) * tolerance);
    if (problem_.wants_wrenches) {
      T whole(0.0);
      for (const T& wrench : wrenches_) whole = madd(wrench, wrench, whole);
      settled = settled & rests(change.wrenches, before_.wrenches, T(kWrenches) * whole, T(kShort * kWrenches) * whole);
    }
    return settled & (change.places < T(kFarthest));
  }

  // ---- what comes of it

  void displaced(std::size_t b, LaneDisplacement<T>& made) const {
    const Motion nominal = in_lanes<T>(problem_.bodies[b]);
    const Motion& body = bodies_[b];
    T turned[9];
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        turned[3 * row + column] = simd::dot3(body.r + 3 * row, nominal.r + 3 * column);
      }
      made.moved[row] = body.p[row] - nominal.p[row];
    }
    const auto turn = simd::rotation_log(turned);
    for (int k = 0; k < 3; ++k) made.theta[k] = turn.w[k];
  }

  /// The displacement of the tool's point by that of the platform.
  void displace_tool() {
    const LaneDisplacement<T>& platform = outcome_.bodies[1];
    const auto turn = simd::exp_coefficients(simd::dot3(platform.theta, platform.theta));
    const double* of = problem_.report.arm;
    const T arm[3] = {T(of[0]), T(of[1]), T(of[2])};
    T once[3];
    T twice[3];
    simd::cross(platform.theta, arm, once);
    simd::cross(platform.theta, once, twice);
    for (int k = 0; k < 3; ++k) outcome_.tool[k] = madd(turn.b, twice[k], madd(turn.a, once[k], platform.moved[k]));
  }

  void end(std::size_t at, Mask left, T iterations) {
    for (std::size_t b = 1; b < bodies_.size(); ++b) displaced(b, outcome_.bodies[b]);
    if (problem_.report.has_tool) displace_tool();
    outcome_.wrenches = wrenches_;
    for (std::size_t e = 0; problem_.report.has_forces && e < problem_.limbs.size(); ++e) {
      walk(e, [&](const KernelJoint& joint, const Motion& g) {
        if (joint.mark >= 0) outcome_.marks[static_cast<std::size_t>(joint.mark)] = g;
      });
    }
    reporter_.write(outcome_, at);
    const unsigned lanes = bits(left);
    double counted[T::kLanes];
    iterations.store(counted);
    for (std::size_t lane = 0; lane < T::kLanes; ++lane) {
      block_.ends[at + lane] = (lanes >> lane & 1u) != 0 ? KernelEnd::left : KernelEnd::converged;
      block_.iterations[at + lane] = static_cast<std::uint32_t>(counted[lane]);
    }
  }

  static constexpr double kWrenches = 1e-24;  ///< square of the share of all wrenches that is rounding
  static constexpr double kNext = 1e-2;       ///< square of the share of the tolerance that a next round may change
  static constexpr double kShort = 1e10;      ///< square of a change over the tolerance up to which it is foreseen
  static constexpr double kFarthest = 100.0;  ///< square of a move beyond which a lane has diverged

  const KernelProblem& problem_;
  const KernelBlock& block_;
  KernelMapper<T> mapper_;
  KernelReporter<T> reporter_;
  LaneOutcome<T> outcome_;
  std::vector<std::size_t> first_segment_;  ///< [limbs] among all
  std::vector<Motion> segments_;            ///< of all limbs, with errors
  std::vector<Motion> bodies_;
  std::vector<T> displacements_;  ///< of passive joints
  std::vector<T> wrenches_;       ///< [6 x limbs] p
  std::vector<T> mismatch_;       ///< [6 x limbs] xi
  std::vector<T> particular_;     ///< [6 x limbs] the part of dp that answers what passive joints feel
  std::vector<T> right_;
  std::vector<T> found_;
  std::vector<T> twists_;  ///< [6 x bodies]
  Change before_;          ///< of the last round
};

/// Solves a block with batches of T.
template <class T>
void solve_assemblies(const KernelProblem& problem, const KernelBlock& block) {
  AssemblyKernel<T>(problem, block).solve();
}

}  // namespace poesy::assembly
