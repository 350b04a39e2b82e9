#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "engine/run/fold.h"
#include "engine/run/rounds.h"
#include "engine/run/shard.h"
#include "engine/study/plan.h"

namespace poesy {

/// Does the work of fold() for the units of a plan. A slot is one error that varies alone, or all errors that vary
/// together. A cell is one slot at one pose, and a unit is a block of samples of one cell. PoseFold manages the units
/// that are still to be solved, the rounds of adaptive samples, shards, and states. A job is a type with everything
/// else:
///
///     static constexpr std::string_view kName     name in the states, unique among all jobs
///     std::vector<std::uint64_t> sizes() const    sizes of the job; a state with other sizes is refused
///     Rounds::Rule rule() const                   the rule of adaptive samples
///     Worker worker() const                       solves units, and owns the scratch of one thread: worker(unit)
///     void unit_state(Archive&, const WorkUnit&, Unit&) const   reads or writes a unit, which has a member `solves`
///     Sums sums(const Plan&, const Shard&) const  empty sums
///     std::vector<Estimate> estimates(const Sums&, std::size_t slot) const   estimates that decide after a round
///
/// The sums have the interface of CellSums:
///
///     static constexpr bool kOfRound              true if sums are made anew for each round
///     void add(const WorkUnit&, const Unit&)      adds the next unit of its cell
///     std::size_t units_done(std::size_t cell) const   number of units of a cell that were added
///     SolveCounts total() const                   solves of all units that were added
///     void state(Archive&, std::size_t samples)   writes all sums, or reads and adds them; see CellSums::state()
template <class Job>
class PoseFold {
 public:
  /// The type of the worker of one thread.
  using Worker = std::remove_cvref_t<decltype(std::declval<const Job&>().worker())>;
  using Unit = std::invoke_result_t<Worker&, const WorkUnit&>;  ///< The type of the output of a unit.
  /// The type of the sums to which units are added.
  using Sums = decltype(std::declval<const Job&>().sums(std::declval<const Plan&>(), {}));

  /// Solves the cells of options.shard, or all cells if there is no shard. Keeps references to the plan and the job.
  PoseFold(const Plan& plan, const Job& job, const RunOptions& options)
      : plan_(plan), job_(job), shard_(options.shard.value_or(Shard())), rounds_(plan, job.rule()) {
    begin_sums();
  }

  /// See fold().
  /// @{
  std::size_t begin_round() {
    const NumberRange cells = shard_.of(plan_.cells());
    pending_.emplace(
        plan_, [&](std::size_t cell) { return sums_->units_done(cell); },
        [&](std::size_t cell) { return cells.holds(cell) ? rounds_.units(slot_of(cell)) : 0; });
    return pending_->size();
  }
  Worker worker() const { return job_.worker(); }
  Unit solve(Worker& worker, std::size_t n) const { return worker((*pending_)[n]); }
  void piece_state(Archive& archive, std::size_t n, Unit& unit) const {
    job_.unit_state(archive, (*pending_)[n], unit);
  }
  SolveCounts merge(std::size_t n, const Unit& found) {
    sums_->add((*pending_)[n], found);
    if constexpr (std::is_same_v<decltype(found.solves), SolveCounts>) {
      return found.solves;
    } else {
      return total_of(found.solves);
    }
  }
  SolveCounts solved() const { return sums_->total(); }
  std::uint64_t left() const { return rounds_.expected_left(solved(), pending_->samples()); }
  void state(Archive& archive) {
    if (archive.reads()) rounds_ = Rounds(plan_, job_.rule());
    archive.object(rounds_);
    if (archive.reads()) begin_sums();
    do {
      part_state(archive);
    } while (archive.is_left());
    for (std::size_t cell = 0; cell < plan_.cells() && !Sums::kOfRound; ++cell) {
      archive.expect(rounds_.may_hold(slot_of(cell), sums_->units_done(cell)), "has a cell of another round");
    }
  }
  bool next_round() {
    if (!rounds_.go_on([&](std::size_t slot) { return job_.estimates(*sums_, slot); })) return false;
    if constexpr (Sums::kOfRound) {
      const Bytes kept = bytes_of([&](ByteWriter& to) {
        Archive archive(to);
        part_state(archive);
      });
      begin_sums();
      ByteReader from(kept);
      Archive archive(from);
      part_state(archive);
    }
    return true;
  }
  /// @}

  Sums& sums() { return *sums_; }  ///< The sums of all units that were merged.
  /// How the adaptive sampling ended; empty if the number of samples was fixed. Precondition: all rounds have ended.
  std::optional<ConvergenceResult> convergence() const { return rounds_.result(); }

 private:
  std::size_t slot_of(std::size_t cell) const { return cell / plan_.poses().size(); }
  const Plan& plan_of_sums() const { return part_ ? *part_ : plan_; }
  void begin_sums() {
    sums_.reset();
    if constexpr (Sums::kOfRound) part_.emplace(plan_.with_samples(rounds_.samples(0)));
    sums_.emplace(job_.sums(plan_of_sums(), shard_));
  }
  /// Writes the sums of all units, or reads the sums of one shard. A state that was merged from several shards has
  /// their sums one after the other.
  void part_state(Archive& archive) {
    head_state(archive, Job::kName, job_.sizes());
    archive.known(plan_.cells(), "has other cells");
    std::size_t samples = plan_of_sums().samples();
    archive.number(samples, samples);
    archive.expect(samples > 0, "has no samples");
    sums_->state(archive, samples);
  }

  const Plan& plan_;
  const Job& job_;
  Shard shard_;
  Rounds rounds_;
  std::optional<Plan> part_;             ///< plan with only the samples of this round; none unless kOfRound
  std::optional<Sums> sums_;             ///< sums of the units; they refer to the plan part_ or plan_
  std::optional<PendingUnits> pending_;  ///< units to be solved in this round
};

/// The sums of the cells of a plan, or of a shard's cells. If the last unit of a cell has fewer than Plan::kUnitSamples
/// samples, its sums are kept separately: a study with more samples has a full unit in its place, so its run continues
/// from the sums of the full units only. `Store` is a type that holds the sums of several cells. It has these members:
///
///     Store(std::size_t responses, std::size_t cells)    sums of no samples; Store() has no cells
///     std::vector<SolveCounts> solves                    [cells] how the solves of each cell ended
///     void merge(std::size_t cell, const Unit&)          adds later samples of a cell
///     void merge(Store later)                            adds later samples of each cell
///     void state(Archive&, std::size_t cell, std::uint64_t first)   reads or writes a cell; first: its first sample
///     Store part(const NumberRange& cells) const         a copy with only these cells
template <class Store>
class CellSums {
 public:
  static constexpr bool kOfRound = false;  ///< The sums of a round are continued in the next round.

  /// Sums without samples, for the cells of a shard and R responses. Keeps a reference to the plan.
  CellSums(const Plan& plan, std::size_t responses, const Shard& shard)
      : plan_(&plan), responses_(responses), cells_(shard.of(plan.cells())) {}

  /// Adds the output of a unit. Precondition: all earlier units of its cell have been added.
  template <class Unit>
  void add(const WorkUnit& unit, const Unit& found) {
    const std::size_t cell = cell_of(unit);
    POESY_EXPECTS(cells_.holds(cell) && unit.first.value == units_done(cell) * Plan::kUnitSamples);
    with_room(unit.count == Plan::kUnitSamples ? whole_ : parts_).merge(cell - cells_.first, found);
  }
  /// The number of units of a cell that were added.
  std::size_t units_done(std::size_t cell) const {
    return static_cast<std::size_t>(samples_in(whole_, cell) / Plan::kUnitSamples) +
           (samples_in(parts_, cell) > 0 ? 1 : 0);
  }
  /// The solves of all units that were added.
  SolveCounts total() const {
    SolveCounts sum = total_of(whole_.solves);
    sum.merge(total_of(parts_.solves));
    return sum;
  }
  /// The sums of the cells of one slot at all poses. Preconditions: the shard has all these cells; units were added.
  Store cells_of(std::size_t slot) const {
    const NumberRange range{slot * plan_->poses().size(), (slot + 1) * plan_->poses().size()};
    POESY_EXPECTS(cells_.first == 0 && range.end <= cells_.end && (!whole_.solves.empty() || !parts_.solves.empty()));
    if (whole_.solves.empty()) return parts_.part(range);
    Store some = whole_.part(range);
    if (!parts_.solves.empty()) some.merge(parts_.part(range));
    return some;
  }
  /// The sums of all cells. Preconditions: the shard has all cells of the plan; units were added.
  Store cells() && {
    POESY_EXPECTS(cells_.first == 0 && cells_.end == plan_->cells());
    POESY_EXPECTS(!whole_.solves.empty() || !parts_.solves.empty());
    if (whole_.solves.empty()) return std::exchange(parts_, {});
    if (!parts_.solves.empty()) whole_.merge(std::exchange(parts_, {}));
    return std::exchange(whole_, {});
  }

  /// Writes the sums of all cells, or reads sums and adds them. samples: the number of samples of the plan that wrote
  /// the sums. Returns the number of units of each cell in the state.
  std::vector<std::size_t> state(Archive& archive, std::size_t samples) {
    std::vector<std::size_t> units;
    units.reserve(plan_->cells());
    for (std::size_t cell = 0; cell < plan_->cells(); ++cell) units.push_back(cell_state(archive, cell, samples));
    return units;
  }

 protected:
  /// The number of the unit's cell in the plan.
  std::size_t cell_of(const WorkUnit& unit) const { return unit.slot * plan_->poses().size() + unit.pose.value; }
  /// The store to which a unit of this size is added.
  const Store& store_of(const WorkUnit& unit) const { return unit.count == Plan::kUnitSamples ? whole_ : parts_; }

  const Plan* plan_;       ///< the plan, which divides the study into cells (one slot at one pose)
  std::size_t responses_;  ///< number of responses, R
  NumberRange cells_;      ///< cells of the shard

 private:
  std::uint64_t samples_in(const Store& store, std::size_t cell) const {
    return !store.solves.empty() && cells_.holds(cell) ? store.solves[cell - cells_.first].total() : 0;
  }
  /// Returns the store. If it has no cells yet, first gives it empty sums for the cells of the shard.
  Store& with_room(Store& store) const {
    if (store.solves.empty()) store = Store(responses_, cells_.end - cells_.first);
    return store;
  }
  /// Reads or writes the sums of a cell in a store. first: number of the first sample of these sums. Returns the number
  /// of their samples.
  std::uint64_t store_state(Archive& archive, Store& store, std::size_t cell, std::uint64_t first) const {
    with_room(store).state(archive, cell, first);
    return store.solves[cell].total();
  }
  std::size_t cell_state(Archive& archive, std::size_t cell, std::size_t samples) {
    const bool has_whole = archive.flag(samples_in(whole_, cell) > 0);
    const bool has_part = archive.flag(samples_in(parts_, cell) > 0);
    if (!has_whole && !has_part) return 0;
    archive.expect(cells_.holds(cell), "has a cell of another shard");
    archive.expect(units_done(cell) == 0, "has a cell twice");
    std::uint64_t whole = 0;
    if (has_whole) {
      whole = store_state(archive, whole_, cell - cells_.first, 0);
      const bool is_whole = whole > 0 && whole % Plan::kUnitSamples == 0 && whole <= samples;
      archive.expect(is_whole, "has a cell that is not a number of whole units");
    }
    if (!has_part) return Plan::units_for(static_cast<std::size_t>(whole));
    std::uint64_t part = 0;
    if (samples == plan_->samples()) {
      part = store_state(archive, parts_, cell - cells_.first, whole);
    } else {
      Store left_out(responses_, 1);  // dropped: this study has more samples, and so a larger unit instead
      part = store_state(archive, left_out, 0, whole);
    }
    const bool is_part = part > 0 && part < Plan::kUnitSamples && whole + part == samples;
    archive.expect(is_part, "has a last unit of the wrong size");
    return Plan::units_for(samples);
  }

  Store whole_;  ///< [cells of the shard] sums of the units of full size; no cells before the first such unit
  Store parts_;  ///< [cells of the shard] sums of smaller last units; no cells before the first such unit
};

}  // namespace poesy
