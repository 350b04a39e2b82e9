#include "engine/storage/checkpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include "engine/base/contract.h"
#include "engine/base/error.h"
#include "engine/base/plain_file.h"
#include "engine/base/readable_line.h"
#include "engine/base/text.h"
#include "engine/storage/content_hash.h"
#include "engine/storage/file_writer.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "poesy-checkpoint";
constexpr std::uint64_t kVersion = 3;
constexpr const char* kNoCheckpoint = "is not a checkpoint of poesy";
constexpr std::size_t kDigestBytes = std::tuple_size_v<Sha256::Digest>;

bool begins_with_magic(std::span<const std::byte> bytes) {
  const auto magic = std::as_bytes(std::span(kMagic));
  return bytes.size() >= magic.size() && std::ranges::equal(bytes.first(magic.size()), magic);
}

/// Calls member() for each member of the identity, in the order of the checkpoint file.
template <class Identity, class Member>
void for_each_member(Identity& identity, const Member& member) {
  member(identity.poesy_version);
  member(identity.git_commit);
  member(identity.model);
  member(identity.seed);
  member(identity.samples);
  member(identity.study);
  member(identity.poses);
  member(identity.shard);
}

void put(ByteWriter& to, const std::string& value) { to.text(value); }
void put(ByteWriter& to, std::uint64_t value) { to.number(value); }
void take(ByteReader& from, std::string& value) { value = from.text(); }
void take(ByteReader& from, std::uint64_t& value) { value = from.number(); }

/// Writes the bytes of a source as a sequence of blocks. Returns the SHA-256 of these bytes.
Sha256::Digest put_blocks(ByteWriter& to, const ByteSource& source) {
  Sha256 sha;
  ByteWriter pieces([&](std::span<const std::byte> piece) {
    sha.bytes(piece);
    to.block(piece);
  });
  source(pieces);
  pieces.flush();
  to.block({});
  return sha.digest();
}

Bytes take_blocks(ByteReader& from) {
  Bytes all;
  ByteReader again = from;
  std::size_t size = 0;
  while (const std::size_t block = again.block().size()) size += block;
  all.reserve(size);
  for (;;) {
    const std::span<const std::byte> block = from.block();
    if (block.empty()) return all;
    all.insert(all.end(), block.begin(), block.end());
  }
}

/// Fills `to` with bytes of the file, from byte `at` on. Throws BytesError if the file is shorter.
void read_all(const PlainFile& file, std::uintmax_t at, std::span<std::byte> to) {
  if (!file.is_open() || file.read(at, to) != to.size()) throw BytesError("ends too early");
}

/// Reads the block that begins at byte `at` of the file, and moves `at` to the end of the block. A state ends with an
/// empty block. Throws BytesError.
void read_block(const PlainFile& file, std::uintmax_t& at, Bytes& block) {
  constexpr std::size_t kMostDigits = 10;
  constexpr std::byte kMore{0x80};
  block.clear();
  do {
    block.resize(block.size() + 1);
    read_all(file, at++, std::span(block).last(1));
  } while (block.size() < kMostDigits && (block.back() & kMore) != std::byte{0});
  block.resize(ByteReader(block).number_up_to(ByteWriter::kPiece));
  read_all(file, at, block);
  at += block.size();
}

double seconds(ByteReader& from) {
  const double value = from.real();
  if (std::isfinite(value) && value >= 0.0) return value;
  throw BytesError("has a time that is negative or no number");
}

std::string program(const CheckpointIdentity& identity) {
  return fmt::format("poesy {} ({})", printable(identity.poesy_version), printable(identity.git_commit));
}

/// A checkpoint, or the reason why it cannot be read.
std::variant<Checkpoint, std::string> read_checkpoint(const std::string& path) {
  const auto unreadable = [](int reason) { return "cannot be read (" + std::generic_category().message(reason) + ")"; };
  const PlainFile file(path);
  const bool nothing = file.other().empty() && file.error() == ENOENT;
  if (nothing || !file.other().empty()) return stands(path) ? "is not a plain file" : "does not exist";
  if (!file.is_open()) return unreadable(file.error());
  const auto is_one = begins_as_checkpoint(file);
  if (!is_one) return unreadable(errno);
  if (!*is_one) return kNoCheckpoint;
  const std::uintmax_t size = file.size();
  try {
    Bytes bytes(static_cast<std::size_t>(size));
    const auto read = file.read(0, bytes);
    if (!read) return unreadable(errno);
    bytes.resize(*read);
    return decode_checkpoint(bytes);
  } catch (const BytesError& error) {
    return error.what();
  } catch (const std::bad_alloc&) {
    return fmt::format("needs {} MB of memory to be read, and there is less", size / 1'000'000 + 1);
  }
}

}  // namespace

void check_continues(const CheckpointIdentity& run, const CheckpointIdentity& checkpoint, const std::string& path) {
  const auto check = [&](bool continues, const std::string& problem, const std::string& remedy) {
    if (!continues) throw InputError({.file = path}, problem, remedy + ", or move the checkpoint away to start afresh");
  };
  check(checkpoint.poesy_version == run.poesy_version && checkpoint.git_commit == run.git_commit,
        fmt::format("was written by {}, and this is {}", program(checkpoint), program(run)),
        "continue it with that version");
  check(checkpoint.model == run.model,
        fmt::format("is of the mechanism {}, and this study is of {}", printable(checkpoint.model), run.model),
        "give the study of that mechanism");
  check(checkpoint.seed == run.seed, fmt::format("has seed {}, and this run has {}", checkpoint.seed, run.seed),
        "give the same seed");
  const auto adaptive = [](const CheckpointIdentity& identity) {
    return identity.study.find("\nsamples.min = ") != std::string::npos;
  };
  check(adaptive(checkpoint) == adaptive(run),
        adaptive(run) ? "has a fixed number of samples, and this study takes as many as it needs"
                      : "takes as many samples as it needs, and this study a fixed number",
        "give the samples as they were");
  const auto [there, here] = with_readable_quantities(first_difference(checkpoint.study, run.study));
  check(checkpoint.study == run.study,
        fmt::format("is of another study: it has {} where this study has {}", there, here), "give the study as it was");
  check(checkpoint.poses == run.poses, "is of other poses under the same name", "give the poses as they were");
  const auto part = [](const std::string& shard) {
    return shard.empty() ? "the whole study" : "shard " + printable(shard);
  };
  check(checkpoint.shard == run.shard,
        fmt::format("is of {}, and this run is of {}", part(checkpoint.shard), part(run.shard)),
        "give the same --shard");
  check(checkpoint.samples <= run.samples,
        fmt::format("has {} samples, and this study asks for {}", checkpoint.samples, run.samples),
        "ask for as many or more");
}

std::vector<StoredState> write_checkpoint(const CheckpointIdentity& identity, const RunTime& time,
                                          std::span<const ByteSource> stages, const ByteWriter::Sink& sink) {
  Sha256 sha;
  std::size_t size = 0;
  ByteWriter to([&](std::span<const std::byte> piece) {
    sha.bytes(piece);
    sink(piece);
    size += piece.size();
  });
  to.raw(std::as_bytes(std::span(kMagic)));
  to.number(kVersion);
  for_each_member(identity, [&](const auto& value) { put(to, value); });
  to.real(time.wall);
  to.real(time.checkpoints);
  to.number(stages.size());
  std::vector<StoredState> stored;
  for (const ByteSource& stage : stages) {
    to.flush();
    const std::size_t offset = size;
    stored.push_back({offset, put_blocks(to, stage)});
  }
  to.flush();
  sink(sha.digest());
  return stored;
}

std::optional<bool> begins_as_checkpoint(const PlainFile& file) {
  std::array<std::byte, kMagic.size()> begin{};
  const auto bytes = file.read(0, begin);
  if (!bytes) return std::nullopt;
  return begins_with_magic(std::span(begin).first(*bytes));
}

Checkpoint decode_checkpoint(std::span<const std::byte> file) {
  if (file.size() < kMagic.size() + kDigestBytes || !begins_with_magic(file)) throw BytesError(kNoCheckpoint);
  const auto content = file.first(file.size() - kDigestBytes);
  if (!std::ranges::equal(sha256(content), file.last(kDigestBytes))) {
    throw BytesError("is cut off or changed: its digest does not match");
  }
  ByteReader from(content.subspan(kMagic.size()));
  if (const std::uint64_t version = from.number(); version != kVersion) {
    throw BytesError(fmt::format("is of format version {}, and this program knows {}", version, kVersion));
  }
  Checkpoint checkpoint;
  for_each_member(checkpoint.identity, [&](auto& value) { take(from, value); });
  checkpoint.time.wall = seconds(from);
  checkpoint.time.checkpoints = seconds(from);
  const std::size_t stages = from.count(1);
  for (std::size_t k = 0; k < stages; ++k) {
    const std::size_t offset = content.size() - from.left();
    checkpoint.stages.push_back(take_blocks(from));
    checkpoint.stored.push_back({offset, sha256(checkpoint.stages.back())});
  }
  from.expect_end();
  return checkpoint;
}

CheckpointFiles::CheckpointFiles(const std::string& result_path)
    : result_(result_path), newer_(result_path + ".part"), older_(result_path + std::string(kOlderEnd)) {}

std::vector<std::string> CheckpointFiles::existing() const {
  std::vector<std::string> paths{newer_, older_};
  std::erase_if(paths, [](const std::string& path) { return !stands(path); });
  return paths;
}

bool CheckpointFiles::exist() const { return !existing().empty(); }

std::optional<FoundCheckpoint> CheckpointFiles::find() {
  if (!exist()) return std::nullopt;
  auto newer = read_checkpoint(newer_);
  newer_is_sound_ = std::holds_alternative<Checkpoint>(newer);
  auto older = newer_is_sound_ ? decltype(newer)() : read_checkpoint(older_);
  if (!newer_is_sound_ && !std::holds_alternative<Checkpoint>(older)) {
    throw FileError(newer_, std::get<std::string>(newer) + ", and " + older_ + " " + std::get<std::string>(older),
                    "restore a copy, or move them away to start afresh");
  }
  FoundCheckpoint found =
      newer_is_sound_ ? FoundCheckpoint{std::get<Checkpoint>(std::move(newer)), newer_, ""}
                      : FoundCheckpoint{std::get<Checkpoint>(std::move(older)), older_, std::get<std::string>(newer)};
  held_.emplace(found.path);
  states_ = found.checkpoint.stored;
  return found;
}

void CheckpointFiles::write(const CheckpointIdentity& identity, const RunTime& time,
                            std::span<const ByteSource> stages) {
  FileWriter writer(newer_, result_);
  writer.expect([&] {
    std::size_t size = 0;
    write_checkpoint(identity, time, stages, [&](std::span<const std::byte> piece) { size += piece.size(); });
    return size;
  });
  auto states =
      write_checkpoint(identity, time, stages, [&](std::span<const std::byte> piece) { writer.write(piece); });
  writer.sync();
  if (newer_is_sound_) put_at_second_name(newer_, older_);
  writer.commit();
  newer_is_sound_ = true;
  held_.emplace(newer_);
  states_ = std::move(states);
}

void CheckpointFiles::write_state(std::size_t stage, ByteWriter& to) {
  POESY_EXPECTS(stage < states_.size());
  std::uintmax_t at = states_[stage].offset;
  Sha256 sha;
  try {
    Bytes block;
    for (read_block(*held_, at, block); !block.empty(); read_block(*held_, at, block)) {
      sha.bytes(block);
      to.raw(block);
    }
    if (sha.digest() != states_[stage].sha256) throw BytesError("was changed");
  } catch (const BytesError& error) {
    throw FileError(newer_, std::string(error.what()) + " while a run was using it", "check the disk");
  }
}

void CheckpointFiles::remove() {
  held_.reset();  // closes the file, which would otherwise still use disk space
  states_.clear();
  // The newer file is removed last, so that it remains if the removal is interrupted.
  for (const std::string* path : {&older_, &newer_}) {
    std::error_code error;
    fs::remove(*path, error);
    if (error) throw FileError(*path, "cannot be removed (" + error.message() + ")", "remove it by hand");
  }
  newer_is_sound_ = false;
}

RunLock::RunLock(const std::string& result_path) : path_(result_path + ".lock") {
  while (!take(result_path)) {
  }
  if (descriptor_ < 0) return;
  const CheckpointFiles checkpoints(result_path);
  for (const std::string& path : {result_path, checkpoints.newer(), checkpoints.older()}) remove_left_over(path);
}

bool RunLock::take(const std::string& result_path) {
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    const int reason = errno;
    // The lock file cannot be created. Writing the result into the same folder will fail too, and report the reason.
    if (!stands(path_)) return true;
    throw FileError(path_, "cannot be opened (" + std::generic_category().message(reason) + ")",
                    "remove it if no run is computing this result, or give another -o");
  }
  struct stat file {};
  if (::fstat(descriptor_, &file) != 0 || !S_ISREG(file.st_mode) || file.st_size > 0) {
    close();
    throw FileError(path_, "is not a lock of poesy, which is an empty file, and a run would remove it",
                    "move it away, or give another -o");
  }
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const bool taken = errno == EWOULDBLOCK;
    close();
    if (!taken) return true;
    throw InputError({.file = result_path}, "another run is computing this result",
                     "wait for it, or give each run its own -o");
  }
  // Another run may have removed the file between open() and flock(). A lock on a removed file excludes nobody.
  if (::fstat(descriptor_, &file) == 0 && file.st_nlink > 0) return true;
  close();
  return false;
}

void RunLock::close() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
}

RunLock::~RunLock() {
  if (descriptor_ >= 0) ::unlink(path_.c_str());
  close();
}

}  // namespace poesy
