#include <gtest/gtest.h>

#include <sstream>

#include "engine/kinds/evaluate/cases.h"
#include "engine/kinds/identification/identification.h"
#include "engine/result/result_file.h"
#include "engine/storage/h5.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/elements.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

/// Two cases at the example's four poses, all details kept.
class CasesFile : public testing::Test {
 protected:
  CasesFile() : result_(example_.cases()), path_(folder_.file("cases.h5")) {
    write_result(path_, example_.study, example_.poses, result_, example_.facts);
  }

  test::TempFolder folder_;
  test::Example example_;
  evaluate::Evaluation result_;
  std::string path_;
};

TEST_F(CasesFile, KeepsSolvesCaseByCase) {
  const h5::File file = h5::File::open(path_);
  EXPECT_EQ(file.shape("/evaluate/linear_deformation"), (h5::Shape{2, test::Example::kPoses}));
  const auto values = file.read<double>("/evaluate/linear_deformation");
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t m = 0; m < test::Example::kPoses; ++m) {
      EXPECT_EQ(values[c * test::Example::kPoses + m], result_.solves.response(1, m, c));
    }
  }
}

TEST_F(CasesFile, IsReadBackAsItWas) {
  const StoredResult stored = read_result(path_);
  EXPECT_EQ(stored.kind, "evaluate");
  const evaluate::Evaluation& found = evaluate::evaluation_of(stored);
  EXPECT_EQ(found.cases, (std::vector<std::string>{"fine", "coarse"}));
  EXPECT_EQ(found.solves.response, result_.solves.response);
  EXPECT_EQ(found.solves.detail, result_.solves.detail);
  EXPECT_EQ(found.solves.status, result_.solves.status);
  EXPECT_EQ(found.solves.iterations, result_.solves.iterations);
  EXPECT_EQ(found.solves.joint_displacement, result_.solves.joint_displacement);
  EXPECT_EQ(found.mean, result_.mean);
  EXPECT_EQ(found.extreme, result_.extreme);
  EXPECT_EQ(found.count, result_.count);
  EXPECT_EQ(test::elements(found.errors), (std::vector<double>{1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3}));
  EXPECT_TRUE(verify_result(path_).matches());
}

TEST_F(CasesFile, KeepsTheTimesOfATrajectory) {
  EXPECT_TRUE(read_result(path_).time.empty());
  example_.poses.time = {0.0, 0.25, 0.5, 1.5};
  write_result(path_, example_.study, example_.poses, result_, example_.facts);
  EXPECT_TRUE(verify_result(path_).matches());
  EXPECT_EQ(read_result(path_).time, example_.poses.time);
  EXPECT_EQ(h5::File::open(path_).attribute<std::string>("/poses/time", "unit").at(0), "s");
  export_tables(path_, folder_.path());
  const auto lines = [&](const std::string& name, std::size_t line) {
    std::istringstream text(test::read_bytes(folder_ / name));
    std::string found;
    for (std::size_t k = 0; k <= line; ++k) std::getline(text, found);
    return found;
  };
  EXPECT_TRUE(lines("poses.csv", 0).starts_with("pose,time [s],z [m]"));
  EXPECT_TRUE(lines("poses.csv", 4).starts_with("3,1.5,"));
  EXPECT_TRUE(lines("evaluate.csv", 0).starts_with("case,pose,time [s],angular_deformation [rad]"));
  EXPECT_TRUE(lines("evaluate.csv", 4).starts_with("fine,3,1.5,"));
  EXPECT_TRUE(lines("evaluate.csv", 6).starts_with("coarse,1,0.25,"));
}

TEST_F(CasesFile, IsExportedWithItsNames) {
  const std::string tables = folder_.file("tables");
  export_tables(path_, tables);
  EXPECT_EQ(test::read_bytes(tables + "/errors.csv"),
            "case,delta_1 [m],epsilon_1 [rad],delta_2 [m]\nfine,0.001,0.002,0.003\ncoarse,0.004,0.005,0.006\n");
  const std::string solves = test::read_bytes(tables + "/evaluate.csv");
  EXPECT_EQ(solves.substr(0, 10), "case,pose,");
  EXPECT_NE(solves.find("\nfine,3,"), std::string::npos);
  EXPECT_LT(solves.find("\nfine,3,"), solves.find("\ncoarse,0,"));
  const std::string cases = test::read_bytes(tables + "/cases.csv");
  EXPECT_EQ(cases.substr(0, cases.find('\n')),
            "case,poses,angular_deformation_mean [rad],angular_deformation_extreme [rad],linear_deformation_mean [m],"
            "linear_deformation_extreme [m]");
}

/// Files of version 0.2.0 have no extremes.
TEST_F(CasesFile, OfVersion020GetsItsExtremesFromTheSolves) {
  evaluate::Evaluation older = result_;
  older.extreme = {};
  const std::string path = folder_.file("older.h5");
  write_result(path, example_.study, example_.poses, older, example_.facts);
  ASSERT_FALSE(h5::File::open(path).exists("/evaluate/extreme"));
  const StoredResult stored = read_result(path);
  EXPECT_EQ(evaluate::evaluation_of(stored).extreme, result_.extreme);
  EXPECT_EQ(evaluate::evaluation_of(stored).mean, result_.mean);
  EXPECT_EQ(evaluate::evaluation_of(stored).count, result_.count);
}

class IdentificationFile : public testing::Test {
 protected:
  IdentificationFile() : path_(folder_.file("identification.h5")) {}

  StoredResult stored(const identification::Result& result) {
    write_result(path_, example_.study, example_.poses, result, example_.facts);
    return read_result(path_);
  }

  test::TempFolder folder_;
  test::Example example_;
  std::string path_;
};

TEST_F(IdentificationFile, IsReadBackAsItWas) {
  const identification::Result written = example_.identification();
  const StoredResult read = stored(written);
  const identification::Result& found = identification::identification_of(read);
  EXPECT_EQ(read.kind, "identification");
  EXPECT_EQ(found.sizes[1].name, "small");
  EXPECT_EQ(found.sizes[1].angular, 4e-4);
  EXPECT_EQ(found.poses, written.poses);
  EXPECT_EQ(found.rounding, written.rounding);
  EXPECT_EQ(found.required_poses, written.required_poses);
  EXPECT_EQ(found.single_below, written.single_below);
  EXPECT_EQ(found.single_max, written.single_max);
  EXPECT_EQ(found.not_solved, written.not_solved);
  EXPECT_EQ(found.coupled_below, written.coupled_below);
  EXPECT_EQ(found.coupled_reduced, written.coupled_reduced);
  EXPECT_EQ(found.single_by_group, written.single_by_group);
  EXPECT_EQ(found.coupled_by_group, written.coupled_by_group);
  EXPECT_EQ(found.single, written.single);
  EXPECT_EQ(found.coupled, written.coupled);
  EXPECT_EQ(found.solves.by_status, written.solves.by_status);
  ASSERT_EQ(found.couplings.size(), 2u);
  EXPECT_EQ(found.couplings[1].first, 1u);
  EXPECT_EQ(found.couplings[1].deforming_poses, 2u);
  EXPECT_TRUE(verify_result(path_).matches());
}

TEST_F(IdentificationFile, MayHaveNoCouplings) {
  identification::Result none = example_.identification();
  none.couplings.clear();
  EXPECT_TRUE(identification::identification_of(stored(none)).couplings.empty());
}

TEST_F(IdentificationFile, IsExportedGroupByGroup) {
  stored(example_.identification());
  const std::string tables = folder_.file("tables");
  export_tables(path_, tables);
  EXPECT_EQ(test::read_bytes(tables + "/identification.csv"),
            "factor,single,coupled,single_group_1,single_group_2,coupled_group_1,coupled_group_2\n"
            "epsilon_1,1,1,1,1,1,1\ndelta_1,0,1,0,0,1,0\n");
  EXPECT_EQ(test::read_bytes(tables + "/couplings.csv"),
            "coupling,group,first_factor,second_factor,poses\nepsilon_1+delta_1,1,0,1,4\ndelta_1+epsilon_1,2,1,0,2\n");
  EXPECT_EQ(test::read_bytes(tables + "/single_below.csv"), "factor,group_1,group_2\nepsilon_1,0,1\ndelta_1,4,4\n");
}

}  // namespace
}  // namespace poesy
