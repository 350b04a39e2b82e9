#pragma once

#include <span>
#include <string>
#include <string_view>

/// Shapes for pictures of mechanisms, as SVG elements. style, attributes: SVG attributes, not escaped.
namespace poesy {

/// A point of a picture.
struct Pixel {
  double x;  ///< to the right
  double y;  ///< downwards
};

std::string svg_line(Pixel a, Pixel b, std::string_view style);               ///< A line between two points.
std::string svg_circle(Pixel at, double radius, std::string_view style);      ///< A circle around a point.
std::string svg_path(std::span<const Pixel> points, std::string_view style);  ///< A closed path.
/// A text, which is escaped.
std::string svg_text(Pixel at, std::string_view text, std::string_view attributes = {});

inline constexpr double kGlyph = 6.0;  ///< Half the size of a joint's glyph, pixels.

/// The glyph of a joint. R: circle; P: square; H: diamond; C: circle in a square; U: circle with a cross; S: circle in
/// a circle; F: a dot. It is filled if the joint is actuated. Lines have the CSS colour of the enclosing element.
/// paper: the colour of unfilled areas.
std::string svg_glyph(char type, bool actuated, Pixel at, std::string_view paper);

}  // namespace poesy
