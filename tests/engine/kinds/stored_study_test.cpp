#include "engine/kinds/study_file.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

class StoredStudyOf : public testing::Test {
 protected:
  StoredResult written() {
    example_.write_sensitivity(path_);
    return read_result(path_);
  }

  test::TempFolder folder_;
  test::Example example_;
  std::string path_ = folder_.file("s.h5");
};

TEST_F(StoredStudyOf, AResultIsTheStudyAtItsPoses) {
  const StoredResult result = written();
  const StoredStudy stored = stored_study(result, path_, test::kFakeCatalog);
  EXPECT_EQ(resolved_text(stored.study), result.study_text);
  ASSERT_EQ(stored.poses.poses.size(), test::Example::kPoses);
  EXPECT_EQ(stored.poses.poses.column(1), example_.poses.poses.column(1));
  EXPECT_EQ(stored.poses.condition, example_.poses.condition);
}

TEST_F(StoredStudyOf, AFileOfPosesThatIsGoneIsNotMissed) {
  example_.study.poses.select = PoseSelection::Select::file;
  example_.study.poses.file = "gone.csv";
  const StoredStudy stored = stored_study(written(), path_, test::kFakeCatalog);
  EXPECT_EQ(stored.study.poses.file, "gone.csv");
  EXPECT_EQ(stored.poses.poses.size(), test::Example::kPoses);
}

TEST_F(StoredStudyOf, AnotherProgramIsAFileError) {
  StoredResult result = written();
  EXPECT_THROW(stored_study(result, path_, {}), FileError);
  result.study_text += "\n[unheard-of]\n";
  EXPECT_THROW(stored_study(result, path_, test::kFakeCatalog), FileError);
  result = read_result(path_);
  result.poses = PoseSet(2, {0.0, 0.0});
  EXPECT_THROW(stored_study(result, path_, test::kFakeCatalog), FileError);
}

}  // namespace
}  // namespace poesy
