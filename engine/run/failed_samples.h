#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/index.h"
#include "engine/model/status.h"

namespace poesy {

/// A sample that was not solved.
struct FailedSample {
  SampleIndex sample;  ///< position in the stream of its cell
  SolveStatus status;  ///< how it ended

  /// Whether both members are equal.
  bool operator==(const FailedSample&) const = default;
};

/// The first samples of one cell, or of a part of it, that were not solved. Allocates once, when one
/// fails.
class FailedSamples {
 public:
  /// No more of a cell are kept; which ones depends on its samples alone.
  static constexpr std::size_t kMost = 10;

  /// Samples come in ascending order.
  void add(SampleIndex sample, SolveStatus status) {
    if (solved(status) || first_.size() == kMost) return;
    first_.reserve(kMost);
    first_.push_back({sample, status});
  }
  /// Precondition: all samples of `later` come after those of this.
  void merge(const FailedSamples& later);

  /// In the order of samples, at most kMost.
  std::span<const FailedSample> first() const { return first_; }

  /// For a state or a message.
  void write(ByteWriter& to) const;
  /// Of samples first .. end - 1, so many of which failed. Throws BytesError for what cannot be theirs.
  static FailedSamples read(ByteReader& from, std::uint64_t failures, std::uint64_t first, std::uint64_t end);

 private:
  std::vector<FailedSample> first_;
};

/// Where a sample stands that was not solved: its address.
struct Failure {
  std::size_t slot;     ///< position among the study's factors; 0 where all vary together
  PoseIndex pose;       ///< among the study's
  FailedSample failed;  ///< which sample, and how it ended

  /// Whether address and end are equal.
  bool operator==(const Failure&) const = default;
};

/// A result lists no more failures than this.
inline constexpr std::size_t kMostFailuresListed = 1000;

/// Appends the failures of a cell, as far as the list has room.
void append_failures(std::size_t slot, PoseIndex pose, const FailedSamples& cell, std::vector<Failure>& list);

}  // namespace poesy
