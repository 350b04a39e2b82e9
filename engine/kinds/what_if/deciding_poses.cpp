#include "engine/kinds/what_if/deciding_poses.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace poesy {
namespace {

/// [settings][sliders] The settings of the sliders for which poses are chosen: numbers by which the sliders multiply
/// the sizes of errors.
std::vector<std::vector<double>> settings(std::size_t sliders) {
  constexpr std::array kAlike{1.0, 0.25, 0.5, 0.75, 1.25, 1.5, 2.0};
  std::vector<std::vector<double>> list;
  for (const double factor : kAlike) list.emplace_back(sliders, factor);
  for (std::size_t g = 0; g < sliders; ++g) {
    for (const double others : {1.0, 0.5}) {
      list.emplace_back(sliders, others);
      list.back()[g] = 2.0;
    }
  }
  return list;
}

/// Chooses poses one after the other: in each step the pose that rejects the largest number of machines that the poses
/// chosen so far do not reject.
class PoseCover {
 public:
  /// rejected: [poses][settings x machines] 1 if the pose rejects the machine at the setting, otherwise 0.
  PoseCover(std::vector<std::vector<std::uint8_t>> rejected, std::size_t machines)
      : rejected_(std::move(rejected)), machines_(machines), left_(rejected_.front().size(), 0) {
    for (const auto& at_pose : rejected_) {
      for (std::size_t n = 0; n < left_.size(); ++n) left_[n] = std::max(left_[n], at_pose[n]);
    }
  }

  DecidingPoses choose(std::size_t most) {
    DecidingPoses found{{}, 0.0};
    while (found.places.size() < most) {
      std::vector<std::size_t> gains;
      for (const auto& at_pose : rejected_) gains.push_back(gain(at_pose));
      const auto best = static_cast<std::size_t>(std::ranges::max_element(gains) - gains.begin());
      if (gains[best] == 0 && !found.places.empty()) break;
      found.places.push_back(best);
      for (std::size_t n = 0; n < left_.size(); ++n) {
        if (rejected_[best][n] == 1) left_[n] = 0;
      }
    }
    std::ranges::sort(found.places);
    for (std::size_t first = 0; first < left_.size(); first += machines_) {
      const auto missed = std::ranges::count(std::span(left_).subspan(first, machines_), 1);
      found.missed = std::max(found.missed, static_cast<double>(missed) / static_cast<double>(machines_));
    }
    return found;
  }

 private:
  std::size_t gain(std::span<const std::uint8_t> at_pose) const {
    std::size_t count = 0;
    for (std::size_t n = 0; n < left_.size(); ++n) {
      if (left_[n] == 1 && at_pose[n] == 1) ++count;
    }
    return count;
  }

  std::vector<std::vector<std::uint8_t>> rejected_;
  std::size_t machines_;
  /// [settings x machines] 1 if some pose rejects the machine, but none of the poses chosen so far does.
  std::vector<std::uint8_t> left_;
};

}  // namespace

std::vector<double> sizes_of(std::span<const SizedErrors> sliders, std::span<const double> factors,
                             std::size_t errors) {
  std::vector<double> sizes(errors, 1.0);
  for (std::size_t g = 0; g < sliders.size(); ++g) {
    for (const std::size_t p : sliders[g].slots) sizes[p] = factors[g];
  }
  return sizes;
}

DecidingPoses deciding_poses(const TriedMachines& tried, const WhatIfMachines& machines,
                             std::span<const SizedErrors> sliders, std::size_t most) {
  const std::size_t errors = machines.deviations().length<axis::Factor>();
  std::vector<std::vector<std::uint8_t>> rejected(tried.poses.size());
  for (const std::vector<double>& factors : settings(sliders.size())) {
    const std::vector<double> sizes = sizes_of(sliders, factors, errors);
    for (std::size_t k = 0; k < tried.poses.size(); ++k) {
      for (const double one : badness(changed(tried, machines, k, sizes), tried.limits)) {
        rejected[k].push_back(one > 0.0 ? 1 : 0);
      }
    }
  }
  return PoseCover(std::move(rejected), machines.machines()).choose(std::min(most, tried.poses.size()));
}

}  // namespace poesy
