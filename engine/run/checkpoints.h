#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/ranks/team.h"
#include "engine/run/result.h"

namespace poesy {

/// Of the state of a stage that has ended, bytes that stay in memory at the most where saves can be read again.
inline constexpr std::size_t kMostStateInMemory = std::size_t{64} << 20U;

/// What a run keeps of itself now and then, so that another run may take it up. A run merges finished work in a fixed
/// order, so between two merges its accumulators are all there is to keep. A study may consist of several runs one
/// after another, its stages: each call of a run function (engine/run/fold.h) is one. A continued study goes through
/// the same stages, and those that were finished have nothing left to solve.
/// A state is written from the accumulators into what keeps it; only small states of stages that have ended are kept in
/// memory besides.
class Checkpoints {
 public:
  /// Whether it is time for another checkpoint.
  using Due = std::function<bool()>;
  /// Keeps the states of all stages, in order. Never called from two threads at once. Throws FileError; then what was
  /// kept before is kept.
  using Save = std::function<void(std::span<const ByteSource> stages)>;
  /// Writes the state of a stage as it was kept last. Throws FileError.
  using Fetch = std::function<void(std::size_t stage, ByteWriter& to)>;

  /// Keeps nothing: for a run that nobody continues.
  Checkpoints() = default;
  /// stages: what an earlier run kept; empty for a run from the beginning. fetch: if there is one, it gives these
  /// stages before the first save; then a state of more than most_in_memory is not held besides.
  Checkpoints(Due due, Save save, std::vector<Bytes> stages = {}, Fetch fetch = {},
              std::size_t most_in_memory = kMostStateInMemory);

  /// The next stage begins: the state to take up, empty where it begins at its beginning.
  Bytes begin();
  /// Work was merged: writes a checkpoint if one is due. state: of the stage that began last, as everywhere below.
  void merged(const ByteSource& state) {
    if (due_ && due_()) save(state);
  }
  /// The stage, or a round of it, ended, complete or stopped, after these solves in all parts of the run.
  void end(bool complete, const SolveCounts& solves);
  /// Keeps the state with which the stage ended: in memory, or, where it is large, by a checkpoint at once. If that
  /// finds no room, it stays in memory after all, for the result may be smaller.
  void keep(const ByteSource& state);
  /// The run was stopped in what follows its stages and keeps no state; writes a checkpoint.
  void stopped_after_stages();

  /// Whether all stages that began have ended complete, and nothing after them was stopped.
  bool complete() const;
  /// Of the stages that have ended.
  SolveCounts solves() const;
  /// A copy of one state for each stage; empty where none was kept. Throws FileError.
  std::vector<Bytes> stages() const;

  /// Writes a checkpoint now, due or not, with this state.
  void save(const ByteSource& state);
  /// Writes a checkpoint of what was kept, unless the last one has all of it and can be read.
  void save();

 private:
  struct End {
    bool complete = false;
    SolveCounts solves;
  };
  /// The state of a stage: these bytes, or, where there are none, what fetch_ gives.
  struct Kept {
    Bytes bytes;
    bool is_saved = false;  ///< fetch_ gives this state or an earlier one
  };

  bool is_large(std::size_t bytes) const { return fetch_ && bytes > most_in_memory_; }
  ByteSource source_of(std::size_t stage) const;
  void save_all(const ByteSource* state);

  Due due_;
  Save save_;
  Fetch fetch_;
  std::size_t most_in_memory_ = kMostStateInMemory;
  std::vector<Kept> stages_;  ///< those begun, then what is left of the earlier run's
  std::size_t begun_ = 0;
  std::vector<End> ends_;  ///< of the stages that have ended
  bool stopped_ = false;
  bool is_saved_ = false;  ///< fetch_ gives every state as it is
};

/// One stage's dealings with checkpoints and other ranks, if there are any.
class Stage {
 public:
  /// Either may be null.
  Stage(Checkpoints* checkpoints, Team* team) : checkpoints_(checkpoints), team_(team) {}

  /// Calls restore(state) if there is a state to take up: of the checkpoint, that rank 0 has.
  template <class Restore>
  void begin(const Restore& restore) {
    Bytes state;
    if (checkpoints_ != nullptr) state = checkpoints_->begin();
    if (team_ != nullptr) state = team_->begin(state);
    if (!state.empty()) restore(std::span<const std::byte>(state));
  }

  /// Between two merges: writes a checkpoint with this state when one is due.
  void merged(const ByteSource& state) {
    if (checkpoints_ != nullptr) checkpoints_->merged(state);
  }

  /// The stage, or a round of it, is complete, or was stopped; then a checkpoint is written. solves() took it in all
  /// parts of the run. The ranks after rank 0 first take up rank 0's state when it is complete: then restore(state) is
  /// called.
  template <class Solves, class Restore>
  void end(bool complete, const Solves& solves, const ByteSource& state, const Restore& restore) {
    const bool follows = team_ != nullptr && !team_->leads();
    if (follows && complete) restore(std::span<const std::byte>(team_->end_state()));
    if (checkpoints_ != nullptr) checkpoints_->end(complete, solves());
    if (follows) return;
    if (checkpoints_ != nullptr && complete) checkpoints_->keep(state);
    // Before the others are told: who was stopped may have little time left.
    if (checkpoints_ != nullptr && !complete) checkpoints_->save(state);
    if (team_ != nullptr) team_->end(complete, complete ? bytes_of(state) : Bytes());
  }

  /// Another round of the stage begins, from the state with which the one before ended.
  void next_round() {
    if (team_ != nullptr) static_cast<void>(team_->begin({}));
  }

 private:
  Checkpoints* checkpoints_;
  Team* team_;
};

}  // namespace poesy
