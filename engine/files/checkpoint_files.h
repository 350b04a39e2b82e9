#pragma once

#include <optional>
#include <span>
#include <string>

#include "engine/files/checkpoint.h"

namespace poesy {

/// A checkpoint that was found.
struct FoundCheckpoint {
  Checkpoint checkpoint;    ///< its content
  std::string path;         ///< the file that it was read from
  std::string passed_over;  ///< why the newer one could not be taken; empty when this is the newer one
};

/// The checkpoints of an unfinished run beside its result: RESULT.h5.part, and the one before it as RESULT.h5.part.1.
/// Each has its own digest and comes into being whole: written as RESULT.h5.part.tmp and synced; then the newer one
/// gets the older one's name as well, and the new one is renamed to take its place. Once there is a RESULT.h5.part, it
/// is there at any moment.
class CheckpointFiles {
 public:
  /// Beside this result.
  explicit CheckpointFiles(const std::string& result_path);

  /// Path of the newer one, RESULT.h5.part.
  const std::string& newer() const { return newer_; }
  /// Whether there is a file, sound or not.
  bool exist() const;
  /// The newest one that is sound, if there is a file at all. Throws FileError when there is and none is sound.
  std::optional<FoundCheckpoint> find();
  /// Throws FileError; then the checkpoints that were there are there.
  void write(const CheckpointIdentity& identity, const RunTime& time, std::span<const Bytes> stages);
  /// Removes all of them. Throws FileError.
  void remove();

 private:
  std::string newer_;
  std::string older_;
  std::string temporary_;
  bool newer_is_sound_ = false;  ///< only then it may replace the older one
};

}  // namespace poesy
