#pragma once

#include <algorithm>
#include <random>
#include <span>
#include <vector>

#include "models/file/tracking.h"

namespace poesy::file {

/// Points of the mechanism's workspace, or of a box around it that is `size` times as large.
inline std::vector<std::vector<double>> random_poses(const Mechanism& mechanism, std::size_t count, double size = 1.0,
                                                     std::uint64_t seed = 7) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> share(0.5 - 0.5 * size, 0.5 + 0.5 * size);
  std::vector<std::vector<double>> poses(count);
  for (std::vector<double>& pose : poses) {
    for (const Coordinate& c : mechanism.coordinates) pose.push_back(c.lower + share(engine) * (c.upper - c.lower));
  }
  return poses;
}

/// The largest distance between a limb's platform and the pose, rad and shares of the reach.
inline double open_by(const Mechanism& mechanism, const Tracked& tracked) {
  double largest = 0.0;
  std::size_t begin = 0;
  for (const Limb& limb : mechanism.limbs) {
    const Transform g = limb_transform(limb, std::span(tracked.displacements).subspan(begin, limb.moving()));
    const lie::Screw<double> mismatch = lie::log(tracked.platform * g.inverse());
    largest = std::max({largest, mismatch.head<3>().norm(), mismatch.tail<3>().norm() / mechanism.reach});
    begin += limb.moving();
  }
  return largest;
}

}  // namespace poesy::file
