#pragma once

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/ranks/team.h"
#include "engine/run/result.h"

namespace poesy {

/// What a run keeps of itself now and then, so that another run may take it up. A run merges finished work in a fixed
/// order, so between two merges its accumulators are all there is to keep. A study may consist of several runs one
/// after another, its stages: each call of a run function (engine/run/fold.h) is one. A continued study goes through
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
    take(state);
    save();
  }

  /// The stage, or a round of it, ended with this state, complete or stopped, after these solves in all parts of the
  /// run.
  template <class State>
  void end(bool complete, const SolveCounts& solves, const State& state) {
    take(state);
    ends_.resize(begun_);
    ends_.back() = {complete, solves};
  }

  /// The run was stopped in what follows its stages and keeps no state; writes a checkpoint.
  void stopped_after_stages() {
    stopped_ = true;
    save();
  }

  /// Whether all stages that began have ended complete, and nothing after them was stopped.
  bool complete() const { return !stopped_ && ends_.size() == begun_ && std::ranges::all_of(ends_, &End::complete); }
  /// Of the stages that have ended.
  SolveCounts solves() const {
    SolveCounts sum;
    for (const End& end : ends_) sum.merge(end.solves);
    return sum;
  }
  /// One state for each stage; empty where none was taken.
  std::span<const Bytes> stages() const { return stages_; }
  /// The stage that began last.
  const Bytes& stage() const { return stages_[begun_ - 1]; }

  /// Writes a checkpoint now, due or not.
  void save() const { save_(stages_); }

 private:
  struct End {
    bool complete = false;
    SolveCounts solves;
  };

  template <class State>
  void take(const State& state) {
    Bytes& stage = stages_[begun_ - 1];
    stage = Bytes();  // the older state goes first: there need not be room for two
    stage = state();
  }

  Due due_;
  Save save_;
  std::vector<Bytes> stages_;  ///< those begun, then what is left of the earlier run's
  std::size_t begun_ = 0;
  std::vector<End> ends_;  ///< of the stages that have ended
  bool stopped_ = false;
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

  /// Between two merges: takes state() and writes a checkpoint when one is due.
  template <class State>
  void merged(const State& state) {
    if (checkpoints_ != nullptr) checkpoints_->merged(state);
  }

  /// The stage, or a round of it, is complete, or was stopped; then a checkpoint is kept. solves() took it in all parts
  /// of the run. The ranks after rank 0 first take up rank 0's state when it is complete: then restore(state) is
  /// called.
  template <class Solves, class State, class Restore>
  void end(bool complete, const Solves& solves, const State& state, const Restore& restore) {
    const bool follows = team_ != nullptr && !team_->leads();
    if (follows && complete) restore(std::span<const std::byte>(team_->end_state()));
    if (checkpoints_ != nullptr && follows) checkpoints_->end(complete, solves(), [] { return Bytes(); });
    if (checkpoints_ != nullptr && !follows) {
      checkpoints_->end(complete, solves(), state);
      // Before the others are told: who was stopped may have little time left.
      if (!complete) checkpoints_->save();
    }
    if (team_ == nullptr || follows) return;
    const Bytes own = complete && checkpoints_ == nullptr ? state() : Bytes();
    team_->end(complete, checkpoints_ != nullptr ? checkpoints_->stage() : own);
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
