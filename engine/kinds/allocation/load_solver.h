#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/kinds/allocation/relative_limits.h"
#include "engine/model/model.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// The number of machines that are solved together at each pose.
inline constexpr std::size_t kMachinesOfPiece = 200;

/// This number of solves, counted as converged. For work that only counts solves; how solves end is counted when all
/// machines are tried.
inline SolveCounts as_converged(std::uint64_t solves) {
  SolveCounts counts;
  counts.by_status[static_cast<std::size_t>(SolveStatus::converged)] = solves;
  return counts;
}

/// Reads or writes `count` loads. No load is negative, and a machine without a solution has an infinite load.
inline void loads_state(Archive& archive, std::vector<double>& loads, std::size_t count) {
  archive.list(loads, count);
  archive.expect(std::ranges::all_of(loads, [](double load) { return load >= 0.0; }), "has loads that no machine has");
}

/// Draws machines, solves them at the poses of a plan, and computes their loads. Owns the scratch of one thread.
class LoadSolver : protected UnitSolver {
 protected:
  /// Refers to all three arguments.
  LoadSolver(const Plan& plan, const Model& model, const RelativeLimits& limits)
      : UnitSolver(plan, model, plan.factors().size()), limits_(limits) {}

  /// Draws the errors of these machines at the first pose into values_ [P x B]. machines: ascending numbers, at most
  /// kMachinesOfPiece.
  void draw(std::span<const std::size_t> machines) {
    const std::size_t count = machines.size();
    const std::size_t errors = plan_->factors().size();
    for (std::size_t p = 0; p < errors; ++p) draw_row(p, PoseIndex(0), machines);
    plan_->transform(std::span(values_).first(errors * count), count);
  }

  /// Draws those of their errors anew that machines have anew at each pose. Returns the positions of these errors.
  std::span<const std::size_t> draw_per_pose(PoseIndex pose, std::span<const std::size_t> machines) {
    const std::span<const std::size_t> errors = plan_->per_pose();
    if (errors.empty()) return errors;
    for (const std::size_t p : errors) draw_row(p, pose, machines);
    plan_->transform_per_pose(std::span(values_).first(plan_->factors().size() * machines.size()), machines.size());
    return errors;
  }

  /// Begins to collect what limits over poses need of this many machines.
  void begin_poses(std::size_t machines) {
    const std::size_t poses = plan_->poses().size();
    if (limits_.any_over_poses()) at_poses_.assign(limits_.size() * machines * poses, 0.0);
  }

  /// Solves the drawn machines at one pose and raises their loads [B]. Sets missing [B] to 1 where a machine is not
  /// solved, and beyond [K x B] to 1 where it breaks a limit. Limits over poses wait for end_poses().
  UnitOutcomes add_pose(PoseIndex pose, std::span<double> loads, std::span<std::uint8_t> missing,
                        std::span<std::uint8_t> beyond) {
    const std::size_t count = loads.size();
    const UnitOutcomes outcomes = UnitSolver::solve(pose, plan_->factors(), count, 0.0);
    for (std::size_t b = 0; b < count; ++b) {
      if (!counts(outcomes.status[b], plan_->not_converged())) missing[b] = 1;
    }
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const double* const y = &outcomes.responses[limits_.response(k) * count];
      for (std::size_t b = 0; b < count; ++b) {
        if (!counts(outcomes.status[b], plan_->not_converged())) continue;
        const double load = limits_.is_spread(k) ? y[b] : limits_.load(k, pose, y[b]);
        if (limits_.is_over_poses(k)) {
          values_over_poses(k, b, count)[pose.value] = load;
          continue;
        }
        loads[b] = std::max(loads[b], load);
        if (load > 1.0) beyond[k * count + b] = 1;
      }
    }
    return outcomes;
  }

  /// Raises the loads of the machines by limits over poses, and sets beyond, as add_pose() does. Loads of machines that
  /// are not solved at a pose say nothing.
  void end_poses(std::span<double> loads, std::span<std::uint8_t> beyond) {
    const std::size_t count = loads.size();
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      if (!limits_.is_over_poses(k)) continue;
      for (std::size_t b = 0; b < count; ++b) {
        const double load = limits_.load_over_poses(k, values_over_poses(k, b, count));
        loads[b] = std::max(loads[b], load);
        if (load > 1.0) beyond[k * count + b] = 1;
      }
    }
  }

  const RelativeLimits& limits_;  ///< K limits

 private:
  /// [M] What the limit needs of a machine at each pose.
  std::span<double> values_over_poses(std::size_t k, std::size_t machine, std::size_t count) {
    const std::size_t poses = plan_->poses().size();
    return std::span(at_poses_).subspan((k * count + machine) * poses, poses);
  }

  /// Fills the row of an error with the uniforms of these machines at a pose.
  void draw_row(std::size_t error, PoseIndex pose, std::span<const std::size_t> machines) {
    const std::size_t count = machines.size();
    for (std::size_t from = 0; from < count;) {  // consecutive machines are drawn together
      std::size_t to = from + 1;
      while (to < count && machines[to] == machines[to - 1] + 1) ++to;
      const WorkUnit run{0, pose, SampleIndex(machines[from]), to - from};
      draw_uniforms(run, error, std::span(values_).subspan(error * count + from, to - from));
      from = to;
    }
  }

  std::vector<double> at_poses_;  ///< [K x B x M] for limits over poses; empty without one
};

}  // namespace poesy
