#include "engine/report/html/robot_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "engine/report/html/page.h"
#include "engine/report/sketch_words.h"
#include "engine/report/svg_shapes.h"

namespace poesy {
namespace {

constexpr double kMargin = 30.0;      // pixels around all
constexpr double kStep = 14.0;        // pixels between glyphs that share a point
constexpr double kTick = 15.0;        // pixels, half of a joint's axis
constexpr double kAxis = 36.0;        // pixels, axes of a frame
constexpr double kThinnest = 2.0;     // pixels of a link without share
constexpr double kThickest = 8.0;     // pixels of the one with the largest
constexpr double kMillimetres = 1e3;  // in a metre
constexpr double kSamePoint = 1.0;    // pixels: joints that are closer share a point

SketchVector plus(const SketchVector& a, double scale, const SketchVector& b) {
  return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

SketchVector middle(const SketchVector& a, const SketchVector& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

double distance(const SketchVector& a, const SketchVector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<SketchVector> points_of(const Sketch& sketch) {
  std::vector<SketchVector> points = sketch.tool;
  points.push_back(sketch.platform);
  for (const auto& limb : sketch.limbs) {
    for (const SketchedJoint& joint : limb) points.push_back(joint.point);
  }
  return points;
}

/// "12.500,-3.000,0.000 ...", mm.
std::string numbers_of(std::span<const SketchVector> points) {
  std::string text;
  const auto number = [](double metres) {
    const double rounded = std::round(metres * kMillimetres * 1e3) / 1e3;
    return fmt::format("{:.3f}", rounded == 0.0 ? 0.0 : rounded);
  };
  for (const SketchVector& point : points) {
    text += fmt::format("{}{},{},{}", text.empty() ? "" : " ", number(point[0]), number(point[1]), number(point[2]));
  }
  return text;
}

/// One picture while it is drawn.
class Drawing {
 public:
  Drawing(const Sketch& sketch, const RobotView& view, const PartShares& shares)
      : sketch_(&sketch),
        view_(&view),
        shares_(&shares),
        sin_yaw_(std::sin(view.yaw * std::numbers::pi / 180.0)),
        cos_yaw_(std::cos(view.yaw * std::numbers::pi / 180.0)),
        sin_pitch_(std::sin(view.pitch * std::numbers::pi / 180.0)),
        cos_pitch_(std::cos(view.pitch * std::numbers::pi / 180.0)) {}

  std::string all(std::size_t mark) {
    bodies();
    for (std::size_t i = 0; i < sketch_->limbs.size(); ++i) limb(i);
    if (mark < sketch_->errors.size()) frame(sketch_->errors[mark]);
    return std::move(text_);
  }

 private:
  Pixel at(const SketchVector& point) const {
    SketchVector p = plus(point, -1.0, view_->centre);
    if (view_->z_is_down) p = {p[0], -p[1], -p[2]};
    const double right = p[0] * cos_yaw_ - p[1] * sin_yaw_;
    const double deep = p[0] * sin_yaw_ + p[1] * cos_yaw_;
    const double up = p[2] * cos_pitch_ + deep * sin_pitch_;
    return {kRobotWidth / 2 + view_->scale * right, kRobotHeight / 2 - view_->scale * up};
  }

  double metres(double pixels) const { return pixels / view_->scale; }

  static std::string points_attribute(std::span<const SketchVector> points) {
    return fmt::format("data-p=\"{}\"", numbers_of(points));
  }

  void add_line(const SketchVector& a, const SketchVector& b, std::string_view attributes) {
    const std::array ends{a, b};
    text_ += svg_line(at(a), at(b), fmt::format("{} {}", points_attribute(ends), attributes));
  }

  void add_path(std::span<const SketchVector> points, std::string_view attributes) {
    std::vector<Pixel> pixels;
    for (const SketchVector& point : points) pixels.push_back(at(point));
    text_ += svg_path(pixels, fmt::format("{} {}", points_attribute(points), attributes));
  }

  /// What is drawn around a point, with that point in the middle.
  void add_group(const SketchVector& point, std::string_view attributes, std::string_view content) {
    const Pixel pixel = at(point);
    text_ += fmt::format("<g transform=\"translate({:.1f} {:.1f})\" {} {}>{}</g>\n", pixel.x, pixel.y,
                         points_attribute({&point, 1}), attributes, content);
  }

  void add_text(const SketchVector& point, Pixel offset, std::string_view what, std::string_view attributes) {
    add_group(point, attributes, svg_text(offset, what));
  }

  /// Axes of the base, the bodies between the first and between the last joints, the platform's origin and its tool.
  void bodies() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      SketchVector end{};
      end[axis] = metres(kAxis);
      add_line({}, end, "class=\"frame-axis\"");
      add_text(end, {3, -3}, std::string(1, "xyz"[axis]), "class=\"frame-name\"");
    }
    std::vector<SketchVector> base;
    std::vector<SketchVector> platform;
    for (const auto& limb : sketch_->limbs) {
      base.push_back(limb.front().point);
      platform.push_back(limb.back().point);
    }
    add_path(base, "class=\"base\"");
    add_path(platform, "class=\"platform\"");
    for (const SketchVector& tip : sketch_->tool) {
      add_line(sketch_->platform, tip, "class=\"tool\"");
      add_text(tip, {5, 4}, "tool", "class=\"frame-name\"");
    }
  }

  /// In the base's middle, from where the links to the first joints go.
  SketchVector base_middle() const {
    SketchVector sum{};
    for (const auto& limb : sketch_->limbs) sum = plus(sum, 1.0, limb.front().point);
    return plus({}, 1.0 / static_cast<double>(sketch_->limbs.size()), sum);
  }

  void limb(std::size_t i) {
    const std::vector<SketchedJoint>& joints = sketch_->limbs[i];
    std::vector<SketchVector> places = places_of(joints);
    places.insert(places.begin(), base_middle());
    places.push_back(sketch_->platform);
    for (std::size_t j = 0; j + 1 < places.size(); ++j) {
      add_line(places[j], places[j + 1],
               fmt::format("class=\"link{}\" data-limb=\"{}\" {}", j == 0 || j == joints.size() ? " body" : "", i + 1,
                           share_style(shares_->links[i][j])));
    }
    for (std::size_t j = 0; j < joints.size(); ++j) joint(i, j, places[j + 1]);
    add_text(places[1], {-20, 5}, std::to_string(i + 1), "class=\"limb-name\"");
  }

  void joint(std::size_t i, std::size_t j, const SketchVector& place) {
    const SketchedJoint& joint = sketch_->limbs[i][j];
    if (joint.type != 'S' && joint.type != 'F') {
      add_line(plus(place, -metres(kTick), joint.axis), plus(place, metres(kTick), joint.axis), "class=\"tick\"");
    }
    const std::string name = joint_words(*sketch_, i, j + 1) + (joint.name.empty() ? "" : " " + name_words(joint));
    const std::string content = element("title", fmt::format("limb {}, {}", i + 1, name)) +
                                svg_glyph(joint.type, joint.actuated, {0, 0}, {"var(--part)", "var(--paper)"});
    add_group(place,
              fmt::format("class=\"joint\" data-limb=\"{}\" data-joint=\"{}\" data-at=\"{}\" {}", i + 1, j + 1,
                          numbers_of({&joint.point, 1}), share_style(shares_->joints[i][j])),
              content);
  }

  /// Its share in percent of the largest, for the colour, and a width.
  std::string share_style(double share) const {
    const double part = shares_->largest > 0.0 ? share / shares_->largest : 0.0;
    return fmt::format("style=\"--share:{:.0f}%\" stroke-width=\"{:.1f}\"", 100.0 * part,
                       kThinnest + (kThickest - kThinnest) * part);
  }

  /// Where the joints' glyphs stand: at their points. Several at one point stand in a row from there towards the next
  /// one; a slide that begins at another joint stands between the two that it connects.
  std::vector<SketchVector> places_of(const std::vector<SketchedJoint>& joints) const {
    std::vector<SketchVector> places;
    while (places.size() < joints.size()) {
      const std::size_t begin = places.size();
      std::size_t end = begin + 1;
      while (end < joints.size() && distance(joints[end].point, joints[begin].point) < metres(kSamePoint)) ++end;
      const SketchVector& here = joints[begin].point;
      const SketchVector& next = end < joints.size() ? joints[end].point : sketch_->platform;
      const bool slides = end - begin > 1 && end < joints.size() && joints[end - 1].type == 'P';
      const std::size_t row = end - begin - (slides ? 1 : 0);
      const double way = distance(here, next);
      const double step = std::min(metres(kStep), way / static_cast<double>(end - begin + 1));
      for (std::size_t k = 0; k < row; ++k) {
        places.push_back(way > 0.0 ? plus(here, static_cast<double>(k) * step / way, plus(next, -1.0, here)) : here);
      }
      if (slides) places.push_back(middle(here, next));
    }
    return places;
  }

  /// The frame of an error, its axis stronger than the others.
  void frame(const SketchedError& error) {
    const SketchedFrame& frame = sketch_->frames[error.limb][error.frame];
    text_ += "<g class=\"marked\">";
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const SketchVector end = plus(frame.origin, metres(axis == error.axis ? 1.5 * kAxis : kAxis), frame.axes[axis]);
      add_line(frame.origin, end, axis == error.axis ? "class=\"error-axis\"" : "class=\"other-axis\"");
      add_text(end, {4, -4}, std::string(1, "xyz"[axis]), "class=\"error-name\"");
    }
    text_ += "</g>\n";
  }

  const Sketch* sketch_;
  const RobotView* view_;
  const PartShares* shares_;
  double sin_yaw_;
  double cos_yaw_;
  double sin_pitch_;
  double cos_pitch_;
  std::string text_;
};

}  // namespace

PartShares::PartShares(const Sketch& sketch) {
  for (const auto& limb : sketch.limbs) {
    links.emplace_back(limb.size() + 1, 0.0);
    joints.emplace_back(limb.size(), 0.0);
  }
}

RobotView robot_view(const std::vector<Sketch>& sketches) {
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
  RobotView view{.centre = middle(low, high), .scale = 1.0, .z_is_down = sketches.front().z_is_down};
  const double pitch = view.pitch * std::numbers::pi / 180.0;
  double aside = 0.0;
  double upwards = 0.0;
  for (const Sketch& sketch : sketches) {
    for (const SketchVector& point : points_of(sketch)) {
      const SketchVector from = plus(point, -1.0, view.centre);
      const double radius = std::hypot(from[0], from[1]);
      aside = std::max(aside, radius);
      upwards = std::max(upwards, std::abs(from[2]) * std::cos(pitch) + radius * std::sin(pitch));
    }
  }
  if (std::max(aside, upwards) > 0.0) {
    view.scale = std::min((kRobotWidth / 2 - kMargin) / aside, (kRobotHeight / 2 - kMargin) / upwards);
  }
  return view;
}

std::string robot_svg(const Sketch& sketch, const RobotView& view, const PartShares& shares, const std::string& id,
                      const std::string& title, const std::string& description, std::size_t mark) {
  return fmt::format(
      "<svg id=\"{0}\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {1:g} {2:g}\" role=\"img\" "
      "aria-labelledby=\"{0}-title {0}-desc\">\n{3}\n{4}\n{5}</svg>\n",
      id, kRobotWidth, kRobotHeight, element("title", title, fmt::format("id=\"{}-title\"", id)),
      element("desc", description, fmt::format("id=\"{}-desc\"", id)), Drawing(sketch, view, shares).all(mark));
}

}  // namespace poesy
