#pragma once

#include <numeric>
#include <span>

#include "models/three_prs/closure.h"
#include "tests/models/three_prs/reference.h"

namespace poesy::three_prs {

/// Samples with the same pose and the same constant errors.
struct ClosureSamples {
  Geometry geometry;
  Configuration nominal;
  std::vector<double> errors;  ///< [60] constant errors (m, rad)
  std::vector<FactorIndex> varied;
  std::size_t count = 0;
  std::vector<double> values;  ///< [varied x count]

  SampleBlock block() const { return {{}, errors, varied, values, count}; }
};

struct ClosureOutcome {
  Eigen::Matrix<double, kResponseRows, Eigen::Dynamic, Eigen::RowMajor> responses;  ///< [12 x count]
  std::vector<SolveStatus> status;
  std::vector<std::uint32_t> iterations;

  explicit ClosureOutcome(std::size_t count)
      : responses(kResponseRows, static_cast<Eigen::Index>(count)), status(count), iterations(count) {}
  OutcomeBlock block() {
    return {{responses.data(), static_cast<std::size_t>(responses.size())}, status, iterations, {}};
  }
  auto motion(std::size_t sample) const { return responses.col(static_cast<Eigen::Index>(sample)).head<kVectorRows>(); }
};

inline Configuration configuration_at(const Geometry& geometry, const std::vector<double>& pose) {
  return configuration(geometry, {pose[0], pose[1], pose[2]});
}

/// Samples in which these errors vary normally. size: standard deviation (m, rad).
inline ClosureSamples varied_samples(const std::vector<double>& pose, std::vector<FactorIndex> factors, double size,
                                     std::size_t count, std::mt19937_64& engine) {
  ClosureSamples samples;
  samples.nominal = configuration_at(samples.geometry, pose);
  samples.errors.assign(kFactors, 0.0);
  samples.varied = std::move(factors);
  samples.count = count;
  std::normal_distribution<double> normal(0.0, size);
  for (std::size_t n = 0; n < samples.varied.size() * count; ++n) samples.values.push_back(normal(engine));
  return samples;
}

inline ClosureSamples all_varied(const std::vector<double>& pose, double size, std::size_t count,
                                 std::mt19937_64& engine) {
  std::vector<FactorIndex> factors;
  for (std::size_t f = 0; f < kFactors; ++f) factors.emplace_back(f);
  return varied_samples(pose, factors, size, count, engine);
}

/// Samples in which one error varies and the others are constant. size: standard deviation of all errors (m, rad).
inline ClosureSamples one_varied(const std::vector<double>& pose, std::size_t factor, double size, std::size_t count,
                                 std::mt19937_64& engine) {
  ClosureSamples samples = varied_samples(pose, {FactorIndex(factor)}, size, count, engine);
  std::normal_distribution<double> normal(0.0, size);
  for (double& error : samples.errors) error = normal(engine);
  return samples;
}

/// The samples at these positions, in this order.
inline ClosureSamples picked(const ClosureSamples& samples, std::span<const std::size_t> positions) {
  ClosureSamples some = samples;
  some.count = positions.size();
  some.values.clear();
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    for (const std::size_t b : positions) some.values.push_back(samples.values[v * samples.count + b]);
  }
  return some;
}

inline ClosureOutcome solve(ClosureSolver& solver, const ClosureSamples& samples) {
  ClosureOutcome outcome(samples.count);
  solver.solve(samples.nominal, samples.block(), outcome.block());
  return outcome;
}

inline ClosureOutcome solve(const ClosureSamples& samples, const SolverOptions& options) {
  ClosureSolver solver(samples.geometry, options);
  return solve(solver, samples);
}

/// Solves the samples one by one with close_limbs().
inline ClosureOutcome solve_by_reference(const ClosureSamples& samples, const SolverOptions& options) {
  ClosureOutcome outcome(samples.count);
  const ClosureStart start(samples.geometry, samples.nominal);
  const lie::Vector3<double> tip = tool(samples.geometry, samples.nominal.platform.R);
  for (std::size_t b = 0; b < samples.count; ++b) {
    const auto limbs = limbs_of_sample(samples.geometry, samples.nominal, samples.block(), b);
    PlatformMotion motion = start(limbs);
    const Closing closing = close_limbs(limbs, samples.nominal.platform.p, start.orientation(), options, motion);
    outcome.status[b] = closing.status;
    outcome.iterations[b] = closing.iterations;
    outcome.responses.col(static_cast<Eigen::Index>(b)).head<kVectorRows>() << lie::log(motion.E), motion.dr,
        motion.dr + (motion.E * tip - tip);
  }
  return outcome;
}

}  // namespace poesy::three_prs
