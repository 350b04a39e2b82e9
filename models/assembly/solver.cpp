#include "models/assembly/solver.h"

#include <algorithm>
#include <utility>

namespace poesy::assembly {
namespace {

/// A step up to this, over the reach, is rounding where the next one is no smaller.
constexpr double kRounding = 1e-11;
constexpr double kDamped = 0.25;

Eigen::VectorXd stacked(std::span<const Screw> screws) {
  return Eigen::Map<const Eigen::VectorXd>(screws.front().data(), 6 * static_cast<Eigen::Index>(screws.size()));
}

auto part(const Eigen::MatrixXd& stack, std::size_t k) {
  return stack.block<6, 1>(6 * static_cast<Eigen::Index>(k), 0);
}

}  // namespace

Solver::Solver(const Assembly& assembly, std::vector<std::size_t> ranks, const SolverOptions& options)
    : assembly_(&assembly), ranks_(std::move(ranks)), options_(options) {}

void Solver::prepare(const Nominal& pose) { pose_ = &pose; }

/// Brings limbs and mismatch to the present bodies and displacements.
void Solver::place(std::span<const std::vector<Transform>> frames, Solution& at) const {
  at.limbs = limb_states(*assembly_, at.bodies, frames, at.displacements);
  for (std::size_t e = 0; e < frames.size(); ++e) {
    at.mismatch[e] = lie::log(at.limbs[e].end * at.bodies[assembly_->limbs[e].to].inverse());
  }
}

Solution Solver::attempt(std::span<const std::vector<Transform>> frames, double damping) const {
  const std::size_t limbs = frames.size();
  Solution at{.bodies = pose_->bodies,
              .displacements = pose_->displacements,
              .limbs = std::vector<LimbState>(limbs),
              .mismatch = std::vector<Screw>(limbs),
              .wrenches = std::vector<Screw>(limbs, Screw::Zero()),
              .status = SolveStatus::iteration_cap,
              .steps = {}};
  Equilibrium equations(*assembly_, *pose_);
  const Eigen::VectorXd load = stacked(pose_->load);
  place(frames, at);
  const auto most = static_cast<std::uint32_t>(static_cast<double>(options_.max_iterations) / damping);
  double before = std::numeric_limits<double>::infinity();
  while (at.iterations < most) {
    ++at.iterations;
    equations.set(at.limbs, ranks_);
    const Balance step = equations.solve(stacked(at.mismatch), load);
    double moved = 0.0;
    for (std::size_t b = kPlatform; b < at.bodies.size(); ++b) {
      const Screw twist = damping * part(step.twists, b);
      moved = std::max(moved, equations.size(twist));
      at.bodies[b] = lie::exp(twist) * at.bodies[b];
    }
    std::size_t joint = 0;
    for (std::size_t e = 0; e < limbs; ++e) {
      const Limb& limb = assembly_->limbs[e];
      at.wrenches[e] = part(step.wrenches, e);
      const Screw given = part(step.twists, limb.to) - part(step.twists, limb.from) - at.mismatch[e] +
                          pose_->compliance[e] * at.wrenches[e];
      moved = std::max(moved, damping * equations.size(given));  // an error across a rod turns it and moves no body
      const Eigen::VectorXd dq = damping * equations.displacements(e, given);
      Eigen::Index k = 0;
      for (const chain::Joint& one : limb.chain.joints) {
        if (!one.actuated) at.displacements[joint] += dq[k++];
        ++joint;
      }
    }
    at.steps.push_back(moved);
    if (!std::isfinite(moved)) {
      at.status = SolveStatus::non_finite;
      return at;
    }
    place(frames, at);
    if (moved <= options_.tolerance) {
      at.status = SolveStatus::converged;
      return at;
    }
    if (moved <= kRounding && moved >= 0.5 * before) {
      at.status = SolveStatus::stagnated;
      return at;
    }
    before = moved;
  }
  return at;
}

Solution Solver::solve(std::span<const std::vector<Transform>> frames) const {
  Solution found = attempt(frames, 1.0);
  if (solved(found.status)) return found;
  Solution again = attempt(frames, kDamped);
  return solved(again.status) ? again : found;
}

}  // namespace poesy::assembly
