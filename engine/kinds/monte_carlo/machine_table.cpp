#include "engine/kinds/monte_carlo/machine_table.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "engine/base/contract.h"
#include "engine/random/weighted_points.h"
#include "engine/run/effect_poses.h"

namespace poesy::monte_carlo {
namespace {

ErrorScore score_of(const Distribution& distribution) {
  using enum Distribution::Shape;
  switch (distribution.shape()) {
    case normal:
    case truncated_normal:
      return NormalScore{distribution.sigma(), distribution.half_width(), distribution.centre()};
    case uniform:
    case triangular:
    case measured: {
      const WeightedPoints points = weighted_points(distribution);
      return PolynomialScore(points.points, points.weights);
    }
    case given:
      return {};  // values that are given in a list have no sigma that could change
  }
  throw std::logic_error("unknown shape of distribution");
}

ErrorScores scores_of(const Plan& plan) {
  ErrorScores scores;
  for (std::size_t p = 0; p < plan.factors().size(); ++p) {
    // An error that is drawn together with others has no score of its own. An error with a shifted mean has no score
    // either, because the shift does not grow with sigma.
    const bool has_score = plan.is_drawn_alone(p) && plan.distributions()[p].shift() == 0.0;
    scores.each.push_back(has_score ? score_of(plan.distributions()[p]) : ErrorScore());
  }
  for (const CorrelatedSlots& block : plan.correlated()) {
    const auto is_normal = [&](std::size_t p) {
      return plan.distributions()[p].shape() == Distribution::Shape::normal;
    };
    if (!std::ranges::all_of(block.slots, is_normal)) continue;
    for (const std::size_t p : block.slots) {
      scores.each[p] = BlockScore{plan.distributions()[p].sigma(), plan.distributions()[p].centre()};
    }
    scores.blocks.push_back({block.slots, lower_triangle(block.copula.correlation())});
  }
  return scores;
}

/// The scores of those errors that each machine draws once (Draws::per_machine), or of those that it draws anew at each
/// pose (Draws::per_pose). The scores of the other errors are empty.
ErrorScores scores_of(const Plan& plan, const ErrorScores& all, Draws draws) {
  const auto is_one = [&](std::size_t p) { return plan.is_per_pose(p) == (draws == Draws::per_pose); };
  ErrorScores scores{std::vector<ErrorScore>(all.each.size())};
  for (std::size_t p = 0; p < all.each.size(); ++p) {
    if (is_one(p)) scores.each[p] = all.each[p];
  }
  for (const NormalBlock& block : all.blocks) {
    if (is_one(block.errors.front())) scores.blocks.push_back(block);
  }
  return scores;
}

/// The number of machines from which the gradient of the yield is estimated by a linear map from the errors to the
/// responses. With this number the estimate takes about a second, unless kLeast or kMost bounds the number.
/// 0 if this gradient is not wanted or not possible.
std::size_t mapped_machines(const Plan& plan, const LimitedVectors& vectors, const ErrorScores& scores) {
  constexpr std::size_t kMostWork = 1'000'000'000;  // multiplications for all machines
  constexpr std::size_t kWorkOfRange = 10;  // multiplications to find the range in which one error keeps one limit
  constexpr std::size_t kLeast = 1000;
  constexpr std::size_t kMost = 1'000'000;
  const bool is_wanted = std::ranges::any_of(
      scores.each, [](const ErrorScore& score) { return std::holds_alternative<PolynomialScore>(score); });
  if (!is_wanted || vectors.rows() == 0 || !plan.per_pose().empty()) return 0;
  const std::size_t at_pose = 2 * vectors.rows() + kWorkOfRange * vectors.each().size();
  return std::clamp(kMostWork / (plan.poses().size() * scores.each.size() * at_pose), kLeast, kMost);
}

}  // namespace

MachineTable::MachineTable(const Plan& plan, const Model& model, const Analysis& analysis,
                           const MachineCalibration* calibration, bool keep_all)
    : plan_(&plan),
      calibration_(calibration),
      responses_(model.description().responses.size()),
      has_limits_(!analysis.limits.empty()),
      limits_(limits_by_response(analysis.limits, responses_)),
      scores_(scores_of(plan)),
      fixed_scores_(scores_of(plan, scores_, Draws::per_machine)),
      pose_scores_(scores_of(plan, scores_, Draws::per_pose)),
      vectors_(plan, model, analysis),
      // There are no mapped machines if machines are calibrated or a limit is over several poses, because a linear map
      // from the errors to the responses contains neither the noise of measurements nor such a limit.
      mapped_(calibration != nullptr || any_over_poses(analysis.limits) ? 0 : mapped_machines(plan, vectors_, scores_)),
      kept_(keep_all && has_limits_ ? plan.samples() : mapped_) {
  POESY_EXPECTS(plan.draws() == Draws::per_machine);
  for (std::size_t r = 0; r < responses_; ++r) {
    if (!limits_[r].is_plain()) judged_.push_back(r);
  }
  for (std::size_t r = 0; r < responses_; ++r) rounding_.push_back(model.rounding(r));
  if (has_limits_) parts_ = part_groups(plan);
  effect_poses_ = poesy::effect_poses(plan.poses().size(), responses_, errors());
}

std::size_t MachineTable::unit_machines(std::size_t poses, UnitSize size_wanted) {
  // Numbers of machines in a unit. With 500, rows of numbers would be nearly one page of memory (4096 bytes) apart,
  // which makes the solver a third slower.
  constexpr std::array<std::size_t, 4> kSizes{1000, 200, 100, 40};
  static_assert(std::ranges::all_of(kSizes, [](std::size_t size) { return Plan::kUnitSamples % size == 0; }));
  constexpr std::size_t kMostSamples = 160'000;
  if (size_wanted == UnitSize::calibrated) return kSizes.back();
  const auto* const size = std::ranges::find_if(kSizes, [&](std::size_t one) { return one * poses <= kMostSamples; });
  return size == kSizes.end() ? kSizes.back() : *size;
}

std::size_t MachineTable::units_for(std::size_t machines, std::size_t poses, UnitSize size) {
  const std::size_t each = unit_machines(poses, size);
  return (machines + each - 1) / each;
}

WorkUnit MachineTable::unit(std::size_t n) const {
  POESY_EXPECTS(n < units());
  const std::size_t each = unit_machines();
  return {0, PoseIndex(0), SampleIndex(n * each), std::min(each, plan_->samples() - n * each)};
}

bool MachineTable::is_fitted(std::size_t n) const {
  constexpr std::size_t kLeast = 1000;
  constexpr std::size_t kForEach = 10;
  return vectors_.rows() > 0 && unit(n).first.value < std::max(kLeast, kForEach * (errors() + 1));
}

}  // namespace poesy::monte_carlo
