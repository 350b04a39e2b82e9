#include "engine/files/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>

#include "engine/base/error.h"
#include "engine/files/content_hash.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/kinds.h"
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
  const CheckpointPieces pieces(identity(), time, stages);
  pieces.for_each([&](std::span<const std::byte> piece) { file.insert(file.end(), piece.begin(), piece.end()); });
  EXPECT_EQ(file.size(), pieces.size());
  return file;
}

/// With a digest that matches.
Bytes sealed(Bytes content) {
  Sha256 sha;
  sha.bytes(content);
  const Sha256::Digest digest = sha.digest();
  content.insert(content.end(), digest.begin(), digest.end());
  return content;
}

TEST(Checkpoint, ComesBack) {
  for (const std::vector<Bytes>& stages :
       {std::vector<Bytes>{}, {some_bytes(300)}, {some_bytes(3), {}, some_bytes(1)}}) {
    const Checkpoint checkpoint = decode_checkpoint(encoded(stages));
    EXPECT_EQ(checkpoint.identity, identity());
    EXPECT_EQ(checkpoint.time.wall, 2.5);
    EXPECT_EQ(checkpoint.time.checkpoints, 0.5);
    EXPECT_EQ(checkpoint.stages, stages);
  }
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
      // Either is right, as long as it does not crash.
    }
  }
}

TEST(Checkpoint, SaysThatItsFormatIsAnother) {
  const Bytes file = encoded({});
  for (const unsigned version : {1U, 3U}) {
    Bytes content(file.begin(), file.end() - 32);
    content[16] = std::byte(version);
    try {
      static_cast<void>(decode_checkpoint(sealed(std::move(content))));
      ADD_FAILURE();
    } catch (const BytesError& error) {
      const std::string expected = "version " + std::to_string(version) + ", and this program knows 2";
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
    files.write(identity(), {}, stages);
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
  analysis.kind = &kMonteCarloStudy;
  const CheckpointIdentity without = identity_of(example.study, example.poses.poses);
  analysis.limits = {{0, 1e-3}};
  EXPECT_EQ(identity_of(example.study, example.poses.poses), without);
  asked_of<MonteCarloOptions>(analysis).judge = Judge::share;
  asked_of<MonteCarloOptions>(analysis).share = 0.99;
  const CheckpointIdentity at_99 = identity_of(example.study, example.poses.poses);
  EXPECT_FALSE(at_99 == without);
  analysis.limits = {{0, 2e-3}, {1, 1e-2}};
  EXPECT_EQ(identity_of(example.study, example.poses.poses), at_99);
  asked_of<MonteCarloOptions>(analysis).share = 0.95;
  EXPECT_FALSE(identity_of(example.study, example.poses.poses) == at_99);
}

TEST(CheckpointIdentity, HoldsTheSamplesThatAStudyDecidesBy) {
  for (const StudyKind* kind : study_kinds().all) {
    Example example;
    example.study.analysis.kind = kind;
    const CheckpointIdentity fewer = identity_of(example.study, example.poses.poses);
    ++example.study.analysis.samples;
    const CheckpointIdentity more = identity_of(example.study, example.poses.poses);
    EXPECT_EQ(more.study != fewer.study, kind == &kAllocationStudy) << kind->name;
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
  EXPECT_EQ(read_bytes(newer_), newer);
  EXPECT_EQ(read_bytes(older_), older);
  EXPECT_EQ(files_in(folder_.path()), 2U);
}

}  // namespace
}  // namespace poesy::test
