#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>

#include "engine/random/distribution.h"
#include "engine/random/low_discrepancy.h"
#include "engine/study/poses/workspace.h"

namespace poesy {
namespace {

/// Two scaled coordinates (0 to 1 over the range of the box) that differ by less than this are equal up to rounding.
constexpr double kRounding = 1e-12;

/// The number of intervals into which the part of a line in the box is divided to find changes of feasibility.
constexpr std::size_t kScanIntervals = 32;

constexpr double kGoldenRatio = 0.6180339887498949;

using Vector = std::vector<double>;

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// The number of uniform random numbers that unit_vector() needs for a vector with n entries.
std::size_t uniforms_for(std::size_t n) { return n <= 3 ? n - 1 : n; }

/// Computes a vector with n entries that is uniform on the unit sphere, from uniforms_for(n) uniforms; for n = 1 it is
/// always 1. For n = 2 and 3 a closed form needs fewer uniforms than entries, which is better, because a
/// low-discrepancy sequence is more even in fewer dimensions.
void unit_vector(std::span<const double> uniforms, std::span<double> vector) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  if (vector.size() == 1) {
    vector[0] = 1.0;
  } else if (vector.size() == 2) {
    vector[0] = std::cos(kTurn * uniforms[0]);
    vector[1] = std::sin(kTurn * uniforms[0]);
  } else if (vector.size() == 3) {
    vector[2] = 2.0 * uniforms[0] - 1.0;
    const double radius = std::sqrt(1.0 - vector[2] * vector[2]);
    vector[0] = radius * std::cos(kTurn * uniforms[1]);
    vector[1] = radius * std::sin(kTurn * uniforms[1]);
  } else {
    static const Distribution kNormal = Distribution::normal(1.0);
    for (std::size_t c = 0; c < vector.size(); ++c) vector[c] = kNormal.quantile(uniforms[c]);
    const double norm = std::sqrt(dot(vector, vector));
    for (double& value : vector) value /= norm;
  }
}

/// Maps a vector that is perpendicular to the last axis to a vector perpendicular to `unit`, by the reflection that
/// maps the last axis to `unit` or -`unit`. Precondition: the vector's last entry is 0.
void reflect_last_axis_to(std::span<const double> unit, std::span<double> vector) {
  const double last = unit.back();
  const double factor = dot(unit, vector) / (1.0 + std::abs(last));
  for (std::size_t c = 0; c < vector.size(); ++c) vector[c] -= factor * unit[c];
  vector.back() -= (last < 0.0 ? -factor : factor);
}

/// A line in coordinates that are scaled so that the workspace is the unit cube.
struct Line {
  Vector point;
  Vector direction;
};

/// A random line from a point of the Sobol' sequence, with the distribution in which no place and no direction is
/// preferred (the kinematic measure). The direction of the line is uniform. The line's point nearest to the cube's
/// centre is uniform in a ball that is perpendicular to the direction and wide enough to cover the cube.
Line line_of(Vector uniforms, std::size_t coordinates) {
  // A fixed irrational step is added in each dimension, modulo 1. Without it, the first points of the sequence are
  // symmetric about the middle, so that their lines pass through edges and corners.
  const auto fraction = [](double value) { return value - std::floor(value); };
  double step = 0.0;
  double share = 0.5;  // the first dimension covers half of the sphere, because a line has no sign
  for (double& u : uniforms) {
    step = fraction(step + kGoldenRatio);
    u = share * fraction(u + step);
    share = 1.0;
  }
  Line line{Vector(coordinates, 0.0), Vector(coordinates, 0.0)};
  unit_vector(uniforms, line.direction);
  const std::span<double> offset = std::span(line.point).first(coordinates - 1);
  const double radius = 0.5 * std::sqrt(static_cast<double>(coordinates));
  const double u = uniforms.back();
  if (offset.size() == 1) offset[0] = radius * (2.0 * u - 1.0);
  if (offset.size() > 1) {
    unit_vector(std::span(uniforms).subspan(uniforms_for(coordinates)), offset);
    for (double& value : offset) value *= radius * std::pow(u, 1.0 / static_cast<double>(offset.size()));
  }
  if (!offset.empty()) reflect_last_axis_to(line.direction, line.point);
  for (double& value : line.point) value += 0.5;
  return line;
}

/// The part of a line inside the unit cube, between two positions along the line.
struct Chord {
  Line line;
  double enter = -std::numeric_limits<double>::infinity();
  double leave = std::numeric_limits<double>::infinity();
  std::size_t enter_face = 0;  ///< coordinate of the face through which the line enters
  std::size_t leave_face = 0;  ///< coordinate of the face through which the line leaves

  /// The point at this position along the line. At `enter` and `leave` the point is exactly on a face.
  void at(double position, Vector& point) const {
    for (std::size_t c = 0; c < point.size(); ++c) {
      point[c] = std::clamp(line.point[c] + position * line.direction[c], 0.0, 1.0);
    }
    if (position == enter) point[enter_face] = line.direction[enter_face] > 0.0 ? 0.0 : 1.0;
    if (position == leave) point[leave_face] = line.direction[leave_face] > 0.0 ? 1.0 : 0.0;
  }
};

/// The part of the line in the unit cube; none if the line misses it.
std::optional<Chord> chord_of(const Line& line) {
  Chord chord{line};
  for (std::size_t c = 0; c < line.point.size(); ++c) {
    const double slope = line.direction[c];
    const double start = line.point[c];
    if (slope == 0.0 && start >= 0.0 && start <= 1.0) continue;
    if (slope == 0.0) return std::nullopt;
    const auto [low, high] = std::minmax({-start / slope, (1.0 - start) / slope});
    if (low > chord.enter) std::tie(chord.enter, chord.enter_face) = std::tuple(low, c);
    if (high < chord.leave) std::tie(chord.leave, chord.leave_face) = std::tuple(high, c);
  }
  return chord.enter < chord.leave ? std::optional(chord) : std::nullopt;
}

/// Adds to the collector every point at which the chord enters or leaves the feasible set: the two ends of each
/// feasible piece of the chord.
void keep_crossings(const Chord& chord, const Workspace& workspace, PoseCollector& collector) {
  Vector scaled(workspace.coordinates());
  Vector pose(workspace.coordinates());
  const auto move_to = [&](double position) {
    chord.at(position, scaled);
    workspace.unscale(scaled, pose);
  };
  // Finds the change of feasibility between two positions by bisection, and returns the last feasible position.
  const auto refined = [&](double feasible, double infeasible) {
    while (std::abs(infeasible - feasible) > std::numeric_limits<double>::epsilon()) {
      const double middle = std::midpoint(feasible, infeasible);
      if (middle == feasible || middle == infeasible) break;
      move_to(middle);
      (workspace.judge(pose).feasible() ? feasible : infeasible) = middle;
    }
    return feasible;
  };
  const auto keep_piece = [&](double begin, double end) {
    if (std::abs(end - begin) < kRounding) return;
    for (const double position : {begin, end}) {
      move_to(position);
      collector.keep(pose, workspace.judge(pose).condition);
    }
  };
  double before = chord.enter;
  bool inside = false;         // true if the position is in a feasible piece
  double entry = chord.enter;  // position where the present feasible piece begins
  for (std::size_t k = 0; k <= kScanIntervals; ++k) {
    const double share = static_cast<double>(k) / static_cast<double>(kScanIntervals);
    const double position = std::lerp(chord.enter, chord.leave, share);
    move_to(position);
    const bool feasible = collector.test(pose).has_value();
    if (feasible && !inside) entry = k == 0 ? position : refined(position, before);
    if (!feasible && inside) keep_piece(entry, refined(before, position));
    inside = feasible;
    before = position;
  }
  if (inside) keep_piece(entry, chord.leave);
}

/// Returns true if two of the collected poses are equal up to rounding in every scaled coordinate. The poses are sorted
/// along a direction that is not parallel to a face of the cube, so only near neighbours need to be compared.
bool some_coincide(const Workspace& workspace, const PoseCollector& collector) {
  const std::size_t count = collector.kept();
  const std::size_t coordinates = workspace.coordinates();
  std::vector<double> key(count, 0.0);
  std::vector<double> scaled(count * coordinates);
  for (std::size_t m = 0; m < count; ++m) {
    for (std::size_t c = 0; c < coordinates; ++c) {
      scaled[m * coordinates + c] = workspace.scaled(c, collector.pose(m)[c]);
      key[m] += std::pow(kGoldenRatio, static_cast<double>(c)) * scaled[m * coordinates + c];
    }
  }
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t m) { return key[m]; });
  const auto coincide = [&](std::size_t a, std::size_t b) {
    for (std::size_t c = 0; c < coordinates; ++c) {
      if (!(std::abs(scaled[a * coordinates + c] - scaled[b * coordinates + c]) < kRounding)) return false;
    }
    return true;
  };
  const double reach = kRounding / (1.0 - kGoldenRatio);
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t next = k + 1; next < count && key[order[next]] - key[order[k]] < reach; ++next) {
      if (coincide(order[k], order[next])) return true;
    }
  }
  return false;
}

}  // namespace

SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model, const WatchSearch& watch) {
  const Workspace workspace(selection, model);
  PoseCollector collector(workspace, selection.count, watch);
  const std::size_t coordinates = workspace.coordinates();
  Vector uniforms(coordinates == 1 ? 1 : uniforms_for(coordinates) + uniforms_for(coordinates - 1) + 1);
  SobolSequence sequence(uniforms.size());
  const std::size_t most = std::max<std::size_t>(20'000, 100 * selection.count);
  for (std::size_t line = 0; collector.kept() < selection.count; ++line) {
    if (line == most || collector.in_vain()) collector.fail(selection.place);
    sequence.next(uniforms);
    if (const auto chord = chord_of(line_of(uniforms, coordinates))) keep_crossings(*chord, workspace, collector);
  }
  collector.keep_first(selection.count);
  if (some_coincide(workspace, collector)) {
    throw InputError(selection.count_place,
                     "poses.count is " + std::to_string(selection.count) +
                         ", more poses of the boundary than can be separated at rounding",
                     "ask for fewer poses");
  }
  return std::move(collector).result();
}

}  // namespace poesy
