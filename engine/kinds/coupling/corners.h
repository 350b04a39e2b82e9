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

/// The worst case of sources of errors whose signs are not known: each block of errors (error_blocks) has its size with
/// either sign, and a corner is a choice of signs. R responses, Z sizes, K subsets of the sources.
namespace poesy {

namespace axis {
using Block = Axis<"block">;  ///< Blocks of errors that move together.
}  // namespace axis

/// Of each block of a subset '+' or '-'.
using Signs = std::string;

/// Which blocks each subset has, and what the errors of a corner are.
struct CornerTable {
  CornerTable(const CouplingStudy& study, const ModelDescription& model);  ///< Of a study of this model.

  std::vector<FactorIndex> factors;                ///< [V] the study's (coupling_factors)
  std::vector<std::vector<std::size_t>> blocks;    ///< of all sources; positions of their errors among the factors
  std::vector<std::vector<std::size_t>> subsets;   ///< [K] positions of their blocks
  std::vector<std::vector<double>> size_of_error;  ///< [Z] of each factor, [V], SI

  /// The signs of all errors at a corner of a subset, [V]: 1, -1, or 0 for errors that are not in it.
  std::vector<double> signs_of_errors(std::size_t subset, const Signs& signs) const;
};

/// What was found of a subset at one size and pose.
struct WorstCorners {
  std::vector<double> value;   ///< [R] largest |response| of a corner that was solved; NaN where none was
  std::vector<Signs> signs;    ///< [R] that corner; empty where none was
  std::uint64_t tried = 0;     ///< corners
  std::uint64_t unsolved = 0;  ///< of these, corners that have no solution
  Signs first_unsolved = {};   ///< one of them; empty where there is none
};

/// What was found at one size and pose.
struct CornersAtPose {
  std::vector<WorstCorners> subsets;  ///< [K]
  SolveCounts solves;                 ///< of all corners
};

/// Looks for the worst corners. Of each response the signs of the first-order sum are solved, which add up what each
/// block does alone, and their opposite; so are those of sums and differences of the responses with signs that have one
/// unit (ModelDescription::signed_headline), because a norm is worst between its components; and the corner where all
/// are positive. From the worst of all corners that were solved, each block is flipped alone, until no flip is worse by
/// more than rounding. A corner counts where it is solved (model/status.h); one that is not cannot be assembled, or was
/// not found. What is found is no bound: of B blocks some B corners for each response are tried, of 2^B.
/// Owns the scratch of one thread. What it gives depends on its arguments alone.
class CornerSearch {
 public:
  /// rounding: up to which a response is rounding. Refers to all of them.
  CornerSearch(const Model& model, const SolverOptions& solver, const PoseSet& poses, const CornerTable& table,
               const Array<double, axis::Response, axis::Size>& rounding);

  /// All subsets at this pose and size.
  CornersAtPose operator()(std::size_t pose, std::size_t size);

 private:
  /// The corners of a subset that were tried.
  struct Tried {
    std::unordered_map<Signs, std::size_t> known;  ///< their numbers
    std::vector<Signs> signs;                      ///< in the order in which they were tried
    /// Of each corner, of each response; NaN where the corner is not solved.
    std::vector<std::vector<double>> magnitude;

    /// Of a response the corner whose magnitude is larger than others' by more than rounding.
    std::size_t worst(std::size_t response, double rounding) const;
  };
  /// A weighted sum of responses.
  using Direction = std::vector<std::pair<std::size_t, double>>;
  /// One that waits to be solved.
  struct Wanted {
    std::size_t subset;
    std::size_t corner;
  };

  /// What each block of errors does alone.
  using BlocksAlone = Array<double, axis::Block, axis::Response>;

  static std::vector<Direction> directions(const ModelDescription& model);
  void want(std::size_t subset, Signs signs);
  void want_first(std::size_t subset, const BlocksAlone& alone);
  void want_neighbours(std::size_t subset);
  void solve_wanted(std::size_t pose, std::size_t size, SolveCounts& solves);
  BlocksAlone blocks_alone(std::size_t pose, std::size_t size);
  /// Room for the errors of so many samples, all zero.
  ArrayView<double, axis::Factor, axis::Sample> next_samples(std::size_t count);
  /// Solves them.
  ArrayView<const double, axis::Response, axis::Sample> solve(std::size_t pose, std::size_t count);
  WorstCorners found(std::size_t subset) const;

  const PoseSet* poses_;
  const CornerTable* table_;
  const Array<double, axis::Response, axis::Size>* rounding_;
  std::size_t responses_;
  std::vector<Direction> directions_;  ///< whose first-order signs are tried
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> zeros_;          ///< [F]
  std::vector<double> at_size_;        ///< [R] rounding at the size
  std::vector<Tried> tried_;           ///< [K]
  std::vector<Wanted> wanted_;         ///< in the order of what is tried
  std::vector<double> values_;         ///< of one block of samples
  std::vector<double> outcomes_;       ///< of one block of samples
  std::vector<SolveStatus> status_;    ///< [B]
  std::vector<std::uint32_t> counts_;  ///< [B] iterations
};

/// About how many corners are tried at each size and pose.
double expected_corners(const CornerTable& table, std::size_t responses);

}  // namespace poesy
