#pragma once

#include <span>

#include "engine/model/sketch.h"
#include "engine/report/svg_shapes.h"

namespace poesy {

inline constexpr double kSketchYaw = -35.0;     ///< Of a view in space, deg.
inline constexpr double kSketchPitch = 25.0;    ///< Of a view in space, deg.
inline constexpr double kSketchWidth = 460.0;   ///< Of a picture, pixels.
inline constexpr double kSketchHeight = 340.0;  ///< Of a picture, pixels.

/// From where a mechanism is seen: the base turned about its z, then towards the reader, without perspective. What
/// draws it again after it was turned (html/web/robot.js) knows these rules too.
struct SketchView {
  double yaw;           ///< about the base's z axis, deg
  double pitch;         ///< downwards, deg
  SketchVector centre;  ///< what is in the middle of the picture, m
  double scale;         ///< pixels for a metre
  bool z_is_down;       ///< whether the base's z axis points to the ground: then y and z change their signs first

  Pixel at(const SketchVector& point) const;                            ///< Where a point is seen.
  double distance(const SketchVector& a, const SketchVector& b) const;  ///< Between two points as seen, pixels.
  double metres(double pixels) const { return pixels / scale; }         ///< How long what is seen so long is.
  SketchVector right() const;                                           ///< What points to the right, of length 1.
};

/// A view in which all of these sketches of one mechanism have room, however it is turned about z.
SketchView sketch_view(std::span<const Sketch> sketches, double yaw, double pitch);

SketchVector plus(const SketchVector& a, double scale, const SketchVector& b);  ///< a + scale b
SketchVector middle(const SketchVector& a, const SketchVector& b);              ///< Halfway between two points.

/// The largest of 1, 2 and 5 times a power of ten that is not above a value. Precondition: it is above 0.
double rounded_down(double value);

}  // namespace poesy
