#include "engine/stats/machines.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"

namespace poesy {
namespace {

void add(Rejects& to, const Rejects& rejects) {
  to.strict += rejects.strict;
  to.lenient += rejects.lenient;
}

/// The first one takes the sizes of the second one where it has none.
void add(std::vector<Rejects>& to, const std::vector<Rejects>& rejects) {
  if (to.empty()) to.resize(rejects.size());
  POESY_EXPECTS(to.size() == rejects.size());
  for (std::size_t k = 0; k < to.size(); ++k) add(to[k], rejects[k]);
}

/// Rejects among these; a strict reject that is no lenient one has a sample that does not count.
void rejects_state(Archive& archive, Rejects& rejects, const Rejects& among, std::uint64_t unsolved) {
  archive.number(rejects.strict, among.strict);
  archive.number(rejects.lenient, std::min(among.lenient, rejects.strict));
  archive.expect(rejects.strict - rejects.lenient <= unsolved, "has rejects without a reason");
}

/// What one response of B machines does at a pose: which keep its limit, and what it adds to their largest magnitudes
/// and sums of squares. Machines whose sample does not count are left as they are.
struct ResponseAtPose {
  std::span<const double> values;        ///< [B]
  std::span<const std::uint8_t> counts;  ///< [B]
  double limit;
  std::span<double> largest;       ///< [B]
  std::span<double> squares;       ///< [B]
  std::span<std::uint8_t> beyond;  ///< [B] 1 from the first pose on at which the limit is broken

  Rejects add() const {
    std::uint64_t broken = 0;
    std::uint64_t unsolved = 0;
    for (std::size_t b = 0; b < values.size(); ++b) {
      const double magnitude = counts[b] != 0 ? std::abs(values[b]) : 0.0;
      const auto is_beyond = static_cast<std::uint8_t>(!(magnitude <= limit));
      largest[b] = std::max(largest[b], magnitude);
      squares[b] += magnitude * magnitude;
      beyond[b] |= is_beyond;
      broken += is_beyond;
      unsolved += static_cast<std::uint64_t>(counts[b] == 0);
    }
    return {broken + unsolved, broken};
  }
};

}  // namespace

void MachineCounts::merge(const MachineCounts& other) {
  if (other.machines == 0) return;
  machines += other.machines;
  unsolved += other.unsolved;
  add(all, other.all);
  add(by_limit, other.by_limit);
  add(at_pose, other.at_pose);
}

void MachineCounts::state(Archive& archive) {
  archive.number(machines);
  archive.number(unsolved, machines);
  rejects_state(archive, all, {machines, machines}, unsolved);
  archive.expect(all.strict >= unsolved, "has machines that are neither solved nor rejected");
  for (Rejects& rejects : by_limit) {
    rejects_state(archive, rejects, all, unsolved);
    archive.expect(rejects.strict >= unsolved, "has machines that keep a limit unsolved");
  }
  const std::size_t poses = by_limit.empty() ? 0 : at_pose.size() / by_limit.size();
  for (std::size_t k = 0; k < at_pose.size(); ++k) rejects_state(archive, at_pose[k], by_limit[k / poses], unsolved);
}

MachineCounts MachineCounts::read(ByteReader& from, std::size_t responses, std::size_t poses) {
  MachineCounts counts;
  counts.by_limit.resize(responses);
  counts.at_pose.resize(responses * poses);
  Archive archive(from);
  counts.state(archive);
  return counts;
}

MachineBlock::MachineBlock(std::span<const double> limits, std::size_t machines)
    : limits_(limits.begin(), limits.end()),
      solved_(machines, 1),
      largest_(limits.size() * machines),
      squares_(limits.size() * machines),
      beyond_(limits.size() * machines) {}

void MachineBlock::add_pose(std::span<const double> responses, std::span<const std::uint8_t> counts) {
  const std::size_t count = machines();
  POESY_EXPECTS(counts.size() == count && responses.size() == limits_.size() * count);
  for (std::size_t b = 0; b < count; ++b) solved_[b] &= static_cast<std::uint8_t>(counts[b] != 0);
  for (std::size_t r = 0; r < limits_.size(); ++r) {
    const auto row = [&](auto& all) { return std::span(all).subspan(r * count, count); };
    at_pose_.push_back(
        ResponseAtPose{row(responses), counts, limits_[r], row(largest_), row(squares_), row(beyond_)}.add());
  }
  ++poses_;
}

MachineCounts MachineBlock::counts() const {
  MachineCounts counts;
  const std::size_t responses = limits_.size();
  counts.machines = machines();
  counts.by_limit.resize(responses);
  counts.at_pose.resize(at_pose_.size());
  for (std::size_t b = 0; b < machines(); ++b) {
    const bool unsolved = solved_[b] == 0;
    bool beyond_any = false;
    for (std::size_t r = 0; r < responses; ++r) {
      const bool beyond = beyond_[r * machines() + b] != 0;
      beyond_any |= beyond;
      add(counts.by_limit[r], {beyond || unsolved ? 1U : 0U, beyond ? 1U : 0U});
    }
    counts.unsolved += unsolved ? 1 : 0;
    add(counts.all, {beyond_any || unsolved ? 1U : 0U, beyond_any ? 1U : 0U});
  }
  for (std::size_t k = 0; k < at_pose_.size(); ++k) {
    counts.at_pose[k % responses * poses_ + k / responses] = at_pose_[k];
  }
  return counts;
}

std::vector<std::uint8_t> MachineBlock::rejected() const {
  std::vector<std::uint8_t> rejected(machines());
  for (std::size_t b = 0; b < machines(); ++b) rejected[b] = static_cast<std::uint8_t>(solved_[b] == 0);
  for (std::size_t k = 0; k < beyond_.size(); ++k) rejected[k % machines()] |= beyond_[k];
  return rejected;
}

std::vector<double> MachineBlock::largest() const {
  std::vector<double> values = largest_;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (solved_[k % machines()] == 0) values[k] = kNaN;
  }
  return values;
}

std::vector<double> MachineBlock::root_mean_square() const {
  POESY_EXPECTS(poses_ > 0);
  std::vector<double> values(squares_.size(), kNaN);
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (solved_[k % machines()] != 0) values[k] = std::sqrt(squares_[k] / static_cast<double>(poses_));
  }
  return values;
}

}  // namespace poesy
