#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/model/sketch.h"

namespace poesy {

/// From where a mechanism is seen: the base turned about its z, then towards the reader, without perspective. What
/// draws it again after it was turned (web/robot.js) knows these rules too.
struct RobotView {
  double yaw = -35.0;   ///< about the base's z axis, deg
  double pitch = 25.0;  ///< downwards, deg
  SketchVector centre;  ///< what stands in the middle of the picture, m
  double scale;         ///< pixels for a metre
  bool z_is_down;       ///< whether the base's z axis points to the ground: then y and z change their signs first
};

/// Shares of what errors do, by the parts of the mechanism where they are. Links are between two joints, of which 0 is
/// the base and one more than there are joints is the platform.
struct PartShares {
  std::vector<std::vector<double>> links;   ///< [limbs][joints + 1]
  std::vector<std::vector<double>> joints;  ///< [limbs][joints] between the axes of one joint
  double largest = 0.0;                     ///< of all of these; 0: nothing is shared

  /// Zeros for a mechanism.
  explicit PartShares(const Sketch& sketch);
};

inline constexpr double kRobotWidth = 460.0;   ///< Of a picture, pixels.
inline constexpr double kRobotHeight = 340.0;  ///< Of a picture, pixels.

/// A view in which all of these sketches of one mechanism have room, however it is turned about z.
RobotView robot_view(const std::vector<Sketch>& sketches);

/// A mechanism as one SVG element with title and description: links and joints in the colour of their share and as
/// thick, as CSS variable --share from 0 % to 100 % of the largest; glyphs of joints (svg_shapes.h) beside each other
/// where joints share a point. Each part that moves has its points (mm, base frame) as data-p="x,y,z x,y,z", a joint
/// also its own as data-at, with data-limb and data-joint. id: of the element, unique on the page. mark: position of an
/// error whose frame is drawn; beyond the errors: none.
std::string robot_svg(const Sketch& sketch, const RobotView& view, const PartShares& shares, const std::string& id,
                      const std::string& title, const std::string& description, std::size_t mark);

}  // namespace poesy
