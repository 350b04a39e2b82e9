#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/model/sketch.h"
#include "engine/report/sketch_view.h"

namespace poesy {

/// Shares of what errors do, by the parts of the mechanism where they are. Links are between two joints, of which 0 is
/// the base and one more than there are joints is the platform.
struct PartShares {
  std::vector<std::vector<double>> links;   ///< [limbs][joints + 1]
  std::vector<std::vector<double>> joints;  ///< [limbs][joints] between the axes of one joint
  double largest = 0.0;                     ///< of all of these; 0: nothing is shared

  /// Zeros for a mechanism.
  explicit PartShares(const Sketch& sketch);
};

/// A mechanism as elements of SVG in a picture of kSketchWidth x kSketchHeight: links and joints, glyphs of joints
/// (svg_shapes.h) beside each other where joints share a point. Each part has its points (mm, base frame) as
/// data-p="x,y,z x,y,z", a joint also its own as data-at, with data-limb and data-joint.
/// @{
/// For a page that sets colours and turns the picture: links and joints are as thick as their shares, which they have
/// as CSS variable --share from 0 % to 100 % of the largest. mark: position of an error whose frame is drawn; beyond
/// the errors: none.
std::string turnable_sketch(const Sketch& sketch, const SketchView& view, const PartShares& shares, std::size_t mark);
/// For a picture of its own, with the style sheet kSketchStyle: limbs in colours of their own, a ring around joints
/// whose frames have errors, the names of drives.
std::string still_sketch(const Sketch& sketch, const SketchView& view);
/// @}

/// The style sheet of a picture of its own.
inline constexpr std::string_view kSketchStyle =
    "<style>.link,.tick{stroke:currentColor}.link{stroke-linecap:round}.body{stroke-opacity:.35}"
    ".tick{stroke-dasharray:6 2 1 2}.frame-axis,.base{stroke:#8b93a1}.tool,.platform{stroke:#5a6270;stroke-width:1.5}"
    ".base,.platform{fill:#8b93a1;fill-opacity:.1}.base{stroke-dasharray:4 3}.frame-name{fill:#5a6270}"
    ".limb-name,.drive{fill:currentColor}.errors{fill:none;stroke:#b3261e;stroke-width:.8}</style>\n";

}  // namespace poesy
