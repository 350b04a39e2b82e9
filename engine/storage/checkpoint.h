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

/// The properties of a run by which it is decided whether the run may continue a checkpoint (check_continues()).
struct CheckpointIdentity {
  std::string poesy_version;  ///< exact version of the program: no other version can read the states
  std::string git_commit;     ///< commit from which that program was built
  std::string model;          ///< name of the mechanism
  std::uint64_t seed = 0;     ///< seed of the draws
  std::uint64_t samples = 0;  ///< number of samples, the largest if adaptive; a run may have more
  std::string study;          ///< resolved study without the keys that may differ, then the mechanism file
  std::string poses;          ///< SHA-256 of the poses, hexadecimal
  std::string shard = {};     ///< shard, such as "2/5"; empty for the whole study

  bool operator==(const CheckpointIdentity&) const = default;  ///< Returns true if all members are equal.
};

/// The time that a run took, in seconds.
struct RunTime {
  double wall = 0.0;         ///< wall time of the run so far
  double checkpoints = 0.0;  ///< part of the wall time that checkpoints took
};

/// Where the state of a stage is in a checkpoint file.
struct StoredState {
  std::size_t offset = 0;                 ///< bytes in the file before the first block of the state
  std::array<std::byte, 32> sha256 = {};  ///< SHA-256 of the state
};

/// The content of a checkpoint of an unfinished run.
struct Checkpoint {
  CheckpointIdentity identity;      ///< identity of the run
  RunTime time;                     ///< time that the run took so far
  std::vector<Bytes> stages;        ///< states of the stages of the run (engine/run/checkpoints.h)
  std::vector<StoredState> stored;  ///< [stages] places of these states in the file
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
/// Only the version of the program that wrote a state can read it, so the identity contains this version.
std::vector<StoredState> write_checkpoint(const CheckpointIdentity& identity, const RunTime& time,
                                          std::span<const ByteSource> stages, const ByteWriter::Sink& sink);

/// Returns true if the file begins like a checkpoint. Returns none if the file cannot be read, with the reason in
/// errno. Precondition: file.is_open().
std::optional<bool> begins_as_checkpoint(const PlainFile& file);

/// Reads a whole checkpoint file. Throws BytesError if write_checkpoint() cannot have written the bytes.
Checkpoint decode_checkpoint(std::span<const std::byte> file);

/// A checkpoint that was found beside a result.
struct FoundCheckpoint {
  Checkpoint checkpoint;    ///< content of the file
  std::string path;         ///< path of the checkpoint file
  std::string passed_over;  ///< why the newer checkpoint was not used; empty if this is the newer checkpoint
};

/// The path of the older checkpoint is the path of the result plus this text. No file beside a result has a longer
/// ending, except temporary files.
inline constexpr std::string_view kOlderEnd = ".part.1";

/// The two checkpoints of an unfinished run, beside its result: the newer one is RESULT.h5.part, the older one
/// RESULT.h5.part.1. Each file contains a digest of its content. A new checkpoint is written under a temporary name
/// (FileWriter) and synced. RESULT.h5.part is then linked as RESULT.h5.part.1, and the new file is renamed to
/// RESULT.h5.part. So from the first checkpoint on, there is a RESULT.h5.part at any moment. If the result exists
/// already, checkpoints get its permissions.
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
  /// Reads the state of a stage from the checkpoint that was found or written last, and writes it to `to`. That file
  /// stays open, so this works even if it was removed meanwhile. Throws FileError if the file cannot be read or was
  /// changed. Precondition: the checkpoint has the stage.
  void write_state(std::size_t stage, ByteWriter& to);
  void remove();  ///< Removes all checkpoints. Throws FileError.

 private:
  std::string result_;
  std::string newer_;
  std::string older_;
  bool newer_is_sound_ = false;      ///< true if the newer checkpoint is intact, so that write() keeps it as older()
  std::optional<PlainFile> held_;    ///< open file of the checkpoint that was found or written last
  std::vector<StoredState> states_;  ///< places of the states in held_
};

/// While the object exists, no other run can work on the same result and its checkpoints. The object holds an advisory
/// lock on RESULT.h5.lock, which the system releases at the latest when the process ends. On a file system without
/// locks the object does nothing. The constructor also removes temporary files that killed runs left.
class RunLock {
 public:
  /// result_path: a path from check_output_path(), which follows symbolic links, so that a link and its target are one
  /// result. Throws InputError if another run has the lock. Throws FileError if there is something other than an empty
  /// plain file at RESULT.h5.lock, or if the file there cannot be opened.
  explicit RunLock(const std::string& result_path);
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;
  ~RunLock();

 private:
  /// Returns true if the lock was obtained, or if no lock is possible here. Returns false if another run removed the
  /// lock file meanwhile, so that the caller must try again.
  bool take(const std::string& result_path);
  void close();

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace poesy
