#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "engine/kinds/coupling/corners.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/kinds/kind.h"

namespace poesy {

/// The worst corners over all poses: R responses, Z sizes, K subsets of the sources, M poses.
struct WorstCases {
  /// A corner and where it was found.
  struct Place {
    double value = 0.0;      ///< of a response; 0 for a corner that is not solved
    std::int64_t pose = -1;  ///< none was found: -1
    Signs signs = {};        ///< empty where none was found
  };

  std::vector<double> value;            ///< [R x Z x K x M] largest |response| at any corner solved; NaN where none was
  std::vector<std::uint64_t> tried;     ///< [Z x K x M] corners
  std::vector<std::uint64_t> unsolved;  ///< [Z x K x M] of these, corners that have no solution
  std::vector<SolveCounts> solves;      ///< [Z x M] of all corners
  std::vector<Place> worst;             ///< [R x Z x K] the largest value of any pose, the first pose that has it
  std::vector<Place> first_unsolved;    ///< [Z x K] the first one
};

/// Looks for the worst corners at every size and pose (CornerSearch). rounding: as coupling_rounding gives it. Empty
/// when stopped, and of a shard.
std::optional<WorstCases> run_worst_cases(const StudyRun& run, const CornerTable& table,
                                          std::span<const double> rounding, const RunOptions& options);

/// Puts them into the result of the same study.
void add_worst_cases(WorstCases found, const CornerTable& table, CouplingResult& result);

}  // namespace poesy
