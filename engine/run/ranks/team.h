#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "engine/base/bytes.h"

namespace poesy {

/// The processes of one run, its ranks, from the view of one of them. No function waits.
class Ranks {
 public:
  /// A message from one rank to another.
  struct Message {
    std::size_t from;  ///< the rank that sent it
    Bytes bytes;       ///< its content
  };

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  /// The number of this process. Precondition of all members: called from one thread at a time.
  virtual std::size_t rank() const = 0;
  /// The number of ranks.
  virtual std::size_t size() const = 0;
  /// The name by which a user would look for this process: "rank 3 on node7".
  virtual std::string name() const = 0;
  /// Sends bytes to another rank, and keeps them until they are sent.
  virtual void send(std::size_t to, std::shared_ptr<const Bytes> bytes) = 0;
  /// The next message, if one has arrived. Messages of one sender arrive in order. Throws std::bad_alloc if there is no
  /// memory for it; it is then lost.
  virtual std::optional<Message> try_receive() = 0;
};

/// The type of a message between ranks, which is its first number. The content follows, in the notation of
/// engine/base/bytes.h:
enum class RankMessage : std::uint64_t {
  study,      ///< rank 0 to all: text that describes the study and the program
  agreed,     ///< to rank 0: number of threads; this rank has the same study
  begin,      ///< rank 0 to all: number of the stage, its state as a block
  ready,      ///< to rank 0: number of the stage, number of threads
  range,      ///< rank 0 to one: first number of the work, and how many numbers to solve
  outputs,    ///< to rank 0: number and output as a block, repeated to the end
  end,        ///< rank 0 to all: 1 if the stage is complete, else 0; its state as a block
  leaving,    ///< to rank 0: reason, text; this rank cannot go on
  dismissed,  ///< rank 0 to all: exit code; the run is over
  gone        ///< to rank 0: the last message of this rank
};

/// Why a rank cannot go on.
enum class LeaveReason : std::uint64_t { stopped, bad_input, file_trouble, internal };

/// The message of a rank that cannot go on.
struct RankLeft {
  LeaveReason reason;  ///< kind of the problem
  std::string text;    ///< names the rank and describes the problem
};

/// Thrown on the ranks after rank 0 while they wait, when rank 0 ends the run.
struct Dismissed : std::exception {
  /// exit_code: the exit code of rank 0.
  explicit Dismissed(int exit_code) : code(exit_code) {}
  /// A clause that describes the reason.
  const char* what() const noexcept override { return "rank 0 ended the run"; }
  int code;  ///< the exit code of rank 0
};

/// The part of this process in a run on several ranks. Rank 0 leads: only it has the checkpoints; it hands out the
/// work, merges all outputs and writes the result. The others follow: they go through the same stages, solve what they
/// are assigned, and take the final state of each stage from rank 0. run_over_ranks() describes a stage, RankMessage
/// the messages.
class Team {
 public:
  /// Refers to the ranks.
  explicit Team(Ranks& ranks) : ranks_(&ranks) {}

  /// Whether this is rank 0.
  bool leads() const { return ranks_->rank() == 0; }
  /// The connection to the other ranks.
  const Ranks& ranks() const { return *ranks_; }
  /// The threads of all ranks together; known to rank 0 after agree().
  std::size_t threads() const { return threads_; }

  /// The first call on every rank: all must have the same study, described by its text. threads: of this rank. Returns
  /// false on rank 0 if a rank left or stop was set, and on another rank if its study differs.
  bool agree(const std::string& study, std::size_t threads, const std::atomic<bool>* stop);

  // Stages, which all ranks go through in the same order.

  /// Rank 0: state is the state with which the stage begins, empty for a new one. Returns the state of rank 0 on every
  /// rank.
  Bytes begin(const Bytes& state);
  /// The stage that began last, counted from 1.
  std::size_t stage() const { return stage_; }
  /// Rank 0: ends the stage. state: needed only if the stage is complete.
  void end(bool complete, const Bytes& state);
  /// Other ranks: the final state of the stage on rank 0. Precondition: an end message was received.
  const Bytes& end_state() const { return end_state_; }
  /// Other ranks: reads an end message; returns whether the stage is complete.
  bool take_end(ByteReader& message);

  // The end of the run.

  /// Other ranks: runs the body, waits until rank 0 ends the run, and returns its exit code. An exception of the body
  /// is sent to rank 0, which reports it. Nothing may be sent afterwards.
  int follow(const std::function<void()>& body);
  /// Other ranks: tells rank 0 why this rank cannot go on.
  void leave(LeaveReason reason, const std::string& problem);
  /// Rank 0: ends the run and waits for the other ranks to end. Returns false if they do not end in time.
  bool dismiss(int exit_code, std::chrono::milliseconds patience);
  /// Rank 0: the message of the first rank that left.
  const std::optional<RankLeft>& left() const { return left_; }

  // Messages.

  /// Begins a message of this type.
  static ByteWriter message(RankMessage about);
  /// Sends the bytes to another rank and empties them.
  void send(std::size_t to, ByteWriter& bytes);
  /// A message from another rank.
  struct Received {
    std::size_t from;   ///< the rank that sent it
    RankMessage about;  ///< its first number
    Bytes bytes;        ///< the whole message
    /// Reads the content after the type.
    ByteReader reader() const;
  };
  /// The next message, if one has arrived. Messages of leaving and dismissal are handled here. Throws Dismissed.
  std::optional<Received> try_receive();

 private:
  void send_to_others(ByteWriter& bytes);
  int await_dismissal();
  /// Receives and discards all messages that have arrived. Those without room in memory are lost.
  void pass_over_messages();
  void say_farewell();
  /// Waits for a message of this type; others are discarded.
  Received wait_for(RankMessage about);

  Ranks* ranks_;
  std::size_t threads_ = 0;
  std::size_t stage_ = 0;
  std::size_t gone_ = 0;
  Bytes end_state_;
  std::optional<RankLeft> left_;
};

/// Sleeps between checks for messages, longer the longer none has arrived, because solves need the cores.
class LookPause {
 public:
  /// The length of the next sleep.
  std::chrono::microseconds next() { return length_ = length_ * 2 < kLongest ? length_ * 2 : kLongest; }
  /// Call it when a message has arrived.
  void reset() { length_ = kShortest; }
  /// Sleeps for next().
  void sleep();

 private:
  static constexpr std::chrono::microseconds kShortest{100};
  static constexpr std::chrono::microseconds kLongest{500};
  std::chrono::microseconds length_ = kShortest;
};

}  // namespace poesy
