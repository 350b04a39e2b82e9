#include "engine/result/shard_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/base/readable_line.h"
#include "engine/base/text.h"
#include "engine/result/result_parts.h"
#include "engine/storage/content_hash.h"
#include "engine/storage/poesy_file.h"
#include "engine/storage/version.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

std::string state_path(std::size_t stage) { return fmt::format("/shard/state_{}", stage + 1); }

Bytes read_state(const h5::File& file, const std::string& path) {
  h5::Value value = file.value(path);
  if (value.type != h5::Value::Type::unsigned_integer || value.width != 1) throw h5::Error(path + " is not bytes");
  return std::move(value.numbers);
}

StoredShard read_checked(const std::string& path, const h5::File& file) {
  expect_filetype(path, file, kShardFile);
  if (stored_hash(file) != content_sha256(file)) {
    throw FileError(path, "was changed since it was written: its content does not have the hash it carries",
                    "take another copy, or run this shard again");
  }
  StoredShard stored;
  stored.path = path;
  stored.poesy_version = text_attribute(file, "poesy_version");
  stored.git_commit = text_attribute(file, "git_commit");
  stored.study_text = file.read<std::string>("/study/text").at(0);
  stored.mechanism_text = mechanism_text(file);
  stored.poses = read_poses(file);
  stored.shard.count = file.attribute<std::uint64_t>("/shard", "shards").at(0);
  stored.shard.index = file.attribute<std::uint64_t>("/shard", "shard").at(0) - 1;
  if (stored.shard.index >= stored.shard.count) throw h5::Error("/shard has a number beyond the last");
  for (std::size_t k = 0; file.exists(state_path(k)); ++k) stored.stages.push_back(read_state(file, state_path(k)));
  stored.facts = read_facts(file);
  return stored;
}

std::size_t number(const StoredShard& shard) { return shard.shard.index; }

/// The name of a shard in messages: "shard 2 of 5".
std::string name_of(const Shard& shard) { return fmt::format("shard {} of {}", shard.index + 1, shard.count); }

[[noreturn]] void refuse(const StoredShard& shard, const std::string& problem, const std::string& remedy) {
  throw InputError({.file = shard.path}, problem, remedy);
}

void check_version(const StoredShard& shard) {
  if (shard.poesy_version == poesy_version() && shard.git_commit == git_commit()) return;
  refuse(shard,
         fmt::format("was written by poesy {} ({}), and this is poesy {} ({})", printable(shard.poesy_version),
                     printable(shard.git_commit), poesy_version(), git_commit()),
         "merge with the version that ran the shards");
}

void check_same_study(const StoredShard& shard, const StoredShard& first) {
  if (shard.study_text != first.study_text) {
    const auto [there, here] = with_readable_quantities(first_difference(shard.study_text, first.study_text));
    refuse(shard, fmt::format("is of another study: it has {} where {} has {}", there, first.path, here),
           "merge shards of one study");
  }
  if (shard.mechanism_text != first.mechanism_text) {
    const auto [there, here] = first_difference(shard.mechanism_text, first.mechanism_text);
    refuse(shard,
           fmt::format("is of another mechanism: its file has {} where that of {} has {}", there, first.path, here),
           "merge shards of one mechanism");
  }
  if (shard.poses.poses != first.poses.poses) {
    refuse(shard, "has other poses than " + first.path + ", though under the same name", "merge shards of one study");
  }
  if (shard.shard.count != first.shard.count) {
    refuse(shard, fmt::format("is {}, and {} is {}", name_of(shard.shard), first.path, name_of(first.shard)),
           "merge shards of the same division");
  }
  if (shard.stages.size() != first.stages.size()) {
    throw FileError(shard.path, "is damaged: it has another number of runs than " + first.path, kDamagedRemedy);
  }
}

/// The numbers of missing shards, from 1: "2, 5 and 7 more". Only the first 20 are listed, because a file may state any
/// number of shards. Precondition: the shards are in order, none appears twice, and at least one is missing.
std::string missing_text(std::span<const StoredShard> shards) {
  constexpr std::size_t kMostListed = 20;
  const std::size_t count = shards.front().shard.count;
  std::size_t left = count - shards.size();
  std::string text;
  auto next = shards.begin();
  for (std::size_t index = 0, listed = 0; left > 0 && listed < kMostListed; ++index) {
    if (next != shards.end() && number(*next) == index) {
      ++next;
      continue;
    }
    text += (listed == 0 ? "" : ", ") + std::to_string(index + 1);
    ++listed;
    --left;
  }
  return left == 0 ? text : fmt::format("{} and {} more", text, left);
}

/// Throws InputError if a shard is missing. Precondition: the shards are in order, and none appears twice.
void check_all_there(std::span<const StoredShard> shards) {
  const std::size_t count = shards.front().shard.count;
  if (shards.size() == count) return;
  throw InputError({}, fmt::format("of {} shards these are missing: {}", count, missing_text(shards)),
                   "run them with --shard and merge all of them");
}

/// Joins the states of one stage (Checkpoints) from all shards, in the order of the shards, and removes them from
/// `shards`.
Bytes take_state(std::span<StoredShard> shards, std::size_t stage) {
  std::size_t bytes = 0;
  for (const StoredShard& shard : shards) bytes += shard.stages[stage].size();
  Bytes whole;
  whole.reserve(bytes);
  for (StoredShard& shard : shards) {
    const Bytes part = std::exchange(shard.stages[stage], {});
    whole.insert(whole.end(), part.begin(), part.end());
  }
  return whole;
}

}  // namespace

void write_shard(const std::string& path, const Study& study, const SelectedPoses& poses, const Shard& shard,
                 std::span<const Bytes> stages, const RunFacts& facts) {
  compose_file(path, kShardFile, study.analysis.kind->name, study, poses, facts, [&](ResultBuilder& result) {
    h5::File& file = result.file();
    file.make_group("/shard");
    file.set_attribute("/shard", "description",
                       std::string("What one shard of the study found, for poesy merge of the same version"));
    file.set_attribute("/shard", "shard", std::uint64_t{shard.index + 1});
    file.set_attribute("/shard", "shards", std::uint64_t{shard.count});
    for (std::size_t k = 0; k < stages.size(); ++k) {
      const std::string path_of_state = state_path(k);
      file.write_slices<std::uint8_t>(
          path_of_state, {stages[k].size()}, [&](std::size_t first, std::span<std::uint8_t> to) {
            std::ranges::transform(std::span(stages[k]).subspan(first, to.size()), to.begin(),
                                   [](std::byte byte) { return std::to_integer<std::uint8_t>(byte); });
          });
      file.set_attribute(path_of_state, "unit", std::string("1"));
      file.set_attribute(path_of_state, "description", std::string("Accumulators of the shard's cells, as bytes"));
    }
  });
}

StoredShard read_shard(const std::string& path) {
  return with_poesy_file(path, [&](const h5::File& file) { return read_checked(path, file); });
}

std::vector<Bytes> merge_shards(std::vector<StoredShard>& shards) {
  POESY_EXPECTS(!shards.empty());
  for (const StoredShard& shard : shards) {
    check_version(shard);
    check_same_study(shard, shards.front());
  }
  std::ranges::stable_sort(shards, {}, number);
  const auto twice = std::ranges::adjacent_find(shards, {}, number);
  if (twice != shards.end()) {
    refuse(*twice, fmt::format("and {} are both {}", std::next(twice)->path, name_of(twice->shard)), "give each once");
  }
  check_all_there(shards);
  std::vector<Bytes> merged;
  const std::size_t stages = shards.front().stages.size();
  for (std::size_t k = 0; k < stages; ++k) merged.push_back(take_state(shards, k));
  return merged;
}

}  // namespace poesy
