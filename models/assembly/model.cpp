#include "models/assembly/model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/base/contract.h"
#include "engine/linalg/decompositions.h"
#include "models/assembly/block_solver.h"
#include "models/assembly/closure.h"
#include "models/chain/metric.h"

namespace poesy::assembly {
namespace {

using Eigen::Index;
using Matrix = Eigen::MatrixXd;
using chain::Fidelity;

Index index(std::size_t value) { return static_cast<Index>(value); }

class AssemblyEvaluator final : public Evaluator {
 public:
  AssemblyEvaluator(const AssemblyModel& model, const SolverOptions& options, Fidelity fidelity)
      : model_(&model), options_(options), fidelity_(fidelity), solver_(model, options) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    PoseProblem& problem = problem_of(samples.pose);
    if (fidelity_ == Fidelity::exact) {
      solver_.solve(problem, samples, outcomes);
    } else {
      solver_.map(problem, samples, outcomes);
    }
  }

 private:
  static constexpr std::size_t kMostPoses = 256;  ///< all problems are discarded when more poses than this are stored

  PoseProblem& problem_of(std::span<const double> pose) {
    if (problems_.size() > kMostPoses) problems_.clear();
    std::vector<double> key(pose.begin(), pose.end());
    const auto known = problems_.find(key);
    if (known != problems_.end()) return known->second;
    return problems_.emplace(std::move(key), PoseProblem(*model_, model_->at(pose), options_)).first->second;
  }

  const AssemblyModel* model_;
  SolverOptions options_;
  Fidelity fidelity_;
  BlockSolver solver_;
  std::map<std::vector<double>, PoseProblem> problems_;
};

/// The solution for a single machine with the errors sample.errors. `sample` has no varied errors. The solvers are
/// those that BlockSolver uses for samples that the kernel does not solve.
Solution exact_solution(const AssemblyModel& model, const Nominal& at, const SampleBlock& sample,
                        const SolverOptions& options) {
  Closure closure(model, at);
  if (!model.over_constrained && closure.is_regular()) return Continuation(model, options).solve(at, sample.errors);
  Solver solver(model.assembly, model.ranks, options);
  solver.prepare(at);
  ErrorFrames frames(model);
  const std::vector<std::vector<Transform>>& with_errors = frames.with(sample.errors, at.displacements);
  Solution found = solver.solve(with_errors);
  double nearing = 0.0;
  closure.find_nearing(sample, {&nearing, 1});
  found.status = closure.opens(nearing, with_errors) ? SolveStatus::not_assembled : closure.judged(found, with_errors);
  return found;
}

}  // namespace

Nominal AssemblyModel::at(std::span<const double> pose) const {
  Nominal placed = nominal(assembly, joint_displacements(pose));
  if (!rounded) return placed;
  Solver solver(assembly, ranks, {.tolerance = chain::kToleranceByMetric});
  solver.prepare(placed);
  std::vector<std::vector<Transform>> frames;
  for (const Limb& limb : assembly.limbs) frames.push_back(limb.chain.home);
  Solution found = solver.solve(frames);
  placed.bodies = std::move(found.bodies);
  placed.displacements = std::move(found.displacements);
  placed.limbs = std::move(found.limbs);
  placed.mismatch = std::move(found.mismatch);
  return placed;
}

Screw term_twist(const AssemblyModel& model, const Nominal& pose, const chain::ErrorTerm& term) {
  const Limb& limb = model.assembly.limbs[term.limb];
  return term.at(pose.displacements) *
         error_twist(limb, pose.bodies[limb.from], pose.limbs[term.limb], term.frame, term.component);
}

Matrix error_twists(const AssemblyModel& model, const Nominal& pose) {
  Matrix G = Matrix::Zero(6 * index(model.assembly.limbs.size()), index(model.terms.size()));
  for (std::size_t f = 0; f < model.terms.size(); ++f) {
    for (const chain::ErrorTerm& term : model.terms[f]) {
      G.block<6, 1>(6 * index(term.limb), index(f)) += term_twist(model, pose, term);
    }
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
  const Nominal at = model.at(pose);
  const auto responses = [&](const Outcome& outcome) {
    return response_values(model.assembly, model.report, model.deforms, at, outcome);
  };
  if (fidelity == Fidelity::first_order) {
    const FirstOrder first_order(model.assembly, at, model.ranks);
    trace.solver = "the closed form of first order, in plain double precision, which iterates nothing";
    trace.status = first_order.is_regular() ? SolveStatus::converged : SolveStatus::singular;
    trace.iterations = 1;
    const Eigen::Map<const Eigen::VectorXd> e(errors.data(), index(errors.size()));
    Balance balance = first_order.effect(error_twists(model, at) * e);
    balance.wrenches += first_order.by_load().wrenches;
    balance.twists += first_order.by_load().twists;
    trace.responses = responses(outcome_of(model.assembly, at, balance, 0));
    return trace;
  }
  trace.solver = "Newton on the equilibrium of the bodies, in plain double precision, from the nominal pose";
  trace.columns = {{"step over reach", "1"}};
  const Solution solution = exact_solution(model, at, {pose, errors, {}, {}, 1}, options);
  trace.rows = solution.steps;
  trace.status = solution.status;
  trace.iterations = solution.iterations;
  trace.responses = responses(outcome_of(model.assembly, at, solution));
  return trace;
}

double condition(const AssemblyModel& model, std::span<const double> pose) {
  const Nominal at = model.at(pose);
  const Matrix B = motion_columns(model.assembly, at.limbs, linalg::cholesky_root(at.W));
  const Index bodies = 6 * index(at.bodies.size() - 1);
  Matrix joints = linalg::orthogonal_complement(B.rightCols(bodies)).transpose() * B.leftCols(B.cols() - bodies);
  joints.colwise().normalize();
  const Eigen::VectorXd values = linalg::singular_values(joints);
  const double smallest = values[joints.cols() - 1 - index(model.idle)];
  const double rounding = static_cast<double>(values.size()) * std::numeric_limits<double>::epsilon();
  return smallest > rounding * values[0] ? values[0] / smallest : std::numeric_limits<double>::infinity();
}

/// Returns true if two subspaces of the same dimension are almost equal. one, other: orthonormal bases.
static bool are_near(const Matrix& one, const Matrix& other) {
  constexpr double kLeast = 0.9;  // product of the cosines of the angles between them
  return one.cols() == other.cols() && std::abs(linalg::determinant(one.transpose() * other)) > kLeast;
}

/// B (motion_columns()) at a pose, with columns of balls for rotations about the base's axes. None if the axes of a
/// ball are nearly aligned.
static std::optional<Matrix> regular_columns(const AssemblyModel& model, std::span<const PassiveBall> balls,
                                             std::span<const double> pose) {
  constexpr double kAligned = 1e-3;  // volume that three unit vectors along the axes span
  Matrix B = motion_columns(model.assembly, model.at(pose).limbs, Matrix6::Identity());
  for (const PassiveBall& ball : balls) {
    auto columns = B.middleCols<3>(index(ball.column));
    const lie::Matrix3<double> axes = columns.middleRows<3>(6 * index(ball.limb));
    if (std::abs(axes.determinant()) < kAligned) return std::nullopt;
    columns *= axes.inverse();
  }
  return B;
}

std::optional<bool> are_separated(const AssemblyModel& model, std::span<const PassiveBall> balls,
                                  std::span<const double> one, std::span<const double> other) {
  const std::optional<Matrix> first = regular_columns(model, balls, one);
  const std::optional<Matrix> second = regular_columns(model, balls, other);
  if (!first || !second) return std::nullopt;
  const Matrix& at_one = *first;
  const Matrix& at_other = *second;
  const auto complement = [](const Matrix& columns) {
    constexpr double kIndependent = 1e-9;  // a smaller pivot, relative to the largest, counts as 0
    return linalg::orthogonal_complement(columns, kIndependent);
  };
  const Matrix left = complement(at_one);
  const Matrix idle = complement(at_one.transpose());
  const bool is_known = at_one.cols() + left.cols() == at_one.rows() + idle.cols() &&
                        are_near(left, complement(at_other)) && are_near(idle, complement(at_other.transpose()));
  if (!is_known) return std::nullopt;
  const auto determinant = [&](const Matrix& columns) {
    Matrix bordered = Matrix::Zero(columns.rows() + idle.cols(), columns.cols() + left.cols());
    bordered << columns, left, idle.transpose(), Matrix::Zero(idle.cols(), left.cols());
    return linalg::determinant(bordered);
  };
  return determinant(at_one) * determinant(at_other) < 0.0;
}

double effect_rounding(const AssemblyModel& model, const Response& response) {
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon();
  const double reach = model.assembly.reach;
  if (response.dimension == Dimension::length) return rounding * reach;
  if (response.dimension == Dimension::angle) return rounding * reach / chain::radius_of(model.assembly.points);
  if (response.dimension == Dimension::force) return rounding * reach * model.stiffness;
  if (response.dimension == Dimension::moment) return rounding * reach * reach * model.stiffness;
  return 0.0;  // energy is a product of two numbers, each of which may be rounding
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
