#include "engine/study/poses/pose_sides.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace poesy {
namespace {

/// The range of each coordinate over the poses.
std::vector<double> ranges_of(const PoseSet& poses) {
  std::vector<double> ranges;
  for (std::size_t c = 0; c < poses[PoseIndex(0)].size(); ++c) {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (std::size_t m = 0; m < poses.size(); ++m) {
      least = std::min(least, poses[PoseIndex(m)][c]);
      most = std::max(most, poses[PoseIndex(m)][c]);
    }
    ranges.push_back(most - least);
  }
  return ranges;
}

/// Compares poses by Model::are_separated(), by way of the pose halfway between them. The way is needed also if both
/// poses seem near: idle freedoms that have turned by 180 deg look as if they had not turned.
class Sides {
 public:
  explicit Sides(const Model& model) : model_(model) {}

  /// Whether the poses are separated; none if this is not known. halvings: how often each half of the way may be
  /// halved.
  std::optional<bool> are_separated(std::span<const double> one, std::span<const double> other, int halvings) {
    std::vector<double> middle;
    for (std::size_t c = 0; c < one.size(); ++c) middle.push_back(0.5 * (one[c] + other[c]));
    if (model_.unreachable(middle)) return std::nullopt;
    const std::optional<bool> first = compare(one, middle, halvings);
    const std::optional<bool> second = first ? compare(middle, other, halvings) : std::nullopt;
    if (!second) return std::nullopt;
    return *first != *second;
  }

 private:
  std::optional<bool> compare(std::span<const double> one, std::span<const double> other, int halvings) {
    if (comparisons_left_ == 0) return std::nullopt;
    --comparisons_left_;
    const std::optional<bool> direct = model_.are_separated(one, other);
    return direct || halvings == 0 ? direct : are_separated(one, other, halvings - 1);
  }

  const Model& model_;
  std::size_t comparisons_left_ = 120;  // one may take some milliseconds
};

/// A pose, and a pose on the side of pose 0 that is near it.
struct NearPoses {
  std::size_t pose = 0;
  std::size_t near = 0;
  double distance = std::numeric_limits<double>::infinity();
};

/// The two poses, one of `left` and one of `same_side`, that are nearest to each other.
NearPoses nearest(const PoseSet& poses, std::span<const double> ranges, std::span<const std::size_t> left,
                  std::span<const std::size_t> same_side) {
  NearPoses found{left.front(), same_side.front()};
  for (const std::size_t pose : left) {
    for (const std::size_t near : same_side) {
      double distance = 0.0;  // squared, with each coordinate in units of its range
      for (std::size_t c = 0; c < ranges.size(); ++c) {
        if (!(ranges[c] > 0.0)) continue;
        const double share = (poses[PoseIndex(pose)][c] - poses[PoseIndex(near)][c]) / ranges[c];
        distance += share * share;
      }
      if (distance < found.distance) found = {pose, near, distance};
    }
  }
  return found;
}

}  // namespace

std::optional<std::size_t> pose_beyond_singularity(const Model& model, const PoseSet& poses) {
  constexpr std::size_t kMost = 30;
  constexpr int kHalvings = 2;
  if (poses.size() == 0) return std::nullopt;
  const std::size_t step = (poses.size() + kMost - 1) / kMost;
  const std::vector<double> ranges = ranges_of(poses);
  std::vector<std::size_t> same_side{0};
  std::vector<std::size_t> left;
  for (std::size_t m = step; m < poses.size(); m += step) left.push_back(m);
  Sides sides(model);
  while (!left.empty()) {
    const NearPoses next = nearest(poses, ranges, left, same_side);
    const std::optional<bool> separated =
        sides.are_separated(poses[PoseIndex(next.near)], poses[PoseIndex(next.pose)], kHalvings);
    if (separated.value_or(false)) return next.pose;
    if (separated) same_side.push_back(next.pose);
    std::erase(left, next.pose);
  }
  return std::nullopt;
}

}  // namespace poesy
