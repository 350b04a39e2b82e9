#include "engine/run/checkpoints.h"

#include <algorithm>
#include <utility>

#include "engine/base/error.h"

namespace poesy {

Checkpoints::Checkpoints(Due due, Save save, std::vector<Bytes> stages, Fetch fetch, std::size_t most_in_memory)
    : due_(std::move(due)), save_(std::move(save)), fetch_(std::move(fetch)), most_in_memory_(most_in_memory) {
  is_saved_ = fetch_ && !stages.empty();
  for (Bytes& stage : stages) stages_.push_back({std::move(stage), is_saved_});
}

Bytes Checkpoints::begin() {
  if (begun_ == stages_.size()) stages_.emplace_back();
  const std::size_t stage = begun_++;
  Bytes& bytes = stages_[stage].bytes;
  const bool is_wanted_again = save_ && !is_large(bytes.size());
  return is_wanted_again ? bytes_of(source_of(stage)) : std::exchange(bytes, {});
}

void Checkpoints::end(bool complete, const SolveCounts& solves) {
  ends_.resize(begun_);
  ends_.back() = {complete, solves};
}

void Checkpoints::keep(const ByteSource& state) {
  if (!save_) return;
  Bytes& bytes = stages_[begun_ - 1].bytes;
  bytes = Bytes();  // frees the older state first, because there may not be enough memory for two states
  if (is_large(size_of(state))) {
    try {
      return save(state);
    } catch (const FileError&) {
      // The state is copied into memory below instead.
    }
  }
  bytes = bytes_of(state);
  is_saved_ = false;
}

void Checkpoints::stopped_after_stages() {
  stopped_ = true;
  save();
}

bool Checkpoints::complete() const {
  return !stopped_ && ends_.size() == begun_ && std::ranges::all_of(ends_, &End::complete);
}

SolveCounts Checkpoints::solves() const {
  SolveCounts sum;
  for (const End& end : ends_) sum.merge(end.solves);
  return sum;
}

std::vector<Bytes> Checkpoints::stages() const {
  std::vector<Bytes> all;
  for (std::size_t stage = 0; stage < stages_.size(); ++stage) all.push_back(bytes_of(source_of(stage)));
  return all;
}

void Checkpoints::save(const ByteSource& state) { save_all(&state); }

void Checkpoints::save() {
  if (!is_saved_) save_all(nullptr);
}

ByteSource Checkpoints::source_of(std::size_t stage) const {
  const Kept& kept = stages_[stage];
  if (kept.bytes.empty() && kept.is_saved) return [this, stage](ByteWriter& to) { fetch_(stage, to); };
  return [&kept](ByteWriter& to) { to.raw(kept.bytes); };
}

/// Saves the states of all stages. state: writes the present state of the stage that began last; null if keep() has
/// stored that state.
void Checkpoints::save_all(const ByteSource* state) {
  if (!save_) return;
  std::vector<ByteSource> all;
  for (std::size_t stage = 0; stage < stages_.size(); ++stage) all.push_back(source_of(stage));
  if (state != nullptr) all[begun_ - 1] = *state;
  save_(all);
  if (!fetch_) return;
  is_saved_ = true;
  if (state != nullptr) stages_[begun_ - 1].bytes = Bytes();
  for (Kept& kept : stages_) {
    kept.is_saved = true;
    if (is_large(kept.bytes.size())) kept.bytes = Bytes();
  }
}

}  // namespace poesy
