#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/study/study_of_errors.h"

namespace poesy {
namespace {

using test::catalog_of_errors;
using test::expect_errors_refused;
using test::study_of_errors;
using test::text_of_errors;

void expect_comes_back(const Study& study) {
  const std::string text = resolved_text(study);
  const Study again = study_of_text(text, "again.toml", catalog_of_errors(), StudyUse::run);
  EXPECT_EQ(again.errors.by_factor, study.errors.by_factor) << text;
  EXPECT_EQ(again.errors.per_pose, study.errors.per_pose) << text;
  EXPECT_EQ(resolved_text(again), text);
}

TEST(Mean, IsReadForEveryShapeAndComesBack) {
  const Study study = study_of_errors(
      "linear = { distribution = \"normal\", sigma = \"1 mm\", mean = \"-0.1 mm\" }\n"
      "angular = { distribution = \"triangular\", half_width = \"1 deg\", mean = 0 }\n"
      "override = { delta_2 = { distribution = \"uniform\", half_width = \"3 mm\", shift = \"1 mm\", mean = \"2 mm\" } "
      "}\n");
  EXPECT_EQ(study.errors.by_factor[0], Distribution::normal(1e-3).about(-1e-4));
  EXPECT_EQ(study.errors.by_factor[1].mean(), 0.0);
  EXPECT_EQ(study.errors.by_factor[2], Distribution::uniform(3e-3).shifted(1e-3).about(2e-3));
  expect_comes_back(study);
  EXPECT_NE(resolved_text(study).find("sigma = \"0.001 m\", mean = \"-1e-04 m\" }"), std::string::npos);
  EXPECT_EQ(resolved_text(study_of_errors("")).find("mean"), std::string::npos);
}

TEST(Mean, IsRefusedWhereItMakesNoSense) {
  expect_errors_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", mean = ^\"1 deg\" }\n",
                        {"errors.linear.mean", "must be a length"});
  expect_errors_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", mean = ^0.1 }\n",
                        {"errors.linear.mean is the bare number 0.1", "unit"});
  expect_errors_refused("linear = { distribution = \"measured\", values = [], ^mean = \"1 mm\" }\n",
                        {"errors.linear.mean does not belong", "measured"});
}

TEST(Limits, AreTheEndsOfEveryShape) {
  const Study study = study_of_errors(
      "linear = { distribution = \"uniform\", limits = [\"-0.1 mm\", 0] }\n"
      "angular = { distribution = \"normal\", limits = [\"-1 deg\", \"2 deg\"], sigmas = 3 }\n"
      "override = { delta_2 = { distribution = \"truncated-normal\", sigma = \"1 mm\", limits = [\"1 mm\", \"3 mm\"] "
      "} }\n");
  EXPECT_EQ(study.errors.by_factor[0], Distribution::uniform(0.5e-4).about(-0.5e-4));
  EXPECT_DOUBLE_EQ(study.errors.by_factor[1].mean() * 180.0, 0.5 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(study.errors.by_factor[1].sigma() * 180.0, 0.5 * std::numbers::pi);
  EXPECT_EQ(study.errors.by_factor[2].mean(), 2e-3);
  EXPECT_EQ(study.errors.by_factor[2].half_width(), 1e-3);
  EXPECT_EQ(study.errors.by_factor[2].sigma(), 1e-3);
  expect_comes_back(study);
}

TEST(Limits, AreThoseOfAZone) {
  const Study study = study_of_errors(
      "linear = { distribution = \"triangular\", limits = \"217 h6\" }\n"
      "override = { delta_2 = { distribution = \"normal\", limits = \"8 g6\", sigmas = 2 } }\n");
  EXPECT_NEAR(study.errors.by_factor[0].mean(), -14.5e-6, 1e-18);
  EXPECT_NEAR(study.errors.by_factor[0].half_width(), 14.5e-6, 1e-18);
  EXPECT_NEAR(study.errors.by_factor[2].mean(), -9.5e-6, 1e-18);
  EXPECT_NEAR(study.errors.by_factor[2].sigma(), 2.25e-6, 1e-18);
  expect_comes_back(study);
}

TEST(Limits, AreRefusedWhereTheyMakeNoSense) {
  const auto refused = [](const std::string& keys, const std::vector<std::string>& words) {
    expect_errors_refused("linear = { distribution = \"uniform\", " + keys + " }\n", words);
  };
  refused("limits = ^[\"0.1 mm\", 0]", {"errors.linear.limits have the second no larger than the first", "smaller"});
  refused("limits = ^[0, 0]", {"errors.linear.limits have the second no larger"});
  refused("limits = ^[0, \"1e-31 m\"]", {"errors.linear.limits are so close that squares lose their digits"});
  refused("limits = ^[\"0.1 mm\"]", {"errors.linear.limits", "write two, e.g. [\"-0.1 mm\", 0]"});
  refused("limits = [0, ^0.1]", {"errors.linear.limits[1] is the bare number 0.1", "unit"});
  refused("limits = [0, ^\"1 deg\"]", {"must be a length"});
  refused("limits = ^\"217 k6\"", {"errors.linear.limits cannot be read: '217 k6' has no zone", "217 h6"});
  refused("limits = ^\"0.1 mm\"", {"errors.linear.limits cannot be read: '0.1 mm' has no zone"});
  refused("limits = ^\"8 H7/g6\"", {"is a fit of two parts"});
  refused("limits = \"8 g6\", ^half_width = \"1 mm\"", {"half_width does not belong to a distribution with limits"});
  refused("limits = \"8 g6\", ^mean = \"1 mm\"", {"mean does not belong to a distribution with limits"});
  refused("limits = \"8 g6\", ^shift = \"1 mm\"", {"shift does not belong to a distribution with limits"});
  refused("limits = \"8 g6\", ^sigmas = 3", {"errors.linear.sigmas does not belong", "uniform"});
  expect_errors_refused(
      "linear = ^{ distribution = \"normal\", limits = \"8 g6\" }\n",
      {"key 'sigmas' is missing in [errors.linear]", "a normal distribution with limits needs it, e.g. sigmas = 3"});
  expect_errors_refused("linear = { distribution = \"normal\", limits = \"8 g6\", ^sigma = \"1 mm\", sigmas = 3 }\n",
                        {"sigma does not belong to a normal distribution with limits"});
  expect_errors_refused("linear = { distribution = \"normal\", limits = \"8 g6\", sigmas = ^0 }\n",
                        {"errors.linear.sigmas is 0", "greater than zero"});
  expect_errors_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", sigmas = ^3 }\n",
                        {"errors.linear.sigmas is set without limits", "write limits"});
  expect_errors_refused("linear = ^{ distribution = \"truncated-normal\", limits = \"8 g6\" }\n", {"sigma"});
  expect_errors_refused("angular = { distribution = \"uniform\", limits = ^\"8 g6\" }\n",
                        {"errors.angular.limits is '8 g6', but zones of ISO 286 are of lengths", "[\"-0.1 deg\", 0]"});
  expect_errors_refused("linear = { distribution = \"measured\", values = [], ^limits = \"8 g6\" }\n",
                        {"errors.linear.limits does not belong", "measured"});
}

/// The fake mechanism, with lengths bounded by the arm.
class BoundedModel final : public test::FakeModel {
 public:
  using FakeModel::FakeModel;

  ErrorBound error_bound(FactorIndex factor) const override {
    return factor.value == 1 ? ErrorBound{} : ErrorBound{kArm, "the arm"};
  }
};

TEST(Mean, CountsInWhatIsTooLarge) {
  Catalog catalog = test::fake_catalog();
  catalog[0].build = [](std::span<const double> geometry, std::size_t) {
    return std::make_unique<BoundedModel>(geometry[0]);
  };
  expect_errors_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", mean = ^\"-60 mm\" }\n",
                        {"errors.linear.mean gives delta_1 a mean of 60 mm, no less than the arm (60 mm)"}, catalog);
  expect_errors_refused("linear = { distribution = \"uniform\", half_width = \"50 mm\", mean = ^\"15 mm\" }\n",
                        {"errors.linear.mean gives delta_1 a largest error of 65 mm"}, catalog);
  expect_errors_refused("linear = { distribution = \"uniform\", limits = ^[\"-70 mm\", 0] }\n",
                        {"errors.linear.limits gives delta_1 a largest error of 70 mm"}, catalog);
  expect_errors_refused("linear = { distribution = \"uniform\", limits = ^[\"-170 mm\", 0] }\n",
                        {"errors.linear.limits gives delta_1 a mean of 85 mm"}, catalog);
  EXPECT_NO_THROW(
      study_of_errors("linear = { distribution = \"uniform\", half_width = \"50 mm\", mean = \"9 mm\" }\n", catalog));
}

TEST(DrawsOfAnError, AreReadWithPatternsAndComeBack) {
  const Study study = study_of_errors(
      "linear = { distribution = \"normal\", sigma = \"1 mm\", draws = \"per pose\" }\n"
      "override = { delta_2 = { draws = \"per machine\" }, \"epsilon_*\" = { distribution = \"uniform\", half_width = "
      "\"1 deg\", draws = \"per pose\" } }\n");
  EXPECT_EQ(study.errors.per_pose, (std::vector{FactorIndex(0), FactorIndex(1)}));
  EXPECT_EQ(study.errors.by_factor[2], Distribution::normal(1e-3));
  expect_comes_back(study);
  EXPECT_EQ(resolved_text(study_of_errors("")).find("per pose\" }"), std::string::npos);
  const Study again = study_of_errors("override = { delta_1 = { distribution = \"normal\", sigma = \"1 mm\" } }\n");
  EXPECT_TRUE(again.errors.per_pose.empty());
}

TEST(DrawsOfAnError, AreRefusedWhereTheyMakeNoSense) {
  expect_errors_refused("override = { delta_1 = { draws = ^\"per move\" } }\n",
                        {"errors.override.delta_1.draws is 'per move'", "per pose"});
  expect_errors_refused("override = { delta_1 = ^{ sigma = \"1 mm\", draws = \"per pose\" } }\n", {"distribution"});
  expect_errors_refused(
      "override = { delta_1 = { draws = \"per pose\" } }\n"
      "[[errors.correlated]]\nfactors = ^[\"delta_2\", \"delta_1\"]\ncorrelation = [[1, 0.5], [0.5, 1]]\n",
      {"has 'delta_1', which is drawn per pose, and 'delta_2', which is not", "give all of them the same draws"});
}

}  // namespace
}  // namespace poesy
