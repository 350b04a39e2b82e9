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
using PanelQuantity = Axis<"quantity">;  ///< What has indices: the responses, then the vectors with a sign.
using PanelRow = Axis<"row">;            ///< What is solved: the responses, then the components of all details.
using GroupPair = Axis<"pair">;          ///< Pairs of groups.
using GroupSubset = Axis<"subset">;      ///< Subsets of the groups, as numbers whose bit g is set for group g.
using BlockError = Axis<"block_error">;  ///< Errors of a block.
}  // namespace axis

/// What a panel is of.
struct IndexPanel {
  /// Of a study. Precondition: its kind is that of Sobol' indices.
  IndexPanel(const Study& study, std::size_t pose_count);

  std::vector<ErrorGroup> groups;     ///< of errors
  std::vector<SignedVector> vectors;  ///< of the model
  std::size_t samples;                ///< of the study
  std::vector<GroupPair> pairs;       ///< as group_pairs() lists them; none: not asked for
  std::size_t responses;              ///< number of them
  std::size_t details;                ///< components of all details; 0: none is needed
  std::size_t poses;                  ///< number of them
  std::vector<std::uint8_t> split;    ///< as split_groups(): 1 has no S1 and ST
  bool shapley;                       ///< whether Shapley effects are asked for

  std::size_t quantities() const { return responses + vectors.size(); }  ///< Positions of axis::PanelQuantity.
  std::size_t rows() const { return responses + details; }               ///< Positions of axis::PanelRow.
  std::span<const std::size_t> components(std::size_t quantity) const;   ///< Rows of which the quantity is made.
  /// At each pose.
  std::size_t solves_of_sample() const { return (shapley ? subsets() : 2 + groups.size()) + pairs.size(); }
  /// Positions of axis::GroupSubset. Precondition: shapley.
  std::size_t subsets() const { return std::size_t{1} << groups.size(); }

 private:
  std::vector<std::vector<std::size_t>> components_;  ///< of each quantity
};

/// What both indices of one group are made of.
struct IndexSums {
  RatioSums total;  ///< ST
  RatioSums first;  ///< S1

  void merge(const IndexSums& later);  ///< Both streams together.
  void state(Archive& archive);        ///< Every bit of them.
};

/// What some samples of a panel come to.
struct PanelSums {
  PanelSums() = default;
  explicit PanelSums(const IndexPanel& panel);  ///< Of no samples.

  Array<IndexSums, axis::Response, axis::ErrorGroup, axis::Pose> at_poses;  ///< of each pose by itself
  Array<IndexSums, axis::PanelQuantity, axis::ErrorGroup> aggregated;       ///< of the poses together
  Array<RatioSums, axis::Response, axis::GroupPair> pairs;                  ///< second-order indices
  Array<RatioSums, axis::Response, axis::ErrorGroup> shapley;               ///< Shapley effects; or empty
  Array<Moments, axis::PanelRow, axis::Pose> moments;                       ///< of the samples A and B
  Array<double, axis::Response> least;  ///< smallest of these; infinite without samples
  std::vector<SolveCounts> solves;      ///< of each pose
  std::vector<FailedSamples> failed;    ///< of each pose the first samples of A that were not solved
  std::vector<std::uint64_t> failures;  ///< of each pose how many there are
  std::uint64_t end = 0;                ///< no sample of the study has this number or a larger one

  /// Precondition: the samples of `later` come after those of this, and are of the same panel.
  void merge(const PanelSums& later);
  /// The same as one sample that is their mean, for a design whose samples depend on each other.
  PanelSums as_one() const;

  void state(Archive& archive);  ///< Every bit of it.
};

/// A block of correlated errors that are not all in one group.
struct SplitBlock {
  std::vector<std::size_t> slots;   ///< of its errors
  std::vector<std::size_t> groups;  ///< of its errors
  const NormalCopula* copula;       ///< of its errors
};

/// The same for Shapley effects: the groups of a mixture that are not shared with A, as bits, say which errors of the
/// block are drawn given which.
struct SplitDraws {
  /// Errors of one mixture.
  struct Mixture {
    std::vector<std::size_t> shared;          ///< positions in the block
    std::vector<std::size_t> drawn;           ///< likewise
    std::optional<ConditionalScores> scores;  ///< empty where it shares all or nothing
  };

  SplitDraws(SplitBlock split, std::size_t subsets);  ///< Of mixtures of so many subsets of groups.

  SplitBlock block;                                       ///< whose errors these are
  std::vector<Mixture> mixtures;                          ///< by the groups that are not shared
  Array<double, axis::BlockError, axis::Sample> scores;   ///< of A
  Array<double, axis::BlockError, axis::Sample> normals;  ///< from which the scores of B are made
};

/// Solves the samples A and B, and A with each group of errors, and each pair of groups, from B; at all poses with the
/// same errors. For Shapley effects also A with each other subset of groups from B. Where errors of groups that are
/// taken from B are correlated with errors that are not, they are drawn given these, from the normals of B. Owns the
/// scratch of one thread; what a unit gives depends on the study and the unit alone.
class PanelEvaluator {
 public:
  /// Refers to all of them.
  PanelEvaluator(const Plan& plan, const Model& model, const IndexPanel& panel, const PanelDesign& design);

  PanelSums operator()(const PanelUnit& unit);  ///< Solves the whole unit.
  /// Some of the unit's poses, from `pose` on: for an outlook. How many solves that were.
  std::uint64_t try_pose(const PanelUnit& unit, PoseIndex pose);

 private:
  /// A number of each sample of the unit along other axes.
  template <NamedAxis... Axes>
  using OfSamples = Array<double, Axes..., axis::Sample>;
  /// Flags: 0 or 1.
  using Flags = std::vector<std::uint8_t>;
  /// What samples came to.
  struct Outcomes {
    OfSamples<axis::PanelRow> values;
    Flags counts;  ///< whether the sample counts
  };
  /// Numbers for each quantity and group.
  struct GroupRows {
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> total;  ///< squared difference of A and C
    /// What B and C have in common: that of A and B, less that of B and C.
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> first;
    OfSamples<axis::PanelQuantity, axis::ErrorGroup> between;  ///< that of A and B, where all three count
  };

  void begin(const PanelUnit& unit);
  /// Makes the scratch for so many samples, all zero.
  void begin_scratch(std::size_t samples);
  void keep_scores(PanelSample sample, const OfSamples<axis::Factor>& uniforms);
  void add_pose(PoseIndex pose);
  void add_samples(PoseIndex pose);
  void add_group(PoseIndex pose, std::size_t group);
  void add_pair(PoseIndex pose, std::size_t pair);
  void add_over_poses();
  void solve(PoseIndex pose, const OfSamples<axis::Factor>& errors, Outcomes& outcomes);
  /// Makes mixed_ A with these groups from B, or A again.
  void mix(std::span<const std::size_t> groups);
  void unmix(std::span<const std::size_t> groups);
  void draw_given(std::span<const std::size_t> groups);
  void add_indices(PoseIndex pose, std::size_t group);
  void keep_differences(std::size_t subset);
  void add_shapley(PoseIndex pose);
  void take(std::size_t group, const OfSamples<axis::Factor>& from);
  /// Makes samples of C equal to A where they differ by rounding alone: their error is absorbed.
  void absorb();
  /// Adds the squared differences of a quantity's components.
  void add_squared_differences(std::size_t quantity, const Outcomes& one, const Outcomes& other,
                               std::span<double> sum) const;

  const Plan* plan_;
  const IndexPanel* panel_;
  const PanelDesign* design_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> rounding_;  ///< of each response as Model::rounding gives it
  PanelUnit unit_{};
  OfSamples<axis::Factor> a_;
  OfSamples<axis::Factor> b_;
  OfSamples<axis::Factor> mixed_;
  Outcomes of_a_;
  Outcomes of_b_;
  Outcomes of_mixed_;
  OfSamples<axis::PanelQuantity> between_;                    ///< of A and B at this pose
  GroupRows at_pose_;                                         ///< at this pose
  GroupRows over_poses_;                                      ///< sums over the poses
  OfSamples<axis::Response, axis::GroupPair> pair_first_;     ///< sums over the poses
  OfSamples<axis::Response, axis::GroupPair> pair_between_;   ///< likewise
  std::vector<SplitDraws> split_;                             ///< where Shapley effects are of groups that split blocks
  OfSamples<axis::GroupSubset, axis::Response> differences_;  ///< of A and what shares the subset with it, at this pose
  Flags all_count_;                                           ///< at this pose: all mixtures count
  OfSamples<axis::Response, axis::ErrorGroup> shapley_;       ///< sums over the poses
  OfSamples<axis::Response> shapley_between_;                 ///< likewise
  Array<std::uint8_t, axis::ErrorGroup, axis::Sample> group_counts_;  ///< at this pose: A, B and C count
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  PanelSums sums_;
};

}  // namespace poesy
