#include "models/chain/deformation_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/contract.h"
#include "models/chain/deformation_solver.h"
#include "models/chain/first_order.h"
#include "models/chain/nominal.h"
#include "models/chain/passive_condition.h"
#include "models/chain/platform_motion.h"

namespace poesy::chain {
namespace {

double largest(std::span<const double> values) {
  double most = 0.0;
  for (const double value : values) most = std::isnan(value) ? value : std::max(most, std::abs(value));
  return most;
}

/// All fixed frames with errors, limb by limb. displacements: nominal ones of all joints (rad, m). errors: the value of
/// each error of the model, SI.
std::vector<lie::Transform<double>> frames_with(const DeformationModel& model, std::span<const double> displacements,
                                                std::span<const double> errors) {
  std::vector<FrameError<double>> of_frames(model.chain.frames(), FrameError<double>::Zero());
  for (std::size_t f = 0; f < model.terms.size(); ++f) {
    for (const ErrorTerm& term : model.terms[f]) {
      const FrameEntry entry = model.entry(term);
      of_frames[entry.frame][static_cast<Eigen::Index>(entry.component)] += term.at(displacements) * errors[f];
    }
  }
  std::vector<lie::Transform<double>> frames;
  for (const Limb& limb : model.chain.limbs) {
    for (std::size_t j = 0; j < limb.frames(); ++j) {
      frames.push_back(frame_with_error(limb, j, of_frames[frames.size()]));
    }
  }
  return frames;
}

std::vector<JointType> passive_types(const ParallelChain& chain) {
  std::vector<JointType> types;
  for (const Limb& limb : chain.limbs) {
    for (const Joint& joint : limb.joints) {
      if (!joint.actuated) types.push_back(joint.type);
    }
  }
  return types;
}

/// The largest step of a passive joint of this type (rad or m).
double largest_step(const std::vector<JointType>& types, JointType type, std::span<const double> step) {
  double most = 0.0;
  for (std::size_t k = 0; k < step.size(); ++k) {
    if (types[k] == type) most = std::max(most, std::abs(step[k]));
  }
  return most;
}

/// The condition number of the passive joints; NaN if the displacements are not finite.
double condition(const ParallelChain& chain, std::span<const double> displacements) {
  const bool is_finite = std::ranges::all_of(displacements, [](double value) { return std::isfinite(value); });
  return is_finite ? passive_condition(chain, displacements) : std::numeric_limits<double>::quiet_NaN();
}

/// The published responses (Du et al. 2022, Eqs. 49, 50 and 45).
std::vector<double> responses_of(std::span<const double> delta_mu) {
  const std::size_t pairs = delta_mu.size() / 6;
  std::vector<double> responses(3, 0.0);
  for (std::size_t n = 0; n < pairs; ++n) {
    const Eigen::Map<const lie::Screw<double>> screw(delta_mu.data() + 6 * n);
    responses[0] += screw.head<3>().norm() / static_cast<double>(pairs);
    responses[1] += screw.tail<3>().norm() / static_cast<double>(pairs);
    responses[2] = std::max(responses[2], screw.norm());
  }
  return responses;
}

void append(const std::vector<double>& responses, SolveTrace& trace) {
  trace.responses.insert(trace.responses.end(), responses.begin(), responses.end());
}

}  // namespace

SolveTrace first_order_trace(const DeformationModel& model, std::span<const double> pose,
                             std::span<const double> errors) {
  POESY_EXPECTS(errors.size() == model.terms.size());
  const std::vector<double> displacements = model.joint_displacements(pose);
  SolveTrace trace;
  trace.solver = "the closed form of first order, in plain double precision, which iterates nothing";
  trace.iterations = 1;
  FirstOrder first_order(model.chain);
  if (!first_order.prepare(displacements, nullptr)) trace.status = SolveStatus::singular;
  std::vector<double> delta_mu(6 * model.chain.pairs.size(), 0.0);
  if (model.chain.rounded) delta_mu = nominal_mismatch(model.chain, displacements);
  std::vector<double> effect(delta_mu.size());
  std::vector<double> moved(model.chain.passive_joints());
  lie::Screw<double> xi = lie::Screw<double>::Zero();
  for (std::size_t f = 0; f < errors.size() && trace.status == SolveStatus::converged; ++f) {
    for (const ErrorTerm& term : model.terms[f]) {
      const FrameEntry entry = model.entry(term);
      const double error = term.at(displacements) * errors[f];
      first_order.effect(entry, effect, moved);
      for (std::size_t n = 0; n < effect.size(); ++n) delta_mu[n] += error * effect[n];
      xi += error / static_cast<double>(model.chain.limbs.size()) * first_order.sum_of_motions(entry, moved);
    }
  }
  trace.responses = responses_of(delta_mu);
  if (const auto points = model.platform_points(displacements)) append(platform_displacement(xi, *points, true), trace);
  return trace;
}

SolveTrace deformation_trace(const DeformationModel& model, std::span<const double> pose,
                             std::span<const double> errors, const SolverOptions& options) {
  POESY_EXPECTS(errors.size() == model.terms.size());
  std::vector<double> displacements = model.joint_displacements(pose);
  std::vector<double> delta_mu(6 * model.chain.pairs.size());
  const std::vector<JointType> types = passive_types(model.chain);
  SolveTrace trace;
  trace.solver = "Gauss-Newton as published, in plain double precision, from nominal displacements";
  trace.columns = {
      {"change", "rad, m"}, {"residual", "rad, m"}, {"step_angle", "rad"}, {"step_length", "m"}, {"condition", "1"}};
  const auto observe = [&](const DeformationIteration& iteration) {
    trace.rows.insert(
        trace.rows.end(),
        {iteration.change, largest(iteration.delta_mu), largest_step(types, JointType::revolute, iteration.step),
         largest_step(types, JointType::prismatic, iteration.step), condition(model.chain, displacements)});
  };
  DeformationSolver solver(model.chain, options);
  const std::optional<PlatformPoints> points = model.platform_points(displacements);
  const std::vector<lie::Transform<double>> frames = frames_with(model, displacements, errors);
  const std::optional<Metric> held = model.held(displacements);
  const Deformation end = solver.solve(frames, displacements, delta_mu, observe, held ? &*held : nullptr);
  trace.status = end.status;
  trace.iterations = end.iterations;
  trace.responses = responses_of(delta_mu);
  if (points) {
    const lie::Screw<double> xi = mean_motion(model.chain, frames, displacements, points->platform);
    append(platform_displacement(xi, *points, false), trace);
  }
  return trace;
}

}  // namespace poesy::chain
