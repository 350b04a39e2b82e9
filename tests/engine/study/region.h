#pragma once

#include <cstddef>
#include <functional>
#include <numeric>
#include <span>
#include <vector>

#include "engine/study/poses/pose_selection.h"
#include "tests/support/fake_model.h"

namespace poesy::test {

/// The fake mechanism with a workspace that `inside` defines, with any number of coordinates. It is never singular.
class RegionModel : public FakeModel {
 public:
  explicit RegionModel(std::function<bool(std::span<const double>)> inside) : inside_(std::move(inside)) {}

  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    if (inside_(pose)) return std::nullopt;
    return "outside the region";
  }
  double condition(std::span<const double>) const override { return 1.0; }

 private:
  std::function<bool(std::span<const double>)> inside_;
};

inline const RegionModel kWholeBox([](std::span<const double>) { return true; });

/// A selection of poses from a box with these ranges (SI).
inline PoseSelection selection_of(PoseSelection::Select select, std::size_t count, std::vector<Range> workspace) {
  PoseSelection selection;
  selection.select = select;
  selection.count = count;
  selection.workspace = std::move(workspace);
  selection.place = {"study.toml", 12, 13};
  selection.count_place = {"study.toml", 11, 9};
  return selection;
}

/// A selection from the workspace of the fake mechanism: z (m), beta and gamma (rad).
inline PoseSelection fake_box(PoseSelection::Select select, std::size_t count) {
  return selection_of(select, count, {{-0.30, -0.18}, {-0.5, 0.5}, {-0.6, 0.6}});
}

/// A selection from the unit cube of this dimension.
inline PoseSelection unit_cube(PoseSelection::Select select, std::size_t count, std::size_t dimension) {
  return selection_of(select, count, std::vector<Range>(dimension, {0.0, 1.0}));
}

inline std::size_t total(const std::vector<RejectedPoses>& rejected) {
  return std::accumulate(rejected.begin(), rejected.end(), std::size_t{0},
                         [](std::size_t sum, const RejectedPoses& each) { return sum + each.count; });
}

}  // namespace poesy::test
