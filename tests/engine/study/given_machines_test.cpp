#include <gtest/gtest.h>

#include <vector>

#include "engine/kinds/study_file.h"
#include "engine/study/plan.h"
#include "engine/study/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

constexpr std::string_view kMachines = "kind = \"monte-carlo\"\ndraws = \"per machine\"\n";
constexpr std::string_view kRows = "delta_2 [mm],delta_1,operator\n3,0.001,Ann\n1,0.002,Bo\n2,0.002,Cy\n";

std::string study_text(const std::string& errors, std::string_view analysis = kMachines) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 2 }\n[errors]\n" +
         errors + "[analysis]\n" + std::string(analysis);
}

class GivenMachines : public ::testing::Test {
 protected:
  Study read(const std::string& text, std::string_view rows = kRows) {
    folder_.write("parts.csv", std::string(rows));
    return study_of_text(text, folder_.write("study.toml", text), test::kFakeCatalog, StudyUse::run);
  }
  void expect_refused(const std::string& marked, const std::vector<std::string>& words) {
    const test::Marked text(marked);
    const std::string path = folder_.write("study.toml", text.text);
    folder_.write("parts.csv", std::string(kRows));
    test::expect_input_error([&] { study_of_text(text.text, path, test::kFakeCatalog, StudyUse::run); },
                             {path, text.line, text.column}, words);
  }
  /// Expects that a table of machines with a mistake at '^' is refused with these words.
  void expect_wrong_table(const std::string& marked, const std::vector<std::string>& words) {
    const test::Marked rows(marked);
    const std::string path = folder_.write("parts.csv", rows.text);
    test::expect_input_error([&] { read(study_text("machines = \"parts.csv\"\n"), rows.text); },
                             {path, rows.line, rows.column}, words);
  }

  test::TempFolder folder_;
};

TEST_F(GivenMachines, AreTheRowsOfTheFile) {
  const Study study = read(study_text("machines = \"parts.csv\"\n"));
  ASSERT_TRUE(study.errors.machines.has_value());
  EXPECT_EQ(study.errors.machines->factors, (std::vector{FactorIndex(2), FactorIndex(0)}));
  EXPECT_EQ(study.analysis.samples, 3U);
  EXPECT_EQ(study.errors.by_factor[1].shape(), Distribution::Shape::normal);
  const Plan plan(study, PoseSet(3, {-0.2, 0, 0, -0.3, 0, 0}));
  for (const std::size_t pose : {0U, 1U}) {
    std::vector<double> values(9);
    for (std::size_t p = 0; p < 3; ++p) {
      plan.draw_uniforms(p, PoseIndex(pose), SampleIndex(0), std::span(values).subspan(3 * p, 3));
    }
    plan.transform(values, 3);
    EXPECT_EQ(std::vector(values.begin(), values.begin() + 3), (std::vector{0.001, 0.002, 0.002}));
    EXPECT_EQ(std::vector(values.begin() + 6, values.end()), (std::vector{3e-3, 1e-3, 2e-3}));
  }
}

TEST_F(GivenMachines, StandInTheResolvedStudyWithoutTheFile) {
  const Study study =
      read(study_text("machines = \"parts.csv\"\noverride = { epsilon_1 = { distribution = \"uniform\", "
                      "half_width = \"1 deg\" } }\n"));
  EXPECT_EQ(study.errors.by_factor[1].shape(), Distribution::Shape::uniform);
  const std::string text = resolved_text(study);
  EXPECT_EQ(text.find("parts.csv"), std::string::npos) << text;
  const Study again = study_of_text(text, "again.toml", test::kFakeCatalog, StudyUse::run);
  EXPECT_EQ(again.errors.by_factor, study.errors.by_factor);
  EXPECT_EQ(again.errors.machines->values, study.errors.machines->values);
  EXPECT_EQ(resolved_text(again), text);
}

TEST_F(GivenMachines, AreAskedAboutBareNumbersFarBeyondTheSize) {
  const Study study =
      read(study_text("machines = \"parts.csv\"\nlinear = { distribution = \"normal\", sigma = \"1 um\" }\n"));
  ASSERT_EQ(study.doubts.size(), 1U);
  EXPECT_NE(study.doubts[0].find("delta_1 has no unit"), std::string::npos) << study.doubts[0];
}

TEST_F(GivenMachines, AreRefusedWhereTheyMakeNoSense) {
  const std::string file = "machines = ^\"parts.csv\"\n";
  const std::string plain = "machines = \"parts.csv\"\n";
  for (const std::string_view analysis : {"kind = \"sensitivity\"\n", "kind = \"monte-carlo\"\ndraws = \"per pose\"\n",
                                          "kind = \"sobol\"\n", "kind = \"identification\"\n"}) {
    expect_refused(
        study_text(file, analysis),
        {"errors.machines is set, but this study does not take machines as they are", "draws = \"per machine\""});
  }
  expect_refused(study_text(file, std::string(kMachines) + "factors = [\"delta_1\", \"epsilon_1\"]\n"),
                 {"errors.machines has the column 'delta_2', which the study does not vary", "remove the column"});
  expect_refused(study_text(plain, std::string(kMachines) + "samples = ^4\n"),
                 {"analysis.samples asks for 4 machines, but errors.machines has 3", "leave it out"});
  expect_refused(study_text(file + "override = { delta_2 = { draws = \"per pose\" } }\n"),
                 {"errors.machines has the column 'delta_2', which [errors] draws per pose"});
  expect_refused(study_text(plain + "[[errors.correlated]]\nfactors = ^[\"delta_1\", \"epsilon_1\"]\ncorrelation = "
                                    "[[1, 0.5], [0.5, 1]]\n"),
                 {"has 'delta_1', a column of errors.machines", "leave it out here"});
  expect_refused(study_text("machines = ^3\n"), {"errors.machines"});
  const auto table = [](const std::string& keys) { return study_text("machines = { " + keys + " }\n"); };
  expect_refused(table("columns = [^\"delta_9\"], rows = [[1e-3], [2e-3]]"),
                 {"errors.machines.columns[0] is 'delta_9', which is not an error of the mechanism"});
  expect_refused(table("columns = [\"delta_1\"], rows = [[1e-3], ^[2e-3, 1]]"),
                 {"errors.machines.rows[1] has 2 numbers, but there are 1 columns"});
  expect_refused(
      study_text("machines = ^{ columns = [\"delta_1\"], rows = [[1e-3], [1e-3]] }\n"),
      {"errors.machines has the column 'delta_1', whose values must not all be equal", "analysis.background"});
  expect_refused(study_text("machines = ^{ columns = [\"delta_1\"], rows = [[1e-3]] }\n"),
                 {"errors.machines has the column 'delta_1', whose number of values must be at least 2, not 1"});
}

TEST_F(GivenMachines, AreRefusedWithLineAndColumnOfTheTable) {
  expect_wrong_table("delta_1,^delta_9\n1,2\n", {"delta_9"});
  expect_wrong_table("delta_1,delta_2\n0.001,0.002\n0.001,^x\n", {"x"});
  expect_wrong_table("delta_1,delta_2\n^0.001\n", {"this line should have 2 cells, but has 1"});
  expect_wrong_table("delta_1\n^", {"there is no data below the column names"});
}

}  // namespace
}  // namespace poesy
