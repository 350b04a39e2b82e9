#pragma once

#include <cstddef>
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
  /// The next message, if one has come. Those of one sender come in the order in which they were sent.
  virtual std::optional<Message> try_receive() = 0;
};

}  // namespace poesy
