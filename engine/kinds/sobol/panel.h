#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/array.h"
#include "engine/kinds/sobol/design.h"
#include "engine/kinds/sobol/groups.h"
#include "engine/random/normal_copula.h"
#include "engine/run/result.h"
#include "engine/stats/moments.h"
#include "engine/stats/squared_differences.h"
#include "engine/study/plan.h"

namespace poesy::axis {

/// Quantities that get Sobol' indices: first the responses, then vectors of components with a sign (SignedVector).
using PanelQuantity = Axis<"quantity">;
using PanelRow = Axis<"row">;  ///< Numbers that a solve gives: first the responses, then the components of the model's
                               ///< additional outputs (Detail in model/model.h).
using GroupPair = Axis<"pair">;          ///< Pairs of groups.
using GroupSubset = Axis<"subset">;      ///< Subsets of the groups, as numbers whose bit g is set for group g.
using BlockError = Axis<"block_error">;  ///< Errors of a block of correlated errors.

}  // namespace poesy::axis

namespace poesy::sobol {

/// What a study of Sobol' indices computes: its groups, quantities and poses. A panel consists of two independent
/// samples A and B of all errors, and of mixtures, which take the errors of some groups from B and all others from A.
struct IndexPanel {
  /// Describes the panel of this study. Precondition: the study is of kind `sobol`.
  IndexPanel(const Study& study, std::size_t pose_count);

  std::vector<ErrorGroup> groups;  ///< groups of errors
  /// Vectors of components with a sign (SignedVector), for which indices are computed too.
  std::vector<SignedVector> vectors;
  std::size_t samples;           ///< number of samples in the study
  std::vector<GroupPair> pairs;  ///< pairs of groups, see group_pairs(); empty without second-order indices
  std::size_t responses;         ///< number of responses
  /// Number of components of the model's additional outputs (Detail in model/model.h); 0 if no vector needs them.
  std::size_t details;
  std::size_t poses;  ///< number of poses
  /// [groups] 1 if an error of the group is correlated with an error of another group, otherwise 0. A group with 1 gets
  /// neither S1 nor ST.
  std::vector<std::uint8_t> split;
  bool shapley;  ///< whether Shapley effects are wanted

  std::size_t quantities() const { return responses + vectors.size(); }  ///< The length of axis::PanelQuantity.
  std::size_t rows() const { return responses + details; }               ///< The length of axis::PanelRow.
  /// The rows that are the components of a quantity.
  std::span<const std::size_t> components(std::size_t quantity) const;
  /// The number of solves of one sample at each pose: A, B, and the mixtures.
  std::size_t solves_of_sample() const { return (shapley ? subsets() : 2 + groups.size()) + pairs.size(); }
  /// The length of axis::GroupSubset. Precondition: `shapley` is true.
  std::size_t subsets() const { return std::size_t{1} << groups.size(); }

 private:
  std::vector<std::vector<std::size_t>> components_;  ///< [quantities] rows of each quantity's components
};

/// Sums from which the two indices (total and first-order) of one group are computed.
struct IndexSums {
  RatioSums total;  ///< sums for the total index ST
  RatioSums first;  ///< sums for the first-order index S1

  void merge(const IndexSums& later);  ///< Adds the sums over later samples.
  void state(Archive& archive);        ///< Reads or writes the sums, bit for bit.
};

/// Sums over some samples of a panel (IndexPanel), from which the indices are computed.
struct PanelSums {
  PanelSums() = default;
  explicit PanelSums(const IndexPanel& panel);  ///< Empty sums.

  Array<IndexSums, axis::Response, axis::ErrorGroup, axis::Pose> at_poses;  ///< sums for the indices at each pose
  Array<IndexSums, axis::PanelQuantity, axis::ErrorGroup> aggregated;  ///< sums for the indices over all poses together
  Array<RatioSums, axis::Response, axis::GroupPair> pairs;             ///< sums for second-order indices over all poses
  /// Sums for Shapley effects over all poses; empty if not wanted.
  Array<RatioSums, axis::Response, axis::ErrorGroup> shapley;
  Array<Moments, axis::PanelRow, axis::Pose> moments;  ///< moments over the samples A and B together, SI
  Array<double, axis::Response> least;  ///< smallest response in the two samples A and B; infinity without samples
  std::vector<SolveCounts> solves;      ///< [poses] how the solves at each pose ended
  std::vector<FailedSamples> failed;    ///< [poses] first samples of A that were not solved
  std::vector<std::uint64_t> failures;  ///< [poses] number of samples of A that were not solved
  std::uint64_t end = 0;                ///< all numbers of samples are smaller than this

  /// Adds later samples of the same panel. Precondition: the samples of `later` come after those of this object.
  void merge(const PanelSums& later);
  /// Returns the sums over a single sample, whose values are the means over all samples of this object; moments and
  /// counts are copied. This is for a replicate of a design: its samples depend on each other, so only their mean is an
  /// independent sample.
  PanelSums as_one() const;

  void state(Archive& archive);  ///< Reads or writes the sums, bit for bit.
};

/// A block of correlated errors that belong to several groups.
struct SplitBlock {
  std::vector<std::size_t> slots;   ///< [block] position of each error in Plan::factors()
  std::vector<std::size_t> groups;  ///< [block] group of each error
  const NormalCopula* copula;       ///< joint distribution of the errors
};

/// The draws of a block of correlated errors that belong to several groups, for Shapley effects. A mixture takes the
/// errors of some groups from A, and draws the others conditional on them. Bit g of the number of a mixture is set if
/// group g is drawn.
struct SplitDraws {
  /// The errors of a block in one mixture.
  struct Mixture {
    std::vector<std::size_t> shared;  ///< positions in the block of the errors that are taken from sample A
    std::vector<std::size_t> drawn;   ///< positions in the block of the other errors, which are drawn
    /// Distribution of the normal scores of `drawn` given those of `shared`; none if either list is empty.
    std::optional<ConditionalScores> scores;
  };

  /// Prepares the mixtures of all subsets of groups. subsets: the number of these subsets.
  SplitDraws(SplitBlock split, std::size_t subsets);

  SplitBlock block;               ///< the block of correlated errors
  std::vector<Mixture> mixtures;  ///< [subsets] mixtures; the index is the number of the subset of groups that is drawn
  Array<double, axis::BlockError, axis::Sample> scores;   ///< [block errors x samples] normal scores in sample A
  Array<double, axis::BlockError, axis::Sample> normals;  ///< [block errors x samples] independent normals from which
                                                          ///< the scores of B are computed
};

/// Solves the samples A and B of a panel (IndexPanel), and mixtures of the two: A with the errors of one group, or of a
/// pair of groups, from B. For Shapley effects, it also solves A with every other subset of groups from B. A mixture
/// has the same errors at all poses. Errors from B that are correlated with errors from A are drawn conditional on
/// these errors from A, with the normal numbers of B. The result of a unit depends only on the study and the unit. Owns
/// the scratch memory of one thread.
class PanelEvaluator {
 public:
  /// Keeps references to all arguments.
  PanelEvaluator(const Plan& plan, const Model& model, const IndexPanel& panel, const PanelDesign& design);

  PanelSums operator()(const PanelUnit& unit);  ///< Solves a unit at all poses.
  /// Solves a unit at one pose, so that a caller can measure the time. Returns the number of solves.
  std::uint64_t try_pose(const PanelUnit& unit, PoseIndex pose);

 private:
  /// Numbers along some axes and for each sample of the unit.
  template <NamedAxis... Axes>
  using OfSamples = Array<double, Axes..., axis::Sample>;
  /// [samples] 1 or 0: whether each sample has some property.
  using Flags = std::vector<std::uint8_t>;
  /// The responses and additional outputs of samples at a pose.
  struct Outcomes {
    OfSamples<axis::PanelRow> values;
    Flags counts;  ///< whether the solve of each sample counts, see counts()
  };
  /// Numbers from which the indices of each group are computed, for each quantity and sample. A and B are the two
  /// independent samples; the mixture C is A with the errors of the group from B.
  struct GroupRows {
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> total;  ///< squared difference of the outcomes of A and C
    /// Squared difference of A and B minus that of B and C. Its mean is twice the covariance of B and C; this
    /// covariance is the variance that the group causes alone.
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> first;
    /// Squared difference of A and B. It is set only in `over_poses_`, to which a pose adds 0 if A, B or C does not
    /// count.
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> between;
  };

  void begin(const PanelUnit& unit);
  /// Resizes the scratch memory for this many samples and sets it to zero.
  void begin_scratch(std::size_t samples);
  void keep_scores(PanelSample sample, const OfSamples<axis::Factor>& uniforms);
  void add_pose(PoseIndex pose);
  void add_samples(PoseIndex pose);
  void add_group(PoseIndex pose, std::size_t group);
  void add_pair(PoseIndex pose, std::size_t pair);
  void add_over_poses();
  void solve(PoseIndex pose, const OfSamples<axis::Factor>& errors, Outcomes& outcomes);
  /// Sets `mixed_` to A with the errors of these groups from B. Without groups, sets it to A.
  void mix(std::span<const std::size_t> groups);
  void unmix(std::span<const std::size_t> groups);
  void draw_given(std::span<const std::size_t> groups);
  void add_indices(PoseIndex pose, std::size_t group);
  void keep_differences(std::size_t subset);
  void add_shapley(PoseIndex pose);
  void take(std::size_t group, const OfSamples<axis::Factor>& from);
  /// Sets the outcomes of the mixture to those of A for each sample in which all its responses differ from those of A
  /// only by rounding, so that rounding does not count as an effect.
  void absorb();
  /// Adds to `sum` [samples] the squared difference of a quantity between two outcomes, summed over its components.
  void add_squared_differences(std::size_t quantity, const Outcomes& one, const Outcomes& other,
                               std::span<double> sum) const;

  const Plan* plan_;
  const IndexPanel* panel_;
  const PanelDesign* design_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> rounding_;  ///< [responses] rounding of each response, SI, see Model::rounding
  PanelUnit unit_{};
  OfSamples<axis::Factor> a_;
  OfSamples<axis::Factor> b_;
  OfSamples<axis::Factor> mixed_;
  Outcomes of_a_;
  Outcomes of_b_;
  Outcomes of_mixed_;
  /// Squared difference of the outcomes of A and B at the present pose.
  OfSamples<axis::PanelQuantity> between_;
  GroupRows at_pose_;     ///< numbers at the present pose
  GroupRows over_poses_;  ///< numbers summed over the poses
  /// For each pair of groups: GroupRows::first of both groups as one, minus GroupRows::first of each group alone,
  /// summed over the poses.
  OfSamples<axis::Response, axis::GroupPair> pair_first_;
  /// Squared difference of A and B, summed over the poses at which A, B, the mixture of each of the two groups and the
  /// mixture of the pair count.
  OfSamples<axis::Response, axis::GroupPair> pair_between_;
  /// Blocks of correlated errors that belong to several groups, for Shapley effects.
  std::vector<SplitDraws> split_;
  /// Squared difference, at the present pose, of A and the mixture that takes this subset of groups from A and all
  /// others from B.
  OfSamples<axis::GroupSubset, axis::Response> differences_;
  Flags all_count_;  ///< [samples] 1 if all mixtures of the sample enter the sums at the present pose
  /// Shapley effects times variance, summed over the poses.
  OfSamples<axis::Response, axis::ErrorGroup> shapley_;
  /// Squared difference of A and B, summed over the poses at which all mixtures count (all_count_).
  OfSamples<axis::Response> shapley_between_;
  /// Whether samples A and B and the mixture C of the group (GroupRows) count at the present pose.
  Array<std::uint8_t, axis::ErrorGroup, axis::Sample> group_counts_;
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  PanelSums sums_;
};

}  // namespace poesy::sobol
