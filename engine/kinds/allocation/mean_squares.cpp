#include "engine/kinds/allocation/mean_squares.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/bytes.h"
#include "engine/kinds/allocation/load_solver.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/fold.h"
#include "engine/stats/moments.h"

namespace poesy {
namespace {

constexpr std::uint64_t kKind = 71;          ///< the first number of a state, which no other stage has
constexpr std::size_t kNodes = 3;            ///< mu - sigma, 0, mu + sigma
constexpr std::size_t kDrawsOfPiece = 16;    ///< draws of one piece of work
constexpr double kUnsolvedOverLimit = 10.0;  ///< response over limit of a sample without a solution
constexpr double kLargestSum = 1e100;        ///< largest sum of squares in a state; slopes from it are finite

/// The result of a piece of work at its pose: K limits, P errors.
struct AddedSquares {
  std::vector<double> base;     ///< [K] y(0)^2 of the perfect mechanism; empty among others
  std::vector<double> added;    ///< [K x P] sums over the draws
  std::vector<double> counted;  ///< [P] draws that were solved

  AddedSquares() = default;
  AddedSquares(std::size_t limits, std::size_t errors) : added(limits * errors), counted(errors) {}
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
  AddedSquaresEvaluator(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                        const Pieces& pieces)
      : UnitSolver(plan, model, plan.factors().size()), limits_(limits), pieces_(pieces) {
    const std::size_t errors = plan.factors().size();
    draws_.resize(errors * pieces.draws);
    const WorkUnit all{0, PoseIndex(0), SampleIndex(0), pieces.draws};
    for (std::size_t p = 0; p < errors; ++p) {
      draw_uniforms(all, p, std::span(draws_).subspan(p * pieces.draws, pieces.draws));
    }
    plan.transform(draws_, pieces.draws);
    for (const ResponseLimit& limit : limits) rounding_.push_back(model.rounding(limit.response));
  }

  AddedSquares operator()(std::size_t n) {
    const std::size_t errors = plan_->factors().size();
    AddedSquares found(limits_.size(), errors);
    const std::size_t samples = pieces_.alone(n) ? 1 : pieces_.draws_of(n);
    constexpr std::size_t kMostPairs = Plan::kUnitSamples / kNodes;
    for (std::size_t first = 0; first < samples * errors; first += kMostPairs) {
      add_pairs(n, first, std::min(kMostPairs, samples * errors - first), found);
    }
    return found;
  }

 private:
  /// The value of another error in a slot.
  double other(std::size_t n, std::size_t sample, std::size_t slot) const {
    return pieces_.alone(n) ? 0.0 : draws_[slot * pieces_.draws + pieces_.first_draw(n) + sample];
  }

  /// Solves pairs of a sample and an error, sample by sample, each at its nodes.
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
      const std::array nodes{error.mean() - error.standard_deviation(), 0.0, error.mean() + error.standard_deviation()};
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
      if (!is_solved) {
        sum += kUnsolvedOverLimit * kUnsolvedOverLimit * limits_[k].most * limits_[k].most;
        continue;
      }
      const auto y = outcomes.responses.subspan(limits_[k].response * samples + pair * kNodes, kNodes);
      if (alone && p == 0) found.base.push_back(y[1] * y[1]);
      const bool moves = std::max(std::abs(y[0] - y[1]), std::abs(y[2] - y[1])) > rounding_[k];
      if (moves) sum += 0.5 * (y[0] * y[0] + y[2] * y[2]) - y[1] * y[1];
    }
  }

  std::span<const ResponseLimit> limits_;
  const Pieces& pieces_;
  std::vector<double> draws_;     ///< [P x draws] of all errors, SI
  std::vector<double> rounding_;  ///< [K]
};

/// All pieces in their order: the work of fold().
class MeanSquareWork {
 public:
  MeanSquareWork(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits, std::size_t draws)
      : plan_(plan),
        model_(model),
        limits_(limits),
        pieces_{plan.poses().size(), draws},
        base_(rows()),
        alone_(rows() * errors()),
        among_(rows() * errors()),
        counted_(pieces_.poses * errors()) {}
  MeanSquareWork(const MeanSquareWork&) = delete;
  MeanSquareWork& operator=(const MeanSquareWork&) = delete;

  std::size_t begin_round() {
    begun_ = next_;
    return pieces_.count() - next_;
  }
  AddedSquaresEvaluator worker() const { return {plan_, model_, limits_, pieces_}; }
  AddedSquares solve(AddedSquaresEvaluator& evaluate, std::size_t n) const { return evaluate(begun_ + n); }
  SolveCounts merge(std::size_t, const AddedSquares& found) {
    const std::size_t m = pieces_.pose(next_).value;
    const bool alone = pieces_.alone(next_);
    for (std::size_t k = 0; k < limits_.size(); ++k) {
      const std::size_t row = k * pieces_.poses + m;
      if (alone && !found.base.empty()) base_[row] = found.base[k];
      for (std::size_t p = 0; p < errors(); ++p) {
        (alone ? alone_ : among_)[row * errors() + p] += found.added[k * errors() + p];
      }
    }
    for (std::size_t p = 0; p < errors() && !alone; ++p) counted_[m * errors() + p] += found.counted[p];
    const SolveCounts solves = solves_of(next_);
    solved_ += solves.total();
    ++next_;
    return solves;
  }
  static void write(std::size_t, const AddedSquares& found, ByteWriter& to) {
    to.number(found.base.size());
    for (const auto* list : {&found.base, &found.added, &found.counted}) to.reals(*list);
  }
  AddedSquares read(std::size_t, ByteReader& from) const {
    AddedSquares found(limits_.size(), errors());
    found.base = from.reals(static_cast<std::size_t>(from.number_up_to(limits_.size())));
    for (auto* list : {&found.added, &found.counted}) from.reals(std::span(*list));
    return found;
  }
  SolveCounts solved() const { return as_converged(solved_); }
  std::uint64_t left() const {
    std::uint64_t left = 0;
    for (std::size_t n = next_; n < pieces_.count(); ++n) left += solves_of(n).total();
    return left;
  }
  void write_state(ByteWriter& to) const {
    for (const std::uint64_t size : sizes()) to.number(size);
    to.number(next_);
    to.number(solved_);
    for (const auto* list : {&base_, &alone_, &among_, &counted_}) to.reals(*list);
  }
  void restore(std::span<const std::byte> state) {
    ByteReader from(state);
    for (const std::uint64_t size : sizes()) {
      if (from.number() != size) throw BytesError("is the state of another kind or size of study");
    }
    next_ = static_cast<std::size_t>(from.number_up_to(pieces_.count()));
    solved_ = from.number();
    for (auto* list : {&base_, &alone_, &among_, &counted_}) from.reals(std::span(*list));
    from.expect_end();
    if (!is_possible()) throw BytesError("has sums that no responses give");
  }
  static bool next_round() { return false; }

  MeanSquares result() const {
    MeanSquares found{base_, std::vector<double>(rows() * errors())};
    for (std::size_t row = 0; row < rows(); ++row) {
      for (std::size_t p = 0; p < errors(); ++p) {
        const std::size_t at = row * errors() + p;
        const double draws = counted_[row % pieces_.poses * errors() + p];
        const double among = draws > 0.0 ? among_[at] / draws : alone_[at];
        const double sigma = plan_.distributions()[p].standard_deviation();
        found.value[row] += 0.5 * (alone_[at] + among);
        found.slope[at] = std::max(0.0, among) / (sigma * sigma);
      }
    }
    return found;
  }

 private:
  std::size_t errors() const { return plan_.factors().size(); }
  std::size_t rows() const { return limits_.size() * pieces_.poses; }
  std::array<std::uint64_t, 5> sizes() const { return {kKind, limits_.size(), pieces_.poses, pieces_.draws, errors()}; }
  SolveCounts solves_of(std::size_t n) const {
    return as_converged(kNodes * errors() * (pieces_.alone(n) ? 1 : pieces_.draws_of(n)));
  }

  /// Whether responses can give the state that was read.
  bool is_possible() const {
    const auto is_sum = [](double sum) { return std::abs(sum) <= kLargestSum; };
    const auto is_count = [&](double n) {
      return n >= 0.0 && n <= static_cast<double>(pieces_.draws) && n == std::floor(n);
    };
    return solved_ + left() == mean_square_solves(plan_, pieces_.draws) &&
           std::ranges::all_of(base_, [&](double y) { return is_sum(y) && y >= 0.0; }) &&
           std::ranges::all_of(alone_, is_sum) && std::ranges::all_of(among_, is_sum) &&
           std::ranges::all_of(counted_, is_count);
  }

  const Plan& plan_;
  const Model& model_;
  std::span<const ResponseLimit> limits_;
  Pieces pieces_;
  std::size_t next_ = 0;
  std::size_t begun_ = 0;
  std::uint64_t solved_ = 0;
  std::vector<double> base_;     ///< [L]
  std::vector<double> alone_;    ///< [L x P]
  std::vector<double> among_;    ///< [L x P] summed over draws
  std::vector<double> counted_;  ///< [M x P] draws
};

}  // namespace

std::optional<MeanSquares> mean_squares(const Plan& plan, const Model& model, std::span<const ResponseLimit> limits,
                                        std::size_t draws, const RunOptions& options) {
  MeanSquareWork work(plan, model, limits, draws);
  if (!fold(work, options)) return std::nullopt;
  return work.result();
}

std::uint64_t mean_square_solves(const Plan& plan, std::size_t draws) {
  return kNodes * plan.factors().size() * (1 + draws) * plan.poses().size();
}

}  // namespace poesy
