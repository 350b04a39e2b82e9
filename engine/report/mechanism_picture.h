#pragma once

#include <string>
#include <string_view>

#include "engine/model/sketch.h"

namespace poesy {

/// Identifies a picture that poesy wrote.
inline constexpr std::string_view kPictureMark = "<!-- picture of poesy -->";

/// The mechanism at home as an SVG document, seen from the front, the side and above, and in space. Each limb has its
/// own colour from the base to the platform. Joints have the glyph of their kind with a tick along their axis, filled
/// if a drive moves them; a ring surrounds joints whose frames have errors. Features of the drawing are bars along
/// axes, plates in planes, and dots, with their names and zones as titles. There is a scale bar. All texts are escaped.
std::string mechanism_picture(const Sketch& sketch, std::string_view title);

}  // namespace poesy
