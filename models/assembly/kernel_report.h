#pragma once

// This header belongs to kernels.cpp alone, which is compiled once for each instruction set.

#include "models/assembly/kernel_motion.h"

namespace poesy::assembly {

/// The displacement of a body, in the kernel's units and axes.
template <class T>
struct LaneDisplacement {
  T moved[3];  ///< displacement of the body's origin
  T theta[3];  ///< rotation vector
};

/// The outcome of a batch of samples, from which all responses follow.
template <class T>
struct LaneOutcome {
  /// Allocates memory for the bodies, limbs and reported frames of this problem.
  explicit LaneOutcome(const KernelProblem& problem)
      : bodies(problem.bodies.size()), wrenches(6 * problem.limbs.size()), marks(problem.report.marks) {}

  std::vector<LaneDisplacement<T>> bodies;  ///< [bodies] displacements; that of the base is not read
  T tool[3];                                ///< displacement of the tool point, if there is a tool
  std::vector<T> wrenches;                  ///< [6 x limbs] wrench of each limb on the body at its end
  std::vector<LaneMotion<T>> marks;         ///< [marks] frames of joints before the joints move
};

/// Writes the responses of a batch of samples, like response_values() for one sample.
template <class T>
class KernelReporter {
 public:
  /// problem, block: must outlive this object. rounding: a displacement or mismatch below this is rounding and is
  /// written as 0; in units of the reach, or rad.
  KernelReporter(const KernelProblem& problem, const KernelBlock& block, double rounding)
      : problem_(problem), report_(problem.report), block_(block), rounding_(rounding) {}

  /// Writes the responses of the samples from `at` on, one sample in each lane.
  void write(const LaneOutcome<T>& outcome, std::size_t at) {
    row_ = block_.responses + at;
    if (report_.deforms) put_deformation(outcome);
    if (report_.has_motions) put_motions(outcome);
    if (report_.has_forces) put_forces(outcome);
    if (block_.mismatch != nullptr) write_mismatch(outcome, at);
  }

 private:
  void put(T value) {
    value.store(row_);
    row_ += block_.stride;
  }

  /// Converts a displacement or mismatch from the kernel's units to SI and writes it; writes 0 if it is rounding.
  void put_above_rounding(T value, double unit) { put(T(unit) * select(abs(value) < T(rounding_), T(0.0), value)); }

  /// Converts a vector from the kernel's axes and units to the base's axes and SI, and writes it. with_norm: also
  /// writes its length behind it.
  void put_vector(const T* vector, double unit, bool with_norm) {
    for (int row = 0; row < 3; ++row) {
      const double* axis = report_.axes + 3 * row;
      put_above_rounding(madd(T(axis[2]), vector[2], madd(T(axis[1]), vector[1], T(axis[0]) * vector[0])), unit);
    }
    if (with_norm) put_above_rounding(norm(vector, 1.0), unit);
  }

  static T norm(const T* vector, double unit) { return T(unit) * sqrt(simd::dot3(vector, vector)); }

  void put(const LaneDisplacement<T>& body) {
    put_vector(body.moved, report_.length, false);
    put_vector(body.theta, 1.0, false);
    put_above_rounding(norm(body.moved, 1.0), report_.length);
    put_above_rounding(norm(body.theta, 1.0), 1.0);
  }

  void put_motions(const LaneOutcome<T>& outcome) {
    put(outcome.bodies[1]);
    if (report_.has_tool) put_vector(outcome.tool, report_.length, true);
    for (std::size_t b = 2; b < outcome.bodies.size(); ++b) put(outcome.bodies[b]);
  }

  void write_mismatch(const LaneOutcome<T>& outcome, std::size_t at) const {
    double* row = block_.mismatch + at;
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
      T xi[6];
      mismatch(e, &outcome.wrenches[6 * e], xi);
      for (int k = 0; k < 6; ++k, row += block_.stride) xi[k].store(row);
    }
  }

  /// Computes the mismatch xi = C p between the end of limb e and its body, from the limb's compliance C and wrench p.
  void mismatch(std::size_t e, const T* p, T* xi) const {
    const double* of = problem_.limbs[e].compliance;
    for (int row = 0; row < 6; ++row, of += 6) {
      T sum = T(of[0]) * p[0];
      for (int k = 1; k < 6; ++k) sum = madd(T(of[k]), p[k], sum);
      xi[row] = sum;
    }
  }

  void put_deformation(const LaneOutcome<T>& outcome) {
    T gap(0.0);
    T angular(0.0);
    T linear(0.0);
    const T origin[3] = {T(report_.origin[0]), T(report_.origin[1]), T(report_.origin[2])};
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
      T xi[6];
      mismatch(e, &outcome.wrenches[6 * e], xi);
      for (int k = 0; k < 6; ++k) gap = madd(T(report_.metric[k]) * xi[k], xi[k], gap);
      angular = angular + simd::dot3(xi, xi);
      simd::add_cross(xi, origin, xi + 3);
      linear = linear + simd::dot3(xi + 3, xi + 3);
    }
    const T share(report_.share);
    put_above_rounding(sqrt(share * gap), 1.0);
    put_above_rounding(sqrt(share * angular), 1.0);
    put_above_rounding(sqrt(share * linear), report_.length);
  }

  /// Computes the moment of a wrench about a point.
  static void moment_about(const T* point, const T* wrench, T* moment) {
    simd::cross(wrench + 3, point, moment);
    for (int k = 0; k < 3; ++k) moment[k] = moment[k] + wrench[k];
  }

  void put_forces(const LaneOutcome<T>& outcome) {
    T energy(0.0);
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
      T xi[6];
      mismatch(e, &outcome.wrenches[6 * e], xi);
      energy = energy + dot6(xi, &outcome.wrenches[6 * e]);
    }
    put(T(0.5 * report_.moment) * energy);
    for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
      const T* wrench = &outcome.wrenches[6 * e];
      T moment[3];
      moment_about(outcome.marks[report_.moments[e]].p, wrench, moment);
      put(norm(wrench + 3, report_.force));
      put(norm(moment, report_.moment));
    }
    for (const KernelMark& drive : report_.drives) {
      T twist[6];
      twist_of(drive.joint, outcome.marks[drive.mark], twist);
      const double unit = drive.joint.slides ? report_.force : report_.moment;
      put(T(unit) * dot6(twist, &outcome.wrenches[6 * drive.limb]));
    }
    for (const KernelMark& joint : report_.reactions) put_reaction(joint, outcome);
  }

  /// Writes the force and the moment of a joint along the axes of its frame.
  void put_reaction(const KernelMark& joint, const LaneOutcome<T>& outcome) {
    const LaneMotion<T>& frame = outcome.marks[joint.mark];
    const T* wrench = &outcome.wrenches[6 * joint.limb];
    T moment[3];
    moment_about(frame.p, wrench, moment);
    put_along(frame, wrench + 3, report_.force);
    put_along(frame, moment, report_.moment);
  }

  void put_along(const LaneMotion<T>& frame, const T* vector, double unit) {
    for (int k = 0; k < 3; ++k) {
      const T axis[3] = {frame.r[k], frame.r[3 + k], frame.r[6 + k]};
      put(T(unit) * simd::dot3(axis, vector));
    }
  }

  const KernelProblem& problem_;
  const KernelReport& report_;
  const KernelBlock& block_;
  double rounding_;        ///< see KernelReporter()
  double* row_ = nullptr;  ///< address of the next response
};

}  // namespace poesy::assembly
