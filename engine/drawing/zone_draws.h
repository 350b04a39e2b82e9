#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "engine/drawing/zone_scatter.h"
#include "engine/model/feature.h"

namespace poesy::drawing {

/// Returns true if ZoneDraws must draw the errors of a feature under this scatter. It must if the errors of the feature
/// depend on each other, or if no Distribution can draw a single error (ScatterShape::boundary).
bool are_drawn_together(const Feature& feature, const ZoneScatter& scatter);

/// Returns true if a feature with these errors (m, in the order of Feature::errors()) is inside its zones.
bool is_inside(const Feature& feature, std::span<const double> errors);

/// Draws the errors of one feature together, so that the feature scatters in its zones as a ScatterShape says. The ends
/// of a pin with a clearance are drawn on the circles, or in the discs, whose diameter is the root mean square of the
/// clearance.
class ZoneDraws {
 public:
  /// The largest number of errors of a feature.
  static constexpr std::size_t kMostErrors = 4;

  /// Precondition: are_drawn_together(); for ScatterShape::inspected, half a zone is at least 1.5 standard deviations.
  ZoneDraws(Feature feature, const ZoneScatter& scatter);

  /// Replaces uniform numbers in [0, 1] by errors (m). rows: a row for each error, in the order of Feature::errors(); a
  /// row has a number for each sample. A sample depends only on its own uniforms. If an inspected feature is outside
  /// its zones, it is drawn again, with random numbers that follow from the sample's first two uniforms and the number
  /// of the attempt.
  void transform(std::span<const std::span<double>> rows) const;

 private:
  using Errors = std::array<double, kMostErrors>;

  void draw_inspected(std::span<const std::span<double>> rows) const;
  Errors uniform(const Errors& u) const;
  Errors uniform_axis(const Errors& u) const;
  Errors uniform_plane(const Errors& u) const;
  Errors boundary(const Errors& u) const;

  Feature feature_;
  ScatterShape shape_;
  Errors sigma_{};    ///< for `inspected`: standard deviations before inspection, m
  std::size_t size_;  ///< number of errors
};

}  // namespace poesy::drawing
