#pragma once

#include <numeric>
#include <random>
#include <span>
#include <vector>

#include "models/chain/block_solver.h"
#include "models/chain/deformation_solver.h"
#include "models/two_upr_rpu/errors.h"
#include "models/two_upr_rpu/kinematics.h"
#include "tests/models/chain/closed_chain.h"

namespace poesy::chain {

/// Samples for a BlockSolver. They have the same pose and the same constant errors.
struct BlockSamples {
  ParallelChain chain;
  std::vector<double> displacements;       ///< [all joints] nominal (rad, m)
  std::vector<FrameError<double>> errors;  ///< [frames] constant errors (rad, m)
  std::vector<FrameEntry> varied;
  double range = 0.0;
  std::size_t count = 0;
  std::vector<double> values;  ///< [varied x count]

  double value(std::size_t v, std::size_t b) const { return values[v * count + b]; }
};

/// The outcome of each sample.
struct BlockOutcome {
  Eigen::MatrixXd delta_mu;   ///< [6 pairs x count]
  Eigen::MatrixXd responses;  ///< [3 x count]
  std::vector<SolveStatus> status;
  std::vector<std::uint32_t> iterations;
};

inline constexpr double kDegree = 3.14159265358979323846 / 180.0;
inline constexpr double kMillimetre = 1e-3;

inline std::vector<FrameEntry> factor_entries() {
  std::vector<FrameEntry> entries;
  for (const ErrorTerms& terms : two_upr_rpu::error_terms()) {
    entries.push_back({5 * terms.front().limb + terms.front().frame, terms.front().component});
  }
  return entries;
}

/// The unit of an entry of a frame error: 1 mm or 1 deg, in SI.
inline double unit_of(const FrameEntry& entry) { return entry.component < 3 ? kDegree : kMillimetre; }

inline void fill_normal(BlockSamples& samples, double size, std::size_t count, std::mt19937_64& engine) {
  std::normal_distribution<double> normal(0.0, size);
  samples.count = count;
  samples.values.clear();
  for (const FrameEntry& entry : samples.varied) {
    for (std::size_t b = 0; b < count; ++b) samples.values.push_back(unit_of(entry) * normal(engine));
  }
}

inline two_upr_rpu::Pose random_pose(std::mt19937_64& engine) {
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return {-0.24 + 0.06 * uniform(engine), 0.5 * uniform(engine), 0.6 * uniform(engine)};
}

/// Samples of the 2UPR-RPU in which these of its 71 errors vary. size: standard deviation of the normal errors (mm or
/// deg).
inline BlockSamples robot_samples(const two_upr_rpu::Pose& pose, std::span<const std::size_t> factors, double size,
                                  std::size_t count, std::mt19937_64& engine) {
  BlockSamples samples;
  samples.chain = two_upr_rpu::parallel_chain({});
  const auto q = two_upr_rpu::joint_displacements({}, pose);
  samples.displacements.assign(q.begin(), q.end());
  samples.errors.assign(samples.chain.frames(), FrameError<double>::Zero());
  const std::vector<FrameEntry> entries = factor_entries();
  for (const std::size_t factor : factors) samples.varied.push_back(entries[factor]);
  fill_normal(samples, size, count, engine);
  return samples;
}

/// Samples of the 2UPR-RPU in which one error varies with sigma = 1 mm or 1 deg. background: sigma of the other errors,
/// which are constant (mm or deg).
inline BlockSamples single_error_samples(const two_upr_rpu::Pose& pose, std::size_t factor, double background,
                                         std::size_t count, std::mt19937_64& engine) {
  BlockSamples samples = robot_samples(pose, std::vector<std::size_t>{factor}, 1.0, count, engine);
  std::normal_distribution<double> normal(0.0, background);
  for (const FrameEntry& entry : factor_entries()) {
    samples.errors[entry.frame][static_cast<Eigen::Index>(entry.component)] = unit_of(entry) * normal(engine);
  }
  return samples;
}

inline BlockSamples all_error_samples(const two_upr_rpu::Pose& pose, double size, std::size_t count,
                                      std::mt19937_64& engine) {
  std::vector<std::size_t> factors(factor_entries().size());
  std::iota(factors.begin(), factors.end(), 0);
  return robot_samples(pose, factors, size, count, engine);
}

/// Samples of a random chain in which all six errors of every frame vary. size: standard deviation (mm or deg).
inline BlockSamples random_chain_samples(std::span<const std::size_t> joints, PassiveJoints kind, double size,
                                         std::size_t count, std::mt19937_64& engine) {
  BlockSamples samples;
  const std::size_t all = std::accumulate(joints.begin(), joints.end(), std::size_t{0});
  samples.displacements = random_displacements(all, 0.4, engine);
  samples.chain = closed_chain(joints, kind, samples.displacements, engine);
  samples.errors.assign(samples.chain.frames(), FrameError<double>::Zero());
  for (std::size_t frame = 0; frame < samples.chain.frames(); ++frame) {
    for (std::size_t component = 0; component < 6; ++component) samples.varied.push_back({frame, component});
  }
  fill_normal(samples, size, count, engine);
  return samples;
}

/// The largest difference between both outcomes in the mismatch delta_mu of sample b (rad, m).
inline double distance(const BlockOutcome& one, const BlockOutcome& other, std::size_t b) {
  const auto column = static_cast<Eigen::Index>(b);
  return (one.delta_mu.col(column) - other.delta_mu.col(column)).cwiseAbs().maxCoeff();
}

/// The samples at these positions, in this order.
inline BlockSamples picked(const BlockSamples& samples, std::span<const std::size_t> positions) {
  BlockSamples some = samples;
  some.count = positions.size();
  some.values.clear();
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    for (const std::size_t b : positions) some.values.push_back(samples.value(v, b));
  }
  return some;
}

/// The fixed frames of the chain with the errors of sample b.
inline std::vector<lie::Transform<double>> frames_of(const BlockSamples& samples, std::size_t b) {
  std::vector<FrameError<double>> errors = samples.errors;
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    const FrameEntry& entry = samples.varied[v];
    errors[entry.frame][static_cast<Eigen::Index>(entry.component)] = samples.value(v, b);
  }
  std::vector<lie::Transform<double>> frames;
  for (const Limb& limb : samples.chain.limbs) {
    for (std::size_t j = 0; j < limb.frames(); ++j) frames.push_back(frame_with_error(limb, j, errors[frames.size()]));
  }
  return frames;
}

inline void prepare(BlockSolver& solver, const BlockSamples& samples) {
  solver.prepare(samples.displacements, samples.errors, samples.varied, samples.range);
}

/// Solves samples that the solver is prepared for.
inline BlockOutcome solve(BlockSolver& solver, const BlockSamples& samples) {
  solver.solve(samples.values, samples.count);
  const auto rows = 6 * static_cast<Eigen::Index>(samples.chain.pairs.size());
  const auto count = static_cast<Eigen::Index>(samples.count);
  BlockOutcome outcome{Eigen::MatrixXd(rows, count), Eigen::MatrixXd(3, count), {}, {}};
  for (Eigen::Index row = 0; row < rows; ++row) {
    outcome.delta_mu.row(row) =
        Eigen::Map<const Eigen::RowVectorXd>(solver.delta_mu(static_cast<std::size_t>(row)).data(), count);
  }
  for (Eigen::Index row = 0; row < 3; ++row) {
    outcome.responses.row(row) =
        Eigen::Map<const Eigen::RowVectorXd>(solver.response(static_cast<std::size_t>(row)).data(), count);
  }
  outcome.status.assign(solver.status().begin(), solver.status().end());
  outcome.iterations.assign(solver.iterations().begin(), solver.iterations().end());
  return outcome;
}

inline BlockOutcome solve(const BlockSamples& samples, const SolverOptions& options) {
  BlockSolver solver(samples.chain, options);
  prepare(solver, samples);
  return solve(solver, samples);
}

/// Solves the samples one by one with the plain Gauss-Newton solver. The outcome has no responses.
inline BlockOutcome solve_by_reference(const BlockSamples& samples, const SolverOptions& options) {
  DeformationSolver solver(samples.chain, options);
  const auto rows = 6 * static_cast<Eigen::Index>(samples.chain.pairs.size());
  BlockOutcome outcome{Eigen::MatrixXd(rows, static_cast<Eigen::Index>(samples.count)), {}, {}, {}};
  for (std::size_t b = 0; b < samples.count; ++b) {
    std::vector<double> q = samples.displacements;
    const Deformation found =
        solver.solve(frames_of(samples, b), q,
                     {outcome.delta_mu.col(static_cast<Eigen::Index>(b)).data(), static_cast<std::size_t>(rows)});
    outcome.status.push_back(found.status);
    outcome.iterations.push_back(found.iterations);
  }
  return outcome;
}

inline SolverOptions gauss_newton(int max_iterations = 50) {
  SolverOptions options;
  options.method = SolverOptions::Method::gauss_newton;
  options.max_iterations = max_iterations;
  return options;
}

}  // namespace poesy::chain
