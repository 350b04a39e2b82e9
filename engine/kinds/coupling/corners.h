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

/// Searches for the worst case of error sources whose signs are unknown. In a block (error_blocks()), each error has
/// the size that the study states, and all have the same sign; a corner is a choice of the sign of each block.
namespace poesy::axis {

using Block = Axis<"block">;  ///< Blocks of errors that have the same sign.

}  // namespace poesy::axis

namespace poesy::coupling {

/// The sign of each block of errors in a subset of sources, '+' or '-'.
using Signs = std::string;

/// The blocks of each subset of sources, and the errors that the blocks contain.
struct CornerTable {
  CornerTable(const Options& study, const ModelDescription& model);  ///< Lists the blocks of a study's sources.

  std::vector<FactorIndex> factors;              ///< errors of the study, see coupling_factors()
  std::vector<std::vector<std::size_t>> blocks;  ///< blocks of all sources; a block is a list of indices in `factors`
  /// [subsets] Blocks of each subset of sources, as indices in `blocks`.
  std::vector<std::vector<std::size_t>> subsets;
  std::vector<std::vector<double>> size_of_error;  ///< [sizes][errors] size of each error of the study, SI

  /// The sign of each error of the study at a corner of a subset: 1, -1, or 0 for errors outside the subset.
  std::vector<double> signs_of_errors(std::size_t subset, const Signs& signs) const;
};

/// The worst corners (choices of the sign of each block) of a subset of sources at one size and pose.
struct WorstCorners {
  std::vector<double> value;  ///< [responses] largest |response| over the solved corners, SI; NaN if none was solved
  /// [responses] Signs of the blocks of errors at the corner that gives `value`; empty if none was solved.
  std::vector<Signs> signs;
  std::uint64_t tried = 0;     ///< number of corners that were tried
  std::uint64_t unsolved = 0;  ///< number of tried corners without a solution
  Signs first_unsolved = {};   ///< signs at the first corner without a solution; empty if there is none
};

/// The worst corners of all subsets at one size and pose.
struct CornersAtPose {
  std::vector<WorstCorners> subsets;  ///< [subsets] worst corners of each subset
  SolveCounts solves;                 ///< how the solves of all corners ended
};

/// Searches for the worst corners. For each response, the search tries the signs with which, to first order, the
/// effects of all blocks add up, and the opposite signs. It does the same for sums and differences of signed responses
/// with the same unit (ModelDescription::signed_headline), because a norm may be largest between the axes of its
/// components. It also tries the corner with all signs positive. Then it flips the sign of each single block at the
/// worst corner so far, until no flip makes the response worse by more than rounding. Only corners that are solved
/// (model/status.h) count; the others cannot be assembled, or their solution was not found. The result is not a bound:
/// a subset with B blocks has 2^B corners, of which about B are tried for each response. The result depends only on the
/// arguments. Owns the scratch memory of one thread.
class CornerSearch {
 public:
  /// Keeps references to all arguments. rounding: [responses x sizes] see coupling_rounding().
  CornerSearch(const Model& model, const SolverOptions& solver, const PoseSet& poses, const CornerTable& table,
               const Array<double, axis::Response, axis::Size>& rounding);

  /// Searches for the worst corners of all subsets at this pose and size.
  CornersAtPose operator()(std::size_t pose, std::size_t size);

 private:
  /// The corners of a subset of sources that were tried or wait to be tried.
  struct Tried {
    std::unordered_map<Signs, std::size_t> known;  ///< index of each corner in `signs`
    std::vector<Signs> signs;                      ///< corners in the order in which they are tried
    /// [corners][responses] Magnitude of each response, SI; NaN if the corner is not solved.
    std::vector<std::vector<double>> magnitude;

    /// Index of the corner at which a response has the largest magnitude. A later corner replaces an earlier one only
    /// if its magnitude is larger by more than rounding.
    std::size_t worst(std::size_t response, double rounding) const;
  };
  /// A weighted sum of responses, as pairs of response and weight.
  using Direction = std::vector<std::pair<std::size_t, double>>;
  /// A corner that waits to be solved.
  struct Wanted {
    std::size_t subset;
    std::size_t corner;
  };

  /// [blocks x responses] The responses if only the errors of one block are not zero.
  using BlocksAlone = Array<double, axis::Block, axis::Response>;

  static std::vector<Direction> directions(const ModelDescription& model);
  void want(std::size_t subset, Signs signs);
  void want_first(std::size_t subset, const BlocksAlone& alone);
  void want_neighbours(std::size_t subset);
  void solve_wanted(std::size_t pose, std::size_t size, SolveCounts& solves);
  BlocksAlone blocks_alone(std::size_t pose, std::size_t size);
  /// The errors of the next `count` samples, set to zero, for the caller to fill in.
  ArrayView<double, axis::Factor, axis::Sample> next_samples(std::size_t count);
  /// Solves the first `count` samples at a pose and returns their responses.
  ArrayView<const double, axis::Response, axis::Sample> solve(std::size_t pose, std::size_t count);
  WorstCorners found(std::size_t subset) const;

  const PoseSet* poses_;
  const CornerTable* table_;
  const Array<double, axis::Response, axis::Size>* rounding_;
  std::size_t responses_;
  std::vector<Direction> directions_;  ///< weighted sums of responses, see the class comment
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> zeros_;  ///< a zero for each error of the model
  /// [responses] Rounding of each response, SI, for the size of errors that is being solved.
  std::vector<double> at_size_;
  std::vector<Tried> tried_;           ///< [subsets] corners of each subset
  std::vector<Wanted> wanted_;         ///< corners that wait to be solved, in the order of solving
  std::vector<double> values_;         ///< errors of the samples that are solved together, SI
  std::vector<double> outcomes_;       ///< responses of the samples that are solved together, SI
  std::vector<SolveStatus> status_;    ///< how the solve of each of these samples ended
  std::vector<std::uint32_t> counts_;  ///< iterations of the solve of each of these samples
};

/// The expected number of corners that are solved for one size at one pose. responses: number of responses.
double expected_corners(const CornerTable& table, std::size_t responses);

}  // namespace poesy::coupling
