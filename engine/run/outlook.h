#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/model/model.h"
#include "engine/run/checkpoints.h"
#include "engine/run/evaluation.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"

namespace poesy {

/// What a run has in memory at its peak, while it writes its result, without the program itself; bytes.
struct MemoryOutlook {
  std::size_t accumulators = 0;  ///< what the run still has of them when the result is made
  std::size_t state = 0;         ///< the run as a checkpoint has it; a large one is on the disk at the end
  std::size_t result = 0;        ///< plain values
  std::size_t file = 0;          ///< the result file, which is composed on the disk

  std::size_t peak() const {  ///< Of all of it.
    return accumulators + (state <= kMostStateInMemory ? state : 0) + result;
  }
};

/// Work of a study that can be tried in pieces, to measure how fast a machine does it.
struct WorkOutlook {
  /// Does the piece that begins at this share of the work, 0 <= at < 1, on this thread. Gives the share that it was.
  std::function<double(double at)> do_piece;
  double times = 1.0;  ///< how much the study does of this work
  /// Done once before the first piece; its time does not count. None where empty.
  std::function<void()> prepare = {};
};

/// What a study will ask of a machine. Refers to the study, the model and the poses.
struct Outlook {
  std::string solves;               ///< their number, and what it is the product of
  MemoryOutlook memory;             ///< beyond that of the program
  std::vector<WorkOutlook> shared;  ///< by all threads: the solves
  std::vector<WorkOutlook> by_one;  ///< what only one thread does: separating errors
  double least = 1.0;               ///< share of the solves that are made in any case
  /// What only one thread does at a time while the others solve: merging what solves come to.
  std::vector<WorkOutlook> merging = {};
};

/// Seconds that one thread takes for the works of an outlook.
struct WorkSeconds {
  double shared = 0.0;   ///< by all threads
  double merging = 0.0;  ///< by one at a time
  double by_one = 0.0;   ///< by one, afterwards

  /// Seconds that so many threads take, of which each merges in turn. share: of the solves that are made.
  double on(std::size_t threads, double share = 1.0) const;
};

/// What a state takes of some numbers (base/bytes.h): whole numbers up to two million take three bytes at the most.
/// @{
inline constexpr std::size_t kWholeNumber = 3;
inline constexpr std::size_t kStoredMoments = kWholeNumber + 4 * sizeof(double);
inline constexpr std::size_t kStoredSolves = (kStatusNames.size() + 2) * kWholeNumber;
/// @}
/// What /solver has of a cell: failures, mean and most iterations, samples by status.
inline constexpr std::size_t kSolverColumns = (2 + kStatusNames.size()) * sizeof(double) + sizeof(std::uint32_t);

/// So many of each.
MemoryOutlook times(std::size_t count, const MemoryOutlook& each);
/// Bytes of the outcomes of one row of errors at one pose.
std::size_t outcome_bytes(const ModelDescription& model, Outcomes outcomes);

/// "3 errors x ".
std::string counted_things(std::size_t count, std::string_view things);
/// The samples at each pose, and what adaptive ones leave open: "1000 to 100000".
std::string samples_text(const Plan& plan);
/// "at least 3000 and at most 300000 solves".
std::string solves_text(const Plan& plan, std::size_t fidelities);
/// The share of the plan's solves that adaptive samples make in any case.
double least_share(const Plan& plan);

/// A model that somebody else owns.
inline std::shared_ptr<const Model> borrowed(const Model& model) { return {std::shared_ptr<const Model>(), &model}; }

/// All draws of the plan; a piece is a few of one unit.
template <class SolveUnit>
WorkOutlook sampling(const std::shared_ptr<const Plan>& plan, const std::shared_ptr<const Model>& model, double times) {
  struct Sampler {
    std::shared_ptr<const Plan> plan;
    std::shared_ptr<const Model> model;
    SolveUnit solve;
  };
  const auto sampler = std::make_shared<Sampler>(Sampler{plan, model, SolveUnit(*plan, *model)});
  return {[sampler](double at) {
            const Plan& all = *sampler->plan;
            WorkUnit unit = all.unit(static_cast<std::size_t>(at * static_cast<double>(all.units())));
            unit.count = std::min<std::size_t>(unit.count, 200);
            return static_cast<double>(sampler->solve(unit).solves.total()) / static_cast<double>(all.solves());
          },
          times};
}

/// Work of a study that solves tables of errors: run_poses(poses) does it for a few of its poses.
template <class RunPoses>
WorkOutlook table_work(const PoseSet& poses, RunPoses run_poses) {
  return {[&poses, run_poses](double at) {
    const std::size_t count = std::min<std::size_t>(poses.size(), 4);
    std::vector<double> some;
    for (std::size_t k = 0; k < count; ++k) {
      const auto m = static_cast<std::size_t>(at * static_cast<double>(poses.size())) + k * poses.size() / count;
      const auto pose = poses[PoseIndex(m % poses.size())];
      some.insert(some.end(), pose.begin(), pose.end());
    }
    run_poses(PoseSet(poses.coordinates(), std::move(some)));
    return static_cast<double>(count) / static_cast<double>(poses.size());
  }};
}

/// The same for every pose with every row of errors.
WorkOutlook table_work(const Study& study, const Model& model, const PoseSet& poses, ErrorTable table,
                       Outcomes outcomes);

}  // namespace poesy
