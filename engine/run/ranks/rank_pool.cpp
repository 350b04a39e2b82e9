#include "engine/run/ranks/rank_pool.h"
#include "engine/run/run_options.h"

#include <utility>

namespace poesy {

template <class Function>
auto RankPool::closing(Function function) {
  return [this, function = std::move(function)](auto... arguments) {
    try {
      return function(arguments...);
    } catch (...) {
      close();
      throw;
    }
  };
}

RankPool::RankPool(const RunOptions& options, std::function<SlotJob()> make_work, SlotOf slot_of, SlotJob deliver)
    : slot_of_(std::move(slot_of)), low_(resolved_threads(options.threads)) {
  const auto make_closing = closing([this, make = std::move(make_work)] { return SlotJob(closing(make())); });
  thread_ = std::thread([this, options, make_closing, give_out = SlotJob(closing(std::move(deliver)))] {
    try {
      run_in_slots([this] { return take(); }, options, make_closing, give_out);
    } catch (...) {
      problem_ = std::current_exception();
      failed_ = true;
    }
  });
}

RankPool::~RankPool() {
  close();
  if (thread_.joinable()) thread_.join();
}

void RankPool::give(std::size_t first, std::size_t count) {
  const std::lock_guard lock(mutex_);
  ranges_.push_back({first, first + count});
  left_ += count;
  given_.notify_one();
}

void RankPool::wait(std::chrono::microseconds at_most) {
  std::unique_lock lock(mutex_);
  hungry_.wait_for(lock, at_most, [&] { return hungry_now_; });
  hungry_now_ = false;
}

std::optional<Ticket> RankPool::take() {
  std::unique_lock lock(mutex_);
  given_.wait(lock, [this] { return closed_ || left_ > 0; });
  if (closed_) return std::nullopt;
  Range& range = ranges_.front();
  const std::size_t n = range.first++;
  if (range.first == range.end) ranges_.pop_front();
  --left_;
  if (left_ == low_ || left_ == 0) {
    hungry_now_ = true;
    hungry_.notify_one();
  }
  return Ticket{n, slot_of_(n)};
}

void RankPool::close() {
  const std::lock_guard lock(mutex_);
  closed_ = true;
  given_.notify_all();
}

void RankPool::finish() {
  close();
  if (thread_.joinable()) thread_.join();
  if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
}

}  // namespace poesy
