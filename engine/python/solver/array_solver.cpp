#include "engine/python/solver/array_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/nan.h"
#include "engine/base/units.h"
#include "engine/study/mechanism_doubts.h"
#include "engine/study/outside_poses.h"

namespace poesy::python {
namespace {

/// The largest number of samples that are solved together, as a block. With more samples, the solver's data would not
/// fit into the processor's caches.
constexpr std::size_t kBlock = 1024;

/// A pose in words, SI: "z = 0.5 m, beta = 20 rad".
std::string pose_text(std::span<const double> pose, const ModelDescription& model) {
  std::string text;
  for (std::size_t c = 0; c < pose.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    text += fmt::format("{}{} = {}", c > 0 ? ", " : "", coordinate.name, to_text({pose[c], coordinate.dimension}));
  }
  return text;
}

}  // namespace

ArraySolver::ArraySolver(Study study)
    : study_(std::move(study)), model_(build_model(study_.mechanism)), zeros_(description().factors.size(), 0.0) {
  for (const OwnResponse& own : study_.mechanism.responses) {
    if (!own.relative_to || !own.relative_to->is_previous()) continue;
    throw InputError(own.relative_to->place, "'" + own.name + "' is relative to the pose before",
                     "leave it out, and subtract its values at other poses in Python");
  }
}

void ArraySolver::check_poses(std::span<const double> poses) const {
  const std::size_t coordinates = description().pose_coordinates.size();
  const std::size_t count = poses.size() / coordinates;
  for (std::size_t m = 0; m < count; ++m) {
    const auto pose = poses.subspan(m * coordinates, coordinates);
    const auto refuse = [&](const std::string& why) {
      const std::string number = count > 1 ? fmt::format(" {}", m + 1) : "";
      throw InputError({}, fmt::format("pose{} ({}) {}", number, pose_text(pose, description()), why),
                       "poses are in SI: metres and radians");
    };
    if (!std::ranges::all_of(pose, [](double value) { return std::isfinite(value); })) refuse("is not finite");
    if (const auto reason = model_->unreachable(pose)) refuse("is out of reach: " + *reason);
  }
}

std::vector<std::string> ArraySolver::doubts() const { return mechanism_doubts(study_.mechanism, *model_); }

std::string ArraySolver::far_poses(std::span<const double> poses) const {
  if (has_warned_) return {};
  const std::string clause =
      far_outside_clause({description().pose_coordinates.size(), {poses.begin(), poses.end()}}, description());
  if (clause.empty() || has_warned_.exchange(true)) return {};
  return clause + "; poses are in SI: metres and radians";
}

std::unique_ptr<ArraySolver::Scratch> ArraySolver::take_scratch() const {
  {
    const std::lock_guard lock(mutex_);
    if (!idle_.empty()) {
      std::unique_ptr<Scratch> scratch = std::move(idle_.back());
      idle_.pop_back();
      return scratch;
    }
  }
  auto scratch = std::make_unique<Scratch>();
  scratch->evaluator = model_->evaluator(study_.solver);
  scratch->status.resize(kBlock);
  scratch->iterations.resize(kBlock);
  return scratch;
}

void ArraySolver::solve_in_place(Scratch& scratch, std::span<const double> pose, const double* errors,
                                 std::size_t count, double* responses, SolveStatus* status) const {
  const std::size_t rows = description().responses.size();
  const std::span ends = status != nullptr ? std::span(status, count) : std::span(scratch.status).first(count);
  scratch.evaluator->evaluate({pose, zeros_, factors(), {errors, factors().size() * count}, count},
                              {{responses, rows * count}, ends, std::span(scratch.iterations).first(count), {}});
  for (std::size_t b = 0; b < count; ++b) {
    if (solved(ends[b])) continue;
    for (std::size_t r = 0; r < rows; ++r) responses[r * count + b] = kNaN;
  }
}

/// Solves the samples from `first` to first + count - 1 at pose m of a job with more samples than a block holds. The
/// samples are copied to scratch memory, because the solver needs the rows of a block (a row for each error) directly
/// one after the other, and the rows of the caller's arrays are longer.
void ArraySolver::solve_block(Scratch& scratch, std::span<const double> pose, const ArrayJob& job, std::size_t m,
                              std::size_t first, std::size_t count) const {
  const std::size_t rows = description().responses.size();
  scratch.errors.resize(factors().size() * kBlock);
  scratch.responses.resize(rows * kBlock);
  const double* const errors = job.errors + m * job.step + first;
  for (std::size_t v = 0; v < factors().size(); ++v) {
    std::copy_n(errors + v * job.samples, count, scratch.errors.data() + v * count);
  }
  SolveStatus* const status = job.status != nullptr ? job.status + m * job.samples + first : nullptr;
  solve_in_place(scratch, pose, scratch.errors.data(), count, scratch.responses.data(), status);
  for (std::size_t r = 0; r < rows; ++r) {
    std::copy_n(scratch.responses.data() + r * count, count, job.responses + (m * rows + r) * job.samples + first);
  }
}

void ArraySolver::solve(const ArrayJob& job, const std::function<void()>& between) const {
  const std::size_t coordinates = description().pose_coordinates.size();
  const std::size_t rows = description().responses.size();
  std::unique_ptr<Scratch> scratch = take_scratch();
  for (std::size_t m = 0; m * coordinates < job.poses.size(); ++m) {
    const auto pose = job.poses.subspan(m * coordinates, coordinates);
    if (job.samples <= kBlock) {
      SolveStatus* const status = job.status != nullptr ? job.status + m * job.samples : nullptr;
      if (job.samples > 0) {
        solve_in_place(*scratch, pose, job.errors + m * job.step, job.samples, job.responses + m * rows * job.samples,
                       status);
      }
      between();
      continue;
    }
    for (std::size_t first = 0; first < job.samples; first += kBlock) {
      solve_block(*scratch, pose, job, m, first, std::min(kBlock, job.samples - first));
      between();
    }
  }
  const std::lock_guard lock(mutex_);
  idle_.push_back(std::move(scratch));
}

}  // namespace poesy::python
