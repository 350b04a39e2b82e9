#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/ranks/team.h"
#include "engine/run/result.h"

namespace poesy {

/// The largest size, in bytes, of a finished stage's state that is kept in memory. A larger state is read again from
/// the checkpoint file if Checkpoints::Fetch is given.
inline constexpr std::size_t kMostStateInMemory = std::size_t{64} << 20U;

/// Saves the state of a run from time to time, so that another run can continue it. A run merges finished work in a
/// fixed order, so between two merges its accumulators are its whole state. A study may have several stages, one for
/// each call of fold() (engine/run/fold.h). A study that is continued goes through all its stages again, but in a
/// finished stage nothing is left to solve. The state of the running stage is written directly from its accumulators,
/// without a copy in memory.
class Checkpoints {
 public:
  /// A function that says whether it is time for another checkpoint.
  using Due = std::function<bool()>;
  /// A function that saves the states of all stages, in order. It is never called from two threads at once. If it
  /// throws FileError, the states that were saved before stay saved.
  using Save = std::function<void(std::span<const ByteSource> stages)>;
  /// A function that writes to `to` the last saved state of a stage. Throws FileError.
  using Fetch = std::function<void(std::size_t stage, ByteWriter& to)>;

  /// Checkpoints that are never saved, for a run that will not be continued.
  Checkpoints() = default;
  /// stages: the states that an earlier run saved; empty for a new run. fetch: if given, a state of more than
  /// most_in_memory bytes is not kept in memory but read by fetch. Until the first save, fetch must return the states
  /// in `stages`.
  Checkpoints(Due due, Save save, std::vector<Bytes> stages = {}, Fetch fetch = {},
              std::size_t most_in_memory = kMostStateInMemory);

  /// Begins the next stage. Returns the state that an earlier run saved for it; empty if there is none.
  Bytes begin();
  /// Writes a checkpoint if one is due; called after a merge. state, in this function and those below: a function that
  /// writes the state of the stage that began last.
  void merged(const ByteSource& state) {
    if (due_ && due_()) save(state);
  }
  /// Records that the stage or one of its rounds has ended. complete: false if the run was stopped. solves: all solves
  /// of this stage, including those of the earlier run that this run continues.
  void end(bool complete, const SolveCounts& solves);
  /// Keeps the final state of the stage: a small one in memory, a large one in a checkpoint that is written now. If the
  /// checkpoint cannot be written, a large state stays in memory too: a full disk may still have room for the smaller
  /// result.
  void keep(const ByteSource& state);
  /// Writes a checkpoint if the run was stopped in work after the last stage. That work has no state: it is done again
  /// when the run is continued.
  void stopped_after_stages();

  /// Returns true if all stages that began are complete, and the work after them was not stopped.
  bool complete() const;
  /// The sum of the solves of all stages that have ended.
  SolveCounts solves() const;
  /// Copies of the states of all stages; empty for a stage whose state was not kept. Throws FileError.
  std::vector<Bytes> stages() const;

  /// Writes a checkpoint with this state now.
  void save(const ByteSource& state);
  /// Writes a checkpoint of the states that keep() stored. Does nothing if fetch can read all of them from the last
  /// checkpoint.
  void save();

 private:
  struct End {
    bool complete = false;
    SolveCounts solves;
  };
  /// The state of a stage: in `bytes`, or if these are empty, in the checkpoint from which fetch_ reads.
  struct Kept {
    Bytes bytes;
    bool is_saved = false;  ///< true if fetch_ returns this state or an earlier state of the stage
  };

  bool is_large(std::size_t bytes) const { return fetch_ && bytes > most_in_memory_; }
  ByteSource source_of(std::size_t stage) const;
  void save_all(const ByteSource* state);

  Due due_;
  Save save_;
  Fetch fetch_;
  std::size_t most_in_memory_ = kMostStateInMemory;
  /// First the states of the stages that have begun. After them, states that an earlier run saved for stages that have
  /// not begun yet.
  std::vector<Kept> stages_;
  std::size_t begun_ = 0;
  std::vector<End> ends_;  ///< [stages that began] how each stage, or its last round, ended
  bool stopped_ = false;
  bool is_saved_ = false;  ///< true if fetch_ returns the present state of every stage
};

/// Connects one stage of a study with the checkpoints and with the other ranks, if there are any.
class Stage {
 public:
  /// checkpoints, team: may be null.
  Stage(Checkpoints* checkpoints, Team* team) : checkpoints_(checkpoints), team_(team) {}

  /// Calls restore(state) if the checkpoint of rank 0 has a state for this stage.
  template <class Restore>
  void begin(const Restore& restore) {
    Bytes state;
    if (checkpoints_ != nullptr) state = checkpoints_->begin();
    if (team_ != nullptr) state = team_->begin(state);
    if (!state.empty()) restore(std::span<const std::byte>(state));
  }

  /// Writes a checkpoint with this state if one is due. Called between two merges.
  void merged(const ByteSource& state) {
    if (checkpoints_ != nullptr) checkpoints_->merged(state);
  }

  /// Ends the stage or one of its rounds. complete: false if the run was stopped; a checkpoint is then written. If the
  /// stage is complete, every other rank calls restore(state) with the state of rank 0. solves(): all solves of the
  /// stage, including those of the earlier run that this run continues.
  template <class Solves, class Restore>
  void end(bool complete, const Solves& solves, const ByteSource& state, const Restore& restore) {
    const bool follows = team_ != nullptr && !team_->leads();
    if (follows && complete) restore(std::span<const std::byte>(team_->end_state()));
    if (checkpoints_ != nullptr) checkpoints_->end(complete, solves());
    if (follows) return;
    if (checkpoints_ != nullptr && complete) checkpoints_->keep(state);
    // The checkpoint is written before the other ranks are told, because a stopped process may have little time left.
    if (checkpoints_ != nullptr && !complete) checkpoints_->save(state);
    if (team_ != nullptr) team_->end(complete, complete ? bytes_of(state) : Bytes());
  }

  /// Begins another round of the stage, from the final state of the previous round.
  void next_round() {
    if (team_ != nullptr) static_cast<void>(team_->begin({}));
  }

 private:
  Checkpoints* checkpoints_;
  Team* team_;
};

}  // namespace poesy
