#include "engine/run/evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/run/fold.h"

namespace poesy {
namespace {

/// Rows that are solved in one go at one pose.
constexpr std::size_t kBlockRows = 256;
/// No other state begins with this number.
constexpr std::uint64_t kKind = 3;

/// How the solves first .. end - 1 ended, counted pose by pose.
SolveCounts solves_of(const EvaluationResult& result, std::size_t first, std::size_t end) {
  SolveCounts solves;
  for (std::size_t n = first; n < end; ++n) solves.add(result.status.all()[n], result.iterations.all()[n]);
  return solves;
}

EvaluationResult empty_evaluation(const Model& model, const PoseSet& poses, std::size_t samples, Outcomes outcomes) {
  const ModelDescription& description = model.description();
  std::size_t components = 0;
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : description.details) components += detail.components.size();
  }
  EvaluationResult result;
  make_room({description.responses.size(), poses.size(), samples}, result.response);
  make_room({poses.size(), samples, components}, result.detail);
  make_room({poses.size(), samples}, result.status, result.iterations);
  make_room({poses.size(), description.joints.size()}, result.joint_displacement);
  for (std::size_t m = 0; m < poses.size(); ++m) {
    std::ranges::copy(model.joint_displacements(poses[PoseIndex(m)]), result.joint_displacement.row(m).begin());
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
        zeros_(model.description().factors.size(), 0.0),
        paired_(pairing == Pairing::row_by_row),
        shard_(shard),
        result_(empty_evaluation(model, poses, paired_ ? 1 : errors.rows, outcomes)),
        done_(result_, kBlockRows, shard) {}

  /// The scratch of one thread.
  struct Worker {
    std::unique_ptr<Evaluator> evaluator;
    std::vector<double> values;
    std::vector<double> responses;
    std::vector<double> details;
  };

  std::size_t begin_round() {
    pending_ = done_.pending();
    return pending_.end - pending_.first;
  }
  Worker worker() const { return {model_.evaluator(solver_), {}, {}, {}}; }
  SolveCounts solve(Worker& worker, std::size_t n) {
    const std::size_t blocks = (result_.samples() + kBlockRows - 1) / kBlockRows;
    const std::size_t pose = (pending_.first + n) / blocks;
    const std::size_t first = (pending_.first + n) % blocks * kBlockRows;
    const std::size_t count = std::min(kBlockRows, result_.samples() - first);
    take_rows(paired_ ? pose : first, count, worker.values);
    worker.responses.resize(result_.responses() * count);
    worker.details.resize(result_.detail.length<axis::Component>() * count);
    const std::span<SolveStatus> status = result_.status.row(pose).subspan(first, count);
    const std::span<std::uint32_t> iterations = result_.iterations.row(pose).subspan(first, count);
    worker.evaluator->evaluate({poses_[PoseIndex(pose)], zeros_, errors_.factors, worker.values, count},
                               {worker.responses, status, iterations, worker.details});
    scatter(worker, pose, first, count);
    SolveCounts solves;
    for (std::size_t b = 0; b < count; ++b) solves.add(status[b], iterations[b]);
    return solves;
  }
  const SolveCounts& merge(std::size_t, const SolveCounts& solves) {
    done_.add_block();
    return solves;
  }
  void write(std::size_t n, const SolveCounts&, ByteWriter& to) const { done_.write_block(pending_.first + n, to); }
  SolveCounts read(std::size_t n, ByteReader& from) { return done_.read_block(pending_.first + n, from); }
  SolveCounts solved() const { return done_.total(); }
  std::uint64_t left() const { return done_.samples() - solved().total(); }
  void write_state(ByteWriter& to) const { done_.write_state(to); }
  void restore(std::span<const std::byte> state) {
    done_ = EvaluationProgress(result_, kBlockRows, shard_);
    done_.restore(state);
  }
  static bool next_round() { return false; }

  EvaluationResult result() && { return std::move(result_); }

 private:
  /// Rows of the table, error by error.
  void take_rows(std::size_t first, std::size_t count, std::vector<double>& values) const {
    const std::size_t varied = errors_.factors.size();
    values.resize(varied * count);
    const ArrayView<double, axis::Factor, axis::Sample> by_error(values, {varied, count});
    const ArrayView<const double, axis::Sample, axis::Factor> table(errors_.values, {errors_.rows, varied});
    for (std::size_t v = 0; v < varied; ++v) {
      for (std::size_t b = 0; b < count; ++b) by_error(v, b) = table(first + b, v);
    }
  }

  void scatter(Worker& from, std::size_t pose, std::size_t first, std::size_t count) {
    const ArrayView<double, axis::Response, axis::Sample> responses(from.responses, {result_.responses(), count});
    for (std::size_t r = 0; r < result_.responses(); ++r) {
      std::ranges::copy(responses.row(r), result_.response.row(r, pose).subspan(first).begin());
    }
    const std::size_t components = result_.detail.length<axis::Component>();
    const ArrayView<double, axis::Component, axis::Sample> details(from.details, {components, count});
    for (std::size_t d = 0; d < components; ++d) {
      for (std::size_t b = 0; b < count; ++b) result_.detail(pose, first + b, d) = details(d, b);
    }
  }

  const Model& model_;
  const SolverOptions& solver_;
  const PoseSet& poses_;
  const ErrorTable& errors_;
  std::vector<double> zeros_;
  bool paired_;
  Shard shard_;
  EvaluationResult result_;
  EvaluationProgress done_;
  NumberRange pending_{};
};

}  // namespace

SolveCounts EvaluationResult::total() const { return solves_of(*this, 0, status.size()); }

std::optional<EvaluationResult> run_evaluation(const Model& model, const SolverOptions& solver, const PoseSet& poses,
                                               const ErrorTable& errors, Pairing pairing, const RunOptions& options,
                                               Outcomes outcomes) {
  TableWork work(model, solver, poses, errors, pairing, outcomes, options.shard.value_or(Shard()));
  if (!fold(work, options) || options.shard) return std::nullopt;
  return std::move(work).result();
}

LimitVerdicts judge_rows(std::span<const ResponseLimit> limits, const EvaluationResult& found, Pairing pairing,
                         NotConverged policy) {
  const bool paired = pairing == Pairing::row_by_row;
  const std::size_t rows = paired ? found.poses() : found.samples();
  LimitVerdicts verdicts;
  for (const ResponseLimit& limit : limits) {
    LimitVerdict verdict{.response = limit.response, .limit = limit.most, .value = kNaN, .tried = rows};
    for (std::size_t row = 0; row < rows; ++row) {
      bool within = found.poses() > 0;
      for (std::size_t m = paired ? row : 0; m < (paired ? row + 1 : found.poses()); ++m) {
        const std::size_t sample = paired ? 0 : row;
        const double magnitude = std::abs(found.response(limit.response, m, sample));
        const bool counted = counts(found.status(m, sample), policy);
        within = within && counted && magnitude <= limit.most;
        if (!counted || std::isnan(magnitude) || magnitude <= verdict.value) continue;
        verdict.value = magnitude;
        verdict.pose = m;
        verdict.row = row;
      }
      if (within) ++verdict.within;
    }
    verdict.passed = verdict.within == verdict.tried;
    verdicts.limits.push_back(verdict);
  }
  return verdicts;
}

EvaluationProgress::EvaluationProgress(EvaluationResult& result, std::size_t block_rows, const Shard& shard)
    : result_(&result),
      block_rows_(block_rows),
      blocks_per_pose_((result.samples() + block_rows - 1) / block_rows),
      blocks_(shard.of(result.poses() * blocks_per_pose_)),
      next_(blocks_.first) {
  POESY_EXPECTS(block_rows > 0);
}

std::size_t EvaluationProgress::outcomes(std::size_t block) const {
  if (blocks_per_pose_ == 0) return 0;
  return block / blocks_per_pose_ * result_->samples() +
         std::min(block % blocks_per_pose_ * block_rows_, result_->samples());
}

SolveCounts EvaluationProgress::total() const { return solves_of(*result_, outcomes(blocks_.first), outcomes(next_)); }

std::array<std::uint64_t, 6> EvaluationProgress::sizes() const {
  return {
      kKind,      result_->poses(), result_->samples(), result_->responses(), result_->detail.length<axis::Component>(),
      block_rows_};
}

void EvaluationProgress::write_state(ByteWriter& to) const {
  for (const std::uint64_t number : sizes()) to.number(number);
  to.number(blocks_.first);
  to.number(next_);
  write_outcomes(outcomes(blocks_.first), outcomes(next_), to);
}

void EvaluationProgress::restore(std::span<const std::byte> state) {
  ByteReader from(state);
  while (from.left() > 0) restore_one(from);
}

void EvaluationProgress::restore_one(ByteReader& from) {
  const auto expect = [&](std::uint64_t number) {
    if (from.number() != number) throw BytesError("is the state of another kind, size or part of a study");
  };
  std::ranges::for_each(sizes(), expect);
  expect(next_);
  const std::size_t first = next_;
  const auto end = static_cast<std::size_t>(from.number_up_to(blocks_.end));
  if (end < first) throw BytesError("has blocks that end before they begin");
  next_ = end;
  read_outcomes(outcomes(first), outcomes(end), from);
}

void EvaluationProgress::write_outcomes(std::size_t first, std::size_t end, ByteWriter& to) const {
  for (std::size_t r = 0; r < result_->responses(); ++r) {
    to.reals(result_->response.row(r).subspan(first, end - first));
  }
  const std::size_t components = result_->detail.length<axis::Component>();
  to.reals(result_->detail.all().subspan(first * components, (end - first) * components));
  for (std::size_t n = first; n < end; ++n) {
    to.number(static_cast<std::uint64_t>(result_->status.all()[n]));
    to.number(result_->iterations.all()[n]);
  }
}

void EvaluationProgress::read_outcomes(std::size_t first, std::size_t end, ByteReader& from) {
  for (std::size_t r = 0; r < result_->responses(); ++r) {
    from.reals(result_->response.row(r).subspan(first, end - first));
  }
  const std::size_t components = result_->detail.length<axis::Component>();
  from.reals(result_->detail.all().subspan(first * components, (end - first) * components));
  for (std::size_t n = first; n < end; ++n) {
    result_->status.all()[n] = static_cast<SolveStatus>(from.number_up_to(kStatusNames.size() - 1));
    result_->iterations.all()[n] =
        static_cast<std::uint32_t>(from.number_up_to(std::numeric_limits<std::uint32_t>::max()));
  }
}

void EvaluationProgress::write_block(std::size_t block, ByteWriter& to) const {
  write_outcomes(outcomes(block), outcomes(block + 1), to);
}

SolveCounts EvaluationProgress::read_block(std::size_t block, ByteReader& from) {
  read_outcomes(outcomes(block), outcomes(block + 1), from);
  return solves_of(*result_, outcomes(block), outcomes(block + 1));
}

}  // namespace poesy
