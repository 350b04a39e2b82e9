#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/model.h"

namespace poesy::comparison {

/// Samples at one pose are solved together, as in production.
inline constexpr std::size_t kGroup = 32;

enum class Kind { single, combined };

/// kGroup random samples at one random pose.
///   single    one of the `deforming` errors, normal with 1 mm or 1 deg, over constant `benign` ones of 1 mm and 1 deg
///   combined  all 71 errors, normal with 0.5 mm and 0.5 deg
struct Group {
  Kind kind;
  std::array<double, 3> pose;
  std::vector<double> errors;       ///< [71], constant ones
  std::vector<FactorIndex> varied;  ///< [V]
  std::vector<double> values;       ///< [V x kGroup]
  double range;                     ///< 4 standard deviations of a single error, else 0

  SampleBlock block() const { return {pose, errors, varied, values, kGroup, range}; }
  /// All errors of one sample, [71].
  std::vector<double> errors_of(std::size_t sample) const;
};

/// Draws groups: three of four single, the errors taking turns, one of four combined. A group depends on the seed and
/// its number alone. Poses: z in [-0.30, -0.18] m, |beta| <= 0.6 rad, |gamma| <= 1 rad, uniform.
class PairSource {
 public:
  PairSource(const Model& model, std::uint64_t seed);

  Group group(std::size_t number) const;

 private:
  std::array<double, 3> pose(std::size_t number) const;
  void fill(Group& group, std::size_t number, double size) const;

  const Model* model_;
  std::uint64_t seed_;
  std::vector<FactorIndex> deforming_;
  std::vector<FactorIndex> all_;
  std::vector<double> background_;
};

}  // namespace poesy::comparison
