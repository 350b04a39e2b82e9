#include "models/assembly/solver.h"

#include <cmath>
#include <utility>

namespace poesy::assembly {
namespace {

/// A step up to this share of the reach counts as rounding if it is not shorter than half of the step before.
constexpr double kRounding = 1e-11;
constexpr double kDamped = 0.25;
constexpr double kLong = 0.5;   ///< a first step above this share of the reach is long
constexpr double kSlow = 0.25;  ///< a step above this share of the step before is not much shorter

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

/// Updates limbs and mismatch for the present places of bodies and displacements of joints.
void Solver::place(std::span<const std::vector<Transform>> frames, Solution& at) const {
  at.limbs = limb_states(*assembly_, at.bodies, frames, at.displacements);
  for (std::size_t e = 0; e < frames.size(); ++e) {
    at.mismatch[e] = lie::log(at.limbs[e].end * at.bodies[assembly_->limbs[e].to].inverse());
  }
}

Solution Solver::attempt(std::span<const std::vector<Transform>> frames, const SolverStart& start,
                         const Manner& manner) const {
  const std::size_t limbs = frames.size();
  const double damping = manner.damping;
  Solution at{.bodies = {start.bodies.begin(), start.bodies.end()},
              .displacements = {start.displacements.begin(), start.displacements.end()},
              .limbs = std::vector<LimbState>(limbs),
              .mismatch = std::vector<Screw>(limbs),
              .wrenches = std::vector<Screw>(limbs, Screw::Zero()),
              .status = SolveStatus::iteration_cap,
              .steps = {}};
  Equilibrium equations(*assembly_, *pose_);
  const Eigen::VectorXd load = (manner.is_loaded ? 1.0 : 0.0) * stacked(pose_->load);
  place(frames, at);
  const auto most = static_cast<std::uint32_t>(static_cast<double>(options_.max_iterations) / damping);
  double before = std::numeric_limits<double>::infinity();
  while (at.iterations < most) {
    ++at.iterations;
    equations.set(at.limbs, ranks_);
    const Balance step = equations.solve(stacked(at.mismatch), load);
    double moved = 0.0;
    const auto note = [&moved](double length) {  // once `moved` is NaN, it stays NaN
      if (!std::isnan(moved) && !(length <= moved)) moved = length;
    };
    for (std::size_t b = kPlatform; b < at.bodies.size(); ++b) {
      const Screw twist = damping * part(step.twists, b);
      note(equations.size(twist));
      at.bodies[b] = lie::exp(twist) * at.bodies[b];
    }
    std::size_t joint = 0;
    for (std::size_t e = 0; e < limbs; ++e) {
      const Limb& limb = assembly_->limbs[e];
      at.wrenches[e] = part(step.wrenches, e);
      const Screw given = part(step.twists, limb.to) - part(step.twists, limb.from) - at.mismatch[e] +
                          pose_->compliance[e] * at.wrenches[e];
      note(damping * equations.size(given));  // joints count too: an error may rotate a rod and move no body
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
    if (manner.must_shrink && moved > kRounding && !(moved <= (at.iterations == 1 ? kLong : kSlow * before))) return at;
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
  return solve(frames, {pose_->bodies, pose_->displacements});
}

Solution Solver::solve(std::span<const std::vector<Transform>> frames, const SolverStart& start) const {
  Solution found = attempt(frames, start, {});
  if (solved(found.status)) return found;
  Solution again = attempt(frames, start, {.damping = kDamped});
  return solved(again.status) ? again : found;
}

Solution Solver::approach(std::span<const std::vector<Transform>> frames, const SolverStart& start) const {
  return attempt(frames, start, {.is_loaded = false, .must_shrink = true});
}

}  // namespace poesy::assembly
