#include "engine/report/svg_shapes.h"

#include <fmt/format.h>

#include <array>

#include "engine/report/html/page.h"

namespace poesy {
namespace {

std::string square(Pixel at, double half, std::string_view style) {
  const std::array<Pixel, 4> corners{Pixel{at.x - half, at.y - half},
                                     {at.x + half, at.y - half},
                                     {at.x + half, at.y + half},
                                     {at.x - half, at.y + half}};
  return svg_path(corners, style);
}

std::string diamond(Pixel at, double half, std::string_view style) {
  const std::array<Pixel, 4> corners{
      Pixel{at.x - half, at.y}, {at.x, at.y - half}, {at.x + half, at.y}, {at.x, at.y + half}};
  return svg_path(corners, style);
}

}  // namespace

std::string svg_line(Pixel a, Pixel b, std::string_view style) {
  return fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>\n", a.x, a.y, b.x, b.y, style);
}

std::string svg_circle(Pixel at, double radius, std::string_view style) {
  return fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}/>\n", at.x, at.y, radius, style);
}

std::string svg_path(std::span<const Pixel> points, std::string_view style) {
  std::string text = "<path d=\"";
  for (const Pixel& point : points)
    text += fmt::format("{}{:.1f} {:.1f}", text.back() == '"' ? "M" : "L", point.x, point.y);
  return text + fmt::format("Z\" {}/>\n", style);
}

std::string svg_text(Pixel at, std::string_view text, std::string_view attributes) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" {}>{}</text>\n", at.x, at.y, attributes, escaped(text));
}

std::string svg_picture(const std::string& id, Pixel size, std::string_view title, std::string_view description,
                        std::string_view drawn) {
  return fmt::format(
      "<svg id=\"{0}\" xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {1:g} {2:g}\" role=\"img\" "
      "aria-labelledby=\"{0}-title {0}-desc\">\n{3}\n{4}\n{5}</svg>\n",
      id, size.x, size.y, element("title", title, fmt::format("id=\"{}-title\"", id)),
      element("desc", description, fmt::format("id=\"{}-desc\"", id)), drawn);
}

std::string svg_glyph(char type, bool actuated, Pixel at, std::string_view paper) {
  const std::string style =
      fmt::format("fill=\"{}\" stroke=\"currentColor\" stroke-width=\"1.6\"", actuated ? "currentColor" : paper);
  const std::string inner =
      fmt::format("fill=\"none\" stroke=\"{}\" stroke-width=\"1.2\"", actuated ? paper : "currentColor");
  constexpr double kArm = 0.7 * kGlyph;
  switch (type) {
    case 'P':
      return square(at, kGlyph, style);
    case 'H':
      return diamond(at, 1.3 * kGlyph, style);
    case 'C':
      return square(at, kGlyph, style) + svg_circle(at, 0.65 * kGlyph, inner);
    case 'U':
      return svg_circle(at, kGlyph, style) + svg_line({at.x - kArm, at.y - kArm}, {at.x + kArm, at.y + kArm}, inner) +
             svg_line({at.x - kArm, at.y + kArm}, {at.x + kArm, at.y - kArm}, inner);
    case 'S':
      return svg_circle(at, kGlyph, style) + svg_circle(at, kGlyph / 2, inner);
    case 'F':
      return svg_circle(at, kGlyph / 3, style);
    default:
      return svg_circle(at, kGlyph, style);
  }
}

}  // namespace poesy
