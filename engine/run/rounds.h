#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/contract.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/stats/moments.h"
#include "engine/study/plan.h"

namespace poesy {

/// The numbers 0 .. count - 1.
std::vector<std::size_t> all_positions(std::size_t count);

/// The least number of samples at each pose: the first milestone, or the fixed number of samples. It is the same for
/// every slot (see Rounds).
std::size_t least_samples(const Plan& plan);

/// The rounds of a sampled study. A slot is one error that varies alone, or all errors that vary together. A fixed
/// number of samples takes a single round. Adaptive samples have milestones (engine/study/plan.h): numbers of samples
/// after which it is decided which slots continue. They take a round for each milestone, and one more if
/// Plan::samples() is above the last milestone. In a round, every slot that has not ended gets the milestone's samples
/// at all poses. A slot ends at the first milestone at which the quantity of each deciding response is known well
/// enough: half-width <= relative_error x |quantity|, see ConvergenceResult. Decisions depend only on the samples up to
/// the milestone, so they are the same on any machine.
class Rounds {
 public:
  /// The rule that decides after each round whether a slot needs more samples.
  struct Rule {
    std::size_t responses;              ///< number of responses
    std::vector<std::size_t> deciding;  ///< indices of the responses that decide
    double conf_level;                  ///< confidence level of the intervals of estimates
    /// [responses x slots] Magnitude of rounding; a quantity below it counts as known well enough.
    std::vector<double> rounding;
  };

  /// Begins the first round. Keeps a reference to the plan.
  Rounds(const Plan& plan, Rule rule);

  /// The number of samples of a slot at each pose at the end of this round.
  std::size_t samples(std::size_t slot) const { return samples_[slot]; }
  /// The number of work units of a slot at each pose at the end of this round.
  std::size_t units(std::size_t slot) const;
  /// Returns true if `units` is a possible number of merged work units of a slot at a pose during this round.
  bool may_hold(std::size_t slot, std::size_t units) const;
  /// The expected number of solves of the whole study. It is computed from the half-widths so far, which decrease with
  /// the square root of the number of samples. It is at least the number of solves of this round. Before the first
  /// decision it is the largest possible number.
  std::uint64_t expected_solves() const;
  /// The expected number of solves that are still to be done in all rounds. done: solves so far. pending: the result if
  /// the number of samples is fixed.
  std::uint64_t expected_left(const SolveCounts& done, std::uint64_t pending) const {
    return adaptive_ ? expected_solves() - done.total() : pending;
  }

  /// Ends the round, and begins the next one if any slot needs more samples. Returns true if a round began.
  /// estimates(slot): for each response, the estimate of the quantity whose precision decides, from the samples of this
  /// slot so far.
  bool go_on(const std::function<std::vector<Estimate>(std::size_t slot)>& estimates);
  /// How the sampling ended; empty for a fixed number of samples. Precondition: all rounds have ended.
  std::optional<ConvergenceResult> result() const;

  /// Reads or writes the decisions so far; nothing for a fixed number of samples. The state may come from the same plan
  /// with fewer samples. Precondition of reading: this is the first round.
  void state(Archive& archive);

 private:
  /// Quantities and half-widths at the end of one round, [responses x slots]; NaN for a slot that had ended before.
  struct Row {
    std::vector<double> quantity;
    std::vector<double> half_width;
  };

  bool last_round() const { return rows_.size() == milestones_.size(); }
  std::size_t cell(std::size_t response, std::size_t slot) const { return response * samples_.size() + slot; }
  /// The half-width of an estimate's interval, divided by the largest half-width at which sampling ends; infinite if
  /// not known.
  double excess(const Row& row, std::size_t cell) const;
  double largest_excess(const Row& row, std::size_t slot) const;
  /// Ends each slot whose deciding responses are all known well enough, and begins the next round for the others.
  /// Returns true if there are others.
  bool decide(Row row);
  std::size_t expected_samples(std::size_t slot) const;
  const Row& row_at_end(std::size_t slot) const;

  std::optional<AdaptiveSamples> adaptive_;
  Rule rule_;
  std::size_t poses_;
  std::size_t max_;
  std::vector<std::size_t> milestones_;  ///< numbers of samples after which the rounds decide
  std::vector<Row> rows_;                ///< estimates of the rounds that have ended
  std::vector<std::size_t> samples_;     ///< [slots] number of samples at each pose at the end of this round
  std::vector<bool> ended_;              ///< [slots] true if the slot needs no more samples
};

/// The units of a plan that are still to be solved, in the order of the plan. In each cell (one slot at one pose) these
/// are the units after those that are done, up to the wanted number.
class PendingUnits {
 public:
  /// done(cell), wanted(cell): the numbers of the cell's units that are done and that are wanted, at most
  /// units_per_cell(). Keeps a reference to the plan.
  template <class Done, class Wanted>
  PendingUnits(const Plan& plan, const Done& done, const Wanted& wanted) : plan_(&plan) {
    std::size_t end = 0;
    for (std::size_t cell = 0; cell < plan.cells(); ++cell) {
      const std::size_t last = wanted(cell);
      POESY_EXPECTS(done(cell) <= plan.units_per_cell() && last <= plan.units_per_cell());
      if (last > done(cell)) {
        end += last - done(cell);
        samples_ += plan.first_sample(last) - plan.first_sample(done(cell));
      }
      ends_.push_back({end, last});
    }
  }

  /// The number of units to be solved.
  std::size_t size() const { return ends_.empty() ? 0 : ends_.back().pending; }

  /// The number of samples in all these units.
  std::uint64_t samples() const { return samples_; }

  /// The n-th unit to be solved, in the order of the plan.
  WorkUnit operator[](std::size_t n) const {
    POESY_EXPECTS(n < size());
    const auto end = std::ranges::upper_bound(ends_, n, {}, &End::pending);
    const auto cell = static_cast<std::size_t>(end - ends_.begin());
    return plan_->unit(cell * plan_->units_per_cell() + end->unit - (end->pending - n));
  }

 private:
  /// pending: number of units to be solved in all cells up to and including this one. unit: number of wanted units of
  /// this cell.
  struct End {
    std::size_t pending;
    std::size_t unit;
  };

  const Plan* plan_;
  std::vector<End> ends_;  ///< [cells] see End
  std::uint64_t samples_ = 0;
};

}  // namespace poesy
