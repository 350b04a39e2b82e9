#include "models/three_prs/evaluators.h"

#include <algorithm>
#include <array>
#include <string>

#include "engine/base/contract.h"
#include "models/three_prs/closure.h"
#include "models/three_prs/error_mapping.h"
#include "models/three_prs/kernels.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;

Configuration configuration_at(const Geometry& geometry, std::span<const double> pose) {
  POESY_EXPECTS(pose.size() == 3);
  return configuration(geometry, {pose[0], pose[1], pose[2]});
}

class FirstOrderEvaluator final : public Evaluator {
 public:
  explicit FirstOrderEvaluator(const Geometry& geometry)
      : geometry_(geometry), kernels_(simd::for_selected_isa([]<simd::Isa isa> { return kernels<isa>(); })) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    const Effects effects = first_order_effects(geometry_, configuration_at(geometry_, samples.pose));
    prepare(effects, samples);
    const FirstOrderMap map{samples.varied.size(), columns_.data(), constant_.data()};
    tiles_.for_each(samples, outcomes, [&](const Tile& tile) { kernels_.map_tile(map, tile); });
    if (!effects.allFinite()) std::ranges::fill(outcomes.status, SolveStatus::singular);
  }

 private:
  void prepare(const Effects& effects, const SampleBlock& samples) {
    POESY_EXPECTS(samples.errors.size() == kFactors);
    Eigen::Matrix<double, kFactors, 1> constant(samples.errors.data());
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      const auto factor = static_cast<Eigen::Index>(samples.varied[v].value);
      constant[factor] = 0.0;
      Eigen::Map<Column>(columns_.data() + v * kMapRows) = effects.col(factor);
    }
    Eigen::Map<Column>(constant_.data()) = effects * constant;
  }

  using Column = Eigen::Matrix<double, kMotions, 1>;
  static_assert(kMotions == kMapRows && kSwing == kVectorRows);

  Geometry geometry_;
  Kernels kernels_;
  Tiles tiles_;
  std::array<double, kFactors * kMapRows> columns_{};
  std::array<double, kMapRows> constant_{};
};

class ExactEvaluator final : public Evaluator {
 public:
  ExactEvaluator(const Geometry& geometry, const SolverOptions& options)
      : geometry_(geometry), solver_(geometry, options) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    const Configuration nominal = configuration_at(geometry_, samples.pose);
    solver_.solve(nominal, samples, {outcomes.responses, outcomes.status, outcomes.iterations, {}});
    if (outcomes.details.empty()) return;
    for (std::size_t b = 0; b < samples.count; ++b) add_swings(nominal, samples, b, outcomes);
  }

 private:
  void add_swings(const Configuration& nominal, const SampleBlock& samples, std::size_t sample,
                  const OutcomeBlock& outcomes) const {
    const auto limbs = limbs_of_sample(geometry_, nominal, samples, sample);
    const auto rows = [&](int first) {
      const double* row = outcomes.responses.data() + static_cast<std::size_t>(first) * samples.count + sample;
      return Vector3(row[0], row[samples.count], row[2 * samples.count]);
    };
    const PlatformMotion motion{lie::exp(rows(kTheta)), rows(kDr)};
    for (std::size_t i = 0; i < kLimbs; ++i) {
      outcomes.details[i * samples.count + sample] =
          swing(limbs[i], nominal.platform.p, motion) - nominal.limbs[i].swing;
    }
  }

  Geometry geometry_;
  ClosureSolver solver_;
};

class GivenOutcome final : public Evaluator {
 public:
  /// Refers to the trace.
  explicit GivenOutcome(const SolveTrace& given) : given_(&given) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    for (std::size_t r = 0; r < given_->responses.size(); ++r) {
      std::ranges::fill(outcomes.responses.subspan(r * samples.count, samples.count), given_->responses[r]);
    }
    std::ranges::fill(outcomes.status, given_->status);
    std::ranges::fill(outcomes.iterations, given_->iterations);
  }

 private:
  const SolveTrace* given_;
};

/// A sample without varied errors, and where its outcome goes.
SampleBlock one_sample(std::span<const double> pose, std::span<const double> errors) {
  return {pose, errors, {}, {}, 1};
}

OutcomeBlock outcome_of(SolveTrace& trace) {
  trace.responses.resize(kResponses);
  return {trace.responses, {&trace.status, 1}, {&trace.iterations, 1}, {}};
}

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

std::unique_ptr<Evaluator> head_evaluator(const Geometry& geometry, Fidelity fidelity, const SolverOptions& options) {
  if (fidelity == Fidelity::first_order) return std::make_unique<FirstOrderEvaluator>(geometry);
  return std::make_unique<ExactEvaluator>(geometry, options);
}

SolveTrace head_trace(const Geometry& geometry, Fidelity fidelity, std::span<const double> pose,
                      std::span<const double> errors, const SolverOptions& options) {
  SolveTrace trace;
  if (fidelity == Fidelity::first_order) {
    trace.solver = "one product with the matrix of first order, which iterates nothing";
    solve_once(*head_evaluator(geometry, fidelity, options), pose, errors, trace);
    return trace;
  }
  trace.solver = "Newton on the closure of all limbs, in plain double precision, from the first order";
  trace.columns = {{"step_angle", "rad"}, {"step_length", "m"}, {"residual_rods", "m^2"}, {"residual_joints", "m"}};
  const auto observe = [&](const ClosureIteration& iteration) {
    for (const lie::Screw<double>& each : {iteration.step, iteration.residual}) {
      trace.rows.push_back(each.head<3>().cwiseAbs().maxCoeff());
      trace.rows.push_back(each.tail<3>().cwiseAbs().maxCoeff());
    }
  };
  const Configuration nominal = configuration_at(geometry, pose);
  close_sample(geometry, nominal, one_sample(pose, errors), 0, ClosureStart(geometry, nominal), options,
               outcome_of(trace), observe);
  return trace;
}

std::unique_ptr<Evaluator> evaluator_of(const SolveTrace& head) { return std::make_unique<GivenOutcome>(head); }

void solve_once(Evaluator& evaluator, std::span<const double> pose, std::span<const double> errors, SolveTrace& trace) {
  evaluator.evaluate(one_sample(pose, errors), outcome_of(trace));
}

}  // namespace poesy::three_prs
