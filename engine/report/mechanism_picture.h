#pragma once

#include <string>
#include <string_view>

#include "engine/model/sketch.h"

namespace poesy {

/// By which a picture is known as one of poesy's.
inline constexpr std::string_view kPictureMark = "<!-- picture of poesy -->";

/// The mechanism at home from the front, the side and above, and in space, as an SVG document: limbs in colours of
/// their own from the base to the platform, joints by the glyph of their kind, filled where a drive holds them, with a
/// tick along their axis; a ring around those whose frames have errors; a scale. All texts are escaped.
std::string mechanism_picture(const Sketch& sketch, std::string_view title);

}  // namespace poesy
