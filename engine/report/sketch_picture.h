#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/sketch.h"
#include "engine/report/sketch_view.h"

namespace poesy {

/// Shares of the errors, summed for each link and joint of the mechanism. In a picture of forces, each link and joint
/// has the force of its limb (SI) instead of a share. A link is between two consecutive joints of a limb, between the
/// base and the first joint, or between the last joint and the platform.
struct PartShares {
  std::vector<std::vector<double>> links;   ///< [limbs][joints + 1] share of each link
  std::vector<std::vector<double>> joints;  ///< [limbs][joints] share of the errors between the axes of each joint
  double largest = 0.0;                     ///< largest share of all links and joints; 0: there are no shares
  /// [limbs][joints] length of the arrow along each joint's axis, relative to the longest arrow; 0: no arrow.
  std::vector<std::vector<double>> arrows;

  /// Makes shares of zero for all links and joints of a mechanism.
  explicit PartShares(const Sketch& sketch);
};

/// A mechanism as SVG elements in a picture of kSketchWidth x SketchView::height. It has links, glyphs of joints
/// (svg_shapes.h), and the features of the drawing with their names and zones as tooltips. Joints that share a point
/// are drawn side by side. Each element has its points (mm, base frame) in the attribute data-p="x,y,z x,y,z". The
/// element of a joint also has the joint's true point in data-at, and the attributes data-limb and data-joint.
/// @{
/// The picture for a page that sets colours and turns the picture. The width of links grows with their shares, and the
/// CSS variable --share of links and joints is their share in percent of the largest share. mark: index of the error
/// whose frame is drawn; with an index beyond the errors, no frame is drawn.
std::string turnable_sketch(const Sketch& sketch, const SketchView& view, const PartShares& shares, std::size_t mark);
/// The picture for a separate file, with the style sheet kSketchStyle. Each limb has a colour, a ring marks joints
/// whose frames have errors, and drives have their names.
std::string still_sketch(const Sketch& sketch, const SketchView& view);
/// @}

/// The style sheet of a picture in a separate file.
inline constexpr std::string_view kSketchStyle =
    "<style>.link,.tick{stroke:currentColor}.link{stroke-linecap:round}.body{stroke-opacity:.35}"
    ".tick{stroke-dasharray:6 2 1 2}.frame-axis,.base{stroke:#8b93a1}.tool,.platform{stroke:#5a6270;stroke-width:1.5}"
    ".base,.platform{fill:#8b93a1;fill-opacity:.1}.base{stroke-dasharray:4 3}.frame-name{fill:#5a6270}"
    ".limb-name,.drive{fill:currentColor}.errors{fill:none;stroke:#b3261e;stroke-width:.8}</style>\n";

/// The style sheet of the features of a drawing in a picture of the mechanism.
inline constexpr std::string_view kFeatureStyle =
    "<style>.feature{stroke:#6b4fa0;fill:#6b4fa0}.bar{stroke-width:3.5;stroke-opacity:.75;stroke-linecap:butt}"
    ".plate{fill-opacity:.25}.dot{stroke:none}</style>\n";

}  // namespace poesy
