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

/// The memory that a run takes at its peak, which is when it writes its result, in bytes. The memory of the program
/// itself is not included.
struct MemoryOutlook {
  std::size_t accumulators = 0;  ///< the accumulators, which still exist when the result is computed
  /// The state in a checkpoint. At the end of a run it is also in memory, unless it is larger than kMostStateInMemory.
  std::size_t state = 0;
  std::size_t result = 0;  ///< the numbers of the result
  std::size_t file = 0;    ///< the result file, which is composed on disk

  std::size_t peak() const {  ///< The peak: the sum of the parts that are in memory.
    return accumulators + (state <= kMostStateInMemory ? state : 0) + result;
  }
};

/// Work of a study in pieces. A few pieces are done to measure how long the whole work takes.
struct WorkOutlook {
  /// Does a small piece of the work on the calling thread. at: where in the work the piece begins, 0 <= at < 1. Returns
  /// the piece's share of the whole work.
  std::function<double(double at)> do_piece;
  double times = 1.0;  ///< number of times that the study does the whole work
  /// A function that is called once before the first piece, and whose time is not measured. May be empty.
  std::function<void()> prepare = {};
};

/// The expected cost of a study: solves, memory and kinds of work. It keeps references to the study, the model and the
/// poses.
struct Outlook {
  std::string solves;               ///< number of solves, as a text: "3 errors x 2 poses x 1000 samples = 6000 solves"
  MemoryOutlook memory;             ///< memory in addition to that of the program itself
  std::vector<WorkOutlook> shared;  ///< work that all threads share: the solves
  /// Work that one thread does while the others wait, such as separating the effects of errors (Separation) or reading
  /// saved states.
  std::vector<WorkOutlook> by_one;
  /// With adaptive samples: the least number of solves, as a fraction of the largest number; 1 if the number of samples
  /// is fixed.
  double least = 1.0;
  /// Work that one thread at a time does while the other threads solve: merging the outcomes.
  std::vector<WorkOutlook> merging = {};
};

/// Seconds that one thread takes for each kind of work in an outlook.
struct WorkSeconds {
  double shared = 0.0;   ///< seconds for Outlook::shared, the work of all threads
  double merging = 0.0;  ///< seconds for Outlook::merging, the work of one thread at a time
  double by_one = 0.0;   ///< seconds for Outlook::by_one, the work of only one thread

  /// Seconds for the whole study on this number of threads, of which one at a time merges. share: solves that the study
  /// makes, as a share of the largest number; below 1 if adaptive sampling ends early.
  double on(std::size_t threads, double share = 1.0) const;
};

/// Bytes that a whole number, moments, and counts of solves take in a state (base/bytes.h). A whole number up to two
/// million takes at most three bytes.
/// @{
inline constexpr std::size_t kWholeNumber = 3;
inline constexpr std::size_t kStoredMoments = kWholeNumber + 4 * sizeof(double);
inline constexpr std::size_t kStoredSolves = (kStatusNames.size() + 2) * kWholeNumber;
/// @}
/// Bytes that one cell (a varied error at a pose, or a pose) takes in the group /solver of a result: failures, mean and
/// largest number of iterations, samples by status.
inline constexpr std::size_t kSolverColumns = (2 + kStatusNames.size()) * sizeof(double) + sizeof(std::uint32_t);

/// The memory of `count` objects that each take the memory `each`.
MemoryOutlook times(std::size_t count, const MemoryOutlook& each);
/// Bytes of an EvaluationResult for one row of errors at one pose.
std::size_t outcome_bytes(const ModelDescription& model, Outcomes outcomes);

/// The text "COUNT THINGS", such as "3 errors" for 3 and "errors".
std::string counted_things(std::size_t count, std::string_view things);
/// The number of samples at each pose as text; for adaptive samples a range, such as "1000 to 100000".
std::string samples_text(const Plan& plan);
/// The number of solves as text, such as "at least 3000 and at most 300000 solves". fidelities: number of models that
/// solve each sample.
std::string solves_text(const Plan& plan, std::size_t fidelities);
/// The least number of solves with adaptive samples, as a share of the largest number.
double least_share(const Plan& plan);

/// A shared pointer that does not own the model.
inline std::shared_ptr<const Model> borrowed(const Model& model) { return {std::shared_ptr<const Model>(), &model}; }

/// The work of solving all samples of the plan. A piece of this work is at most 200 samples of one unit. times: see
/// WorkOutlook.
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

/// The work of a study that solves a table of errors at each pose. run_poses(poses) does this work for some of the
/// study's poses.
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

/// The work of solving every row of an error table at every pose.
WorkOutlook table_work(const Study& study, const Model& model, const PoseSet& poses, ErrorTable table,
                       Outcomes outcomes);

}  // namespace poesy
