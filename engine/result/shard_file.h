#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/run/result.h"
#include "engine/run/shard.h"
#include "engine/study/study.h"

namespace poesy {

/// A shard file: an HDF5 file with /study, /poses and /run as in a result, and in /shard the states of the shard's
/// runs, which only the program that wrote them can read.
struct StoredShard {
  std::string path;            ///< path of the file
  std::string poesy_version;   ///< exact version, because states are for the program that wrote them
  std::string git_commit;      ///< commit of that program
  std::string study_text;      ///< the study with every default filled in
  std::string mechanism_text;  ///< the mechanism file; empty if the mechanism has none
  SelectedPoses poses;         ///< poses of the whole study
  Shard shard;                 ///< which part of the study
  std::vector<Bytes> stages;   ///< states of the study's runs (engine/run/checkpoints.h)
  RunFacts facts;              ///< facts of the run that solved it
};

/// Writes a shard, which appears complete or not at all. Throws FileError.
void write_shard(const std::string& path, const Study& study, const SelectedPoses& poses, const Shard& shard,
                 std::span<const Bytes> stages, const RunFacts& facts);

/// Reads a shard. Throws FileError if it is not one, or if it was changed after it was written.
StoredShard read_shard(const std::string& path);

/// Merges the shards of a study into the states of its runs. Throws InputError, which names the files, if they are not
/// the shards of one study, each once, written by this version of the program.
std::vector<Bytes> merge_shards(std::vector<StoredShard>& shards);

}  // namespace poesy
