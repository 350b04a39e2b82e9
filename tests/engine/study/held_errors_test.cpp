#include "engine/study/study.h"

#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"

namespace poesy::test {
namespace {

Study study_with(const std::string& sections) {
  return study_of_text(
      "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\ncount = 3\n" + sections,
      "study.toml", kFakeCatalog, StudyUse::run);
}

/// A study with this background. By default it varies delta_1 and epsilon_1. errors: text of [errors].
Study held(const std::string& background, const std::string& errors = "",
           const std::string& factors = "\"deforming\"") {
  return study_with("[errors]\n" + errors + "[analysis]\nfactors = " + factors + "\nbackground = " + background + "\n");
}

TEST(BackgroundSize, IsThatOfTheErrorsUnlessItIsWritten) {
  const std::string errors =
      "linear = { distribution = \"normal\", sigma = \"20 um\" }\n"
      "angular = { distribution = \"normal\", sigma = \"0.01 deg\" }\n";
  const Background both = *held("{ factors = \"benign\" }", errors).analysis.background;
  EXPECT_DOUBLE_EQ(both.linear, 20e-6);
  EXPECT_DOUBLE_EQ(both.angular, parse_quantity("0.01 deg").si);
  const Background one = *held("{ factors = \"benign\", linear = \"3 mm\" }", errors).analysis.background;
  EXPECT_DOUBLE_EQ(one.linear, 3e-3);
  EXPECT_DOUBLE_EQ(one.angular, parse_quantity("0.01 deg").si);
}

TEST(BackgroundSize, IsOneMillimetreAndOneDegreeWhereErrorsSayNothing) {
  const Background background = *held("{ factors = \"all\" }").analysis.background;
  EXPECT_DOUBLE_EQ(background.linear, 1e-3);
  EXPECT_DOUBLE_EQ(background.angular, parse_quantity("1 deg").si);
}

/// A uniform error with the half-width w has the standard deviation w / sqrt(3), a triangular one w / sqrt(6).
TEST(BackgroundSize, IsTheStandardDeviationOfOtherDistributions) {
  const Background background = *held("{ factors = \"benign\" }",
                                      "linear = { distribution = \"uniform\", half_width = \"3 mm\" }\n"
                                      "angular = { distribution = \"triangular\", half_width = \"0.1 rad\" }\n"
                                      "override = { delta_2 = { distribution = \"normal\", sigma = \"9 mm\" } }\n")
                                     .analysis.background;
  EXPECT_NEAR(background.linear, 3e-3 / std::sqrt(3.0), 1e-15);
  EXPECT_NEAR(background.angular, 0.1 / std::sqrt(6.0), 1e-14);
}

TEST(BackgroundSize, IsWrittenInTheResolvedStudy) {
  const Study study = held("{ factors = \"benign\" }", "linear = { distribution = \"normal\", sigma = \"0.02 mm\" }\n");
  const std::string text = resolved_text(study);
  const std::string background = text.substr(text.find("[analysis.background]"));
  EXPECT_EQ(
      background.substr(0, background.find("\n\n")),
      "[analysis.background]\nfactors = \"benign\"\nlinear = \"2e-05 m\"\nangular = \"0.017453292519943295 rad\"");
}

/// A background value has no effect on an error that varies, so it must be refused instead of silently ignored.
TEST(BackgroundOfAnErrorThatVaries, IsRefusedAtItsName) {
  const auto refused = [](const std::string& analysis, const std::vector<std::string>& words) {
    const Marked marked(
        "format = \"poesy-study\"\nversion = 1\nmechanism.model = \"fake\"\nposes.count = 3\n[analysis]\n" + analysis);
    expect_input_error([&] { study_of_text(marked.text, "study.toml", kFakeCatalog, StudyUse::run); },
                       {"study.toml", marked.line, marked.column}, words);
  };
  const std::vector<std::string> words{"analysis.background.factors", "'delta_1'", "varies", "leave it out"};
  refused("factors = [\"delta_1\"]\nbackground = { factors = [\"delta_2\", ^\"delta_1\"], linear = \"-0.05 mm\" }\n",
          words);
  for (const std::string kind : {"monte-carlo", "sobol", "sensitivity"}) {
    refused("kind = \"" + kind + "\"\nfactors = \"all\"\nbackground = { factors = [^\"delta_1\"] }\n", words);
  }
  refused("factors = \"deforming\"\nbackground = { factors = ^\"deforming\" }\n", {"all vary", "leave it out"});
}

TEST(BackgroundOfAnErrorThatVaries, IsNoMistakeWhereASetHoldsOthers) {
  EXPECT_NO_THROW(held("{ factors = \"all\" }", "", "[\"delta_2\"]"));
  EXPECT_NO_THROW(
      study_with("[analysis]\nkind = \"evaluate\"\nbackground = { factors = [\"delta_1\"], linear = \"7 mm\" }\n"
                 "cases = [{ errors = { delta_1 = \"1 mm\" } }, { errors = { delta_2 = \"1 mm\" } }]\n"));
}

TEST(HeldErrorsText, NamesTheSetItsNumberAndTheSizes) {
  EXPECT_EQ(held_errors_text(held("{ factors = \"benign\" }")), "held constant: 1 error of set 'benign' at 1 mm");
  EXPECT_EQ(held_errors_text(held("{ factors = \"all\", linear = \"20 um\" }", "", "[\"delta_2\"]")),
            "held constant: 2 of the 3 errors of set 'all' at 0.02 mm and 1 deg");
}

TEST(HeldErrorsText, NamesErrorsThatAreNoSet) {
  EXPECT_EQ(held_errors_text(held("{ factors = [\"epsilon_1\", \"delta_2\"] }", "", "[\"delta_1\"]")),
            "held constant: epsilon_1 and delta_2 at 1 mm and 1 deg");
}

TEST(HeldErrorsText, IsEmptyWhereNothingIsHeld) {
  EXPECT_EQ(held_errors_text(study_with("")), "");
  EXPECT_EQ(held_errors_text(held("{ factors = \"benign\", linear = \"0 mm\" }")), "");
}

TEST(HeldErrorsText, OfCasesIsWhereTheySetNothing) {
  const Study study = study_with(
      "[analysis]\nkind = \"evaluate\"\nbackground = { factors = \"benign\", linear = \"7 mm\" }\n"
      "cases = [{ errors = { delta_1 = \"1 mm\" } }]\n");
  EXPECT_EQ(held_errors_text(study),
            "held constant, unless a case sets another value: 1 error of set 'benign' at 7 mm");
}

}  // namespace
}  // namespace poesy::test
