#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/study/study.h"

namespace poesy {

/// The content of a shard file. It is an HDF5 file with /study, /poses and /run as in a result. The group /shard has
/// the states of the shard's stages (Checkpoints), which only the program that wrote them can read.
struct StoredShard {
  std::string path;            ///< path of the file
  std::string poesy_version;   ///< exact version of the program: no other version can read the states
  std::string git_commit;      ///< commit from which that program was built
  std::string study_text;      ///< the study file (TOML) with every default filled in
  std::string mechanism_text;  ///< the mechanism file; empty if the mechanism has none
  SelectedPoses poses;         ///< poses of the whole study
  Shard shard;                 ///< index of the shard, and number of all shards
  std::vector<Bytes> stages;   ///< [stages] states of the stages (engine/run/checkpoints.h)
  RunFacts facts;              ///< facts of the run that solved the shard
};

/// Writes a shard file, which appears complete or not at all. Throws FileError.
void write_shard(const std::string& path, const Study& study, const SelectedPoses& poses, const Shard& shard,
                 std::span<const Bytes> stages, const RunFacts& facts);

/// Reads a shard file. Throws FileError if the file is not a shard, or was changed after it was written.
StoredShard read_shard(const std::string& path);

/// Joins the states of all shards of a study, and returns a state for each stage of the study. Sorts the shards, and
/// empties their states. Throws InputError unless they are all shards of one study, each once, written by this version
/// of the program. Throws FileError if their numbers of stages differ.
std::vector<Bytes> merge_shards(std::vector<StoredShard>& shards);

}  // namespace poesy
