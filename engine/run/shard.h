#pragma once

#include <cstddef>
#include <string>

namespace poesy {

/// Consecutive numbers, the end not among them.
struct NumberRange {
  std::size_t first;  ///< the first piece of work that is its own
  std::size_t end;    ///< behind the last

  /// Whether this piece is the shard's.
  bool holds(std::size_t number) const { return number >= first && number < end; }
};

/// One of several shards of a study, which together are the whole: each takes consecutive cells of every run that the
/// study consists of, or blocks where it has no cells, in order and as evenly as can be.
struct Shard {
  std::size_t index = 0;  ///< from 0
  std::size_t count = 1;  ///< of all shards

  /// Its part of 0 .. all - 1. The parts of all shards follow each other without gap.
  NumberRange of(std::size_t all) const { return {begin(index, all), begin(index + 1, all)}; }

 private:
  std::size_t begin(std::size_t shard, std::size_t all) const {
    // all * shard / count, which could overflow.
    return all / count * shard + all % count * shard / count;
  }
};

/// "2/5"
inline std::string to_string(const Shard& shard) {
  return std::to_string(shard.index + 1) + "/" + std::to_string(shard.count);
}

}  // namespace poesy
