#include "engine/drawing/share_inside.h"

#include <algorithm>
#include <boost/math/distributions/non_central_chi_squared.hpp>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

#include "engine/drawing/zone_scatter.h"

namespace poesy::drawing {
namespace {

using std::numbers::pi;
using std::numbers::sqrt2;

/// The probability that a standard normal number is between -k and k.
double in_interval(double k) { return std::erf(k / sqrt2); }

/// The probability that a point with two (three) independent standard normal coordinates is in a disc (ball) of radius
/// k.
double in_disc(double k) { return -std::expm1(-0.5 * k * k); }
double in_ball(double k) { return in_interval(k) - std::sqrt(2.0 / pi) * k * std::exp(-0.5 * k * k); }

template <class F>
double integral(const F& f, double from, double to) {
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(f, from, to, 15, 1e-12);
}

/// The probability that both ends of an axis are within a distance k of their nominal places. Each coordinate of an end
/// has standard deviation 1. correlation: between a coordinate of one end and the same coordinate of the other end. If
/// the displacement of one end is given, that of the other end is normal with the mean `correlation` times the given
/// displacement.
double ends_inside(double k, double correlation, bool one_direction) {
  const double rest = std::sqrt(std::max(0.0, (1.0 - correlation) * (1.0 + correlation)));
  if (rest < 1e-6) return one_direction ? in_interval(k) : in_disc(k);
  if (one_direction) {
    return integral(
        [&](double x) {
          const double middle = correlation * x;
          const double other =
              0.5 * (std::erf((k - middle) / (rest * sqrt2)) + std::erf((k + middle) / (rest * sqrt2)));
          return std::exp(-0.5 * x * x) / std::sqrt(2.0 * pi) * other;
        },
        -k, k);
  }
  return integral(
      [&](double r) {
        const double away = std::pow(correlation * r / rest, 2);
        const double most = std::pow(k / rest, 2);
        return r * std::exp(-0.5 * r * r) * cdf(boost::math::non_central_chi_squared(2.0, away), most);
      },
      0.0, k);
}

/// The probability that all extreme points of a plane face are at most `half` above or below their nominal places. This
/// holds if |z| plus the largest lift is at most `half`. Here z is the displacement of the middle of the face, and the
/// largest lift is that of the extreme point that the tilt raises most. middle: standard deviation of z. tilt: standard
/// deviation of each of the two lift errors. All lengths in m.
double plane_inside(FeatureKind kind, double half, double middle, double tilt) {
  const auto density = [&](double lift) {
    const double x = lift / tilt;
    if (kind == FeatureKind::round) return x / tilt * std::exp(-0.5 * x * x);
    return 2.0 / (tilt * std::sqrt(pi)) * std::exp(-0.25 * x * x) * std::erf(0.5 * x);
  };
  return integral([&](double lift) { return density(lift) * std::erf((half - lift) / (middle * sqrt2)); }, 0.0, half);
}

double location_inside(const Feature& feature, double sigmas) {
  const double location = feature.location->size;
  const FeatureSigmas found = feature_sigmas(feature, sigmas);
  if (feature.kind == FeatureKind::axis) {
    const double middle = std::pow(*found.middle, 2);
    const double half_tilt = 0.25 * std::pow(*found.tilt, 2);
    return ends_inside(sigmas, (middle - half_tilt) / (middle + half_tilt), feature.one_direction);
  }
  if (*found.tilt <= 1e-9 * location) return in_interval(sigmas);
  return plane_inside(feature.kind, 0.5 * location, *found.middle, *found.tilt);
}

double orientation_inside(const Feature& feature, double sigmas) {
  const double one = in_interval(sigmas);
  if (feature.kind == FeatureKind::rectangle) return one * one;
  return feature.one_direction ? one : in_disc(sigmas);
}

}  // namespace

double share_inside(const Feature& feature, ZoneClass of, double sigmas, double shift) {
  if (of == ZoneClass::orientation) return orientation_inside(feature, sigmas);
  if (feature.kind == FeatureKind::distance) {
    const double far = (1.0 + shift) / (1.0 - shift) * sigmas;
    return 0.5 * (in_interval(sigmas) + in_interval(far));
  }
  if (feature.kind != FeatureKind::point) return location_inside(feature, sigmas);
  return feature.one_direction ? in_interval(sigmas) : in_ball(sigmas);
}

}  // namespace poesy::drawing
