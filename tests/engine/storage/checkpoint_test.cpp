#include "engine/storage/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <fstream>

#include "engine/base/error.h"
#include "engine/result/checkpoint_identity.h"
#include "engine/storage/content_hash.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/kinds.h"
#include "tests/support/states.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

Bytes some_bytes(std::size_t count) { return Bytes(count, std::byte{7}); }

CheckpointIdentity identity() {
  return {.poesy_version = "1.2.3",
          .git_commit = "abc",
          .model = "fake",
          .seed = 5,
          .samples = 1000,
          .study = "[poses]\ncount = 3\n[errors]\n",
          .poses = "0123"};
}

Bytes encoded(std::span<const Bytes> stages, const RunTime& time = {2.5, 0.5}) {
  Bytes file;
  write_checkpoint(identity(), time, sources_of(stages),
                   [&](std::span<const std::byte> piece) { file.insert(file.end(), piece.begin(), piece.end()); });
  return file;
}

/// The content followed by its SHA-256 digest.
Bytes sealed(Bytes content) {
  Sha256 sha;
  sha.bytes(content);
  const Sha256::Digest digest = sha.digest();
  content.insert(content.end(), digest.begin(), digest.end());
  return content;
}

TEST(Checkpoint, ComesBack) {
  for (const std::vector<Bytes>& stages : {std::vector<Bytes>{},
                                           {some_bytes(300)},
                                           {some_bytes(3), {}, some_bytes(1)},
                                           {some_bytes(ByteWriter::kPiece), some_bytes(3 * ByteWriter::kPiece + 1)}}) {
    const Checkpoint checkpoint = decode_checkpoint(encoded(stages));
    EXPECT_EQ(checkpoint.identity, identity());
    EXPECT_EQ(checkpoint.time.wall, 2.5);
    EXPECT_EQ(checkpoint.time.checkpoints, 0.5);
    EXPECT_EQ(checkpoint.stages, stages);
  }
}

TEST(Checkpoint, DoesNotTellHowItsStatesWereWritten) {
  Bytes state;
  for (std::size_t k = 0; k < 5 * ByteWriter::kPiece / 2; ++k) state.push_back(static_cast<std::byte>(k % 251));
  const std::vector<ByteSource> in_bits{[&](ByteWriter& to) {
    for (std::size_t at = 0; at < state.size(); at += 7)
      to.raw(std::span(state).subspan(at).first(std::min<std::size_t>(7, state.size() - at)));
  }};
  Bytes file;
  write_checkpoint(identity(), {2.5, 0.5}, in_bits,
                   [&](std::span<const std::byte> piece) { file.insert(file.end(), piece.begin(), piece.end()); });
  EXPECT_TRUE(file == encoded(std::span(&state, 1)));
}

TEST(Checkpoint, BeginsWithItsName) {
  const Bytes file = encoded({});
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(file.data()), 16), "poesy-checkpoint");
}

TEST(Checkpoint, RefusesEveryTruncationAndEveryFlippedBit) {
  const std::vector<Bytes> stages{some_bytes(20), some_bytes(30)};
  const Bytes file = encoded(stages);
  for (std::size_t length = 0; length < file.size(); ++length) {
    EXPECT_THROW(decode_checkpoint(std::span(file).first(length)), BytesError);
  }
  for (std::size_t bit = 0; bit < 8 * file.size(); ++bit) {
    Bytes flipped = file;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    EXPECT_THROW(decode_checkpoint(flipped), BytesError);
  }
}

TEST(Checkpoint, RefusesContentThatDoesNotFitEvenWithItsDigest) {
  const std::vector<Bytes> stages{some_bytes(20)};
  const Bytes file = encoded(stages);
  const std::span content = std::span(file).first(file.size() - 32);
  EXPECT_NO_THROW(decode_checkpoint(sealed(Bytes(content.begin(), content.end()))));
  for (std::size_t length = 0; length < content.size(); ++length) {
    const auto cut = content.first(length);
    EXPECT_THROW(decode_checkpoint(sealed(Bytes(cut.begin(), cut.end()))), BytesError);
  }
  for (std::size_t at = 0; at < content.size(); ++at) {
    Bytes changed(content.begin(), content.end());
    changed[at] = std::byte{0xff};
    try {
      static_cast<void>(decode_checkpoint(sealed(std::move(changed))));
    } catch (const BytesError&) {
      // Refusing and decoding are both right, as long as nothing crashes.
    }
  }
}

TEST(Checkpoint, SaysThatItsFormatIsAnother) {
  const Bytes file = encoded({});
  for (const unsigned version : {1U, 2U, 4U}) {
    Bytes content(file.begin(), file.end() - 32);
    content[16] = std::byte(version);
    try {
      static_cast<void>(decode_checkpoint(sealed(std::move(content))));
      ADD_FAILURE();
    } catch (const BytesError& error) {
      const std::string expected = "version " + std::to_string(version) + ", and this program knows 3";
      EXPECT_NE(std::string(error.what()).find(expected), std::string::npos) << error.what();
    }
  }
}

TEST(CheckpointIdentity, MayAskForMoreSamplesAndForNothingElse) {
  CheckpointIdentity more = identity();
  more.samples = 2000;
  EXPECT_NO_THROW(check_continues(identity(), identity(), "f"));
  EXPECT_NO_THROW(check_continues(more, identity(), "f"));
  const auto refusal = [&](auto change, const CheckpointIdentity& from = identity()) {
    CheckpointIdentity other = from;
    change(other);
    try {
      check_continues(other, from, "f");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const auto expect_names = [](const std::string& message, const std::vector<std::string>& words) {
    for (const std::string& word : words) EXPECT_NE(message.find(word), std::string::npos) << message;
  };
  expect_names(refusal([](auto& other) { other.samples = 10; }), {"f: ", "1000", "10"});
  expect_names(refusal([](auto& other) { other.seed = 6; }), {"seed 5", "6"});
  expect_names(refusal([](auto& other) { other.poesy_version = "1.2.4"; }), {"1.2.3", "1.2.4"});
  expect_names(refusal([](auto& other) { other.git_commit = "abd"; }), {"abc", "abd"});
  expect_names(refusal([](auto& other) { other.model = "real"; }), {"fake", "real"});
  expect_names(refusal([](auto& other) { other.poses = "4567"; }), {"poses"});
  expect_names(refusal([](auto& other) { other.shard = "2/5"; }), {"the whole study", "shard 2/5"});
  expect_names(refusal([](auto& other) { other.study = "[poses]\ncount = 4\n[errors]\n"; }),
               {"'count = 3'", "'count = 4'"});
  expect_names(refusal([](auto& other) { other.study += "more"; }), {"nothing", "'more'"});
}

class Files : public testing::Test {
 protected:
  void write(CheckpointFiles& files, std::size_t state_bytes) {
    const std::vector<Bytes> stages{some_bytes(state_bytes)};
    files.write(identity(), {}, sources_of(stages));
  }
  static std::size_t state_bytes(const FoundCheckpoint& found) { return found.checkpoint.stages.at(0).size(); }

  TempFolder folder_;
  std::string result_ = folder_ / "r.h5";
  std::string newer_ = folder_ / "r.h5.part";
  std::string older_ = folder_ / "r.h5.part.1";
};

TEST(CheckpointIdentity, LeavesTheLimitOnFailuresOpen) {
  Example example;
  const CheckpointIdentity without = identity_of(example.study, example.poses.poses);
  example.study.max_not_converged = 0.01;
  EXPECT_EQ(identity_of(example.study, example.poses.poses), without);
  example.study.not_converged = NotConverged::include;
  EXPECT_FALSE(identity_of(example.study, example.poses.poses) == without);
}

TEST(CheckpointIdentity, LeavesLimitsOpenButNotTheirShare) {
  Example example;
  Analysis& analysis = example.study.analysis;
  analysis.kind = &monte_carlo::kStudy;
  const CheckpointIdentity without = identity_of(example.study, example.poses.poses);
  analysis.limits = {{0, 1e-3}};
  EXPECT_EQ(identity_of(example.study, example.poses.poses), without);
  asked_of<monte_carlo::Options>(analysis).judge = Judge::share;
  asked_of<monte_carlo::Options>(analysis).share = 0.99;
  const CheckpointIdentity at_99 = identity_of(example.study, example.poses.poses);
  EXPECT_FALSE(at_99 == without);
  analysis.limits = {{0, 2e-3}, {1, 1e-2}};
  EXPECT_EQ(identity_of(example.study, example.poses.poses), at_99);
  asked_of<monte_carlo::Options>(analysis).share = 0.95;
  EXPECT_FALSE(identity_of(example.study, example.poses.poses) == at_99);
}

TEST(CheckpointIdentity, HoldsTheSamplesThatAStudyDecidesBy) {
  for (const StudyKind* kind : study_kinds().all) {
    Example example;
    example.study.analysis.kind = kind;
    const CheckpointIdentity fewer = identity_of(example.study, example.poses.poses);
    ++example.study.analysis.samples;
    const CheckpointIdentity more = identity_of(example.study, example.poses.poses);
    EXPECT_EQ(more.study != fewer.study, kind == &allocation::kStudy) << kind->name;
  }
}

TEST_F(Files, KeepTwoGenerations) {
  CheckpointFiles files(result_);
  EXPECT_FALSE(files.exist());
  EXPECT_FALSE(files.find());
  for (const std::size_t size : {1U, 2U, 3U}) write(files, size);
  EXPECT_EQ(files_in(folder_.path()), 2U);
  const auto found = CheckpointFiles(result_).find();
  ASSERT_TRUE(found);
  EXPECT_EQ(state_bytes(*found), 3U);
  EXPECT_EQ(found->path, newer_);
  EXPECT_EQ(found->passed_over, "");
  std::filesystem::remove(newer_);
  EXPECT_EQ(state_bytes(*CheckpointFiles(result_).find()), 2U);
  files.remove();
  EXPECT_EQ(files_in(folder_.path()), 0U);
}

TEST_F(Files, ADamagedOneNeverReplacesASoundOne) {
  CheckpointFiles first(result_);
  for (const std::size_t size : {1U, 2U}) write(first, size);
  const std::string sound = read_bytes(older_);
  write_bytes(newer_, "rubbish");
  CheckpointFiles second(result_);
  const auto found = second.find();
  ASSERT_TRUE(found);
  EXPECT_EQ(state_bytes(*found), 1U);
  EXPECT_EQ(found->path, older_);
  EXPECT_NE(found->passed_over, "");
  write(second, 5);
  EXPECT_EQ(read_bytes(older_), sound);
  EXPECT_EQ(state_bytes(*CheckpointFiles(result_).find()), 5U);
}

TEST_F(Files, GiveTheStatesBackThatWereWrittenOrFoundLast) {
  const std::vector<Bytes> states{some_bytes(3 * ByteWriter::kPiece + 5), {}, some_bytes(7)};
  const auto given = [](CheckpointFiles& files, std::size_t stage) {
    return bytes_of([&](ByteWriter& to) { files.write_state(stage, to); });
  };
  CheckpointFiles files(result_);
  files.write(identity(), {}, sources_of(states));
  CheckpointFiles later(result_);
  ASSERT_TRUE(later.find());
  for (const std::size_t stage : {2U, 0U, 1U, 0U}) {
    EXPECT_TRUE(given(files, stage) == states[stage]) << stage;
    EXPECT_TRUE(given(later, stage) == states[stage]) << stage;
  }
  // The new file takes over a state from the old file that it replaces.
  const std::vector<ByteSource> taken_over{[&](ByteWriter& to) { files.write_state(0, to); },
                                           [](ByteWriter& to) { to.number(1); }};
  files.write(identity(), {}, taken_over);
  EXPECT_TRUE(CheckpointFiles(result_).find()->checkpoint.stages.at(0) == states[0]);
  std::filesystem::remove(newer_);
  EXPECT_TRUE(given(files, 0) == states[0]) << "removed";
}

TEST_F(Files, DoNotGiveAStateThatWasChanged) {
  CheckpointFiles files(result_);
  const std::vector<Bytes> states{some_bytes(1000)};
  const auto taken_over = std::vector<ByteSource>{[&](ByteWriter& to) { files.write_state(0, to); }};
  for (const bool cut : {false, true}) {
    files.write(identity(), {}, sources_of(states));
    const auto size = std::filesystem::file_size(newer_);
    std::fstream(newer_, std::ios::binary | std::ios::in | std::ios::out).seekp(static_cast<std::streamoff>(size) - 100)
        << 'x';
    if (cut) std::filesystem::resize_file(newer_, size - 100);
    const std::string before = read_bytes(newer_);
    EXPECT_THROW(files.write(identity(), {}, taken_over), FileError);
    EXPECT_EQ(read_bytes(newer_), before);
    EXPECT_LE(files_in(folder_.path()), 2U);
  }
}

TEST_F(Files, BothDamagedAreRefusedAndStay) {
  write_bytes(newer_, "rubbish");
  write_bytes(older_, "");
  CheckpointFiles files(result_);
  EXPECT_TRUE(files.exist());
  EXPECT_THROW(files.find(), FileError);
  EXPECT_EQ(read_bytes(newer_), "rubbish");
  EXPECT_EQ(read_bytes(older_), "");
}

TEST_F(Files, AFolderIsNoCheckpoint) {
  std::filesystem::create_directory(newer_);
  EXPECT_THROW(CheckpointFiles(result_).find(), FileError);
}

TEST_F(Files, WithoutRoomBothStayAsTheyWere) {
  CheckpointFiles files(result_);
  for (const std::size_t size : {1U, 2U}) write(files, size);
  const std::string newer = read_bytes(newer_);
  const std::string older = read_bytes(older_);
  struct rlimit before {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  const struct rlimit tight { 4096, before.rlim_max };
  setrlimit(RLIMIT_FSIZE, &tight);
  std::string message;
  try {
    write(files, 10000);
  } catch (const FileError& error) {
    message = error.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find(newer_), std::string::npos) << message;
  EXPECT_NE(message.find("File too large"), std::string::npos) << message;
  EXPECT_NE(message.find("raise the limit on file sizes to 10"), std::string::npos) << message;
  EXPECT_EQ(read_bytes(newer_), newer);
  EXPECT_EQ(read_bytes(older_), older);
  EXPECT_EQ(files_in(folder_.path()), 2U);
}

}  // namespace
}  // namespace poesy::test
