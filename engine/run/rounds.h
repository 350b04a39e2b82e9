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

/// 0 .. count - 1.
std::vector<std::size_t> all_positions(std::size_t count);

/// Samples that each pose of every slot gets in any case.
std::size_t least_samples(const Plan& plan);

/// The rounds of a sampled study. One with a fixed number of samples has a single round. One with adaptive samples has
/// a round for each milestone (engine/study/plan.h), in which every slot that goes on gets the milestone's
/// samples at all poses, and then perhaps a last one up to Plan::samples(). A slot ends at the first milestone at which
/// each response that decides is reached: half-width <= relative_error x |quantity|, see ConvergenceResult. What is
/// decided follows from the samples up to the milestone alone, so it is the same on any machine.
class Rounds {
 public:
  /// What decides whether a slot goes on.
  struct Rule {
    std::size_t responses;              ///< R
    std::vector<std::size_t> deciding;  ///< positions among the responses
    double conf_level;                  ///< of the intervals
    std::vector<double> rounding;       ///< [R x P] a quantity whose magnitude is below this counts as reached
  };

  /// Refers to the plan. Begins with the first round.
  Rounds(const Plan& plan, Rule rule);

  /// That each pose of the slot has at the end of this round.
  std::size_t samples(std::size_t slot) const { return samples_[slot]; }
  /// Units of each cell of the slot in this round.
  std::size_t units(std::size_t slot) const;
  /// Whether a cell of this slot may hold so many units in this round.
  bool may_hold(std::size_t slot, std::size_t units) const;
  /// Of the whole study, as far as the half-widths so far let expect: they fall with the root of the samples. At least
  /// those of this round; before the first decision all that there may be.
  std::uint64_t expected_solves() const;
  /// Solves after those that were done, as far as that is known: for a fixed number of samples those that are pending.
  std::uint64_t expected_left(const SolveCounts& done, std::uint64_t pending) const {
    return adaptive_ ? expected_solves() - done.total() : pending;
  }

  /// Ends the round; whether another one follows, which begins. estimates(slot): its quantities, [R].
  bool go_on(const std::function<std::vector<Estimate>(std::size_t slot)>& estimates);
  /// Empty for a study with a fixed number of samples. Precondition: no round follows.
  std::optional<ConvergenceResult> result() const;

  /// What was decided so far; nothing for a fixed number of samples. Where it is read, it is of this plan or of one
  /// that differs by fewer samples. Precondition there: this is the first round.
  void state(Archive& archive);

 private:
  /// Quantities and half-widths at a milestone, [R x P].
  struct Row {
    std::vector<double> quantity;
    std::vector<double> half_width;
  };

  bool last_round() const { return rows_.size() == milestones_.size(); }
  std::size_t cell(std::size_t response, std::size_t slot) const { return response * samples_.size() + slot; }
  /// Half-width over what it may be.
  double excess(const Row& row, std::size_t cell) const;
  double largest_excess(const Row& row, std::size_t slot) const;
  /// Ends the slots whose every deciding response is reached, and begins the next round; whether a slot goes on.
  bool decide(Row row);
  std::size_t expected_samples(std::size_t slot) const;
  const Row& row_at_end(std::size_t slot) const;

  std::optional<AdaptiveSamples> adaptive_;
  Rule rule_;
  std::size_t poses_;
  std::size_t max_;
  std::vector<std::size_t> milestones_;  ///< those at which something is decided
  std::vector<Row> rows_;                ///< of the rounds that are over
  std::vector<std::size_t> samples_;     ///< [P] of each slot in this round
  std::vector<bool> ended_;              ///< [P]
};

/// The units of a plan that are still to be solved, in the plan's order: of each cell those between the first ones that
/// are done and as many as are wanted.
class PendingUnits {
 public:
  /// done(cell), wanted(cell): how many of the cell's units. Precondition: at most units_per_cell(). Refers to the
  /// plan.
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

  /// Units that are still to be solved.
  std::size_t size() const { return ends_.empty() ? 0 : ends_.back().pending; }

  /// In all of them.
  std::uint64_t samples() const { return samples_; }

  /// The n-th of them, in the order of the plan.
  WorkUnit operator[](std::size_t n) const {
    POESY_EXPECTS(n < size());
    const auto end = std::ranges::upper_bound(ends_, n, {}, &End::pending);
    const auto cell = static_cast<std::size_t>(end - ends_.begin());
    return plan_->unit(cell * plan_->units_per_cell() + end->unit - (end->pending - n));
  }

 private:
  /// Where a cell's pending units end: how many there are up to and with this cell, and the unit within the cell.
  struct End {
    std::size_t pending;
    std::size_t unit;
  };

  const Plan* plan_;
  std::vector<End> ends_;  ///< [cells]
  std::uint64_t samples_ = 0;
};

}  // namespace poesy
