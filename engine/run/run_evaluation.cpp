#include <algorithm>

#include "engine/run/evaluation_state.h"
#include "engine/run/run_in_order.h"
#include "engine/run/runner.h"

namespace poesy {
namespace {

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

EvaluationResult empty_evaluation(const Model& model, const PoseSet& poses, std::size_t samples, Outcomes outcomes) {
  const ModelDescription& description = model.description();
  EvaluationResult result;
  result.poses = poses.size();
  result.samples = samples;
  result.responses = description.responses.size();
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : description.details) result.details += detail.components.size();
  }
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

}  // namespace

std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes) {
  const bool paired = pairing == Pairing::row_by_row;
  const std::size_t samples = paired ? 1 : errors.rows;
  EvaluationResult result = empty_evaluation(model, poses, samples, outcomes);
  const std::size_t blocks = (samples + kBlockRows - 1) / kBlockRows;
  EvaluationProgress done(result, kBlockRows, options.shard.value_or(Shard()));
  const auto restore = [&](std::span<const std::byte> state) {
    done = EvaluationProgress(result, kBlockRows, options.shard.value_or(Shard()));
    done.restore(state);
  };
  Stage stage(options.checkpoints, options.team);
  stage.begin(restore);
  ProgressCounter counter(done.samples(), done.total(), options);
  const NumberRange pending = done.pending();
  const auto state = [&] { return done.state(); };
  const bool complete = run_in_order(
      pending.end - pending.first, options, [&] { return TableEvaluator(model, solver, poses, errors, result); },
      [&](TableEvaluator& evaluate, std::size_t n) {
        const std::size_t block = pending.first + n;
        const std::size_t pose = block / blocks;
        const std::size_t first = block % blocks * kBlockRows;
        const std::size_t count = std::min(kBlockRows, samples - first);
        return evaluate(PoseIndex(pose), first, paired ? pose : first, count);
      },
      [&](std::size_t, const SolveCounts& solves) {
        done.add_block();
        counter.add(solves);
        stage.merged(state);
      },
      [&](std::size_t n, const SolveCounts&, ByteWriter& to) { done.write_block(pending.first + n, to); },
      [&](std::size_t n, ByteReader& from) { return done.read_block(pending.first + n, from); });
  stage.end(
      complete, [&] { return done.total(); }, state, restore);
  if (!complete || options.shard) return std::nullopt;
  return result;
}

}  // namespace poesy
