#include "models/file/pose_tracker.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "tests/models/file/files.h"
#include "tests/models/file/poses.h"

namespace poesy::file {
namespace {

TEST(PoseTracker, GivesWhatATrackerGives) {
  const Mechanism mechanism = from_file("ups6");
  const Tracker expected(mechanism);
  const PoseTracker tracker(mechanism);
  const auto poses = random_poses(mechanism, 40);
  for (const std::size_t pose : {0, 1, 0, 1, 2, 39, 5, 0, 2}) {
    EXPECT_EQ(tracker.track(poses[pose]).displacements, expected.track(poses[pose]).displacements) << pose;
  }
  for (const auto& pose : poses) {
    EXPECT_EQ(tracker.track(pose).displacements, expected.track(pose).displacements);
  }
}

TEST(PoseTracker, TellsZerosBySign) {
  const Mechanism mechanism = from_file("ups6");
  const PoseTracker tracker(mechanism);
  std::vector<double> pose = random_poses(mechanism, 1).front();
  for (const double zero : {0.0, -0.0}) {
    pose.front() = zero;
    const Tracked found = tracker.track(pose);
    const Tracked expected = Tracker(mechanism).track(pose);
    for (std::size_t n = 0; n < 6; ++n) EXPECT_EQ(std::signbit(found.pose[n]), std::signbit(expected.pose[n])) << n;
  }
}

TEST(PoseTracker, RemembersWhyAPoseIsNotReached) {
  const Mechanism mechanism = from_file("ups6");
  const PoseTracker tracker(mechanism);
  std::vector<double> pose = random_poses(mechanism, 1).front();
  pose.front() = std::numeric_limits<double>::quiet_NaN();
  for (int n = 0; n < 2; ++n) EXPECT_EQ(tracker.track(pose).unreachable, "a coordinate is not a finite number");
}

TEST(PoseTracker, ServesSeveralThreadsAtOnce) {
  const Mechanism mechanism = from_file("rps3");
  const PoseTracker tracker(mechanism);
  const auto poses = random_poses(mechanism, 24);
  std::vector<std::vector<std::vector<double>>> found(4);
  {
    std::vector<std::jthread> threads;
    for (auto& list : found) {
      threads.emplace_back([&tracker, &poses, &list] {
        for (const auto& pose : poses) list.push_back(tracker.track(pose).displacements);
      });
    }
  }
  const Tracker expected(mechanism);
  for (std::size_t n = 0; n < poses.size(); ++n) {
    for (const auto& list : found) EXPECT_EQ(list[n], expected.track(poses[n]).displacements);
  }
}

}  // namespace
}  // namespace poesy::file
