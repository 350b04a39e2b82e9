#pragma once

#include <span>

#include "engine/model/sketch.h"
#include "engine/report/svg_shapes.h"

namespace poesy {

inline constexpr double kSketchYaw = -35.0;     ///< Yaw of a view in space, deg.
inline constexpr double kSketchPitch = 25.0;    ///< Pitch of a view in space, deg.
inline constexpr double kSketchWidth = 460.0;   ///< Width of a picture, pixels.
inline constexpr double kSketchHeight = 340.0;  ///< Height of a picture, pixels.

/// A view of a mechanism without perspective: the base is turned about its z axis, then towards the reader. The script
/// that draws the picture again after turning (html/web/robot.js) uses the same rules.
struct SketchView {
  double yaw;           ///< about the base's z axis, deg
  double pitch;         ///< downwards, deg
  SketchVector centre;  ///< point in the middle of the picture, m
  double scale;         ///< pixels per metre
  bool z_is_down;       ///< whether the base's z axis points to the ground; y and z then change their signs first

  Pixel at(const SketchVector& point) const;  ///< The place of a point in the picture.
  double distance(const SketchVector& a,
                  const SketchVector& b) const;                  ///< The distance of two points in the picture, pixels.
  double metres(double pixels) const { return pixels / scale; }  ///< The length in metres of this many pixels.
  SketchVector right() const;                                    ///< The unit vector that points to the right.
};

/// A view that shows all of these sketches of one mechanism, however it is turned about z.
SketchView sketch_view(std::span<const Sketch> sketches, double yaw, double pitch);

SketchVector plus(const SketchVector& a, double scale, const SketchVector& b);  ///< a + scale b
SketchVector middle(const SketchVector& a, const SketchVector& b);              ///< The middle of two points.

/// The largest of 1, 2 and 5 times a power of ten that is at most the value. Precondition: the value is positive.
double rounded_down(double value);

}  // namespace poesy
