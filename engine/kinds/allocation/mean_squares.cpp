#include "engine/kinds/allocation/mean_squares.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string_view>

#include "engine/base/archive.h"
#include "engine/base/contract.h"
#include "engine/base/nan.h"
#include "engine/kinds/allocation/load_solver.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/unit_fold.h"

namespace poesy::allocation {
namespace {

/// The number of values of an error at which the mechanism is solved (nodes): mu - sigma, c and mu + sigma, with its
/// mean mu, its standard deviation sigma and c = Distribution::centre().
constexpr std::size_t kNodes = 3;
constexpr std::size_t kDrawsOfPiece = 16;  ///< number of draws of the other errors in a piece of work
/// If the mechanism is not solved while one source of scatter is varied and all others are at their centres, the mean
/// square that this source adds is the square of this multiple of RelativeLimits::room().
constexpr double kUnsolvedOverLimit = 10.0;
constexpr double kLargestSum = 1e100;  ///< the largest sum of squares that a checkpoint may contain, so that slopes
                                       ///< computed from it are finite

/// The sources of scatter, which add to mean squares: the errors that vary, then the noise of the measured values of a
/// calibration.
struct Sources {
  std::size_t errors;
  std::size_t noises;

  std::size_t size() const { return errors + noises; }
  bool is_noise(std::size_t p) const { return p >= errors; }
};

Sources sources_of(const Plan& plan, const MachineCalibration* calibration) {
  const bool is_noisy =
      calibration != nullptr && std::ranges::any_of(calibration->noise(), [](double sd) { return sd > 0.0; });
  return {plan.factors().size(), is_noisy ? calibration->values() : 0};
}

/// The numbers that one piece of work computes at its pose, for each source of scatter (Sources).
struct AddedSquares {
  /// [limits] Square of the response's deviation from the centre of the limit, with all errors at their centres. NaN if
  /// the mechanism is not solved, in pieces in which the other errors are drawn, and for limits on a spread.
  std::vector<double> base;
  std::vector<double> added;    ///< [limits x sources] mean square that each source adds, summed over the draws
  std::vector<double> counted;  ///< [sources] number of draws that were solved
  /// [limits x sources x kNodes] Response (SI) at the three nodes of each source, with all others at their centres. NaN
  /// if the mechanism is not solved there, in pieces in which the other errors are drawn, and for limits that are not
  /// on a spread. Empty without a limit on a spread.
  std::vector<double> nodes;

  AddedSquares() = default;
  AddedSquares(const RelativeLimits& limits, std::size_t sources)
      : base(limits.size(), kNaN),
        added(limits.size() * sources),
        counted(sources),
        nodes(limits.any_spread() ? added.size() * kNodes : 0, kNaN) {}

  void state(Archive& archive) {
    for (auto* list : {&base, &added, &counted, &nodes}) archive.reals(*list);
  }
};

/// The pieces of work. At each pose, the first piece varies one error after the other, with all others at their
/// centres. The following pieces do the same with the other errors drawn.
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

/// Computes AddedSquares for one piece of work after the other. Owns the scratch memory of one thread.
class AddedSquaresEvaluator : private UnitSolver {
 public:
  AddedSquaresEvaluator(const Plan& plan, const Model& model, const RelativeLimits& limits, const Pieces& pieces,
                        const MachineCalibration* calibration)
      : UnitSolver(plan, model, plan.factors().size()),
        limits_(limits),
        pieces_(pieces),
        sources_(sources_of(plan, calibration)),
        calibration_(calibration) {
    POESY_EXPECTS(calibration == nullptr || pieces.draws == 0);
    if (calibration != nullptr) calibrator_ = std::make_unique<MachineCalibrator>(*calibration);
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
    AddedSquares found(limits_, sources_.size());
    const std::size_t samples = pieces_.alone(n) ? 1 : pieces_.draws_of(n);
    constexpr std::size_t kMostPairs = Plan::kUnitSamples / kNodes;
    for (std::size_t first = 0; first < samples * sources_.size(); first += kMostPairs) {
      add_pairs(n, first, std::min(kMostPairs, samples * sources_.size() - first), found);
    }
    return found;
  }

 private:
  /// The value of error plan.factors()[slot] in a sample of piece n in which another source is varied.
  double other(std::size_t n, std::size_t sample, std::size_t slot) const {
    if (pieces_.alone(n)) return plan_->distributions()[slot].centre();
    return draws_[slot * pieces_.draws + pieces_.first_draw(n) + sample];
  }

  /// Solves pairs at the three nodes and adds their results to `found`. A pair is a sample of the other errors and a
  /// source that is varied. Pairs are numbered sample by sample; `first` is the number of the first one to solve.
  void add_pairs(std::size_t n, std::size_t first, std::size_t pairs, AddedSquares& found) {
    const std::size_t count = pairs * kNodes;
    for (std::size_t v = 0; v < sources_.errors; ++v) {
      double* const row = &values_[v * count];
      for (std::size_t k = 0; k < pairs; ++k) {
        std::fill_n(row + k * kNodes, kNodes, other(n, (first + k) / sources_.size(), v));
      }
    }
    for (std::size_t k = 0; k < pairs; ++k) {
      const std::size_t p = (first + k) % sources_.size();
      if (sources_.is_noise(p)) continue;
      const Distribution& error = plan_->distributions()[p];
      const std::array nodes{error.mean() - error.standard_deviation(), error.centre(),
                             error.mean() + error.standard_deviation()};
      std::ranges::copy(nodes, &values_[p * count + k * kNodes]);
    }
    calibrate(first, pairs);
    const UnitOutcomes outcomes = UnitSolver::solve(pieces_.pose(n), plan_->factors(), count, 0.0);
    for (std::size_t k = 0; k < pairs; ++k) add(n, (first + k) % sources_.size(), k, outcomes, found);
  }

  /// If the study calibrates machines: calibrates those in `values_`. Pairs with the same numbers are the same machines
  /// at each pose, so they are calibrated only once.
  void calibrate(std::size_t first, std::size_t pairs) {
    if (calibrator_ == nullptr) return;
    std::unique_ptr<Evaluator>& evaluator = calibrated_[first];
    if (evaluator == nullptr) {
      evaluator =
          calibration_->evaluator(calibrator_->with_noise(all_errors(drawn(pairs * kNodes)), noise_of(first, pairs)));
    }
    solve_by(evaluator.get());
  }

  /// [measured values x (pairs x kNodes)] The noise of the measured values (SI) at the nodes of each pair; 0 for a pair
  /// whose source is an error.
  calibration::Matrix noise_of(std::size_t first, std::size_t pairs) const {
    const auto columns = static_cast<Eigen::Index>(pairs * kNodes);
    calibration::Matrix noise = calibration::Matrix::Zero(static_cast<Eigen::Index>(calibration_->values()), columns);
    for (std::size_t k = 0; k < pairs; ++k) {
      if (!sources_.is_noise(first + k)) continue;
      const std::size_t i = first + k - sources_.errors;
      const auto row = static_cast<Eigen::Index>(i);
      const auto column = static_cast<Eigen::Index>(k * kNodes);
      noise(row, column) = -calibration_->noise()[i];
      noise(row, column + 2) = calibration_->noise()[i];
    }
    return noise;
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
      double& sum = found.added[k * sources_.size() + p];
      const PoseIndex pose = pieces_.pose(n);
      if (!is_solved) {
        const double room = limits_.room(k, pose);
        sum += kUnsolvedOverLimit * kUnsolvedOverLimit * room * room;
        continue;
      }
      const auto values = outcomes.responses.subspan(limits_.response(k) * samples + pair * kNodes, kNodes);
      if (limits_.is_spread(k)) {
        if (alone) std::ranges::copy(values, &found.nodes[(k * sources_.size() + p) * kNodes]);
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
  Sources sources_;
  const MachineCalibration* calibration_;
  std::unique_ptr<MachineCalibrator> calibrator_;  ///< null: machines are not calibrated
  /// Evaluators of the calibrated machines. The key is the number of the first of the pairs that add_pairs() solves
  /// together.
  std::map<std::size_t, std::unique_ptr<Evaluator>> calibrated_;
  std::vector<double> draws_;     ///< [errors x draws] draws of all errors, SI
  std::vector<double> rounding_;  ///< [limits] Model::rounding of the limited response, SI
};

/// The sums over all pieces of work, in SI units. A row is a limit at a pose; the poses of the first limit come first.
struct SquareSums {
  const Pieces* pieces;
  std::size_t sources;        ///< number of sources of scatter (Sources)
  std::vector<double> base;   ///< [rows] square of the response minus its centre, with all errors at their
                              ///< centres; 0 if the mechanism is not solved
  std::vector<double> alone;  ///< [rows x sources] mean square that each source adds if all others are at their centres
  /// [rows x sources] Mean square that each source adds if the other errors are drawn, summed over draws.
  std::vector<double> among;
  std::vector<double> counted;  ///< [poses x sources] number of draws that were solved
  std::vector<double> nodes;  ///< [rows x sources x kNodes] see AddedSquares::nodes; empty without a limit on a spread

  SquareSums(const Pieces& all, const RelativeLimits& limits, std::size_t source_count)
      : pieces(&all),
        sources(source_count),
        base(limits.size() * all.poses),
        alone(base.size() * sources),
        among(alone.size()),
        counted(all.poses * sources),
        nodes(limits.any_spread() ? alone.size() * kNodes : 0, kNaN) {}

  void add(std::size_t n, const AddedSquares& found) {
    const std::size_t m = pieces->pose(n).value;
    const bool is_alone = pieces->alone(n);
    for (std::size_t k = 0; k < found.base.size(); ++k) {
      const std::size_t row = k * pieces->poses + m;
      if (is_alone && !std::isnan(found.base[k])) base[row] = found.base[k];
      for (std::size_t p = 0; p < sources; ++p) {
        (is_alone ? alone : among)[row * sources + p] += found.added[k * sources + p];
      }
    }
    for (std::size_t k = 0; k < found.base.size() && is_alone && !nodes.empty(); ++k) {
      const std::size_t of_limit = sources * kNodes;
      std::copy_n(&found.nodes[k * of_limit], of_limit, &nodes[(k * pieces->poses + m) * of_limit]);
    }
    for (std::size_t p = 0; p < sources && !is_alone; ++p) counted[m * sources + p] += found.counted[p];
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

/// The job of a UnitFold (run/unit_fold.h), whose units are the pieces.
struct SquareJob {
  const Plan& plan;
  const Model& model;
  RelativeLimits limits;
  Pieces pieces;
  const MachineCalibration* calibration;

  static constexpr std::string_view kName = "mean squares";
  std::size_t sources() const { return sources_of(plan, calibration).size(); }
  std::vector<std::uint64_t> sizes() const { return {limits.size(), pieces.poses, pieces.draws, sources()}; }
  NumberRange units(const Shard& shard) const { return shard.of(pieces.count()); }
  std::uint64_t expected(std::size_t n) const {
    return kNodes * sources() * (pieces.alone(n) ? 1 : pieces.draws_of(n));
  }
  AddedSquaresEvaluator worker() const { return {plan, model, limits, pieces, calibration}; }
  AddedSquares unit(std::size_t) const { return {limits, sources()}; }
  SolveCounts solves(std::size_t n, const AddedSquares&) const { return as_converged(expected(n)); }
  SquareSums sums() const { return {pieces, limits, sources()}; }
};

/// Computes the rows of SquareSums for limits on spreads over the poses, to first order in single errors. The limited
/// quantity is the response minus its mean over the solved poses. An error that is drawn anew at each pose is
/// independent between poses.
class SpreadRows {
 public:
  SpreadRows(SquareSums& sums, const SquareJob& job) : sums_(sums), job_(job), poses_(job.pieces.poses) {}

  void fill(std::size_t k) {
    rounding_ = job_.model.rounding(job_.limits.response(k));
    for (std::size_t p = 0; p < sums_.sources; ++p) {
      take_mean(k, p);
      const bool is_anew = p < job_.plan.factors().size() && job_.plan.is_per_pose(p);
      (is_anew ? add_per_pose(k, p) : add_fixed(k, p));
    }
  }

 private:
  using Nodes = std::array<double, kNodes>;

  /// The response (SI) under limit k at pose m and the nodes of source p, minus its mean over the poses.
  Nodes centred(std::size_t k, std::size_t m, std::size_t p) const {
    Nodes y{};
    for (std::size_t at = 0; at < kNodes; ++at) y[at] = node(k, m, p, at) - mean_[at];
    return y;
  }

  double node(std::size_t k, std::size_t m, std::size_t p, std::size_t at) const {
    return sums_.nodes[((k * poses_ + m) * sums_.sources + p) * kNodes + at];
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
    sums_.alone[row * sums_.sources + p] = added;
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

  /// For an error p that is drawn anew at each pose: the mean square of the change of the response at pose m that the
  /// draw at this pose causes.
  double own_square(std::size_t k, std::size_t m, std::size_t p) const {
    const double low = node(k, m, p, 0) - node(k, m, p, 1);
    const double high = node(k, m, p, 2) - node(k, m, p, 1);
    return std::max(std::abs(low), std::abs(high)) > rounding_ ? 0.5 * (low * low + high * high) : 0.0;
  }

  SquareSums& sums_;
  const SquareJob& job_;
  std::size_t poses_;
  double rounding_ = 0.0;  ///< changes of the response up to this are rounding, SI
  double solved_ = 0.0;    ///< number of poses at which the mechanism is solved with the present source varied
  Nodes mean_{};           ///< mean of the response over these poses at each node, SI
};

MeanSquares mean_squares_of(const SquareSums& sums, const RelativeLimits& limits, const Plan& plan) {
  const std::size_t errors = plan.factors().size();
  MeanSquares found{sums.base, std::vector<double>(sums.base.size() * errors), {}};
  for (std::size_t row = 0; row < sums.base.size(); ++row) {
    for (std::size_t p = 0; p < sums.sources; ++p) {
      const std::size_t at = row * sums.sources + p;
      const double draws = sums.counted[row % sums.pieces->poses * sums.sources + p];
      const double among =
          draws > 0.0 && !limits.is_spread(row / sums.pieces->poses) ? sums.among[at] / draws : sums.alone[at];
      found.value[row] += 0.5 * (sums.alone[at] + among);
      if (p >= errors) continue;  // noise does not change with tolerances
      const double sigma = plan.distributions()[p].standard_deviation();
      found.slope[row * errors + p] = std::max(0.0, among) / (sigma * sigma);
    }
  }
  return found;
}

}  // namespace

std::optional<MeanSquares> mean_squares(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                        std::size_t draws, const RunOptions& options,
                                        const MachineCalibration* calibration) {
  const SquareJob job{plan, model, {plan, model, limits, calibration}, {plan.poses().size(), draws}, calibration};
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

}  // namespace poesy::allocation
