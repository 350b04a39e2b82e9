#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/kinds/coupling/coupling.h"
#include "engine/result/result_file.h"
#include "engine/storage/h5.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::coupling {
namespace {

constexpr std::size_t kPoses = test::Example::kPoses;

class CouplingFile : public testing::Test {
 protected:
  CouplingFile() : path_(folder_.file("coupling.h5")), found_(example_.coupling()) { example_.write_coupling(path_); }

  test::TempFolder folder_;
  test::Example example_;
  std::string path_;
  Result found_;
};

/// Expects equal numbers. NaN equals NaN.
template <class Numbers>
void expect_same(const Numbers& found, const Numbers& expected) {
  ASSERT_EQ(found.lengths(), expected.lengths());
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double one = found.all()[k];
    const double other = expected.all()[k];
    EXPECT_TRUE(one == other || (std::isnan(one) && std::isnan(other))) << k;
  }
}

TEST_F(CouplingFile, IsReadBackAsItWas) {
  const StoredResult result = read_result(path_);
  const Result& found = coupling_of(result);
  EXPECT_EQ(result.kind, "coupling");
  EXPECT_EQ(found.size_names, (std::vector<std::string>{"0.1 mm", "0.2 mm"}));
  EXPECT_EQ(found.linear, found_.linear);
  EXPECT_TRUE(std::isnan(found.angular(1)));
  EXPECT_EQ(found.sources, (std::vector<std::string>{"D", "E"}));
  EXPECT_EQ(found.subsets, (std::vector<std::string>{"D", "E", "D+E"}));
  EXPECT_EQ(result.headline, (std::vector<std::size_t>{0, 1}));
  for (const auto member : test::Example::kCurves) expect_same(found.*member, found_.*member);
  for (const auto member : test::Example::kSummaries) expect_same(found.*member, found_.*member);
  EXPECT_EQ(found.count, found_.count);
  EXPECT_EQ(found.effect_max_pose, found_.effect_max_pose);
  EXPECT_EQ(found.cancellation_max_pose, found_.cancellation_max_pose);
  ASSERT_EQ(found.solves.size(), 2 * kPoses);
  EXPECT_EQ(found.solves(1, 1).by_status, found_.solves(1, 1).by_status);
  EXPECT_EQ(found.total().iterations, found_.total().iterations);
  EXPECT_TRUE(verify_result(path_).matches());
}

TEST_F(CouplingFile, HasNamedAxesAndSaysWhichErrorIsWhere) {
  const h5::File file = h5::File::open(path_);
  EXPECT_EQ(file.shape("/coupling/effect"), (h5::Shape{2, 2, 3, kPoses}));
  EXPECT_EQ(file.shape("/coupling/effect_max"), (h5::Shape{2, 2, 3}));
  EXPECT_EQ(file.read<std::string>("/coupling/subset"), (std::vector<std::string>{"D", "E", "D+E"}));
  EXPECT_EQ(file.read<std::uint8_t>("/coupling/subset_sources"), (std::vector<std::uint8_t>{1, 0, 0, 1, 1, 1}));
  EXPECT_EQ(file.read<std::uint64_t>("/coupling/factor_source"), (std::vector<std::uint64_t>{1, 0}));
  EXPECT_EQ(file.read<std::uint64_t>("/coupling/factor_block"), (std::vector<std::uint64_t>{0, 0}));
  EXPECT_EQ(file.shape("/solver/not_converged"), (h5::Shape{2, kPoses}));
}

TEST_F(CouplingFile, KnowsTheResponsesOfASummary) {
  Catalog catalog = test::fake_catalog();
  catalog.front().description.signed_headline = {1};
  example_.study.mechanism.entry = &catalog.front();
  example_.write_coupling(path_);
  EXPECT_EQ(read_result(path_).signed_headline, std::vector<std::size_t>{1});
}

std::string first_lines(const std::string& text, std::size_t count) {
  std::size_t end = 0;
  for (std::size_t n = 0; n < count; ++n) end = text.find('\n', end) + 1;
  return text.substr(0, end);
}

TEST_F(CouplingFile, IsExportedByPoseAndInSum) {
  const std::string tables = folder_.file("tables");
  EXPECT_EQ(export_tables(path_, tables).size(), 5u);
  const std::string curves = test::read_bytes(tables + "/coupling.csv");
  EXPECT_EQ(first_lines(curves, 2),
            "subset,size_linear [m],size_angular [rad],pose,corners,unsolved_corners,angular_deformation_effect [rad],"
            "angular_deformation_interaction [rad],angular_deformation_first_order_sum [rad],"
            "angular_deformation_worst_case [rad],angular_deformation_root_sum_square [rad],"
            "angular_deformation_cancellation,linear_deformation_effect [m],linear_deformation_interaction [m],"
            "linear_deformation_first_order_sum [m],linear_deformation_worst_case [m],"
            "linear_deformation_root_sum_square [m],linear_deformation_cancellation\n"
            "D,1e-04,NaN,0,20,0,0.125,12.125,45.125,18.125,24.125,30.125,3.125,15.125,48.125,21.125,27.125,33.125\n");
  EXPECT_EQ(std::count(curves.begin(), curves.end(), '\n'), 1 + 2 * 3 * static_cast<std::ptrdiff_t>(kPoses));
  EXPECT_NE(curves.find("\nD+E,2e-04,NaN,3,"), std::string::npos);
  const std::string summary = test::read_bytes(tables + "/coupling_summary.csv");
  EXPECT_EQ(std::count(summary.begin(), summary.end(), '\n'), 1 + 2 * 3);
  EXPECT_NE(summary.find("\nE,1e-04,NaN,3,36.25,0,37.75,51.25,39.25,1,40.75,42.25,43.75,1,3,37,6,"), std::string::npos)
      << summary;
  EXPECT_EQ(first_lines(test::read_bytes(tables + "/coupling_corners.csv"), 3),
            "subset,size_linear [m],size_angular [rad],error,angular_deformation,linear_deformation,unsolved\n"
            "D,1e-04,NaN,0,1,1,0\nD,1e-04,NaN,1,0,0,0\n");
  EXPECT_EQ(first_lines(test::read_bytes(tables + "/not_converged.csv"), 2),
            "pose,size_linear [m],size_angular [rad],not_converged,iterations_mean,iterations_max,solves_converged,"
            "solves_stagnated,solves_iteration_cap,solves_singular,solves_non_finite\n0,1e-04,NaN,1,2,5,3,0,0,1,0\n");
}

/// A file of version 0.2.0 stores the first-order sum under the name of the worst case and has no corners.
TEST_F(CouplingFile, OfVersion020HasTheFirstOrderSumAsWorstCase) {
  Result older = example_.coupling();
  const Result::Curves sum = older.worst_case;
  const auto clear = [](auto&... arrays) { (..., (arrays = {})); };
  clear(older.first_order_sum, older.first_order_sum_max, older.rounding, older.corners, older.unsolved_corners,
        older.worst_case_max_pose, older.worst_case_signs, older.unsolved_pose, older.unsolved_signs);
  write_result(path_, example_.study, example_.poses, older, example_.facts);
  const StoredResult stored = read_result(path_);
  const Result& found = coupling_of(stored);
  EXPECT_FALSE(has_worst_cases(found));
  ASSERT_EQ(found.first_order_sum.size(), sum.size());
  EXPECT_EQ(found.first_order_sum(0, 0, 0, 0), sum(0, 0, 0, 0));
  ASSERT_EQ(found.rounding.size(), 4u);
  for (const std::size_t r : {0u, 1u}) {
    EXPECT_DOUBLE_EQ(found.rounding(r, 0), 1e-14) << "1e-10 of 0.1 mm";
    EXPECT_DOUBLE_EQ(found.rounding(r, 1), 2e-14);
  }
  EXPECT_EQ(export_tables(path_, folder_.file("tables")).size(), 4u);
  EXPECT_FALSE(coupling_tables(stored).empty());
}

}  // namespace
}  // namespace poesy::coupling
