#include "engine/study/bare_numbers.h"

#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

const test::FakeModel kModel;

std::string pose_text(std::string_view table) {
  const test::TempFolder folder;
  PoseSelection selection;
  selection.select = PoseSelection::Select::file;
  selection.from_file = read_poses(folder.write("p.csv", table), kModel.description());
  selection.place = {"p.csv", 2, 1};
  return outside_pose_text("p.csv", selection.from_file, select_poses(selection, kModel).poses, kModel.description());
}

/// The workspace has z from -0.3 m to -0.18 m and beta from -0.5 rad to 0.5 rad.
TEST(BareNumbers, OfPosesOutsideTheWorkspace) {
  EXPECT_EQ(
      pose_text("z,beta,gamma\n-0.2,0,0\n-250,0,0\n"),
      "p.csv: z has no unit, so its numbers are in m: pose 2 has z = -250 m, outside the workspace from -0.3 m to "
      "-0.18 m; if they are not, name their unit in the first line, e.g. 'z [mm]'");
  EXPECT_EQ(
      pose_text("z [mm],gamma,beta\n-200,0,0.1\n-200,0,-1.25\n"),
      "p.csv: beta has no unit, so its numbers are in rad: pose 2 has beta = -1.25 rad, outside the workspace from "
      "-0.5 rad to 0.5 rad; if they are not, name their unit in the first line, e.g. 'beta [deg]'");
  EXPECT_EQ(pose_text("z,beta,gamma\n-0.3,0.5,-0.6\n-0.18,-0.5,0.6\n"), "") << "the ends are inside";
}

TEST(BareNumbers, OfPosesWithUnits) {
  EXPECT_EQ(pose_text("z [mm],beta [deg],gamma [rad]\n-200,0,0\n-350,0,0\n"),
            "p.csv: pose 2 has z = -350 mm, outside the workspace from -300 mm to -180 mm; look at its sign and unit");
  EXPECT_EQ(pose_text("z [mm],beta [deg],gamma [rad]\n-200,20,0.1\n"), "");
}

TEST(BareNumbers, OfOtherCoordinatesOfPoses) {
  EXPECT_EQ(
      pose_text("depth,sum [rad],difference [rad]\n200,0,0\n"),
      "p.csv: depth has no unit, so its numbers are in m: pose 1 has z = -200 m, outside the workspace from -0.3 m "
      "to -0.18 m; if they are not, name their unit in the first line, e.g. 'depth [mm]'");
  EXPECT_EQ(pose_text("depth,sum,difference\n0.2,0,0\n"), "");
  EXPECT_EQ(pose_text("depth [mm],sum [rad],difference [rad]\n2000,0,0\n"),
            "p.csv: pose 1 has z = -2000 mm, outside the workspace from -300 mm to -180 mm; look at its sign and unit");
}

std::string study_text(std::string_view errors, std::string_view poses = "{ count = 3 }") {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = " + std::string(poses) +
         "\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per pose\"\n[errors]\n" + std::string(errors);
}

std::string error_text(std::string_view errors, std::string_view table) {
  const test::TempFolder folder;
  const Study study = study_of_text(study_text(errors), "study.toml", test::kFakeCatalog, StudyUse::run);
  const std::vector<std::string> doubts =
      error_table_doubts("e.csv", read_errors(folder.write("e.csv", table), kModel), study);
  EXPECT_LE(doubts.size(), 1u);
  return doubts.empty() ? "" : doubts.front();
}

TEST(BareNumbers, OfErrorsFarBeyondTheirSize) {
  const std::string uniform = "linear = { distribution = \"uniform\", half_width = \"0.05 mm\" }\n";
  EXPECT_EQ(
      error_text(uniform, "delta_1\n0.0004\n-0.0245\n"),
      "e.csv: delta_1 has no unit, so its numbers are in m: one is -24.5 mm, more than 10 times the size that the "
      "study gives this error (0.05 mm); if they are not, name their unit in the first line, e.g. 'delta_1 [mm]'");
  EXPECT_EQ(error_text(uniform, "epsilon_1,delta_1\n0.01,0.0005\n0.17,0\n"), "") << "ten times are not more";
  EXPECT_EQ(error_text(uniform, "delta_1 [m]\n-0.0245\n"), "");
  EXPECT_NE(error_text("", "part,delta_1 [mm],epsilon_1\na,1,0.18\n").find("e.csv: epsilon_1 has no unit"),
            std::string::npos)
      << "the default is 1 deg";
}

TEST(BareNumbers, OfValuesFarFromTheOthers) {
  const std::string others = "part,delta_1 [mm]\na,0.01\nb,-0.02\nc,0.01\nd,0.005\n";
  EXPECT_EQ(
      error_text("", others + "e,12.3\n"),
      "e.csv: delta_1 has 12.3 mm, more than 100 times its median 0.01 mm; is that meant, and in the column's unit?");
  EXPECT_EQ(error_text("", others + "e,0.9\n"), "");
}

TEST(BareNumbers, OfRowsThatSummariseOthers) {
  EXPECT_EQ(error_text("", "part,delta_1 [mm]\nT1,0.01\nT2,0.03\nMean,0.02\n"),
            "e.csv: the row Mean counts as one more part; is that meant? If not, delete it");
  EXPECT_EQ(error_text("", "part,delta_1 [mm]\nmeander,0.01\nsigma-2,0.03\n"), "");
  EXPECT_NE(error_text("", "part,delta_1 [mm]\nT1,0.01\nUSL,0.03\n"), "");
  EXPECT_EQ(error_text("", "name,delta_1 [mm]\nmax,0.01\nnominal,0.03\n"), "") << "cases of an evaluation";
}

/// The checked tables of a study are its file of poses and its measured values. Measured values are compared with the
/// other errors of their dimension.
TEST(BareNumbers, OfTheTablesOfAStudy) {
  const test::TempFolder folder;
  folder.write("p.csv", "z,beta,gamma\n-250,0,0\n");
  std::string parts = "hole,slot [mm]\n";
  for (int k = 1; k <= 9; ++k) parts += std::to_string(0.01 * k) + "," + std::to_string(0.01 * k) + "\n";
  folder.write("parts.csv", parts);
  const auto doubts = [&](const std::string& column) {
    const std::string text = study_text(
        "linear = { distribution = \"normal\", sigma = \"0.02 mm\" }\n"
        "override = { delta_2 = { distribution = \"measured\", file = \"parts.csv\", column = \"" +
            column + "\" } }\n",
        "{ select = \"file\", file = \"p.csv\" }");
    const Study study = read_study(folder.write("study.toml", text), test::kFakeCatalog, StudyUse::run);
    return doubts_of(study, select_poses(study.poses, kModel));
  };
  ASSERT_EQ(doubts("hole").size(), 2u);
  EXPECT_EQ(doubts("hole")[0],
            "parts.csv: hole has no unit, so its numbers are in m: one is 90 mm, more than 10 times the size of other "
            "linear errors (0.02 mm); if they are not, name their unit in the first line, e.g. 'hole [mm]'");
  EXPECT_EQ(doubts("hole")[1].find("p.csv: z has no unit"), 0u);
  ASSERT_EQ(doubts("slot").size(), 1u);
}

TEST(BareNumbers, OfATrajectory) {
  const test::TempFolder folder;
  folder.write("c.csv", "t,z,beta,gamma\n0,-0.25,0,0\n1,-250,0,0\n");
  const std::string text = study_text(
      "", "{ select = \"trajectory\", trajectory = { file = \"c.csv\", points = 3, time = [\"0 s\", \"1 s\"] } }");
  const Study study = read_study(folder.write("study.toml", text), test::kFakeCatalog, StudyUse::run);
  const std::vector<std::string> doubts = doubts_of(study, select_poses(study.poses, kModel));
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].find("c.csv: z has no unit, so its numbers are in m: pose 2 has z = -125.125 m"), 0u)
      << doubts[0];
}

TEST(DrawingText, IsTakenForHalfWidthsAndShares) {
  const auto read = [](const std::string& errors, const std::string& conf_level) {
    std::string text = study_text(errors);
    text.insert(text.find("[errors]"), "conf_level = " + conf_level + "\n");
    return study_of_text(text, "study.toml", test::kFakeCatalog, StudyUse::run);
  };
  for (const char* width : {"0.02 mm", "+-0.02 mm", "+- 0.02 mm", "+/-0.02 mm",
                            "\xC2\xB1"
                            "0.02 mm"}) {
    const Study study =
        read("linear = { distribution = \"uniform\", half_width = \"" + std::string(width) + "\" }\n", "\"99.73 %\"");
    EXPECT_EQ(study.errors.by_factor[0], Distribution::uniform(0.02 * 1e-3)) << width;
    EXPECT_EQ(study.analysis.conf_level, 0.9973);
  }
  EXPECT_THROW(read("linear = { distribution = \"uniform\", half_width = \"+--1 mm\" }\n", "0.95"), InputError);
  EXPECT_THROW(read("linear = { distribution = \"normal\", sigma = \"+-1 mm\" }\n", "0.95"), InputError);
  for (const char* share : {"\"95\"", "\"100 %\"", "\"0 %\"", "\"a %\"", "\"%\"", "95"}) {
    EXPECT_THROW(read("", share), InputError) << share;
  }
}

}  // namespace
}  // namespace poesy
