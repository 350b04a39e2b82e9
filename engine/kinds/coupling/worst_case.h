#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/coupling/corners.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/kind.h"

namespace poesy {

/// The worst corners over all poses. Arrays have the axes of those in CouplingResult.
struct WorstCases {
  /// A corner and the pose at which it was found.
  struct Place {
    double value = 0.0;      ///< |response| at the corner; 0 for a corner that is not solved
    std::int64_t pose = -1;  ///< pose; -1 if no corner was found
    Signs signs = {};        ///< signs at the corner; empty if no corner was found
  };

  CouplingResult::Curves value;  ///< largest |response| over the solved corners; NaN if none was solved
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> tried;     ///< number of corners that were tried
  Array<std::uint64_t, axis::Size, axis::Subset, axis::Pose> unsolved;  ///< number of tried corners without a solution
  Array<SolveCounts, axis::Size, axis::Pose> solves;                    ///< how the solves of all corners ended
  CouplingResult::Summary<Place> worst;  ///< corner with the largest value over the poses; the first pose among equal
                                         ///< ones
  Array<Place, axis::Size, axis::Subset> first_unsolved;  ///< the first corner that was not solved
};

/// Searches the worst corners (choices of the signs of all errors) at every size and pose (CornerSearch). rounding: see
/// coupling_rounding(). Returns nothing if the run was stopped, and for a shard.
std::optional<WorstCases> run_worst_cases(const StudyRun& run, const CornerTable& table,
                                          const Array<double, axis::Response, axis::Size>& rounding,
                                          const RunOptions& options);

/// Copies the worst cases into the result of the same study.
void add_worst_cases(WorstCases found, const CornerTable& table, CouplingResult& result);

}  // namespace poesy
