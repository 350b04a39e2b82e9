#pragma once

#include <span>
#include <vector>

#include "engine/model/model.h"
#include "models/three_prs/error_mapping.h"

namespace poesy::three_prs {

/// The two serial slides of the hybrid machine (San et al. 2023, Section 2: "two nominally orthogonal sliding
/// subsets"), in the order rack - X slide - Y slide - head. The paper does not say which slide carries the other, so
/// this order is a choice. The X slide moves along x of the rack's frame {O}, the Y slide along y. The paper prints no
/// travel; 0.6 m is a choice.
struct Travel {
  double x = 0.6;  ///< travel of the X slide, m: slide_x is from -x/2 to x/2
  double y = 0.6;  ///< travel of the Y slide, m: slide_y is from -y/2 to y/2
};

/// The index of the first component of each error of the slides. Vectors have three components (x, y, z); squareness is
/// a scalar. The value of an error is that at the commanded position of its slide. EXX and so on are the symbols of ISO
/// 230-1.
enum class SlideSource : std::size_t {
  x_translation = 0,  ///< translation errors of the X slide along x, y and z: EXX, EYX, EZX
  x_rotation = 3,     ///< rotation errors of the X slide about x, y and z: EAX, EBX, ECX
  y_translation = 6,  ///< translation errors of the Y slide along x, y and z: EXY, EYY, EZY
  y_rotation = 9,     ///< rotation errors of the Y slide about x, y and z: EAY, EBY, ECY
  squareness = 12     ///< C0Y: squareness error of the Y slide to the X slide, an angle about z
};
inline constexpr std::size_t kSlideFactors = 13;
using SlideErrors = std::span<const double, kSlideFactors>;

/// The errors `x_position` ... `squareness`, in the order of SlideSource; their descriptions contain the symbols of ISO
/// 230-1. The X slide counts as limb 4, the Y slide as limb 5. Their frames are numbered after those of the head:
/// translation and rotation of each slide, then squareness.
std::vector<Factor> slide_factors();

/// The exact displacement of the head's frame by the slides' errors: x -> R x + p maps coordinates of a point in the
/// head to coordinates in the nominal head frame, which is parallel to the rack's and has its origin at (slide_x,
/// slide_y, 0):
///     R = E_x E_y,  E = exp of a slide's rotation,
///     p = (EXX, EYX, EZX) + E_x Rz(C0Y) (EXY, slide_y + EYY, EZY) - (0, slide_y, 0).
/// Each slide rotates the parts that it carries about the origin of its carriage. The origin of the Y slide's carriage
/// is the origin of the head's frame; that of the X slide's carriage is the same point at slide_y = 0. Squareness
/// rotates the travel and straightness directions of the Y slide, but not the head, which is aligned on its carriage at
/// slide_y = 0.
lie::Transform<double> nominal_T_head(double slide_y, SlideErrors errors);

using SlideEffects = Eigen::Matrix<double, kSwing, static_cast<int>(kSlideFactors), Eigen::RowMajor>;

/// [9 x 13] The first-order effects of each error of the slides (rad, m per unit). The rows are the first nine of
/// Effects. P, tip: P and the tool tip in the head's frame at the nominal pose (m).
SlideEffects slide_effects(double slide_y, const lie::Vector3<double>& P, const lie::Vector3<double>& tip);

}  // namespace poesy::three_prs
