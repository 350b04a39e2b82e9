#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/study/study.h"

namespace poesy {

/// What a shard file says: an HDF5 file with /study, /poses and /run as in a result, and in /shard what the shard
/// found, for the program that wrote it alone.
struct StoredShard {
  std::string path;            ///< of the file
  std::string poesy_version;   ///< exact: bytes of a state are for the program that wrote them
  std::string git_commit;      ///< of that program
  std::string study_text;      ///< the study with every default filled in
  std::string mechanism_text;  ///< the file that describes the mechanism; empty where there is none
  SelectedPoses poses;         ///< of the whole study
  Shard shard;                 ///< which part of the study
  std::vector<Bytes> stages;   ///< states of the study's runs (engine/run/checkpoints.h)
  RunFacts facts;              ///< of the run that solved it
};

/// Writes a shard, in the way of results: whole or not at all. Throws FileError.
void write_shard(const std::string& path, const Study& study, const SelectedPoses& poses, const Shard& shard,
                 std::span<const Bytes> stages, const RunFacts& facts);

/// Reads one back. Throws FileError when it is not one, or when it was changed since it was written.
StoredShard read_shard(const std::string& path);

/// Puts the shards of a study together: the state of each of its runs, whole. Throws InputError that names the files
/// when they are not the shards of one study, written by this program's version, each once.
std::vector<Bytes> merge_shards(std::vector<StoredShard>& shards);

}  // namespace poesy
