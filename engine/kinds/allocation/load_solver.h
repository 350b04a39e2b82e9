#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/base/archive.h"
#include "engine/kinds/allocation/relative_limits.h"
#include "engine/kinds/machine_calibration.h"
#include "engine/model/model.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/result.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy::allocation {

/// The largest number of machines that one thread solves together at a pose.
inline constexpr std::size_t kMachinesOfPiece = 200;

/// SolveCounts for a piece of work that does not record how its solves ended: all solves count as converged. Only
/// machine_loads() records how solves ended.
inline SolveCounts as_converged(std::uint64_t solves) {
  SolveCounts counts;
  counts.by_status[static_cast<std::size_t>(SolveStatus::converged)] = solves;
  return counts;
}

/// Reads or writes the loads (MachineLoads) of `count` machines. A load is never negative, and a machine that is not
/// solved has an infinite load.
inline void loads_state(Archive& archive, std::vector<double>& loads, std::size_t count) {
  archive.list(loads, count);
  archive.expect(std::ranges::all_of(loads, [](double load) { return load >= 0.0; }), "has loads that no machine has");
}

/// Draws the machines of a plan, solves them at its poses, and computes their loads: for each machine the largest ratio
/// of a response to its limit. Owns the scratch memory of one thread.
class LoadSolver : protected UnitSolver {
 protected:
  /// Keeps references to all arguments. calibration: the calibration of each machine; null: machines are not
  /// calibrated.
  LoadSolver(const Plan& plan, const Model& model, const RelativeLimits& limits, const MachineCalibration* calibration)
      : UnitSolver(plan, model, plan.factors().size()), limits_(limits), calibration_(calibration) {
    if (calibration != nullptr) calibrator_ = std::make_unique<MachineCalibrator>(*calibration);
  }

  /// Draws the errors of these machines into `values_` [errors x machines]. Errors that machines draw anew at each pose
  /// get their values at the first pose. machines: numbers, ascending, at most kMachinesOfPiece.
  void draw(std::span<const std::size_t> machines) {
    const std::size_t count = machines.size();
    const std::size_t errors = plan_->factors().size();
    for (std::size_t p = 0; p < errors; ++p) draw_row(p, PoseIndex(0), machines);
    plan_->transform(std::span(values_).first(errors * count), count);
  }

  /// If the study calibrates machines: calibrates those whose errors are in `values_` [errors x machines]. All
  /// following solves are of the calibrated machines.
  void calibrate(std::span<const std::size_t> machines) {
    if (calibrator_ == nullptr) return;
    calibrated_ = calibration_->evaluator((*calibrator_)(all_errors(drawn(machines.size())), machines));
    solve_by(calibrated_.get());
  }
  bool is_calibrated() const { return calibrator_ != nullptr; }  ///< Whether machines are calibrated.

  /// Draws for this pose the errors that machines draw anew at each pose. Returns their indices in Plan::factors().
  std::span<const std::size_t> draw_per_pose(PoseIndex pose, std::span<const std::size_t> machines) {
    const std::span<const std::size_t> errors = plan_->per_pose();
    if (errors.empty()) return errors;
    for (const std::size_t p : errors) draw_row(p, pose, machines);
    plan_->transform_per_pose(std::span(values_).first(plan_->factors().size() * machines.size()), machines.size());
    return errors;
  }

  /// Allocates memory for the values of this number of machines at all poses, if some limit is judged from several
  /// poses together (RelativeLimits::is_over_poses()).
  void begin_poses(std::size_t machines) {
    const std::size_t poses = plan_->poses().size();
    if (limits_.any_over_poses()) at_poses_.assign(limits_.size() * machines * poses, 0.0);
  }

  /// Solves the drawn machines at one pose and raises their loads [machines] to the largest so far. Sets `missing`
  /// [machines] to 1 for a machine that is not solved, and `beyond` [limits x machines] to 1 for a machine that breaks
  /// the limit. For limits that are judged from several poses together, only records the values for end_poses().
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
        raise(loads[b], load, b, k);
        if (load > 1.0) beyond[k * count + b] = 1;
      }
    }
    return outcomes;
  }

  /// For each limit that is judged from several poses together: computes the load of each machine from the values that
  /// add_pose() recorded, writes this load into `loads` [machines] if it is larger than the element there, and sets
  /// `beyond` [limits x machines] as add_pose() does. The load of a machine that is not solved at some pose is
  /// meaningless.
  void end_poses(std::span<double> loads, std::span<std::uint8_t> beyond) {
    const std::size_t count = loads.size();
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      if (!limits_.is_over_poses(k)) continue;
      for (std::size_t b = 0; b < count; ++b) {
        const double load = limits_.load_over_poses(k, values_over_poses(k, b, count));
        raise(loads[b], load, b, k);
        if (load > 1.0) beyond[k * count + b] = 1;
      }
    }
  }

  const RelativeLimits& limits_;  ///< limits of the study
  /// [machines] The limit by which add_pose() or end_poses() last raised the load of the machine.
  std::vector<std::size_t> raised_by_ = std::vector<std::size_t>(kMachinesOfPiece);

 private:
  /// Raises the load of a machine to that under limit k, if this is larger.
  void raise(double& load, double of_limit, std::size_t machine, std::size_t k) {
    if (!(of_limit > load)) return;
    load = of_limit;
    raised_by_[machine] = k;
  }

  /// [poses] The values that were recorded for a machine under limit k. count: number of machines in the piece of work.
  std::span<double> values_over_poses(std::size_t k, std::size_t machine, std::size_t count) {
    const std::size_t poses = plan_->poses().size();
    return std::span(at_poses_).subspan((k * count + machine) * poses, poses);
  }

  /// Fills the row of an error in `values_` with the uniform numbers from which the error of each of these machines is
  /// drawn at a pose.
  void draw_row(std::size_t error, PoseIndex pose, std::span<const std::size_t> machines) {
    const std::size_t count = machines.size();
    for (std::size_t from = 0; from < count;) {  // machines with consecutive numbers are drawn in one call
      std::size_t to = from + 1;
      while (to < count && machines[to] == machines[to - 1] + 1) ++to;
      const WorkUnit run{0, pose, SampleIndex(machines[from]), to - from};
      draw_uniforms(run, error, std::span(values_).subspan(error * count + from, to - from));
      from = to;
    }
  }

  const MachineCalibration* calibration_;
  std::unique_ptr<MachineCalibrator> calibrator_;  ///< null: machines are not calibrated
  std::unique_ptr<Evaluator> calibrated_;          ///< evaluator of the machines that were calibrated last
  /// [limits x machines x poses] Values for limits that are judged from several poses together: the response (SI) for a
  /// limit on a spread, otherwise the load. Empty if all limits are judged pose by pose.
  std::vector<double> at_poses_;
};

}  // namespace poesy::allocation
