#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"

namespace poesy {
namespace {

const Catalog kCatalog = test::fake_catalog();

std::string study_text(const std::string& errors) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 }\n[analysis]\n"
         "kind = \"monte-carlo\"\n[errors]\n" +
         errors;
}

Study read(const std::string& errors, const Catalog& catalog = kCatalog) {
  return study_of_text(study_text(errors), "study.toml", catalog, StudyUse::run);
}

void expect_refused(const std::string& marked, const std::vector<std::string>& words,
                    const Catalog& catalog = kCatalog) {
  const test::Marked text(study_text(marked));
  test::expect_input_error([&] { study_of_text(text.text, "study.toml", catalog, StudyUse::run); },
                           {"study.toml", text.line, text.column}, words);
}

TEST(Shift, IsReadForEveryShapeAndComesBack) {
  const Study study = read(
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
  const Study again = study_of_text(text, "again.toml", kCatalog, StudyUse::run);
  EXPECT_EQ(again.errors.by_factor, study.errors.by_factor);
  EXPECT_EQ(resolved_text(again), text);
  EXPECT_EQ(resolved_text(read("")).find("shift"), std::string::npos);
}

TEST(Shift, IsRefusedWhereItMakesNoSense) {
  expect_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", shift = ^\"-0.1 mm\" }\n",
                 {"errors.linear.shift is '-0.1 mm', below zero", "at least 0"});
  expect_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", shift = ^\"1 deg\" }\n",
                 {"errors.linear.shift", "must be a length"});
  expect_refused("linear = { distribution = \"measured\", values = [], ^shift = \"1 mm\" }\n",
                 {"errors.linear.shift does not belong", "measured"});
  expect_refused(
      "override = { delta_1 = { distribution = \"uniform\", half_width = \"1 mm\", shift = \"1 um\" } }\n"
      "[[errors.correlated]]\nfactors = ^[\"delta_2\", \"delta_1\"]\ncorrelation = [[1, 0.5], [0.5, 1]]\n",
      {"'delta_1', whose distribution has a shift"});
}

/// Lengths up to the arm make sense.
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
  expect_refused("linear = { distribution = \"uniform\", half_width = \"50 mm\", shift = ^\"15 mm\" }\n",
                 {"errors.linear.shift gives delta_1 a largest error of 65 mm, no less than the arm (60 mm)"}, catalog);
  expect_refused("linear = { distribution = \"uniform\", half_width = ^\"60 mm\", shift = \"15 mm\" }\n",
                 {"errors.linear.half_width gives delta_1 a largest error of 75 mm"}, catalog);
  expect_refused("linear = { distribution = \"normal\", sigma = \"1 mm\", shift = ^\"60 mm\" }\n",
                 {"errors.linear.shift gives delta_1 a standard deviation of"}, catalog);
  EXPECT_NO_THROW(read("linear = { distribution = \"uniform\", half_width = \"50 mm\", shift = \"9 mm\" }\n", catalog));
}

}  // namespace
}  // namespace poesy
