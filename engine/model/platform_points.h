#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"

namespace poesy {

/// A point of the platform whose displacement is reported.
struct NamedPlatformPoint {
  std::string name;     ///< its responses are NAME_x, NAME_y, NAME_z and NAME_position
  PlatformPoint place;  ///< in the platform's frame (m)
};

/// How the platform lies at a reachable pose (SI), or at home if the pose is empty, without errors: base_R_platform [3
/// x 3], row-major.
using PlatformOrientation = std::function<std::array<double, 9>(std::span<const double> pose)>;

/// A model with the displacements of these points behind its responses, in the base's axes. They follow from the
/// displacement x, y, z and the rotation vector theta_x, theta_y, theta_z of the platform, which the model must report:
/// d = (x, y, z) + (exp(theta) - 1) r, with r the point's nominal place from the platform's origin; if `is_linear`, d =
/// (x, y, z) + theta x r.
std::unique_ptr<Model> with_platform_points(std::unique_ptr<Model> model, std::vector<NamedPlatformPoint> points,
                                            PlatformOrientation orientation, bool is_linear);

}  // namespace poesy
