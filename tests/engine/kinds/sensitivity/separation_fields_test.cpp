#include <gtest/gtest.h>

#include <limits>

#include "engine/kinds/sensitivity/result.h"
#include "engine/result/result_file.h"
#include "engine/storage/h5.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::sensitivity {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The example's sensitivity result for a model that separates its errors. The values count up through all arrays.
class SeparationFile : public testing::Test {
 protected:
  SeparationFile() {
    catalog_[0].description.separation = {"how far the platform moves", {"compensable", "", "non-compensable"}};
    example_.study.mechanism.entry = &catalog_[0];
    example_.study.analysis.factors = {FactorIndex(2), FactorIndex(0)};
    double next = 0.0;
    SeparationResult& separation = result_.separation.emplace();
    for (auto* values : {&separation.drive, &separation.constraint, &separation.effect, &separation.residual,
                         &separation.removable_local}) {
      *values = SeparationResult::Cells({2, test::Example::kPoses});
      for (double& value : *values) value = next += 0.125;
    }
    separation.measure = "how far the platform moves";
    separation.removable_local(1, 3) = kNaN;
    separation.drive_share = {{2}, {0.25, 0.75}};
    separation.removable = {{2}, {0.125, 0.5}};
    separation.published = {{2}, std::vector<std::string>{"non-compensable", "compensable"}};
    separation.removable_together = 0.375;
    write_result(path_, example_.study, example_.poses, result_, example_.facts);
  }

  const Catalog fake_ = test::fake_catalog();
  Catalog catalog_ = fake_;
  test::TempFolder folder_;
  test::Example example_;
  Result result_ = example_.sensitivity();
  std::string path_ = folder_.file("separation.h5");
};

TEST_F(SeparationFile, IsReadBackAsItWas) {
  const StoredResult stored = read_result(path_);
  ASSERT_TRUE(sensitivity_of(stored).separation);
  const SeparationResult& found = *sensitivity_of(stored).separation;
  EXPECT_EQ(found.drive, result_.separation->drive);
  EXPECT_EQ(found.constraint, result_.separation->constraint);
  EXPECT_EQ(found.effect, result_.separation->effect);
  EXPECT_EQ(found.residual, result_.separation->residual);
  EXPECT_TRUE(std::equal(found.removable_local.begin(), found.removable_local.end() - 1,
                         result_.separation->removable_local.begin()));
  EXPECT_TRUE(std::isnan(found.removable_local(1, 3)));
  EXPECT_EQ(found.drive_share, result_.separation->drive_share);
  EXPECT_EQ(found.removable, result_.separation->removable);
  EXPECT_EQ(found.removable_together, 0.375);
  EXPECT_EQ(found.measure, "how far the platform moves");
  EXPECT_EQ(found.published, result_.separation->published);
  EXPECT_TRUE(verify_result(path_).matches());
}

TEST_F(SeparationFile, StandsBesideAxesAndUnits) {
  const h5::File file = h5::File::open(path_);
  EXPECT_EQ(file.shape("/separation/residual"), (h5::Shape{2, test::Example::kPoses}));
  EXPECT_EQ(file.shape("/separation/removable"), h5::Shape{2});
  EXPECT_EQ(file.shape("/separation/removable_together"), h5::Shape{});
  EXPECT_TRUE(file.exists("/separation/factor") && file.exists("/separation/pose"));
  EXPECT_EQ(file.attribute<std::string>("/separation/drive", "unit").front(), "SI: m / factor unit");
}

TEST_F(SeparationFile, IsExported) {
  export_tables(path_, folder_.file("tables"));
  EXPECT_EQ(test::read_bytes(folder_.file("tables/separation.csv")),
            "factor,drive_share,removable,published_non-compensable,published_compensable\n"
            "delta_2,0.25,0.125,1,0\n"
            "delta_1,0.75,0.5,0,1\n");
  EXPECT_EQ(test::read_bytes(folder_.file("tables/separation_together.csv")), "errors,removable\ntogether,0.375\n");
  EXPECT_EQ(test::read_bytes(folder_.file("tables/separation_drive.csv")),
            "factor,pose_0 [m per m],pose_1 [m per m],pose_2 [m per m],pose_3 [m per m]\n"
            "delta_2,0.125,0.25,0.375,0.5\n"
            "delta_1,0.625,0.75,0.875,1\n");
}

TEST_F(SeparationFile, ModelsThatDoNotSeparateHaveNone) {
  const test::Example plain;
  plain.write_sensitivity(path_);
  EXPECT_FALSE(h5::File::open(path_).exists("/separation"));
  EXPECT_FALSE(h5::File::open(path_).exists("/fidelity"));
  EXPECT_FALSE(sensitivity_of(read_result(path_)).separation);
}

}  // namespace
}  // namespace poesy::sensitivity
