#include "engine/report/mechanism_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/base/text.h"
#include "engine/report/html/page.h"
#include "engine/report/sketch_words.h"
#include "engine/report/svg_shapes.h"

namespace poesy {
namespace {

constexpr double kPanel = 320.0;  // pixels
constexpr double kMargin = 34.0;  // around a panel's drawing
constexpr double kTick = 15.0;    // half of an axis
constexpr double kHead = 26.0;    // for a title of one line
constexpr double kTitleLine = 18.0;
constexpr std::size_t kTitleWidth = 70;  // characters of a line
constexpr double kLegend = 44.0;         // below the panels
constexpr std::array<std::string_view, 6> kColours{"#2563a8", "#b4541a", "#2f7d4f", "#8a3d8f", "#8a6d1b", "#3b7f8c"};

/// A direction from which one looks.
struct SketchView {
  std::string_view name;
  SketchVector right;  ///< what goes to the right, in the base frame
  SketchVector up;     ///< what goes upwards
};

const std::array<SketchView, 4>& views() {
  static const double third = std::sqrt(1.0 / 6.0);
  static const std::array<SketchView, 4> all{
      SketchView{"front: x to the right, z up", {1, 0, 0}, {0, 0, 1}},
      SketchView{"side: y to the right, z up", {0, 1, 0}, {0, 0, 1}},
      SketchView{"above: x to the right, y up", {1, 0, 0}, {0, 1, 0}},
      SketchView{"in space", {std::sqrt(0.5), std::sqrt(0.5), 0}, {third, -third, 2 * third}}};
  return all;
}

double dot(const SketchVector& a, const SketchVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

std::vector<SketchVector> all_points(const Sketch& sketch) {
  std::vector<SketchVector> points{sketch.platform, {0, 0, 0}};
  points.insert(points.end(), sketch.tool.begin(), sketch.tool.end());
  for (const auto& limb : sketch.limbs) {
    for (const SketchedJoint& joint : limb) points.push_back(joint.point);
  }
  return points;
}

/// Middle of the points in a view, and the larger of their extents.
struct ViewExtent {
  Pixel middle;
  double size;
};

ViewExtent extent(std::span<const SketchVector> points, const SketchView& view) {
  Pixel least{HUGE_VAL, HUGE_VAL};
  Pixel most{-HUGE_VAL, -HUGE_VAL};
  for (const SketchVector& point : points) {
    least = {std::min(least.x, dot(point, view.right)), std::min(least.y, dot(point, view.up))};
    most = {std::max(most.x, dot(point, view.right)), std::max(most.y, dot(point, view.up))};
  }
  return {{(least.x + most.x) / 2, (least.y + most.y) / 2}, std::max(most.x - least.x, most.y - least.y)};
}

/// Half of the space that a glyph takes in a row.
double half_space(const SketchedJoint& joint) { return joint.type == 'F' ? kGlyph / 3 + 2 : kGlyph + 1.5; }

/// A view with its place on the page.
class ViewPanel {
 public:
  /// scale: pixels for a metre.
  ViewPanel(const SketchView& view, const ViewExtent& extent, double scale, Pixel corner)
      : view_(&view), extent_(extent), scale_(scale), corner_(corner) {}

  Pixel at(const SketchVector& point) const {
    return {corner_.x + kPanel / 2 + scale_ * (dot(point, view_->right) - extent_.middle.x),
            corner_.y + kPanel / 2 - scale_ * (dot(point, view_->up) - extent_.middle.y)};
  }

  std::string drawing(const Sketch& sketch) const {
    std::string text = svg_text({corner_.x + 8, corner_.y + 16}, view_->name, "fill=\"#5a6270\"");
    text += base_axes() + ground(sketch) + platform(sketch);
    for (std::size_t i = 0; i < sketch.limbs.size(); ++i) text += limb(sketch, i);
    return text;
  }

 private:
  std::string base_axes() const {
    constexpr double kLength = 22.0;
    std::string text;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      SketchVector end{};
      end[axis] = kLength / scale_;
      const Pixel from = at({});
      const Pixel to = at(end);
      if (std::hypot(to.x - from.x, to.y - from.y) < 2.0) continue;
      text += svg_line(from, to, "stroke=\"#8b93a1\" stroke-width=\"1\"");
      text += svg_text({to.x + 2, to.y - 2}, std::string(1, "xyz"[axis]), "fill=\"#8b93a1\"");
    }
    return text;
  }

  /// The bodies: lines around the first and the last joints, the platform's with its origin.
  std::string ground(const Sketch& sketch) const {
    std::vector<Pixel> points;
    for (const auto& limb : sketch.limbs) points.push_back(at(limb.front().point));
    return svg_path(points, "fill=\"#8b93a1\" fill-opacity=\"0.10\" stroke=\"#8b93a1\" stroke-dasharray=\"4 3\"");
  }

  std::string platform(const Sketch& sketch) const {
    std::vector<Pixel> points;
    for (const auto& limb : sketch.limbs) points.push_back(at(limb.back().point));
    std::string text =
        svg_path(points, "fill=\"#2563a8\" fill-opacity=\"0.10\" stroke=\"#5a6270\" stroke-width=\"1.5\"");
    for (const SketchVector& tip : sketch.tool) {
      text += svg_line(at(sketch.platform), at(tip), "stroke=\"#5a6270\" stroke-width=\"1.5\"");
      text += svg_text({at(tip).x + 5, at(tip).y + 4}, "tool", "fill=\"#5a6270\"");
    }
    return text + svg_circle(at(sketch.platform), 2.5, "fill=\"#1d222b\"") +
           svg_text({at(sketch.platform).x + 5, at(sketch.platform).y - 5}, "P", "fill=\"#1d222b\"");
  }

  std::string limb(const Sketch& sketch, std::size_t number) const {
    const std::span<const SketchedJoint> joints = sketch.limbs[number];
    const std::string_view colour = kColours[number % kColours.size()];
    std::string text;
    for (std::size_t j = 1; j < joints.size(); ++j) {
      text += svg_line(at(joints[j - 1].point), at(joints[j].point),
                       fmt::format("stroke=\"{}\" stroke-width=\"2.2\"", colour));
    }
    const std::vector<Pixel> places = places_of(joints, sketch.platform);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      text += tick(joints[j], places[j], colour) + joint_glyph(joints[j], places[j], colour);
    }
    return text +
           svg_text(number_place(sketch, number), std::to_string(number + 1), fmt::format("fill=\"{}\"", colour));
  }

  /// Below the first joint, or above it where the limb goes downwards; to the right of the numbers of other limbs that
  /// begin there.
  Pixel number_place(const Sketch& sketch, std::size_t number) const {
    constexpr double kWidth = 9.0;
    const std::span<const SketchedJoint> joints = sketch.limbs[number];
    const Pixel first = at(joints.front().point);
    const auto second = std::ranges::find_if(
        joints, [&](const SketchedJoint& joint) { return !is_at(joint.point, joints.front().point); });
    const Pixel next = at(second == joints.end() ? sketch.platform : second->point);
    const bool above = next.y - first.y > std::abs(next.x - first.x);
    Pixel place{first.x - 4, above ? first.y - 13 : first.y + 20};
    for (std::size_t i = 0; i < number; ++i) {
      const Pixel other = at(sketch.limbs[i].front().point);
      if (std::hypot(other.x - first.x, other.y - first.y) < kWidth) place.x += kWidth;
    }
    return place;
  }

  /// Where the joints' glyphs stand: at their points. Several at one point stand in a row from there towards the next
  /// one, after the last joint towards the platform's origin; a slide that begins at another joint stands between the
  /// two that it connects.
  std::vector<Pixel> places_of(std::span<const SketchedJoint> joints, const SketchVector& platform) const {
    std::vector<Pixel> places;
    while (places.size() < joints.size()) {
      const std::size_t begin = places.size();
      std::size_t end = begin + 1;
      while (end < joints.size() && is_at(joints[end].point, joints[begin].point)) ++end;
      const Pixel next = at(end < joints.size() ? joints[end].point : platform);
      const Pixel here = at(joints[begin].point);
      const bool slides = end - begin > 1 && end < joints.size() && joints[end - 1].type == 'P';
      add_row(joints.subspan(begin, end - begin - (slides ? 1 : 0)), here, next, places);
      if (slides) places.push_back({(here.x + next.x) / 2, (here.y + next.y) / 2});
    }
    return places;
  }

  bool is_at(const SketchVector& a, const SketchVector& b) const {
    return scale_ * std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) < 1.0;
  }

  /// Towards `next` where the row is not longer than the way there, else to the right.
  static void add_row(std::span<const SketchedJoint> joints, Pixel here, Pixel next, std::vector<Pixel>& places) {
    double length = 0.0;
    for (std::size_t j = 1; j < joints.size(); ++j) length += half_space(joints[j - 1]) + half_space(joints[j]);
    const double way = std::hypot(next.x - here.x, next.y - here.y);
    const Pixel along = length < way ? Pixel{(next.x - here.x) / way, (next.y - here.y) / way} : Pixel{1.0, 0.0};
    double from = 0.0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (j > 0) from += half_space(joints[j - 1]) + half_space(joints[j]);
      places.push_back({here.x + from * along.x, here.y + from * along.y});
    }
  }

  std::string tick(const SketchedJoint& joint, Pixel middle, std::string_view colour) const {
    if (joint.type == 'S' || joint.type == 'F') return {};
    const Pixel along{dot(joint.axis, view_->right), -dot(joint.axis, view_->up)};
    return svg_line({middle.x - kTick * along.x, middle.y - kTick * along.y},
                    {middle.x + kTick * along.x, middle.y + kTick * along.y},
                    fmt::format("stroke=\"{}\" stroke-width=\"1\" stroke-dasharray=\"6 2 1 2\"", colour));
  }

  std::string joint_glyph(const SketchedJoint& joint, Pixel middle, std::string_view colour) const {
    std::string text = fmt::format("<g><title>{}</title>\n", escaped(name_words(joint)));
    if (joint.has_errors)
      text += svg_circle(middle, 1.7 * kGlyph, "fill=\"none\" stroke=\"#b3261e\" stroke-width=\"0.8\"");
    text += svg_glyph(joint.type, joint.actuated, middle, {colour});
    if (!joint.drive.empty()) {
      text += svg_text({middle.x + 2 * kGlyph, middle.y - kGlyph}, joint.drive, fmt::format("fill=\"{}\"", colour));
    }
    return text + "</g>\n";
  }

  const SketchView* view_;
  ViewExtent extent_;
  double scale_;
  Pixel corner_;
};

/// A round length of about a fifth of this one: 1, 2 or 5 times a power of ten.
double round_length(double size) {
  const double fifth = size / 5;
  const double power = std::pow(10.0, std::floor(std::log10(fifth)));
  const double share = fifth / power;
  return power * (share < 2 ? 1 : share < 5 ? 2 : 5);
}

std::string legend(Pixel at, double scale, double size) {
  const double length = round_length(size);
  std::string text = svg_line({at.x, at.y}, {at.x + scale * length, at.y}, "stroke=\"#1d222b\" stroke-width=\"2\"");
  text += svg_text({at.x + scale * length + 6, at.y + 4}, fmt::format("{:g} mm", 1e3 * length));
  double x = at.x + 170;
  constexpr std::array<std::string_view, 6> kNames{"R", "P", "H", "C", "U", "S"};
  for (const std::string_view name : kNames) {
    text += svg_glyph(name.front(), false, {x, at.y}, {"#1d222b"}) + svg_text({x + 11, at.y + 4}, name);
    x += 40;
  }
  text += svg_glyph('P', true, {x, at.y}, {"#1d222b"}) + svg_text({x + 11, at.y + 4}, "actuated");
  return text + svg_circle({x + 84, at.y}, 1.7 * kGlyph, "fill=\"none\" stroke=\"#b3261e\" stroke-width=\"0.8\"") +
         svg_text({x + 98, at.y + 4}, "frames with errors");
}

}  // namespace

std::string mechanism_picture(const Sketch& sketch, std::string_view title) {
  const std::vector<SketchVector> points = all_points(sketch);
  double size = 0.0;
  for (const SketchView& view : views()) size = std::max(size, extent(points, view).size);
  if (!(size > 0.0)) size = 1.0;
  const double scale = (kPanel - 2 * kMargin) / size;
  const std::vector<std::string> title_lines = wrapped(title, kTitleWidth);
  const double head = kHead + kTitleLine * static_cast<double>(std::max<std::size_t>(title_lines.size(), 1) - 1);
  const double width = 2 * kPanel;
  const double height = head + 2 * kPanel + kLegend;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
      "role=\"img\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n{3}\n<title>{2}</title>\n<rect width=\"{0:g}\" height=\"{1:g}\" "
      "fill=\"#ffffff\"/>\n",
      width, height, escaped(title), kPictureMark);
  for (std::size_t n = 0; n < title_lines.size(); ++n) {
    text += svg_text({8, 18 + kTitleLine * static_cast<double>(n)}, title_lines[n],
                     "font-weight=\"bold\" font-size=\"14\"");
  }
  for (std::size_t v = 0; v < views().size(); ++v) {
    const SketchView& view = views()[v];
    const Pixel corner{kPanel * static_cast<double>(v % 2), head + kPanel * static_cast<double>(v / 2)};
    text += ViewPanel(view, extent(points, view), scale, corner).drawing(sketch);
  }
  return text + legend({16, height - kLegend / 2}, scale, size) + "</svg>\n";
}

}  // namespace poesy
