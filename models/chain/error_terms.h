#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace poesy::chain {

/// A joint displacement to which an error is proportional, such as the travel of a slide whose error grows with the
/// travel.
struct JointWay {
  std::size_t joint;  ///< index among the joints of all limbs
  double from;        ///< displacement of the joint at which the error is zero (rad, m)
};

/// The contribution of an error to a component of a fixed frame's error: component += at(displacements) x error.
struct ErrorTerm {
  std::size_t limb;       ///< index of the limb
  std::size_t frame;      ///< index of the frame in the limb, from 0 to the number of its joints
  std::size_t component;  ///< index in [omega; v]: 0-2 angular, 3-5 linear
  /// Factor in rad or m per unit of the error; if the error grows with a displacement, also per unit of that
  /// displacement.
  double scale = 1.0;
  /// Joint displacement to which the error is proportional; none if the error is the same at all poses.
  std::optional<JointWay> along = {};

  /// The factor of the error for displacements [all joints] (rad, m) of the perfect mechanism's joints.
  double at(std::span<const double> displacements) const {
    return along ? scale * (displacements[along->joint] - along->from) : scale;
  }
};

/// All terms of an error, at least one. The first term says to which limb and frame the error belongs.
using ErrorTerms = std::vector<ErrorTerm>;

}  // namespace poesy::chain
