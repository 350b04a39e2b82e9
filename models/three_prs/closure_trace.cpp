#include "models/three_prs/closure_trace.h"

#include <algorithm>

#include "models/three_prs/closure_solver.h"
#include "models/three_prs/evaluators.h"

namespace poesy::three_prs {
namespace {

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

SolveTrace closure_trace(const Geometry& geometry, std::span<const double> pose, std::span<const double> errors,
                         const SolverOptions& options) {
  const Configuration nominal = configuration(geometry, {pose[0], pose[1], pose[2]});
  SolveTrace trace;
  trace.solver = "Newton on the closure of all limbs, in plain double precision, from the first order";
  trace.columns = {{"step_angle", "rad"}, {"step_length", "m"}, {"residual_rods", "m^2"}, {"residual_joints", "m"}};
  const auto observe = [&](const ClosureIteration& iteration) {
    for (const lie::Screw<double>& each : {iteration.step, iteration.residual}) {
      trace.rows.push_back(each.head<3>().cwiseAbs().maxCoeff());
      trace.rows.push_back(each.tail<3>().cwiseAbs().maxCoeff());
    }
  };
  close_sample(geometry, nominal, one_sample(pose, errors), 0, ClosureStart(geometry, nominal), options,
               outcome_of(trace), observe);
  return trace;
}

SolveTrace first_order_trace(const Geometry& geometry, std::span<const double> pose, std::span<const double> errors) {
  SolveTrace trace;
  trace.solver = "one product with the matrix of first order, which iterates nothing";
  solve_once(*first_order_evaluator(geometry), pose, errors, trace);
  return trace;
}

std::unique_ptr<Evaluator> evaluator_of(const SolveTrace& head) { return std::make_unique<GivenOutcome>(head); }

void solve_once(Evaluator& evaluator, std::span<const double> pose, std::span<const double> errors, SolveTrace& trace) {
  evaluator.evaluate(one_sample(pose, errors), outcome_of(trace));
}

}  // namespace poesy::three_prs
