#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/coupling/corners.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/kind.h"

namespace poesy::coupling {

/// The worst corners at each pose and over all poses.
struct WorstCases {
  /// A corner and the pose at which it was found.
  struct Place {
    double value = 0.0;      ///< |response| at the corner, SI; 0 for a corner that is not solved
    std::int64_t pose = -1;  ///< index of the pose; -1 if no corner was found
    Signs signs = {};        ///< signs at the corner; empty if no corner was found
  };

  Result::Curves value;  ///< largest |response| over the solved corners at a pose, SI; NaN if none was solved
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> tried;     ///< number of corners that were tried
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> unsolved;  ///< number of tried corners without a solution
  Array<SolveCounts, axis::Size, axis::Pose> solves;                    ///< how the solves of all corners ended
  /// Corner with the largest value over the poses; of equal values, the first pose.
  Result::Summary<Place> worst;
  Array<Place, axis::Size, axis::Subset> first_unsolved;  ///< first corner that was not solved, over the poses
};

/// Searches for the worst corners (choices of the sign of each block of errors) at every size and pose (CornerSearch).
/// rounding: see coupling_rounding(). Returns nothing if the run was stopped, and for a shard.
std::optional<WorstCases> run_worst_cases(const StudyRun& run, const CornerTable& table,
                                          const Array<double, axis::Response, axis::Size>& rounding,
                                          const RunOptions& options);

/// Sets the worst cases in the result of the same study, and adds the solves of corners to its counts.
void add_worst_cases(WorstCases found, const CornerTable& table, Result& result);

}  // namespace poesy::coupling
