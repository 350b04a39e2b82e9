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

namespace poesy {

namespace axis {
using PanelQuantity = Axis<"quantity">;  ///< Quantities with indices: the responses, then the vectors with a sign.
using PanelRow = Axis<"row">;            ///< Values that are solved: the responses, then the components of all details.
using GroupPair = Axis<"pair">;          ///< Pairs of groups.
using GroupSubset = Axis<"subset">;      ///< Subsets of the groups, as numbers whose bit g is set for group g.
using BlockError = Axis<"block_error">;  ///< Errors of a block.
}  // namespace axis

/// The dimensions of a panel.
struct IndexPanel {
  /// The panel of a study. Precondition: the study is of Sobol' indices.
  IndexPanel(const Study& study, std::size_t pose_count);

  std::vector<ErrorGroup> groups;     ///< groups of errors
  std::vector<SignedVector> vectors;  ///< signed vectors of the model
  std::size_t samples;                ///< samples of the study
  std::vector<GroupPair> pairs;       ///< see group_pairs(); empty without second-order indices
  std::size_t responses;              ///< number of responses
  std::size_t details;                ///< components of all details; 0 if none are needed
  std::size_t poses;                  ///< number of poses
  std::vector<std::uint8_t> split;    ///< see split_groups(); a group with 1 has no S1 and ST
  bool shapley;                       ///< whether Shapley effects are wanted

  std::size_t quantities() const { return responses + vectors.size(); }  ///< The length of axis::PanelQuantity.
  std::size_t rows() const { return responses + details; }               ///< The length of axis::PanelRow.
  std::span<const std::size_t> components(
      std::size_t quantity) const;  ///< The rows that are the quantity's components.
  /// The solves of one sample at each pose.
  std::size_t solves_of_sample() const { return (shapley ? subsets() : 2 + groups.size()) + pairs.size(); }
  /// The length of axis::GroupSubset. Precondition: shapley.
  std::size_t subsets() const { return std::size_t{1} << groups.size(); }

 private:
  std::vector<std::vector<std::size_t>> components_;  ///< [quantities]
};

/// Sums for both indices of one group.
struct IndexSums {
  RatioSums total;  ///< ST
  RatioSums first;  ///< S1

  void merge(const IndexSums& later);  ///< Adds later sums.
  void state(Archive& archive);        ///< Reads or writes every bit.
};

/// Sums over some samples of a panel.
struct PanelSums {
  PanelSums() = default;
  explicit PanelSums(const IndexPanel& panel);  ///< Empty sums.

  Array<IndexSums, axis::Response, axis::ErrorGroup, axis::Pose> at_poses;  ///< for each pose alone
  Array<IndexSums, axis::PanelQuantity, axis::ErrorGroup> aggregated;       ///< for all poses together
  Array<RatioSums, axis::Response, axis::GroupPair> pairs;                  ///< second-order indices
  Array<RatioSums, axis::Response, axis::ErrorGroup> shapley;               ///< Shapley effects; empty if not wanted
  Array<Moments, axis::PanelRow, axis::Pose> moments;                       ///< of the samples A and B
  Array<double, axis::Response> least;  ///< smallest response in A and B; infinite without samples
  std::vector<SolveCounts> solves;      ///< [M]
  std::vector<FailedSamples> failed;    ///< [M] the first samples of A that were not solved
  std::vector<std::uint64_t> failures;  ///< [M] number of samples of A that were not solved
  std::uint64_t end = 0;                ///< larger than the number of every sample

  /// Adds later samples. Precondition: the samples of `later` come after those of this object, and are of the same
  /// panel.
  void merge(const PanelSums& later);
  /// The sums of one sample that is the mean of all, for a design whose samples depend on each other.
  PanelSums as_one() const;

  void state(Archive& archive);  ///< Reads or writes every bit.
};

/// A block of correlated errors that are not all in one group.
struct SplitBlock {
  std::vector<std::size_t> slots;   ///< [block] slots of the errors
  std::vector<std::size_t> groups;  ///< [block] groups of the errors
  const NormalCopula* copula;       ///< copula of the errors
};

/// The draws of a split block for Shapley effects. A mixture has a bit for each group that is not shared with A; the
/// bits determine which errors of the block are drawn conditional on which others.
struct SplitDraws {
  /// The errors of a block in one mixture.
  struct Mixture {
    std::vector<std::size_t> shared;          ///< errors shared with A, as positions in the block
    std::vector<std::size_t> drawn;           ///< errors drawn from B, as positions in the block
    std::optional<ConditionalScores> scores;  ///< empty if all or no errors are shared
  };

  SplitDraws(SplitBlock split, std::size_t subsets);  ///< Prepares mixtures of this many subsets of groups.

  SplitBlock block;                                       ///< the block
  std::vector<Mixture> mixtures;                          ///< [subsets] by the groups that are not shared
  Array<double, axis::BlockError, axis::Sample> scores;   ///< normal scores of A
  Array<double, axis::BlockError, axis::Sample> normals;  ///< normals from which the scores of B are made
};

/// Solves the samples A and B, and A with the errors of each group, and of each pair of groups, from B; at all poses
/// with the same errors. For Shapley effects also A with each other subset of groups from B. Errors taken from B that
/// are correlated with errors of A are drawn conditional on these, from the normals of B. Owns the scratch of one
/// thread. The result of a unit depends only on the study and the unit.
class PanelEvaluator {
 public:
  /// Refers to all arguments.
  PanelEvaluator(const Plan& plan, const Model& model, const IndexPanel& panel, const PanelDesign& design);

  PanelSums operator()(const PanelUnit& unit);  ///< Solves the whole unit.
  /// Solves the unit at some poses from `pose` on, for an outlook. Returns the number of solves.
  std::uint64_t try_pose(const PanelUnit& unit, PoseIndex pose);

 private:
  /// A number for each sample of the unit, and along other axes.
  template <NamedAxis... Axes>
  using OfSamples = Array<double, Axes..., axis::Sample>;
  /// Flags, 0 or 1.
  using Flags = std::vector<std::uint8_t>;
  /// The outcomes of samples.
  struct Outcomes {
    OfSamples<axis::PanelRow> values;
    Flags counts;  ///< whether the sample counts
  };
  /// Numbers for each quantity, group and sample.
  struct GroupRows {
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> total;  ///< squared difference of A and C
    /// The product that B and C share: the squared difference of A and B, less that of B and C.
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> first;
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> between;  ///< squared difference of A and B, where all three count
  };

  void begin(const PanelUnit& unit);
  /// Resizes the scratch for this many samples and sets it to zero.
  void begin_scratch(std::size_t samples);
  void keep_scores(PanelSample sample, const OfSamples<axis::Factor>& uniforms);
  void add_pose(PoseIndex pose);
  void add_samples(PoseIndex pose);
  void add_group(PoseIndex pose, std::size_t group);
  void add_pair(PoseIndex pose, std::size_t pair);
  void add_over_poses();
  void solve(PoseIndex pose, const OfSamples<axis::Factor>& errors, Outcomes& outcomes);
  /// Sets mixed_ to A with these groups from B; to A if there are none.
  void mix(std::span<const std::size_t> groups);
  void unmix(std::span<const std::size_t> groups);
  void draw_given(std::span<const std::size_t> groups);
  void add_indices(PoseIndex pose, std::size_t group);
  void keep_differences(std::size_t subset);
  void add_shapley(PoseIndex pose);
  void take(std::size_t group, const OfSamples<axis::Factor>& from);
  /// Sets samples of C to A where they differ only by rounding, which thus does not count as an effect.
  void absorb();
  /// Adds the squared differences of a quantity's components.
  void add_squared_differences(std::size_t quantity, const Outcomes& one, const Outcomes& other,
                               std::span<double> sum) const;

  const Plan* plan_;
  const IndexPanel* panel_;
  const PanelDesign* design_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> rounding_;  ///< [R] see Model::rounding
  PanelUnit unit_{};
  OfSamples<axis::Factor> a_;
  OfSamples<axis::Factor> b_;
  OfSamples<axis::Factor> mixed_;
  Outcomes of_a_;
  Outcomes of_b_;
  Outcomes of_mixed_;
  OfSamples<axis::PanelQuantity> between_;                   ///< squared difference of A and B at this pose
  GroupRows at_pose_;                                        ///< sums at this pose
  GroupRows over_poses_;                                     ///< sums over the poses
  OfSamples<axis::Response, axis::GroupPair> pair_first_;    ///< sums over the poses
  OfSamples<axis::Response, axis::GroupPair> pair_between_;  ///< sums over the poses
  std::vector<SplitDraws> split_;                            ///< blocks that groups split, for Shapley effects
  OfSamples<axis::GroupSubset, axis::Response>
      differences_;  ///< squared difference of A and the sample that shares the subset with it, at this pose
  Flags all_count_;  ///< whether all mixtures count at this pose
  OfSamples<axis::Response, axis::ErrorGroup> shapley_;               ///< sums over the poses
  OfSamples<axis::Response> shapley_between_;                         ///< sums over the poses
  Array<std::uint8_t, axis::ErrorGroup, axis::Sample> group_counts_;  ///< whether A, B and C count at this pose
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  PanelSums sums_;
};

}  // namespace poesy
