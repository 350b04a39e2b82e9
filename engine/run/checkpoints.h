#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/team.h"

namespace poesy {

/// What a run keeps of itself now and then, so that another run may take it up. A run merges finished work in a fixed
/// order, so between two merges its accumulators are all there is to keep. A study may consist of several runs one
/// after another, its stages: each call of a run function (engine/run/runner.h) is one. A continued study goes through
/// the same stages, and those that were finished have nothing left to solve.
class Checkpoints {
 public:
  /// Whether it is time for another checkpoint.
  using Due = std::function<bool()>;
  /// Keeps the states of all stages, in order. Never called from two threads at once.
  using Save = std::function<void(std::span<const Bytes> stages)>;

  /// stages: what an earlier run kept; empty for a run from the beginning.
  Checkpoints(Due due, Save save, std::vector<Bytes> stages = {})
      : due_(std::move(due)), save_(std::move(save)), stages_(std::move(stages)) {}

  /// The next stage begins: the state to take up, empty where it begins at its beginning.
  const Bytes& begin() {
    if (begun_ == stages_.size()) stages_.emplace_back();
    return stages_[begun_++];
  }

  /// Work was merged. state() gives the stage's state, if that is wanted.
  template <class State>
  void merged(const State& state) {
    if (!due_()) return;
    stages_[begun_ - 1] = state();
    save();
  }

  /// The stage ended with this state.
  void end(Bytes state) { stages_[begun_ - 1] = std::move(state); }

  void save() const { save_(stages_); }

 private:
  Due due_;
  Save save_;
  std::vector<Bytes> stages_;  ///< those begun, then what is left of the earlier run's
  std::size_t begun_ = 0;
};

/// One stage's dealings with checkpoints and other ranks, if there are any.
class Stage {
 public:
  Stage(Checkpoints* checkpoints, Team* team) : checkpoints_(checkpoints), team_(team) {}

  /// Calls restore(state) if there is a state to take up: of the checkpoint, that rank 0 has.
  template <class Restore>
  void begin(const Restore& restore) {
    Bytes state;
    if (checkpoints_ != nullptr) state = checkpoints_->begin();
    if (team_ != nullptr) state = team_->begin(state);
    if (!state.empty()) restore(std::span<const std::byte>(state));
  }

  template <class State>
  void merged(const State& state) {
    if (checkpoints_ != nullptr) checkpoints_->merged(state);
  }

  /// The stage is complete, or was stopped; then a checkpoint is kept. The ranks after rank 0 take up rank 0's state
  /// when it is complete: then restore(state) is called a second time.
  template <class State, class Restore>
  void end(bool complete, const State& state, const Restore& restore) {
    if (team_ != nullptr && !team_->leads()) {
      if (complete) restore(std::span<const std::byte>(team_->end_state()));
      return;
    }
    if (checkpoints_ == nullptr && team_ == nullptr) return;
    Bytes last = state();
    // The checkpoint first: who was stopped may have little time left.
    if (checkpoints_ != nullptr && !complete) {
      checkpoints_->end(last);
      checkpoints_->save();
    }
    if (team_ != nullptr) team_->end(complete, last);
    if (checkpoints_ != nullptr && complete) checkpoints_->end(std::move(last));
  }

 private:
  Checkpoints* checkpoints_;
  Team* team_;
};

}  // namespace poesy
