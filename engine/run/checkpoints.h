#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/ranks/team.h"
#include "engine/run/result.h"

namespace poesy {

/// The largest state, in bytes, of a finished stage that stays in memory if saved states can be read again.
inline constexpr std::size_t kMostStateInMemory = std::size_t{64} << 20U;

/// Saves the state of a run from time to time, so that another run can continue it. A run merges finished work in a
/// fixed order, so between two merges its accumulators are its whole state. A study may have several runs in sequence,
/// its stages: each call of a run function (engine/run/fold.h) is one. A continued study goes through the same stages;
/// finished ones have nothing left to solve. States are written directly from the accumulators; only small states of
/// finished stages are also kept in memory.
class Checkpoints {
 public:
  /// Whether it is time for another checkpoint.
  using Due = std::function<bool()>;
  /// Saves the states of all stages, in order. Never called from two threads at once. Throws FileError and then leaves
  /// the states that were saved before.
  using Save = std::function<void(std::span<const ByteSource> stages)>;
  /// Writes the last saved state of a stage. Throws FileError.
  using Fetch = std::function<void(std::size_t stage, ByteWriter& to)>;

  /// Saves nothing: for a run that will not be continued.
  Checkpoints() = default;
  /// stages: the states of an earlier run; empty for a new run. fetch: if given, it returns these states before the
  /// first save, and states above most_in_memory are not kept in memory.
  Checkpoints(Due due, Save save, std::vector<Bytes> stages = {}, Fetch fetch = {},
              std::size_t most_in_memory = kMostStateInMemory);

  /// Begins the next stage. Returns the state to restore; empty for a stage that starts afresh.
  Bytes begin();
  /// Called after a merge: writes a checkpoint if one is due. state: of the stage that began last, as in all functions
  /// below.
  void merged(const ByteSource& state) {
    if (due_ && due_()) save(state);
  }
  /// Ends the stage or a round of it, complete or stopped. solves: of all parts of the run.
  void end(bool complete, const SolveCounts& solves);
  /// Keeps the final state of the stage: a small one in memory, a large one in a checkpoint that is written now. If the
  /// checkpoint finds no room, the state stays in memory, because the result may be smaller.
  void keep(const ByteSource& state);
  /// The run was stopped in work that follows its stages and has no state; writes a checkpoint.
  void stopped_after_stages();

  /// Whether all stages that began are complete, and nothing after them was stopped.
  bool complete() const;
  /// The solves of the stages that have ended.
  SolveCounts solves() const;
  /// A copy of the state of each stage; empty if none was kept. Throws FileError.
  std::vector<Bytes> stages() const;

  /// Writes a checkpoint with this state now.
  void save(const ByteSource& state);
  /// Writes a checkpoint of the states that were kept, unless the last one has them all and can be read.
  void save();

 private:
  struct End {
    bool complete = false;
    SolveCounts solves;
  };
  /// The state of a stage: these bytes, or the result of fetch_ if there are none.
  struct Kept {
    Bytes bytes;
    bool is_saved = false;  ///< whether fetch_ returns this state or an earlier one
  };

  bool is_large(std::size_t bytes) const { return fetch_ && bytes > most_in_memory_; }
  ByteSource source_of(std::size_t stage) const;
  void save_all(const ByteSource* state);

  Due due_;
  Save save_;
  Fetch fetch_;
  std::size_t most_in_memory_ = kMostStateInMemory;
  std::vector<Kept> stages_;  ///< stages that began, followed by those of the earlier run
  std::size_t begun_ = 0;
  std::vector<End> ends_;  ///< ends of the finished stages
  bool stopped_ = false;
  bool is_saved_ = false;  ///< whether fetch_ returns every present state
};

/// Connects one stage with the checkpoints and the other ranks, if there are any.
class Stage {
 public:
  /// Either argument may be null.
  Stage(Checkpoints* checkpoints, Team* team) : checkpoints_(checkpoints), team_(team) {}

  /// Calls restore(state) if there is a state to restore, which comes from the checkpoint of rank 0.
  template <class Restore>
  void begin(const Restore& restore) {
    Bytes state;
    if (checkpoints_ != nullptr) state = checkpoints_->begin();
    if (team_ != nullptr) state = team_->begin(state);
    if (!state.empty()) restore(std::span<const std::byte>(state));
  }

  /// Called between two merges: writes a checkpoint with this state when one is due.
  void merged(const ByteSource& state) {
    if (checkpoints_ != nullptr) checkpoints_->merged(state);
  }

  /// Ends the stage or a round of it. If it was stopped, a checkpoint is written. solves(): the solves of all parts of
  /// the run. If it is complete, the ranks after rank 0 take its state: restore(state) is called on them.
  template <class Solves, class Restore>
  void end(bool complete, const Solves& solves, const ByteSource& state, const Restore& restore) {
    const bool follows = team_ != nullptr && !team_->leads();
    if (follows && complete) restore(std::span<const std::byte>(team_->end_state()));
    if (checkpoints_ != nullptr) checkpoints_->end(complete, solves());
    if (follows) return;
    if (checkpoints_ != nullptr && complete) checkpoints_->keep(state);
    // Before the other ranks are told, because a stopped process may have little time left.
    if (checkpoints_ != nullptr && !complete) checkpoints_->save(state);
    if (team_ != nullptr) team_->end(complete, complete ? bytes_of(state) : Bytes());
  }

  /// Begins another round of the stage, from the final state of the one before.
  void next_round() {
    if (team_ != nullptr) static_cast<void>(team_->begin({}));
  }

 private:
  Checkpoints* checkpoints_;
  Team* team_;
};

}  // namespace poesy
