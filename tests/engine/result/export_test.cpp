#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <sstream>

#include "engine/base/error.h"
#include "engine/base/units.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/result/result_file.h"
#include "engine/run/evaluation.h"
#include "engine/study/table_file.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

using Cells = std::vector<std::string>;

std::vector<Cells> read_table(const std::string& path) {
  std::vector<Cells> table;
  std::istringstream lines(read_bytes(path));
  for (std::string line; std::getline(lines, line);) {
    Cells cells;
    std::istringstream rest(line);
    for (std::string text; std::getline(rest, text, ',');) cells.push_back(text);
    table.push_back(cells);
  }
  return table;
}

std::vector<std::string> base_names(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const std::string& path : paths) names.push_back(std::filesystem::path(path).filename().string());
  std::ranges::sort(names);
  return names;
}

class Export : public testing::Test {
 protected:
  Export() {
    example_.write_sensitivity(folder_ / "s.h5");
    example_.write_evaluation(folder_ / "e.h5", Pairing::every_pose_with_every_row);
  }

  TempFolder folder_;
  Example example_;
};

TEST_F(Export, SensitivityHasThePromisedTables) {
  EXPECT_EQ(base_names(export_tables(folder_ / "s.h5", folder_ / "new/folder")),
            (std::vector<std::string>{"count_angular_deformation.csv",
                                      "count_linear_deformation.csv",
                                      "factors.csv",
                                      "failures.csv",
                                      "global.csv",
                                      "history_angular_deformation.csv",
                                      "history_linear_deformation.csv",
                                      "index_change.csv",
                                      "iterations_max.csv",
                                      "iterations_mean.csv",
                                      "local_angular_deformation.csv",
                                      "local_ci_high_angular_deformation.csv",
                                      "local_ci_high_linear_deformation.csv",
                                      "local_ci_low_angular_deformation.csv",
                                      "local_ci_low_linear_deformation.csv",
                                      "local_linear_deformation.csv",
                                      "mean_angular_deformation.csv",
                                      "mean_linear_deformation.csv",
                                      "not_converged.csv",
                                      "poses.csv",
                                      "solves_converged.csv",
                                      "solves_iteration_cap.csv",
                                      "solves_non_finite.csv",
                                      "solves_singular.csv",
                                      "solves_stagnated.csv",
                                      "std_angular_deformation.csv",
                                      "std_linear_deformation.csv",
                                      "tolerances_angular_deformation.csv",
                                      "tolerances_linear_deformation.csv"}));
}

TEST_F(Export, FailuresAreAddresses) {
  export_tables(folder_ / "s.h5", folder_.path());
  EXPECT_EQ(read_table(folder_ / "failures.csv"),
            (std::vector<Cells>{
                {"factor", "pose", "sample", "status"}, {"epsilon_1", "1", "7", "2"}, {"delta_1", "3", "99", "4"}}));
}

TEST_F(Export, GlobalIndicesComeInSiAndInDisplayUnits) {
  export_tables(folder_ / "s.h5", folder_.path());
  const auto table = read_table(folder_ / "global.csv");
  ASSERT_EQ(table.size(), 3U);
  ASSERT_EQ(table[0].size(), 25U);
  EXPECT_EQ(table[0][0], "factor");
  EXPECT_EQ(table[0][1], "angular_deformation [rad per rad or m]");
  EXPECT_EQ(table[0][5], "angular_deformation_ci_low [deg per deg or mm]");
  EXPECT_EQ(table[0][12], "linear_deformation_ci_high [mm per deg or mm]");
  EXPECT_EQ(table[0][13], "angular_deformation_corrected [rad per rad or m]");
  EXPECT_EQ(table[0][24], "linear_deformation_corrected_ci_high [mm per deg or mm]");
  EXPECT_EQ(table[1][0], "epsilon_1");
  EXPECT_EQ(table[2][0], "delta_1");
  // global is array 5 of the example, with the values 5000 + 100 r + 10 p.
  EXPECT_EQ(table[1][1], "5000");
  EXPECT_DOUBLE_EQ(parse_number(table[1][4]).value(), 5000.0);  // deg per deg
  EXPECT_EQ(table[2][1], "5010");
  EXPECT_DOUBLE_EQ(parse_number(table[2][4]).value(), 5010.0 * 1e-3 * 180.0 / std::numbers::pi);  // deg per mm
  EXPECT_EQ(table[1][7], "5100");
  EXPECT_DOUBLE_EQ(parse_number(table[1][10]).value(), 5100.0 * 1e3 * std::numbers::pi / 180.0);  // mm per deg
  EXPECT_EQ(table[2][7], "NaN");
  // global_corrected is array 11.
  EXPECT_EQ(table[1][13], "11000");
  EXPECT_DOUBLE_EQ(parse_number(table[2][16]).value(), 11010.0 * 1e-3 * 180.0 / std::numbers::pi);  // deg per mm
}

/// A unit of two words stays one unit in the headings and in text columns.
TEST_F(Export, UnitsMayHoldABlank) {
  CatalogEntry entry = *example_.study.mechanism.entry;
  entry.description.responses[0].dimension = Dimension::moment;
  entry.description.responses[1].dimension = Dimension::energy;
  example_.study.mechanism.entry = &entry;
  example_.write_sensitivity(folder_ / "moment.h5");
  const StoredResult result = read_result(folder_ / "moment.h5");
  EXPECT_EQ(result.responses[0].unit, "N m");
  EXPECT_EQ(result.responses[1].unit, "J");
  EXPECT_EQ(display(result.responses[0]).name, "N m");
  export_tables(folder_ / "moment.h5", folder_ / "moment");
  const Cells head = read_table(folder_ / "moment/global.csv").at(0);
  EXPECT_EQ(head.at(1), "angular_deformation [N m per rad or m]");
  EXPECT_EQ(head.at(7), "linear_deformation [J per rad or m]");
}

TEST_F(Export, IndexChangesHaveAColumnForEachResponse) {
  export_tables(folder_ / "s.h5", folder_.path());
  EXPECT_EQ(read_table(folder_ / "index_change.csv"),
            (std::vector<Cells>{{"factor", "angular_deformation", "linear_deformation"},
                                {"epsilon_1", "-0.25", "0"},
                                {"delta_1", "0.125", "NaN"}}));
}

TEST_F(Export, HistoryHasARowForEachNumberOfSamples) {
  export_tables(folder_ / "s.h5", folder_.path());
  EXPECT_EQ(read_table(folder_ / "history_linear_deformation.csv"),
            (std::vector<Cells>{{"factor", "samples", "index [m per rad or m]", "index_ci_low [m per rad or m]",
                                 "index_ci_high [m per rad or m]"},
                                {"epsilon_1", "50", "8100", "9100", "10100"},
                                {"epsilon_1", "100", "8100.125", "9100.125", "10100.125"},
                                {"delta_1", "50", "8110", "9110", "10110"},
                                {"delta_1", "100", "8110.125", "9110.125", "NaN"}}));
}

TEST_F(Export, LocalTableHasFactorsDownAndPosesAcross) {
  export_tables(folder_ / "s.h5", folder_.path());
  const auto table = read_table(folder_ / "local_ci_low_linear_deformation.csv");
  EXPECT_EQ(table[0][2], "pose_1 [m per rad or m]");
  EXPECT_EQ(table[1], (Cells{"epsilon_1", "1100", "1100.125", "1100.25", "1100.375"}));
  EXPECT_EQ(table[2], (Cells{"delta_1", "1110", "1110.125", "1110.25", "NaN"}));
}

TEST_F(Export, SolverTablesCountSamples) {
  export_tables(folder_ / "s.h5", folder_.path());
  // The example has by_status = {90 - cell, 7, 2, 1, cell} with cell = 4 p + m. The first two statuses count as solved.
  EXPECT_EQ(read_table(folder_ / "not_converged.csv")[2], (Cells{"delta_1", "7", "8", "9", "10"}));
  EXPECT_EQ(read_table(folder_ / "solves_converged.csv")[1], (Cells{"epsilon_1", "90", "89", "88", "87"}));
  EXPECT_EQ(read_table(folder_ / "iterations_mean.csv")[1], (Cells{"epsilon_1", "7", "7.01", "7.02", "7.03"}));
}

TEST_F(Export, PosesKeepTheModelsOrderAndUnits) {
  export_tables(folder_ / "s.h5", folder_.path());
  const auto table = read_table(folder_ / "poses.csv");
  EXPECT_EQ(table[0], (Cells{"pose", "z [m]", "beta [rad]", "gamma [rad]", "condition"}));
  EXPECT_EQ(table[3], (Cells{"2", "-0.21875", "0.25", "-0.5", "5"}));
  EXPECT_EQ(table[4][4], "inf");
}

TEST_F(Export, EvaluationHasARowForEachSolve) {
  EXPECT_EQ(base_names(export_tables(folder_ / "e.h5", folder_.path())),
            (std::vector<std::string>{"errors.csv", "evaluate.csv", "joint_displacements.csv", "poses.csv"}));
  const auto table = read_table(folder_ / "evaluate.csv");
  ASSERT_EQ(table.size(), 1 + Example::kPoses * Example::kSamples);
  EXPECT_EQ(table[0],
            (Cells{"pose", "sample", "angular_deformation [rad]", "linear_deformation [m]", "signed_angular [rad]",
                   "signed_linear [m]", "twist_21_omega_x [rad]", "twist_21_omega_y [rad]", "twist_21_v_z [m]",
                   "twist_32_omega_x [rad]", "twist_32_omega_y [rad]", "twist_32_v_z [m]", "status", "iterations"}));
  // Row 7 is pose 2, sample 1. Its responses are k / 8 with k = 7 and 12 + 7, its details 56 to 63, its status 7 mod 5.
  EXPECT_EQ(table[8], (Cells{"2", "1", "0.875", "2.375", "56", "57", "58", "59", "60", "61", "62", "63", "2", "17"}));
  const auto errors = read_table(folder_ / "errors.csv");
  EXPECT_EQ(errors[0], (Cells{"sample", "delta_2 [m]", "epsilon_1 [rad]"}));
  EXPECT_EQ(errors[2], (Cells{"1", "0.001953125", "0.0029296875"}));
}

TEST_F(Export, LabelsOfRowsComeBack) {
  ErrorTable errors = example_.errors(Pairing::every_pose_with_every_row);
  errors.labels = {"part", {"17", "Gehäuse", "19"}};
  evaluate::Evaluation found = example_.evaluation(Pairing::every_pose_with_every_row);
  found.labels = errors.labels;
  evaluate::write_evaluation(folder_ / "l.h5", example_.study, example_.poses, errors.factors, found, example_.facts);
  const StoredResult stored = read_result(folder_ / "l.h5");
  EXPECT_EQ(evaluate::evaluation_of(stored).labels.column, "part");
  EXPECT_EQ(evaluate::evaluation_of(stored).labels.names, errors.labels.names);
  export_tables(stored, folder_.path());
  const auto solves = read_table(folder_ / "evaluate.csv");
  EXPECT_EQ(Cells(solves[0].begin(), solves[0].begin() + 4),
            (Cells{"part", "pose", "sample", "angular_deformation [rad]"}));
  EXPECT_EQ(Cells(solves[8].begin(), solves[8].begin() + 4), (Cells{"Gehäuse", "2", "1", "0.875"}));
  EXPECT_EQ(read_table(folder_ / "errors.csv")[2], (Cells{"Gehäuse", "1", "0.001953125", "0.0029296875"}));
  // The response of solve k = 3 m + s (pose m, row s) is k / 8, and it is solved if k mod 5 < 2. So row 1 is solved at
  // pose 0 (k = 1) and at pose 3 (k = 10).
  const auto parts = read_table(folder_ / "parts.csv");
  ASSERT_EQ(parts.size(), 4U);
  EXPECT_EQ(Cells(parts[0].begin(), parts[0].begin() + 5),
            (Cells{"part", "poses", "angular_deformation_mean [rad]", "angular_deformation_extreme [rad]",
                   "angular_deformation_extreme_pose"}));
  EXPECT_EQ(Cells(parts[2].begin(), parts[2].begin() + 5), (Cells{"Gehäuse", "2", "0.6875", "1.25", "3"}));
}

TEST_F(Export, ErrorsOfAnExportAreReadAgain) {
  export_tables(folder_ / "e.h5", folder_.path());
  const FakeModel model;
  const ErrorTable written = example_.errors(Pairing::every_pose_with_every_row);
  const ErrorTable back = read_errors(folder_ / "errors.csv", model);
  EXPECT_EQ(back.factors, written.factors);
  EXPECT_EQ(back.values, written.values);
}

TEST_F(Export, WholeNumbersHaveAllTheirDigits) {
  monte_carlo::Result found = example_.monte_carlo();
  std::ranges::fill(found.overall_count, 100'000);
  write_result(folder_ / "m.h5", example_.study, example_.poses, found, example_.facts);
  export_tables(folder_ / "m.h5", folder_.path());
  const auto overall = read_table(folder_ / "overall.csv");
  const auto count = std::ranges::find(overall[0], "count") - overall[0].begin();
  EXPECT_EQ(overall[1][static_cast<std::size_t>(count)], "100000");
}

TEST_F(Export, IntoAFolderThatIsAFileIsAFileError) {
  EXPECT_THROW(export_tables(folder_ / "s.h5", folder_ / "e.h5"), FileError);
}

}  // namespace
}  // namespace poesy::test
