#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/kinds/sobol/design.h"
#include "engine/kinds/sobol/groups.h"
#include "engine/random/normal_copula.h"
#include "engine/run/result.h"
#include "engine/stats/moments.h"
#include "engine/stats/squared_differences.h"
#include "engine/study/plan.h"

namespace poesy {

/// What a panel is of: R responses and V signed vectors, P groups of errors, M poses.
struct IndexPanel {
  /// Of a study. Precondition: its kind is that of Sobol' indices.
  IndexPanel(const Study& study, std::size_t pose_count);

  std::vector<ErrorGroup> groups;                          ///< [P]
  std::vector<SignedVector> vectors;                       ///< [V]
  std::vector<std::pair<std::size_t, std::size_t>> pairs;  ///< of groups, the smaller first; none: not asked for
  std::size_t responses;                                   ///< R
  std::size_t details;                                     ///< D, components of all details; 0: none is needed
  std::size_t poses;                                       ///< M
  std::vector<std::uint8_t> split;                         ///< [P] as split_groups(): 1 has no S1 and ST
  bool shapley;                                            ///< whether Shapley effects are asked for

  std::size_t quantities() const { return responses + vectors.size(); }  ///< R + V, in this order.
  std::size_t rows() const { return responses + details; }               ///< R + D, in this order.
  std::span<const std::size_t> components(std::size_t quantity) const;   ///< Rows of [(R + D) x B].
  /// At each pose.
  std::size_t solves_of_sample() const { return (shapley ? subsets() : 2 + groups.size()) + pairs.size(); }
  /// Of the groups, as numbers whose bit g is set for group g. Precondition: shapley.
  std::size_t subsets() const { return std::size_t{1} << groups.size(); }

 private:
  std::vector<std::vector<std::size_t>> components_;  ///< [R + V]
};

/// What both indices of one group are made of.
struct IndexSums {
  RatioSums total;  ///< ST
  RatioSums first;  ///< S1
};

/// What some samples of a panel come to.
struct PanelSums {
  PanelSums() = default;
  explicit PanelSums(const IndexPanel& panel);  ///< Of no samples.

  std::vector<IndexSums> at_poses;      ///< [R x P x M]
  std::vector<IndexSums> aggregated;    ///< [(R + V) x P]
  std::vector<RatioSums> pairs;         ///< [R x pairs] second-order indices
  std::vector<RatioSums> shapley;       ///< [R x P] Shapley effects; or empty
  std::vector<Moments> moments;         ///< [(R + D) x M] of the samples A and B
  std::vector<double> least;            ///< [R] smallest of these; infinite without samples
  std::vector<SolveCounts> solves;      ///< [M]
  std::vector<FailedSamples> failed;    ///< [M] the first samples of A that were not solved
  std::vector<std::uint64_t> failures;  ///< [M] how many there are

  /// Precondition: the samples of `later` come after those of this, and are of the same panel.
  void merge(const PanelSums& later);
  /// The same as one sample that is their mean, for a design whose samples depend on each other.
  PanelSums as_one() const;

  void write(ByteWriter& to) const;  ///< Every bit of it.
  /// The opposite, of samples before `end`. Throws BytesError.
  static PanelSums read(ByteReader& from, const IndexPanel& panel, std::uint64_t end);
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

  SplitBlock block;               ///< whose errors these are
  std::vector<Mixture> mixtures;  ///< [subsets] by the groups that are not shared
  std::vector<double> scores;     ///< [k x B] of A
  std::vector<double> normals;    ///< [k x B] from which the scores of B are made
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
  /// Rows of B numbers.
  using Rows = std::vector<double>;
  /// What samples came to.
  struct Outcomes {
    Rows values;                       ///< [(R + D) x B]
    std::vector<std::uint8_t> counts;  ///< [B] whether the sample counts
  };
  /// Numbers for each quantity and group, [(R + V) x P x B].
  struct GroupRows {
    Rows total;    ///< squared difference of A and C
    Rows first;    ///< what B and C have in common: that of A and B, less that of B and C
    Rows between;  ///< that of A and B, where all three count
  };

  void begin(const PanelUnit& unit);
  void keep_scores(PanelSample sample, const Rows& uniforms);
  void add_pose(PoseIndex pose);
  void add_samples(PoseIndex pose);
  void add_group(PoseIndex pose, std::size_t group);
  void add_pair(PoseIndex pose, std::size_t pair);
  void add_over_poses();
  void solve(PoseIndex pose, const Rows& errors, Outcomes& outcomes);
  /// Makes mixed_ A with these groups from B, or A again.
  void mix(std::span<const std::size_t> groups);
  void unmix(std::span<const std::size_t> groups);
  void draw_given(std::span<const std::size_t> groups);
  void add_indices(PoseIndex pose, std::size_t group);
  void keep_differences(std::size_t subset);
  void add_shapley(PoseIndex pose);
  void take(std::size_t group, const Rows& from);
  /// Makes samples of C equal to A where they differ by rounding alone: their error is absorbed.
  void absorb();
  std::span<double> row(Rows& rows, std::size_t number) const;
  /// Adds the squared differences of a quantity's components.
  void add_squared_differences(std::size_t quantity, const Outcomes& one, const Outcomes& other,
                               std::span<double> sum) const;

  const Plan* plan_;
  const IndexPanel* panel_;
  const PanelDesign* design_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> rounding_;  ///< [R] as Model::rounding gives it
  PanelUnit unit_{};
  Rows a_;  ///< [errors x B], as b_ and mixed_
  Rows b_;
  Rows mixed_;
  Outcomes of_a_;
  Outcomes of_b_;
  Outcomes of_mixed_;
  Rows between_;                            ///< [(R + V) x B] of A and B at this pose
  GroupRows at_pose_;                       ///< at this pose
  GroupRows over_poses_;                    ///< sums over the poses
  Rows pair_first_;                         ///< [R x pairs x B] sums over the poses
  Rows pair_between_;                       ///< likewise
  std::vector<SplitDraws> split_;           ///< where Shapley effects are of groups that split blocks
  Rows differences_;                        ///< [subsets x R x B] of A and what shares the subset with it, at this pose
  std::vector<std::uint8_t> all_count_;     ///< [B] at this pose: all mixtures count
  Rows shapley_;                            ///< [R x P x B] sums over the poses
  Rows shapley_between_;                    ///< [R x B] likewise
  std::vector<std::uint8_t> group_counts_;  ///< [P x B] at this pose: A, B and C count
  std::vector<SolveStatus> status_;
  std::vector<std::uint32_t> iterations_;
  PanelSums sums_;
};

}  // namespace poesy
