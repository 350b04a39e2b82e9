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

/// Messages between the processes (ranks) of one run, as seen from one rank. No function blocks.
class Ranks {
 public:
  /// A message from one rank to another.
  struct Message {
    std::size_t from;  ///< the rank that sent it
    Bytes bytes;       ///< content of the message
  };

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  /// The number of this process, from 0. Precondition of all member functions: they are called from one thread at a
  /// time.
  virtual std::size_t rank() const = 0;
  /// The number of ranks.
  virtual std::size_t size() const = 0;
  /// A name by which a user can find this process, such as "rank 3 on node7".
  virtual std::string name() const = 0;
  /// Begins to send bytes to another rank, and keeps them until they are sent.
  virtual void send(std::size_t to, std::shared_ptr<const Bytes> bytes) = 0;
  /// The next message, if one has arrived. Messages of one sender arrive in order. Throws std::bad_alloc if there is no
  /// memory for the message, which is then lost.
  virtual std::optional<Message> try_receive() = 0;
};

/// The type of a message between ranks. It is the first number of the message; the content follows, encoded as in
/// engine/base/bytes.h.
enum class RankMessage : std::uint64_t {
  study,      ///< rank 0 to all: text that describes the study and the program
  agreed,     ///< to rank 0: the sender has the same study. Content: its number of threads
  begin,      ///< rank 0 to all: a stage begins. Content: its number, and its state as a block
  ready,      ///< to rank 0: the sender is ready for the stage. Content: number of the stage, its number of threads
  range,      ///< rank 0 to one: work to do. Content: number of the first piece of work, and number of pieces
  outputs,    ///< to rank 0: outputs. Content: the number of each piece of work, and its output as a block
  end,        ///< rank 0 to all: the stage ends. Content: 1 if it is complete, else 0; its state as a block
  leaving,    ///< to rank 0: the sender cannot go on. Content: LeaveReason, and text
  dismissed,  ///< rank 0 to all: the run is over. Content: exit code
  gone        ///< to rank 0: the last message of the sender
};

/// Why a rank cannot go on.
enum class LeaveReason : std::uint64_t { stopped, bad_input, file_trouble, internal };

/// The message of a rank that cannot go on.
struct RankLeft {
  LeaveReason reason;  ///< kind of problem
  std::string text;    ///< description of the problem, with the name of the rank
};

/// Thrown on a rank other than rank 0, while it waits, if rank 0 ends the run.
struct Dismissed : std::exception {
  /// exit_code: the exit code of rank 0.
  explicit Dismissed(int exit_code) : code(exit_code) {}
  /// The reason, as a clause.
  const char* what() const noexcept override { return "rank 0 ended the run"; }
  int code;  ///< the exit code of rank 0
};

/// This process as a member of a run on several ranks. Rank 0 leads: it hands out the work, merges all outputs, and
/// writes checkpoints and the result. The other ranks go through the same stages, solve what they are assigned, and
/// take the final state of each stage from rank 0. See run_over_ranks() for a stage and RankMessage for the messages.
class Team {
 public:
  /// ranks: the connection to the other ranks, which must outlive this object.
  explicit Team(Ranks& ranks) : ranks_(&ranks) {}

  /// Returns true if this is rank 0.
  bool leads() const { return ranks_->rank() == 0; }
  /// The connection between the ranks.
  const Ranks& ranks() const { return *ranks_; }
  /// The number of threads of all ranks together; known only on rank 0, after agree().
  std::size_t threads() const { return threads_; }

  /// The first call on every rank. It compares the text of the study, which must be the same on all ranks. threads: the
  /// number of threads of this rank. stop: a flag that stops the run; may be null. Returns false on rank 0 if a rank
  /// left or stop was set, and on another rank if its study differs.
  bool agree(const std::string& study, std::size_t threads, const std::atomic<bool>* stop);

  // Functions for the stages. All ranks go through the stages in the same order.

  /// Begins a stage. On rank 0, `state` is the state with which the stage begins, empty for a new stage. Returns the
  /// state of rank 0 on every rank.
  Bytes begin(const Bytes& state);
  /// The stage that began last, counted from 1.
  std::size_t stage() const { return stage_; }
  /// Rank 0: ends the stage. state: the final state; needed only if the stage is complete.
  void end(bool complete, const Bytes& state);
  /// Other ranks: the final state of the stage on rank 0. Precondition: an end message was received.
  const Bytes& end_state() const { return end_state_; }
  /// Other ranks: reads a message `end`, and keeps its state for end_state(). Returns true if the stage is complete.
  bool take_end(ByteReader& message);

  // Functions for the end of the run.

  /// Other ranks: runs the body, waits until rank 0 ends the run, and returns its exit code. If the body throws, the
  /// message of the exception is sent to rank 0, which reports it. After this call, this rank must send nothing.
  int follow(const std::function<void()>& body);
  /// Other ranks: tells rank 0 why this rank cannot go on.
  void leave(LeaveReason reason, const std::string& problem);
  /// Rank 0: ends the run and waits for the other ranks to end. Returns false if they do not end in time.
  bool dismiss(int exit_code, std::chrono::milliseconds patience);
  /// Rank 0: the message of the first rank that left.
  const std::optional<RankLeft>& left() const { return left_; }

  // Functions for messages.

  /// Begins a message of this type; the caller appends the content.
  static ByteWriter message(RankMessage about);
  /// Sends the bytes to another rank, and empties `bytes`.
  void send(std::size_t to, ByteWriter& bytes);
  /// A message that another rank sent.
  struct Received {
    std::size_t from;   ///< the rank that sent it
    RankMessage about;  ///< type of the message
    Bytes bytes;        ///< the whole message
    /// Reads the content after the type.
    ByteReader reader() const;
  };
  /// The next message, if one has arrived. Messages of the types `leaving`, `gone` and `dismissed` are handled here and
  /// not returned. Throws Dismissed.
  std::optional<Received> try_receive();

 private:
  void send_to_others(ByteWriter& bytes);
  int await_dismissal();
  /// Receives all messages that have arrived, and ignores their content. A message that does not fit into memory is
  /// dropped unread.
  void pass_over_messages();
  void say_farewell();
  /// Waits for a message of this type; discards messages of other types.
  Received wait_for(RankMessage about);

  Ranks* ranks_;
  std::size_t threads_ = 0;
  std::size_t stage_ = 0;
  std::size_t gone_ = 0;
  Bytes end_state_;
  std::optional<RankLeft> left_;
};

/// Sleeps between two checks for messages. While no message arrives, the pauses become longer, because solves need the
/// cores.
class LookPause {
 public:
  /// The length of the next sleep, which is longer than the previous one up to a limit.
  std::chrono::microseconds next() { return length_ = length_ * 2 < kLongest ? length_ * 2 : kLongest; }
  /// Makes the next sleep short again. Call this function when a message has arrived.
  void reset() { length_ = kShortest; }
  /// Sleeps for next().
  void sleep();

 private:
  static constexpr std::chrono::microseconds kShortest{100};
  static constexpr std::chrono::microseconds kLongest{500};
  std::chrono::microseconds length_ = kShortest;
};

}  // namespace poesy
