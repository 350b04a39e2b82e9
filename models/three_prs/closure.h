#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/error_mapping.h"
#include "models/three_prs/kernels.h"
#include "models/three_prs/tiles.h"

namespace poesy::three_prs {

/// One limb with its errors (m). Vectors are in the base frame, except the rod. The drive holds the carriage at its
/// nominal displacement.
struct LimbWithErrors {
  lie::Vector3<double> carriage;         ///< centre of the revolute joint
  lie::Matrix3<double> base_R_revolute;  ///< rotation matrix; its second column is the axis of the revolute joint
  /// From the carriage to the spherical joint C_i, in the revolute joint's frame before the swing.
  lie::Vector3<double> rod;
  lie::Vector3<double> joint;  ///< from P to C_i, at the nominal rotation of the platform
};

/// The limb at a nominal configuration with its errors [20] (rad, m), in the order of Source.
LimbWithErrors limb_with_errors(const Geometry& geometry, const Configuration& nominal, std::size_t limb,
                                std::span<const double, kSources> errors);

/// The finite motion of the platform from its nominal pose, in the base frame.
struct PlatformMotion {
  lie::Matrix3<double> E;   ///< rotation: it takes the nominal orientation R of the platform to E R
  lie::Vector3<double> dr;  ///< displacement of P, m
};

/// How a solve ended.
struct Closing {
  SolveStatus status;        ///< why the solve ended
  std::uint32_t iterations;  ///< number of iterations
};

/// Computes the starting point of solves at a nominal configuration. This point is the first-order motion that the
/// errors cause: one Newton step from zero displacement with the nominal Jacobian. At a singular pose solves start from
/// zero displacement.
class ClosureStart {
 public:
  /// Inverts the nominal Jacobian at a configuration.
  ClosureStart(const Geometry& geometry, const Configuration& nominal);

  /// The first-order motion of the platform for limbs with errors, at which a solve starts.
  PlatformMotion operator()(const std::array<LimbWithErrors, kLimbs>& limbs) const;

  /// The matrix that maps the values of the six equations at zero displacement to the first-order motion [delta; dr]:
  /// rotation vector of the platform (rad) and displacement of P (m). Zero at a singular pose.
  const lie::Matrix6<double>& from_residual() const { return from_residual_; }
  /// The order in which partial pivoting eliminates the six equations, if the columns of the Jacobian are in the order
  /// [dr; delta]: entry n is the place (from 0) of equation n in this order.
  const std::array<std::size_t, 6>& elimination_order() const { return order_; }
  /// The sign of the Jacobian's determinant without errors and motion: 1.0 or -1.0, or 0 at a singular pose.
  double orientation() const { return orientation_; }
  /// The sign of the product of the pivots in elimination_order(): 1.0 or -1.0, or 0 at a singular pose.
  double pivot_sign() const { return pivot_sign_; }

 private:
  lie::Vector3<double> r_;
  lie::Matrix6<double> from_residual_;
  std::array<std::size_t, 6> order_;
  double orientation_ = 0.0;
  double pivot_sign_ = 0.0;
};

/// The level below which a change (rad, m) of the motion may be rounding: 64 eps x max(1, |r|). r: P in the base frame,
/// m.
double rounding_level(const lie::Vector3<double>& r);

/// The residual and the step of one Newton iteration.
struct ClosureIteration {
  /// Values of the six equations before the step: three of rods (m^2), three of joints (m).
  lie::Screw<double> residual;
  lie::Screw<double> step;  ///< step [delta; dr] (rad, m)
};
/// A function that the solver calls after each iteration.
using ClosureObserver = std::function<void(const ClosureIteration&)>;

/// Finds the motion (E, dr) of the platform at which all limbs close, for errors of finite size. In the symbols of San
/// et al. 2023 (d: error or displacement; tA, tB, tB': attitude errors; E(t): their rotations), the nine equations are
///     r + dr + E R R_i (c0 + dc_i) = R_i (a0 + da_i) + R_i E(tA_i) e3 (q_i + dq_i) + R_i E(tA_i) E(tB_i) db_i
///                                    + R_i E(tA_i) E(tB_i) Ry(th_i + dphi_i) E(tB'_i) e3 (l + dl_i),  i = 1, 2, 3
/// of which Eq. 14 of San et al. 2023 is the first order. The swings dphi_i are eliminated exactly: a rod that turns
/// about its revolute joint keeps its length and its component along the joint axis. Newton's method solves the
/// remaining six equations for E and dr with their exact Jacobian; Gauss-Newton is the same method here. The equation
/// of a rod is (|rod|^2 - l^2) / 2.
///
/// Stopping rule: let c_j be the largest component of step j (rad, m). Step j ends the solve as
///     converged      when c_j is below the tolerance;
///     stagnated      when c_j is at most rounding_level(r), and not below the smallest c so far;
///     iteration_cap  when j is the allowed number of iterations;
///     singular       when a pivot of the Jacobian falls to rounding, or when the solve has converged to a root at
///                    which the determinant of the Jacobian has the other sign: as errors grow, every path from the
///                    nominal pose to such a root passes a singular pose (theory.md, "Which root");
///     non_finite     when an equation's value is not finite.
/// A solve that ends at the cap or as singular is not_assembled instead if is_impossible() returns true and orientation
/// is not 0. r: P in the base frame, m. motion: the starting point on entry, the last iterate on return. orientation:
/// ClosureStart::orientation(); 0 accepts any root. observe: may be empty.
Closing close_limbs(const std::array<LimbWithErrors, kLimbs>& limbs, const lie::Vector3<double>& r, double orientation,
                    const SolverOptions& options, PlatformMotion& motion, const ClosureObserver& observe = {});

/// Returns true if the limbs cannot be assembled near `start`. From `start`, a descent (linalg::comes_to_rest()) leads
/// to a minimum of the mismatch of the limbs. The result is true if the mismatch at the minimum is more than 1e-9 of
/// |r|: the three limbs of the 3-PRS do not over-constrain the platform, so the mismatch vanishes if the machine can be
/// assembled near `start`. Returns false if the descent does not converge.
bool is_impossible(const std::array<LimbWithErrors, kLimbs>& limbs, const lie::Vector3<double>& r,
                   const PlatformMotion& start);

/// The swing th_i + dphi_i (rad) of a limb's rod at this motion, measured from th = 0 in the revolute joint's frame.
double swing(const LimbWithErrors& limb, const lie::Vector3<double>& r, const PlatformMotion& motion);

/// Solves the closure of all limbs for blocks of samples with the fastest kernel that this computer supports.
/// close_limbs() solves the samples that the kernel gives up. An object has scratch memory, so each thread needs its
/// own object.
class ClosureSolver {
 public:
  /// Allocates the scratch memory.
  ClosureSolver(const Geometry& geometry, const SolverOptions& options);

  /// Computes responses, status and iterations of a block of samples at its nominal configuration, but not the swings
  /// of the rods.
  void solve(const Configuration& nominal, const SampleBlock& samples, const OutcomeBlock& outcomes);

 private:
  void prepare(const Configuration& nominal, const SampleBlock& samples, const ClosureStart& start);
  void review(const Configuration& nominal, const SampleBlock& samples, const ClosureStart& start,
              const OutcomeBlock& outcomes) const;

  Geometry geometry_;
  SolverOptions options_;
  Kernels kernels_;
  Tiles tiles_;
  ClosurePose pose_{};
  ClosureOptions kernel_options_{};
  std::vector<double> scratch_;
};

/// Solves one sample of a block by close_limbs(). Does not compute the swings of the rods.
void close_sample(const Geometry& geometry, const Configuration& nominal, const SampleBlock& samples,
                  std::size_t sample, const ClosureStart& start, const SolverOptions& options,
                  const OutcomeBlock& outcomes, const ClosureObserver& observe = {});

/// The limbs with the errors of one sample of a block.
std::array<LimbWithErrors, kLimbs> limbs_of_sample(const Geometry& geometry, const Configuration& nominal,
                                                   const SampleBlock& samples, std::size_t sample);

}  // namespace poesy::three_prs
