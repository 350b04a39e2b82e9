#pragma once

#include <span>

#include "engine/model/sketch.h"
#include "engine/report/svg_shapes.h"

namespace poesy {

inline constexpr double kSketchYaw = -35.0;     ///< Yaw of the usual view in space, deg.
inline constexpr double kSketchPitch = 25.0;    ///< Pitch of the usual view in space, deg.
inline constexpr double kSketchWidth = 460.0;   ///< Width of a picture, pixels.
inline constexpr double kSketchHeight = 340.0;  ///< Height of a picture, pixels.
inline constexpr double kTallHeight = 520.0;    ///< Largest height of a picture of a tall mechanism, pixels.

/// A view of a mechanism without perspective. The base is turned by `yaw` about its z axis, and afterwards by `pitch`
/// towards the reader. The script that draws the picture again when a reader turns it (html/web/robot.js) uses the same
/// rules.
struct SketchView {
  double yaw;           ///< angle about the base's z axis, deg
  double pitch;         ///< angle at which the reader looks down, deg
  SketchVector centre;  ///< point in the middle of the picture, m, base frame
  double scale;         ///< pixels per metre
  /// True if the base's z axis points to the ground, so that y and z change their signs before the base is turned.
  bool z_is_down;
  double height;  ///< height of the picture, pixels; the width is kSketchWidth

  Pixel at(const SketchVector& point) const;  ///< The pixel at which a point (m, base frame) is seen.
  /// The distance of two points in the picture, pixels.
  double distance(const SketchVector& a, const SketchVector& b) const;
  double metres(double pixels) const { return pixels / scale; }  ///< The length that this many pixels show, m.
  SketchVector right() const;  ///< The unit vector in the base frame that points to the right in the picture.
};

/// A view in which all of these sketches of one mechanism stay visible if the base is turned about z. The picture of a
/// tall mechanism is higher than kSketchHeight, but at most `tallest` pixels, so that the mechanism fills the width of
/// the picture.
SketchView sketch_view(std::span<const Sketch> sketches, double yaw, double pitch, double tallest = kSketchHeight);

SketchVector plus(const SketchVector& a, double scale, const SketchVector& b);  ///< The vector a + scale b.
SketchVector middle(const SketchVector& a, const SketchVector& b);              ///< The middle of two points.

/// The largest number of the form 1, 2 or 5 times a power of ten that is at most `value`. Precondition: `value` is
/// positive.
double rounded_down(double value);

}  // namespace poesy
