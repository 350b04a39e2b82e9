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

/// The facts in which a run and the checkpoint that it continues must agree (result/checkpoint_identity.h).
struct CheckpointIdentity {
  std::string poesy_version;  ///< exact version, because only the program that wrote a state can read it
  std::string git_commit;     ///< commit of that program
  std::string model;          ///< name of the mechanism
  std::uint64_t seed = 0;     ///< seed of the draws
  std::uint64_t samples = 0;  ///< samples in the study; a run may have more than its checkpoint
  std::string study;       ///< text of the resolved study, without the keys that may differ, and of the mechanism file
  std::string poses;       ///< SHA-256 of the poses, hexadecimal
  std::string shard = {};  ///< shard, such as "2/5"; empty for the whole study

  bool operator==(const CheckpointIdentity&) const = default;  ///< Returns true if all members are equal.
};

/// The time that a run took, in seconds.
struct RunTime {
  double wall = 0.0;         ///< wall time of the run so far
  double checkpoints = 0.0;  ///< part of the wall time that checkpoints took
};

/// The place of a state in a checkpoint file.
struct StoredState {
  std::size_t offset = 0;                 ///< number of bytes in the file before its first block
  std::array<std::byte, 32> sha256 = {};  ///< SHA-256 of the state
};

/// The content of a checkpoint of an unfinished run.
struct Checkpoint {
  CheckpointIdentity identity;      ///< identity of the run
  RunTime time;                     ///< time that the run took so far
  std::vector<Bytes> stages;        ///< states of its stages (engine/run/checkpoints.h)
  std::vector<StoredState> stored;  ///< places of these states in the file
};

/// Throws InputError, which names the first difference, unless a run with the identity `run` may continue the
/// checkpoint in the file at `path`. The run may continue it if the identities are equal, or differ only because the
/// run asks for more samples.
void check_continues(const CheckpointIdentity& run, const CheckpointIdentity& checkpoint, const std::string& path);

/// Writes a checkpoint file to `sink`, piece by piece and in one pass. Returns where in the file the state of each
/// stage is. The file consists of the following entries, encoded as in engine/base/bytes.h:
///
///     16 bytes "poesy-checkpoint"
///     number   version of the format, 3
///     text     poesy_version, git_commit, model
///     number   seed, samples
///     text     study, poses, shard
///     real     seconds that the run took so far; how many of them were spent on checkpoints
///     number   how many stages there are; then the state of each stage, as blocks of which the last one is empty
///     32 bytes SHA-256 of all bytes before it
///
/// A state can be read only by the version of the program that wrote it, so the identity names this version.
std::vector<StoredState> write_checkpoint(const CheckpointIdentity& identity, const RunTime& time,
                                          std::span<const ByteSource> stages, const ByteWriter::Sink& sink);

/// Returns true if the file begins like a checkpoint. Returns none if the file cannot be read, with the reason in
/// errno. Precondition: file.is_open().
std::optional<bool> begins_as_checkpoint(const PlainFile& file);

/// Reads a whole checkpoint file. Throws BytesError for content that write_checkpoint() does not write.
Checkpoint decode_checkpoint(std::span<const std::byte> file);

/// A checkpoint that was found beside a result.
struct FoundCheckpoint {
  Checkpoint checkpoint;    ///< content of the file
  std::string path;         ///< path of the checkpoint file
  std::string passed_over;  ///< why the newer checkpoint was not used; empty if this is the newer checkpoint
};

/// The text that is added to the path of a result to get that of the older checkpoint. No file of a run has a longer
/// end.
inline constexpr std::string_view kOlderEnd = ".part.1";

/// The two checkpoints of an unfinished run, beside its result: the newer one is RESULT.h5.part, the older one
/// RESULT.h5.part.1. Each has its own digest. A new checkpoint is written under a temporary name (FileWriter) and
/// synced. RESULT.h5.part is then linked as RESULT.h5.part.1, and the new file is renamed to RESULT.h5.part. So from
/// the first checkpoint on, there is a RESULT.h5.part at any moment. Checkpoints have the permissions of an existing
/// result.
class CheckpointFiles {
 public:
  explicit CheckpointFiles(const std::string& result_path);  ///< result_path: the path of the result.

  const std::string& newer() const { return newer_; }  ///< The path of the newer checkpoint, RESULT.h5.part.
  const std::string& older() const { return older_; }  ///< The path of the older checkpoint, RESULT.h5.part.1.
  /// The paths of the checkpoint files that exist, the newer one first.
  std::vector<std::string> existing() const;
  bool exist() const;  ///< Returns true if there is a checkpoint file, intact or not.
  /// The newest intact checkpoint; none if there is no file. Throws FileError if there are files but none is intact.
  std::optional<FoundCheckpoint> find();
  /// Writes a checkpoint. If it throws FileError, the earlier checkpoints are kept.
  void write(const CheckpointIdentity& identity, const RunTime& time, std::span<const ByteSource> stages);
  /// Writes to `to` the state of a stage from the checkpoint that was found or written last. The bits are the same,
  /// even if the checkpoint's file was removed meanwhile. Throws FileError if the file cannot be read or was changed.
  /// Precondition: the stage exists.
  void write_state(std::size_t stage, ByteWriter& to);
  void remove();  ///< Removes all checkpoints. Throws FileError.

 private:
  std::string result_;
  std::string newer_;
  std::string older_;
  bool newer_is_sound_ = false;      ///< true if the newer checkpoint is intact; only then it replaces the older one
  std::optional<PlainFile> held_;    ///< open file of the checkpoint that was found or written last
  std::vector<StoredState> states_;  ///< places of the states in held_
};

/// Keeps other runs away from the same result and its checkpoints while the object exists. It is an advisory lock on
/// RESULT.h5.lock, which the system releases at the latest when the process ends. On a file system without locks it
/// does nothing. The owner of the lock removes temporary files of killed runs.
class RunLock {
 public:
  /// result_path: the target of symbolic links (check_output_path), so that a link and its target are one result.
  /// Throws InputError if another run has the lock. Throws FileError if the name belongs to something other than an
  /// empty plain file, or the file cannot be opened.
  explicit RunLock(const std::string& result_path);
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  ~RunLock();

 private:
  /// Returns true if the lock was obtained, or if locks are not supported. Returns false if another run removed the
  /// lock file meanwhile.
  bool take(const std::string& result_path);
  void close();

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace poesy
