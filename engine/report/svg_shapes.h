#pragma once

#include <span>
#include <string>
#include <string_view>

/// What pictures of mechanisms are drawn with, as elements of SVG. style, attributes: attributes as they stand.
namespace poesy {

/// A place in a picture.
struct Pixel {
  double x;  ///< to the right
  double y;  ///< downwards
};

std::string svg_line(Pixel a, Pixel b, std::string_view style);               ///< From one to the other.
std::string svg_circle(Pixel at, double radius, std::string_view style);      ///< Around a place.
std::string svg_path(std::span<const Pixel> points, std::string_view style);  ///< A closed one.
/// A text, escaped.
std::string svg_text(Pixel at, std::string_view text, std::string_view attributes = {});

inline constexpr double kGlyph = 6.0;  ///< Half of a joint's glyph, pixels.

/// R: circle; P: square; H: diamond; C: circle in a square; U: circle with a cross; S: circle in a circle; F: a dot.
/// Filled where a drive holds the joint. Lines are in the colour (CSS) of what it is in. paper: the colour of what is
/// not filled.
std::string svg_glyph(char type, bool actuated, Pixel at, std::string_view paper);

}  // namespace poesy
