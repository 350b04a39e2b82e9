#pragma once

#include <span>
#include <string>
#include <vector>

#include "models/file/loops.h"
#include "models/file/mechanism.h"

namespace poesy::file {

/// The displacements [moving] with those of prismatic joints multiplied by a factor.
std::vector<double> scaled_displacements(const Mechanism& mechanism, std::span<const double> displacements,
                                         double factor);

/// A tracked pose, or the end of the path towards it.
struct Tracked {
  std::vector<double> displacements;  ///< [moving], limb by limb, from home (rad, m); at the end of the path
  PlatformPose pose;                  ///< of the platform at the end of the path
  Transform platform;                 ///< base_T_platform at the end of the path
  double share;                       ///< share of the path that was tracked; 1: the pose is reached
  std::string unreachable;            ///< why the path ended; empty: the pose is reached
  /// Whether the path ended because the loops stay open beyond, although no pose on it is singular.
  bool open = false;
  double mismatch = 0.0;  ///< m: gap of the limbs at the end if numbers are rounded; else 0
  State state = {};       ///< at the end, with lengths in units of the reach
};

/// The numbers that define the configuration: the coordinates of the platform (inverse kinematics), or the
/// displacements of the drives from home, in the order of drives_of() (forward kinematics).
enum class Given { coordinates, drives };

/// Computes nominal joint displacements at a pose. Tracks the straight line in the given numbers from home, by Newton's
/// method on all other joints and components of the bodies' poses. Steps along the line are halved until Newton
/// converges at once, so the limbs stay in the working mode of home. Newton steps have the least norm for the rank that
/// the mechanism has at home, so redundant loop equations do no harm. The joints of one drive are one unknown. Among
/// the displacements at a pose those with the least sum of squares nearby (rad, and lengths in units of the reach) are
/// chosen, so that idle freedoms do not depend on the path. With rounded numbers (Precision) a pose is the
/// least-squares one by the metric. A result depends only on the mechanism and the pose.
class Tracker {
 public:
  /// Copies the mechanism. Precondition for drives: if all are held, the platform has no freedom.
  explicit Tracker(const Mechanism& mechanism, Given given = Given::coordinates);

  /// Tracks a pose. numbers: [mechanism.coordinates] or [drives], SI. Never throws for a pose that is not reached.
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

  Mechanism unit_;                  ///< lengths in units of the reach
  double reach_;                    ///< m
  Given by_;                        ///< what is given
  std::vector<std::size_t> given_;  ///< positions of the given numbers in a state
  std::vector<double> units_;       ///< [given] unit of each number, SI
  std::vector<std::size_t> free_;   ///< positions of all other numbers in a state, ascending
  std::vector<Drive> shared_;       ///< drives of several joints; the first joint is the unknown
  /// For each limb, the positions among its moving joints of those that are neither given nor share a drive with
  /// others.
  std::vector<std::vector<std::size_t>> limb_joints_;
  std::vector<std::size_t> limb_ranks_;  ///< rank of their columns at home
  std::size_t idle_ = 0;                 ///< number of joints in excess of these ranks
};

}  // namespace poesy::file
