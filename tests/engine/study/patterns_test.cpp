#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"

// Tests patterns in place of names of errors. The mechanism has the errors delta_1, epsilon_1 and delta_2.
namespace poesy {
namespace {

std::string study_text(const std::string& rest) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 }\n" + rest;
}

Study read(const std::string& rest) {
  return study_of_text(study_text(rest), "study.toml", test::kFakeCatalog, StudyUse::run);
}

double sigma(const Study& study, std::size_t factor) { return study.errors.by_factor[factor].standard_deviation(); }

TEST(Patterns, OverrideAllErrorsThatMatch) {
  const Study study = read("[errors.override]\n\"delta_?\" = { distribution = \"normal\", sigma = \"2 mm\" }\n");
  EXPECT_DOUBLE_EQ(sigma(study, 0), 2e-3);
  EXPECT_DOUBLE_EQ(sigma(study, 1), sigma(read(""), 1));
  EXPECT_DOUBLE_EQ(sigma(study, 2), 2e-3);
  const std::string text = resolved_text(study);
  EXPECT_EQ(resolved_text(study_of_text(text, "again.toml", test::kFakeCatalog, StudyUse::run)), text);
}

TEST(Patterns, YieldToWhatComesLater) {
  const std::string all = "\"delta_*\" = { distribution = \"normal\", sigma = \"5 mm\" }\n";
  const std::string pattern = "\"*_2\" = { distribution = \"normal\", sigma = \"3 mm\" }\n";
  const std::string name = "delta_2 = { distribution = \"normal\", sigma = \"4 mm\" }\n";
  EXPECT_DOUBLE_EQ(sigma(read("[errors.override]\n" + all + name), 2), 4e-3);
  EXPECT_DOUBLE_EQ(sigma(read("[errors.override]\n" + all + pattern), 2), 3e-3);
}

/// A study that is read again from a result may have such keys.
TEST(Patterns, AreRefusedInARunWhereEarlierKeysHaveNoEffect) {
  const auto refused = [](const std::string& keys, const std::string& words) {
    const test::Marked text(study_text("[errors.override]\n" + keys));
    const auto read_for = [&](StudyUse use) { return study_of_text(text.text, "study.toml", test::kFakeCatalog, use); };
    test::expect_input_error([&] { read_for(StudyUse::run); }, {"study.toml", text.line, text.column},
                             {words, "write it after them"});
    EXPECT_NO_THROW(read_for(StudyUse::evaluate));
  };
  const std::string all = " = { distribution = \"normal\", sigma = \"1 mm\" }\n";
  refused("delta_2 = ^{ distribution = \"normal\", sigma = \"5 mm\" }\n\"delta_*\"" + all,
          "errors.override.delta_2 has no effect, because later keys, such as 'delta_*', are for all its errors");
  refused("\"delta_*\" = ^{ distribution = \"normal\", sigma = \"5 mm\" }\ndelta_1" + all + "delta_2" + all,
          "errors.override.delta_* has no effect, because later keys, such as 'delta_1', are for all its errors");
}

TEST(Patterns, NameTheErrorsThatVary) {
  using Positions = std::vector<FactorIndex>;
  EXPECT_EQ(read("analysis = { factors = [\"*_1\"] }\n").analysis.factors, (Positions{FactorIndex(0), FactorIndex(1)}));
  EXPECT_EQ(read("analysis = { factors = [\"delta_2\", \"delta_*\"] }\n").analysis.factors,
            (Positions{FactorIndex(2), FactorIndex(0)}));
}

TEST(Patterns, AreRefusedWhereTheyMatchNothing) {
  const auto refused = [](const std::string& marked, const std::vector<std::string>& words) {
    SCOPED_TRACE(marked);
    const test::Marked text(study_text(marked));
    test::expect_input_error([&] { study_of_text(text.text, "study.toml", test::kFakeCatalog, StudyUse::run); },
                             {"study.toml", text.line, text.column}, words);
  };
  refused("[errors.override]\n\"rod_*\" = ^{ distribution = \"normal\", sigma = \"1 mm\" }\n",
          {"errors.override.rod_* matches no error of the mechanism", "'poesy models fake'"});
  refused("[errors.override]\n^delta_3 = { distribution = \"normal\", sigma = \"1 mm\" }\n",
          {"unknown factor 'delta_3'"});
  refused("[errors.override]\n\"*_1\" = { distribution = \"normal\", sigma = ^\"1 mm\" }\n",
          {"errors.override.*_1.sigma", "angle"});
  refused("analysis = { factors = [^\"rod_*\"] }\n", {"analysis.factors[0] matches no error", "'poesy models fake'"});
  refused("analysis = { factors = [\"delta_*\", ^\"delta_1\"] }\n", {"a second time"});
}

}  // namespace
}  // namespace poesy
