#include "engine/report/sketch_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace poesy {
namespace {

constexpr double kMargin = 30.0;  // pixels that stay free on all sides

std::vector<SketchVector> points_of(const Sketch& sketch) {
  std::vector<SketchVector> points = sketch.tool;
  for (const SketchedPoint& named : sketch.points) points.push_back(named.point);
  points.insert(points.end(), {sketch.platform, {0, 0, 0}});
  for (const auto& limb : sketch.limbs) {
    for (const SketchedJoint& joint : limb) points.push_back(joint.point);
  }
  return points;
}

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

}  // namespace

Pixel SketchView::at(const SketchVector& point) const {
  SketchVector p = plus(point, -1.0, centre);
  if (z_is_down) p = {p[0], -p[1], -p[2]};
  const double right = p[0] * std::cos(radians(yaw)) - p[1] * std::sin(radians(yaw));
  const double deep = p[0] * std::sin(radians(yaw)) + p[1] * std::cos(radians(yaw));
  const double up = p[2] * std::cos(radians(pitch)) + deep * std::sin(radians(pitch));
  return {kSketchWidth / 2 + scale * right, height / 2 - scale * up};
}

double SketchView::distance(const SketchVector& a, const SketchVector& b) const {
  return std::hypot(at(a).x - at(b).x, at(a).y - at(b).y);
}

SketchVector SketchView::right() const {
  return {std::cos(radians(yaw)), (z_is_down ? 1.0 : -1.0) * std::sin(radians(yaw)), 0.0};
}

SketchView sketch_view(std::span<const Sketch> sketches, double yaw, double pitch, double tallest) {
  SketchVector low{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  SketchVector high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (const Sketch& sketch : sketches) {
    for (const SketchVector& point : points_of(sketch)) {
      for (std::size_t c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], point[c]);
        high[c] = std::max(high[c], point[c]);
      }
    }
  }
  SketchView view{yaw, pitch, middle(low, high), 1.0, sketches.front().z_is_down, kSketchHeight};
  double aside = 0.0;
  double upwards = 0.0;
  for (const Sketch& sketch : sketches) {
    for (const SketchVector& point : points_of(sketch)) {
      const SketchVector from = plus(point, -1.0, view.centre);
      const double radius = std::hypot(from[0], from[1]);
      aside = std::max(aside, radius);
      upwards = std::max(upwards, std::abs(from[2]) * std::cos(radians(pitch)) + radius * std::sin(radians(pitch)));
    }
  }
  if (std::max(aside, upwards) > 0.0) {
    const double room = kSketchWidth / 2 - kMargin;
    view.height = std::clamp(2 * (kMargin + room * upwards / aside), kSketchHeight, tallest);
    view.scale = std::min(room / aside, (view.height / 2 - kMargin) / upwards);
  }
  return view;
}

SketchVector plus(const SketchVector& a, double scale, const SketchVector& b) {
  return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

SketchVector middle(const SketchVector& a, const SketchVector& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

double rounded_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  return power * (value / power < 2 ? 1 : value / power < 5 ? 2 : 5);
}

}  // namespace poesy
