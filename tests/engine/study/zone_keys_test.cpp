#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"

// Features of a drawing that scatter in their zones. The mechanism has delta_1, epsilon_1 and delta_2.
namespace poesy {
namespace {

/// A mechanism with an axis, whose middle is delta_1 and whose tilt is delta_2.
Catalog with_axis(const Zone& location) {
  Catalog catalog = test::fake_catalog();
  Feature axis{.name = "bore_1", .label = "bore", .limb = 1, .frame = 0, .kind = FeatureKind::axis, .size = {0.04}};
  axis.middle = {FactorIndex(0)};
  axis.tilt = {FactorIndex(2)};
  axis.location = location;
  catalog.front().description.features = {axis};
  return catalog;
}

const Catalog kCatalog = with_axis({"position", 5e-5, "A|B"});

std::string study_text(const std::string& rest) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 }\n" + rest;
}

Study read(const std::string& rest) { return study_of_text(study_text(rest), "study.toml", kCatalog, StudyUse::run); }

double sigma(const Study& study, std::size_t factor) { return study.errors.by_factor[factor].standard_deviation(); }

TEST(ZoneKeys, GiveTheStandardDeviationsOfTheZone) {
  const Study study = read("errors.zones = { distribution = \"normal\", sigmas = 3 }\n");
  EXPECT_NEAR(sigma(study, 0), 5.8925565099e-6, 1e-16);
  EXPECT_NEAR(sigma(study, 2), 11.7851130198e-6, 1e-16);
  EXPECT_EQ(sigma(study, 1), sigma(read(""), 1));
  const Study by_cpk = read("errors.zones = { distribution = \"normal\", cpk = 2 }\n");
  EXPECT_NEAR(sigma(by_cpk, 0), 0.5 * sigma(study, 0), 1e-18);
  const Study by_share = read("errors.zones = { distribution = \"normal\", within = 0.99 }\n");
  EXPECT_NEAR(sigma(by_share, 0), 3.0 / 3.0348542587702925 * sigma(study, 0), 1e-17);
}

TEST(ZoneKeys, YieldToAnErrorsOwnDistribution) {
  const Study study = read(
      "[errors]\nlinear = { distribution = \"normal\", sigma = \"2 mm\" }\n"
      "override = { delta_2 = { distribution = \"normal\", sigma = \"3 mm\" } }\n"
      "zones = { distribution = \"normal\", sigmas = 3 }\n");
  EXPECT_NEAR(sigma(study, 0), 5.8925565099e-6, 1e-16);
  EXPECT_DOUBLE_EQ(sigma(study, 2), 3e-3);
}

TEST(ZoneKeys, AreReadBackFromTheirText) {
  for (const char* use : {"sigmas = 4", "cpk = 1.1", "within = \"99.73 %\""}) {
    const Study study = read(std::string("errors.zones = { distribution = \"normal\", ") + use + " }\n");
    const std::string text = resolved_text(study);
    EXPECT_EQ(text.find("[errors.override]"), std::string::npos) << text;
    const Study again = study_of_text(text, "again.toml", kCatalog, StudyUse::run);
    EXPECT_EQ(again.errors.by_factor, study.errors.by_factor) << use;
    EXPECT_EQ(resolved_text(again), text);
  }
}

TEST(ZoneKeys, AreRefusedWithPlaceAndRemedy) {
  const auto refused = [](const std::string& marked, const std::vector<std::string>& words,
                          const Catalog& catalog = kCatalog) {
    SCOPED_TRACE(marked);
    const test::Marked text(study_text(marked));
    test::expect_input_error([&] { study_of_text(text.text, "study.toml", catalog, StudyUse::run); },
                             {"study.toml", text.line, text.column}, words);
  };
  refused("errors.zones = ^{ distribution = \"normal\" }\n", {"errors.zones does not say", "sigmas = 3"});
  refused("errors.zones = ^{ distribution = \"normal\", sigmas = 3, cpk = 1 }\n", {"says twice"});
  refused("errors.zones = { distribution = ^\"boundary\", sigmas = 3 }\n", {"errors.zones.distribution is 'boundary'"});
  refused("errors.zones = ^{ sigmas = 3 }\n", {"'distribution' is missing", "distribution = \"normal\""});
  refused("errors.zones = { distribution = \"normal\", sigmas = ^0 }\n", {"errors.zones.sigmas is 0"});
  refused("errors.zones = { distribution = \"normal\", cpk = ^-1 }\n", {"errors.zones.cpk is -1"});
  refused("errors.zones = { distribution = \"normal\", within = ^1 }\n", {"errors.zones.within is 1"});
  refused("errors.zones = { distribution = \"normal\", within = ^\"120 %\" }\n", {"errors.zones.within"});
  refused("errors.zones = { distribution = \"normal\", ^sigma = 3 }\n", {"unknown key 'sigma'", "sigmas"});
  refused("errors.zones = ^3\n", {"errors.zones is the whole number 3"});
  refused("errors.zones = ^{ distribution = \"normal\", sigmas = 3 }\n", {"fake", "has no features"},
          test::fake_catalog());
}

}  // namespace
}  // namespace poesy
