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

/// One limb with its errors, carriage held where the nominal pose has it; base frame, m.
struct LimbWithErrors {
  lie::Vector3<double> carriage;         ///< centre of the revolute joint
  lie::Matrix3<double> base_R_revolute;  ///< its axis is the second column
  lie::Vector3<double> rod;              ///< from that centre to C_i in the revolute's frame, before it swings
  lie::Vector3<double> joint;            ///< from P to C_i, at the nominal rotation of the platform
};

/// A limb at a nominal configuration with its errors [20], as ordered by Source.
LimbWithErrors limb_with_errors(const Geometry& geometry, const Configuration& nominal, std::size_t limb,
                                std::span<const double, kSources> errors);

/// Finite motion of the platform from its nominal pose, base frame.
struct PlatformMotion {
  lie::Matrix3<double> E;   ///< rotation: the platform stands at E R
  lie::Vector3<double> dr;  ///< displacement of P, m
};

/// How a solve ended.
struct Closing {
  SolveStatus status;        ///< why it ended
  std::uint32_t iterations;  ///< that it took
};

/// Where solves at a nominal configuration start: one step of its Jacobian from no motion, which is the first order of
/// what the errors do. At a singular pose solves start without motion.
class ClosureStart {
 public:
  /// For limbs about a nominal configuration.
  ClosureStart(const Geometry& geometry, const Configuration& nominal);

  /// The motion to first order, where a solve starts.
  PlatformMotion operator()(const std::array<LimbWithErrors, kLimbs>& limbs) const;

  /// [delta; dr] from the values of the six equations without motion; zero at a singular pose.
  const lie::Matrix6<double>& from_residual() const { return from_residual_; }
  /// Order of the equations in which partial pivoting eliminates [dr; delta]: equation n stands at the n-th place
  /// named.
  const std::array<std::size_t, 6>& elimination_order() const { return order_; }
  /// Sign of the Jacobian's determinant without errors and motion, as 1.0 or -1.0; 0 at a singular pose.
  double orientation() const { return orientation_; }
  /// Sign of the product of the pivots in that order; 0 likewise.
  double pivot_sign() const { return pivot_sign_; }

 private:
  lie::Vector3<double> r_;
  lie::Matrix6<double> from_residual_;
  std::array<std::size_t, 6> order_;
  double orientation_ = 0.0;
  double pivot_sign_ = 0.0;
};

/// Below which a change (rad, m) may be rounding: 64 eps x max(1, |r|).
double rounding_level(const lie::Vector3<double>& r);

/// What one iteration did.
struct ClosureIteration {
  lie::Screw<double> residual;  ///< of the six equations before the step: of rods (m^2), of joints (m)
  lie::Screw<double> step;      ///< [delta; dr] (rad, m)
};
/// Called after each iteration.
using ClosureObserver = std::function<void(const ClosureIteration&)>;

/// Finds the motion at which all limbs close, to finite size of all errors: the nine equations
///   r + dr + E R R_i (c0 + dc_i) = R_i (a0 + da_i) + R_i E(tA_i) e3 (q_i + dq_i) + R_i E(tA_i) E(tB_i) db_i
///                                  + R_i E(tA_i) E(tB_i) Ry(th_i + dphi_i) E(tB'_i) e3 (l + dl_i),  i = 1, 2, 3
/// of which Eq. 14 is the first order. The swings dphi_i are eliminated exactly: a rod that turns about its revolute
/// joint keeps its length and its component along the joint. That leaves six equations for E and dr, which Newton
/// solves with their exact Jacobian; Gauss-Newton is the same there. A rod's equation is (|rod|^2 - l^2) / 2.
///
/// Stopping rule. With c_j the largest component of the step j (rad, m), step j ends the solve as
///   converged      when c_j is below the tolerance;
///   stagnated      when c_j is at rounding level, 64 eps x max(1, |r|), and not below the smallest c so far;
///   iteration_cap  when j is the allowed number of iterations;
///   singular       when a pivot of the Jacobian falls to rounding, or when the solve has come to rest where the
///                  determinant of the Jacobian has the other sign: no way leads there from the nominal pose, as errors
///                  grow from zero, but through a singular one (theory.md, "Which root");
///   non_finite     when an equation's value is not finite.
/// A solve that ends at the cap or as singular is not_assembled instead where is_impossible() says so and orientation
/// is not 0. `motion` is the start on entry, the last iterate on return. orientation: ClosureStart::orientation(); 0
/// where any root will do. observe: may be empty.
Closing close_limbs(const std::array<LimbWithErrors, kLimbs>& limbs, const lie::Vector3<double>& r, double orientation,
                    const SolverOptions& options, PlatformMotion& motion, const ClosureObserver& observe = {});

/// Whether the limbs cannot be assembled: whether they are apart, by more than 1e-9 of |r|, where their mismatch comes
/// to rest on the way downhill from this motion (linalg::comes_to_rest()). Three limbs of the 3-PRS are no
/// over-constraint, so what is left there is what no joint can take away. False where it does not come to rest.
bool is_impossible(const std::array<LimbWithErrors, kLimbs>& limbs, const lie::Vector3<double>& r,
                   const PlatformMotion& start);

/// Swing of a limb's rod from th = 0 in the revolute's frame at this motion, th_i + dphi_i (rad).
double swing(const LimbWithErrors& limb, const lie::Vector3<double>& r, const PlatformMotion& motion);

/// Closes the limbs of blocks of samples with the fastest kernel this machine has; what a kernel gives up, close_limbs
/// solves. Owns the scratch of one thread.
class ClosureSolver {
 public:
  /// For one thread.
  ClosureSolver(const Geometry& geometry, const SolverOptions& options);

  /// Responses, status and iterations of a block at its nominal configuration; no details.
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

/// Solves one sample of a block by close_limbs; no details.
void close_sample(const Geometry& geometry, const Configuration& nominal, const SampleBlock& samples,
                  std::size_t sample, const ClosureStart& start, const SolverOptions& options,
                  const OutcomeBlock& outcomes, const ClosureObserver& observe = {});

/// Limbs of one sample of a block.
std::array<LimbWithErrors, kLimbs> limbs_of_sample(const Geometry& geometry, const Configuration& nominal,
                                                   const SampleBlock& samples, std::size_t sample);

}  // namespace poesy::three_prs
