#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/array.h"
#include "engine/base/value_limit.h"

/// Machines that are used at all poses. A machine is one set of errors, and it is good if it keeps every limit at every
/// pose. The machines of a block are its samples.
namespace poesy {

/// Numbers of rejected machines, or of rejected samples at one pose. A sample is unsolved here if it does not count in
/// statistics (counts() in run/result.h).
struct Rejects {
  std::uint64_t strict = 0;   ///< number of rejects if unsolved samples are rejects
  std::uint64_t lenient = 0;  ///< number of rejects if unsolved samples are not rejects; at most `strict`

  friend bool operator==(const Rejects&, const Rejects&) = default;  ///< Returns true if both are equal.
};

/// The numbers of rejected machines. A response without a limit has an infinite limit, which rejects only machines with
/// an unsolved sample, and only in Rejects::strict.
struct MachineCounts {
  std::uint64_t machines = 0;               ///< machines that were evaluated
  std::uint64_t unsolved = 0;               ///< machines with an unsolved sample at one pose or more
  Rejects all;                              ///< machines that break any limit
  Array<Rejects, axis::Response> by_limit;  ///< machines that break the limit of each response
  /// Machines that break the limit of a response and are beyond it at this pose. For a limit on the spread over poses:
  /// only machines that are not solved at this pose.
  Array<Rejects, axis::Response, axis::Pose> at_pose;

  /// Adds the counts of other machines, in any order. If this object is empty, it takes the lengths of `other`.
  void merge(const MachineCounts& other);

  /// Counts of zero machines, with room for these responses and poses.
  static MachineCounts of_none(std::size_t responses, std::size_t poses);
  void state(Archive& archive);  ///< Reads or writes every count. Precondition: the arrays have their final lengths.

  /// Returns true if all counts are equal.
  friend bool operator==(const MachineCounts&, const MachineCounts&) = default;
};

/// Collects the outcomes of a block of machines, pose after pose. Memory: 17 bytes for each machine and response, for
/// any number of poses. For a response whose limit is not plain (ValueLimit::is_plain), each machine takes 8 bytes more
/// for each pose, and one further byte for all these responses together. A machine that is not solved at every pose is
/// a reject (Rejects::strict), and solved() is 0 for this machine. Its largest magnitude and root mean square are NaN,
/// because those over the solved poses alone would be too small. Leave these machines out of distributions, and state
/// their number (MachineCounts::unsolved).
class MachineBlock {
 public:
  /// limits: one for each response; infinite for a response without a limit. machines: the number of machines.
  MachineBlock(std::span<const ValueLimit> limits, std::size_t machines);

  /// Adds the outcomes at the next pose. responses: [responses x machines], row-major as in OutcomeBlock. counts:
  /// [machines] 1 if the sample counts in statistics; 0 if it is unsolved, and its responses are ignored.
  void add_pose(std::span<const double> responses, std::span<const std::uint8_t> counts);

  std::size_t machines() const { return solved_.size(); }  ///< The number of machines.
  std::size_t poses() const { return at_pose_.size(); }    ///< The number of poses that were added.
  MachineCounts counts() const;                            ///< The counts over these poses.

  /// [machines] 1 if the machine is rejected (strict), else 0; an argument of ScoreSums::add().
  std::vector<std::uint8_t> rejected() const;
  /// [machines] 1 if the machine is solved at every pose, else 0. Pass this list as `counts` to MainEffectSums::add()
  /// if the responses there are numbers over all poses of a machine.
  std::span<const std::uint8_t> solved() const { return solved_; }
  /// Largest magnitudes over the poses; NaN if the machine is not solved at each of them.
  Array<double, axis::Response, axis::Sample> largest() const;
  /// [machines] The numbers by which the machines are judged (ValueLimit::deciding); NaN if a machine is not solved at
  /// each pose. Precondition: the limit of the response is not plain.
  std::vector<double> deciding(std::size_t response) const;
  /// Root mean squares over the poses; NaN if the machine is not solved at each of them. Precondition: poses() > 0.
  Array<double, axis::Response, axis::Sample> root_mean_square() const;

 private:
  /// The values of a machine at the poses where it is solved.
  std::vector<double> values_of(std::size_t response, std::size_t machine) const;
  /// [machines] 1 if the machine breaks the limit of this response, judged only by the poses where the machine is
  /// solved; else 0.
  std::vector<std::uint8_t> beyond(std::size_t response) const;
  /// The rejects of a response at one pose, if its limit judges all poses of a machine together (a share of the poses,
  /// or the spread over them); see MachineCounts::at_pose. beyond: [machines] what the function beyond() returns for
  /// this response.
  Rejects rejects_over_poses(std::size_t response, std::size_t pose, std::span<const std::uint8_t> beyond) const;

  std::vector<ValueLimit> limits_;    ///< [responses] limit of each response
  std::vector<std::uint8_t> solved_;  ///< [machines] 1 if the machine is solved at every pose
  /// Largest magnitudes over the poses where the machine is solved.
  Array<double, axis::Response, axis::Sample> largest_;
  Array<double, axis::Response, axis::Sample> squares_;  ///< sums of squares over the poses where the machine is solved
  Array<std::uint8_t, axis::Response, axis::Sample> beyond_;  ///< 1 if the machine is beyond the limit at some pose
  std::vector<std::vector<Rejects>> at_pose_;                 ///< [poses][responses] rejects, judged at each pose alone
  /// For each response, its values [poses x machines] if the limit is not plain.
  std::vector<std::vector<double>> values_;
  std::vector<std::uint8_t> counts_;  ///< [poses x machines] 1 if solved, else 0; empty if all limits are plain
};

}  // namespace poesy
