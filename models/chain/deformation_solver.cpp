#include "models/chain/deformation_solver.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"

namespace poesy::chain {
namespace {

constexpr int kFlatIterations = 3;

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

}  // namespace

double rounding_level(const ParallelChain& chain) {
  return 64.0 * std::numeric_limits<double>::epsilon() * std::max(1.0, chain.reach());
}

DeformationSolver::DeformationSolver(const ParallelChain& chain, const SolverOptions& options)
    : chain_(&chain),
      options_(options),
      rounding_level_(rounding_level(chain)),
      passive_(passive_positions(chain)),
      loops_(chain),
      previous_(6 * chain.pairs.size()),
      equations_(chain),
      assembly_(chain) {}

Deformation DeformationSolver::solve(std::span<const lie::Transform<double>> frames, std::span<double> displacements,
                                     std::span<double> delta_mu, const DeformationObserver& observe,
                                     const Metric* held) {
  POESY_EXPECTS(frames.size() == chain_->frames());
  POESY_EXPECTS(displacements.size() == chain_->joints());
  POESY_EXPECTS(delta_mu.size() == previous_.size());
  const std::vector<double> nominal(displacements.begin(), displacements.end());
  Deformation end = iterate(frames, displacements, delta_mu, observe);
  if (end.status == SolveStatus::non_finite) return end;
  assembly_.prepare(nominal, held);
  if (assembly_.is_impossible(frames)) end.status = SolveStatus::not_assembled;
  return end;
}

Deformation DeformationSolver::iterate(std::span<const lie::Transform<double>> frames, std::span<double> displacements,
                                       std::span<double> delta_mu, const DeformationObserver& observe) {
  loops_.evaluate(frames, displacements, delta_mu);
  equations_.hold_idle(loops_.columns(), nullptr);
  double smallest = std::numeric_limits<double>::infinity();
  int flat = 0;
  for (int iteration = 1; iteration <= options_.max_iterations; ++iteration) {
    const auto done = static_cast<std::uint32_t>(iteration);
    if (!all_finite(delta_mu)) return {SolveStatus::non_finite, done - 1};
    if (!equations_.solve(loops_.columns(), delta_mu, nullptr)) return {SolveStatus::singular, done - 1};
    for (std::size_t k = 0; k < passive_.size(); ++k) displacements[passive_[k]] += equations_.solution()[k];
    std::copy(delta_mu.begin(), delta_mu.end(), previous_.begin());
    loops_.evaluate(frames, displacements, delta_mu);
    const double change = largest_change(delta_mu);
    if (observe) observe({equations_.solution(), delta_mu, change});
    if (change < options_.tolerance) return {SolveStatus::converged, done};
    flat = change < smallest ? 0 : flat + 1;
    smallest = std::min(smallest, change);
    if (change <= rounding_level_ && flat >= kFlatIterations) return {SolveStatus::stagnated, done};
  }
  const auto cap = static_cast<std::uint32_t>(options_.max_iterations);
  return {all_finite(delta_mu) ? SolveStatus::iteration_cap : SolveStatus::non_finite, cap};
}

double DeformationSolver::largest_change(std::span<const double> delta_mu) const {
  double largest = 0.0;
  for (std::size_t k = 0; k < delta_mu.size(); ++k) {
    const double change = std::abs(delta_mu[k] - previous_[k]);
    // NaN compares false with everything, so this negated condition is true for NaN and keeps it.
    if (!(change <= largest)) largest = change;
  }
  return largest;
}

}  // namespace poesy::chain
