#include "models/assembly/continuation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "models/assembly/closure.h"

namespace poesy::assembly {
namespace {

/// Tolerance of the solves of strides; the error after Newton's last step is about the square of the tolerance.
constexpr double kTolerance = 1e-9;
constexpr int kMostIterations = 12;  ///< largest number of iterations in a stride
/// Shortest stride, as a share of the errors. If a shorter stride is needed, the path ends there.
constexpr double kShortest = 1e-8;

constexpr std::uint32_t kMostOnTheWay = 1000;  ///< largest number of iterations of all strides together

/// Adds the iterations of `before` to those of `next`, and puts the steps of `before` in front of those of `next`.
void add_iterations(const Solution& before, Solution& next) {
  next.iterations += before.iterations;
  next.steps.insert(next.steps.begin(), before.steps.begin(), before.steps.end());
}

SolverOptions options_of_strides() { return {.tolerance = kTolerance, .max_iterations = kMostIterations}; }

}  // namespace

Continuation::Continuation(const AssemblyModel& model, const SolverOptions& options)
    : model_(&model),
      options_(options),
      on_the_way_(model.assembly, model.ranks, options_of_strides()),
      at_the_end_(model.assembly, model.ranks, options),
      frames_(model) {}

/// The frames of the limbs with this share of the errors.
const std::vector<std::vector<Transform>>& Continuation::frames(const Nominal& pose, std::span<const double> errors,
                                                                double share) {
  grown_.assign(errors.begin(), errors.end());
  for (double& error : grown_) error *= share;
  return frames_.with(grown_, pose.displacements);
}

/// Moves `here` along the path, as far as the path leads. Status: converged if `here` arrives at the full errors;
/// otherwise iteration_cap, non_finite or not_assembled.
SolveStatus Continuation::follow(const Nominal& pose, std::span<const double> errors, Solution& here) {
  if (!std::ranges::all_of(errors, [](double error) { return std::isfinite(error); })) return SolveStatus::non_finite;
  double share = 0.0;
  double stride = 1.0;
  bool was_halved = false;
  while (share < 1.0) {
    if (here.iterations > kMostOnTheWay) return SolveStatus::iteration_cap;
    const double next = std::min(1.0, share + stride);
    Solution there = on_the_way_.approach(frames(pose, errors, next), {here.bodies, here.displacements});
    const bool stays = solved(there.status) && !is_open(*model_, pose, there.mismatch);
    if (stays && there.iterations > static_cast<std::uint32_t>(options_.max_iterations))
      return SolveStatus::iteration_cap;
    add_iterations(here, there);
    if (stays) {
      here = std::move(there);
      share = next;
      if (!was_halved) stride *= 2.0;
    } else {
      here.iterations = there.iterations;
      here.steps = std::move(there.steps);
      stride *= 0.5;
    }
    was_halved = !stays;
    if (stride < kShortest) return SolveStatus::not_assembled;
  }
  return SolveStatus::converged;
}

Solution Continuation::solve(const Nominal& pose, std::span<const double> errors) {
  on_the_way_.prepare(pose);
  at_the_end_.prepare(pose);
  Solution here{.bodies = pose.bodies,
                .displacements = pose.displacements,
                .limbs = pose.limbs,
                .mismatch = pose.mismatch,
                .wrenches = std::vector<Screw>(pose.limbs.size(), Screw::Zero()),
                .steps = {}};
  here.status = follow(pose, errors, here);
  if (!solved(here.status)) return here;
  Solution found = at_the_end_.solve(frames(pose, errors, 1.0), {here.bodies, here.displacements});
  add_iterations(here, found);
  return found;
}

}  // namespace poesy::assembly
