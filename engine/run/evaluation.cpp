#include "engine/run/evaluation.h"

#include <algorithm>
#include <utility>

#include "engine/run/evaluation_state.h"
#include "engine/run/fold.h"

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

/// Blocks of rows of an error table, pose by pose: the work of fold(). Threads write outcomes where they belong.
class TableWork {
 public:
  TableWork(const Model& model, const SolverOptions& solver, const PoseSet& poses, const ErrorTable& errors,
            Pairing pairing, Outcomes outcomes, const Shard& shard)
      : model_(model),
        solver_(solver),
        poses_(poses),
        errors_(errors),
        paired_(pairing == Pairing::row_by_row),
        shard_(shard),
        result_(empty_evaluation(model, poses, paired_ ? 1 : errors.rows, outcomes)),
        done_(result_, kBlockRows, shard) {}

  std::size_t begin_round() {
    pending_ = done_.pending();
    return pending_.end - pending_.first;
  }
  TableEvaluator worker() { return {model_, solver_, poses_, errors_, result_}; }
  SolveCounts solve(TableEvaluator& evaluate, std::size_t n) const {
    const std::size_t blocks = (result_.samples + kBlockRows - 1) / kBlockRows;
    const std::size_t pose = (pending_.first + n) / blocks;
    const std::size_t first = (pending_.first + n) % blocks * kBlockRows;
    return evaluate(PoseIndex(pose), first, paired_ ? pose : first, std::min(kBlockRows, result_.samples - first));
  }
  const SolveCounts& merge(std::size_t, const SolveCounts& solves) {
    done_.add_block();
    return solves;
  }
  void write(std::size_t n, const SolveCounts&, ByteWriter& to) const { done_.write_block(pending_.first + n, to); }
  SolveCounts read(std::size_t n, ByteReader& from) { return done_.read_block(pending_.first + n, from); }
  SolveCounts solved() const { return done_.total(); }
  std::uint64_t left() const { return done_.samples() - solved().total(); }
  Bytes state() const { return done_.state(); }
  void restore(std::span<const std::byte> state) {
    done_ = EvaluationProgress(result_, kBlockRows, shard_);
    done_.restore(state);
  }
  static bool next_round() { return false; }

  EvaluationResult result() && { return std::move(result_); }

 private:
  const Model& model_;
  const SolverOptions& solver_;
  const PoseSet& poses_;
  const ErrorTable& errors_;
  bool paired_;
  Shard shard_;
  EvaluationResult result_;
  EvaluationProgress done_;
  NumberRange pending_{};
};

}  // namespace

SolveCounts EvaluationResult::total() const {
  SolveCounts sum;
  for (std::size_t n = 0; n < status.size(); ++n) sum.add(status[n], iterations[n]);
  return sum;
}

std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes) {
  TableWork work(model, solver, poses, errors, pairing, outcomes, options.shard.value_or(Shard()));
  if (!fold(work, options) || options.shard) return std::nullopt;
  return std::move(work).result();
}

}  // namespace poesy
