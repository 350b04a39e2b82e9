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
    double value = 0.0;      ///< the response; 0 for a corner that is not solved
    std::int64_t pose = -1;  ///< -1: none was found
    Signs signs = {};        ///< empty if none was found
  };

  CouplingResult::Curves value;  ///< largest |response| among the solved corners; NaN if none was solved
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> tried;     ///< corners that were tried
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> unsolved;  ///< corners among them that have no solution
  Array<SolveCounts, axis::Size, axis::Pose> solves;                    ///< solves of all corners
  CouplingResult::Summary<Place> worst;  ///< the largest value over the poses, and the first pose that has it
  Array<Place, axis::Size, axis::Subset> first_unsolved;  ///< the first corner that was not solved
};

/// Searches the worst corners at every size and pose (CornerSearch). rounding: see coupling_rounding(). Empty when
/// stopped, and for a shard.
std::optional<WorstCases> run_worst_cases(const StudyRun& run, const CornerTable& table,
                                          const Array<double, axis::Response, axis::Size>& rounding,
                                          const RunOptions& options);

/// Adds the worst cases to the result of the same study.
void add_worst_cases(WorstCases found, const CornerTable& table, CouplingResult& result);

}  // namespace poesy
