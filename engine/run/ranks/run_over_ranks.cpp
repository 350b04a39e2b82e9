#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "engine/base/error.h"
#include "engine/run/run_in_slots.h"

namespace poesy {
namespace {

/// A rank is given up to kAhead pieces of work in advance for each of its threads, later up to kMostAhead. The number
/// doubles each time the rank has returned all its outputs within kQuick after the last assignment.
constexpr std::size_t kAhead = 4;
constexpr std::size_t kMostAhead = 128;
constexpr std::chrono::milliseconds kQuick{3};
/// The largest number of pieces of work that are handed out but not yet merged. If ranks could use more, merging on
/// rank 0 would be the bottleneck anyway.
constexpr std::size_t kMostSlots = 65536;
/// Rank 0 hands out no work while more than this number of bytes of outputs from other ranks wait to be merged in
/// order.
constexpr std::size_t kMostWaitingBytes = std::size_t{256} << 20U;
/// Outputs are collected in a message. It is sent when it has kSendBytes bytes, when kSendEvery has passed since the
/// previous message, or when little work is left.
constexpr std::size_t kSendBytes = std::size_t{16} << 10U;
constexpr std::chrono::microseconds kSendEvery{500};

/// A pool of threads (run_in_slots) that works while the calling thread exchanges messages. It receives the numbers of
/// the pieces of work range by range.
class RankPool {
  /// Wraps a function that oneTBB calls, so that the pool closes if the function throws. Otherwise a thread that waits
  /// for the next piece of work would wait forever, because oneTBB does not end it.
  template <class Function>
  auto closing(Function function) {
    return [this, function = std::move(function)](auto... arguments) {
      try {
        return function(arguments...);
      } catch (...) {
        close();
        throw;
      }
    };
  }

 public:
  /// A function that returns the slot (place) for the output of piece n of the work. It is called in the order of n,
  /// from one thread at a time.
  using SlotOf = std::function<std::size_t(std::size_t n)>;

  /// Calls deliver(n, slot) after each piece of work n, one at a time, on threads of the pool.
  RankPool(const RunOptions& options, std::function<SlotJob()> make_work, SlotOf slot_of, SlotJob deliver)
      : slot_of_(std::move(slot_of)), low_(resolved_threads(options.threads)) {
    const auto make_closing = closing([this, make = std::move(make_work)] { return SlotJob(closing(make())); });
    const auto run = [this, options, make_closing, give_out = SlotJob(closing(std::move(deliver)))] {
      try {
        run_in_slots([this] { return take(); }, options, make_closing, give_out);
      } catch (...) {
        problem_ = std::current_exception();
        failed_ = true;
      }
    };
    try {
      thread_ = std::thread(run);
    } catch (const std::system_error& error) {
      throw FileError("", "a thread cannot be started (" + error.code().message() + ")",
                      "raise the limits on processes and memory (ulimit -u, ulimit -v)");
    }
  }
  RankPool(const RankPool&) = delete;
  RankPool& operator=(const RankPool&) = delete;
  ~RankPool() { join(); }

  /// Adds the pieces of work with the numbers first .. first + count - 1.
  void give(std::size_t first, std::size_t count) {
    const std::lock_guard lock(mutex_);
    ranges_.push_back({first, first + count});
    left_ += count;
    given_.notify_one();
  }

  /// Waits until the pool will soon need more work, but at most this long.
  void wait(std::chrono::microseconds at_most) {
    std::unique_lock lock(mutex_);
    hungry_.wait_for(lock, at_most, [&] { return hungry_now_; });
    hungry_now_ = false;
  }

  /// Returns true if an exception was thrown in the pool.
  bool failed() const { return failed_; }

  /// Ends the pool: work that began is delivered, and no more begins. Throws the exception that was thrown in the pool.
  void finish() {
    join();
    if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
  }

 private:
  std::optional<Ticket> take() {
    std::unique_lock lock(mutex_);
    given_.wait(lock, [this] { return closed_ || left_ > 0; });
    if (closed_) return std::nullopt;
    NumberRange& range = ranges_.front();
    const std::size_t n = range.first++;
    if (range.first == range.end) ranges_.pop_front();
    --left_;
    if (left_ == low_ || left_ == 0) {
      hungry_now_ = true;
      hungry_.notify_one();
    }
    return Ticket{n, slot_of_(n)};
  }

  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    given_.notify_all();
  }

  void join() {
    close();
    if (thread_.joinable()) thread_.join();
  }

  SlotOf slot_of_;
  std::size_t low_;  ///< the pool asks for work when this number of pieces, or none, is left in the ranges
  std::mutex mutex_;
  std::condition_variable given_;
  std::condition_variable hungry_;
  std::deque<NumberRange> ranges_;
  std::size_t left_ = 0;  ///< number of pieces of work left in the ranges
  bool hungry_now_ = false;
  bool closed_ = false;
  std::atomic<bool> failed_{false};
  std::exception_ptr problem_;
  std::thread thread_;  ///< declared last, because its thread uses all other members
};

/// The work of rank 0 in a stage: hands out pieces of work to all ranks, and merges the outputs in order.
class Leader {
 public:
  Leader(std::size_t count, const RunOptions& options, const SlotWork& work)
      : team_(options.team),
        options_(&options),
        work_(&work),
        count_(count),
        window_(rank_slots(options)),
        ranks_(team_->ranks().size()),
        done_(window_),
        bytes_(window_),
        pool_(
            options, work.make_work, [this](std::size_t n) { return n % window_; },
            [this](std::size_t n, std::size_t /*slot*/) { deliver(n); }) {
    ranks_[0].threads = threads_ = resolved_threads(options.threads);
  }

  bool run() {
    LookPause pause;
    while (next_to_merge_ < count_) {
      if (receive()) pause.reset();
      take_own();
      merge();
      for (std::size_t rank = 0; rank < ranks_.size(); ++rank) hand_out(rank);
      if (stopped(*options_) || team_->left() || pool_.failed()) break;
      pool_.wait(pause.next());
    }
    pool_.finish();
    take_own();
    merge();
    return next_to_merge_ == count_;
  }

 private:
  struct Rank {
    std::size_t threads = 0;  ///< number of threads; 0 until the rank has said that it is ready
    std::size_t given = 0;    ///< number of pieces of work handed out to the rank and not yet returned as outputs
    std::size_t ahead = kAhead;
    std::chrono::steady_clock::time_point given_at;  ///< time of the last assignment
  };

  /// Called on a thread of the pool when the work of piece n is done.
  void deliver(std::size_t n) {
    const std::lock_guard lock(mutex_);
    delivered_.push_back(n);
  }

  void take_own() {
    std::vector<std::size_t> delivered;
    {
      const std::lock_guard lock(mutex_);
      delivered.swap(delivered_);
    }
    for (const std::size_t n : delivered) done_[n % window_] = 1;
    returned(ranks_[0], delivered.size());
  }

  bool receive() {
    bool any = false;
    try {
      while (const auto message = team_->try_receive()) {
        any = true;
        ByteReader from = message->reader();
        if (message->about == RankMessage::ready) welcome(message->from, from);
        if (message->about == RankMessage::outputs) take_outputs(message->from, from);
      }
    } catch (const BytesError& error) {
      throw std::runtime_error(std::string("what another rank sent ") + error.what());
    }
    return any;
  }

  void welcome(std::size_t rank, ByteReader& from) {
    if (from.number() != team_->stage()) return;  // the message belongs to an earlier stage
    ranks_[rank].threads = static_cast<std::size_t>(from.number());
    threads_ += ranks_[rank].threads;
  }

  void take_outputs(std::size_t rank, ByteReader& from) {
    std::size_t taken = 0;
    for (; from.left() > 0; ++taken) {
      const auto n = static_cast<std::size_t>(from.number());
      const std::span<const std::byte> output = from.block();
      if (n < next_to_merge_ || n >= next_to_give_ || done_[n % window_] != 0) throw BytesError("was not asked for");
      ByteReader bytes(output);
      Archive archive(bytes);
      work_->state(n, n % window_, archive);
      bytes.expect_end();
      done_[n % window_] = 1;
      bytes_[n % window_] = output.size();
      waiting_bytes_ += output.size();
    }
    returned(ranks_[rank], taken);
  }

  void returned(Rank& rank, std::size_t numbers) {
    rank.given -= numbers;
    const bool is_quick = std::chrono::steady_clock::now() < rank.given_at + kQuick;
    if (numbers > 0 && rank.given == 0 && is_quick) rank.ahead = std::min(kMostAhead, 2 * rank.ahead);
  }

  void merge() {
    while (next_to_merge_ < count_ && done_[next_to_merge_ % window_] != 0) {
      const std::size_t slot = next_to_merge_ % window_;
      work_->finish(next_to_merge_, slot);
      done_[slot] = 0;
      waiting_bytes_ -= std::exchange(bytes_[slot], 0);
      ++next_to_merge_;
    }
  }

  /// Hands out pieces of work to a rank. Towards the end each rank gets fewer at a time, so that all ranks end at about
  /// the same time.
  void hand_out(std::size_t to) {
    Rank& rank = ranks_[to];
    const std::size_t left = count_ - next_to_give_;
    if (left == 0 || rank.threads == 0) return;
    const std::size_t share = std::max<std::size_t>(1, left * rank.threads / (2 * threads_));
    const std::size_t wanted = std::min(rank.ahead * rank.threads, share);
    if (2 * rank.given > wanted || rank.given >= wanted || waiting_bytes_ > kMostWaitingBytes) return;
    const std::size_t room = next_to_merge_ + window_ - next_to_give_;
    const std::size_t numbers = std::min(wanted - rank.given, room);
    if (numbers == 0) return;
    give(to, numbers);
    rank.given += numbers;
    rank.given_at = std::chrono::steady_clock::now();
    next_to_give_ += numbers;
  }

  void give(std::size_t to, std::size_t numbers) {
    if (to == 0) return pool_.give(next_to_give_, numbers);
    ByteWriter range = Team::message(RankMessage::range);
    range.number(next_to_give_);
    range.number(numbers);
    team_->send(to, range);
  }

  Team* team_;
  const RunOptions* options_;
  const SlotWork* work_;
  std::size_t count_;
  std::size_t window_;
  std::vector<Rank> ranks_;
  std::size_t threads_ = 0;  ///< threads of the ranks that are ready
  std::size_t next_to_give_ = 0;
  std::size_t next_to_merge_ = 0;
  std::vector<std::uint8_t> done_;  ///< [slots] 1 if the slot has an output that is not yet merged
  std::vector<std::size_t> bytes_;  ///< [slots] bytes of the output in the slot if another rank sent it, else 0
  std::size_t waiting_bytes_ = 0;
  std::mutex mutex_;
  std::vector<std::size_t> delivered_;  ///< numbers of the pieces of work that the pool delivered
  RankPool pool_;                       ///< declared last, because its threads use all other members
};

/// The work of each rank except rank 0 in a stage: does the pieces of work that rank 0 hands out, and sends their
/// outputs.
class Follower {
 public:
  Follower(const RunOptions& options, const SlotWork& work)
      : team_(options.team),
        options_(&options),
        work_(&work),
        outputs_(Team::message(RankMessage::outputs)),
        pool_(
            options, work.make_work,
            [this, slots = rank_slots(options)](std::size_t /*n*/) { return taken_++ % slots; },
            [this](std::size_t n, std::size_t slot) { deliver(n, slot); }) {
    ByteWriter ready = Team::message(RankMessage::ready);
    ready.number(team_->stage());
    ready.number(resolved_threads(options.threads));
    team_->send(0, ready);
  }

  bool run() {
    bool told = false;
    for (LookPause pause;; pool_.wait(pause.next())) {
      if (receive()) pause.reset();
      if (complete_) break;
      if (pool_.failed()) break;
      if (stopped(*options_) && !told) {
        team_->leave(LeaveReason::stopped, "was asked to stop");
        told = true;
      }
      send_outputs();
    }
    pool_.finish();
    return *complete_;
  }

 private:
  /// Called on a thread of the pool when the work of piece n is done.
  void deliver(std::size_t n, std::size_t slot) {
    ByteWriter output;
    Archive archive(output);
    work_->state(n, slot, archive);
    const Bytes bytes = output.take();
    const std::lock_guard lock(mutex_);
    outputs_.number(n);
    outputs_.block(bytes);
    waiting_bytes_ += bytes.size();
    ++waiting_;
    ++delivered_;
  }

  bool receive() {
    bool any = false;
    while (!complete_) {
      const auto message = team_->try_receive();
      if (!message) break;
      any = true;
      ByteReader from = message->reader();
      if (message->about == RankMessage::end) complete_ = team_->take_end(from);
      if (message->about != RankMessage::range) continue;
      const auto first = static_cast<std::size_t>(from.number());
      const auto numbers = static_cast<std::size_t>(from.number());
      pool_.give(first, numbers);
      given_ += numbers;
    }
    return any;
  }

  void send_outputs() {
    ByteWriter outputs;
    {
      const std::lock_guard lock(mutex_);
      const auto now = std::chrono::steady_clock::now();
      // Near the end, rank 0 may be waiting for exactly these outputs.
      const bool few_left = 2 * (given_ - delivered_) <= resolved_threads(options_->threads);
      if (waiting_ == 0 || (waiting_bytes_ < kSendBytes && now < last_sent_ + kSendEvery && !few_left)) return;
      outputs = std::exchange(outputs_, Team::message(RankMessage::outputs));
      waiting_ = 0;
      waiting_bytes_ = 0;
      last_sent_ = now;
    }
    team_->send(0, outputs);
  }

  Team* team_;
  const RunOptions* options_;
  const SlotWork* work_;
  std::size_t taken_ = 0;  ///< number of pieces of work that the pool has taken
  /// What the message `end` says: whether the stage is complete. None before that message.
  std::optional<bool> complete_;
  std::size_t given_ = 0;  ///< number of pieces of work received from rank 0
  std::mutex mutex_;
  ByteWriter outputs_;
  std::size_t waiting_ = 0;  ///< number of outputs in the unsent message
  std::size_t waiting_bytes_ = 0;
  std::size_t delivered_ = 0;
  std::chrono::steady_clock::time_point last_sent_;
  RankPool pool_;  ///< declared last, because its threads use all other members
};

}  // namespace

std::size_t rank_slots(const RunOptions& options) {
  if (!options.team->leads()) return pool_slots(options);
  return std::min(kMostSlots, 2 * kMostAhead * resolved_threads(options.threads) * options.team->ranks().size());
}

bool run_over_ranks(std::size_t count, const RunOptions& options, const SlotWork& work) {
  return options.team->leads() ? Leader(count, options, work).run() : Follower(options, work).run();
}

}  // namespace poesy
