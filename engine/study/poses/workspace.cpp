#include "engine/study/poses/workspace.h"

#include <algorithm>
#include <cmath>

#include "engine/base/contract.h"
#include "engine/base/units.h"

namespace poesy {

Workspace::Workspace(const PoseSelection& selection, const Model& model) : selection_(&selection), model_(&model) {
  for (const JointLimit& limit : selection.limits) {
    const JointDisplacement& joint = model.description().joints[limit.joint];
    limit_reasons_.push_back({joint.name + " below " + readable_text({limit.range.lower, joint.dimension}),
                              joint.name + " above " + readable_text({limit.range.upper, joint.dimension})});
  }
  singular_ = "singular: condition number above " + shortest(selection.max_condition);
}

void Workspace::unscale(std::span<const double> scaled, std::span<double> pose) const {
  for (std::size_t c = 0; c < scaled.size(); ++c) {
    const Range& range = selection_->workspace[c];
    pose[c] = std::lerp(range.lower, range.upper, scaled[c]);
  }
}

double Workspace::scaled(std::size_t coordinate, double value) const {
  const Range& range = selection_->workspace[coordinate];
  return (value - range.lower) / (range.upper - range.lower);
}

Judgement Workspace::judge(std::span<const double> pose) const {
  if (const auto reason = model_->unreachable(pose)) {
    return {0.0, "out of reach: " + *reason, &selection_->place, "move the workspace into reach"};
  }
  if (!selection_->limits.empty()) {
    const std::vector<double> displacements = model_->joint_displacements(pose);
    for (std::size_t k = 0; k < selection_->limits.size(); ++k) {
      const JointLimit& limit = selection_->limits[k];
      const double value = displacements[limit.joint];
      if (value >= limit.range.lower && value <= limit.range.upper) continue;
      const bool below = value < limit.range.lower;
      return {0.0, below ? limit_reasons_[k].below : limit_reasons_[k].above, &limit.place, "make the limit wider"};
    }
  }
  const double condition = model_->condition(pose);
  if (condition <= selection_->max_condition) return {condition, {}, nullptr, {}};
  return {condition, singular_, &selection_->place,
          "move the workspace away from singular poses, or raise max_condition"};
}

bool PoseCollector::test(std::span<const double> pose) {
  const Judgement judgement = workspace_->judge(pose);
  ++tested_;
  if (!judgement.feasible()) reject(judgement);
  return judgement.feasible();
}

void PoseCollector::keep(std::span<const double> pose) { keep(pose, workspace_->judge(pose).condition); }

void PoseCollector::offer(std::span<const double> pose) {
  const Judgement judgement = workspace_->judge(pose);
  ++tested_;
  if (judgement.feasible()) {
    keep(pose, judgement.condition);
  } else {
    reject(judgement);
  }
}

void PoseCollector::keep(std::span<const double> pose, double condition) {
  values_.insert(values_.end(), pose.begin(), pose.end());
  condition_.push_back(condition);
}

void PoseCollector::reject(const Judgement& judgement) {
  Count& count = rejected_[judgement.reason];
  ++count.count;
  count.place = judgement.place;
  count.remedy = judgement.remedy;
}

std::span<const double> PoseCollector::pose(std::size_t m) const {
  const std::size_t width = workspace_->coordinates();
  return std::span(values_).subspan(m * width, width);
}

void PoseCollector::keep_first(std::size_t count) {
  POESY_EXPECTS(count <= kept());
  values_.resize(count * workspace_->coordinates());
  condition_.resize(count);
}

void PoseCollector::thin_to(std::size_t count) {
  POESY_EXPECTS(count <= kept());
  const std::size_t width = workspace_->coordinates();
  for (std::size_t m = 0; m < count; ++m) {
    const std::size_t from = m * kept() / count;  // never before m
    std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(from * width), width,
                values_.begin() + static_cast<std::ptrdiff_t>(m * width));
    condition_[m] = condition_[from];
  }
  keep_first(count);
}

void PoseCollector::fail(std::size_t wanted, const Place& workspace_place) const {
  std::string problem =
      kept() == 0 ? "the workspace is empty"
                  : "the workspace gives only " + std::to_string(kept()) + " of " + std::to_string(wanted) + " poses";
  const auto most = std::max_element(rejected_.begin(), rejected_.end(),
                                     [](const auto& a, const auto& b) { return a.second.count < b.second.count; });
  if (most == rejected_.end()) throw InputError(workspace_place, problem, "make the workspace wider");
  problem += " (" + most->first + ": " + std::to_string(most->second.count) + " of " + std::to_string(tested_) +
             " candidates)";
  throw InputError(*most->second.place, problem, most->second.remedy);
}

SelectedPoses PoseCollector::result() && {
  SelectedPoses selected;
  selected.poses = PoseSet(workspace_->coordinates(), std::move(values_));
  selected.condition = std::move(condition_);
  for (const auto& [reason, count] : rejected_) selected.rejected.push_back({reason, count.count});
  std::ranges::stable_sort(selected.rejected, std::ranges::greater(), &RejectedPoses::count);
  return selected;
}

}  // namespace poesy
