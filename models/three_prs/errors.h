#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/model/model.h"

namespace poesy::three_prs {

/// Where each source's components stand among a limb's error sources.
enum class Source : std::size_t {
  a = 0,          ///< position of the rail's upper end A_i, in {O_i}
  q = 3,          ///< initial position of the carriage along the rail
  theta_A = 4,    ///< attitude of the rail, in {O_i}
  b = 7,          ///< gap of the revolute joint, in {B_i}
  theta_B = 10,   ///< attitude of the revolute joint, in {A_i}
  theta_Bp = 13,  ///< swing frame of the rod, in {B_i'}
  l = 16,         ///< length of the rod
  c = 17          ///< position of the spherical joint, in {P_i'}
};
inline constexpr std::size_t kSources = 20;  ///< of one limb
inline constexpr std::size_t kFactors = 60;

/// Where the components of a limb's source stand among all factors; limbs counted from 0.
constexpr std::size_t factor_of(std::size_t limb, Source source) {
  return limb * kSources + static_cast<std::size_t>(source);
}

/// The 60 error sources a_x_1 ... c_z_3 (San et al. 2023, Section 3), limb by limb; frame counts the sources.
std::vector<Factor> factors();

/// all (the 51 that have an effect); compensable (30: the paper's 24, with its scalar c as three components) and
/// non-compensable (21), Section 4.2; platform-hinges (FS), initial-position (T), revolute-gap (R), rod-length (L),
/// Section 5.2.
std::vector<FactorSet> factor_sets();

/// "compensable", "non-compensable", or empty without effect (Section 4.2), [60].
std::vector<std::string> published_classes();

}  // namespace poesy::three_prs
