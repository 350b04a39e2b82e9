#include "models/assembly/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/base/contract.h"
#include "engine/linalg/decompositions.h"
#include "models/assembly/block_solver.h"
#include "models/chain/metric.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using chain::Fidelity;

Index index(std::size_t value) { return static_cast<Index>(value); }

/// A mechanism's reach and metric at a pose, and what follows from them for all samples there.
struct AtPose {
  Nominal pose;
  Matrix by_error;  ///< first order: [6 bodies + 6 limbs x F] twists of bodies and wrenches of limbs
  Eigen::VectorXd by_load;
  bool is_regular = true;
};

/// Twists of bodies, then wrenches of limbs.
Matrix stacked(const Balance& balance) {
  Matrix all(balance.twists.rows() + balance.wrenches.rows(), balance.twists.cols());
  all << balance.twists, balance.wrenches;
  return all;
}

Balance unstacked(const AssemblyModel& model, const Matrix& all) {
  const Index twists = 6 * index(model.assembly.bodies.size());
  return {all.bottomRows(all.rows() - twists), all.topRows(twists)};
}

AtPose at_pose(const AssemblyModel& model, std::span<const double> pose, Fidelity fidelity) {
  AtPose made{.pose = model.at(pose), .by_error = {}, .by_load = {}};
  if (fidelity == Fidelity::exact) return made;
  const FirstOrder first_order(model.assembly, made.pose, model.ranks);
  made.is_regular = first_order.is_regular();
  made.by_error = stacked(first_order.effect(error_twists(model, made.pose)));
  made.by_load = stacked(first_order.by_load());
  return made;
}

class AssemblyEvaluator final : public Evaluator {
 public:
  AssemblyEvaluator(const AssemblyModel& model, const SolverOptions& options, Fidelity fidelity)
      : model_(&model), fidelity_(fidelity), solver_(model, options) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    const AtPose& at = at_pose_of(samples.pose);
    const auto put = [&](std::size_t b, const Outcome& outcome, SolveStatus status, std::uint32_t iterations) {
      const std::vector<double> values =
          response_values(model_->assembly, model_->report, model_->deforms, at.pose, outcome);
      POESY_EXPECTS(outcomes.responses.size() == values.size() * samples.count);
      for (std::size_t r = 0; r < values.size(); ++r) outcomes.responses[r * samples.count + b] = values[r];
      outcomes.status[b] = status;
      outcomes.iterations[b] = iterations;
    };
    if (fidelity_ == Fidelity::exact) {
      solver_.solve(at.pose, samples, [&](std::size_t b, const Solution& solution) {
        put(b, outcome_of(model_->assembly, at.pose, solution), solution.status, solution.iterations);
      });
      return;
    }
    const SolveStatus status = at.is_regular ? SolveStatus::converged : SolveStatus::singular;
    Eigen::VectorXd errors = Eigen::Map<const Eigen::VectorXd>(samples.errors.data(), index(samples.errors.size()));
    for (std::size_t b = 0; b < samples.count; ++b) {
      for (std::size_t v = 0; v < samples.varied.size(); ++v) {
        errors[index(samples.varied[v].value)] = samples.values[v * samples.count + b];
      }
      const Balance balance = unstacked(*model_, at.by_load + at.by_error * errors);
      put(b, outcome_of(model_->assembly, at.pose, balance, 0), status, 1);
    }
  }

 private:
  static constexpr std::size_t kMostPoses = 256;  ///< that are remembered

  const AtPose& at_pose_of(std::span<const double> pose) {
    if (poses_.size() > kMostPoses) {
      poses_.clear();
      solver_.forget();
    }
    std::vector<double> key(pose.begin(), pose.end());
    const auto known = poses_.find(key);
    if (known != poses_.end()) return known->second;
    return poses_.emplace(std::move(key), at_pose(*model_, pose, fidelity_)).first->second;
  }

  const AssemblyModel* model_;
  Fidelity fidelity_;
  BlockSolver solver_;
  std::map<std::vector<double>, AtPose> poses_;
};

}  // namespace

Matrix error_twists(const AssemblyModel& model, const Nominal& pose) {
  Matrix G = Matrix::Zero(6 * index(model.assembly.limbs.size()), index(model.slots.size()));
  for (std::size_t f = 0; f < model.slots.size(); ++f) {
    const chain::ErrorSlot& slot = model.slots[f];
    const Limb& limb = model.assembly.limbs[slot.limb];
    G.block<6, 1>(6 * index(slot.limb), index(f)) =
        slot.scale * error_twist(limb, pose.bodies[limb.from], pose.limbs[slot.limb], slot.frame, slot.component);
  }
  return G;
}

std::vector<Response> responses_of(const AssemblyModel& model) {
  return responses_of(model.assembly, model.report, model.deforms);
}

std::unique_ptr<Evaluator> assembly_evaluator(const AssemblyModel& model, const SolverOptions& options,
                                              Fidelity fidelity) {
  return std::make_unique<AssemblyEvaluator>(model, options, fidelity);
}

SolveTrace assembly_trace(const AssemblyModel& model, std::span<const double> pose, std::span<const double> errors,
                          const SolverOptions& options, Fidelity fidelity) {
  SolveTrace trace;
  const AtPose at = at_pose(model, pose, fidelity);
  const auto responses = [&](const Outcome& outcome) {
    return response_values(model.assembly, model.report, model.deforms, at.pose, outcome);
  };
  if (fidelity == Fidelity::first_order) {
    trace.solver = "the closed form of first order, in plain double precision, which iterates nothing";
    trace.status = at.is_regular ? SolveStatus::converged : SolveStatus::singular;
    trace.iterations = 1;
    const Eigen::Map<const Eigen::VectorXd> e(errors.data(), index(errors.size()));
    trace.responses = responses(outcome_of(model.assembly, at.pose, unstacked(model, at.by_load + at.by_error * e), 0));
    return trace;
  }
  trace.solver = "Newton on the equilibrium of the bodies, in plain double precision, from the nominal pose";
  trace.columns = {{"step over reach", "1"}};
  Solver solver(model.assembly, model.ranks, options);
  solver.prepare(at.pose);
  ErrorFrames frames(model);
  const Solution solution = solver.solve(frames.with(errors));
  trace.rows = solution.steps;
  trace.status = solution.status;
  trace.iterations = solution.iterations;
  trace.responses = responses(outcome_of(model.assembly, at.pose, solution));
  return trace;
}

double condition(const AssemblyModel& model, std::span<const double> pose) {
  const Nominal at = model.at(pose);
  Matrix B = motion_columns(model.assembly, at.limbs, linalg::cholesky_root(at.W));
  B.colwise().normalize();
  const Eigen::VectorXd values = linalg::singular_values(B);
  const double smallest = values[values.size() - 1 - index(model.idle)];
  const double rounding = static_cast<double>(values.size()) * std::numeric_limits<double>::epsilon();
  return smallest > rounding * values[0] ? values[0] / smallest : std::numeric_limits<double>::infinity();
}

double effect_rounding(const AssemblyModel& model, const Response& response) {
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const double reach = model.assembly.reach;
  if (response.dimension == Dimension::length) return rounding * reach;
  if (response.dimension == Dimension::angle) return rounding * reach / chain::radius_of(model.assembly.points);
  if (response.dimension == Dimension::force) return rounding * reach * model.stiffness;
  if (response.dimension == Dimension::moment) return rounding * reach * reach * model.stiffness;
  return 0.0;  // energy is a product of what rounds
}

double largest_stiffness(const AssemblyModel& model, const Nominal& pose) {
  const auto rows = 6 * index(model.assembly.limbs.size());
  const Matrix wrenches = FirstOrder(model.assembly, pose, model.ranks).effect(Matrix::Identity(rows, rows)).wrenches;
  double largest = 0.0;
  for (Index row = 3; row < rows; row += 6) {
    for (Index column = 3; column < rows; column += 6) {
      largest = std::max(largest, wrenches.block<3, 3>(row, column).cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

}  // namespace poesy::assembly
