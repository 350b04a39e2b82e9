#include "engine/files/checkpoint.h"

#include <algorithm>
#include <cmath>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/files/sha256.h"
#include "engine/files/version.h"
#include "engine/study/study_file.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

constexpr std::uint64_t kVersion = 2;
constexpr std::size_t kDigestBytes = std::tuple_size_v<Sha256::Digest>;

std::string hash_of(const PoseSet& poses) {
  ByteWriter bytes;
  bytes.number(poses.size());
  for (std::size_t m = 0; m < poses.size(); ++m) bytes.reals(poses[PoseIndex(m)]);
  Sha256 sha;
  sha.bytes(bytes.take());
  return hex(sha.digest());
}

void write_identity(ByteWriter& to, const CheckpointIdentity& identity) {
  to.text(identity.poesy_version);
  to.text(identity.git_commit);
  to.text(identity.model);
  to.number(identity.seed);
  to.number(identity.samples);
  to.text(identity.study);
  to.text(identity.poses);
  to.text(identity.shard);
}

CheckpointIdentity read_identity(ByteReader& from) {
  CheckpointIdentity identity;
  identity.poesy_version = from.text();
  identity.git_commit = from.text();
  identity.model = from.text();
  identity.seed = from.number();
  identity.samples = from.number();
  identity.study = from.text();
  identity.poses = from.text();
  identity.shard = from.text();
  return identity;
}

double seconds(ByteReader& from) {
  const double value = from.real();
  if (std::isfinite(value) && value >= 0.0) return value;
  throw BytesError("has a time that is none");
}

constexpr std::string_view kStartAfresh = ", or move the checkpoint away to start afresh";

[[noreturn]] void refuse(const std::string& path, const std::string& problem, const std::string& remedy) {
  throw InputError({.file = path}, problem, remedy + std::string(kStartAfresh));
}

std::string program(const CheckpointIdentity& identity) {
  return "poesy " + printable(identity.poesy_version) + " (" + printable(identity.git_commit) + ")";
}

}  // namespace

CheckpointIdentity identity_of(const Study& study, const PoseSet& poses, const std::optional<Shard>& shard) {
  Study rest = study;
  rest.seed = 0;
  rest.title.clear();
  rest.max_not_converged = 1.0;  // judges the run when it is done
  rest.analysis.limits.clear();  // likewise
  rest.analysis.samples = 0;
  return {.poesy_version = poesy_version(),
          .git_commit = git_commit(),
          .model = study.model().name,
          .seed = study.seed,
          .samples = study.analysis.samples,
          .study = resolved_text(rest),
          .poses = hash_of(poses),
          .shard = shard ? to_string(*shard) : ""};
}

void check_continues(const CheckpointIdentity& run, const CheckpointIdentity& checkpoint, const std::string& path) {
  if (checkpoint.poesy_version != run.poesy_version || checkpoint.git_commit != run.git_commit) {
    refuse(path, "was written by " + program(checkpoint) + ", and this is " + program(run),
           "continue it with that version");
  }
  if (checkpoint.model != run.model) {
    refuse(path, "is of the mechanism " + printable(checkpoint.model) + ", and this study is of " + run.model,
           "give the study of that mechanism");
  }
  if (checkpoint.seed != run.seed) {
    refuse(path, "has seed " + std::to_string(checkpoint.seed) + ", and this run has " + std::to_string(run.seed),
           "give the same seed");
  }
  if (checkpoint.study != run.study) {
    const auto [there, here] = first_difference(checkpoint.study, run.study);
    refuse(path, "is of another study: it has " + there + " where this study has " + here, "give the study as it was");
  }
  if (checkpoint.poses != run.poses) {
    refuse(path, "is of other poses under the same name", "give the poses as they were");
  }
  if (checkpoint.shard != run.shard) {
    const auto part = [](const std::string& shard) {
      return shard.empty() ? "the whole study" : "shard " + printable(shard);
    };
    refuse(path, "is of " + part(checkpoint.shard) + ", and this run is of " + part(run.shard),
           "give the same --shard");
  }
  if (checkpoint.samples > run.samples) {
    refuse(path,
           "has " + std::to_string(checkpoint.samples) + " samples, and this study asks for " +
               std::to_string(run.samples),
           "ask for as many or more");
  }
}

CheckpointPieces::CheckpointPieces(const CheckpointIdentity& identity, const RunTime& time,
                                   std::span<const Bytes> stages)
    : stages_(stages) {
  ByteWriter head;
  head.raw(std::as_bytes(std::span(kCheckpointMagic)));
  head.number(kVersion);
  write_identity(head, identity);
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
  Sha256 sha;
  sha.bytes(content);
  if (!std::ranges::equal(sha.digest(), file.last(kDigestBytes))) {
    throw BytesError("is cut off or changed: its digest does not match");
  }
  ByteReader from(content.subspan(magic.size()));
  if (const std::uint64_t version = from.number(); version != kVersion) {
    throw BytesError("is of format version " + std::to_string(version) + ", and this program knows " +
                     std::to_string(kVersion));
  }
  Checkpoint checkpoint;
  checkpoint.identity = read_identity(from);
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

}  // namespace poesy
