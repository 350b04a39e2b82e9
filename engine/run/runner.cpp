#include "engine/run/runner.h"

#include <oneapi/tbb/enumerable_thread_specific.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_pipeline.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <thread>
#include <type_traits>

#include "engine/run/evaluate_unit.h"
#include "engine/run/handover.h"
#include "engine/run/sensitivity.h"

namespace poesy {
namespace {

namespace tbb = oneapi::tbb;

bool stopped(const RunOptions& options) {
  return options.stop != nullptr && options.stop->load(std::memory_order_relaxed);
}

/// Calls work(worker, n) for n = 0 .. count - 1 on a pool of threads, each with its own worker, and finish(n, output)
/// in the order of n. A few outputs per thread are in flight at any time. Returns false when stopped.
template <class MakeWorker, class Work, class Finish>
bool run_in_order(std::size_t count, const RunOptions& options, MakeWorker make_worker, Work work, Finish finish) {
  using Worker = std::invoke_result_t<MakeWorker>;
  using Output = std::invoke_result_t<Work, Worker&, std::size_t>;
  const std::size_t threads = resolved_threads(options.threads);
  const std::size_t in_flight = 4 * threads;
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  tbb::task_arena arena(static_cast<int>(threads));
  tbb::enumerable_thread_specific<Worker> workers(make_worker);
  // The pipeline finishes in order with at most in_flight numbers under way, so no two of those share a slot.
  std::vector<Output> outputs(in_flight);
  std::size_t next = 0;
  std::size_t finished = 0;
  const handover::Task start([&](tbb::flow_control& control) -> std::size_t {
    if (next == count || stopped(options)) {
      control.stop();
      return 0;
    }
    return next++;
  });
  const handover::Task solve([&](std::size_t n) {
    outputs[n % in_flight] = work(workers.local(), n);
    return n;
  });
  const handover::Task collect([&](std::size_t n) {
    finish(n, outputs[n % in_flight]);
    ++finished;
  });
  arena.execute([&] {
    tbb::parallel_pipeline(in_flight,
                           tbb::make_filter<void, std::size_t>(tbb::filter_mode::serial_in_order, start) &
                               tbb::make_filter<std::size_t, std::size_t>(tbb::filter_mode::parallel, solve) &
                               tbb::make_filter<std::size_t, void>(tbb::filter_mode::serial_in_order, collect));
  });
  handover::receive();
  return finished == count;
}

/// Rows that are solved in one go at one pose.
constexpr std::size_t kBlockRows = 256;

/// Solves blocks of rows of an error table and scatters what they give into the result.
class TableEvaluator {
 public:
  TableEvaluator(const Model& model, const SolverOptions& solver, const PoseSet& poses, const ErrorTable& errors,
                 EvaluationResult& result)
      : poses_(&poses),
        errors_(&errors),
        result_(&result),
        zeros_(model.description().factors.size(), 0.0),
        evaluator_(model.evaluator(solver)) {}

  /// Samples first_sample .. of pose m are the rows first_row .. of the table.
  SolveCounts operator()(PoseIndex pose, std::size_t first_sample, std::size_t first_row, std::size_t count) {
    const std::size_t varied = errors_->factors.size();
    values_.resize(varied * count);
    for (std::size_t v = 0; v < varied; ++v) {
      for (std::size_t b = 0; b < count; ++b) {
        values_[v * count + b] = errors_->values[(first_row + b) * varied + v];
      }
    }
    const std::size_t start = pose.value * result_->samples + first_sample;
    responses_.resize(result_->responses * count);
    details_.resize(result_->details * count);
    const std::span status = std::span(result_->status).subspan(start, count);
    const std::span iterations = std::span(result_->iterations).subspan(start, count);
    evaluator_->evaluate({(*poses_)[pose], zeros_, errors_->factors, values_, count},
                         {responses_, status, iterations, details_});
    scatter(start, count);
    SolveCounts solves;
    for (std::size_t b = 0; b < count; ++b) solves.add(status[b], iterations[b]);
    return solves;
  }

 private:
  void scatter(std::size_t start, std::size_t count) {
    const std::size_t all = result_->poses * result_->samples;
    for (std::size_t r = 0; r < result_->responses; ++r) {
      std::copy_n(&responses_[r * count], count, &result_->response[r * all + start]);
    }
    for (std::size_t d = 0; d < result_->details; ++d) {
      for (std::size_t b = 0; b < count; ++b) {
        result_->detail[(start + b) * result_->details + d] = details_[d * count + b];
      }
    }
  }

  const PoseSet* poses_;
  const ErrorTable* errors_;
  EvaluationResult* result_;
  std::vector<double> zeros_;
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> values_;
  std::vector<double> responses_;
  std::vector<double> details_;
};

EvaluationResult empty_evaluation(const Model& model, const PoseSet& poses, std::size_t samples) {
  const ModelDescription& description = model.description();
  EvaluationResult result;
  result.poses = poses.size();
  result.samples = samples;
  result.responses = description.responses.size();
  for (const Detail& detail : description.details) result.details += detail.components.size();
  const std::size_t all = result.poses * samples;
  result.response.resize(result.responses * all);
  result.detail.resize(all * result.details);
  result.status.resize(all);
  result.iterations.resize(all);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    const std::vector<double> q = model.joint_displacements(poses[PoseIndex(m)]);
    result.joint_displacement.insert(result.joint_displacement.end(), q.begin(), q.end());
  }
  return result;
}

/// Reports progress after each finished piece of work.
class ProgressCounter {
 public:
  ProgressCounter(std::uint64_t total, const RunOptions& options) : options_(&options) { progress_.total = total; }

  void add(const SolveCounts& solves) {
    progress_.solves += solves.total();
    progress_.not_converged += solves.not_converged();
    if (options_->progress) options_->progress(progress_);
  }

 private:
  const RunOptions* options_;
  Progress progress_;
};

}  // namespace

std::size_t resolved_threads(std::size_t threads) {
  return threads != 0 ? threads : std::max<std::size_t>(1, std::thread::hardware_concurrency());
}

std::optional<SensitivityResult> run_sensitivity(const Plan& plan, const Model& model, double conf_level,
                                                 const RunOptions& options) {
  std::vector<UnitStats> cells(plan.factors().size() * plan.poses().size());
  ProgressCounter counter(plan.solves(), options);
  const bool complete = run_in_order(
      plan.units(), options, [&] { return UnitEvaluator(plan, model); },
      [&](UnitEvaluator& evaluate, std::size_t u) { return evaluate(plan.unit(u)); },
      [&](std::size_t u, const UnitStats& stats) {
        const WorkUnit unit = plan.unit(u);
        cells[unit.slot * plan.poses().size() + unit.pose.value].merge(stats);
        counter.add(stats.solves);
      });
  if (!complete) return std::nullopt;
  return sensitivity_result(plan, cells, conf_level);
}

std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options) {
  const bool paired = pairing == Pairing::row_by_row;
  const std::size_t samples = paired ? 1 : errors.rows;
  EvaluationResult result = empty_evaluation(model, poses, samples);
  const std::size_t blocks = (samples + kBlockRows - 1) / kBlockRows;
  ProgressCounter counter(poses.size() * samples, options);
  const bool complete = run_in_order(
      poses.size() * blocks, options, [&] { return TableEvaluator(model, solver, poses, errors, result); },
      [&](TableEvaluator& evaluate, std::size_t n) {
        const std::size_t pose = n / blocks;
        const std::size_t first = n % blocks * kBlockRows;
        const std::size_t count = std::min(kBlockRows, samples - first);
        return evaluate(PoseIndex(pose), first, paired ? pose : first, count);
      },
      [&](std::size_t, const SolveCounts& solves) { counter.add(solves); });
  if (!complete) return std::nullopt;
  return result;
}

}  // namespace poesy
