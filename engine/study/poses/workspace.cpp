#include "engine/study/poses/workspace.h"

#include <algorithm>
#include <cmath>

#include "engine/study/poses/unusual_workspace.h"

namespace poesy {

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
    return {0.0, std::string(kOutOfReach) + *reason, &selection_->place, "move the workspace into reach"};
  }
  std::vector<double> displacements;
  if (!selection_->limits.empty()) displacements = model_->joint_displacements(pose);
  for (const JointLimit& limit : selection_->limits) {
    const double value = displacements[limit.joint];
    if (value >= limit.range.lower && value <= limit.range.upper) continue;
    const JointDisplacement& joint = model_->description().joints[limit.joint];
    const bool below = value < limit.range.lower;
    const double end = below ? limit.range.lower : limit.range.upper;
    return {0.0, joint.name + (below ? " below " : " above ") + readable_text({end, joint.dimension}), &limit.place,
            "make the limit wider"};
  }
  const double condition = model_->condition(pose);
  if (condition <= selection_->max_condition) return {condition, {}, nullptr, {}};
  return {condition, "singular: condition number above " + shortest(selection_->max_condition), &selection_->place,
          "move the workspace away from singular poses, or raise max_condition"};
}

std::string Workspace::apart() const { return apart_clause(selection_->workspace, model_->description()); }

void tell(const WatchSearch& watch, const PoseSearch& search) {
  if (watch && !watch(search)) throw SearchStopped();
}

std::optional<double> PoseCollector::test(std::span<const double> pose) {
  const Judgement judgement = workspace_->judge(pose);
  ++tested_;
  ++in_vain_;
  tell(*watch_, {std::min(kept(), wanted_), wanted_, before_ + tested_});
  if (judgement.feasible()) return judgement.condition;
  if (judgement.reason.starts_with(kOutOfReach)) ++unreached_;
  Count& count = rejected_[judgement.reason];
  ++count.count;
  count.last = judgement;
  return std::nullopt;
}

void PoseCollector::keep(std::span<const double> pose, double condition) {
  values_.insert(values_.end(), pose.begin(), pose.end());
  condition_.push_back(condition);
  in_vain_ = 0;
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
  for (std::size_t m = 0; m < count; ++m) {
    const std::size_t from = m * kept() / count;  // since from >= m, no pose is overwritten before it is copied
    std::ranges::copy(pose(from), values_.begin() + std::ptrdiff_t(m * workspace_->coordinates()));
    condition_[m] = condition_[from];
  }
  keep_first(count);
}

void PoseCollector::fail(const Place& workspace_place) const {
  std::string problem =
      kept() == 0 ? "the workspace is empty"
                  : "the workspace gives only " + std::to_string(kept()) + " of " + std::to_string(wanted_) + " poses";
  if (kept() > 0 && in_vain()) problem += ", the last " + std::to_string(in_vain_) + " candidates none";
  const auto most = std::ranges::max_element(rejected_, {}, [](const auto& reason) { return reason.second.count; });
  if (most == rejected_.end()) throw InputError(workspace_place, problem, "make the workspace wider");
  const auto& [reason, rejected] = *most;
  problem += " (" + reason + ": " + std::to_string(rejected.count) + " of " + std::to_string(tested_) + " candidates)";
  if (kept() == 0) problem += ", or so small that none of these is in it";
  if (const std::string apart = workspace_->apart(); kept() == 0 && !apart.empty()) problem += "; " + apart;
  throw InputError(*rejected.last.place, problem, rejected.last.remedy);
}

SelectedPoses PoseCollector::result() && {
  SelectedPoses selected{.poses = PoseSet(workspace_->coordinates(), std::move(values_)),
                         .condition = std::move(condition_),
                         .rejected = {},
                         .candidates = tested_,
                         .time = {}};
  for (const auto& [reason, rejected] : rejected_) selected.rejected.push_back({reason, rejected.count});
  std::ranges::stable_sort(selected.rejected, std::ranges::greater(), &RejectedPoses::count);
  return selected;
}

}  // namespace poesy
