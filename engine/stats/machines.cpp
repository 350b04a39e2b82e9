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

/// Adds `rejects` to `to`, element by element. If `to` is empty, it first takes the lengths of `rejects`.
template <NamedAxis... Axes>
void add(Array<Rejects, Axes...>& to, const Array<Rejects, Axes...>& rejects) {
  if (to.empty()) make_room(rejects.lengths(), to);
  POESY_EXPECTS(to.lengths() == rejects.lengths());
  for (std::size_t k = 0; k < to.size(); ++k) add(to.all()[k], rejects.all()[k]);
}

/// Reads or writes rejects. When reading, checks them against `among`, the rejects under any limit, and against the
/// number of machines with an unsolved sample: only a machine with an unsolved sample can be in `strict` and not in
/// `lenient`.
void rejects_state(Archive& archive, Rejects& rejects, const Rejects& among, std::uint64_t unsolved) {
  archive.number(rejects.strict, among.strict);
  archive.number(rejects.lenient, std::min(among.lenient, rejects.strict));
  archive.expect(rejects.strict - rejects.lenient <= unsolved, "has rejects without a reason");
}

/// Updates the results of some machines by the values of one response at one pose: whether the machines are within the
/// limit, their largest magnitudes, and their sums of squares. Machines that are unsolved at this pose (counts = 0) are
/// not changed.
struct ResponseAtPose {
  std::span<const double> values;
  std::span<const std::uint8_t> counts;
  const ValueLimit& limit;
  std::span<double> largest;
  std::span<double> squares;
  std::span<std::uint8_t> beyond;  ///< 1 if the machine is beyond the limit at this pose or an earlier one

  Rejects add() const {
    std::uint64_t broken = 0;
    std::uint64_t unsolved = 0;
    for (std::size_t b = 0; b < values.size(); ++b) {
      const double magnitude = counts[b] != 0 ? std::abs(values[b]) : 0.0;
      const auto is_beyond = static_cast<std::uint8_t>(counts[b] != 0 && !limit.holds(values[b]));
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
  for (std::size_t r = 0; r < by_limit.size(); ++r) {
    for (Rejects& rejects : at_pose.row(r)) rejects_state(archive, rejects, by_limit(r), unsolved);
  }
}

MachineCounts MachineCounts::of_none(std::size_t responses, std::size_t poses) {
  MachineCounts counts;
  make_room({responses}, counts.by_limit);
  make_room({responses, poses}, counts.at_pose);
  return counts;
}

MachineBlock::MachineBlock(std::span<const ValueLimit> limits, std::size_t machines)
    : limits_(limits.begin(), limits.end()),
      solved_(machines, 1),
      largest_({limits.size(), machines}),
      squares_({limits.size(), machines}),
      beyond_({limits.size(), machines}),
      values_(limits.size()) {}

void MachineBlock::add_pose(std::span<const double> responses, std::span<const std::uint8_t> counts) {
  const ArrayView<const double, axis::Response, axis::Sample> values(responses, largest_.lengths());
  POESY_EXPECTS(counts.size() == machines());
  for (std::size_t b = 0; b < counts.size(); ++b) solved_[b] &= static_cast<std::uint8_t>(counts[b] != 0);
  std::vector<Rejects>& rejects = at_pose_.emplace_back();
  const ValueLimit none;
  bool keeps_values = false;
  for (std::size_t r = 0; r < limits_.size(); ++r) {
    const ValueLimit& limit = limits_[r].is_spread() ? none : limits_[r];
    rejects.push_back(
        ResponseAtPose{values.row(r), counts, limit, largest_.row(r), squares_.row(r), beyond_.row(r)}.add());
    if (limits_[r].is_plain()) continue;
    keeps_values = true;
    values_[r].insert(values_[r].end(), values.row(r).begin(), values.row(r).end());
  }
  if (keeps_values) counts_.insert(counts_.end(), counts.begin(), counts.end());
}

std::vector<double> MachineBlock::values_of(std::size_t response, std::size_t machine) const {
  std::vector<double> values;
  for (std::size_t at = machine; at < counts_.size(); at += machines()) {
    if (counts_[at] != 0) values.push_back(values_[response][at]);
  }
  return values;
}

std::vector<std::uint8_t> MachineBlock::beyond(std::size_t response) const {
  const auto at_some_pose = beyond_.row(response);
  std::vector<std::uint8_t> list(at_some_pose.begin(), at_some_pose.end());
  if (!limits_[response].is_over_poses()) return list;
  for (std::size_t b = 0; b < machines(); ++b) {
    std::vector<double> values = values_of(response, b);
    list[b] = limits_[response].keeps(values, poses()) ? 0 : 1;
  }
  return list;
}

Rejects MachineBlock::rejects_over_poses(std::size_t response, std::size_t pose,
                                         std::span<const std::uint8_t> beyond) const {
  const ValueLimit& limit = limits_[response];
  Rejects rejects;
  for (std::size_t b = 0; b < machines(); ++b) {
    const std::size_t at = pose * machines() + b;
    const bool is_solved = counts_[at] != 0;
    const bool is_reject = is_solved && !limit.is_spread() && beyond[b] != 0 && !limit.holds(values_[response][at]);
    add(rejects, {is_reject || !is_solved ? 1U : 0U, is_reject ? 1U : 0U});
  }
  return rejects;
}

std::vector<double> MachineBlock::deciding(std::size_t response) const {
  POESY_EXPECTS(!limits_[response].is_plain());
  std::vector<double> numbers(machines(), kNaN);
  for (std::size_t b = 0; b < machines(); ++b) {
    if (solved_[b] == 0) continue;
    std::vector<double> values = values_of(response, b);
    numbers[b] = limits_[response].deciding(values, poses());
  }
  return numbers;
}

MachineCounts MachineBlock::counts() const {
  const std::size_t responses = limits_.size();
  MachineCounts counts;
  counts.machines = machines();
  make_room({responses}, counts.by_limit);
  make_room({responses, poses()}, counts.at_pose);
  const auto count = [&](std::size_t b, bool is_beyond, Rejects& rejects) {
    add(rejects, {is_beyond || solved_[b] == 0 ? 1U : 0U, is_beyond ? 1U : 0U});
  };
  std::vector<std::uint8_t> beyond_any(machines(), 0);
  for (std::size_t r = 0; r < responses; ++r) {
    const std::vector<std::uint8_t> of_limit = beyond(r);
    for (std::size_t b = 0; b < machines(); ++b) {
      beyond_any[b] |= of_limit[b];
      count(b, of_limit[b] != 0, counts.by_limit(r));
    }
    for (std::size_t m = 0; m < poses(); ++m) {
      counts.at_pose(r, m) = limits_[r].is_over_poses() ? rejects_over_poses(r, m, of_limit) : at_pose_[m][r];
    }
  }
  for (std::size_t b = 0; b < machines(); ++b) {
    counts.unsolved += solved_[b] == 0 ? 1 : 0;
    count(b, beyond_any[b] != 0, counts.all);
  }
  return counts;
}

std::vector<std::uint8_t> MachineBlock::rejected() const {
  std::vector<std::uint8_t> rejected(machines());
  for (std::size_t b = 0; b < machines(); ++b) rejected[b] = static_cast<std::uint8_t>(solved_[b] == 0);
  for (std::size_t r = 0; r < limits_.size(); ++r) {
    const std::vector<std::uint8_t> of_limit = beyond(r);
    for (std::size_t b = 0; b < machines(); ++b) rejected[b] |= of_limit[b];
  }
  return rejected;
}

Array<double, axis::Response, axis::Sample> MachineBlock::largest() const {
  Array<double, axis::Response, axis::Sample> values(largest_.lengths(), kNaN);
  for (std::size_t r = 0; r < limits_.size(); ++r) {
    for (std::size_t b = 0; b < machines(); ++b) {
      if (solved_[b] != 0) values(r, b) = largest_(r, b);
    }
  }
  return values;
}

Array<double, axis::Response, axis::Sample> MachineBlock::root_mean_square() const {
  POESY_EXPECTS(poses() > 0);
  Array<double, axis::Response, axis::Sample> values(squares_.lengths(), kNaN);
  for (std::size_t r = 0; r < limits_.size(); ++r) {
    for (std::size_t b = 0; b < machines(); ++b) {
      if (solved_[b] != 0) values(r, b) = std::sqrt(squares_(r, b) / static_cast<double>(poses()));
    }
  }
  return values;
}

}  // namespace poesy
