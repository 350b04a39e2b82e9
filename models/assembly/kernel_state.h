#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include "models/assembly/kernel_map.h"

namespace poesy::assembly {

/// An assembly with errors in each lane: the places of its bodies and joints, and the wrenches of its limbs.
template <class T>
class LaneAssembly {
 public:
  using Mask = typename T::MaskType;  ///< a truth value for each lane
  using Motion = LaneMotion<T>;       ///< a motion in each lane

  /// Both arguments must outlive this object.
  LaneAssembly(const KernelProblem& problem, const KernelBlock& block)
      : bodies(problem.bodies.size()),
        displacements(problem.joints),
        wrenches(6 * problem.limbs.size(), T(0.0)),
        problem_(problem),
        block_(block),
        mapper_(problem, block, KernelMapper<T>::kAllRows) {
    std::size_t segments = 0;
    for (const KernelLimb& limb : problem.limbs) {
      first_segment_.push_back(segments);
      segments += limb.segments.size();
    }
    segments_.resize(segments);
    bodies[0] = in_lanes<T>(problem.bodies[0]);
  }

  /// Sets the errors of the samples from `at` on, one sample in each lane, and their starting points: from the series
  /// of KernelStart if it is used, else from the first-order solution.
  void begin(std::size_t at) {
    const LaneErrors<T> errors(block_, at);
    std::size_t segment = 0;
    for (const KernelLimb& limb : problem_.limbs) {
      for (const KernelSegment& one : limb.segments) segments_[segment++] = errors.segment(one);
    }
    if (!problem_.start.is_used) return start_by_map(at);
    const T t =
        T(problem_.start.scale) * (T(problem_.map.units[0]) * T::load(block_.values + at) - T(problem_.start.centre));
    const Mask outside = !(abs(t) < T(1.0 + 1e-9));
    if (any(outside)) start_by_map(at);
    start_by_series(t, !outside);
  }

  /// The square of the largest move of a body from the nominal pose to the first-order solution. Not meaningful if the
  /// series of KernelStart is used.
  const T& start_move() const { return start_move_; }

  /// Writes the state of the lanes (see KernelStart). row: address of the first number; the others follow at distances
  /// of one stride.
  void store(double* row) const {
    const auto put = [&](T value) {
      value.store(row);
      row += block_.stride;
    };
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      T twist[6];
      log_of(bodies[b], in_lanes<T>(problem_.bodies[b]), twist);
      for (const T& entry : twist) put(entry);
    }
    for (const T& entry : wrenches) put(entry);
    for_each_joint([&](const KernelJoint& one, std::size_t joint) { put(displacements[joint] - T(one.displacement)); });
  }

  /// The pose of the end of limb e with the present displacements of its joints, without elastic deformation. Calls
  /// at_joint(joint, frame) for each joint, with the frame before the joint moves.
  template <class AtJoint>
  Motion walk(std::size_t e, AtJoint at_joint) const {
    const KernelLimb& limb = problem_.limbs[e];
    const Motion* segment = &segments_[first_segment_[e]];
    Motion g = limb.from == 0 ? *segment : product(bodies[limb.from], *segment);
    for (const KernelJoint& joint : limb.joints) {
      at_joint(joint, g);
      const bool moves = joint.passive >= 0;
      const T displacement =
          moves ? displacements[limb.first_joint + static_cast<std::size_t>(joint.passive)] : T(joint.displacement);
      move(joint, displacement, g);
      g = product(g, *++segment);
    }
    return g;
  }

  /// Moves the bodies by twists [6 x bodies] in the active lanes. Returns the square of the longest twist.
  T move_bodies(const std::vector<T>& twists, Mask active) {
    T largest(0.0);
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      const T* twist = &twists[6 * b];
      largest = max(largest, dot6(twist, twist));
      const Motion moved = product(motion_of(twist), bodies[b]);
      for (int k = 0; k < 9; ++k) bodies[b].r[k] = select(active, moved.r[k], bodies[b].r[k]);
      for (int k = 0; k < 3; ++k) bodies[b].p[k] = select(active, moved.p[k], bodies[b].p[k]);
    }
    return largest;
  }

  /// The lanes in which all unknowns are finite.
  Mask is_finite() const {
    T sum(0.0);
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      for (int k = 0; k < 3; ++k) sum = sum + abs(bodies[b].p[k]);
    }
    for (const T& entry : wrenches) sum = sum + abs(entry);
    for (const T& entry : displacements) sum = sum + abs(entry);
    return sum < T(1e300);
  }

  /// Sets the numbers from which the responses are computed.
  void report(LaneOutcome<T>& outcome) const {
    if (problem_.report.has_motions) {
      for (std::size_t b = 1; b < bodies.size(); ++b) displaced(b, outcome.bodies[b]);
      if (problem_.report.has_tool) displace_tool(outcome);
    }
    outcome.wrenches = wrenches;
    for (std::size_t e = 0; problem_.report.has_forces && e < problem_.limbs.size(); ++e) {
      walk(e, [&](const KernelJoint& joint, const Motion& g) {
        if (joint.mark >= 0) outcome.marks[static_cast<std::size_t>(joint.mark)] = g;
      });
    }
  }

  std::vector<Motion> bodies;    ///< [bodies] poses of the bodies
  std::vector<T> displacements;  ///< displacements of the passive joints of all limbs
  std::vector<T> wrenches;       ///< [6 x limbs] wrench of each limb on the body at its end

 private:
  /// Calls visit(joint, index) for each passive joint, with its index among those of all limbs.
  template <class Visit>
  void for_each_joint(Visit visit) const {
    std::size_t joint = 0;
    for (const KernelLimb& limb : problem_.limbs) {
      for (const KernelJoint& one : limb.joints) {
        if (one.passive >= 0) visit(one, joint++);
      }
    }
  }

  void start_by_map(std::size_t at) {
    const T* coordinates = mapper_.coordinates(at);
    start_move_ = T(0.0);
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      const T* twist = coordinates + 6 * (b - 1);
      start_move_ = max(start_move_, dot6(twist, twist));
      bodies[b] = product(motion_of(twist), in_lanes<T>(problem_.bodies[b]));
    }
    if (problem_.carries) mapper_.wrenches(coordinates, wrenches.data());
    const T* dq = coordinates + mapper_.first_joint();
    for_each_joint(
        [&](const KernelJoint& one, std::size_t joint) { displacements[joint] = T(one.displacement) + dq[joint]; });
  }

  /// Sets the starting points of these lanes from the series.
  void start_by_series(T t, Mask lanes) {
    constexpr std::size_t kTerms = KernelStart::kTerms;
    T terms[kTerms] = {T(1.0), t};
    for (std::size_t n = 2; n < kTerms; ++n) terms[n] = nmadd(T(1.0), terms[n - 2], (t + t) * terms[n - 1]);
    const double* of = problem_.start.coefficients.data();
    const auto next = [&] {
      T even = T(of[0]) * terms[0];
      T odd = T(of[1]) * terms[1];
      for (std::size_t n = 2; n < kTerms; n += 2) {
        even = madd(T(of[n]), terms[n], even);
        odd = madd(T(of[n + 1]), terms[n + 1], odd);
      }
      of += kTerms;
      return even + odd;
    };
    for (std::size_t b = 1; b < bodies.size(); ++b) {
      T twist[6];
      for (T& entry : twist) entry = next();
      const Motion moved = product(motion_of(twist), in_lanes<T>(problem_.bodies[b]));
      for (int k = 0; k < 9; ++k) bodies[b].r[k] = select(lanes, moved.r[k], bodies[b].r[k]);
      for (int k = 0; k < 3; ++k) bodies[b].p[k] = select(lanes, moved.p[k], bodies[b].p[k]);
    }
    for (T& entry : wrenches) entry = select(lanes, next(), entry);
    for_each_joint([&](const KernelJoint& one, std::size_t joint) {
      displacements[joint] = select(lanes, T(one.displacement) + next(), displacements[joint]);
    });
  }

  void displaced(std::size_t b, LaneDisplacement<T>& made) const {
    const Motion nominal = in_lanes<T>(problem_.bodies[b]);
    const Motion& body = bodies[b];
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

  /// Sets the displacement of the tool point from that of the platform.
  void displace_tool(LaneOutcome<T>& outcome) const {
    const LaneDisplacement<T>& platform = outcome.bodies[1];
    const auto turn = simd::exp_coefficients(simd::dot3(platform.theta, platform.theta));
    const double* of = problem_.report.arm;
    const T arm[3] = {T(of[0]), T(of[1]), T(of[2])};
    T once[3];
    T twice[3];
    simd::cross(platform.theta, arm, once);
    simd::cross(platform.theta, once, twice);
    for (int k = 0; k < 3; ++k) outcome.tool[k] = madd(turn.b, twice[k], madd(turn.a, once[k], platform.moved[k]));
  }

  const KernelProblem& problem_;
  const KernelBlock& block_;
  KernelMapper<T> mapper_;
  std::vector<std::size_t> first_segment_;  ///< [limbs] index of each limb's first segment among all
  std::vector<Motion> segments_;            ///< motions between the joints of all limbs, with errors
  T start_move_{0.0};                       ///< see start_move()
};

/// How much a round (iteration) changed the state of each lane, and the lanes in which these changes must not be used.
template <class T>
struct LaneChange {
  T places{0.0};    ///< square of the largest change of a body or joint
  T wrenches{0.0};  ///< sum of the squared changes of the wrenches
  /// Lanes in which a pivot was not safely positive. Another solver must solve them.
  typename T::MaskType refused = T(1.0) < T(0.0);
};

}  // namespace poesy::assembly
