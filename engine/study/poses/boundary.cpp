#include "engine/study/poses/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>

#include "engine/random/distribution.h"
#include "engine/random/low_discrepancy.h"

namespace poesy {
namespace {

/// Scaled coordinates that differ by less are equal to rounding.
constexpr double kRounding = 1e-12;

constexpr double kGoldenRatio = 0.6180339887498949;

using Vector = std::vector<double>;

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Number of uniforms that unit_vector() takes in n dimensions.
std::size_t uniforms_for(std::size_t n) { return n <= 3 ? n - 1 : n; }

/// A vector uniform on the unit sphere, [n], from uniforms [uniforms_for(n)]; in one dimension always 1. As few
/// uniforms as possible where there is a closed form, because a low-discrepancy sequence is more even in fewer
/// dimensions.
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

/// Turns a vector across the last axis into one across this unit vector, by the reflection that exchanges both lines.
/// Precondition: the vector's last entry is 0.
void reflect_last_axis_to(std::span<const double> unit, std::span<double> vector) {
  const double last = unit.back();
  const double factor = dot(unit, vector) / (1.0 + std::abs(last));
  for (std::size_t c = 0; c < vector.size(); ++c) vector[c] -= factor * unit[c];
  vector.back() -= (last < 0.0 ? -factor : factor);
}

/// The part of a line inside the unit cube.
class Chord {
 public:
  /// The line through `point` along the unit vector `direction`; nothing when it misses the cube.
  static std::optional<Chord> through(const Vector& point, const Vector& direction) {
    Chord chord(point, direction);
    for (std::size_t c = 0; c < point.size(); ++c) {
      if (!chord.clip(c)) return std::nullopt;
    }
    if (!(chord.enter_ < chord.leave_)) return std::nullopt;
    return chord;
  }

  double enter() const { return enter_; }
  double leave() const { return leave_; }

  /// The point at this position; at enter() and leave() exactly on the face.
  void at(double position, Vector& point) const {
    for (std::size_t c = 0; c < point.size(); ++c) {
      point[c] = std::clamp((*point_)[c] + position * (*direction_)[c], 0.0, 1.0);
    }
    if (position == enter_) point[enter_face_] = (*direction_)[enter_face_] > 0.0 ? 0.0 : 1.0;
    if (position == leave_) point[leave_face_] = (*direction_)[leave_face_] > 0.0 ? 1.0 : 0.0;
  }

 private:
  Chord(const Vector& point, const Vector& direction) : point_(&point), direction_(&direction) {}

  bool clip(std::size_t c) {
    const double slope = (*direction_)[c];
    const double start = (*point_)[c];
    if (slope == 0.0) return start >= 0.0 && start <= 1.0;
    const auto [low, high] = std::minmax({-start / slope, (1.0 - start) / slope});
    if (low > enter_) {
      enter_ = low;
      enter_face_ = c;
    }
    if (high < leave_) {
      leave_ = high;
      leave_face_ = c;
    }
    return true;
  }

  const Vector* point_;
  const Vector* direction_;
  double enter_ = -std::numeric_limits<double>::infinity();
  double leave_ = std::numeric_limits<double>::infinity();
  std::size_t enter_face_ = 0;
  std::size_t leave_face_ = 0;
};

/// Lines through the unit cube by the kinematic measure, from a Sobol' sequence.
class Lines {
 public:
  explicit Lines(std::size_t coordinates)
      : uniform_(coordinates == 1 ? 1 : uniforms_for(coordinates) + uniforms_for(coordinates - 1) + 1),
        sequence_(uniform_.size()),
        direction_(coordinates),
        point_(coordinates) {}

  /// The next line's part in the cube; nothing when it misses. Valid until the next call.
  std::optional<Chord> next() {
    sequence_.next(uniform_);
    shift();
    const std::size_t coordinates = direction_.size();
    uniform_[0] *= 0.5;  // half of the sphere: a line has no sign
    unit_vector(uniform_, direction_);
    point_.assign(coordinates, 0.0);
    if (coordinates > 1) set_offset();
    for (double& value : point_) value += 0.5;
    return Chord::through(point_, direction_);
  }

 private:
  /// Moves the point by a fixed irrational step in each dimension, modulo 1. The first points of the sequence lie
  /// symmetric to the middle, and such lines meet edges and corners.
  void shift() {
    double step = 0.0;
    for (double& u : uniform_) {
      step = fraction(step + kGoldenRatio);
      u = fraction(u + step);
    }
  }

  static double fraction(double value) { return value - std::floor(value); }

  /// The point nearest to the centre: uniform in a ball across the direction that covers the cube.
  void set_offset() {
    const std::size_t across = direction_.size() - 1;
    const std::span<double> offset = std::span(point_).first(across);
    const double radius = 0.5 * std::sqrt(static_cast<double>(direction_.size()));
    const double u = uniform_.back();
    if (across == 1) {
      offset[0] = radius * (2.0 * u - 1.0);
    } else {
      unit_vector(std::span(uniform_).subspan(uniforms_for(direction_.size())), offset);
      for (double& value : offset) value *= radius * std::pow(u, 1.0 / static_cast<double>(across));
    }
    reflect_last_axis_to(direction_, point_);
  }

  Vector uniform_;
  SobolSequence sequence_;
  Vector direction_;
  Vector point_;
};

/// Finds where chords cross the boundary of the feasible set.
class Crossings {
 public:
  Crossings(const Workspace& workspace, PoseCollector& collector)
      : workspace_(&workspace),
        collector_(&collector),
        scaled_(workspace.coordinates()),
        pose_(workspace.coordinates()) {}

  /// Keeps every crossing along the chord.
  void collect(const Chord& chord) {
    double before = chord.enter();
    bool inside = false;
    for (std::size_t k = 0; k <= kScanIntervals; ++k) {
      const double position =
          std::lerp(chord.enter(), chord.leave(), static_cast<double>(k) / static_cast<double>(kScanIntervals));
      move_to(chord, position);
      const bool feasible = collector_->test(pose_);
      if (feasible && !inside) entry_at_ = k == 0 ? position : refined(chord, position, before);
      if (!feasible && inside) keep_piece(chord, refined(chord, before, position));
      inside = feasible;
      before = position;
    }
    if (inside) keep_piece(chord, chord.leave());
  }

 private:
  void move_to(const Chord& chord, double position) {
    chord.at(position, scaled_);
    workspace_->unscale(scaled_, pose_);
  }

  /// The last feasible position between a feasible and an infeasible one, to rounding.
  double refined(const Chord& chord, double feasible, double infeasible) {
    while (std::abs(infeasible - feasible) > std::numeric_limits<double>::epsilon()) {
      const double middle = std::midpoint(feasible, infeasible);
      if (middle == feasible || middle == infeasible) break;
      move_to(chord, middle);
      (workspace_->judge(pose_).feasible() ? feasible : infeasible) = middle;
    }
    return feasible;
  }

  /// Keeps both ends of the feasible piece from entry_at_ to here.
  void keep_piece(const Chord& chord, double end) {
    if (std::abs(end - entry_at_) < kRounding) return;
    for (const double position : {entry_at_, end}) {
      move_to(chord, position);
      collector_->keep(pose_);
    }
  }

  const Workspace* workspace_;
  PoseCollector* collector_;
  Vector scaled_;
  Vector pose_;
  double entry_at_ = 0.0;
};

/// Whether two poses are equal to rounding in every scaled coordinate. Poses are sorted along a
/// direction that is parallel to no face, so only near neighbours need to be compared.
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

SelectedPoses boundary_poses(const PoseSelection& selection, const Model& model) {
  const Workspace workspace(selection, model);
  PoseCollector collector(workspace);
  Crossings crossings(workspace, collector);
  Lines lines(workspace.coordinates());
  const std::size_t most = std::max<std::size_t>(20'000, 100 * selection.count);
  for (std::size_t line = 0; collector.kept() < selection.count; ++line) {
    if (line == most) collector.fail(selection.count, selection.place);
    if (const auto chord = lines.next()) crossings.collect(*chord);
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
