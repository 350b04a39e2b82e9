#include <gtest/gtest.h>

#include <random>

#include "engine/kinds/study_file.h"
#include "engine/study/table_file.h"
#include "tests/engine/study/valid_study.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

/// Reads damaged texts and counts how many are refused with an InputError. Other exceptions make the test fail.
template <class Read>
class Damage {
 public:
  explicit Damage(Read read) : read_(read) {}

  void try_text(std::string_view text) {
    try {
      read_(folder_.write("damaged", text));
    } catch (const InputError& error) {
      ++refused_;
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
    }
  }
  int refused() const { return refused_; }

 private:
  Read read_;
  test::TempFolder folder_;
  int refused_ = 0;
};

std::string with_changed_bytes(std::string_view text, std::mt19937_64& random) {
  std::string damaged(text);
  for (auto changes = 1 + random() % 4; changes > 0; --changes) {
    damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
  }
  return damaged;
}

TEST(DamagedStudy, IsAStudyOrAnInputErrorWhereverItIsCut) {
  const Catalog catalog = test::fake_catalog();
  Damage damage([&](const std::string& path) { read_study(path, catalog, StudyUse::run); });
  for (std::size_t length = 0; length < test::kValidStudy.size(); ++length) {
    damage.try_text(test::kValidStudy.substr(0, length));
  }
  EXPECT_GT(damage.refused(), 100);
}

TEST(DamagedStudy, IsAStudyOrAnInputErrorWhateverBytesChange) {
  const Catalog catalog = test::fake_catalog();
  Damage damage([&](const std::string& path) { read_study(path, catalog, StudyUse::run); });
  std::mt19937_64 random(20240607);
  for (int k = 0; k < 4000; ++k) damage.try_text(with_changed_bytes(test::kValidStudy, random));
  EXPECT_GT(damage.refused(), 1000);
}

TEST(DamagedStudy, MayNestAsDeepAsItsLinesAreLong) {
  const Catalog catalog = test::fake_catalog();
  std::string deep = "a";
  while (deep.size() < 16000) deep += ".a";
  Damage damage([&](const std::string& path) { read_study(path, catalog, StudyUse::run); });
  damage.try_text("[" + deep + "]\n" + deep + " = { " + deep.substr(0, 15001) + " = 1 }\n");
  damage.try_text(deep.substr(0, 15001) + " = { b." + deep.substr(0, 1001) + " = 1 }\n");
  damage.try_text("a = " + std::string(16000, '[') + "\n");
  damage.try_text("[" + deep + "]\n" + deep + " = 1\n");
  EXPECT_EQ(damage.refused(), 4);
}

TEST(DamagedTemplate, IsAStudyOrAnInputErrorWhateverBytesChange) {
  const Catalog catalog = test::fake_catalog();
  Damage damage([&](const std::string& path) {
    try {
      read_study(path, catalog, StudyUse::run);
    } catch (const FileError&) {
      // A damaged comment may have become a key that names a file, which does not exist.
    }
  });
  std::mt19937_64 random(20240608);
  for (const StudyKind* kind : study_kinds().all) {
    const std::string text = template_text(catalog[0], *kind);
    for (int k = 0; k < 500; ++k) damage.try_text(with_changed_bytes(text, random));
  }
  EXPECT_GT(damage.refused(), 100);
}

TEST(DamagedTable, IsATableOrAnInputErrorWhateverBytesChange) {
  const ModelDescription model = test::FakeModel::describe();
  const std::string_view text = "z,beta,gamma\n-0.2,0.1,0.3\n-0.25,1e-3,0\n";
  Damage damage([&](const std::string& path) { read_poses(path, model); });
  for (std::size_t length = 0; length < text.size(); ++length) damage.try_text(text.substr(0, length));
  std::mt19937_64 random(20240609);
  for (int k = 0; k < 2000; ++k) damage.try_text(with_changed_bytes(text, random));
  EXPECT_GT(damage.refused(), 1000);
}

TEST(DamagedTrajectory, GivesPosesOrAnInputErrorWhateverBytesChange) {
  const Catalog catalog = test::fake_catalog();
  const std::string_view text = "t,depth,sum,difference\n0,0.2,0.1,0\n0.5,0.25,0,0.1\n1,0.25,0,0.1\n2,0.2,0,0\n";
  const test::TempFolder folder;
  const std::string study = folder.write(
      "study.toml",
      "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\nselect = \"trajectory\"\n"
      "trajectory = { file = \"curve.csv\", points = 9 }\n");
  const test::FakeModel model;
  Damage damage([&](const std::string& path) {
    folder.write("curve.csv", test::read_bytes(path));
    const SelectedPoses poses = select_poses(read_study(study, catalog, StudyUse::run).poses, model);
    EXPECT_EQ(poses.time.size(), 9u);
  });
  for (std::size_t length = 0; length < text.size(); ++length) damage.try_text(text.substr(0, length));
  std::mt19937_64 random(20240610);
  for (int k = 0; k < 1000; ++k) damage.try_text(with_changed_bytes(text, random));
  EXPECT_GT(damage.refused(), 500);
}

}  // namespace
}  // namespace poesy
