#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/array.h"

/// Machines that are built once and used at all poses: a machine is one set of errors, and it is good if it keeps every
/// limit at every pose. The machines of a block are its samples.
namespace poesy {

/// Machines that are rejected, or samples at one pose.
struct Rejects {
  std::uint64_t strict = 0;   ///< a sample that does not count (not solved) is a reject
  std::uint64_t lenient = 0;  ///< a sample that does not count is no reject; at most as many

  friend bool operator==(const Rejects&, const Rejects&) = default;  ///< Both.
};

/// How many machines are good. A response without a limit rejects no machine but, strictly, those with a sample that
/// does not count, because its limit is infinite.
struct MachineCounts {
  std::uint64_t machines = 0;               ///< that were tried
  std::uint64_t unsolved = 0;               ///< machines with a sample that does not count, at one pose or more
  Rejects all;                              ///< machines that break any limit at any pose
  Array<Rejects, axis::Response> by_limit;  ///< machines that break this limit at any pose
  Array<Rejects, axis::Response, axis::Pose> at_pose;  ///< machines that break this limit at this pose

  /// Both together; exact, so in any order. One of no machines has no sizes and takes those of the other one.
  void merge(const MachineCounts& other);

  /// Of no machines, with room for so many responses and poses.
  static MachineCounts of_none(std::size_t responses, std::size_t poses);
  void state(Archive& archive);  ///< Every count, of lists that have their lengths.

  friend bool operator==(const MachineCounts&, const MachineCounts&) = default;  ///< All counts.
};

/// Some machines, to which the outcomes of one pose after another are added. Memory: 17 bytes for each response of a
/// machine, whatever the number of poses.
/// A machine with a sample that does not count at any pose is rejected (strict), and has neither a largest magnitude
/// nor a root mean square: both are NaN, because what is known of the other poses alone would flatter it. solved() says
/// which machines these are. Leave them out of distributions, and say how many there are (MachineCounts::unsolved).
class MachineBlock {
 public:
  /// limits: on the magnitude of each response, infinite for none. A value equal to its limit keeps it. machines: how
  /// many. Precondition: limits >= 0.
  MachineBlock(std::span<const double> limits, std::size_t machines);

  /// Adds the outcomes at the next pose. responses: along responses and machines, row-major as OutcomeBlock has them.
  /// counts: of each machine 1 where the sample counts, and 0 where it does not; its responses are then not looked at.
  void add_pose(std::span<const double> responses, std::span<const std::uint8_t> counts);

  std::size_t machines() const { return solved_.size(); }  ///< Number of them.
  std::size_t poses() const { return at_pose_.size(); }    ///< Those that were added.
  MachineCounts counts() const;                            ///< Over the poses that were added.

  /// Of each machine 1 if it is rejected (strict), else 0: what ScoreSums takes.
  std::vector<std::uint8_t> rejected() const;
  /// Of each machine 1 where each of its samples counts, else 0: what MainEffectSums takes with numbers of whole
  /// machines.
  std::span<const std::uint8_t> solved() const { return solved_; }
  /// Largest magnitudes over the poses; NaN where the machine is not solved at each of them.
  Array<double, axis::Response, axis::Sample> largest() const;
  /// Root mean squares over the poses; NaN likewise. Precondition: poses() > 0.
  Array<double, axis::Response, axis::Sample> root_mean_square() const;

 private:
  std::vector<double> limits_;                                ///< of each response
  std::vector<std::uint8_t> solved_;                          ///< of each machine 1 where each sample counts
  Array<double, axis::Response, axis::Sample> largest_;       ///< of the poses where the machine is solved
  Array<double, axis::Response, axis::Sample> squares_;       ///< sums, likewise
  Array<std::uint8_t, axis::Response, axis::Sample> beyond_;  ///< 1 where the limit is broken at a pose
  std::vector<std::vector<Rejects>> at_pose_;                 ///< of each response at each pose, pose by pose
};

}  // namespace poesy
