#include "models/assembly/block_solver.h"

#include <algorithm>

#include "engine/base/contract.h"

namespace poesy::assembly {

using Eigen::Index;

ErrorFrames::ErrorFrames(const AssemblyModel& model) : model_(&model) {
  for (const Limb& limb : model.assembly.limbs) {
    frames_.push_back(limb.chain.home);
    errors_.emplace_back(limb.chain.frames(), chain::FrameError<double>::Zero());
  }
}

const std::vector<std::vector<Transform>>& ErrorFrames::with(std::span<const double> errors) {
  for (auto& limb : errors_) std::ranges::fill(limb, chain::FrameError<double>::Zero());
  for (std::size_t f = 0; f < errors.size(); ++f) {
    const chain::ErrorSlot& slot = model_->slots[f];
    errors_[slot.limb][slot.frame][static_cast<Index>(slot.component)] += slot.scale * errors[f];
  }
  for (std::size_t e = 0; e < frames_.size(); ++e) {
    const chain::Limb& limb = model_->assembly.limbs[e].chain;
    for (std::size_t j = 0; j < limb.frames(); ++j) {
      frames_[e][j] = errors_[e][j].isZero(0.0) ? limb.home[j] : chain::frame_with_error(limb, j, errors_[e][j]);
    }
  }
  return frames_;
}

BlockSolver::BlockSolver(const AssemblyModel& model, const SolverOptions& options)
    : model_(&model),
      kernels_(simd::for_selected_isa([]<simd::Isa isa>() { return kernels<isa>(); })),
      solver_(model.assembly, model.ranks, options),
      closure_(model.assembly),
      frames_(model) {}

/// Responses, ends and iterations by a kernel.
void BlockSolver::run(KernelWork work, PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  const KernelProblem& solved = problem.with(samples, values_);
  const std::size_t stride = padded(samples.count);
  const std::size_t rows = solved.report.rows(solved.bodies.size(), solved.limbs.size());
  POESY_EXPECTS(outcomes.responses.size() == rows * samples.count);
  const bool is_whole = stride == samples.count;
  if (!is_whole) responses_.resize(rows * stride);
  ends_.resize(stride);
  iterations_.resize(stride);
  double* responses = is_whole ? outcomes.responses.data() : responses_.data();
  work(solved, {samples.count, stride, values_.data(), responses, ends_.data(), iterations_.data()});
  if (is_whole) return;
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy_n(responses + row * stride, samples.count, outcomes.responses.data() + row * samples.count);
  }
}

/// Of a sample that the kernel left. Where no stiffness is known, a machine in which loops stay open has come to rest
/// with a mismatch.
Solution BlockSolver::solve_one(const Nominal& pose, std::span<const double> errors) {
  const std::vector<std::vector<Transform>>& frames = frames_.with(errors);
  Solution found = solver_.solve(frames);
  if (model_->over_constrained) return found;
  if (!solved(found.status)) {
    if (closure_.is_impossible(pose, frames)) found.status = SolveStatus::not_assembled;
  } else if (model_->assembly.metric == Metric::platform && closure_.is_open(pose, found.mismatch)) {
    found.status = SolveStatus::not_assembled;
  }
  return found;
}

void BlockSolver::solve(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  const Nominal& pose = problem.pose();
  solver_.prepare(pose);
  run(kernels_.solve, problem, samples, outcomes);
  std::vector<double> errors(samples.errors.begin(), samples.errors.end());
  for (std::size_t b = 0; b < samples.count; ++b) {
    outcomes.status[b] = SolveStatus::converged;
    outcomes.iterations[b] = iterations_[b];
    if (ends_[b] == KernelEnd::converged) continue;
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      errors[samples.varied[v].value] = samples.values[v * samples.count + b];
    }
    const Solution found = solve_one(pose, errors);
    const std::vector<double> values = response_values(model_->assembly, model_->report, model_->deforms, pose,
                                                       outcome_of(model_->assembly, pose, found));
    for (std::size_t r = 0; r < values.size(); ++r) outcomes.responses[r * samples.count + b] = values[r];
    outcomes.status[b] = found.status;
    outcomes.iterations[b] = found.iterations;
  }
}

void BlockSolver::map(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  run(kernels_.map, problem, samples, outcomes);
  std::ranges::fill(outcomes.status, problem.is_regular() ? SolveStatus::converged : SolveStatus::singular);
  std::ranges::fill(outcomes.iterations, 1u);
}

}  // namespace poesy::assembly
