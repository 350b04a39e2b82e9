#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/sketch.h"
#include "engine/report/sketch_view.h"

namespace poesy {

/// Shares of the errors by parts of the mechanism. A link is between two consecutive joints; the base counts as joint 0
/// and the platform as the joint after the last.
struct PartShares {
  std::vector<std::vector<double>> links;   ///< [limbs][joints + 1]
  std::vector<std::vector<double>> joints;  ///< [limbs][joints] errors between the axes of one joint
  double largest = 0.0;                     ///< largest of all; 0: there are no shares

  /// Zero shares for a mechanism.
  explicit PartShares(const Sketch& sketch);
};

/// A mechanism as SVG elements in a picture of kSketchWidth x kSketchHeight: links, and glyphs of joints
/// (svg_shapes.h), side by side if joints share a point, and the features of the drawing with their names and zones as
/// titles. Each part has its points (mm, base frame) as data-p="x,y,z
/// x,y,z". A joint also has its own point as data-at, with data-limb and data-joint.
/// @{
/// For a page that sets colours and turns the picture: links and joints are as thick as their shares, which are in the
/// CSS variable --share, from 0 % to 100 % of the largest. mark: position of the error whose frame is drawn; a position
/// beyond the errors draws none.
std::string turnable_sketch(const Sketch& sketch, const SketchView& view, const PartShares& shares, std::size_t mark);
/// For a separate picture with the style sheet kSketchStyle: each limb has a colour, joints whose frames have errors
/// have a ring, and drives have their names.
std::string still_sketch(const Sketch& sketch, const SketchView& view);
/// @}

/// The style sheet of a separate picture.
inline constexpr std::string_view kSketchStyle =
    "<style>.link,.tick{stroke:currentColor}.link{stroke-linecap:round}.body{stroke-opacity:.35}"
    ".tick{stroke-dasharray:6 2 1 2}.frame-axis,.base{stroke:#8b93a1}.tool,.platform{stroke:#5a6270;stroke-width:1.5}"
    ".base,.platform{fill:#8b93a1;fill-opacity:.1}.base{stroke-dasharray:4 3}.frame-name{fill:#5a6270}"
    ".limb-name,.drive{fill:currentColor}.errors{fill:none;stroke:#b3261e;stroke-width:.8}</style>\n";

/// The style sheet of the features in it.
inline constexpr std::string_view kFeatureStyle =
    "<style>.feature{stroke:#6b4fa0;fill:#6b4fa0}.bar{stroke-width:3.5;stroke-opacity:.75;stroke-linecap:butt}"
    ".plate{fill-opacity:.25}.dot{stroke:none}</style>\n";

}  // namespace poesy
