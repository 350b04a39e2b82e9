#include "models/assembly/block_solver.h"

#include <algorithm>

#include "engine/linalg/decompositions.h"
#include "models/assembly/kernels.h"
#include "models/chain/assembly.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;

/// Rounds of the kernel; a sample that needs more has its own matrices made.
constexpr int kMostRounds = 30;

std::size_t padded(std::size_t count) { return (count + kKernelLanes - 1) / kKernelLanes * kKernelLanes; }

/// With lengths in this unit, about this point.
KernelMotion motion_of(const Transform& transform, double length, const Vector3& origin = Vector3::Zero()) {
  KernelMotion made{};
  for (Index row = 0; row < 3; ++row) {
    for (Index column = 0; column < 3; ++column) made.r[3 * row + column] = transform.R(row, column);
    made.p[row] = (transform.p[row] - origin[row]) / length;
  }
  return made;
}

void copy_rows(const Eigen::MatrixXd& matrix, std::vector<double>& to) {
  for (Index row = 0; row < matrix.rows(); ++row) {
    for (Index column = 0; column < matrix.cols(); ++column) to.push_back(matrix(row, column));
  }
}

/// A perfect limb. displacements: nominal, of its joints.
KernelLimb kernel_limb(const Limb& limb, const Equilibrium& equations, std::size_t e, double length,
                       std::span<const double> displacements) {
  KernelLimb made{};
  made.from = limb.from;
  made.to = limb.to;
  made.first_wrench = static_cast<std::size_t>(equations.first_wrenches()[e]);
  made.carried = static_cast<std::size_t>(equations.carry(e).cols());
  copy_rows(equations.carry(e), made.carry);
  copy_rows(equations.give(e), made.give);
  for (Index k = 0; k < 36; ++k) made.compliance[k] = equations.compliance(e)(k / 6, k % 6);
  int passive = 0;
  for (std::size_t j = 0; j < limb.chain.joints.size(); ++j) {
    const chain::Joint& joint = limb.chain.joints[j];
    const bool slides = joint.type == chain::JointType::prismatic;
    made.joints.push_back(
        {slides, joint.advance / length, joint.actuated ? -1 : passive++, displacements[j] / (slides ? length : 1.0)});
  }
  for (std::size_t j = 0; j < limb.chain.frames(); ++j) {
    KernelFrame frame{};
    frame.before = motion_of(limb.chain.home[j], length);
    frame.behind = motion_of(Transform(), length);
    frame.inverted = j + 1 == limb.chain.frames();
    std::ranges::fill(frame.varied, -1);
    made.frames.push_back(frame);
  }
  return made;
}

/// Says where a frame's error is, once its entries are known.
void complete(const chain::Limb& limb, std::size_t j, double length, KernelFrame& frame) {
  const auto has = [&](std::size_t n) { return frame.varied[n] >= 0 || frame.constant[n] != 0.0; };
  for (std::size_t n = 0; n < 6; ++n) frame.has_error = frame.has_error || has(n);
  for (std::size_t n = 0; n < 3; ++n) frame.turns = frame.turns || has(n);
  if (!frame.has_error) return;
  const bool splits = limb.errors_at_joints && frame.turns;
  const Transform whole = limb.home[j];
  frame.before = motion_of(splits ? limb.before_error(j) : frame.inverted ? whole : Transform(), length);
  frame.behind = motion_of(splits ? limb.behind_error(j) : frame.inverted ? Transform() : whole, length);
}

}  // namespace

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
      options_(options),
      kernel_(simd::for_selected_isa([]<simd::Isa isa>() { return kernel<isa>(); })),
      solver_(model.assembly, model.ranks, options),
      closure_(model),
      frames_(model),
      problem_{},
      solution_{} {}

/// The equations of the pose.
void BlockSolver::prepare_pose(const Nominal& pose) {
  const Assembly& assembly = model_->assembly;
  pose_ = &pose;
  solver_.prepare(pose);
  closure_.prepare(pose);
  equations_.emplace(assembly, pose);
  equations_->set(pose.limbs, model_->ranks);
  problem_ = {};
  const Vector3& origin = pose.bodies[kPlatform].p;
  for (const Transform& body : pose.bodies) problem_.bodies.push_back(motion_of(body, assembly.reach, origin));
  for (const Screw& load : pose.load) {
    const Screw in_units = equations_->wrench_in_units(load);
    problem_.load.insert(problem_.load.end(), in_units.begin(), in_units.end());
  }
  problem_.size = static_cast<std::size_t>(equations_->matrix().rows());
  copy_rows(linalg::inverse(equations_->matrix()), problem_.inverse);
  problem_.wants_wrenches = assembly.metric == Metric::stiffness;
  problem_.tolerance = options_.tolerance;
  problem_.most_rounds = std::min(kMostRounds, options_.max_iterations);
  problem_.joints = assembly.joints();
}

/// Perfect limbs at the pose.
void BlockSolver::prepare_limbs(const Nominal& pose) {
  const Assembly& assembly = model_->assembly;
  problem_.limbs.clear();
  for (std::size_t e = 0; e < assembly.limbs.size(); ++e) {
    const std::size_t first_joint = assembly.first_joint(e);
    const std::span<const double> displacements(pose.displacements);
    problem_.limbs.push_back(kernel_limb(assembly.limbs[e], *equations_, e, assembly.reach,
                                         displacements.subspan(first_joint, assembly.limbs[e].chain.joints.size())));
    problem_.limbs.back().first_joint = first_joint;
  }
}

/// The errors of frames: entries that stay, and the values of those that vary.
void BlockSolver::prepare_errors(const SampleBlock& samples) {
  const std::size_t stride = padded(samples.count);
  const auto frame_of = [&](const chain::ErrorSlot& slot) -> KernelFrame& {
    return problem_.limbs[slot.limb].frames[slot.frame];
  };
  const auto scale_of = [&](const chain::ErrorSlot& slot) {
    return slot.scale * (slot.component < 3 ? 1.0 : 1.0 / model_->assembly.reach);
  };
  std::vector<bool> varies(model_->slots.size(), false);
  for (const FactorIndex factor : samples.varied) varies[factor.value] = true;
  for (std::size_t f = 0; f < varies.size(); ++f) {
    const chain::ErrorSlot& slot = model_->slots[f];
    if (!varies[f]) frame_of(slot).constant[slot.component] += scale_of(slot) * samples.errors[f];
  }
  values_.clear();
  for (std::size_t v = 0; v < samples.varied.size(); ++v) {
    const chain::ErrorSlot& slot = model_->slots[samples.varied[v].value];
    int& row = frame_of(slot).varied[slot.component];
    if (row < 0) {
      row = static_cast<int>(values_.size() / stride);
      values_.insert(values_.end(), stride, frame_of(slot).constant[slot.component]);
    }
    double* to = values_.data() + static_cast<std::size_t>(row) * stride;
    const double* from = samples.values.data() + v * samples.count;
    for (std::size_t b = 0; b < samples.count; ++b) to[b] += scale_of(slot) * from[b];
  }
}

void BlockSolver::prepare(const Nominal& pose, const SampleBlock& samples) {
  if (pose_ != &pose) prepare_pose(pose);
  prepare_limbs(pose);
  prepare_errors(samples);
  for (std::size_t e = 0; e < problem_.limbs.size(); ++e) {
    for (std::size_t j = 0; j < problem_.limbs[e].frames.size(); ++j) {
      complete(model_->assembly.limbs[e].chain, j, model_->assembly.reach, problem_.limbs[e].frames[j]);
    }
  }
}

void BlockSolver::run(std::size_t count) {
  const std::size_t stride = padded(count);
  rows_.resize(problem_.rows() * stride);
  ends_.resize(stride);
  iterations_.resize(stride);
  kernel_(problem_, {count, stride, values_.data(), rows_.data(), ends_.data(), iterations_.data()});
}

/// The solution of a sample that the kernel solved.
const Solution& BlockSolver::read(const Nominal& pose, std::span<const double> errors, std::size_t sample) {
  const Assembly& assembly = model_->assembly;
  const std::size_t stride = ends_.size();
  const double length = assembly.reach;
  const double* from = rows_.data() + sample;
  const auto next = [&] {
    const double value = *from;
    from += stride;
    return value;
  };
  solution_.bodies.resize(pose.bodies.size());
  for (Transform& body : solution_.bodies) {
    for (Index k = 0; k < 9; ++k) body.R(k / 3, k % 3) = next();
    for (Index k = 0; k < 3; ++k) body.p[k] = pose.bodies[kPlatform].p[k] + length * next();
  }
  solution_.displacements.resize(assembly.joints());
  std::size_t joint = 0;
  for (const Limb& limb : assembly.limbs) {
    for (const chain::Joint& one : limb.chain.joints) {
      solution_.displacements[joint++] = next() * (one.type == chain::JointType::prismatic ? length : 1.0);
    }
  }
  const auto next_screw = [&] {
    Screw screw;
    for (Index k = 0; k < 6; ++k) screw[k] = next();
    return screw;
  };
  solution_.wrenches.resize(assembly.limbs.size());
  solution_.mismatch.resize(assembly.limbs.size());
  for (Screw& wrench : solution_.wrenches) wrench = equations_->wrench_from_units(next_screw());
  for (Screw& mismatch : solution_.mismatch) mismatch = equations_->twist_from_units(next_screw());
  solution_.status = SolveStatus::converged;
  solution_.iterations = iterations_[sample];
  check_closed(errors, solution_);
  solution_.limbs.clear();
  if (assembly.metric != Metric::stiffness) return solution_;
  solution_.limbs = limb_states(assembly, solution_.bodies, frames_.with(errors), solution_.displacements);
  return solution_;
}

/// Of a sample that the kernel left.
Solution BlockSolver::solve_one(std::span<const double> errors) {
  Solution found = solver_.solve(frames_.with(errors));
  check_closed(errors, found);
  return found;
}

/// Where limbs deform each other, and where a sample is not solved, Closure decides; else loops that stay open show as
/// a mismatch, unless stiffness holds it.
void BlockSolver::check_closed(std::span<const double> errors, Solution& found) {
  const bool is_doubted =
      !solved(found.status) || (model_->over_constrained && closure_.nearing(errors) < chain::kNearing);
  const bool has_no_mismatch = !model_->over_constrained && model_->assembly.metric == Metric::platform;
  if ((is_doubted && closure_.is_impossible(frames_.with(errors))) ||
      (has_no_mismatch && solved(found.status) && closure_.is_open(found.mismatch))) {
    found.status = SolveStatus::not_assembled;
  }
}

void BlockSolver::solve(const Nominal& pose, const SampleBlock& samples,
                        const std::function<void(std::size_t, const Solution&)>& found) {
  prepare(pose, samples);
  run(samples.count);
  std::vector<double> errors(samples.errors.begin(), samples.errors.end());
  for (std::size_t b = 0; b < samples.count; ++b) {
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      errors[samples.varied[v].value] = samples.values[v * samples.count + b];
    }
    if (ends_[b] == KernelEnd::converged) {
      found(b, read(pose, errors, b));
    } else {
      found(b, solve_one(errors));
    }
  }
}

}  // namespace poesy::assembly
