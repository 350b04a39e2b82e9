#include "engine/kinds/coupling/coupling.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/evaluation.h"
#include "engine/run/result.h"
#include "engine/stats/rounding.h"

namespace poesy {
namespace {

/// What a subset does at one pose. A NaN among the effects makes NaN of all that rests on it.
struct Combination {
  double effect = 0.0;
  double sum = 0.0;
  double magnitudes = 0.0;  ///< sum over the sources of |effect of the source|
  double largest = 0.0;     ///< |effect of a source|
  double worst_case = 0.0;
  double squares = 0.0;

  double cancellation(double rounding) const {
    const double cancelled = magnitudes - std::abs(sum);
    return cancelled <= rounding ? 0.0 : cancelled / magnitudes;
  }
  bool is_known() const { return !std::isnan(effect) && !std::isnan(sum) && !std::isnan(worst_case); }
  bool is_opposed(double rounding) const { return largest - std::abs(sum) > rounding; }
};

/// effects: [N] of the rows of one size, at one pose.
Combination combination(const CouplingRows& rows, std::size_t subset, std::span<const double> effects) {
  Combination found;
  found.effect = effects[subset];
  for (const std::size_t source : rows.subsets[subset]) {
    found.sum += effects[source];
    found.magnitudes += std::abs(effects[source]);
    found.largest = std::max(found.largest, std::abs(effects[source]));
    for (const std::size_t row : rows.block_rows[source]) {
      found.worst_case += std::abs(effects[row]);
      found.squares += effects[row] * effects[row];
    }
  }
  return found;
}

/// The largest of the values that were added, and the first pose that has it.
struct Largest {
  double value = kNaN;
  std::int64_t pose = -1;

  void add(double candidate, std::size_t m) {
    if (pose >= 0 && candidate <= value) return;
    value = candidate;
    pose = static_cast<std::int64_t>(m);
  }
};

/// The numbers of one subset at all poses.
struct Summary {
  std::uint64_t count = 0;
  std::uint64_t opposed = 0;
  Largest effect, interaction, worst_case, root_sum_square, cancellation;
};

/// Fills a result: for each response, size and subset, in this order, its poses and then their summary.
class Composer {
 public:
  Composer(const EvaluationResult& evaluation, const CouplingStudy& study, const ModelDescription& model,
           NotConverged policy)
      : evaluation_(&evaluation), study_(&study), rows_(coupling_rows(study, model)), policy_(policy) {
    POESY_EXPECTS(evaluation.samples == study.sizes() * rows_.errors.size());
    found_.responses = evaluation.responses;
    found_.sizes = study.sizes();
    found_.subsets = rows_.subsets.size();
    found_.poses = evaluation.poses;
  }

  CouplingResult operator()() {
    for (std::size_t r = 0; r < found_.responses; ++r) {
      for (std::size_t z = 0; z < found_.sizes; ++z) {
        const std::vector<double> effects = effects_of(r, z);
        for (std::size_t k = 0; k < found_.subsets; ++k) add_subset(k, effects, rounding_at(z));
      }
    }
    for (std::size_t z = 0; z < found_.sizes; ++z) {
      for (std::size_t m = 0; m < found_.poses; ++m) found_.solves.push_back(solves_at(z, m));
    }
    return std::move(found_);
  }

 private:
  std::size_t rows() const { return rows_.errors.size(); }
  std::size_t solve(std::size_t z, std::size_t m, std::size_t n) const {
    return m * evaluation_->samples + z * rows() + n;
  }

  double rounding_at(std::size_t z) const {
    const double linear = study_->linear.empty() ? 0.0 : study_->linear[z];
    const double angular = study_->angular.empty() ? 0.0 : study_->angular[z];
    return size_rounding(linear, angular);
  }

  /// [M x N]; NaN where the solve does not count.
  std::vector<double> effects_of(std::size_t r, std::size_t z) const {
    std::vector<double> effects;
    effects.reserve(found_.poses * rows());
    for (std::size_t m = 0; m < found_.poses; ++m) {
      for (std::size_t n = 0; n < rows(); ++n) {
        const std::size_t at = solve(z, m, n);
        const bool is_known = counts(evaluation_->status[at], policy_);
        effects.push_back(is_known ? evaluation_->response[r * evaluation_->status.size() + at] : kNaN);
      }
    }
    return effects;
  }

  void add_subset(std::size_t k, std::span<const double> effects, double rounding) {
    Summary summary;
    for (std::size_t m = 0; m < found_.poses; ++m) {
      const Combination at = combination(rows_, k, effects.subspan(m * rows(), rows()));
      const double interaction = at.effect - at.sum;
      const double root_sum_square = std::sqrt(at.squares);
      const double cancellation = at.cancellation(rounding);
      found_.effect.push_back(at.effect);
      found_.sum.push_back(at.sum);
      found_.interaction.push_back(interaction);
      found_.worst_case.push_back(at.worst_case);
      found_.root_sum_square.push_back(root_sum_square);
      found_.cancellation.push_back(cancellation);
      if (!at.is_known()) continue;
      ++summary.count;
      summary.opposed += at.is_opposed(rounding) ? 1 : 0;
      summary.effect.add(std::abs(at.effect), m);
      summary.interaction.add(std::abs(interaction), m);
      summary.worst_case.add(at.worst_case, m);
      summary.root_sum_square.add(root_sum_square, m);
      summary.cancellation.add(cancellation, m);
    }
    add_summary(summary);
  }

  void add_summary(const Summary& summary) {
    const double count = static_cast<double>(summary.count);
    found_.count.push_back(summary.count);
    found_.effect_max.push_back(summary.effect.value);
    found_.effect_max_pose.push_back(summary.effect.pose);
    found_.interaction_max.push_back(summary.interaction.value);
    found_.worst_case_max.push_back(summary.worst_case.value);
    found_.root_sum_square_max.push_back(summary.root_sum_square.value);
    found_.opposed_share.push_back(summary.count == 0 ? kNaN : static_cast<double>(summary.opposed) / count);
    found_.cancellation_max.push_back(summary.cancellation.value);
    found_.cancellation_max_pose.push_back(summary.cancellation.pose);
  }

  SolveCounts solves_at(std::size_t z, std::size_t m) const {
    SolveCounts solves;
    for (std::size_t n = 0; n < rows(); ++n) {
      solves.add(evaluation_->status[solve(z, m, n)], evaluation_->iterations[solve(z, m, n)]);
    }
    return solves;
  }

  const EvaluationResult* evaluation_;
  const CouplingStudy* study_;
  CouplingRows rows_;
  NotConverged policy_;
  CouplingResult found_;
};

}  // namespace

CouplingResult coupling_result(const EvaluationResult& evaluation, const CouplingStudy& study,
                               const ModelDescription& model, NotConverged policy) {
  return Composer(evaluation, study, model, policy)();
}

std::vector<std::string> subset_names(std::span<const ErrorSource> sources) {
  std::vector<std::string> names;
  for (const std::vector<std::size_t>& subset : source_subsets(sources.size())) {
    std::string& name = names.emplace_back();
    for (const std::size_t source : subset) name += (name.empty() ? "" : "+") + sources[source].name;
  }
  return names;
}

}  // namespace poesy
