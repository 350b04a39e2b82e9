#include "engine/model/platform_points.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "engine/base/contract.h"
#include "engine/model/forwarding_model.h"

namespace poesy {
namespace {

constexpr std::size_t kRows = 4;  // number of responses of each point: x, y, z and position (their norm)

/// The vector from the platform's origin to a point, in the base's axes (m). place: the point in the platform's frame
/// (m). R: the rotation base_R_platform [3 x 3], row-major.
PlatformPoint arm_of(const PlatformPoint& place, const std::array<double, 9>& R) {
  PlatformPoint arm{};
  for (std::size_t k = 0; k < 3; ++k) arm[k] = R[3 * k] * place[0] + R[3 * k + 1] * place[1] + R[3 * k + 2] * place[2];
  return arm;
}

/// The factors `once` and `twice` in exp(hat(theta)) - I = once * hat(theta) + twice * hat(theta)^2, where hat(theta)
/// is the skew-symmetric matrix of theta.
struct Turn {
  double once;
  double twice;
};

/// The factors for a rotation vector theta. square: |theta|^2, rad^2.
Turn turn_of(double square) {
  constexpr double kSmall = 1e-4;  // if |theta|^2 is smaller, the neglected terms of the series are below rounding
  if (square < kSmall) {
    return {1.0 - square / 6.0 * (1.0 - square / 20.0 * (1.0 - square / 42.0)),
            0.5 - square / 24.0 * (1.0 - square / 30.0 * (1.0 - square / 56.0))};
  }
  const double angle = std::sqrt(square);
  const double half = std::sin(0.5 * angle);
  return {std::sin(angle) / angle, 2.0 * half * half / square};
}

std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The index of the response of this name. Precondition: the model has this response.
std::size_t row_of(const ModelDescription& model, std::string_view name) {
  const auto found = std::ranges::find(model.responses, name, &Response::name);
  POESY_EXPECTS(found != model.responses.end());
  return static_cast<std::size_t>(found - model.responses.begin());
}

ModelDescription described(ModelDescription model, const std::vector<NamedPlatformPoint>& points) {
  for (const NamedPlatformPoint& point : points) {
    const std::size_t x = model.responses.size();
    for (const char axis : std::string_view("xyz")) {
      model.responses.push_back({point.name + "_" + axis, Dimension::length,
                                 "displacement of the point " + point.name + " along the base's " + axis});
    }
    if (!model.headline.empty()) model.headline.push_back(model.responses.size());
    model.responses.push_back({point.name + "_position",
                               Dimension::length,
                               "length of the displacement of the point " + point.name,
                               1.0,
                               {x, x + 1, x + 2}});
  }
  return model;
}

class PointedModel final : public ForwardingModel {
 public:
  PointedModel(std::unique_ptr<Model> model, std::vector<NamedPlatformPoint> points, PlatformOrientation orientation,
               bool is_linear)
      : ForwardingModel(std::move(model)),
        points_(std::move(points)),
        orientation_(std::move(orientation)),
        is_linear_(is_linear),
        description_(described(inner(), points_)),
        x_(row_of(inner(), "x")),
        theta_(row_of(inner(), "theta_x")) {}

  const ModelDescription& description() const override { return description_; }

  std::unique_ptr<Evaluator> formed(std::unique_ptr<Evaluator> evaluator) const override;
  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    std::optional<SolveTrace> trace = ForwardingModel::trace(pose, errors, options);
    if (!trace) return trace;
    trace->responses.resize(description_.responses.size());
    displace(arms_at(pose), trace->responses, 1);
    return trace;
  }
  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return point_of(response) ? std::vector<double>() : ForwardingModel::norm_of_details(response, pose);
  }
  double rounding(std::size_t response) const override {
    const NamedPlatformPoint* const point = point_of(response);
    if (point == nullptr) return ForwardingModel::rounding(response);
    const auto& [px, py, pz] = point->place;
    return ForwardingModel::rounding(x_) + std::hypot(px, py, pz) * ForwardingModel::rounding(theta_);
  }
  std::optional<Sketch> sketch(std::span<const double> pose) const override {
    std::optional<Sketch> sketch = ForwardingModel::sketch(pose);
    if (!sketch) return sketch;
    const std::vector<PlatformPoint> arms = arms_at(pose);
    for (std::size_t n = 0; n < points_.size(); ++n) {
      const auto& [x, y, z] = sketch->platform;
      sketch->points.push_back({points_[n].name, {x + arms[n][0], y + arms[n][1], z + arms[n][2]}});
    }
    return sketch;
  }

  /// The vectors from the platform's origin to the points at a pose, in the base's axes (m).
  std::vector<PlatformPoint> arms_at(std::span<const double> pose) const {
    const std::array<double, 9> R = orientation_(pose);
    std::vector<PlatformPoint> arms;
    for (const NamedPlatformPoint& point : points_) arms.push_back(arm_of(point.place, R));
    return arms;
  }

  /// Computes the responses of the points from the displacement of the platform. arms: from arms_at(). rows: the values
  /// of all responses [responses x samples], row-major.
  void displace(std::span<const PlatformPoint> arms, std::span<double> rows, std::size_t samples) const {
    for (std::size_t b = 0; b < samples; ++b) {
      std::array<double, 3> moved{};
      std::array<double, 3> theta{};
      for (std::size_t k = 0; k < 3; ++k) {
        moved[k] = rows[(x_ + k) * samples + b];
        theta[k] = rows[(theta_ + k) * samples + b];
      }
      const double square = theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2];
      const Turn turn = is_linear_ ? Turn{1.0, 0.0} : turn_of(square);
      std::size_t to = of_model() * samples + b;
      for (const PlatformPoint& arm : arms) {
        const std::array<double, 3> once = cross(theta, arm);
        const std::array<double, 3> twice = cross(theta, once);
        double sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k, to += samples) {
          rows[to] = moved[k] + turn.once * once[k] + turn.twice * twice[k];
          sum += rows[to] * rows[to];
        }
        rows[to] = std::sqrt(sum);
        to += samples;
      }
    }
  }

  /// The number of responses of the wrapped model; the responses of the points follow them.
  std::size_t of_model() const { return inner().responses.size(); }

 private:
  const ModelDescription& inner() const { return ForwardingModel::description(); }

  /// The point to which the response belongs; null for a response of the wrapped model.
  const NamedPlatformPoint* point_of(std::size_t response) const {
    return response < of_model() ? nullptr : &points_[(response - of_model()) / kRows];
  }

  std::vector<NamedPlatformPoint> points_;
  PlatformOrientation orientation_;
  bool is_linear_;
  ModelDescription description_;
  std::size_t x_;      ///< index of the response x; y and z follow
  std::size_t theta_;  ///< index of the response theta_x; theta_y and theta_z follow
};

class PointsEvaluator final : public Evaluator {
 public:
  PointsEvaluator(std::unique_ptr<Evaluator> inner, const PointedModel& model)
      : inner_(std::move(inner)), model_(&model) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    OutcomeBlock inner = outcomes;
    inner.responses = outcomes.responses.first(model_->of_model() * samples.count);
    inner_->evaluate(samples, inner);
    model_->displace(arms_at(samples.pose), outcomes.responses, samples.count);
  }

 private:
  /// The largest number of poses for which the vectors to the points are cached. The cache pays because many blocks
  /// have the same pose, and a model may have to iterate to find the platform's orientation.
  static constexpr std::size_t kMostPoses = 1024;

  std::span<const PlatformPoint> arms_at(std::span<const double> pose) {
    key_.assign(pose.begin(), pose.end());
    const auto known = arms_.find(key_);
    if (known != arms_.end()) return known->second;
    if (arms_.size() >= kMostPoses) arms_.clear();
    return arms_.emplace(key_, model_->arms_at(pose)).first->second;
  }

  std::unique_ptr<Evaluator> inner_;
  const PointedModel* model_;
  std::vector<double> key_;
  std::map<std::vector<double>, std::vector<PlatformPoint>> arms_;  ///< vectors to the points, by pose
};

std::unique_ptr<Evaluator> PointedModel::formed(std::unique_ptr<Evaluator> evaluator) const {
  if (evaluator == nullptr) return nullptr;
  return std::make_unique<PointsEvaluator>(std::move(evaluator), *this);
}

}  // namespace

std::unique_ptr<Model> with_platform_points(std::unique_ptr<Model> model, std::vector<NamedPlatformPoint> points,
                                            PlatformOrientation orientation, bool is_linear) {
  if (points.empty()) return model;
  return std::make_unique<PointedModel>(std::move(model), std::move(points), std::move(orientation), is_linear);
}

}  // namespace poesy
