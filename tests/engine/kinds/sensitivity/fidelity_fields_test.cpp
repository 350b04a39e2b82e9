#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/kinds/study_file.h"
#include "engine/result/result_file.h"
#include "engine/storage/h5.h"
#include "engine/study/study_file.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy::sensitivity {
namespace {

/// The example's result with a second fidelity.
class FidelityFile : public testing::Test {
 protected:
  FidelityFile() {
    catalog_[0].description.fidelities = {"exact", "first-order"};
    example_.study.mechanism.entry = &catalog_[0];
    example_.study.mechanism.compared = 1;
    asked_of<Options>(example_.study.analysis).linearity = 0.02;
    result_.fidelity = test::Example::fidelity(catalog_[0].description.fidelities);
    write_result(path_, example_.study, example_.poses, result_, example_.facts);
  }

  Catalog catalog_ = test::fake_catalog();
  test::TempFolder folder_;
  test::Example example_;
  Result result_ = example_.sensitivity();
  std::string path_ = folder_.file("fidelity.h5");
};

TEST_F(FidelityFile, IsReadBackAsItWas) {
  const StoredResult stored = read_result(path_);
  ASSERT_TRUE(sensitivity_of(stored).fidelity);
  const FidelityResult& found = *sensitivity_of(stored).fidelity;
  EXPECT_EQ(found.linearity, 0.02);
  EXPECT_EQ(found.global, result_.fidelity->global);
  EXPECT_EQ(found.discrepancy, result_.fidelity->discrepancy);
  EXPECT_EQ(found.relative_discrepancy, result_.fidelity->relative_discrepancy);
  EXPECT_EQ(found.nonlinearity, result_.fidelity->nonlinearity);
  EXPECT_EQ(found.linear, result_.fidelity->linear);
  EXPECT_EQ(found.not_converged, result_.fidelity->not_converged);
  EXPECT_EQ(found.fidelities, result_.fidelity->fidelities);
  EXPECT_EQ(sensitivity_of(stored).solves.size(), result_.solves.size());
  EXPECT_TRUE(verify_result(path_).matches());
}

TEST_F(FidelityFile, StudyInItIsComplete) {
  const std::string text = read_result(path_).study_text;
  EXPECT_NE(text.find("fidelity = \"both\"\n"), std::string::npos) << text;
  EXPECT_NE(text.find("linearity = 0.02\n"), std::string::npos) << text;
}

TEST_F(FidelityFile, IsExported) {
  export_tables(path_, folder_.file("tables"));
  const std::string table = test::read_bytes(folder_.file("tables/fidelity.csv"));
  const std::string head = table.substr(0, table.find('\n'));
  EXPECT_TRUE(
      head.starts_with("factor,linear,angular_deformation_exact [rad per rad or m],"
                       "angular_deformation_first-order [rad per rad or m],"
                       "angular_deformation_discrepancy [rad per rad or m],"
                       "angular_deformation_relative_discrepancy,angular_deformation_nonlinearity,"
                       "linear_deformation_exact"))
      << head;
  EXPECT_NE(table.find("\nepsilon_1,1,5000,1,0.5,0.25,0.5,5100,3,-0.125,-0.0625,0.03125\n"), std::string::npos)
      << table;
  EXPECT_TRUE(table.ends_with(",4,0,inf,0.75\n")) << table;
  const std::string failed = test::read_bytes(folder_.file("tables/fidelity_not_converged.csv"));
  EXPECT_TRUE(failed.ends_with("epsilon_1,0,1,2,3\ndelta_1,4,5,6,7\n")) << failed;
}

TEST_F(FidelityFile, ConfirmationOfItsTolerancesIsAtTheFirstFidelity) {
  Result solved = example_.sensitivity();
  for (const auto values : {solved.global.all(), solved.mean.all(), solved.std.all()}) std::ranges::fill(values, 1.0);
  set_references(example_.study, solved);
  solved.fidelity = result_.fidelity;
  write_result(path_, example_.study, example_.poses, solved, example_.facts);
  const StoredResult stored = read_result(path_);
  const ResponseStudy study = response_study(sensitivity_of(stored), stored.factor_sigma, {}, 1);
  ResponseTolerances found{1, tolerances(study, sensitivity_of(stored).reference(1)), std::nullopt};
  found.limit =
      limit_tolerances(study, found.all.mean_square, stored.factor_sigma, 10.0, largest_tolerances(stored, catalog_));
  for (const std::string& path : write_confirmation(folder_.file("t"), stored, found, catalog_).paths) {
    const Study confirmation = read_study(path, catalog_, StudyUse::run);
    EXPECT_EQ(confirmation.mechanism.fidelity, 0u);
    EXPECT_FALSE(confirmation.mechanism.compared);
  }
}

}  // namespace
}  // namespace poesy::sensitivity
