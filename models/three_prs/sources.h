#pragma once

#include <cstddef>

// Translation units compiled for one instruction set also include this file, so it contains nothing that is computed at
// run time.

namespace poesy::three_prs {

inline constexpr std::size_t kLimbs = 3;

/// The index of each error source's first component among the errors of a limb. {O_i} is the base frame rotated about z
/// to the limb; sketch() in sketch.h states the other frames.
enum class Source : std::size_t {
  a = 0,          ///< position of the rail's upper end A_i, in {O_i}
  q = 3,          ///< initial position of the carriage along the rail
  theta_A = 4,    ///< attitude of the rail, in {O_i}
  b = 7,          ///< gap of the revolute joint, in {B_i}
  theta_B = 10,   ///< attitude of the revolute joint, in {A_i}
  theta_Bp = 13,  ///< attitude of the rod's swing frame, in {B_i'}
  l = 16,         ///< length of the rod
  c = 17          ///< position of the spherical joint, in {P_i'}
};
inline constexpr std::size_t kSources = 20;  ///< number of error components of one limb
inline constexpr std::size_t kFactors = 60;

/// The index of a source's first component among all factors. Limbs are counted from 0.
constexpr std::size_t factor_of(std::size_t limb, Source source) {
  return limb * kSources + static_cast<std::size_t>(source);
}

}  // namespace poesy::three_prs
