#include "models/assembly/block_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/contract.h"
#include "models/chain/assembly.h"

namespace poesy::assembly {

using Eigen::Index;

namespace {

constexpr std::size_t kTerms = KernelStart::kTerms;

/// If one of the last coefficients of series is larger, states are not smooth
/// over the range. In units of the reach and rad.
constexpr double kTrustedTail = 1e-6;

double chebyshev(std::size_t n, std::size_t node) {
  return std::cos(std::numbers::pi / static_cast<double>(kTerms) * static_cast<double>(n) *
                  (static_cast<double>(node) + 0.5));
}

/// Series through states at the nodes, [rows x kTerms] both; empty if they are
/// not smooth.
std::vector<double> series_of(std::span<const double> states) {
  std::array<double, kTerms * kTerms> weights;
  for (std::size_t n = 0; n < kTerms; ++n) {
    for (std::size_t k = 0; k < kTerms; ++k) {
      weights[kTerms * n + k] = (n == 0 ? 1.0 : 2.0) / static_cast<double>(kTerms) * chebyshev(n, k);
    }
  }
  std::vector<double> coefficients;
  for (std::size_t row = 0; row < states.size(); row += kTerms) {
    for (std::size_t n = 0; n < kTerms; ++n) {
      double sum = 0.0;
      for (std::size_t k = 0; k < kTerms; ++k) sum += weights[kTerms * n + k] * states[row + k];
      if (n + 3 >= kTerms && !(std::abs(sum) < kTrustedTail)) return {};
      coefficients.push_back(sum);
    }
  }
  return coefficients;
}

}  // namespace

ErrorFrames::ErrorFrames(const AssemblyModel& model) : model_(&model) {
  for (const Limb& limb : model.assembly.limbs) {
    frames_.push_back(limb.chain.home);
    errors_.emplace_back(limb.chain.frames(), chain::FrameError<double>::Zero());
  }
}

const std::vector<std::vector<Transform>>& ErrorFrames::with(std::span<const double> errors,
                                                             std::span<const double> displacements) {
  for (auto& limb : errors_) std::ranges::fill(limb, chain::FrameError<double>::Zero());
  for (std::size_t f = 0; f < errors.size(); ++f) {
    for (const chain::ErrorTerm& term : model_->terms[f]) {
      errors_[term.limb][term.frame][static_cast<Index>(term.component)] += term.at(displacements) * errors[f];
    }
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
  work(solved, {samples.count, stride, problem.values(), responses, ends_.data(), iterations_.data()});
  if (is_whole) return;
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy_n(responses + row * stride, samples.count, outcomes.responses.data() + row * samples.count);
  }
}

/// Solves samples at the nodes of series over the range of the varied error, so
/// that others start nearly solved.
void BlockSolver::predict_starts(PoseProblem& problem, const SampleBlock& samples) {
  if (problem.has_starts(samples)) return;
  std::array<double, kTerms> nodes;
  for (std::size_t k = 0; k < kTerms; ++k) nodes[k] = samples.range * chebyshev(1, k);
  const KernelProblem& solved = problem.with({samples.pose, samples.errors, samples.varied, nodes, kTerms}, values_);
  responses_.resize(solved.report.rows(solved.bodies.size(), solved.limbs.size()) * kTerms);
  ends_.resize(kTerms);
  iterations_.resize(kTerms);
  states_.resize(solved.rows_of_state() * kTerms);
  kernels_.solve(
      solved, {kTerms, kTerms, problem.values(), responses_.data(), ends_.data(), iterations_.data(), states_.data()});
  const bool are_solved = std::ranges::all_of(ends_, [](KernelEnd end) { return end == KernelEnd::converged; });
  problem.set_starts(samples, are_solved ? series_of(states_) : std::vector<double>());
}

void BlockSolver::solve(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  solver_.prepare(problem.pose());
  // By stiffness results keep their bits, which depend on where solves start.
  const bool is_predicted =
      model_->assembly.metric == Metric::platform && samples.varied.size() == 1 && samples.range > 0.0;
  if (is_predicted) predict_starts(problem, samples);
  run(kernels_.solve, problem, samples, outcomes);
  nearing_.assign(samples.count, 0.0);
  const bool may_hold_open = model_->over_constrained || model_->assembly.metric == Metric::stiffness;
  if (may_hold_open) problem.closure().find_nearing(samples, nearing_);
  std::vector<double> errors(samples.errors.begin(), samples.errors.end());
  for (std::size_t b = 0; b < samples.count; ++b) {
    outcomes.status[b] = SolveStatus::converged;
    outcomes.iterations[b] = iterations_[b];
    const bool is_near = nearing_[b] < chain::kNearing;
    if (ends_[b] == KernelEnd::converged && !is_near) continue;
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      errors[samples.varied[v].value] = samples.values[v * samples.count + b];
    }
    const std::vector<std::vector<Transform>>& frames = frames_.with(errors, problem.pose().displacements);
    if (ends_[b] != KernelEnd::converged) solve_one(problem, frames, b, outcomes);
    const bool is_asked = is_near || !solved(outcomes.status[b]);
    if (is_asked && problem.closure().is_impossible(frames)) outcomes.status[b] = SolveStatus::not_assembled;
  }
}

/// A sample that the kernel left. Where no stiffness is known and limbs do not deform each other, a machine in which
/// loops stay open comes to rest with a mismatch.
void BlockSolver::solve_one(PoseProblem& problem, std::span<const std::vector<Transform>> frames, std::size_t sample,
                            const OutcomeBlock& outcomes) {
  const Nominal& pose = problem.pose();
  const Solution found = solver_.solve(frames);
  const std::vector<double> values = response_values(model_->assembly, model_->report, model_->deforms, pose,
                                                     outcome_of(model_->assembly, pose, found));
  const std::size_t count = outcomes.status.size();
  for (std::size_t r = 0; r < values.size(); ++r) outcomes.responses[r * count + sample] = values[r];
  outcomes.status[sample] = found.status;
  outcomes.iterations[sample] = found.iterations;
  const bool may_be_open = !model_->over_constrained && model_->assembly.metric == Metric::platform;
  if (may_be_open && solved(found.status) && problem.closure().is_open(found.mismatch)) {
    outcomes.status[sample] = SolveStatus::not_assembled;
  }
}

void BlockSolver::map(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  run(kernels_.map, problem, samples, outcomes);
  std::ranges::fill(outcomes.status, problem.is_regular() ? SolveStatus::converged : SolveStatus::singular);
  std::ranges::fill(outcomes.iterations, 1u);
}

}  // namespace poesy::assembly
