#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include "engine/run/fold.h"
#include "engine/run/rounds.h"
#include "engine/run/shard.h"

namespace poesy {

/// A job whose units are blocks of samples. Its number of samples may be adaptive (Rounds), and a study with more
/// samples can continue one with fewer.
template <class Job>
concept SampledUnits = requires(const Job& job) {
  job.rounds();
};

/// The work of fold() for a sequence of units, which are solved on any thread and merged in order. UnitFold manages the
/// pending units, shards, and states. A job is a type with everything else:
///
///     static constexpr std::string_view kName       name in the states, unique among all jobs
///     std::vector<std::uint64_t> sizes() const      sizes of the job; a state with other sizes is refused
///     NumberRange units(const Shard&) const         the units of a shard, numbered from 0 over all shards
///     std::uint64_t expected(std::size_t n) const   expected number of solves of unit n
///     Worker worker() const                         owns the scratch of one thread: worker(n) solves unit n
///     Unit unit(std::size_t n) const                an empty unit, with state(Archive&); not needed if Unit is Sums
///     SolveCounts solves(std::size_t n, const Unit&) const   how a unit's solves ended
///     Sums sums() const                             empty sums
///
/// The sums have add(std::size_t n, Unit&&), which adds the next unit, and state(Archive&, const NumberRange& units),
/// which writes the sums of these units, or reads and adds them. The type of a unit may be Sums; a state is then read
/// as a Sums object, which is added like a unit. A job whose units are blocks of samples also has:
///
///     Rounds rounds() const                         the rounds of the study, at the start of the first one
///     std::size_t samples() const                   samples of the whole study
///     std::size_t units_for(std::size_t samples) const   number of units for these samples
///     bool is_whole(std::size_t n) const            true if more samples would not make unit n larger
///     std::vector<Estimate> estimates(const Sums&, const Unit* last) const   estimates that decide after a round
///
/// If the last unit is not whole, because a study with more samples has a larger unit in its place, its sums are kept
/// separate until the end. A study with more samples continues without that unit.
template <class Job>
class UnitFold {
 public:
  using Sums = decltype(std::declval<const Job&>().sums());      ///< The type of the sums to which units are added.
  using Worker = decltype(std::declval<const Job&>().worker());  ///< The type of the worker of one thread.
  using Unit = std::invoke_result_t<Worker&, std::size_t>;       ///< The type of the output of a unit.

  /// Solves the units of options.shard, or all units if there is no shard. Keeps a reference to the job.
  UnitFold(const Job& job, const RunOptions& options)
      : job_(job), units_(job.units(options.shard.value_or(Shard()))), sums_(job.sums()) {
    clear();
  }

  /// See fold().
  /// @{
  std::size_t begin_round() {
    begun_ = next_;
    end_ = units_.end;
    if constexpr (SampledUnits<Job>) end_ = std::clamp(job_.units_for(rounds_->samples(0)), next_, units_.end);
    return end_ - begun_;
  }
  Worker worker() const { return job_.worker(); }
  Unit solve(Worker& worker, std::size_t n) const { return worker(begun_ + n); }
  void piece_state(Archive& archive, std::size_t n, Unit& unit) const { unit_state(archive, begun_ + n, unit); }
  SolveCounts merge(std::size_t, Unit&& unit) {
    const SolveCounts solves = job_.solves(next_, unit);
    if (is_whole(next_)) {
      sums_.add(next_, std::move(unit));
      solved_.merge(solves);
    } else {
      last_.emplace(std::move(unit));
    }
    ++next_;
    return solves;
  }
  SolveCounts solved() const {
    SolveCounts solves = solved_;
    if (last_) solves.merge(job_.solves(next_ - 1, *last_));
    return solves;
  }
  std::uint64_t left() const {
    const std::uint64_t left = expected({next_, end_});
    if constexpr (SampledUnits<Job>) return rounds_->expected_left(solved(), left);
    const std::uint64_t expected_so_far = expected({units_.first, next_});
    if (expected_so_far == 0) return left;
    const double took = static_cast<double>(solved().total()) / static_cast<double>(expected_so_far);
    return static_cast<std::uint64_t>(std::llround(took * static_cast<double>(left)));
  }
  void state(Archive& archive) {
    if (archive.reads()) clear();
    if constexpr (SampledUnits<Job>) archive.object(*rounds_);
    do {
      part_state(archive);
    } while (archive.is_left());
  }
  bool next_round() {
    if constexpr (SampledUnits<Job>) {
      return rounds_->go_on([&](std::size_t) { return job_.estimates(sums_, last_ ? &*last_ : nullptr); });
    }
    return false;
  }
  /// @}

  /// The sums of all units that were merged. Precondition: all rounds have ended.
  Sums sums() && {
    if (last_) sums_.add(next_ - 1, *std::exchange(last_, std::nullopt));
    return std::move(sums_);
  }
  /// How the adaptive sampling ended; empty if the number of samples was fixed. Precondition: all rounds have ended.
  std::optional<ConvergenceResult> convergence() const { return rounds_ ? rounds_->result() : std::nullopt; }

 private:
  /// Removes all sums, and goes back to the first round.
  void clear() {
    sums_ = job_.sums();
    next_ = units_.first;
    solved_ = {};
    last_.reset();
    if constexpr (SampledUnits<Job>) rounds_.emplace(job_.rounds());
  }
  bool is_whole(std::size_t n) const {
    if constexpr (SampledUnits<Job>) return job_.is_whole(n);
    return true;
  }
  std::uint64_t expected(const NumberRange& units) const {
    std::uint64_t solves = 0;
    for (std::size_t n = units.first; n < units.end; ++n) solves += job_.expected(n);
    return solves;
  }
  void unit_state(Archive& archive, std::size_t n, Unit& unit) const {
    if constexpr (std::is_same_v<Unit, Sums>) {
      if (archive.reads()) unit = job_.sums();
      unit.state(archive, {n, n + 1});
    } else {
      if (archive.reads()) unit = job_.unit(n);
      archive.object(unit);
    }
  }

  /// Writes the sums of all units, or reads the sums of one shard. A state that was merged from several shards has
  /// their sums one after the other.
  void part_state(Archive& archive) {
    head_state(archive, Job::kName, job_.sizes());
    NumberRange units{archive.reads() ? next_ : units_.first, last_ ? next_ - 1 : next_};
    archive.known(units.first, "does not follow what was solved before");
    archive.number(units.end, units_.end);
    archive.expect(units.end >= units.first, "has units that end before they begin");
    SolveCounts solves = solved_;
    archive.object(solves);
    sums_state(archive, units);
    if (archive.reads()) {
      solved_.merge(solves);
      next_ = units.end;
    }
    if constexpr (SampledUnits<Job>) last_state(archive);
  }
  void sums_state(Archive& archive, const NumberRange& units) {
    if constexpr (std::is_same_v<Unit, Sums>) {
      if (archive.reads()) {
        Sums part = job_.sums();
        part.state(archive, units);
        return sums_.add(units.first, std::move(part));
      }
    }
    sums_.state(archive, units);
  }
  /// Reads or writes the sums of a last unit that is not whole. They are separate, because a study with more samples
  /// leaves them out.
  void last_state(Archive& archive) {
    std::size_t samples = job_.samples();
    archive.number(samples, job_.samples());
    Bytes bytes;
    if (last_) bytes = bytes_of([&](ByteWriter& to) { write_state(*last_, to); });
    archive.block(bytes);
    if (!archive.reads() || bytes.empty() || samples < job_.samples()) return;
    archive.expect(next_ + 1 == units_.end && !is_whole(next_), "has a last unit of another size");
    ByteReader from(bytes);
    Archive of_last(from);
    unit_state(of_last, next_, last_.emplace());
    from.expect_end();
    ++next_;
  }

  const Job& job_;
  NumberRange units_;  ///< units of the shard
  std::size_t next_ = 0;
  std::size_t begun_ = 0;  ///< number of the round's first unit
  std::size_t end_ = 0;    ///< number of the round's last unit, plus 1
  Sums sums_;              ///< sums of the units that are whole (see UnitFold)
  SolveCounts solved_;     ///< solves of the units that are whole
  std::optional<Unit> last_;
  std::optional<Rounds> rounds_;
};

/// Solves all units of a job and returns their sums. Empty if the run was stopped, and for a shard.
template <class Job>
std::optional<typename UnitFold<Job>::Sums> fold_units(const Job& job, const RunOptions& options) {
  UnitFold work(job, options);
  if (!fold(work, options) || options.shard) return std::nullopt;
  return std::move(work).sums();
}

}  // namespace poesy
