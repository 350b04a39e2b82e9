#include "engine/report/sketch_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "engine/report/html/page.h"
#include "engine/report/sketch_words.h"
#include "engine/report/svg_shapes.h"

namespace poesy {
namespace {

constexpr std::size_t kBase = 0;      // index of the base among the bodies
constexpr std::size_t kPlatform = 1;  // index of the platform among the bodies
constexpr double kTick = 15.0;        // pixels, half the length of a joint's axis
constexpr double kAxis = 36.0;        // pixels, length of a frame's axes
constexpr double kThinnest = 2.0;     // pixels, width of a link whose errors have no share (PartShares)
constexpr double kThickest = 8.0;     // pixels, width of the link with the largest share (PartShares)
constexpr double kMillimetres = 1e3;  // millimetres in a metre
constexpr double kFlat = 1e-9;        // points are on one line if their hull is thinner than this share of its length
constexpr double kSamePoint = 1.0;    // pixels; joints that are closer share a point
constexpr double kAlong = 0.99;  // least cosine of the angle between a strut's axis and the line to the end of the limb
constexpr double kRing = 11.0;   // pixels, radius of the ring that shows a link without length
constexpr double kDigit = 9.0;   // pixels, width of a limb's number
constexpr double kArrow = 60.0;  // pixels, the longest arrow
constexpr double kTip = 3.5;     // pixels, radius of the end of an arrow
constexpr double kDot = 2.5;     // pixels, radius of a feature without size
constexpr std::array<std::string_view, 6> kLimbs{"#2563a8", "#b4541a", "#2f7d4f", "#8a3d8f", "#8a6d1b", "#3b7f8c"};

double distance(const SketchVector& a, const SketchVector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// Half of the space that a joint's glyph takes in a row, pixels.
double half_space(const SketchedJoint& joint) { return joint.type == 'F' ? kGlyph / 3 + 2 : kGlyph + 1; }

/// Points (m) as text in mm: "12.500,-3.000,0.000 ...".
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

double dot(const SketchVector& a, const SketchVector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// The corners of the convex hull of points that lie near a plane, in their order along the hull. Points on one line,
/// and fewer than four points, are returned unchanged.
std::vector<SketchVector> hull_of(const std::vector<SketchVector>& points) {
  if (points.size() < 4) return points;
  SketchVector centre{};
  for (const SketchVector& point : points) centre = plus(centre, 1.0 / static_cast<double>(points.size()), point);
  const auto from_centre = [&](const SketchVector& point) { return plus(point, -1.0, centre); };
  const auto length = [](const SketchVector& a) { return std::sqrt(dot(a, a)); };
  const auto longest = [&](const auto& vector_of) {
    return vector_of(
        *std::ranges::max_element(points, {}, [&](const SketchVector& p) { return length(vector_of(p)); }));
  };
  const SketchVector along = longest(from_centre);
  if (!(length(along) > 0.0)) return points;
  const SketchVector across = longest([&](const SketchVector& point) {
    const SketchVector from = from_centre(point);
    return plus(from, -dot(from, along) / dot(along, along), along);
  });
  if (!(length(across) > kFlat * length(along))) return points;
  struct Corner {
    double x;
    double y;
    const SketchVector* point;
  };
  std::vector<Corner> corners;
  for (const SketchVector& point : points) {
    const SketchVector from = from_centre(point);
    corners.push_back({dot(from, along) / length(along), dot(from, across) / length(across), &point});
  }
  std::ranges::sort(corners, {}, [](const Corner& corner) { return std::pair(corner.x, corner.y); });
  std::vector<SketchVector> hull;
  // First the lower side from left to right, afterwards the upper side from right to left (Andrew's monotone chain).
  for (int side = 0; side < 2; ++side) {
    std::vector<Corner> chain;
    for (const Corner& next : corners) {
      const auto turns_left = [&](const Corner& a, const Corner& b) {
        return (b.x - a.x) * (next.y - a.y) - (b.y - a.y) * (next.x - a.x) > 0.0;
      };
      while (chain.size() > 1 && !turns_left(chain[chain.size() - 2], chain.back())) chain.pop_back();
      chain.push_back(next);
    }
    for (std::size_t n = 0; n + 1 < chain.size(); ++n) hull.push_back(*chain[n].point);
    std::ranges::reverse(corners);
  }
  return hull;
}

/// Draws a mechanism as SVG text.
class Drawing {
 public:
  /// shares: shares of links and joints; null for a picture in a separate file (still_sketch()).
  Drawing(const Sketch& sketch, const SketchView& view, const PartShares* shares)
      : sketch_(&sketch), view_(&view), shares_(shares) {}

  std::string all(std::size_t mark) {
    bodies();
    for (std::size_t i = 0; i < sketch_->limbs.size(); ++i) limb(i);
    if (!sketch_->frames.empty()) {  // without frames, the places of features are not known
      for (const SketchedFeature& one : sketch_->features) feature(one);
    }
    if (mark < sketch_->errors.size()) frame(sketch_->errors[mark]);
    return std::move(text_);
  }

 private:
  bool is_still() const { return shares_ == nullptr; }

  static std::string points_attribute(std::span<const SketchVector> points) {
    return fmt::format("data-p=\"{}\"", numbers_of(points));
  }

  void add_line(const SketchVector& a, const SketchVector& b, std::string_view attributes) {
    const std::array ends{a, b};
    text_ += svg_line(view_->at(a), view_->at(b), fmt::format("{} {}", points_attribute(ends), attributes));
  }

  void add_path(std::span<const SketchVector> points, std::string_view attributes) {
    std::vector<Pixel> pixels;
    for (const SketchVector& point : points) pixels.push_back(view_->at(point));
    text_ += svg_path(pixels, fmt::format("{} {}", points_attribute(points), attributes));
  }

  /// Adds SVG content, and moves its origin to the pixel at which `point` (m, base frame) is seen.
  void add_group(const SketchVector& point, std::string_view attributes, std::string_view content) {
    const Pixel pixel = view_->at(point);
    text_ += fmt::format("<g transform=\"translate({:.1f} {:.1f})\" {} {}>{}</g>\n", pixel.x, pixel.y,
                         points_attribute({&point, 1}), attributes, content);
  }

  void add_text(const SketchVector& point, Pixel offset, std::string_view what, std::string_view attributes) {
    add_group(point, attributes, svg_text(offset, what));
  }

  /// Draws the axes of the base frame, the outlines of the bodies through their joints, and lines from the platform's
  /// origin to the tool and to the named points.
  void bodies() {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      SketchVector end{};
      end[axis] = view_->metres(kAxis);
      if (is_still() && view_->distance({}, end) < 2.0) continue;
      add_line({}, end, "class=\"frame-axis\"");
      add_text(end, {3, -3}, std::string(1, "xyz"[axis]), "class=\"frame-name\"");
    }
    add_path(hull_of(joints_at(kBase)), "class=\"base\"");
    add_path(hull_of(joints_at(kPlatform)), "class=\"platform\"");
    for (std::size_t b = kPlatform + 1; b < sketch_->bodies.size(); ++b)
      add_path(hull_of(joints_at(b)), "class=\"platform\"");
    if (is_still()) add_text(sketch_->platform, {5, -5}, "P", "class=\"frame-name\"");
    for (const SketchVector& tip : sketch_->tool) {
      add_line(sketch_->platform, tip, "class=\"tool\"");
      add_text(tip, {5, 4}, "tool", "class=\"frame-name\"");
    }
    for (const SketchedPoint& point : sketch_->points) {
      add_line(sketch_->platform, point.point, "class=\"tool\"");
      add_text(point.point, {5, 4}, point.name, "class=\"frame-name\"");
    }
  }

  bool share_point(const SketchedJoint& a, const SketchedJoint& b) const {
    return distance(a.point, b.point) < view_->metres(kSamePoint);
  }

  /// Returns true if a limb ends with a strut, which is a prismatic joint that begins at the joint before it and points
  /// to the end of the limb. The point of such a joint is where the strut begins, which is not where the limb holds the
  /// body. last: end of the limb.
  bool ends_with_strut(std::span<const SketchedJoint> joints, const SketchVector& last) const {
    if (joints.size() < 2 || joints.back().type != 'P') return false;
    const SketchVector way = plus(last, -1.0, joints.back().point);
    const double length = std::sqrt(dot(way, way));
    return share_point(joints[joints.size() - 2], joints.back()) && length > view_->metres(kSamePoint) &&
           std::abs(dot(way, joints.back().axis)) > kAlong * length;
  }

  /// The points where limbs hold a body: the limbs' first or last joints, or the body's origin if a limb ends with a
  /// strut.
  std::vector<SketchVector> joints_at(std::size_t body) const {
    std::vector<SketchVector> points;
    for (std::size_t i = 0; i < sketch_->limbs.size(); ++i) {
      const std::vector<SketchedJoint>& joints = sketch_->limbs[i];
      const SketchedEnds ends = sketch_->ends_of(i);
      if (ends.from == body) points.push_back(joints.front().point);
      if (ends.to != body) continue;
      const bool has_strut = body != kBase && ends_with_strut(joints, middle_of(body));
      points.push_back(has_strut ? middle_of(body) : joints.back().point);
    }
    return points;
  }

  /// The point from which lines to a body's joints are drawn: the mean position of the base's joints for the base, and
  /// the body's origin for any other body.
  SketchVector middle_of(std::size_t body) const {
    if (body == kPlatform) return sketch_->platform;
    if (body != kBase) return sketch_->bodies[body].origin;
    SketchVector sum{};
    const std::vector<SketchVector> points = joints_at(kBase);
    for (const SketchVector& point : points) sum = plus(sum, 1.0, point);
    return plus({}, 1.0 / static_cast<double>(points.size()), sum);
  }

  /// Draws the links and joints of a limb. If the ends of a link with errors coincide, a ring is drawn, so that the
  /// colour of the link can be seen.
  void limb(std::size_t i) {
    const std::vector<SketchedJoint>& joints = sketch_->limbs[i];
    const SketchedEnds ends = sketch_->ends_of(i);
    std::vector<SketchVector> places = places_of(joints, middle_of(ends.to));
    places.insert(places.begin(), middle_of(ends.from));
    places.push_back(middle_of(ends.to));
    if (is_still()) text_ += fmt::format("<g color=\"{}\">\n", kLimbs[i % kLimbs.size()]);
    const bool has_strut = ends_with_strut(joints, places.back());
    for (std::size_t j = 0; j + 1 < places.size(); ++j) {
      const bool is_of_body = j == 0 || (j == joints.size() && !has_strut);
      add_line(places[j], places[j + 1],
               fmt::format("class=\"link{}\" data-limb=\"{}\" {}", is_of_body ? " body" : "", i + 1,
                           share_style(&PartShares::links, i, j)));
      if (!is_still() && shares_->links[i][j] > 0.0 && distance(places[j], places[j + 1]) < view_->metres(kSamePoint)) {
        add_group(places[j],
                  fmt::format("class=\"link short\" data-limb=\"{}\" {}", i + 1, share_style(&PartShares::links, i, j)),
                  svg_circle({0, 0}, kRing, "fill=\"none\""));
      }
    }
    for (std::size_t j = 0; j < joints.size(); ++j) joint(i, j, places[j + 1]);
    number(i, places[1], places[2]);
    if (is_still()) text_ += "</g>\n";
  }

  /// Draws a limb's number below the first joint, or above it if the limb goes downwards. Numbers of limbs that begin
  /// at the same place are side by side.
  void number(std::size_t i, const SketchVector& place, const SketchVector& next) {
    const std::span others(sketch_->limbs.data(), i);
    const auto is_here = [&](const auto& limb) { return view_->distance(limb.front().point, place) < kDigit; };
    const double right = kDigit * static_cast<double>(std::ranges::count_if(others, is_here));
    const Pixel way{view_->at(next).x - view_->at(place).x, view_->at(next).y - view_->at(place).y};
    add_text(place, {right - 4, way.y > std::abs(way.x) ? -13.0 : 20.0}, std::to_string(i + 1), "class=\"limb-name\"");
  }

  void joint(std::size_t i, std::size_t j, const SketchVector& place) {
    const SketchedJoint& joint = sketch_->limbs[i][j];
    if (joint.type != 'S' && joint.type != 'F') {
      add_line(plus(place, -view_->metres(kTick), joint.axis), plus(place, view_->metres(kTick), joint.axis),
               "class=\"tick\"");
    }
    if (!is_still() && shares_->arrows[i][j] > 0.0) arrow(place, shares_->arrows[i][j], joint.axis);
    const std::string name = joint_words(*sketch_, i, j + 1) + (joint.name.empty() ? "" : " " + name_words(joint));
    std::string content = element("title", fmt::format("limb {}, {}", i + 1, name));
    if (is_still() && joint.has_errors) content += svg_circle({0, 0}, 1.7 * kGlyph, "class=\"errors\"");
    content += svg_glyph(joint.type, joint.actuated, {0, 0}, is_still() ? "#ffffff" : "var(--paper)");
    if (is_still() && !joint.drive.empty()) {
      content += svg_text({2 * kGlyph, -kGlyph}, joint.drive, "class=\"drive\"");
    }
    add_group(place,
              fmt::format("class=\"joint\" data-limb=\"{}\" data-joint=\"{}\" data-at=\"{}\" {}", i + 1, j + 1,
                          numbers_of({&joint.point, 1}), share_style(&PartShares::joints, i, j)),
              content);
  }

  /// Draws an arrow as a line that ends in a dot.
  void arrow(const SketchVector& from, double share, const SketchVector& axis) {
    const SketchVector tip = plus(from, view_->metres(kArrow * share), axis);
    add_line(from, tip, "class=\"arrow\"");
    add_group(tip, "class=\"arrow-tip\"", svg_circle({0, 0}, kTip, ""));
  }

  /// The style of a link or joint: the line width, and on a page also the share in percent of the largest share, by
  /// which the page chooses the colour.
  std::string share_style(std::vector<std::vector<double>> PartShares::*parts, std::size_t i, std::size_t j) const {
    if (is_still()) return fmt::format("stroke-width=\"{:.1f}\"", kThinnest);
    const double part = shares_->largest > 0.0 ? (shares_->*parts)[i][j] / shares_->largest : 0.0;
    return fmt::format("style=\"--share:{:.0f}%\" stroke-width=\"{:.1f}\"", 100.0 * part,
                       kThinnest + (kThickest - kThinnest) * part);
  }

  /// The places of the joints' glyphs. Joints that share a point form a row there. If the last joint of such a row is
  /// prismatic, it is drawn halfway to the next joint, or halfway to the end of the limb if the limb ends with a strut.
  /// last: end of the limb.
  std::vector<SketchVector> places_of(std::span<const SketchedJoint> joints, const SketchVector& last) const {
    std::vector<SketchVector> places;
    while (places.size() < joints.size()) {
      const std::size_t begin = places.size();
      std::size_t end = begin + 1;
      while (end < joints.size() && share_point(joints[end], joints[begin])) ++end;
      const SketchVector& here = joints[begin].point;
      const SketchVector& next = end < joints.size() ? joints[end].point : last;
      const bool slides =
          end - begin > 1 && joints[end - 1].type == 'P' && (end < joints.size() || ends_with_strut(joints, last));
      add_row(joints.subspan(begin, end - begin - (slides ? 1 : 0)), next, places);
      if (slides) places.push_back(middle(here, next));
    }
    return places;
  }

  /// Places joints that share a point in a row: towards `next` if there is room, otherwise to the right.
  void add_row(std::span<const SketchedJoint> row, const SketchVector& next, std::vector<SketchVector>& places) const {
    const SketchVector& here = row.front().point;
    std::vector<double> offsets{0.0};
    for (std::size_t j = 1; j < row.size(); ++j) {
      offsets.push_back(offsets.back() + half_space(row[j - 1]) + half_space(row[j]));
    }
    const double way = view_->distance(here, next);
    const SketchVector pixel = offsets.back() < way ? plus({}, 1.0 / way, plus(next, -1.0, here))
                                                    : plus({}, view_->metres(1.0), view_->right());
    for (const double offset : offsets) places.push_back(plus(here, offset, pixel));
  }

  /// Draws a feature: a bar for two points (an axis), a plate for more (a plane), a dot for one.
  void feature(const SketchedFeature& feature) {
    const SketchedFrame& frame = sketch_->frames[feature.limb][feature.frame];
    std::vector<SketchVector> points;
    for (const SketchVector& inside : feature.outline) {
      SketchVector& point = points.emplace_back(frame.origin);
      for (std::size_t axis = 0; axis < 3; ++axis) point = plus(point, inside[axis], frame.axes[axis]);
    }
    const std::string zones = feature.zones.empty() ? "" : ": " + feature.zones;
    text_ += "<g class=\"feature\">" +
             element("title", fmt::format("{} of limb {}{}", feature.name, feature.limb + 1, zones)) + "\n";
    if (points.size() == 1) {
      add_group(points.front(), "class=\"dot\"", svg_circle({0, 0}, kDot, ""));
    } else if (points.size() == 2) {
      add_line(points[0], points[1], "class=\"bar\"");
    } else {
      add_path(points, "class=\"plate\"");
    }
    text_ += "</g>\n";
  }

  /// Draws the frame of an error. The axis of the error is thicker than the other two. Of an error's own frame only
  /// this axis is drawn.
  void frame(const SketchedError& error) {
    const SketchedFrame& frame = error.own ? error.own->frame : sketch_->frames[error.limb][error.frame];
    text_ += "<g class=\"marked\">";
    if (error.own) {
      add_line(frame.origin, plus(frame.origin, view_->metres(1.5 * kAxis), frame.axes[2]), "class=\"error-axis\"");
    }
    for (std::size_t axis = 0; axis < 3 && !error.own; ++axis) {
      const SketchVector end =
          plus(frame.origin, view_->metres(axis == error.axis ? 1.5 * kAxis : kAxis), frame.axes[axis]);
      add_line(frame.origin, end, axis == error.axis ? "class=\"error-axis\"" : "class=\"other-axis\"");
      add_text(end, {4, -4}, std::string(1, "xyz"[axis]), "class=\"error-name\"");
    }
    text_ += "</g>\n";
  }

  const Sketch* sketch_;
  const SketchView* view_;
  const PartShares* shares_;
  std::string text_;
};

}  // namespace

PartShares::PartShares(const Sketch& sketch) {
  for (const auto& limb : sketch.limbs) {
    links.emplace_back(limb.size() + 1, 0.0);
    joints.emplace_back(limb.size(), 0.0);
    arrows.emplace_back(limb.size(), 0.0);
  }
}

std::string turnable_sketch(const Sketch& sketch, const SketchView& view, const PartShares& shares, std::size_t mark) {
  return Drawing(sketch, view, &shares).all(mark);
}

std::string still_sketch(const Sketch& sketch, const SketchView& view) {
  return Drawing(sketch, view, nullptr).all(sketch.errors.size());
}

}  // namespace poesy
