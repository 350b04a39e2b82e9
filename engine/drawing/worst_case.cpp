#include "engine/drawing/worst_case.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "engine/base/contract.h"
#include "engine/drawing/zone_moments.h"

namespace poesy::drawing {
namespace {

constexpr int kStarts = 24;      ///< number of directions from which the ascent starts
constexpr int kMostTurns = 200;  ///< largest number of steps of one ascent
/// An ascent ends when a step increases the length by less than this share. Only the best of all ascents is continued
/// until a step increases the length by less than kTop.
constexpr double kNearTop = 1e-4;
constexpr double kTop = 1e-14;     ///< the final ascent ends when a step increases the length by less than this share
constexpr int kMostRounds = 1000;  ///< largest number of rounds of weighted_median()
constexpr double kRest = 1e-15;    ///< weighted_median() ends when the gradient is below this share of the sum of
                                   ///< weights
constexpr double kEqual = 1e-14;   ///< costs that differ by less than this share count as equal
/// weighted_median() also ends when the gradient is below this share of the sum of weights and a round did not decrease
/// it.
constexpr double kNearRest = 1e-12;

/// A vector perpendicular to an axis: a displacement (m) or slopes. In a zone between two planes, y is 0.
struct Across {
  double x = 0.0;
  double y = 0.0;

  double length() const { return std::sqrt(x * x + y * y); }
};

Across operator+(const Across& a, const Across& b) { return {a.x + b.x, a.y + b.y}; }
Across operator-(const Across& a, const Across& b) { return {a.x - b.x, a.y - b.y}; }
Across operator*(double s, const Across& a) { return {s * a.x, s * a.y}; }

Across unit(const Across& a) {
  const double length = a.length();
  return length > 0.0 ? 1.0 / length * a : Across{};
}

double sign(double value) { return value < 0.0 ? -1.0 : 1.0; }

Across across(const OfErrors& slopes, std::size_t first, std::size_t count) {
  Across made;
  if (count > 0) made.x = slopes[first];
  if (count > 1) made.y = slopes[first + 1];
  return made;
}

void append(const Across& errors, std::size_t count, OfErrors& list) {
  if (count > 0) list.push_back(errors.x);
  if (count > 1) list.push_back(errors.y);
}

/// The point q that minimises w0 |q| + w |q - p1| + w |q - p2|: the weighted median of the origin, p1 and p2.
Across weighted_median(const Across& p1, const Across& p2, double w0, double w) {
  const std::array<Across, 3> points{Across{}, p1, p2};
  const std::array<double, 3> weights{w0, w, w};
  const auto cost = [&](const Across& q) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 3; ++k) sum += weights[k] * (q - points[k]).length();
    return sum;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    Across pull;
    for (std::size_t j = 0; j < 3; ++j) {
      if (j != k) pull = pull + weights[j] * unit(points[j] - points[k]);
    }
    if (pull.length() <= weights[k]) return points[k];
  }
  Across q = 1.0 / (w0 + 2.0 * w) * (w * p1 + w * p2);
  double last = std::numeric_limits<double>::infinity();
  for (int round = 0; round < kMostRounds; ++round) {
    Across gradient;
    Across pulled;  // point after a step of Weiszfeld's method, which is slow but never fails
    double inverse = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Across away = q - points[k];
      const double length = std::max(away.length(), std::numeric_limits<double>::min());
      const Across u = 1.0 / length * away;
      const double weight = weights[k] / length;
      gradient = gradient + weights[k] * u;
      pulled = pulled + weight * points[k];
      inverse += weight;
      xx += weight * u.y * u.y;
      xy -= weight * u.x * u.y;
      yy += weight * u.x * u.x;
    }
    const double pull = gradient.length() / (w0 + 2.0 * w);
    const bool is_rounding = pull >= last && pull <= kNearRest;
    if (pull <= kRest || is_rounding) break;
    last = pull;
    const double determinant = xx * yy - xy * xy;
    const Across newton = q - Across{(yy * gradient.x - xy * gradient.y) / determinant,
                                     (xx * gradient.y - xy * gradient.x) / determinant};
    const Across slow = 1.0 / inverse * pulled;
    const double least = cost(slow);
    q = cost(newton) <= least + kEqual * least ? newton : slow;
  }
  return q;
}

/// The displacements of the two ends of an axis, perpendicular to it (m).
struct Ends {
  Across far;
  Across near;
};

/// The displacements of the two ends of an axis with the largest value of far . a + near . b (scalar products). Each
/// end stays in a disc of this radius (m), and the two displacements differ by at most `lean` (m).
Ends extreme_ends(const Across& a, const Across& b, double radius, double lean) {
  const Ends free{radius * unit(a), radius * unit(b)};
  if ((free.far - free.near).length() <= lean) return free;
  const Across minus_b = -1.0 * b;
  const Across q = weighted_median(minus_b, a, lean, radius);
  const bool at_near = (q - minus_b).length() <= 1e-15 * (q.length() + b.length());
  const Across tilt = lean * unit(q);
  if (at_near) return {radius * unit(a - q), radius * unit(a - q) - tilt};
  const Across near = radius * unit(q + b);
  return {near + tilt, near};
}

Extreme extreme_axis(const Feature& feature, const OfErrors& slopes) {
  const std::size_t middles = feature.middle.size();
  const std::size_t tilts = feature.tilt.size();
  const Across a_m = across(slopes, 0, middles);
  const Across a_lean = across(slopes, middles, tilts);
  Extreme found;
  if (!feature.location) {
    const Across lean = feature.orientation ? feature.orientation->size * unit(a_lean) : Across{};
    append({}, middles, found.errors);
    append(lean, tilts, found.errors);
    return found;
  }
  const double most = feature.orientation ? feature.orientation->size : 2.0 * feature.location->size;
  const Ends ends = extreme_ends(0.5 * a_m + a_lean, 0.5 * a_m - a_lean, 0.5 * feature.location->size, most);
  append(0.5 * (ends.far + ends.near), middles, found.errors);
  append(ends.far - ends.near, tilts, found.errors);
  return found;
}

Extreme extreme_plane(const Feature& feature, const OfErrors& slopes) {
  const std::size_t middles = feature.middle.size();
  const double a_z = middles > 0 ? slopes[0] : 0.0;
  const Across a_lift = across(slopes, middles, feature.tilt.size());
  const bool is_round = feature.kind == FeatureKind::round;
  const bool first = std::abs(a_lift.x) >= std::abs(a_lift.y);
  const Across direction = is_round ? unit(a_lift) : first ? Across{sign(a_lift.x), 0.0} : Across{0.0, sign(a_lift.y)};
  const double pull = is_round ? a_lift.length() : std::max(std::abs(a_lift.x), std::abs(a_lift.y));
  const double half = feature.location ? 0.5 * feature.location->size : 0.0;
  double lift = feature.orientation ? 0.5 * feature.orientation->size : half;
  if (feature.location) lift = pull > std::abs(a_z) ? std::min(lift, half) : 0.0;
  Extreme found;
  if (middles > 0) found.errors.push_back(feature.location ? (half - lift) * sign(a_z) : 0.0);
  append(lift * direction, feature.tilt.size(), found.errors);
  return found;
}

Extreme extreme_point(const Feature& feature, const OfErrors& slopes) {
  const double radius = feature.location ? 0.5 * feature.location->size : 0.0;
  const double length = std::sqrt(std::inner_product(slopes.begin(), slopes.end(), slopes.begin(), 0.0));
  Extreme found;
  for (const double slope : slopes) found.errors.push_back(length > 0.0 ? radius * slope / length : 0.0);
  return found;
}

Extreme extreme_distance(const Feature& feature, const OfErrors& slopes) {
  return {{feature.location ? feature.location->size * sign(slopes[0]) : 0.0}, 0.0};
}

double sum_of(const OfErrors& squares, std::size_t first, std::size_t count) {
  return std::accumulate(squares.begin() + static_cast<std::ptrdiff_t>(first),
                         squares.begin() + static_cast<std::ptrdiff_t>(first + count), 0.0);
}

/// A vector with an entry for each component of a response; entries beyond its last component are 0.
using Direction = std::array<double, 3>;

/// Unit vectors from which ascents start, evenly spread over a half-sphere or half-circle; opposite directions give the
/// same lengths.
std::vector<Direction> starts(std::size_t components) {
  if (components == 1) return {{1.0, 0.0, 0.0}};
  std::vector<Direction> list;
  for (int k = 0; k < kStarts; ++k) {
    const double share = (k + 0.5) / kStarts;
    const double turn = components == 2 ? std::numbers::pi * share : 2.0 * std::numbers::pi * std::numbers::phi * k;
    const double height = components == 2 ? 0.0 : share;
    const double radius = std::sqrt(1.0 - height * height);
    list.push_back({radius * std::cos(turn), radius * std::sin(turn), height});
  }
  return list;
}

/// A point of an ascent to the largest length of the sum of the features' vectors (largest_length()).
struct Reached {
  LargestLength top;
  Direction direction{};  ///< the sum of the vectors, whose direction is that of the next step
};

/// The sum of the features' vectors and its length, if the errors of each feature make its vector's component along
/// `direction` as large as possible. The direction may have any length.
Reached reached_in(const std::vector<Feature>& features, const std::vector<std::vector<OfErrors>>& slopes,
                   const Direction& direction) {
  const double size = std::hypot(direction[0], direction[1], direction[2]);
  Reached found;
  for (std::size_t q = 0; q < features.size(); ++q) {
    const std::vector<OfErrors>& components = slopes[q];
    OfErrors along(components.front().size(), 0.0);
    for (std::size_t c = 0; c < components.size(); ++c) {
      for (std::size_t e = 0; e < along.size(); ++e) along[e] += direction[c] / size * components[c][e];
    }
    const Extreme at = extreme(features[q], along);
    for (std::size_t c = 0; c < components.size(); ++c) {
      found.direction[c] += std::inner_product(at.errors.begin(), at.errors.end(), components[c].begin(), 0.0);
    }
    found.top.by_feature.push_back(at.value);
  }
  found.top.length = std::hypot(found.direction[0], found.direction[1], found.direction[2]);
  return found;
}

/// Ascends to a local maximum of the length. Each step takes reached_in() along the present sum of vectors. The ascent
/// ends when a step increases the length by no more than the share `share`.
Reached ascend(const std::vector<Feature>& features, const std::vector<std::vector<OfErrors>>& slopes,
               const Direction& start, double share) {
  Reached best = reached_in(features, slopes, start);
  for (int round = 0; round < kMostTurns && best.top.length > 0.0; ++round) {
    Reached next = reached_in(features, slopes, best.direction);
    const bool is_top = !(next.top.length > best.top.length * (1.0 + share));
    if (next.top.length >= best.top.length) best = std::move(next);
    if (is_top) break;
  }
  return best;
}

}  // namespace

Extreme extreme(const Feature& feature, const OfErrors& slopes) {
  POESY_EXPECTS(slopes.size() == feature.middle.size() + feature.tilt.size());
  if (feature.clearance) return extreme(pin_in_zone(feature, feature.clearance->most), slopes);
  Extreme found;
  switch (feature.kind) {
    case FeatureKind::axis:
      found = extreme_axis(feature, slopes);
      break;
    case FeatureKind::rectangle:
    case FeatureKind::round:
      found = extreme_plane(feature, slopes);
      break;
    case FeatureKind::point:
      found = extreme_point(feature, slopes);
      break;
    case FeatureKind::distance:
      found = extreme_distance(feature, slopes);
      break;
  }
  found.value = std::inner_product(slopes.begin(), slopes.end(), found.errors.begin(), 0.0);
  return found;
}

ZoneSquares zone_squares(const Feature& feature, const ZoneScatter& scatter, const FeatureSigmas& sigma,
                         const OfErrors& squares) {
  const double middle = sum_of(squares, 0, feature.middle.size());
  const double tilt = sum_of(squares, feature.middle.size(), feature.tilt.size());
  const auto square = [](double value) { return value * value; };
  const double even = middle * square(sigma.middle.value_or(0.0)) + tilt * square(sigma.tilt.value_or(0.0));
  const bool is_divided_freely = feature.location && !feature.orientation && !feature.tilt.empty();
  if (!is_divided_freely || !scatter.has_sigmas()) return {even, even};
  const double sigmas = sigmas_of(feature, scatter);
  Feature shifted = feature;
  shifted.orientation = Zone{"parallelism", 0.0, {}};
  const double only_middle = middle * square(*feature_sigmas(shifted, sigmas).middle);
  Feature turned = feature;
  turned.location.reset();
  turned.orientation = Zone{"parallelism", feature.location->size, {}};
  return {even, std::max(only_middle, tilt * square(*feature_sigmas(turned, sigmas).tilt))};
}

LargestLength largest_length(const std::vector<Feature>& features, const std::vector<std::vector<OfErrors>>& slopes) {
  if (features.empty()) return {};
  const std::size_t components = slopes.front().size();
  POESY_EXPECTS(components >= 1 && components <= 3);
  Reached best;
  for (const Direction& direction : starts(components)) {
    Reached found = ascend(features, slopes, direction, kNearTop);
    if (found.top.length > best.top.length) best = std::move(found);
  }
  return best.top.length > 0.0 ? ascend(features, slopes, best.direction, kTop).top : best.top;
}

}  // namespace poesy::drawing
