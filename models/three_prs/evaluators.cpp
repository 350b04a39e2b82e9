#include "models/three_prs/evaluators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/base/contract.h"
#include "models/three_prs/closure.h"
#include "models/three_prs/error_mapping.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;
using Errors = std::array<double, kFactors>;

Configuration configuration_at(const Geometry& geometry, std::span<const double> pose) {
  POESY_EXPECTS(pose.size() == 3);
  return configuration(geometry, {pose[0], pose[1], pose[2]});
}

/// What the errors that do not vary give, [12].
Eigen::Matrix<double, kMotions, 1> constant_part(const Effects& effects, const SampleBlock& samples) {
  POESY_EXPECTS(samples.errors.size() == kFactors);
  Eigen::Matrix<double, kFactors, 1> errors(samples.errors.data());
  for (const FactorIndex factor : samples.varied) errors[static_cast<Eigen::Index>(factor.value)] = 0.0;
  return effects * errors;
}

/// Rows of `effects` times the errors of each sample, [rows x B]; by tiles of samples, whose errors stay in the nearest
/// cache while all rows read them.
void multiply(const Effects& effects, int first, int rows, const SampleBlock& samples, std::span<double> responses) {
  constexpr std::size_t kTile = 64;
  const Eigen::Matrix<double, kMotions, 1> constant = constant_part(effects, samples);
  for (std::size_t begin = 0; begin < samples.count; begin += kTile) {
    const std::size_t size = std::min(kTile, samples.count - begin);
    for (int r = 0; r < rows; ++r) {
      double* out = responses.data() + static_cast<std::size_t>(r) * samples.count + begin;
      std::fill_n(out, size, constant[first + r]);
      for (std::size_t v = 0; v < samples.varied.size(); ++v) {
        const double effect = effects(first + r, static_cast<Eigen::Index>(samples.varied[v].value));
        const double* values = samples.values.data() + v * samples.count + begin;
        for (std::size_t b = 0; b < size; ++b) out[b] += effect * values[b];
      }
    }
  }
}

/// The norm of the vector whose three rows begin at `first`, [B].
void norms(std::span<double> responses, std::size_t first, std::size_t norm, std::size_t count) {
  const double* x = responses.data() + first * count;
  double* out = responses.data() + norm * count;
  for (std::size_t b = 0; b < count; ++b) {
    out[b] = std::sqrt(x[b] * x[b] + x[b + count] * x[b + count] + x[b + 2 * count] * x[b + 2 * count]);
  }
}

class FirstOrderEvaluator final : public Evaluator {
 public:
  explicit FirstOrderEvaluator(const Geometry& geometry) : geometry_(geometry) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    POESY_EXPECTS(outcomes.responses.size() == kResponses * samples.count);
    const Effects effects = first_order_effects(geometry_, configuration_at(geometry_, samples.pose));
    multiply(effects, 0, kComponents, samples, outcomes.responses);
    all_norms(outcomes.responses, samples.count);
    if (!outcomes.details.empty()) multiply(effects, kSwing, kLimbs, samples, outcomes.details);
    const bool singular = !effects.allFinite();
    for (std::size_t b = 0; b < samples.count; ++b) {
      outcomes.status[b] = singular                                          ? SolveStatus::singular
                           : is_finite(outcomes.responses, b, samples.count) ? SolveStatus::converged
                                                                             : SolveStatus::non_finite;
      outcomes.iterations[b] = 1;
    }
  }

 private:
  Geometry geometry_;
};

class ExactEvaluator final : public Evaluator {
 public:
  ExactEvaluator(const Geometry& geometry, const SolverOptions& options) : geometry_(geometry), options_(options) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    POESY_EXPECTS(outcomes.responses.size() == kResponses * samples.count);
    nominal_ = configuration_at(geometry_, samples.pose);
    // The first order of theta and dr is where each sample starts.
    multiply(first_order_effects(geometry_, nominal_), 0, kTip, samples, outcomes.responses);
    std::ranges::copy(samples.errors, errors_.begin());
    for (std::size_t i = 0; i < kLimbs; ++i) update_limb(i);
    std::array<bool, kLimbs> varies{};
    for (const FactorIndex factor : samples.varied) varies[factor.value / kSources] = true;
    for (std::size_t b = 0; b < samples.count; ++b) {
      for (std::size_t v = 0; v < samples.varied.size(); ++v) {
        errors_[samples.varied[v].value] = samples.values[v * samples.count + b];
      }
      for (std::size_t i = 0; i < kLimbs; ++i) {
        if (varies[i]) update_limb(i);
      }
      solve(b, samples.count, outcomes);
    }
    all_norms(outcomes.responses, samples.count);
  }

 private:
  void update_limb(std::size_t limb) {
    limbs_[limb] =
        limb_with_errors(geometry_, nominal_, limb, std::span(errors_).subspan(limb * kSources).first<kSources>());
  }

  void solve(std::size_t sample, std::size_t count, const OutcomeBlock& outcomes) const {
    const auto rows = [&](std::size_t first) {
      return Eigen::Map<Vector3, 0, Eigen::InnerStride<>>(outcomes.responses.data() + first * count + sample,
                                                          Eigen::InnerStride<>(static_cast<Eigen::Index>(count)));
    };
    PlatformMotion motion{lie::exp<double>(Vector3(rows(kTheta))), rows(kDr)};
    const Closing closing = close_limbs(limbs_, nominal_.platform.p, options_, motion);
    const Vector3 to_tip = tool(geometry_, nominal_.platform.R);
    rows(kTheta) = lie::log(motion.E);
    rows(kDr) = motion.dr;
    rows(kTip) = motion.dr + (motion.E * to_tip - to_tip);
    outcomes.status[sample] = closing.status;
    outcomes.iterations[sample] = closing.iterations;
    if (outcomes.details.empty()) return;
    for (std::size_t i = 0; i < kLimbs; ++i) {
      outcomes.details[i * count + sample] = swing(limbs_[i], nominal_.platform.p, motion) - nominal_.limbs[i].swing;
    }
  }

  Geometry geometry_;
  SolverOptions options_;
  Configuration nominal_;
  Errors errors_{};
  std::array<LimbWithErrors, kLimbs> limbs_;
};

}  // namespace

std::vector<Response> responses() {
  std::vector<Response> list;
  const auto add = [&](const char* name, const char* axes, Dimension dimension, const std::string& what) {
    for (const char* axis = axes; *axis != '\0'; ++axis) {
      list.push_back({std::string(name) + *axis, dimension, what + *axis + " of the base frame"});
    }
  };
  add("theta_", "xyz", Dimension::angle, "rotation vector of the platform, along ");
  add("", "xyz", Dimension::length, "displacement of the platform's centre P along ");
  add("tip_", "xyz", Dimension::length, "displacement of the tool tip along ");
  list.push_back({"rotation", Dimension::angle, "angle by which the platform turns"});
  list.push_back({"position", Dimension::length, "distance by which the platform's centre P moves"});
  list.push_back({"tip_position", Dimension::length, "distance by which the tool tip moves"});
  return list;
}

std::vector<Detail> details() {
  return {{"swing", {"limb_1", "limb_2", "limb_3"}, "rad", "additional swing of each rod about its revolute joint"}};
}

void all_norms(std::span<double> responses, std::size_t count) {
  norms(responses, kTheta, kComponents, count);
  norms(responses, kDr, kComponents + 1, count);
  norms(responses, kTip, kComponents + 2, count);
}

bool is_finite(std::span<const double> responses, std::size_t sample, std::size_t count) {
  return std::isfinite(responses[kComponents * count + sample]) &&
         std::isfinite(responses[(kComponents + 1) * count + sample]) &&
         std::isfinite(responses[(kComponents + 2) * count + sample]);
}

std::unique_ptr<Evaluator> first_order_evaluator(const Geometry& geometry) {
  return std::make_unique<FirstOrderEvaluator>(geometry);
}

std::unique_ptr<Evaluator> exact_evaluator(const Geometry& geometry, const SolverOptions& options) {
  return std::make_unique<ExactEvaluator>(geometry, options);
}

}  // namespace poesy::three_prs
