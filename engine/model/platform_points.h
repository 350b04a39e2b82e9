#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/model/model.h"

namespace poesy {

/// A point of the platform for which a model reports the displacement.
struct NamedPlatformPoint {
  std::string name;     ///< name of the point; its responses are NAME_x, NAME_y, NAME_z and NAME_position
  PlatformPoint place;  ///< position in the platform's frame (m)
};

/// The nominal orientation of the platform at a reachable pose (SI), or at home if the pose is empty: base_R_platform
/// [3 x 3], row-major.
using PlatformOrientation = std::function<std::array<double, 9>(std::span<const double> pose)>;

/// The model with the displacements of these points, in the base's axes, appended to its responses. The model must have
/// the responses x, y, z (displacement of the platform's origin) and theta_x, theta_y, theta_z (rotation vector). If r
/// is the nominal vector from the platform's origin to a point, the displacement of the point is (x, y, z) + (R - I) r,
/// where R is the rotation by theta, or (x, y, z) + theta x r if `is_linear`.
std::unique_ptr<Model> with_platform_points(std::unique_ptr<Model> model, std::vector<NamedPlatformPoint> points,
                                            PlatformOrientation orientation, bool is_linear);

}  // namespace poesy
