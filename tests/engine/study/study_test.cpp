#include "engine/study/study.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"

namespace poesy {
namespace {

TEST(BuildModel, TellsWhereAnImpossibleGeometryStands) {
  const Catalog catalog = test::fake_catalog();
  const MechanismChoice choice{&catalog[0], {-1.0}, 0, {"study.toml", 5, 12}};
  test::expect_input_error([&] { build_model(choice); }, choice.place, {"arm must be greater than zero"});
}

TEST(BuildModel, PassesTheGeometryOn) {
  const Catalog catalog = test::fake_catalog();
  const auto model = build_model({&catalog[0], {0.5}, 0, {}});
  const std::vector<double> pose{-0.2, 0.1, 0.1};
  const std::vector<double> errors{1e-3, 0.0, 0.0};
  std::vector<double> responses(2);
  std::vector<SolveStatus> status(1);
  std::vector<std::uint32_t> iterations(1);
  model->evaluator({})->evaluate({pose, errors, {}, {}, 1}, {responses, status, iterations, {}});
  EXPECT_DOUBLE_EQ(responses[0], 0.5 * 2.0 * 1.5 * 1e-3);
}

TEST(BackgroundErrors, ApplyByDimensionAndOnlyToTheirFactors) {
  const Catalog catalog = test::fake_catalog();
  Study study;
  study.mechanism.entry = &catalog[0];
  EXPECT_EQ(background_errors(study.analysis.background, study.model()), (std::vector<double>{0.0, 0.0, 0.0}));
  study.analysis.background = Background{{FactorIndex(1), FactorIndex(2)}, 1e-3, 2e-2};
  EXPECT_EQ(background_errors(study.analysis.background, study.model()), (std::vector<double>{0.0, 2e-2, 1e-3}));
}

TEST(AskedOf, GivesDefaultsUntilSomethingIsAsked) {
  struct Options {
    int number = 3;
  };
  Analysis analysis;
  EXPECT_EQ(asked_of<Options>(std::as_const(analysis)).number, 3);
  EXPECT_FALSE(analysis.asked.has_value());
  asked_of<Options>(analysis).number = 4;
  const Analysis copy = analysis;
  asked_of<Options>(analysis).number = 5;
  EXPECT_EQ(asked_of<Options>(copy).number, 4);
}

TEST(Names, AreThoseOfTheStudyFile) {
  using Select = PoseSelection::Select;
  EXPECT_EQ(name(Select::interior), "interior");
  EXPECT_EQ(name(Select::file), "file");
  EXPECT_EQ(name(Select::boundary), "boundary");
  EXPECT_EQ(name(Select::grid), "grid");
  EXPECT_EQ(name(Select::trajectory), "trajectory");
  EXPECT_EQ(name(NotConverged::exclude), "exclude");
  EXPECT_EQ(name(NotConverged::include), "include");
  EXPECT_EQ(name(SolverOptions::Method::newton), "newton");
  EXPECT_EQ(name(SolverOptions::Method::gauss_newton), "gauss-newton");
}

}  // namespace
}  // namespace poesy
