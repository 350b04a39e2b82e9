#pragma once

#include <cstdint>

namespace poesy {

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

}  // namespace poesy
