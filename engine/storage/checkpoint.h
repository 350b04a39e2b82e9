#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/bytes.h"
#include "engine/base/plain_file.h"

namespace poesy {

/// What a run must have in common with the checkpoint that it takes up (result/checkpoint_identity.h).
struct CheckpointIdentity {
  std::string poesy_version;  ///< exact: bytes of a state are for the program that wrote them
  std::string git_commit;     ///< of that program
  std::string model;          ///< its name
  std::uint64_t seed = 0;     ///< of the draws
  std::uint64_t samples = 0;  ///< that the study sets; a run may have more than its checkpoint
  std::string study;          ///< the resolved study without what may differ, and the mechanism's file
  std::string poses;          ///< SHA-256 of the poses, hexadecimal
  std::string shard = {};     ///< "2/5"; empty for the whole study

  bool operator==(const CheckpointIdentity&) const = default;  ///< Whether nothing differs.
};

/// Seconds that a run took.
struct RunTime {
  double wall = 0.0;         ///< of the whole run
  double checkpoints = 0.0;  ///< of these, for checkpoints
};

/// Where a state stands in its file.
struct StoredState {
  std::size_t offset = 0;                 ///< of its first block
  std::array<std::byte, 32> sha256 = {};  ///< of the state
};

/// An unfinished run.
struct Checkpoint {
  CheckpointIdentity identity;      ///< what a run that takes it up must have
  RunTime time;                     ///< that it took so far
  std::vector<Bytes> stages;        ///< states of its stages (engine/run/checkpoints.h)
  std::vector<StoredState> stored;  ///< the same states in the file
};

/// Throws InputError that names the first difference, unless a run of this identity may take up the checkpoint of that
/// file: nothing differs, or it asks for more samples.
void check_continues(const CheckpointIdentity& run, const CheckpointIdentity& checkpoint, const std::string& path);

/// Gives the bytes of a checkpoint file to `sink`, piece by piece and in one pass; where its states stand. In the
/// notation of engine/base/bytes.h:
///
///     16 bytes "poesy-checkpoint"
///     number   version of the format, 3
///     text     poesy_version, git_commit, model
///     number   seed, samples
///     text     study, poses, shard
///     real     seconds that the run took, and of these for checkpoints
///     number   stages, and each as blocks that follow each other, the last of which is empty
///     32 bytes SHA-256 of everything before
///
/// What a state consists of is for the program that wrote it alone: its version is part of the identity.
std::vector<StoredState> write_checkpoint(const CheckpointIdentity& identity, const RunTime& time,
                                          std::span<const ByteSource> stages, const ByteWriter::Sink& sink);

/// Whether the file begins as a checkpoint does. None where the disk fails, with the reason in errno. Precondition:
/// file.is_open().
std::optional<bool> begins_as_checkpoint(const PlainFile& file);

/// Reads a whole checkpoint file back. Throws BytesError for anything that write_checkpoint does not give.
Checkpoint decode_checkpoint(std::span<const std::byte> file);

/// A checkpoint that was found.
struct FoundCheckpoint {
  Checkpoint checkpoint;    ///< its content
  std::string path;         ///< the file that it was read from
  std::string passed_over;  ///< why the newer one could not be taken; empty when this is the newer one
};

/// What the name of the older checkpoint adds to that of the result; no file of a run adds more.
inline constexpr std::string_view kOlderEnd = ".part.1";

/// The checkpoints of an unfinished run beside its result: RESULT.h5.part, and the one before it as RESULT.h5.part.1.
/// Each has its own digest and comes into being whole: written under a temporary name (FileWriter) and synced; then the
/// newer one gets the older one's name as well, and the new one is renamed to take its place. Once there is a
/// RESULT.h5.part, it is there at any moment. Who may not read a result that is there may not read its checkpoints.
class CheckpointFiles {
 public:
  explicit CheckpointFiles(const std::string& result_path);  ///< Beside this result.

  const std::string& newer() const { return newer_; }  ///< Path of the newer one, RESULT.h5.part.
  const std::string& older() const { return older_; }  ///< Path of the one before, RESULT.h5.part.1.
  bool exist() const;                                  ///< Whether there is a file, sound or not.
  /// The newest one that is sound, if there is a file at all. Throws FileError when there is and none is sound.
  std::optional<FoundCheckpoint> find();
  /// Throws FileError; then the checkpoints that were there are there.
  void write(const CheckpointIdentity& identity, const RunTime& time, std::span<const ByteSource> stages);
  /// Writes the state of a stage as the checkpoint has it that was found or written last: bit by bit, also when
  /// somebody has removed the file. Throws FileError when it cannot be read or was changed. Precondition: there is such
  /// a stage.
  void write_state(std::size_t stage, ByteWriter& to);
  void remove();  ///< Removes all of them. Throws FileError.

 private:
  std::string result_;
  std::string newer_;
  std::string older_;
  bool newer_is_sound_ = false;      ///< only then it may replace the older one
  std::optional<PlainFile> held_;    ///< what was found or written last
  std::vector<StoredState> states_;  ///< of that
};

/// Keeps other runs from the same result, and so from its checkpoints, while it lives: an advisory lock on
/// RESULT.h5.lock, which goes with the process however that ends. Where the file system knows no locks there is none.
/// Who has it removes what killed runs left of the result and its checkpoints under temporary names.
class RunLock {
 public:
  /// result_path: where links end (check_output_path), so that a link and what it leads to are one result. Throws
  /// InputError when another run has the lock, FileError when something other than an empty plain file has its name,
  /// or it cannot be opened.
  explicit RunLock(const std::string& result_path);
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  ~RunLock();

 private:
  /// Whether the lock is had, or none is to be had; not when a run that ended has removed the file meanwhile.
  bool take(const std::string& result_path);
  void close();

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace poesy
