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

/// The processes that work on one run, its ranks, as one of them sees them. None of its functions waits.
class Ranks {
 public:
  /// What one rank sent to another.
  struct Message {
    std::size_t from;  ///< the rank that sent it
    Bytes bytes;       ///< its content
  };

  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;
  virtual ~Ranks() = default;

  /// This process's number. Precondition of all members: called from one thread at a time.
  virtual std::size_t rank() const = 0;
  /// How many there are.
  virtual std::size_t size() const = 0;
  /// This process as a user would look for it: "rank 3 on node7".
  virtual std::string name() const = 0;
  /// Sends bytes to another rank and keeps them until they are on their way.
  virtual void send(std::size_t to, std::shared_ptr<const Bytes> bytes) = 0;
  /// The next message, if one has come. Those of one sender come in the order in which they were sent. Throws
  /// std::bad_alloc when there is no room for it: then it is lost.
  virtual std::optional<Message> try_receive() = 0;
};

/// What a message between ranks is about: its first number. What follows, in the notation of engine/base/bytes.h:
enum class RankMessage : std::uint64_t {
  study,      ///< rank 0 to all: text, what the study and the program are
  agreed,     ///< to rank 0: number of threads; this rank has the same study
  begin,      ///< rank 0 to all: number of the stage, its state as a block
  ready,      ///< to rank 0: number of the stage, number of threads
  range,      ///< rank 0 to one: first number, how many of them; to be solved
  outputs,    ///< to rank 0: until the end, a number and its output as a block
  end,        ///< rank 0 to all: 1 if the stage is complete, else 0; its state as a block
  leaving,    ///< to rank 0: reason, text; this rank cannot go on
  dismissed,  ///< rank 0 to all: exit code; the run is over
  gone        ///< to rank 0: the last message of this rank
};

/// Why a rank cannot go on.
enum class LeaveReason : std::uint64_t { stopped, bad_input, file_trouble, internal };

/// What a rank says when it cannot go on.
struct RankLeft {
  LeaveReason reason;  ///< what kind of trouble it is
  std::string text;    ///< names the rank and says what is wrong
};

/// Thrown on the ranks after rank 0 where they wait, when rank 0 ends the run.
struct Dismissed : std::exception {
  /// With the exit code that rank 0 ends with.
  explicit Dismissed(int exit_code) : code(exit_code) {}
  /// A clause.
  const char* what() const noexcept override { return "rank 0 ended the run"; }
  int code;  ///< the exit code that rank 0 ends with
};

/// This process's part in a run on several ranks. Rank 0 leads: it alone knows the checkpoints, hands out the work,
/// merges all outputs and writes the result. The others follow: they go through the same stages, solve what they are
/// given, and take each stage's final state from rank 0, so that every rank has the whole of it. run_over_ranks has
/// what happens within a stage, RankMessage the messages.
class Team {
 public:
  /// Refers to the ranks.
  explicit Team(Ranks& ranks) : ranks_(&ranks) {}

  /// Whether this is rank 0.
  bool leads() const { return ranks_->rank() == 0; }
  /// How it reaches the others.
  const Ranks& ranks() const { return *ranks_; }
  /// Of all ranks together, known to rank 0 once they agreed.
  std::size_t threads() const { return threads_; }

  /// The beginning on every rank: all must have the same study, described by its text, and so many threads each.
  /// False on rank 0 when one left, or stop was set; false on another one whose study differs.
  bool agree(const std::string& study, std::size_t threads, const std::atomic<bool>* stop);

  // Stages, in the same order on every rank.

  /// Rank 0: the state that the stage begins with, empty at its beginning. Gives that of rank 0 on every rank.
  Bytes begin(const Bytes& state);
  /// The stage that began last, counted from 1.
  std::size_t stage() const { return stage_; }
  /// Rank 0: the stage ended with this state; needed only if it is complete.
  void end(bool complete, const Bytes& state);
  /// The others: the state with which rank 0 ended the stage. Precondition: an end was received.
  const Bytes& end_state() const { return end_state_; }
  /// The others: what an end says; whether the stage is complete.
  bool take_end(ByteReader& message);

  // The end of the run.

  /// The others: does what is to be done, and waits until rank 0 ends the run; its exit code. What the body throws is
  /// told to rank 0, which is to report it. Nothing may be sent afterwards.
  int follow(const std::function<void()>& body);
  /// The others: this rank cannot go on, for a reason that rank 0 is to report.
  void leave(LeaveReason reason, const std::string& problem);
  /// Rank 0: ends the run and waits for the others to be gone. False when they are not in time.
  bool dismiss(int exit_code, std::chrono::milliseconds patience);
  /// Rank 0: the first rank that left.
  const std::optional<RankLeft>& left() const { return left_; }

  // Messages.

  /// A message that begins with what it is about.
  static ByteWriter message(RankMessage about);
  /// Sends what was written to another rank; leaves nothing.
  void send(std::size_t to, ByteWriter& bytes);
  /// A message from another rank.
  struct Received {
    std::size_t from;   ///< the rank that sent it
    RankMessage about;  ///< its first number
    Bytes bytes;        ///< of the whole message
    /// Reads what follows the first number.
    ByteReader reader() const;
  };
  /// The next message but for those about leaving and dismissal, if one has come. Throws Dismissed.
  std::optional<Received> try_receive();

 private:
  void send_to_others(ByteWriter& bytes);
  int await_dismissal();
  /// Takes what has come, when no more is to be done with it. What there is no room for is lost.
  void pass_over_messages();
  void say_farewell();
  /// Waits for a message; those about other things are passed over.
  Received wait_for(RankMessage about);

  Ranks* ranks_;
  std::size_t threads_ = 0;
  std::size_t stage_ = 0;
  std::size_t gone_ = 0;
  Bytes end_state_;
  std::optional<RankLeft> left_;
};

/// Sleeps between looks for messages, the longer the longer nothing came: cores are wanted for solves.
class LookPause {
 public:
  /// The length of the next sleep.
  std::chrono::microseconds next() { return length_ = length_ * 2 < kLongest ? length_ * 2 : kLongest; }
  /// Something came.
  void reset() { length_ = kShortest; }
  /// Sleeps for next().
  void sleep();

 private:
  static constexpr std::chrono::microseconds kShortest{100};
  static constexpr std::chrono::microseconds kLongest{500};
  std::chrono::microseconds length_ = kShortest;
};

}  // namespace poesy
