#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <new>
#include <span>
#include <system_error>

#include "engine/app/command_line.h"
#include "engine/app/results.h"
#include "engine/base/error.h"
#include "engine/kinds/study_file.h"
#include "engine/kinds/study_run.h"
#include "engine/result/result_file.h"
#include "engine/result/shard_file.h"
#include "engine/run/outlook.h"
#include "engine/storage/checkpoint.h"
#include "models/registry.h"

namespace poesy::app {
namespace {

struct MergeOptions {
  std::vector<std::string> shards;
  std::string result;
};

/// The sum of the times of all shards.
RunTime time_of(const std::vector<StoredShard>& shards) {
  RunTime sum;
  for (const StoredShard& shard : shards) {
    sum.wall += shard.facts.wall_seconds;
    sum.checkpoints += shard.facts.checkpoint_seconds;
  }
  return sum;
}

/// The largest value among all shards of one fact about their runs. fact: pointer to the member with this fact.
std::size_t most(const std::vector<StoredShard>& shards, std::size_t RunFacts::*fact) {
  std::size_t largest = 0;
  for (const StoredShard& shard : shards) largest = std::max(largest, shard.facts.*fact);
  return largest;
}

/// The size of all states together, bytes. A state has the sums that one stage of a study accumulated.
std::size_t state_bytes(std::span<const Bytes> states) {
  std::size_t sum = 0;
  for (const Bytes& state : states) sum += state.size();
  return sum;
}

/// The least memory that is needed to read the shards, bytes. A missing file is left out.
std::size_t file_bytes(std::span<const std::string> paths) {
  std::size_t sum = 0;
  for (const std::string& path : paths) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(path, error);
    if (!error) sum += static_cast<std::size_t>(bytes);
  }
  return sum;
}

/// The peak memory of merging, bytes. All states stay in memory until the last of them is restored.
std::size_t peak_of(std::span<const Bytes> states, const MemoryOutlook& run) {
  return state_bytes(states) + run.accumulators + run.result;
}

/// Merges the shards and writes the result. needed: is set to the memory that merging needs, as text, as soon as this
/// is known; if memory runs out, the caller reports it.
int merge(const MergeOptions& options, const std::string& path, std::string& needed) {
  std::vector<StoredShard> shards;
  for (const std::string& shard : options.shards) shards.push_back(read_shard(shard));
  std::vector<Bytes> merged = merge_shards(shards);
  const StoredShard& first = shards.front();
  const StoredStudy whole = stored_study(first, registry());
  const Study& study = whole.study;
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  needed = memory_text(peak_of(merged, outlook(study, *model, whole.poses.poses).memory));
  // From here on, the merge is treated as a run of the whole study that was resumed after all stages were done.
  Checkpoints done({}, {}, std::move(merged));
  const Job job{.study = study,
                .model = *model,
                .poses = whole.poses,
                .path = path,
                .options = {.checkpoints = &done},
                .time = [time = time_of(shards)] { return time; },
                .threads = most(shards, &RunFacts::threads),
                .ranks = most(shards, &RunFacts::ranks)};
  try {
    return report_outcome(job, path, run_to_file(job).value());
  } catch (const BytesError& error) {
    throw FileError(first.path, std::string("or another shard ") + error.what(), "run the shards again");
  }
}

int merge_to_end(const MergeOptions& options) {
  const std::string path = check_result_path(options.result, options.shards);
  const RunLock lock(path);
  std::string needed = memory_text(file_bytes(options.shards)) + ", or more,";
  try {
    return merge(options, path, needed);
  } catch (const std::bad_alloc&) {
    throw too_little_memory(path, "this merge", needed);
  }
}

}  // namespace

Command& add_merge(Command& program) {
  const auto [command, options] =
      program.add_command("merge", "put the shards of a study together (poesy run --shard)", merge_to_end);
  command.add_value("shards", options.shards, "SHARD.h5", "all shards of one study, in any order")->required();
  command.add_value("-o,--output", options.result, "RESULT.h5", "result file, the same as that of one run")->required();
  command.examples = {{"two shards", "poesy merge study.1-of-2.h5 study.2-of-2.h5 -o study.h5"},
                      {"all that there are", "poesy merge study.*-of-*.h5 -o study.h5"}};
  return command;
}

}  // namespace poesy::app
