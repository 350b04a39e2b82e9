#pragma once

#include <span>
#include <string>
#include <vector>

#include "models/file/loops.h"
#include "models/file/mechanism.h"

namespace poesy::file {

/// The displacements [moving] with those of prismatic joints times a factor.
std::vector<double> scaled_displacements(const Mechanism& mechanism, std::span<const double> displacements,
                                         double factor);

/// A pose, or how far the way there went.
struct Tracked {
  std::vector<double> displacements;  ///< [moving], limb by limb, from home (rad, m); at the end of the way
  PlatformPose pose;                  ///< of the platform there
  Transform platform;                 ///< base_T_platform there
  double share;                       ///< of the way from home; 1: the pose is reached
  std::string unreachable;            ///< why the way ended; empty: the pose is reached
  /// Whether it ended because the loops stay open beyond, although nothing is singular there.
  bool open = false;
  double mismatch = 0.0;  ///< m: the limbs' gap at the end, of rounded numbers; else 0
};

/// What says where the mechanism is: the coordinates of its platform (inverse kinematics), or the displacements of its
/// drives from home, in the order of drives_of() (forward kinematics).
enum class Given { coordinates, drives };

/// Nominal joint displacements at a pose. Tracked from home along the straight line in the given numbers, by Newton's
/// method on all other joints and components of the bodies' poses, in steps that are halved until Newton converges at
/// once: so the limbs stay in the working mode of home. Steps are of least norm in the rank that the mechanism has at
/// home, so redundant loop equations do no harm. The joints of one drive are one unknown. Of all displacements at a
/// pose those are taken whose squares (rad, and lengths in units of the reach) have the least sum nearby, so that idle
/// freedoms do not depend on the way. Where the mechanism's numbers are rounded (Precision), a pose is the
/// least-squares one by its metric. A result depends on nothing but the mechanism and the pose.
class Tracker {
 public:
  /// The mechanism is copied. Precondition for drives: held, they leave the platform no freedom.
  explicit Tracker(const Mechanism& mechanism, Given given = Given::coordinates);

  /// numbers: [mechanism.coordinates], or [drives], SI. Physics never throws.
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
  std::vector<std::size_t> given_;  ///< places in a state of the given numbers
  std::vector<double> units_;       ///< [given] theirs, SI
  std::vector<std::size_t> free_;   ///< places in a state of all others, ascending
  std::vector<Drive> shared_;       ///< drives of several joints, of which the first is an unknown
  /// Places among each limb's moving joints of those that are not given, and have no drive in common with others.
  std::vector<std::vector<std::size_t>> limb_joints_;
  std::vector<std::size_t> limb_ranks_;  ///< of their columns at home
  std::size_t idle_ = 0;                 ///< joints beyond these ranks
};

}  // namespace poesy::file
