#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/coupling/corners.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/kind.h"

namespace poesy {

/// The worst corners over all poses.
struct WorstCases {
  /// A corner and where it was found.
  struct Place {
    double value = 0.0;      ///< of a response; 0 for a corner that is not solved
    std::int64_t pose = -1;  ///< none was found: -1
    Signs signs = {};        ///< empty where none was found
  };

  CouplingResult::Curves value;  ///< largest |response| at any corner solved; NaN where none was
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> tried;     ///< corners
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> unsolved;  ///< of these, corners that have no solution
  Array<SolveCounts, axis::Size, axis::Pose> solves;                    ///< of all corners
  CouplingResult::Summary<Place> worst;                   ///< the largest value of any pose, the first pose that has it
  Array<Place, axis::Size, axis::Subset> first_unsolved;  ///< the first one
};

/// Looks for the worst corners at every size and pose (CornerSearch). rounding: as coupling_rounding gives it. Empty
/// when stopped, and of a shard.
std::optional<WorstCases> run_worst_cases(const StudyRun& run, const CornerTable& table,
                                          const Array<double, axis::Response, axis::Size>& rounding,
                                          const RunOptions& options);

/// Puts them into the result of the same study.
void add_worst_cases(WorstCases found, const CornerTable& table, CouplingResult& result);

}  // namespace poesy
