#include "engine/kinds/corner_machines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "engine/base/array.h"
#include "engine/base/index.h"
#include "engine/kinds/calibrated_model.h"
#include "engine/report/html/parts.h"
#include "engine/report/tables.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/study/plan.h"
#include "engine/study/poses/corners.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

/// Returns true if one pose of a machine shows whether the machine misses a limit there.
bool has_limits_at_each_pose(const Study& study) {
  const Analysis& analysis = study.analysis;
  const auto is_relative_to_previous = [](const OwnResponse& own) {
    return own.relative_to && own.relative_to->is_previous();
  };
  return analysis.kind->varies == Varies::together && !analysis.kind->finds_sizes &&
         analysis.draws == Draws::per_machine && !analysis.limits.empty() && !any_over_poses(analysis.limits) &&
         std::ranges::none_of(study.mechanism.responses, is_relative_to_previous);
}

/// Notes which machines miss a limit at a pose of the plan. misses: [machines] true for a machine that misses a limit.
void add_misses(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                std::vector<bool>& misses) {
  PoseUnitEvaluator evaluator(plan, model);
  const std::size_t count = misses.size();
  for (std::size_t m = 0; m < plan.poses().size(); ++m) {
    const UnitOutcomes outcomes = evaluator.solve({0, PoseIndex(m), SampleIndex(0), count});
    const ArrayView<const double, axis::Response, axis::Sample> responses(outcomes.responses,
                                                                          {outcomes.responses.size() / count, count});
    for (std::size_t s = 0; s < count; ++s) {
      const auto is_missed = [&](const ResponseLimit& limit) {
        return !limit.allowed.holds(responses(limit.response, s));
      };
      if (!counts(outcomes.status[s], plan.not_converged()) || std::ranges::any_of(limits, is_missed)) misses[s] = true;
    }
  }
}

std::size_t number_of(const std::vector<bool>& misses) {
  return static_cast<std::size_t>(std::ranges::count(misses, true));
}

}  // namespace

std::optional<CornerMachines> corner_machines(const Study& study, const Model& model, const PoseSet& poses,
                                              const PoseSet& corners) {
  if (!has_limits_at_each_pose(study) || corners.size() == 0) return std::nullopt;
  constexpr std::size_t kMost = 100;  // machines
  constexpr std::size_t kLeast = 20;
  constexpr std::size_t kSolves = 20'000;
  const Plan plan(study, poses);
  const std::size_t machines = std::min({kMost, plan.samples(), kSolves / (poses.size() + corners.size())});
  if (machines < kLeast) return std::nullopt;
  const std::shared_ptr<const Model> studied = studied_model(study, model, poses);
  CornerMachines found{.machines = machines, .at_poses = 0, .with_corners = 0};
  std::vector<bool> misses(machines, false);
  add_misses(plan, *studied, study.analysis.limits, misses);
  found.at_poses = number_of(misses);
  add_misses(Plan(study, corners), *studied, study.analysis.limits, misses);
  found.with_corners = number_of(misses);
  return found;
}

std::string corners_text(const CornerMachines& found, const ModelDescription& model) {
  const std::size_t more = found.only_at_corners();
  std::string text = fmt::format(
      "of the first {} machines, {} {} a limit at the poses of the study, and {} at a corner of the workspace",
      found.machines, found.at_poses, found.at_poses == 1 ? "misses" : "miss",
      more == 0 ? "no further one" : fmt::format("{} more", more));
  if (more == 0) return text;
  std::vector<std::string> counts;
  for (const PoseCoordinate& coordinate : model.pose_coordinates) counts.push_back(coordinate.name + " = 2");
  return text +
         fmt::format("; to study the corners, write select = \"grid\", count = {{ {} }}", fmt::join(counts, ", "));
}

void add_not_covered(const Study& study, const Model& model, const StoredResult& result, Page& page) {
  const auto line = std::ranges::find(page.answer, kWhatToDo, &AnswerLine::first);
  if (line == page.answer.end()) return;
  std::vector<std::string> clauses{left_out_text(study), rejected_text(result)};
  const auto found = corner_machines(study, model, result.poses, feasible_corners(study.poses, model));
  if (found && found->only_at_corners() > 0) clauses.push_back(corners_text(*found, study.model()));
  for (std::string& clause : clauses) {
    if (!clause.empty()) line->second += " " + as_sentence(std::move(clause));
  }
}

}  // namespace poesy
