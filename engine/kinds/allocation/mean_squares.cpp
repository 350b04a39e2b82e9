#include "engine/kinds/allocation/mean_squares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "engine/base/archive.h"
#include "engine/base/nan.h"
#include "engine/kinds/allocation/load_solver.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/unit_fold.h"

namespace poesy {
namespace {

constexpr std::size_t kNodes = 3;            ///< mu - sigma, c, mu + sigma; c: Distribution::centre()
constexpr std::size_t kDrawsOfPiece = 16;    ///< draws of one piece of work
constexpr double kUnsolvedOverLimit = 10.0;  ///< response over limit of a sample without a solution
constexpr double kLargestSum = 1e100;        ///< largest sum of squares in a state; slopes from it are finite

/// The result of a piece of work at its pose: K limits, P errors.
struct AddedSquares {
  /// [K] y^2 of the mechanism whose errors are at their centres; NaN where it is not solved, and among others
  std::vector<double> base;
  std::vector<double> added;    ///< [K x P] sums over the draws
  std::vector<double> counted;  ///< [P] draws that were solved
  /// [K x P x kNodes] of limits on spreads: the response at each node of each error alone; NaN where it is not solved,
  /// and among others. Empty without such a limit.
  std::vector<double> nodes;

  AddedSquares() = default;
  AddedSquares(const RelativeLimits& limits, std::size_t errors)
      : base(limits.size(), kNaN),
        added(limits.size() * errors),
        counted(errors),
        nodes(limits.any_spread() ? added.size() * kNodes : 0, kNaN) {}

  void state(Archive& archive) {
    for (auto* list : {&base, &added, &counted, &nodes}) archive.reals(*list);
  }
};

/// The pieces of work: at each pose one for each error alone, then some for each error among draws of the others.
struct Pieces {
  std::size_t poses;
  std::size_t draws;

  std::size_t at_pose() const { return 1 + (draws + kDrawsOfPiece - 1) / kDrawsOfPiece; }
  std::size_t count() const { return poses * at_pose(); }
  PoseIndex pose(std::size_t n) const { return PoseIndex(n / at_pose()); }
  bool alone(std::size_t n) const { return n % at_pose() == 0; }
  std::size_t first_draw(std::size_t n) const { return (n % at_pose() - 1) * kDrawsOfPiece; }
  std::size_t draws_of(std::size_t n) const { return std::min(kDrawsOfPiece, draws - first_draw(n)); }
};

/// Solves pieces. Owns the scratch of one thread.
class AddedSquaresEvaluator : private UnitSolver {
 public:
  AddedSquaresEvaluator(const Plan& plan, const Model& model, const RelativeLimits& limits, const Pieces& pieces)
      : UnitSolver(plan, model, plan.factors().size()), limits_(limits), pieces_(pieces) {
    const std::size_t errors = plan.factors().size();
    draws_.resize(errors * pieces.draws);
    const WorkUnit all{0, PoseIndex(0), SampleIndex(0), pieces.draws};
    for (std::size_t p = 0; p < errors; ++p) {
      draw_uniforms(all, p, std::span(draws_).subspan(p * pieces.draws, pieces.draws));
    }
    plan.transform(draws_, pieces.draws);
    for (std::size_t k = 0; k < limits.size(); ++k) rounding_.push_back(model.rounding(limits.response(k)));
  }

  AddedSquares operator()(std::size_t n) {
    const std::size_t errors = plan_->factors().size();
    AddedSquares found(limits_, errors);
    const std::size_t samples = pieces_.alone(n) ? 1 : pieces_.draws_of(n);
    constexpr std::size_t kMostPairs = Plan::kUnitSamples / kNodes;
    for (std::size_t first = 0; first < samples * errors; first += kMostPairs) {
      add_pairs(n, first, std::min(kMostPairs, samples * errors - first), found);
    }
    return found;
  }

 private:
  /// The value of another error in a slot of the batch.
  double other(std::size_t n, std::size_t sample, std::size_t slot) const {
    if (pieces_.alone(n)) return plan_->distributions()[slot].centre();
    return draws_[slot * pieces_.draws + pieces_.first_draw(n) + sample];
  }

  /// Solves pairs of a sample and an error, sample by sample, at each of the three nodes.
  void add_pairs(std::size_t n, std::size_t first, std::size_t pairs, AddedSquares& found) {
    const std::size_t errors = plan_->factors().size();
    const std::size_t count = pairs * kNodes;
    for (std::size_t v = 0; v < errors; ++v) {
      double* const row = &values_[v * count];
      for (std::size_t k = 0; k < pairs; ++k) {
        std::fill_n(row + k * kNodes, kNodes, other(n, (first + k) / errors, v));
      }
    }
    for (std::size_t k = 0; k < pairs; ++k) {
      const std::size_t p = (first + k) % errors;
      const Distribution& error = plan_->distributions()[p];
      const std::array nodes{error.mean() - error.standard_deviation(), error.centre(),
                             error.mean() + error.standard_deviation()};
      std::ranges::copy(nodes, &values_[p * count + k * kNodes]);
    }
    const UnitOutcomes outcomes = UnitSolver::solve(pieces_.pose(n), plan_->factors(), count, 0.0);
    for (std::size_t k = 0; k < pairs; ++k) add(n, (first + k) % errors, k, outcomes, found);
  }

  void add(std::size_t n, std::size_t p, std::size_t pair, const UnitOutcomes& outcomes, AddedSquares& found) const {
    const auto status = outcomes.status.subspan(pair * kNodes, kNodes);
    const bool is_solved =
        std::ranges::all_of(status, [&](SolveStatus one) { return counts(one, plan_->not_converged()); });
    const bool alone = pieces_.alone(n);
    if (!is_solved && !alone) return;
    found.counted[p] += 1.0;
    const std::size_t samples = outcomes.status.size();
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      double& sum = found.added[k * plan_->factors().size() + p];
      const PoseIndex pose = pieces_.pose(n);
      if (!is_solved) {
        const double room = limits_.room(k, pose);
        sum += kUnsolvedOverLimit * kUnsolvedOverLimit * room * room;
        continue;
      }
      const auto values = outcomes.responses.subspan(limits_.response(k) * samples + pair * kNodes, kNodes);
      if (limits_.is_spread(k)) {
        if (alone) std::ranges::copy(values, &found.nodes[(k * plan_->factors().size() + p) * kNodes]);
        continue;
      }
      const double centre = limits_.centre(k, pose);
      const std::array y{values[0] - centre, values[1] - centre, values[2] - centre};
      if (alone && p == 0) found.base[k] = y[1] * y[1];
      const bool moves = std::max(std::abs(y[0] - y[1]), std::abs(y[2] - y[1])) > rounding_[k];
      if (moves) sum += 0.5 * (y[0] * y[0] + y[2] * y[2]) - y[1] * y[1];
    }
  }

  const RelativeLimits& limits_;
  const Pieces& pieces_;
  std::vector<double> draws_;     ///< [P x draws] of all errors, SI
  std::vector<double> rounding_;  ///< [K]
};

/// The results of all pieces: K limits at M poses, L rows in all.
struct SquareSums {
  const Pieces* pieces;
  std::size_t errors;           ///< P
  std::vector<double> base;     ///< [L]
  std::vector<double> alone;    ///< [L x P]
  std::vector<double> among;    ///< [L x P] summed over draws
  std::vector<double> counted;  ///< [M x P] draws
  std::vector<double> nodes;    ///< [L x P x kNodes] of limits on spreads; empty without one

  SquareSums(const Pieces& all, const RelativeLimits& limits, std::size_t error_count)
      : pieces(&all),
        errors(error_count),
        base(limits.size() * all.poses),
        alone(base.size() * errors),
        among(alone.size()),
        counted(all.poses * errors),
        nodes(limits.any_spread() ? alone.size() * kNodes : 0, kNaN) {}

  void add(std::size_t n, const AddedSquares& found) {
    const std::size_t m = pieces->pose(n).value;
    const bool is_alone = pieces->alone(n);
    for (std::size_t k = 0; k < found.base.size(); ++k) {
      const std::size_t row = k * pieces->poses + m;
      if (is_alone && !std::isnan(found.base[k])) base[row] = found.base[k];
      for (std::size_t p = 0; p < errors; ++p) {
        (is_alone ? alone : among)[row * errors + p] += found.added[k * errors + p];
      }
    }
    for (std::size_t k = 0; k < found.base.size() && is_alone && !nodes.empty(); ++k) {
      const std::size_t of_limit = errors * kNodes;
      std::copy_n(&found.nodes[k * of_limit], of_limit, &nodes[(k * pieces->poses + m) * of_limit]);
    }
    for (std::size_t p = 0; p < errors && !is_alone; ++p) counted[m * errors + p] += found.counted[p];
  }

  void state(Archive& archive, const NumberRange&) {
    for (auto* list : {&base, &alone, &among, &counted, &nodes}) archive.reals(*list);
    const auto is_sum = [](double sum) { return std::abs(sum) <= kLargestSum; };
    const auto is_count = [&](double n) {
      return n >= 0.0 && n <= static_cast<double>(pieces->draws) && n == std::floor(n);
    };
    const bool is_possible = std::ranges::all_of(base, [&](double y) { return is_sum(y) && y >= 0.0; }) &&
                             std::ranges::all_of(alone, is_sum) && std::ranges::all_of(among, is_sum) &&
                             std::ranges::all_of(counted, is_count) &&
                             std::ranges::all_of(nodes, [&](double y) { return std::isnan(y) || is_sum(y); });
    archive.expect(is_possible, "has sums that no responses give");
  }
};

/// The job of UnitFold, whose units are the pieces.
struct SquareJob {
  const Plan& plan;
  const Model& model;
  RelativeLimits limits;
  Pieces pieces;

  static constexpr std::string_view kName = "mean squares";
  std::size_t errors() const { return plan.factors().size(); }
  std::vector<std::uint64_t> sizes() const { return {limits.size(), pieces.poses, pieces.draws, errors()}; }
  NumberRange units(const Shard& shard) const { return shard.of(pieces.count()); }
  std::uint64_t expected(std::size_t n) const { return kNodes * errors() * (pieces.alone(n) ? 1 : pieces.draws_of(n)); }
  AddedSquaresEvaluator worker() const { return {plan, model, limits, pieces}; }
  AddedSquares unit(std::size_t) const { return {limits, errors()}; }
  SolveCounts solves(std::size_t n, const AddedSquares&) const { return as_converged(expected(n)); }
  SquareSums sums() const { return {pieces, limits, errors()}; }
};

/// Fills in the rows of limits on spreads, to first order in single errors: of the responses less their mean over the
/// poses where they are solved. An error that is drawn anew at each pose is independent from pose to pose.
class SpreadRows {
 public:
  SpreadRows(SquareSums& sums, const SquareJob& job) : sums_(sums), job_(job), poses_(job.pieces.poses) {}

  void fill(std::size_t k) {
    rounding_ = job_.model.rounding(job_.limits.response(k));
    for (std::size_t p = 0; p < sums_.errors; ++p) {
      take_mean(k, p);
      (job_.plan.is_per_pose(p) ? add_per_pose(k, p) : add_fixed(k, p));
    }
  }

 private:
  using Nodes = std::array<double, kNodes>;

  /// The response at the nodes of an error, less the mean over the poses.
  Nodes centred(std::size_t k, std::size_t m, std::size_t p) const {
    Nodes y{};
    for (std::size_t at = 0; at < kNodes; ++at) y[at] = node(k, m, p, at) - mean_[at];
    return y;
  }

  double node(std::size_t k, std::size_t m, std::size_t p, std::size_t at) const {
    return sums_.nodes[((k * poses_ + m) * sums_.errors + p) * kNodes + at];
  }
  bool is_solved(std::size_t k, std::size_t m, std::size_t p) const { return !std::isnan(node(k, m, p, 1)); }

  void take_mean(std::size_t k, std::size_t p) {
    solved_ = 0.0;
    mean_ = {};
    for (std::size_t m = 0; m < poses_; ++m) {
      if (!is_solved(k, m, p)) continue;
      solved_ += 1.0;
      for (std::size_t at = 0; at < kNodes; ++at) mean_[at] += node(k, m, p, at);
    }
    for (double& one : mean_) one /= solved_;
  }

  void set(std::size_t k, std::size_t m, std::size_t p, double base, double added) {
    const std::size_t row = k * poses_ + m;
    sums_.base[row] = base * base;
    sums_.alone[row * sums_.errors + p] = added;
  }

  void add_fixed(std::size_t k, std::size_t p) {
    for (std::size_t m = 0; m < poses_; ++m) {
      if (!is_solved(k, m, p)) continue;
      const Nodes y = centred(k, m, p);
      const bool moves = std::max(std::abs(y[0] - y[1]), std::abs(y[2] - y[1])) > rounding_;
      set(k, m, p, y[1], moves ? 0.5 * (y[0] * y[0] + y[2] * y[2]) - y[1] * y[1] : 0.0);
    }
  }

  void add_per_pose(std::size_t k, std::size_t p) {
    double all = 0.0;
    for (std::size_t m = 0; m < poses_; ++m) all += is_solved(k, m, p) ? own_square(k, m, p) : 0.0;
    const double own = 1.0 - 1.0 / solved_;
    for (std::size_t m = 0; m < poses_; ++m) {
      if (!is_solved(k, m, p)) continue;
      const double square = own_square(k, m, p);
      set(k, m, p, centred(k, m, p)[1], own * own * square + (all - square) / (solved_ * solved_));
    }
  }

  /// What the error adds at its own pose to the mean square about the response without it.
  double own_square(std::size_t k, std::size_t m, std::size_t p) const {
    const double low = node(k, m, p, 0) - node(k, m, p, 1);
    const double high = node(k, m, p, 2) - node(k, m, p, 1);
    return std::max(std::abs(low), std::abs(high)) > rounding_ ? 0.5 * (low * low + high * high) : 0.0;
  }

  SquareSums& sums_;
  const SquareJob& job_;
  std::size_t poses_;
  double rounding_ = 0.0;  ///< of the response
  double solved_ = 0.0;    ///< poses where the error is solved
  Nodes mean_{};           ///< over these poses
};

MeanSquares mean_squares_of(const SquareSums& sums, const RelativeLimits& limits, const Plan& plan) {
  MeanSquares found{sums.base, std::vector<double>(sums.alone.size()), {}};
  for (std::size_t row = 0; row < sums.base.size(); ++row) {
    for (std::size_t p = 0; p < sums.errors; ++p) {
      const std::size_t at = row * sums.errors + p;
      const double draws = sums.counted[row % sums.pieces->poses * sums.errors + p];
      const double among =
          draws > 0.0 && !limits.is_spread(row / sums.pieces->poses) ? sums.among[at] / draws : sums.alone[at];
      const double sigma = plan.distributions()[p].standard_deviation();
      found.value[row] += 0.5 * (sums.alone[at] + among);
      found.slope[at] = std::max(0.0, among) / (sigma * sigma);
    }
  }
  return found;
}

}  // namespace

std::optional<MeanSquares> mean_squares(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                        std::size_t draws, const RunOptions& options) {
  const SquareJob job{plan, model, {plan, model, limits}, {plan.poses().size(), draws}};
  auto sums = fold_units(job, options);
  if (!sums) return std::nullopt;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (job.limits.is_spread(k)) SpreadRows(*sums, job).fill(k);
  }
  MeanSquares found = mean_squares_of(*sums, job.limits, plan);
  for (std::size_t k = 0; k < limits.size(); ++k) {
    for (std::size_t m = 0; m < job.pieces.poses; ++m) found.room.push_back(job.limits.room(k, PoseIndex(m)));
  }
  return found;
}

std::uint64_t mean_square_solves(const Plan& plan, std::size_t draws) {
  return kNodes * plan.factors().size() * (1 + draws) * plan.poses().size();
}

}  // namespace poesy
