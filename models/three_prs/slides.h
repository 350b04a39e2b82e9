#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/error_mapping.h"

namespace poesy::three_prs {

/// The two serial slides of the hybrid machine (San et al. 2023, Section 2: "two nominally orthogonal sliding
/// subsets"), as rack - X slide - Y slide - head. The paper does not say which slide carries which; this order is
/// chosen. The X slide moves along x of the rack's frame {O}, the Y slide along y. The paper prints no travel; 0.6 m is
/// chosen.
struct Travel {
  double x = 0.6;  ///< m, from -x/2 to x/2
  double y = 0.6;  ///< m, from -y/2 to y/2
};

/// Where the errors of the slides stand among theirs: vectors by their components x, y, z, and a scalar. Each is the
/// error at the commanded position of its slide.
enum class SlideSource : std::size_t {
  x_translation = 0,  ///< EXX, EYX, EZX
  x_rotation = 3,     ///< EAX, EBX, ECX
  y_translation = 6,  ///< EXY, EYY, EZY
  y_rotation = 9,     ///< EAY, EBY, ECY
  squareness = 12     ///< C0Y, angle by which the Y slide's travel is turned about z out of square with the X slide's
};
inline constexpr std::size_t kSlideFactors = 13;
using SlideErrors = std::span<const double, kSlideFactors>;

/// x_position ... squareness, in the order of SlideSource, with the symbols of ISO 230-1 in their descriptions. The X
/// slide counts as limb 4, the Y slide as limb 5; frames go on after the head's: translation, rotation, squareness.
std::vector<Factor> slide_factors();

/// The head's frame as the slides' errors displace it, exactly: x -> R x + p takes head coordinates of a point to what
/// they are in the frame where the head should stand, parallel to the rack's, with its origin at (slide_x, slide_y, 0):
///   R = E_x E_y,  E = exp of a slide's rotation,
///   p = (EXX, EYX, EZX) + E_x Rz(C0Y) (EXY, slide_y + EYY, EZY) - (0, slide_y, 0).
/// Each slide turns what it carries about the origin of its carriage, which is the origin of the head's frame at
/// slide_y = 0 (X slide), or at any slide_y (Y slide). Squareness turns the direction of travel and of straightness of
/// the Y slide, not the head, which is aligned on its carriage at slide_y = 0.
lie::Transform<double> nominal_T_head(double slide_y, SlideErrors errors);

using SlideEffects = Eigen::Matrix<double, kSwing, static_cast<int>(kSlideFactors), Eigen::RowMajor>;

/// What each error of the slides does to first order, [9 x 13], rows as the first nine of Effects; P and the tool tip
/// in the head's frame at the nominal pose.
SlideEffects slide_effects(double slide_y, const lie::Vector3<double>& P, const lie::Vector3<double>& tip);

}  // namespace poesy::three_prs
