#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/tolerances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "engine/base/error.h"
#include "engine/kinds/study_file.h"
#include "engine/storage/h5.h"
#include "engine/study/study.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/engine/kinds/stored.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDegree = std::numbers::pi / 180.0;

/// Tolerance files of the example's sensitivity result. written(index) replaces its indices [responses x errors].
class ToleranceFiles : public testing::Test {
 protected:
  StoredResult written(const std::vector<double>& index) {
    sensitivity::Result found = example_.sensitivity();
    found.global = {{2, 2}, index};
    sensitivity::set_references(example_.study, found);
    write_result(path_, example_.study, example_.poses, found, example_.facts);
    return read_result(path_);
  }

  /// Tolerances for the first response. epsilon_1 has no effect, so its tolerance is infinite.
  static sensitivity::ResponseTolerances some(bool limit) {
    sensitivity::ResponseTolerances tolerances{
        0, {ReferenceError{1, 2e-3}, {kInfinity, 2e-3}, {0.0, 1.0}, {}}, std::nullopt};
    if (limit) tolerances.limit = LimitTolerances{1e-3, {0.25, 4e-3}, {0.25, 1e-5}};
    return tolerances;
  }

  Study read_back(const std::string& path) { return read_study(path, catalog_, StudyUse::run); }

  TempFolder folder_;
  std::string path_ = folder_ / "s.h5";
  Example example_;
  Catalog catalog_ = fake_catalog();
};

TEST_F(ToleranceFiles, ReferenceReadsBackAsChosenByTheStudy) {
  asked_of<sensitivity::Options>(example_.study.analysis).reference =
      sensitivity::ToleranceReference{FactorIndex(0), 3e-3};
  const StoredResult stored = written({1.0, 2.0, 3.0, 4.0});
  for (const std::size_t p : {0U, 1U}) EXPECT_EQ(sensitivity::sensitivity_of(stored).limb(p), 1U);
  for (const std::size_t r : {0U, 1U}) {
    const auto reference = sensitivity::sensitivity_of(stored).reference(r);
    ASSERT_TRUE(reference);
    EXPECT_EQ(reference->factor, 1U);  // delta_1 is the second varied error of the study
    EXPECT_EQ(reference->tolerance, 3e-3);
  }
}

TEST_F(ToleranceFiles, ReferenceIsTheSmallestEffectOrTheStudysOwn) {
  const StoredResult stored = written({1e-5, 2.0, 0.0, 0.0});  // times sigma: effects of 2.9e-6 and 2e-3
  EXPECT_EQ(sensitivity::sensitivity_of(stored).reference(0)->factor, 0U);
  EXPECT_EQ(sensitivity::sensitivity_of(stored).reference(0)->tolerance, kDegree);
  EXPECT_FALSE(sensitivity::sensitivity_of(stored).reference(1));
}

TEST_F(ToleranceFiles, ReferenceWithoutEffectLeavesTolerancesUnknown) {
  asked_of<sensitivity::Options>(example_.study.analysis).reference =
      sensitivity::ToleranceReference{FactorIndex(0), 3e-3};
  written({1.0, 0.0, 1.0, 2.0});
  const auto found = h5::File::open(path_).read<double>("/tolerances/equal_effect");
  EXPECT_TRUE(std::isnan(found[0]) && std::isnan(found[1]));
  EXPECT_EQ(found[2], 6e-3);
  EXPECT_EQ(found[3], 3e-3);
}

TEST_F(ToleranceFiles, ErrorWithoutEffectHasNoLimit) {
  written({0.0, 2.0, 1.0, 2.0});
  EXPECT_EQ(h5::File::open(path_).read<double>("/tolerances/equal_effect")[0], kInfinity);
}

TEST_F(ToleranceFiles, TableReadsWithoutKnowingTheProgram) {
  const StoredResult stored = written({0.0, 2.0, 1.0, 2.0});
  const std::string path = sensitivity::write_tolerances(folder_ / "new/folder", stored, some(true));
  EXPECT_EQ(path, folder_ / "new/folder/tolerances.csv");
  EXPECT_EQ(
      read_bytes(path),
      "factor,kind,limb,unit,display_unit,index_unit,studied_as,index,index_ci_low,index_ci_high,mean_square_share,"
      "index_change,limit_equal_effect,limit_equal_tolerance,equal_effect,"
      "limit_equal_effect_display,limit_equal_tolerance_display,equal_effect_display\n"
      "epsilon_1,angular,1,rad,deg,rad/rad,uniform,0,6000,7000,0,-0.25,0.25,0.25,inf," +
          shortest(0.25 / kDegree) + "," + shortest(0.25 / kDegree) +
          ",inf\n"
          "delta_1,linear,1,m,mm,rad/m,normal,2,6010,7010,1,0.125,0.004,1e-05,0.002,4,0.01,2\n");
}

TEST_F(ToleranceFiles, WithoutALimitTheTableHasNoColumnsForIt) {
  const StoredResult stored = written({0.0, 2.0, 1.0, 2.0});
  EXPECT_EQ(read_bytes(sensitivity::write_tolerances(folder_.path(), stored, some(false))).find("limit"),
            std::string::npos);
}

TEST_F(ToleranceFiles, ConfirmationVariesErrorsByTheirTolerances) {
  asked_of<sensitivity::Options>(example_.study.analysis).reference =
      sensitivity::ToleranceReference{FactorIndex(0), 3e-3};
  example_.study.analysis.background = Background{{FactorIndex(2)}, 1e-3, 0.0};
  example_.study.seed = 77;
  const auto paths =
      sensitivity::write_confirmation(folder_ / "out", written({0.0, 2.0, 1.0, 2.0}), some(true), catalog_).paths;
  ASSERT_EQ(paths, (std::vector<std::string>{folder_ / "out/confirm_equal_effect.toml",
                                             folder_ / "out/confirm_equal_tolerance.toml"}));
  const Study equal_effect = read_back(paths[0]);
  EXPECT_EQ(equal_effect.analysis.kind, &monte_carlo::kStudy);
  EXPECT_EQ(equal_effect.analysis.factors, example_.study.analysis.factors);
  EXPECT_EQ(equal_effect.analysis.samples, example_.study.analysis.samples);
  EXPECT_EQ(equal_effect.analysis.background->linear, 1e-3);
  EXPECT_EQ(equal_effect.poses.count, example_.study.poses.count);
  EXPECT_EQ(equal_effect.seed, 77U);
  EXPECT_EQ(equal_effect.errors.by_factor[0].shape(), Distribution::Shape::normal);
  EXPECT_EQ(equal_effect.errors.by_factor[0].sigma(), 4e-3);
  EXPECT_EQ(equal_effect.errors.by_factor[1].sigma(), 0.25);
  EXPECT_EQ(equal_effect.errors.by_factor[2].sigma(), 1e-3) << "not varied: as it was";
  const Study equal_tolerance = read_back(paths[1]);
  EXPECT_EQ(equal_tolerance.errors.by_factor[0].sigma(), 1e-5);
  EXPECT_EQ(equal_tolerance.errors.by_factor[1].shape(), Distribution::Shape::normal);
  EXPECT_EQ(equal_tolerance.errors.by_factor[1].sigma(), 0.25);
}

TEST_F(ToleranceFiles, StudiesBeginWithTheCaveat) {
  sensitivity::ResponseTolerances tolerances = some(true);
  tolerances.caveat = "they may not hold";
  for (const std::string& path :
       sensitivity::write_confirmation(folder_ / "out", written({0.0, 2.0, 1.0, 2.0}), tolerances, catalog_).paths) {
    EXPECT_TRUE(read_bytes(path).starts_with("# they may not hold\n"));
    read_back(path);
  }
}

TEST_F(ToleranceFiles, ConfirmationTakesThePosesOfAFileAlong) {
  example_.study.poses = {};
  example_.study.poses.select = PoseSelection::Select::file;
  example_.study.poses.file = "gone/poses.csv";
  const auto paths =
      sensitivity::write_confirmation(folder_ / "out", written({0.0, 2.0, 1.0, 2.0}), some(true), catalog_).paths;
  const PoseSet found = read_back(paths[0]).poses.from_file.points;
  ASSERT_EQ(found.size(), example_.poses.poses.size());
  for (std::size_t c = 0; c < found.coordinates(); ++c) EXPECT_EQ(found.column(c), example_.poses.poses.column(c));
}

TEST_F(ToleranceFiles, ConfirmationTakesATrajectorysPosesAlong) {
  example_.study.poses = {};
  example_.study.poses.select = PoseSelection::Select::trajectory;
  example_.study.poses.trajectory.emplace().file = "gone/curve.csv";
  const auto paths =
      sensitivity::write_confirmation(folder_ / "out", written({0.0, 2.0, 1.0, 2.0}), some(true), catalog_).paths;
  const Study study = read_back(paths[0]);
  EXPECT_EQ(study.poses.select, PoseSelection::Select::file);
  EXPECT_EQ(study.poses.from_file.points.size(), example_.poses.poses.size());
}

TEST_F(ToleranceFiles, StudiesClaimNothingBeforeTheyAreRun) {
  const auto paths =
      sensitivity::write_confirmation(folder_ / "out", written({0.0, 2.0, 1.0, 2.0}), some(true), catalog_).paths;
  EXPECT_EQ(read_back(paths[0]).title,
            "Tests tolerances of equal effect against a limit of 0.0572957795131 deg on the root mean square of "
            "angular_deformation");
  EXPECT_TRUE(read_back(paths[1]).title.starts_with("Tests equal tolerances against a limit of "));
}

TEST_F(ToleranceFiles, StudiesCarryTheLimitThatJudgesThem) {
  for (const std::string& path :
       sensitivity::write_confirmation(folder_ / "out", written({0.0, 2.0, 1.0, 2.0}), some(true), catalog_).paths) {
    const Analysis analysis = read_back(path).analysis;
    ASSERT_EQ(analysis.limits.size(), 1U);
    EXPECT_EQ(analysis.limits[0].response, 0U);
    EXPECT_EQ(analysis.limits[0].allowed.to(), 1e-3);
    EXPECT_EQ(asked_of<monte_carlo::Options>(analysis).judge, Judge::rms);
  }
}

TEST_F(ToleranceFiles, ClaimWhatIsWrittenAndNoMore) {
  example_.study.poses = {};
  example_.study.poses.select = PoseSelection::Select::file;
  example_.study.poses.file = "gone/poses.csv";
  const StoredResult stored = written({0.0, 2.0, 1.0, 2.0});
  for (const bool limit : {false, true}) {
    const std::string out = folder_ / (limit ? "with" : "without");
    OutputFolder output(out, stored.content_sha256);
    sensitivity::claim_tolerance_files(output, stored, some(limit), catalog_);
    output.fill([&] {
      if (limit) sensitivity::write_confirmation(out, stored, some(limit), catalog_);
      sensitivity::write_tolerances(out, stored, some(limit));
    });
    const std::string list = read_bytes(output.file(kManifest));
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(out)) {
      const std::string name = entry.path().filename().string();
      if (name == kManifest) continue;
      ++files;
      EXPECT_NE(list.find("\n" + name + "\n"), std::string::npos) << name;
    }
    EXPECT_EQ(files, limit ? 4U : 1U);
    EXPECT_EQ(std::ranges::count(list, '\n'), static_cast<std::ptrdiff_t>(files + 2));
  }
}

TEST_F(ToleranceFiles, ExportHasTheSameRows) {
  written({0.0, 2.0, 1.0, 2.0});
  export_tables(path_, folder_.path());
  EXPECT_EQ(read_bytes(folder_ / "tolerances_angular_deformation.csv"),
            "factor,angular,limb,index [rad per rad or m],index_ci_low [rad per rad or m],"
            "index_ci_high [rad per rad or m],mean_square_share,index_change,equal_effect [rad or m],"
            "equal_effect [deg or mm]\n"
            "epsilon_1,1,1,0,6000,7000,0,-0.25,inf,inf\n"
            "delta_1,0,1,2,6010,7010,1,0.125,0.001,1\n");
}

}  // namespace
}  // namespace poesy::test
