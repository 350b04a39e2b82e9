#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/model.h"

namespace poesy::comparison {

/// Number of samples that are solved together at one pose, as a study does.
inline constexpr std::size_t kGroup = 32;

enum class Kind { single, combined };

/// kGroup random samples at one random pose.
///   single one of the `deforming` errors, normal with sigma 1 mm or 1 deg; all `benign` errors are 1 mm or 1 deg
///   combined all 71 errors, normal with sigma 0.5 mm or 0.5 deg
struct Group {
  Kind kind;
  std::array<double, 3> pose;
  std::vector<double> errors;       ///< [71] constant parts of the errors (m, rad)
  std::vector<FactorIndex> varied;  ///< the errors that differ between samples
  std::vector<double> values;       ///< [varied x kGroup] (m, rad)
  double range;                     ///< of `single`: 4 standard deviations of the error (m or rad); of `combined`: 0

  SampleBlock block() const { return {pose, errors, varied, values, kGroup, range}; }
  /// [71] All errors of one sample (m, rad).
  std::vector<double> errors_of(std::size_t sample) const;
};

/// Draws groups. Three of four groups are `single`, with each `deforming` error in turn; the fourth is `combined`. A
/// group depends only on the seed and the group's number. Poses are uniform: z in [-0.30, -0.18] m, |beta| <= 0.6 rad,
/// |gamma| <= 1 rad.
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
