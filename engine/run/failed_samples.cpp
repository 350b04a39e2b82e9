#include "engine/run/failed_samples.h"

#include <algorithm>

#include "engine/base/contract.h"

namespace poesy {

void FailedSamples::merge(const FailedSamples& later) {
  POESY_EXPECTS(first_.empty() || later.first_.empty() || first_.back().sample < later.first_.front().sample);
  for (const FailedSample& failed : later.first_) add(failed.sample, failed.status);
}

void FailedSamples::write(ByteWriter& to) const {
  to.number(first_.size());
  for (const FailedSample& failed : first_) {
    to.number(failed.sample.value);
    to.number(static_cast<std::uint64_t>(failed.status));
  }
}

FailedSamples FailedSamples::read(ByteReader& from, std::uint64_t failures, std::uint64_t first, std::uint64_t end) {
  FailedSamples samples;
  const std::uint64_t kept = from.number();
  if (kept != std::min<std::uint64_t>(failures, kMost)) throw BytesError("has another number of failures than it says");
  for (std::uint64_t n = 0; n < kept; ++n) {
    const std::uint64_t sample = from.number();
    const auto status = static_cast<SolveStatus>(from.number_up_to(kStatusNames.size() - 1));
    if (sample < first || sample >= end || solved(status)) throw BytesError("has a failure that cannot be there");
    samples.first_.push_back({SampleIndex(static_cast<std::size_t>(sample)), status});
    first = sample + 1;
  }
  return samples;
}

void append_failures(std::size_t slot, PoseIndex pose, const FailedSamples& cell, std::vector<Failure>& list) {
  for (const FailedSample& failed : cell.first()) {
    if (list.size() == kMostFailuresListed) return;
    list.push_back({slot, pose, failed});
  }
}

}  // namespace poesy
