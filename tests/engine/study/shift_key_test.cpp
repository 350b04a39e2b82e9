#include <gtest/gtest.h>

#include "tests/engine/study/study_of_errors.h"

namespace poesy {
namespace {

using test::catalog_of_errors;
using test::expect_errors_refused;
using test::study_of_errors;
using test::text_of_errors;

TEST(Shift, IsReadForEveryShapeAndComesBack) {
  const Study study = study_of_errors(
      "linear = { distribution = \"normal\", sigma = \"1 mm\", shift = \"0.1 mm\" }\n"
      "angular = { distribution = \"uniform\", half_width = \"1 deg\", shift = \"0 deg\" }\n"
      "override = { delta_2 = { distribution = \"truncated-normal\", sigma = \"1 mm\", half_width = \"3 mm\", shift = "
      "\"0.7 mm\" } }\n");
  EXPECT_EQ(study.errors.by_factor[0], Distribution::normal(1e-3).shifted(1e-4));
  EXPECT_EQ(study.errors.by_factor[1].shift(), 0.0);
  EXPECT_EQ(study.errors.by_factor[2].shift(), 0.7e-3);
  const std::string text = resolved_text(study);
  EXPECT_NE(text.find("sigma = \"0.001 m\", shift = \"1e-04 m\" }"), std::string::npos) << text;
  EXPECT_EQ(text.find("shift = \"0 "), std::string::npos) << text;
  const Study again = study_of_text(text, "again.toml", catalog_of_errors(), StudyUse::run);
  EXPECT_EQ(again.errors.by_factor, study.errors.by_factor);
  EXPECT_EQ(resolved_text(again), text);
  EXPECT_EQ(resolved_text(study_of_errors("")).find("shift"), std::string::npos);
}

TEST(Shift, IsRefusedWhereItMakesNoSense) {
  expect_errors_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", shift = ^\"-0.1 mm\" }\n",
                        {"errors.linear.shift is '-0.1 mm', below zero", "at least 0"});
  expect_errors_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", shift = ^\"1 deg\" }\n",
                        {"errors.linear.shift", "must be a length"});
  expect_errors_refused("linear = { distribution = \"measured\", values = [], ^shift = \"1 mm\" }\n",
                        {"errors.linear.shift does not belong", "measured"});
  expect_errors_refused(
      "override = { delta_1 = { distribution = \"uniform\", half_width = \"1 mm\", shift = \"1 um\" } }\n"
      "[[errors.correlated]]\nfactors = ^[\"delta_2\", \"delta_1\"]\ncorrelation = [[1, 0.5], [0.5, 1]]\n",
      {"'delta_1', whose distribution has a shift"});
}

/// The fake mechanism, with lengths bounded by the arm.
class BoundedModel final : public test::FakeModel {
 public:
  using FakeModel::FakeModel;

  ErrorBound error_bound(FactorIndex factor) const override {
    return factor.value == 1 ? ErrorBound{} : ErrorBound{kArm, "the arm"};
  }
};

TEST(Shift, CountsInWhatIsTooLarge) {
  Catalog catalog = test::fake_catalog();
  catalog[0].build = [](std::span<const double> geometry, std::size_t) {
    return std::make_unique<BoundedModel>(geometry[0]);
  };
  expect_errors_refused("linear = { distribution = \"uniform\", half_width = \"50 mm\", shift = ^\"15 mm\" }\n",
                        {"errors.linear.shift gives delta_1 a largest error of 65 mm, no less than the arm (60 mm)"},
                        catalog);
  expect_errors_refused("linear = { distribution = \"uniform\", half_width = ^\"60 mm\", shift = \"15 mm\" }\n",
                        {"errors.linear.half_width gives delta_1 a largest error of 75 mm"}, catalog);
  expect_errors_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", shift = ^\"60 mm\" }\n",
                        {"errors.linear.shift gives delta_1 a standard deviation of"}, catalog);
  EXPECT_NO_THROW(
      study_of_errors("linear = { distribution = \"uniform\", half_width = \"50 mm\", shift = \"9 mm\" }\n", catalog));
}

}  // namespace
}  // namespace poesy
