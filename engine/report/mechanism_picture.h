#pragma once

#include <string>
#include <string_view>

#include "engine/model/sketch.h"

namespace poesy {

/// A comment in the file by which poesy recognises pictures that it wrote.
inline constexpr std::string_view kPictureMark = "<!-- picture of poesy -->";

/// The mechanism at its home pose as an SVG document, seen from the front, from the side, from above, and in space.
/// Each limb has its own colour. A joint has the glyph of its type, filled if a drive moves the joint, and a tick along
/// its axis. A ring surrounds joints whose frames have errors. Features of the drawing are bars along axes, plates in
/// planes, and dots; a tooltip gives the name and the zones of a feature. There is a scale bar. All texts are escaped.
std::string mechanism_picture(const Sketch& sketch, std::string_view title);

}  // namespace poesy
