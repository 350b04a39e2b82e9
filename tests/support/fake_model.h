#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/model/model.h"

namespace poesy::test {

/// A mechanism with closed-form answers: response r = |sum over factors p of weight(r, p, pose) * error p|.
/// Pose (z, beta, gamma), in reach below z = 0. One geometry parameter, `arm`, scales every weight.
/// Three factors: delta_1 (length), epsilon_1 (angle) and delta_2 (length), the last without effect.
class FakeModel : public Model {
 public:
  static constexpr double kArm = 0.06;

  explicit FakeModel(double arm = kArm);

  static ModelDescription describe();

  /// The derivative of a response by an error, before the absolute value: arm * kWeights[r][p] * (1 + beta + 2 gamma -
  /// z).
  static double weight(double arm, std::size_t response, std::size_t factor, std::span<const double> pose) {
    constexpr double kWeights[2][3] = {{2.0, 3.0, 0.0}, {0.5, 1.0, 0.0}};
    return arm * kWeights[response][factor] * (1.0 + pose[1] + 2.0 * pose[2] - pose[0]);
  }

  const ModelDescription& description() const override { return description_; }

  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    if (pose[0] < 0.0) return std::nullopt;
    return "z must be negative";
  }

  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    return {-pose[0], pose[1] + pose[2]};
  }

  /// Singular at beta = +-90 deg.
  double condition(std::span<const double> pose) const override { return 1.0 / std::abs(std::cos(pose[1])); }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override;

  /// Chart "sums": depth = -z, sum = beta + gamma, difference = beta - gamma. No pose has |sum| > 2 rad. For sums below
  /// -2 rad, no_pose_because() states the reason.
  std::optional<std::vector<double>> pose_from_chart(std::size_t /*chart*/,
                                                     std::span<const double> sums) const override {
    if (std::abs(sums[1]) > 2.0) return std::nullopt;
    return std::vector{-sums[0], 0.5 * (sums[1] + sums[2]), 0.5 * (sums[1] - sums[2])};
  }

  std::string no_pose_because(std::size_t /*chart*/, std::span<const double> sums) const override {
    return sums[1] < -2.0 ? "both tilts end at -1 rad" : "";
  }

 private:
  ModelDescription description_ = describe();
  double arm_;
};

/// The evaluator of FakeModel. The details are the sums of both responses before the absolute value.
class FakeEvaluator : public Evaluator {
 public:
  explicit FakeEvaluator(double arm) : arm_(arm) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    std::vector<double> errors(samples.errors.begin(), samples.errors.end());
    for (std::size_t b = 0; b < samples.count; ++b) {
      for (std::size_t v = 0; v < samples.varied.size(); ++v) {
        errors[samples.varied[v].value] = samples.values[v * samples.count + b];
      }
      for (std::size_t r = 0; r < 2; ++r) {
        double sum = 0.0;
        for (std::size_t p = 0; p < errors.size(); ++p) {
          sum += FakeModel::weight(arm_, r, p, samples.pose) * errors[p];
        }
        outcomes.responses[r * samples.count + b] = std::abs(sum);
        if (!outcomes.details.empty()) outcomes.details[r * samples.count + b] = sum;
      }
      outcomes.status[b] = SolveStatus::converged;
      outcomes.iterations[b] = 1;
    }
  }

 private:
  double arm_;
};

inline FakeModel::FakeModel(double arm) : arm_(arm) {
  if (!(arm > 0.0)) throw std::invalid_argument("arm must be greater than zero");
}

inline std::unique_ptr<Evaluator> FakeModel::evaluator(const SolverOptions& /*options*/) const {
  return std::make_unique<FakeEvaluator>(arm_);
}

inline ModelDescription FakeModel::describe() {
  ModelDescription model;
  model.name = "fake";
  model.title = "a linear toy mechanism with closed-form responses";
  model.geometry = {{"arm", Dimension::length, kArm, "scales every response"}};
  model.pose_coordinates = {{"z", Dimension::length, "height"},
                            {"beta", Dimension::angle, "first tilt"},
                            {"gamma", Dimension::angle, "second tilt"}};
  model.factors = {{"delta_1", Dimension::length, 1, 0, "a position error"},
                   {"epsilon_1", Dimension::angle, 1, 0, "an angular error"},
                   {"delta_2", Dimension::length, 2, 0, "an error without effect"}};
  model.factor_sets = {{"all", "every error", {FactorIndex(0), FactorIndex(1), FactorIndex(2)}},
                       {"deforming", "errors with an effect", {FactorIndex(0), FactorIndex(1)}},
                       {"benign", "errors without effect", {FactorIndex(2)}}};
  model.responses = {{"angular_deformation", Dimension::angle, "first response"},
                     {"linear_deformation", Dimension::length, "second response"}};
  model.deformation = DeformationMeasure{1, 1e-14};
  model.details = {{"signed", {"angular", "linear"}, "rad,m", "both sums before the absolute value"}};
  model.joints = {{"q_1", Dimension::length}, {"q_2", Dimension::angle}};
  model.pose_lower = {-0.30, -0.5, -0.6};
  model.pose_upper = {-0.18, 0.5, 0.6};
  model.sources = {{"D", "deforming"}, {"B", "benign"}};
  model.workspace_note = "a box inside reach";
  model.charts = {{"sums",
                   {{"depth", Dimension::length, "below z = 0"},
                    {"sum", Dimension::angle, "of both tilts"},
                    {"difference", Dimension::angle, "of both tilts"}},
                   "make the sum smaller"}};
  model.curves = {{"wave", "0.1 sin t m, t, 0", 0, 0.0, 4.0, {0.2, -1.0, 0.0}, [](double t) {
                     return std::vector{0.1 * std::sin(t), t, 0.0};
                   }}};
  return model;
}

/// A catalog with only the fake mechanism.
inline Catalog fake_catalog() {
  return {{FakeModel::describe(), [](std::span<const double> geometry, std::size_t /*fidelity*/) {
             return std::make_unique<FakeModel>(geometry[0]);
           }}};
}

inline const Catalog kFakeCatalog = fake_catalog();

}  // namespace poesy::test
