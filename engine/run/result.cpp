#include "engine/run/result.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "engine/base/contract.h"

namespace poesy {

SolveCounts total_of(std::span<const SolveCounts> cells) {
  SolveCounts sum;
  for (const SolveCounts& cell : cells) sum.merge(cell);
  return sum;
}

std::uint64_t SolveCounts::total() const {
  return std::accumulate(by_status.begin(), by_status.end(), std::uint64_t{0});
}

std::uint64_t SolveCounts::not_converged() const {
  std::uint64_t count = 0;
  for (std::size_t s = 0; s < by_status.size(); ++s) {
    if (!solved(static_cast<SolveStatus>(s))) count += by_status[s];
  }
  return count;
}

void SolveCounts::add(SolveStatus status, std::uint32_t sample_iterations) {
  ++by_status[static_cast<std::size_t>(status)];
  iterations += sample_iterations;
  most_iterations = std::max(most_iterations, sample_iterations);
}

void SolveCounts::merge(const SolveCounts& other) {
  for (std::size_t s = 0; s < by_status.size(); ++s) by_status[s] += other.by_status[s];
  iterations += other.iterations;
  most_iterations = std::max(most_iterations, other.most_iterations);
}

void SolveCounts::state(Archive& archive) {
  std::uint64_t left = std::numeric_limits<std::uint64_t>::max();
  for (std::uint64_t& count : by_status) {
    archive.number(count, left);
    left -= count;
  }
  archive.number(iterations);
  archive.number(most_iterations);
}

void FailedSamples::merge(const FailedSamples& later) {
  POESY_EXPECTS(first_.empty() || later.first_.empty() || first_.back().sample < later.first_.front().sample);
  for (const FailedSample& failed : later.first_) add(failed.sample, failed.status);
}

void FailedSamples::state(Archive& archive, std::uint64_t failures, std::uint64_t first, std::uint64_t end) {
  std::size_t kept = first_.size();
  archive.number(kept);
  archive.expect(kept == std::min<std::uint64_t>(failures, kMost), "has another number of failures than it says");
  first_.resize(kept);
  for (auto& [sample, status] : first_) {
    archive.number(sample.value);
    archive.number(status, kStatusNames.size() - 1);
    archive.expect(sample.value >= first && sample.value < end && !solved(status),
                   "has a failure that cannot be there");
    first = sample.value + 1;
  }
}

void append_failures(std::size_t slot, PoseIndex pose, const FailedSamples& cell, std::vector<Failure>& list) {
  for (const FailedSample& failed : cell.first()) {
    if (list.size() == kMostFailuresListed) return;
    list.push_back({slot, pose, failed});
  }
}

bool LimitVerdicts::passed() const {
  if (yield) return yield->decision != YieldVerdict::Decision::not_kept;
  return std::ranges::all_of(limits, [](const LimitVerdict& one) { return one.passed; });
}

}  // namespace poesy
