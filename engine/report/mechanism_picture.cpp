#include "engine/report/mechanism_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "engine/base/text.h"
#include "engine/report/html/page.h"
#include "engine/report/sketch_picture.h"
#include "engine/report/svg_shapes.h"

namespace poesy {
namespace {

constexpr double kHead = 26.0;  // pixels above the views, for a title of one line
constexpr double kTitleLine = 18.0;
constexpr std::size_t kTitleWidth = 100;  // characters in a line of the title
constexpr double kLegend = 44.0;          // pixels below the views, for the legend
constexpr std::string_view kInk = "color=\"#1d222b\"";

/// A direction from which the mechanism is seen; see SketchView.
struct Direction {
  std::string name;
  double yaw;    ///< angle about the base's z axis, deg
  double pitch;  ///< angle at which the reader looks down, deg
};

std::array<Direction, 4> directions(bool z_is_down) {
  const std::string_view upwards = z_is_down ? "down" : "up";
  return {{{fmt::format("front: x to the right, z {}", upwards), 0.0, 0.0},
           {fmt::format("side: y to the right, z {}", upwards), z_is_down ? 90.0 : -90.0, 0.0},
           {fmt::format("above: x to the right, y {}", upwards), 0.0, 90.0},
           {"in space", kSketchYaw, kSketchPitch}}};
}

/// The legend of the picture, with a scale bar. scale: pixels per metre.
std::string legend(Pixel at, double scale, bool has_features) {
  const double length = rounded_down(kSketchWidth / 5 / scale);
  std::string text = svg_line({at.x, at.y}, {at.x + scale * length, at.y}, "stroke=\"#1d222b\" stroke-width=\"2\"");
  text += svg_text({at.x + scale * length + 6, at.y + 4}, fmt::format("{:g} mm", 1e3 * length));
  double x = at.x + 230;
  for (const std::string_view name : {"R", "P", "H", "C", "U", "S"}) {
    text += svg_glyph(name.front(), false, {x, at.y}, "#ffffff") + svg_text({x + 11, at.y + 4}, name);
    x += 40;
  }
  text += svg_glyph('P', true, {x, at.y}, "#ffffff") + svg_text({x + 11, at.y + 4}, "actuated");
  text += svg_circle({x + 84, at.y}, 1.7 * kGlyph, "class=\"errors\"");
  text += svg_text({x + 98, at.y + 4}, "frames with errors");
  if (has_features) {
    x += 222;
    text += "<g class=\"feature\">" + svg_line({x, at.y}, {x + 20, at.y}, "class=\"bar\"") + "</g>\n" +
            svg_text({x + 26, at.y + 4}, "features");
  }
  return fmt::format("<g {}>\n{}</g>\n", kInk, text);
}

}  // namespace

std::string mechanism_picture(const Sketch& sketch, std::string_view title) {
  const std::array<Direction, 4> all = directions(sketch.z_is_down);
  std::array<SketchView, 4> views;
  std::ranges::transform(all, views.begin(), [&](const Direction& direction) {
    return sketch_view({&sketch, 1}, direction.yaw, direction.pitch);
  });
  const double scale = std::ranges::min(views, {}, &SketchView::scale).scale;
  const std::vector<std::string> title_lines = wrapped(title, kTitleWidth);
  const double head = kHead + kTitleLine * static_cast<double>(std::max<std::size_t>(title_lines.size(), 1) - 1);
  const bool has_features = !sketch.features.empty();
  const std::string style = std::string(kSketchStyle) + std::string(has_features ? kFeatureStyle : "");
  const double height = head + 2 * kSketchHeight + kLegend;
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" height=\"{1:g}\" "
      "role=\"img\" font-family=\"sans-serif\" font-size=\"12\">\n{2}\n{3}\n{4}<rect width=\"{0:g}\" "
      "height=\"{1:g}\" fill=\"#ffffff\"/>\n",
      2 * kSketchWidth, height, kPictureMark, element("title", title), style);
  for (std::size_t n = 0; n < title_lines.size(); ++n) {
    text += svg_text({8, 18 + kTitleLine * static_cast<double>(n)}, title_lines[n],
                     "font-weight=\"bold\" font-size=\"14\"");
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    views[v].scale = scale;
    text += fmt::format("<g transform=\"translate({:g} {:g})\">\n{}{}</g>\n", kSketchWidth * static_cast<double>(v % 2),
                        head + kSketchHeight * static_cast<double>(v / 2),
                        svg_text({8, 16}, all[v].name, "fill=\"#5a6270\""), still_sketch(sketch, views[v]));
  }
  return text + legend({16, height - kLegend / 2}, scale, has_features) + "</svg>\n";
}

}  // namespace poesy
