#pragma once

#include <span>
#include <string>
#include <vector>

#include "models/file/loops.h"
#include "models/file/mechanism.h"

namespace poesy::file {

/// The given displacements of all joints that move, with those of prismatic joints multiplied by `factor`.
std::vector<double> scaled_displacements(const Mechanism& mechanism, std::span<const double> displacements,
                                         double factor);

/// The result of tracking: the pose, or the end of the path towards it.
struct Tracked {
  /// Displacements from home (rad, m) of all joints that move at the end of the path, limb by limb.
  std::vector<double> displacements;
  PlatformPose pose;        ///< pose of the platform at the end of the path
  Transform platform;       ///< frame base_T_platform at the end of the path
  double share;             ///< share of the path that was tracked; 1 if the pose is reached
  std::string unreachable;  ///< reason why the path ended; empty if the pose is reached
  /// True if the path ended because the loops stay open beyond its end, although the pose at its end is not singular.
  bool open = false;
  double mismatch = 0.0;  ///< response `gap` of perfect limbs at the end of the path if numbers are rounded (m); else 0
  State state = {};       ///< state at the end of the path, with lengths in units of the reach
};

/// The numbers that define the configuration: the coordinates of the platform (inverse kinematics), or the
/// displacements of the drives from home, in the order of drives_of() (forward kinematics).
enum class Given { coordinates, drives };

/// Computes nominal joint displacements at a pose. From home, the tracker changes the given numbers (Given) in
/// proportion, step by step, to their values at the pose. After each step Newton's method solves for all other joint
/// displacements and body poses. The tracker halves a step until Newton's method converges without a long or slow step,
/// so that the limbs stay in the working mode that they have at home. Each Newton step is the least-squares solution
/// with the least norm, so redundant loop equations do no harm. The joints of one drive are one unknown. If several
/// displacements give the pose, the tracker chooses among those nearby the ones with the least sum of squares (rad, and
/// lengths in units of the reach), so that idle freedoms do not depend on the path. With rounded numbers (Precision)
/// the limbs do not quite fit, and the tracker finds the configuration with the least mismatch in the metric. A result
/// depends only on the mechanism and the pose.
class Tracker {
 public:
  /// Copies the mechanism. Precondition for Given::drives: if all drives are held, the platform has no freedom.
  explicit Tracker(const Mechanism& mechanism, Given given = Given::coordinates);

  /// Tracks a pose. numbers: [mechanism.coordinates] or [drives], SI. Does not throw for a pose that is not reached.
  Tracked track(std::span<const double> numbers) const;

 private:
  enum class Ending { closed, slow, open, restless };

  Eigen::MatrixXd matrix_of(const LoopEquations& equations) const;
  Eigen::VectorXd step(const LoopEquations& equations, const State& state) const;
  bool is_closed(const State& state) const;
  bool is_regular(const State& state) const;
  void move_together(State& state) const;
  Ending close(State& state) const;
  bool settle(State& state) const;
  std::string why(const State& state, Ending ending, double share) const;

  Mechanism unit_;                  ///< mechanism with lengths in units of the reach
  double reach_;                    ///< reach, m
  Given by_;                        ///< kind of the given numbers
  std::vector<std::size_t> given_;  ///< indices of the given numbers in a state
  std::vector<double> units_;       ///< [given] SI value of the unit of each given number
  std::vector<std::size_t> free_;   ///< indices of all other numbers in a state, ascending
  std::vector<Drive> shared_;  ///< drives that move several joints; each such drive is one unknown, kept at the index
                               ///< of its first joint
  /// For each limb, the joints whose displacements are not given and that share no drive with others, as indices among
  /// the limb's joints that move.
  std::vector<std::vector<std::size_t>> limb_joints_;
  std::vector<std::size_t> limb_ranks_;  ///< [limbs] rank of the columns of the joints in limb_joints_ at home
  /// Number of idle freedoms: total number of joints in limb_joints_ minus the sum of limb_ranks_.
  std::size_t idle_ = 0;
};

}  // namespace poesy::file
