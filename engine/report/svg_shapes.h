#pragma once

#include <span>
#include <string>
#include <string_view>

/// Shapes for pictures of mechanisms, as SVG elements. The arguments `style` and `attributes` are SVG attributes and
/// are not escaped.
namespace poesy {

/// A point of a picture, pixels.
struct Pixel {
  double x;  ///< distance from the left side
  double y;  ///< distance from the upper side
};

std::string svg_line(Pixel a, Pixel b, std::string_view style);               ///< A line between two points.
std::string svg_circle(Pixel at, double radius, std::string_view style);      ///< A circle around a point.
std::string svg_path(std::span<const Pixel> points, std::string_view style);  ///< A closed path.
/// A text element; the function escapes the text.
std::string svg_text(Pixel at, std::string_view text, std::string_view attributes = {});

/// A picture of this size as one SVG element, with a title and a description for screen readers. id: unique on the
/// page. drawn: SVG content.
std::string svg_picture(const std::string& id, Pixel size, std::string_view title, std::string_view description,
                        std::string_view drawn);

inline constexpr double kGlyph = 6.0;  ///< Half the size of a joint's glyph, pixels.

/// The glyph of a joint by its type. R (revolute): circle; P (prismatic): square; H (helical): diamond; C
/// (cylindrical): circle in a square; U (universal): circle with a cross; S (spherical): circle in a circle; F (fixed):
/// dot. The glyph of an actuated joint is filled. Lines have the CSS colour of the enclosing element. paper: the colour
/// of areas that are not filled.
std::string svg_glyph(char type, bool actuated, Pixel at, std::string_view paper);

}  // namespace poesy
