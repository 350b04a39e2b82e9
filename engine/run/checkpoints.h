#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/ranks/team.h"
#include "engine/run/result.h"

namespace poesy {

/// The largest size, in bytes, of a finished stage's state that is kept in memory. Larger states are read again from
/// the checkpoint file, if that is possible (Fetch).
inline constexpr std::size_t kMostStateInMemory = std::size_t{64} << 20U;

/// Saves the state of a run from time to time, so that another run can continue it. A run merges finished work in a
/// fixed order, so between two merges its accumulators are its whole state. A study may have several stages, one for
/// each call of fold() (engine/run/fold.h). A continued study goes through the same stages; in a finished stage nothing
/// is left to solve. A state is written directly from the accumulators of its stage. Only small states of finished
/// stages are kept in memory.
class Checkpoints {
 public:
  /// A function that says whether it is time for another checkpoint.
  using Due = std::function<bool()>;
  /// A function that saves the states of all stages, in order. It is never called from two threads at once. Throws
  /// FileError; earlier saved states then stay saved.
  using Save = std::function<void(std::span<const ByteSource> stages)>;
  /// A function that writes to `to` the last saved state of a stage. Throws FileError.
  using Fetch = std::function<void(std::size_t stage, ByteWriter& to)>;

  /// Checkpoints that are never saved, for a run that will not be continued.
  Checkpoints() = default;
  /// stages: the states that an earlier run saved; empty for a new run. fetch: if given, it returns these states until
  /// the first save, and states of more than most_in_memory bytes are not kept in memory.
  Checkpoints(Due due, Save save, std::vector<Bytes> stages = {}, Fetch fetch = {},
              std::size_t most_in_memory = kMostStateInMemory);

  /// Begins the next stage. Returns the state to restore; empty for a stage that starts afresh.
  Bytes begin();
  /// Writes a checkpoint if one is due. Called after a merge. state: here and in the functions below, the state of the
  /// stage that began last.
  void merged(const ByteSource& state) {
    if (due_ && due_()) save(state);
  }
  /// Records that the stage or one of its rounds has ended. complete: false if the run was stopped. solves: all solves
  /// of the run, including those of the earlier run that it continues.
  void end(bool complete, const SolveCounts& solves);
  /// Keeps the final state of the stage: a small one in memory, a large one in a checkpoint that is written now. If the
  /// disk has no room for the checkpoint, the state stays in memory, because the smaller result may still have room on
  /// the disk.
  void keep(const ByteSource& state);
  /// Writes a checkpoint after the run was stopped in work that comes after the stages. Such work has no state of its
  /// own.
  void stopped_after_stages();

  /// Returns true if all stages that began are complete, and the work after them was not stopped.
  bool complete() const;
  /// The solves of the stages that have ended.
  SolveCounts solves() const;
  /// A copy of the state of each stage; an empty one for a stage without a kept state. Throws FileError.
  std::vector<Bytes> stages() const;

  /// Writes a checkpoint with this state now.
  void save(const ByteSource& state);
  /// Writes a checkpoint of the states that were kept. Does nothing if the last checkpoint has all of them and can be
  /// read again.
  void save();

 private:
  struct End {
    bool complete = false;
    SolveCounts solves;
  };
  /// The state of a stage. It is in `bytes`, or if these are empty, in the checkpoint from which fetch_ reads.
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
  std::vector<End> ends_;  ///< ends of the finished stages
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

  /// Called between two merges: writes a checkpoint with this state when one is due.
  void merged(const ByteSource& state) {
    if (checkpoints_ != nullptr) checkpoints_->merged(state);
  }

  /// Ends the stage or one of its rounds. complete: false if the run was stopped; a checkpoint is then written. If the
  /// stage is complete, all other ranks take the state of rank 0 by restore(state). solves(): all solves of the run,
  /// including those of the earlier run that it continues.
  template <class Solves, class Restore>
  void end(bool complete, const Solves& solves, const ByteSource& state, const Restore& restore) {
    const bool follows = team_ != nullptr && !team_->leads();
    if (follows && complete) restore(std::span<const std::byte>(team_->end_state()));
    if (checkpoints_ != nullptr) checkpoints_->end(complete, solves());
    if (follows) return;
    if (checkpoints_ != nullptr && complete) checkpoints_->keep(state);
    // Saved before the other ranks are told, because a stopped process may have little time left.
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
