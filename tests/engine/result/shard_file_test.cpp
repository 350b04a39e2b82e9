#include "engine/result/shard_file.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

/// The message of merge_shards for the shards with these numbers (from 0) of a study that is divided into `count`
/// shards.
std::string said_of(const std::vector<std::size_t>& numbers, std::size_t count) {
  const TempFolder folder;
  const Example example;
  const std::vector<Bytes> stages(1, Bytes(3));
  std::vector<StoredShard> shards;
  for (const std::size_t number : numbers) {
    write_shard(folder / "s.h5", example.study, example.poses, {number, count}, stages, {});
    shards.push_back(read_shard(folder / "s.h5"));
  }
  try {
    merge_shards(shards);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ShardFile, MissingShardsAreNamed) {
  EXPECT_EQ(said_of({0, 1, 2}, 3), "");
  EXPECT_EQ(said_of({3, 1}, 4), "of 4 shards these are missing: 1, 3; run them with --shard and merge all of them");
  EXPECT_EQ(said_of({0, 1}, 4), "of 4 shards these are missing: 3, 4; run them with --shard and merge all of them");
}

/// A file may claim any number of shards, so only the first missing ones are named and the search ends soon.
TEST(ShardFile, OfManyMissingShardsTheFirstAreNamed) {
  const std::string first = "1, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21";
  EXPECT_EQ(said_of({1}, std::size_t{1} << 40U),
            "of 1099511627776 shards these are missing: " + first +
                " and 1099511627755 more; run them with --shard and merge all of them");
  EXPECT_EQ(said_of({1}, 22),
            "of 22 shards these are missing: " + first + " and 1 more; run them with --shard and merge all of them");
}

TEST(ShardFile, StatesAreReadAndPutTogether) {
  const TempFolder folder;
  const Example example;
  std::vector<StoredShard> shards;
  for (const std::size_t number : {std::size_t{1}, std::size_t{0}}) {
    const std::vector<Bytes> stages{Bytes(2, std::byte(10 + number)), Bytes(1, std::byte(20 + number))};
    write_shard(folder / "s.h5", example.study, example.poses, {number, 2}, stages, {});
    shards.push_back(read_shard(folder / "s.h5"));
    EXPECT_EQ(shards.back().stages, stages);
  }
  const std::vector<Bytes> whole{{std::byte{10}, std::byte{10}, std::byte{11}, std::byte{11}},
                                 {std::byte{20}, std::byte{21}}};
  EXPECT_EQ(merge_shards(shards), whole);
}

}  // namespace
}  // namespace poesy::test
