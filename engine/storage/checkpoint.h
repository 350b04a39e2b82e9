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

/// What a run must have in common with the checkpoint that it continues (result/checkpoint_identity.h).
struct CheckpointIdentity {
  std::string poesy_version;  ///< exact version, because states are for the program that wrote them
  std::string git_commit;     ///< commit of that program
  std::string model;          ///< name of the mechanism
  std::uint64_t seed = 0;     ///< seed of the draws
  std::uint64_t samples = 0;  ///< samples in the study; a run may have more than its checkpoint
  std::string study;          ///< resolved study without what may differ, and the mechanism file
  std::string poses;          ///< SHA-256 of the poses, hexadecimal
  std::string shard = {};     ///< "2/5"; empty for the whole study

  bool operator==(const CheckpointIdentity&) const = default;  ///< Whether all members are equal.
};

/// The time of a run, s.
struct RunTime {
  double wall = 0.0;         ///< wall time of the whole run
  double checkpoints = 0.0;  ///< the part of it that checkpoints took
};

/// The place of a state in its file.
struct StoredState {
  std::size_t offset = 0;                 ///< position of its first block
  std::array<std::byte, 32> sha256 = {};  ///< hash of the state
};

/// The checkpoint of an unfinished run.
struct Checkpoint {
  CheckpointIdentity identity;      ///< identity of the run
  RunTime time;                     ///< time that the run took so far
  std::vector<Bytes> stages;        ///< states of its stages (engine/run/checkpoints.h)
  std::vector<StoredState> stored;  ///< places of these states in the file
};

/// Throws InputError, which names the first difference, unless a run of this identity may continue the checkpoint of
/// that file: nothing differs, or the run asks for more samples.
void check_continues(const CheckpointIdentity& run, const CheckpointIdentity& checkpoint, const std::string& path);

/// Writes a checkpoint file to `sink`, piece by piece and in one pass. Returns the places of its states. In the
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
/// The content of a state is known only to the version of the program that wrote it, which is part of the identity.
std::vector<StoredState> write_checkpoint(const CheckpointIdentity& identity, const RunTime& time,
                                          std::span<const ByteSource> stages, const ByteWriter::Sink& sink);

/// Whether the file begins like a checkpoint. None if reading fails, with the reason in errno. Precondition:
/// file.is_open().
std::optional<bool> begins_as_checkpoint(const PlainFile& file);

/// Reads a whole checkpoint file. Throws BytesError for content that write_checkpoint() does not write.
Checkpoint decode_checkpoint(std::span<const std::byte> file);

/// A checkpoint that was found.
struct FoundCheckpoint {
  Checkpoint checkpoint;    ///< its content
  std::string path;         ///< path of its file
  std::string passed_over;  ///< why the newer checkpoint was not used; empty if this is the newer one
};

/// The end of the older checkpoint's name, which follows that of the result. It is the longest end of a run's files.
inline constexpr std::string_view kOlderEnd = ".part.1";

/// The checkpoints of an unfinished run beside its result: RESULT.h5.part, and the one before it as RESULT.h5.part.1.
/// Each has its own digest. It is written under a temporary name (FileWriter) and synced; then the newer one also gets
/// the older one's name, and the new one is renamed to replace it. So once RESULT.h5.part exists, it exists at any
/// moment. Checkpoints have the permissions of an existing result.
class CheckpointFiles {
 public:
  explicit CheckpointFiles(const std::string& result_path);  ///< result_path: the path of the result.

  const std::string& newer() const { return newer_; }  ///< The path of the newer one, RESULT.h5.part.
  const std::string& older() const { return older_; }  ///< The path of the older one, RESULT.h5.part.1.
  bool exist() const;                                  ///< Whether there is a file, intact or not.
  /// The newest intact checkpoint; none if there is no file. Throws FileError if there are files but none is intact.
  std::optional<FoundCheckpoint> find();
  /// Writes a checkpoint. Throws FileError and then keeps the earlier checkpoints.
  void write(const CheckpointIdentity& identity, const RunTime& time, std::span<const ByteSource> stages);
  /// Writes the state of a stage from the checkpoint that was found or written last, with the same bits, even if its
  /// file was removed meanwhile. Throws FileError if it cannot be read or was changed. Precondition: the stage exists.
  void write_state(std::size_t stage, ByteWriter& to);
  void remove();  ///< Removes all checkpoints. Throws FileError.

 private:
  std::string result_;
  std::string newer_;
  std::string older_;
  bool newer_is_sound_ = false;      ///< the newer one replaces the older one only if it is intact
  std::optional<PlainFile> held_;    ///< the checkpoint that was found or written last
  std::vector<StoredState> states_;  ///< places of the states in it
};

/// Excludes other runs from the same result and its checkpoints while the object exists: an advisory lock on
/// RESULT.h5.lock, which ends with the process in any case. If the file system does not support locks, there is none.
/// The owner of the lock removes temporary files of killed runs.
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
  /// Whether the lock was obtained, or is not supported; false if a run that ended has removed the file meanwhile.
  bool take(const std::string& result_path);
  void close();

  std::string path_;
  int descriptor_ = -1;
};

}  // namespace poesy
