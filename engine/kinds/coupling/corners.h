#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/kinds/coupling/coupling.h"
#include "engine/model/model.h"
#include "engine/run/result.h"
#include "engine/study/poses/pose_selection.h"

/// Searches the worst case of error sources whose signs are not known. Each block of errors (error_blocks) has its size
/// with either sign, and a corner is a choice of signs. R responses, Z sizes, K subsets of the sources.
namespace poesy {

namespace axis {
using Block = Axis<"block">;  ///< Blocks of errors that move together.
}  // namespace axis

/// The sign of each block of a subset, '+' or '-'.
using Signs = std::string;

/// The blocks of each subset, and the errors of each corner.
struct CornerTable {
  CornerTable(const CouplingStudy& study, const ModelDescription& model);  ///< The table of a study of this model.

  std::vector<FactorIndex> factors;                ///< [V] the errors of the study (coupling_factors)
  std::vector<std::vector<std::size_t>> blocks;    ///< blocks of all sources, as positions among the factors
  std::vector<std::vector<std::size_t>> subsets;   ///< [K] blocks of each subset, as positions among the blocks
  std::vector<std::vector<double>> size_of_error;  ///< [Z] the size of each factor, [V], SI

  /// [V] The sign of each error at a corner of a subset: 1, -1, or 0 for errors outside the subset.
  std::vector<double> signs_of_errors(std::size_t subset, const Signs& signs) const;
};

/// The worst corners of a subset at one size and pose.
struct WorstCorners {
  std::vector<double> value;   ///< [R] largest |response| among the solved corners; NaN if none was solved
  std::vector<Signs> signs;    ///< [R] the corner of that value; empty if none was solved
  std::uint64_t tried = 0;     ///< corners that were tried
  std::uint64_t unsolved = 0;  ///< corners among them that have no solution
  Signs first_unsolved = {};   ///< one of those; empty if there is none
};

/// The worst corners of all subsets at one size and pose.
struct CornersAtPose {
  std::vector<WorstCorners> subsets;  ///< [K]
  SolveCounts solves;                 ///< of all corners
};

/// Searches the worst corners. For each response it tries the signs that add up the effects of the blocks alone (the
/// first-order sum), and the opposite signs. It does the same for sums and differences of signed responses of one unit
/// (ModelDescription::signed_headline), because a norm may be largest between its components. It also tries the corner
/// where all signs are positive. From the worst of these corners it flips each block alone, until no flip is worse by
/// more than rounding. A corner counts if it is solved (model/status.h); otherwise it cannot be assembled, or its
/// solution was not found. The result is not a bound: with B blocks, about B corners for each response are tried, of
/// 2^B. Owns the scratch of one thread. The result depends only on the arguments.
class CornerSearch {
 public:
  /// Refers to all arguments. rounding: see coupling_rounding().
  CornerSearch(const Model& model, const SolverOptions& solver, const PoseSet& poses, const CornerTable& table,
               const Array<double, axis::Response, axis::Size>& rounding);

  /// Searches all subsets at this pose and size.
  CornersAtPose operator()(std::size_t pose, std::size_t size);

 private:
  /// The corners of a subset that were tried.
  struct Tried {
    std::unordered_map<Signs, std::size_t> known;  ///< their numbers
    std::vector<Signs> signs;                      ///< in the order in which they were tried
    /// The magnitude of each response at each corner; NaN where the corner is not solved.
    std::vector<std::vector<double>> magnitude;

    /// The corner with the largest magnitude of a response; differences within rounding do not count.
    std::size_t worst(std::size_t response, double rounding) const;
  };
  /// A weighted sum of responses.
  using Direction = std::vector<std::pair<std::size_t, double>>;
  /// A corner that waits to be solved.
  struct Wanted {
    std::size_t subset;
    std::size_t corner;
  };

  /// The effect of each block of errors alone.
  using BlocksAlone = Array<double, axis::Block, axis::Response>;

  static std::vector<Direction> directions(const ModelDescription& model);
  void want(std::size_t subset, Signs signs);
  void want_first(std::size_t subset, const BlocksAlone& alone);
  void want_neighbours(std::size_t subset);
  void solve_wanted(std::size_t pose, std::size_t size, SolveCounts& solves);
  BlocksAlone blocks_alone(std::size_t pose, std::size_t size);
  /// Returns the errors of the next `count` samples, all set to zero.
  ArrayView<double, axis::Factor, axis::Sample> next_samples(std::size_t count);
  /// Solves these samples.
  ArrayView<const double, axis::Response, axis::Sample> solve(std::size_t pose, std::size_t count);
  WorstCorners found(std::size_t subset) const;

  const PoseSet* poses_;
  const CornerTable* table_;
  const Array<double, axis::Response, axis::Size>* rounding_;
  std::size_t responses_;
  std::vector<Direction> directions_;  ///< weighted sums whose first-order signs are tried
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> zeros_;          ///< [F]
  std::vector<double> at_size_;        ///< [R] rounding at the size
  std::vector<Tried> tried_;           ///< [K]
  std::vector<Wanted> wanted_;         ///< in the order in which corners are tried
  std::vector<double> values_;         ///< of one block of samples
  std::vector<double> outcomes_;       ///< of one block of samples
  std::vector<SolveStatus> status_;    ///< [B]
  std::vector<std::uint32_t> counts_;  ///< [B] iterations
};

/// About how many corners are tried at each size and pose.
double expected_corners(const CornerTable& table, std::size_t responses);

}  // namespace poesy
