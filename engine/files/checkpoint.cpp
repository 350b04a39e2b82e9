#include "engine/files/checkpoint.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>
#include <variant>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/files/content_hash.h"
#include "engine/files/file_writer.h"
#include "engine/files/version.h"
#include "engine/study/study_file.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kVersion = 2;
constexpr std::size_t kDigestBytes = std::tuple_size_v<Sha256::Digest>;

std::string hash_of(const PoseSet& poses) {
  ByteWriter bytes;
  bytes.number(poses.size());
  for (std::size_t m = 0; m < poses.size(); ++m) bytes.reals(poses[PoseIndex(m)]);
  return hex(sha256(bytes.take()));
}

/// The members in the order of the file.
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

double seconds(ByteReader& from) {
  const double value = from.real();
  if (std::isfinite(value) && value >= 0.0) return value;
  throw BytesError("has a time that is none");
}

std::string program(const CheckpointIdentity& identity) {
  return fmt::format("poesy {} ({})", printable(identity.poesy_version), printable(identity.git_commit));
}

/// A checkpoint, or why there is none to be had.
std::variant<Checkpoint, std::string> read_checkpoint(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return stands(path) ? "is not a plain file" : "does not exist";
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  Bytes bytes(file ? static_cast<std::size_t>(fs::file_size(path, ignored)) : 0);
  if (!file || !file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) {
    return "cannot be read (" + std::generic_category().message(errno) + ")";
  }
  try {
    return decode_checkpoint(bytes);
  } catch (const BytesError& error) {
    return error.what();
  }
}

}  // namespace

CheckpointIdentity identity_of(const Study& study, const PoseSet& poses, const std::optional<Shard>& shard) {
  Study rest = study;
  rest.seed = 0;
  rest.title.clear();
  rest.max_not_converged = 1.0;  // judges the run when it is done
  // Likewise, but that machines are counted under them.
  if (study.analysis.draws == Draws::per_pose) rest.analysis.limits.clear();
  if (!study.analysis.kind->decides_by_samples) rest.analysis.samples = 0;
  return {.poesy_version = poesy_version(),
          .git_commit = git_commit(),
          .model = study.model().name,
          .seed = study.seed,
          .samples = study.analysis.samples,
          .study = resolved_text(rest) + (study.mechanism.file ? study.mechanism.file->text : ""),
          .poses = hash_of(poses),
          .shard = shard ? to_string(*shard) : ""};
}

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
  const auto [there, here] = first_difference(checkpoint.study, run.study);
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

CheckpointPieces::CheckpointPieces(const CheckpointIdentity& identity, const RunTime& time,
                                   std::span<const Bytes> stages)
    : stages_(stages) {
  ByteWriter head;
  head.raw(std::as_bytes(std::span(kCheckpointMagic)));
  head.number(kVersion);
  for_each_member(identity, [&](const auto& value) { put(head, value); });
  head.real(time.wall);
  head.real(time.checkpoints);
  head.number(stages.size());
  head_ = head.take();
  for (const Bytes& stage : stages) {
    head.number(stage.size());
    lengths_.push_back(head.take());
  }
  Sha256 sha;
  for_each([&](std::span<const std::byte> piece) { sha.bytes(piece); });  // the digest is still empty
  const Sha256::Digest digest = sha.digest();
  digest_.assign(digest.begin(), digest.end());
}

std::size_t CheckpointPieces::size() const {
  std::size_t size = 0;
  for_each([&](std::span<const std::byte> piece) { size += piece.size(); });
  return size;
}

Checkpoint decode_checkpoint(std::span<const std::byte> file) {
  const auto magic = std::as_bytes(std::span(kCheckpointMagic));
  if (file.size() < magic.size() + kDigestBytes || !std::ranges::equal(file.first(magic.size()), magic)) {
    throw BytesError("is not a checkpoint of poesy");
  }
  const auto content = file.first(file.size() - kDigestBytes);
  if (!std::ranges::equal(sha256(content), file.last(kDigestBytes))) {
    throw BytesError("is cut off or changed: its digest does not match");
  }
  ByteReader from(content.subspan(magic.size()));
  if (const std::uint64_t version = from.number(); version != kVersion) {
    throw BytesError(fmt::format("is of format version {}, and this program knows {}", version, kVersion));
  }
  Checkpoint checkpoint;
  for_each_member(checkpoint.identity, [&](auto& value) { take(from, value); });
  checkpoint.time.wall = seconds(from);
  checkpoint.time.checkpoints = seconds(from);
  const std::size_t stages = from.count(1);
  for (std::size_t k = 0; k < stages; ++k) {
    const std::span<const std::byte> state = from.block();
    checkpoint.stages.emplace_back(state.begin(), state.end());
  }
  from.expect_end();
  return checkpoint;
}

CheckpointFiles::CheckpointFiles(const std::string& result_path)
    : result_(result_path), newer_(result_path + ".part"), older_(newer_ + ".1") {}

bool CheckpointFiles::exist() const { return stands(newer_) || stands(older_); }

std::optional<FoundCheckpoint> CheckpointFiles::find() {
  if (!exist()) return std::nullopt;
  auto newer = read_checkpoint(newer_);
  newer_is_sound_ = std::holds_alternative<Checkpoint>(newer);
  if (newer_is_sound_) return FoundCheckpoint{std::get<Checkpoint>(std::move(newer)), newer_, ""};
  auto older = read_checkpoint(older_);
  if (std::holds_alternative<Checkpoint>(older)) {
    return FoundCheckpoint{std::get<Checkpoint>(std::move(older)), older_, std::get<std::string>(newer)};
  }
  throw FileError(newer_, std::get<std::string>(newer) + ", and " + older_ + " " + std::get<std::string>(older),
                  "restore a copy, or move them away to start afresh");
}

void CheckpointFiles::write(const CheckpointIdentity& identity, const RunTime& time, std::span<const Bytes> stages) {
  const CheckpointPieces pieces(identity, time, stages);
  FileWriter writer(newer_, result_);
  writer.expect(pieces.size());
  pieces.for_each([&](std::span<const std::byte> piece) { writer.write(piece); });
  writer.sync();
  if (newer_is_sound_) put_at_second_name(newer_, older_);
  writer.commit();
  newer_is_sound_ = true;
}

void CheckpointFiles::remove() {
  // The newest last, so that what is left of a removal that was cut short is the newest.
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
  // A FIFO that somebody put there is opened at once, and refused.
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
  struct stat file {};
  const int looked = descriptor_ < 0 ? ::lstat(path_.c_str(), &file) : ::fstat(descriptor_, &file);
  if (looked == 0 && !S_ISREG(file.st_mode)) {
    close();
    throw FileError(path_, "is not a plain file, and a run keeps its lock in one", "remove it");
  }
  if (descriptor_ < 0) return true;
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    const bool taken = errno == EWOULDBLOCK;
    close();
    if (!taken) return true;
    throw InputError({.file = result_path}, "another run is computing this result",
                     "wait for it, or give each run its own -o");
  }
  // A run that ended in between has removed the file: a lock on that keeps nobody away.
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
