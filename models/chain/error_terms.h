#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace poesy::chain {

/// The way of a joint by which an error grows.
struct JointWay {
  std::size_t joint;  ///< position among the joints of all limbs
  double from;        ///< displacement of this joint where the error is zero (rad, m)
};

/// What an error adds to an entry of a fixed frame's error: entry += at() x error.
struct ErrorTerm {
  std::size_t limb;                    ///< counts from 0
  std::size_t frame;                   ///< 0 .. joints of the limb
  std::size_t component;               ///< position in [omega; v]: 0-2 angular, 3-5 linear
  double scale = 1.0;                  ///< rad or m per unit of the error, and of the way if there is one
  std::optional<JointWay> along = {};  ///< none: the same at all poses

  /// The factor of the error where the perfect mechanism's joints [all joints] are so displaced (rad, m).
  double at(std::span<const double> displacements) const {
    return along ? scale * (displacements[along->joint] - along->from) : scale;
  }
};

/// All terms of an error, at least one. The first one says to which limb and frame the error belongs.
using ErrorTerms = std::vector<ErrorTerm>;

}  // namespace poesy::chain
