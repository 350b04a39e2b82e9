#include "engine/kinds/allocation/machine_loads.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>

#include "engine/base/archive.h"
#include "engine/kinds/allocation/load_solver.h"
#include "engine/run/unit_fold.h"
#include "engine/stats/sums.h"

namespace poesy::allocation {
namespace {

/// The machines that a run solves.
struct Machines {
  std::size_t count;                      ///< number of machines
  std::span<const std::uint32_t> listed;  ///< [machines] their numbers in the plan; empty: 0 .. count - 1

  std::size_t pieces() const { return (count + kMachinesOfPiece - 1) / kMachinesOfPiece; }
  std::size_t first(std::size_t piece) const { return piece * kMachinesOfPiece; }
  std::size_t count_of(std::size_t piece) const { return std::min(kMachinesOfPiece, count - first(piece)); }
  std::size_t number(std::size_t n) const { return listed.empty() ? n : listed[n]; }
};

/// The loads (MachineLoads) of consecutive machines over all poses, from one or several pieces of work.
struct LoadSums : MachineLoads {
  const Machines* machines = nullptr;

  LoadSums() = default;
  LoadSums(const Machines& all, std::size_t poses, std::size_t limits) : machines(&all) {
    solves.resize(poses);
    failed.resize(poses);
    beyond.resize(limits);
    near = Array<std::uint64_t, axis::Limit, axis::Pose>({limits, poses});
  }

  void add(std::size_t, const LoadSums& later) {
    load.insert(load.end(), later.load.begin(), later.load.end());
    merge_each(solves, later.solves);
    merge_each(failed, later.failed);
    for (std::size_t k = 0; k < beyond.size(); ++k) beyond[k] += later.beyond[k];
    std::ranges::transform(near, later.near, near.begin(), std::plus());
    unsolved += later.unsolved;
  }

  void state(Archive& archive, const NumberRange& pieces) {
    const std::size_t first = machines->first(pieces.first);
    const std::size_t end = std::max(first, std::min(machines->count, machines->first(pieces.end)));
    loads_state(archive, load, end - first);
    const bool some = first < end;
    ends_state(archive, solves, failed, end - first, some ? machines->number(first) : 0,
               some ? machines->number(end - 1) + 1 : 0);
    for (std::uint64_t& of_limit : beyond) archive.number(of_limit, end - first);
    for (std::uint64_t& of_limit : near) archive.number(of_limit, end - first);
    archive.number(unsolved, end - first);
  }
};

/// Computes the loads of the machines of a piece of work. Owns the scratch memory of one thread.
class LoadEvaluator : private LoadSolver {
 public:
  LoadEvaluator(const Plan& plan, const Model& model, const RelativeLimits& limits, const Machines& machines,
                const MachineCalibration* calibration)
      : LoadSolver(plan, model, limits, calibration), machines_(machines) {}

  LoadSums operator()(std::size_t piece) {
    const std::size_t count = machines_.count_of(piece);
    const std::size_t poses = plan_->poses().size();
    numbers_.clear();
    for (std::size_t b = 0; b < count; ++b) numbers_.push_back(machines_.number(machines_.first(piece) + b));
    draw(numbers_);
    calibrate(numbers_);
    LoadSums found(machines_, poses, limits_.size());
    found.load.assign(count, 0.0);
    missing_.assign(count, 0);
    beyond_.assign(limits_.size() * count, 0);
    begin_poses(count);
    deciding_.assign(count, {});
    for (std::size_t m = 0; m < poses; ++m) add(m, found);
    add_over_poses(found);
    for (std::size_t b = 0; b < count; ++b) {
      if (missing_[b] == 0) continue;
      if (found.load[b] <= 1.0) ++found.unsolved;
      found.load[b] = std::numeric_limits<double>::infinity();
      for (std::size_t k = 0; k < limits_.size(); ++k) beyond_[k * count + b] = 1;
    }
    for (std::size_t b = 0; b < count; ++b) {
      if (std::abs(found.load[b] - 1.0) <= kNearLimit) ++found.near(deciding_[b].limit, deciding_[b].pose);
    }
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const auto of_limit = std::span(beyond_).subspan(k * count, count);
      found.beyond[k] = static_cast<std::uint64_t>(std::ranges::count(of_limit, std::uint8_t{1}));
    }
    return found;
  }

 private:
  void add(std::size_t m, LoadSums& found) {
    at_pose_.assign(found.load.size(), 0.0);
    draw_per_pose(PoseIndex(m), numbers_);
    const UnitOutcomes outcomes = add_pose(PoseIndex(m), at_pose_, missing_, beyond_);
    for (std::size_t b = 0; b < at_pose_.size(); ++b) {
      if (at_pose_[b] > found.load[b]) {
        found.load[b] = at_pose_[b];
        deciding_[b] = {raised_by_[b], m};
      }
      found.solves[m].add(outcomes.status[b], outcomes.iterations[b]);
      found.failed[m].add(SampleIndex(numbers_[b]), outcomes.status[b]);
    }
  }

  void add_over_poses(LoadSums& found) {
    const std::size_t none = limits_.size();
    std::ranges::fill(raised_by_, none);
    end_poses(found.load, beyond_);
    for (std::size_t b = 0; b < found.load.size(); ++b) {
      if (raised_by_[b] != none) deciding_[b] = {raised_by_[b], 0};
    }
  }

  /// The limit and the pose that a load belongs to.
  struct Deciding {
    std::size_t limit = 0;
    std::size_t pose = 0;
  };

  const Machines& machines_;
  std::vector<std::size_t> numbers_;   ///< [machines] numbers of the machines
  std::vector<double> at_pose_;        ///< [machines] loads at one pose
  std::vector<Deciding> deciding_;     ///< [machines] what the load of the machine belongs to
  std::vector<std::uint8_t> missing_;  ///< [machines] 1 if the machine is not solved at some pose
  std::vector<std::uint8_t> beyond_;   ///< [limits x machines] 1 if the limit is broken at some pose
};

/// The job of a UnitFold (run/unit_fold.h), whose units are the pieces of work.
struct LoadJob {
  const Plan& plan;
  const Model& model;
  RelativeLimits limits;
  Machines machines;
  const MachineCalibration* calibration;

  static constexpr std::string_view kName = "machine loads";
  std::vector<std::uint64_t> sizes() const { return {machines.count, plan.poses().size(), limits.size()}; }
  NumberRange units(const Shard& shard) const { return shard.of(machines.pieces()); }
  std::uint64_t expected(std::size_t n) const { return std::uint64_t{machines.count_of(n)} * plan.poses().size(); }
  LoadEvaluator worker() const { return {plan, model, limits, machines, calibration}; }
  static SolveCounts solves(std::size_t, const LoadSums& unit) { return total_of(unit.solves); }
  LoadSums sums() const { return {machines, plan.poses().size(), limits.size()}; }
};

}  // namespace

std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          const RunOptions& options, const MachineCalibration* calibration) {
  const LoadJob job{plan, model, {plan, model, limits, calibration}, {plan.samples(), {}}, calibration};
  return fold_units(job, options);
}

std::optional<MachineLoads> machine_loads(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                          std::span<const std::uint32_t> machines, const RunOptions& options,
                                          const MachineCalibration* calibration) {
  const LoadJob job{plan, model, {plan, model, limits, calibration}, {machines.size(), machines}, calibration};
  return fold_units(job, options);
}

}  // namespace poesy::allocation
