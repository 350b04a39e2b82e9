#include "engine/drawing/zone_draws.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "engine/base/contract.h"
#include "engine/drawing/axis_in_disc.h"
#include "engine/drawing/zone_moments.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"

namespace poesy::drawing {
namespace {

using std::numbers::pi;

/// Maps a uniform in [0, 1] to [-1, 1].
double between(double u) { return 2.0 * u - 1.0; }

/// The largest lift of the extreme points of a plane face that its zones allow, divided by half the zone of location;
/// at most 1.
double tilt_share(const Feature& feature) {
  return feature.orientation ? std::min(1.0, feature.orientation->size / feature.location->size) : 1.0;
}

/// The point on the square |x| + |y| = size at the share u of its perimeter, measured from (size, 0) towards (0, size).
std::array<double, 2> on_square(double size, double u) {
  const double way = 4.0 * u;
  const auto side = static_cast<int>(way);
  const double rest = size * (way - side);
  switch (side) {
    case 0:
      return {size - rest, rest};
    case 1:
      return {-rest, size - rest};
    case 2:
      return {rest - size, -rest};
    default:
      return {rest, rest - size};
  }
}

std::array<double, 2> on_circle(double radius, double u) {
  return {radius * std::cos(2.0 * pi * u), radius * std::sin(2.0 * pi * u)};
}

/// The two lift errors of a plane face whose extreme points have this lift. u: direction of the tilt, as a share of a
/// full turn.
std::array<double, 2> tilt_of_plane(FeatureKind kind, double lift, double u) {
  return kind == FeatureKind::rectangle ? on_square(lift, u) : on_circle(lift, u);
}

bool axis_is_inside(const Feature& feature, std::span<const double> middle, std::span<const double> lean) {
  double length = 0.0;  // squared length of the lean; near, far: squared displacements of the two ends
  double near = 0.0;
  double far = 0.0;
  for (std::size_t k = 0; k < lean.size(); ++k) {
    length += lean[k] * lean[k];
    if (middle.empty()) continue;
    near += std::pow(middle[k] - 0.5 * lean[k], 2);
    far += std::pow(middle[k] + 0.5 * lean[k], 2);
  }
  if (feature.orientation && length > std::pow(feature.orientation->size, 2)) return false;
  return !feature.location || std::max(near, far) <= std::pow(0.5 * feature.location->size, 2);
}

bool plane_is_inside(const Feature& feature, std::span<const double> middle, std::span<const double> tilt) {
  const bool is_round = feature.kind == FeatureKind::round;
  const double lift = is_round ? std::hypot(tilt[0], tilt[1]) : std::abs(tilt[0]) + std::abs(tilt[1]);
  if (feature.orientation && lift > 0.5 * feature.orientation->size) return false;
  return !feature.location || std::abs(middle[0]) + lift <= 0.5 * feature.location->size;
}

}  // namespace

bool are_drawn_together(const Feature& feature, const ZoneScatter& scatter) {
  const bool has_zone = feature.location || feature.orientation;
  if (scatter.is_normal() || !(has_zone || feature.clearance)) return false;
  return scatter.shape == ScatterShape::boundary || feature.errors().size() > 1;
}

bool is_inside(const Feature& feature, std::span<const double> errors) {
  const std::span middle = errors.first(feature.middle.size());
  const std::span tilt = errors.subspan(feature.middle.size());
  switch (feature.kind) {
    case FeatureKind::axis:
      return axis_is_inside(feature, middle, tilt);
    case FeatureKind::rectangle:
    case FeatureKind::round:
      return plane_is_inside(feature, middle, tilt);
    case FeatureKind::point:
    case FeatureKind::distance:
      break;
  }
  double square = 0.0;
  for (const double error : middle) square += error * error;
  return !feature.location || square <= std::pow(half_width_alone(feature), 2);
}

ZoneDraws::ZoneDraws(Feature feature, const ZoneScatter& scatter)
    : feature_(std::move(feature)), shape_(scatter.shape), size_(feature_.errors().size()) {
  POESY_EXPECTS(are_drawn_together(feature_, scatter) && size_ <= kMostErrors);
  if (feature_.clearance) {
    shape_ = feature_.clearance->touches ? ScatterShape::boundary : ScatterShape::uniform;
    feature_ = pin_in_zone(feature_, std::sqrt(feature_.clearance->mean_square));
  }
  if (shape_ != ScatterShape::inspected) return;
  const FeatureSigmas normal = feature_sigmas(feature_, sigmas_of(feature_, scatter));
  std::fill_n(sigma_.begin(), feature_.middle.size(), normal.middle.value_or(0.0));
  std::fill_n(sigma_.begin() + static_cast<std::ptrdiff_t>(feature_.middle.size()), feature_.tilt.size(),
              normal.tilt.value_or(0.0));
}

void ZoneDraws::transform(std::span<const std::span<double>> rows) const {
  POESY_EXPECTS(rows.size() == size_);
  if (shape_ == ScatterShape::inspected) return draw_inspected(rows);
  for (std::size_t b = 0; b < rows.front().size(); ++b) {
    Errors u{};
    for (std::size_t e = 0; e < size_; ++e) u[e] = rows[e][b];
    const Errors errors = shape_ == ScatterShape::uniform ? uniform(u) : boundary(u);
    for (std::size_t e = 0; e < size_; ++e) rows[e][b] = errors[e];
  }
}

void ZoneDraws::draw_inspected(std::span<const std::span<double>> rows) const {
  const auto bits = [&](std::size_t e, std::size_t b) { return std::bit_cast<std::uint64_t>(rows[e][b]); };
  for (std::size_t b = 0; b < rows.front().size(); ++b) {
    const std::uint64_t first = bits(0, b);
    const std::uint64_t second = bits(1, b);
    Errors errors{};
    for (std::size_t e = 0; e < size_; ++e) errors[e] = normal_quantile(sigma_[e], rows[e][b]);
    for (std::size_t attempt = 1; !is_inside(feature_, std::span(errors).first(size_)); ++attempt) {
      const StreamAddress address{first, Purpose::zone_attempts, FactorIndex(second), PoseIndex(attempt)};
      const auto drawn = random_block(address, 0);
      for (std::size_t e = 0; e < size_; ++e) errors[e] = normal_quantile(sigma_[e], uniform_from_bits(drawn[e]));
    }
    for (std::size_t e = 0; e < size_; ++e) rows[e][b] = errors[e];
  }
}

ZoneDraws::Errors ZoneDraws::uniform(const Errors& u) const {
  switch (feature_.kind) {
    case FeatureKind::axis:
      return uniform_axis(u);
    case FeatureKind::rectangle:
    case FeatureKind::round:
      return uniform_plane(u);
    case FeatureKind::point:
    case FeatureKind::distance:
      break;
  }
  const double radius = half_width_alone(feature_) * std::cbrt(u[0]);
  const double cosine = between(u[1]);
  const auto [x, y] = on_circle(radius * std::sqrt((1.0 - cosine) * (1.0 + cosine)), u[2]);
  return {x, y, radius * cosine};
}

ZoneDraws::Errors ZoneDraws::uniform_axis(const Errors& u) const {
  if (!feature_.location) {
    const auto [x, y] = on_circle(feature_.orientation->size * std::sqrt(u[0]), u[1]);
    return {x, y};
  }
  const double radius = 0.5 * feature_.location->size;
  const double most = std::min(2.0, feature_.orientation ? feature_.orientation->size / radius : 2.0);
  if (feature_.one_direction) {
    // The density of |lean| decreases linearly, because the range of the middle in which both ends are inside becomes
    // shorter linearly.
    const double share = std::abs(between(u[1])) * most * (1.0 - 0.25 * most);
    const double lean = 2.0 * share / (1.0 + std::sqrt(1.0 - share));
    return {radius * between(u[0]) * (1.0 - 0.5 * lean), std::copysign(radius * lean, u[1] - 0.5)};
  }
  const double lean = distance_at_share(u[2], most);
  const double across = chord_at_share(u[1], lean);
  const double along = between(u[0]) * (std::sqrt((1.0 - across) * (1.0 + across)) - 0.5 * lean);
  const auto [cosine, sine] = on_circle(1.0, u[3]);
  return {radius * (along * cosine - across * sine), radius * (along * sine + across * cosine), radius * lean * cosine,
          radius * lean * sine};
}

ZoneDraws::Errors ZoneDraws::uniform_plane(const Errors& u) const {
  if (!feature_.location) {
    const auto [x, y] = tilt_of_plane(feature_.kind, 0.5 * feature_.orientation->size * std::sqrt(u[0]), u[1]);
    return {x, y};
  }
  const double half = 0.5 * feature_.location->size;
  const double most = tilt_share(feature_);
  const double share = u[1] * most * most * (3.0 - 2.0 * most);
  const double lift = 0.5 - std::sin(std::asin(1.0 - 2.0 * share) / 3.0);
  const auto [x, y] = tilt_of_plane(feature_.kind, half * lift, u[2]);
  return {half * between(u[0]) * (1.0 - lift), x, y};
}

ZoneDraws::Errors ZoneDraws::boundary(const Errors& u) const {
  const double radius = half_width_alone(feature_);
  const auto side = [radius](double one) { return std::copysign(radius, one - 0.5); };
  if (feature_.kind != FeatureKind::axis && size_ == 1) return {side(u[0])};
  if (feature_.kind != FeatureKind::axis) {
    const double cosine = between(u[1]);
    const auto [x, y] = on_circle(radius * std::sqrt((1.0 - cosine) * (1.0 + cosine)), u[2]);
    return {x, y, radius * cosine};
  }
  if (feature_.one_direction) {
    const double near = side(u[0]);
    const double far = side(u[1]);
    return {0.5 * (near + far), far - near};
  }
  const auto near = on_circle(radius, u[1]);
  const auto far = on_circle(radius, u[3]);
  return {0.5 * (near[0] + far[0]), 0.5 * (near[1] + far[1]), far[0] - near[0], far[1] - near[1]};
}

}  // namespace poesy::drawing
