#include "models/three_prs/evaluators.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

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

class CalibratedEvaluator final : public Evaluator {
 public:
  CalibratedEvaluator(const Geometry& geometry, Fidelity fidelity, std::unique_ptr<Evaluator> uncorrected)
      : geometry_(geometry), fidelity_(fidelity), uncorrected_(std::move(uncorrected)) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    uncorrected_->evaluate(samples, outcomes);
    const Configuration nominal = configuration_at(geometry_, samples.pose);
    const Corrections by = corrections(geometry_, nominal);
    const Vector3 arm = tool(geometry_, nominal.platform.R);
    for (std::size_t b = 0; b < samples.count; ++b) correct(by, arm, b, outcomes);
    fill_norms(outcomes);
    if (!by.motions.allFinite() || !by.best.allFinite()) std::ranges::fill(outcomes.status, SolveStatus::singular);
  }

 private:
  using Rows = Eigen::Map<Eigen::VectorXd, 0, Eigen::InnerStride<>>;

  /// The rows of one sample in a block of responses or of swings. count: number of samples in the block.
  static Rows rows_of(std::span<double> block, std::size_t sample, std::size_t count) {
    return {block.data() + sample, static_cast<Eigen::Index>(block.size() / count),
            Eigen::InnerStride<>(static_cast<Eigen::Index>(count))};
  }

  void correct(const Corrections& by, const Vector3& arm, std::size_t sample, const OutcomeBlock& outcomes) const {
    const std::size_t count = outcomes.status.size();
    Rows responses = rows_of(outcomes.responses, sample, count);
    const lie::Screw<double> displacement = responses.head<6>();
    const Vector3 dq = by.best * displacement;
    const lie::Screw<double> left = displacement - by.motions.topRows<6>() * dq;
    const Vector3 theta = left.head<3>();
    responses.head<6>() = left;
    const bool linear = fidelity_ == Fidelity::first_order;
    responses.segment<3>(kTip) =
        left.tail<3>() + (linear ? Vector3(theta.cross(arm)) : lie::moved_by_rotation<double>(theta, arm));
    if (outcomes.details.empty()) return;
    rows_of(outcomes.details, sample, count) -= by.motions.bottomRows<3>() * dq;
  }

  Geometry geometry_;
  Fidelity fidelity_;
  std::unique_ptr<Evaluator> uncorrected_;
};

class GivenOutcome final : public Evaluator {
 public:
  /// Keeps a reference to the trace.
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

/// A block of one sample without varied errors.
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
  list.push_back({"rotation", Dimension::angle, "angle by which the platform turns", 1.0, {0, 1, 2}});
  list.push_back({"position", Dimension::length, "distance by which the platform's centre P moves", 1.0, {3, 4, 5}});
  list.push_back({"tip_position", Dimension::length, "distance by which the tool tip moves", 1.0, {6, 7, 8}});
  return list;
}

std::vector<Detail> details() {
  return {{"swing", {"limb_1", "limb_2", "limb_3"}, "rad", "additional swing of each rod about its revolute joint"}};
}

std::unique_ptr<Evaluator> head_evaluator(const Geometry& geometry, Fidelity fidelity, const SolverOptions& options) {
  if (fidelity == Fidelity::first_order) return std::make_unique<FirstOrderEvaluator>(geometry);
  return std::make_unique<ExactEvaluator>(geometry, options);
}

std::unique_ptr<Evaluator> calibrated_head_evaluator(const Geometry& geometry, Fidelity fidelity,
                                                     const SolverOptions& options) {
  return std::make_unique<CalibratedEvaluator>(geometry, fidelity, head_evaluator(geometry, fidelity, options));
}

void fill_norms(const OutcomeBlock& outcomes) {
  const std::size_t count = outcomes.status.size();
  double* const rows = outcomes.responses.data();
  for (std::size_t n = 0; n < kResponses - kComponents; ++n) {
    const double* const x = rows + 3 * n * count;
    double* const out = rows + (kComponents + n) * count;
    for (std::size_t b = 0; b < count; ++b) {
      out[b] = std::sqrt(x[b] * x[b] + x[b + count] * x[b + count] + x[b + 2 * count] * x[b + 2 * count]);
    }
  }
  for (std::size_t b = 0; b < count; ++b) {
    bool finite = true;
    for (std::size_t n = kComponents; n < kResponses; ++n) finite = finite && std::isfinite(rows[n * count + b]);
    if (usable(outcomes.status[b]) && !finite) outcomes.status[b] = SolveStatus::non_finite;
  }
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
