#include "engine/drawing/zone_moments.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/contract.h"

namespace poesy::drawing {
namespace {

using std::numbers::pi;
using std::numbers::sqrt2;

/// The density of an error before the zones cut it off: normal or constant. It is not normalised.
struct Density {
  double sigma = 0.0;  ///< standard deviation of a normal density, m; 0 for a constant density

  double at(double x) const { return sigma > 0.0 ? std::exp(-0.5 * (x / sigma) * (x / sigma)) : 1.0; }
  /// The integral of the density over [-half, half].
  double mass(double half) const {
    return sigma > 0.0 ? sigma * std::sqrt(2.0 * pi) * std::erf(half / (sigma * sqrt2)) : 2.0 * half;
  }
  /// The integral of x^2 times the density over [-half, half].
  double square(double half) const {
    if (sigma <= 0.0) return 2.0 / 3.0 * half * half * half;
    return sigma * sigma * (mass(half) - 2.0 * half * at(half));
  }
};

/// Integrals of a density over all displacements of a feature's middle and all tilts for which the feature is inside
/// its zones.
struct Integrals {
  double one = 0.0;     ///< integral of the density
  double middle = 0.0;  ///< integral of the density times the sum of the squared errors of the middle
  double tilt = 0.0;    ///< integral of the density times the sum of the squared tilt errors
};

template <class F>
double integral(const F& f, double from, double to) {
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, from, to, 8, 1e-11);
}

/// Integrates the three members of f from 0 to `end`. The substitution x = end sin(a) removes a square-root singularity
/// at the end.
template <class F>
Integrals integrals(const F& f, double end) {
  const auto one_of = [&](double Integrals::*member) {
    return integral([&](double a) { return end * std::cos(a) * (f(end * std::sin(a)).*member); }, 0.0, 0.5 * pi);
  };
  return {one_of(&Integrals::one), one_of(&Integrals::middle), one_of(&Integrals::tilt)};
}

/// For an axis with this lean, integrates over all displacements of the middle with which both ends stay in a disc.
/// These displacements fill a lens between two arcs.
Integrals over_lens(const Density& middle, double radius, double lean) {
  const auto at = [&](double angle) {  // integrand at an angle on an arc of the lens
    const double across = radius * std::sin(angle);
    const double along = std::max(0.0, radius * std::cos(angle) - 0.5 * lean);
    const double here = radius * std::cos(angle) * middle.at(across);
    const double mass = middle.mass(along);
    return Integrals{here * mass, here * (across * across * mass + middle.square(along)), 0.0};
  };
  const double most = std::acos(std::min(1.0, 0.5 * lean / radius));
  return {2.0 * integral([&](double angle) { return at(angle).one; }, 0.0, most),
          2.0 * integral([&](double angle) { return at(angle).middle; }, 0.0, most), 0.0};
}

/// Integrates over the displacement of the middle in one direction, from -half to half.
Integrals over_interval(const Density& middle, double half) { return {middle.mass(half), middle.square(half), 0.0}; }

/// Integrates over all tilts of a rectangle with |lift_x| + |lift_y| = lift. Returns the integral of the density, and
/// the integral of the density times lift_x^2 + lift_y^2. The two sums (lift_x +- lift_y) / sqrt 2 are independent, and
/// the larger magnitude of the two is lift / sqrt 2. Both integrals lack the same constant factor, here the four sides
/// of the square, which cancels in cut().
std::pair<double, double> rectangle_at(const Density& tilt, double lift) {
  const double larger = lift / sqrt2;
  const double weight = tilt.at(larger) * tilt.mass(larger);
  return {weight, tilt.at(larger) * (larger * larger * tilt.mass(larger) + tilt.square(larger))};
}

/// Integrates over all directions of a tilt of this length; for a rectangle, `length` is the lift of the extreme
/// points. Returns the integral of the density, and the integral of the density times the sum of the squared tilt
/// errors. Both integrals lack the same constant factor, which cancels in cut().
std::pair<double, double> tilt_at(const Feature& feature, const Density& tilt, double length) {
  if (feature.kind == FeatureKind::rectangle) return rectangle_at(tilt, length);
  const double weight = (feature.one_direction ? 1.0 : length) * tilt.at(length);
  return {weight, weight * length * length};
}

/// Integrates over all displacements of the middle with which a feature of this tilt stays in its zone of location.
Integrals middles_at(const Feature& feature, const Density& middle, double tilt) {
  if (!feature.location) return {1.0, 0.0, 0.0};
  const double half = 0.5 * feature.location->size;
  if (feature.kind != FeatureKind::axis) return over_interval(middle, half - tilt);
  return feature.one_direction ? over_interval(middle, half - 0.5 * tilt) : over_lens(middle, half, tilt);
}

/// The largest tilt that the zones allow, m: lean of an axis, or lift of the extreme points of a plane face.
double largest_tilt(const Feature& feature) {
  const bool is_axis = feature.kind == FeatureKind::axis;
  const double by_location = feature.location ? (is_axis ? 1.0 : 0.5) * feature.location->size : HUGE_VAL;
  const double by_orientation = feature.orientation ? (is_axis ? 1.0 : 0.5) * feature.orientation->size : HUGE_VAL;
  return std::min(by_location, by_orientation);
}

/// The standard deviations of the errors of an axis or a plane face, if middle and tilt have these densities inside the
/// zones and density 0 outside.
FeatureSigmas cut(const Feature& feature, const Density& middle, const Density& tilt) {
  const auto at = [&](double length) {
    const auto [weight, square] = tilt_at(feature, tilt, length);
    const Integrals left = middles_at(feature, middle, length);
    return Integrals{weight * left.one, weight * left.middle, square * left.one};
  };
  const Integrals all = integrals(at, largest_tilt(feature));
  const double coordinates = feature.kind == FeatureKind::axis && !feature.one_direction ? 2.0 : 1.0;
  const double tilts = feature.one_direction ? 1.0 : 2.0;
  FeatureSigmas found;
  if (feature.location) found.middle = std::sqrt(all.middle / all.one / coordinates);
  found.tilt = std::sqrt(all.tilt / all.one / tilts);
  return found;
}

/// The standard deviation of a normal coordinate after an inspection, divided by that before. The inspection rejects a
/// point with n coordinates if its distance from 0 is above k standard deviations. The ratio of the mean squares is
/// that of two chi-square probabilities, with n + 2 and n degrees of freedom.
double inspected_share(double n, double k) {
  const auto below = [&](double degrees) { return cdf(boost::math::chi_squared(degrees), k * k); };
  return std::sqrt(below(n + 2.0) / below(n));
}

FeatureSigmas inspected(const Feature& feature, double sigmas) {
  const FeatureSigmas normal = feature_sigmas(feature, sigmas);
  const std::size_t errors = feature.middle.size() + feature.tilt.size();
  const bool is_centred = feature.kind == FeatureKind::point || feature.kind == FeatureKind::distance;
  if (is_centred) return {*normal.middle * inspected_share(static_cast<double>(errors), sigmas), {}};
  return cut(feature, Density{normal.middle.value_or(0.0)}, Density{normal.tilt.value_or(0.0)});
}

FeatureSigmas uniform(const Feature& feature) {
  const bool is_centred = feature.kind == FeatureKind::point || feature.kind == FeatureKind::distance;
  if (!is_centred) return cut(feature, {}, {});
  const auto errors = static_cast<double>(feature.middle.size());
  return {half_width_alone(feature) / std::sqrt(errors + 2.0), {}};
}

FeatureSigmas boundary(const Feature& feature) {
  POESY_EXPECTS(can_touch(feature));
  if (feature.kind != FeatureKind::axis) {
    return {half_width_alone(feature) / std::sqrt(static_cast<double>(feature.middle.size())), {}};
  }
  const double of_end = 0.5 * feature.location->size / std::sqrt(feature.one_direction ? 1.0 : 2.0);
  return {of_end / sqrt2, of_end * sqrt2};
}

}  // namespace

FeatureSigmas scatter_sigmas(const Feature& feature, const ZoneScatter& scatter) {
  const bool has_zone = feature.location || feature.orientation;
  if (feature.clearance || !has_zone) return feature_sigmas(feature, scatter.sigmas);
  switch (scatter.shape) {
    case ScatterShape::uniform:
      return uniform(feature);
    case ScatterShape::boundary:
      return boundary(feature);
    case ScatterShape::inspected:
      return inspected(feature, sigmas_of(feature, scatter));
    case ScatterShape::normal:
      break;
  }
  return feature_sigmas(feature, sigmas_of(feature, scatter));
}

bool can_touch(const Feature& feature) {
  const bool is_plane = feature.kind == FeatureKind::rectangle || feature.kind == FeatureKind::round;
  return !is_plane && !feature.orientation;
}

double half_width_alone(const Feature& feature) {
  if (feature.kind == FeatureKind::distance) return feature.location->size;
  return feature.location ? 0.5 * feature.location->size : feature.orientation->size;
}

}  // namespace poesy::drawing
