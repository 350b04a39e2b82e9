#pragma once

#include <cstddef>
#include <string>

namespace poesy {

/// Consecutive numbers in [first, end).
struct NumberRange {
  std::size_t first;  ///< first number
  std::size_t end;    ///< one past the last number

  /// Returns true if this number is in the range.
  bool holds(std::size_t number) const { return number >= first && number < end; }
};

/// One of several shards into which a study is divided. A shard has consecutive cells of the plan (a cell is a varied
/// error at a pose), or consecutive blocks of machines or rows in a study without cells. All shards have the same size,
/// up to one cell or block.
struct Shard {
  std::size_t index = 0;  ///< number of the shard, from 0
  std::size_t count = 1;  ///< number of all shards

  /// The range of the numbers 0 .. all - 1 that belongs to this shard. Each shard begins where the previous one ends.
  NumberRange of(std::size_t all) const { return {begin(index, all), begin(index + 1, all)}; }

 private:
  std::size_t begin(std::size_t shard, std::size_t all) const {
    // Equal to all * shard / count, but without overflow.
    return all / count * shard + all % count * shard / count;
  }
};

/// The shard as text, with numbers from 1: "2/5" for index 1 of 5 shards.
inline std::string to_string(const Shard& shard) {
  return std::to_string(shard.index + 1) + "/" + std::to_string(shard.count);
}

}  // namespace poesy
