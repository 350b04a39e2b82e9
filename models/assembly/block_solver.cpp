#include "models/assembly/block_solver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/contract.h"
#include "models/assembly/details.h"

namespace poesy::assembly {

using Eigen::Index;

namespace {

constexpr std::size_t kTerms = KernelStart::kTerms;

/// If one of the last three coefficients of a series (KernelStart) is larger than this (in rad, or in units of the
/// reach), the states do not vary smoothly with the error, and the series is not used.
constexpr double kTrustedTail = 1e-6;

double chebyshev(std::size_t n, std::size_t node) {
  return std::cos(std::numbers::pi / static_cast<double>(kTerms) * static_cast<double>(n) *
                  (static_cast<double>(node) + 0.5));
}

/// The coefficients of the Chebyshev series through the states at the nodes; empty if the states do not vary smoothly.
/// states: for each number of a state (KernelStart), a row with its values at the kTerms nodes. The result has a row of
/// kTerms coefficients for each number of a state.
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

BlockSolver::BlockSolver(const AssemblyModel& model, const SolverOptions& options)
    : model_(&model),
      kernels_(simd::for_selected_isa([]<simd::Isa isa>() { return kernels<isa>(); })),
      solver_(model.assembly, model.ranks, options),
      continuation_(model, options),
      frames_(model) {}

/// Writes the additional outputs (mismatch of pairs of limbs) of one sample.
void put_details(std::span<const double> values, std::size_t sample, const OutcomeBlock& outcomes) {
  const std::size_t count = outcomes.status.size();
  for (std::size_t d = 0; d < values.size(); ++d) outcomes.details[d * count + sample] = values[d];
}

/// Calls a kernel for these samples. The kernel computes responses, iterations and how each sample ended, and the
/// mismatch of limbs if the caller wants additional outputs.
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
  if (!outcomes.details.empty()) mismatch_.resize(6 * solved.limbs.size() * stride);
  work(solved, {samples.count, stride, problem.values(), responses, ends_.data(), iterations_.data(), nullptr,
                outcomes.details.empty() ? nullptr : mismatch_.data()});
  if (is_whole) return;
  for (std::size_t row = 0; row < rows; ++row) {
    std::copy_n(responses + row * stride, samples.count, outcomes.responses.data() + row * samples.count);
  }
}

/// Solves samples at the Chebyshev nodes of the varied error's range, and computes the series of starting points from
/// them. All other samples then start near their solutions.
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
  const bool are_solved = std::ranges::all_of(ends_, [](KernelEnd end) { return end != KernelEnd::left; });
  problem.set_starts(samples, are_solved ? series_of(states_) : std::vector<double>());
}

void BlockSolver::solve(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  solver_.prepare(problem.pose());
  // With stiffness, starting points are not predicted, because another start changes the last bits of a result.
  const bool is_predicted =
      model_->assembly.metric == Metric::platform && samples.varied.size() == 1 && samples.range > 0.0;
  if (is_predicted) predict_starts(problem, samples);
  run(kernels_.solve, problem, samples, outcomes);
  find_details(problem, chain::Fidelity::exact, outcomes);
  nearing_.resize(samples.count);
  problem.closure().find_nearing(samples, nearing_);
  std::vector<double> errors(samples.errors.begin(), samples.errors.end());
  for (std::size_t b = 0; b < samples.count; ++b) {
    outcomes.status[b] = SolveStatus::converged;
    outcomes.iterations[b] = iterations_[b];
    if (is_sure(b)) continue;
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      errors[samples.varied[v].value] = samples.values[v * samples.count + b];
    }
    solve_one(problem, errors, b, outcomes);
  }
}

/// Returns true if the kernel solved a sample and no other solver has to check it.
bool BlockSolver::is_sure(std::size_t sample) const {
  if (ends_[sample] == KernelEnd::left || Closure::may_open(nearing_[sample])) return false;
  return ends_[sample] == KernelEnd::converged || model_->over_constrained;
}

/// Solves a sample for which is_sure() is false, or finds that it is not_assembled.
void BlockSolver::solve_one(PoseProblem& problem, std::span<const double> errors, std::size_t sample,
                            const OutcomeBlock& outcomes) {
  if (!model_->over_constrained && problem.closure().is_regular()) {
    const Solution found = continuation_.solve(problem.pose(), errors);
    return put(problem, found, sample, outcomes);
  }
  const std::vector<std::vector<Transform>>& frames = frames_.with(errors, problem.pose().displacements);
  // Solver takes hundreds of steps if the loops cannot close, so Closure decides first.
  if (problem.closure().opens(nearing_[sample], frames)) {
    outcomes.status[sample] = SolveStatus::not_assembled;
  } else if (ends_[sample] == KernelEnd::left) {
    Solution found = solver_.solve(frames);
    found.status = problem.closure().judged(found, frames);
    put(problem, found, sample, outcomes);
  }
}

/// Writes a solution as the outcome of a sample.
void BlockSolver::put(const PoseProblem& problem, const Solution& found, std::size_t sample,
                      const OutcomeBlock& outcomes) const {
  const Nominal& pose = problem.pose();
  outcomes.status[sample] = found.status;
  outcomes.iterations[sample] = found.iterations;
  const std::vector<double> values = response_values(model_->assembly, model_->report, model_->deforms, pose,
                                                     outcome_of(model_->assembly, pose, found));
  const std::size_t count = outcomes.status.size();
  for (std::size_t r = 0; r < values.size(); ++r) outcomes.responses[r * count + sample] = values[r];
  if (!outcomes.details.empty()) {
    put_details(pair_mismatch(*model_, found.mismatch, chain::Fidelity::exact), sample, outcomes);
  }
}

/// Computes the additional outputs (mismatch of pairs of limbs) from the mismatch of each limb that a kernel wrote.
void BlockSolver::find_details(const PoseProblem& problem, chain::Fidelity fidelity, const OutcomeBlock& outcomes) {
  if (outcomes.details.empty()) return;
  const std::size_t stride = padded(outcomes.status.size());
  std::vector<Screw> mismatch(model_->assembly.limbs.size());
  for (std::size_t b = 0; b < outcomes.status.size(); ++b) {
    for (std::size_t e = 0; e < mismatch.size(); ++e) {
      Screw in_units;
      for (std::size_t k = 0; k < 6; ++k) in_units[static_cast<Index>(k)] = mismatch_[(6 * e + k) * stride + b];
      mismatch[e] = problem.twists_from_units() * in_units;
    }
    put_details(pair_mismatch(*model_, mismatch, fidelity), b, outcomes);
  }
}

void BlockSolver::map(PoseProblem& problem, const SampleBlock& samples, const OutcomeBlock& outcomes) {
  run(kernels_.map, problem, samples, outcomes);
  find_details(problem, chain::Fidelity::first_order, outcomes);
  if (problem.is_regular()) {
    const auto status = [](KernelEnd end) {
      return end == KernelEnd::converged ? SolveStatus::converged : SolveStatus::non_finite;
    };
    std::ranges::transform(std::span(ends_).first(samples.count), outcomes.status.begin(), status);
  } else {
    std::ranges::fill(outcomes.status, SolveStatus::singular);
  }
  std::ranges::fill(outcomes.iterations, 1u);
}

}  // namespace poesy::assembly
