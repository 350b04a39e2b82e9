#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "engine/report/tables.h"
#include "engine/study/study.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

/// The fake mechanism with responses of these dimensions, e.g. forces.
Catalog catalog_of(Dimension first, Dimension second) {
  Catalog catalog = test::fake_catalog();
  catalog[0].description.responses = {{"load", first, "first response"}, {"other", second, "second response"}};
  return catalog;
}

const Catalog kMoment = catalog_of(Dimension::moment, Dimension::energy);
const Catalog kForce = catalog_of(Dimension::force, Dimension::number);

Study with_limits(const Catalog& catalog, const std::string& limits) {
  const test::TempFolder folder;
  return read_study(
      folder.write("study.toml",
                   "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n"
                   "[poses]\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per pose\"\nlimits = { " +
                       limits + " }\n"),
      catalog, StudyUse::run);
}

std::string refusal(const Catalog& catalog, const std::string& limits) {
  return test::refusal_of([&] { with_limits(catalog, limits); });
}

TEST(ResponseUnits, LimitsAreForcesMomentsAndEnergies) {
  const Study study = with_limits(kMoment, "load = \"2 N mm\", other = \"3 mJ\"");
  ASSERT_EQ(study.analysis.limits.size(), 2u);
  EXPECT_DOUBLE_EQ(study.analysis.limits[0].allowed.to(), 2e-3);
  EXPECT_DOUBLE_EQ(study.analysis.limits[1].allowed.to(), 3e-3);
  EXPECT_DOUBLE_EQ(with_limits(kForce, "load = \"5 kN\"").analysis.limits[0].allowed.to(), 5e3);
  const std::string text = resolved_text(study);
  EXPECT_NE(text.find("limits.load = \"0.002 N m\"\nlimits.other = \"0.003 J\"\n"), std::string::npos) << text;
}

TEST(ResponseUnits, AreNamedInRefusals) {
  for (const auto& [limits, words] : std::vector<std::pair<std::string, std::string>>{
           {"load = \"2 N\"", "load is '2 N', but must be a moment; write it like \"1 N m\""},
           {"load = \"2 Nm\"", "'2 Nm' (known: N m, N mm, kN m); did you mean 'N m'?"},
           {"load = \"2 n MM\"", "(known: N m, N mm, kN m); did you mean 'N mm'?"},
           {"load = 2", "load is the bare number 2; write it with a unit, e.g. \"1 N m\""},
           {"other = \"2 N\"", "other is '2 N', but must be an energy; write it like \"1 J\""},
           {"other = \"2 j\"", "(known: J, mJ, uJ); did you mean 'J'?"}}) {
    EXPECT_NE(refusal(kMoment, limits).find(words), std::string::npos) << refusal(kMoment, limits);
  }
}

TEST(ResponseUnits, AreListedByTemplatesOfModelsThatHaveThem) {
  const std::string usual = "m, cm, mm, um, in, mil, thou, rad, mrad, deg, arcmin, arcsec, s, ms, min, h";
  const auto begins = [&](const Catalog& catalog, const std::string& more) {
    const std::string text = template_text(catalog[0], monte_carlo::kStudy);
    EXPECT_NE(text.find("# Quantities are texts with a unit: " + usual + more + ".\n"), std::string::npos) << text;
  };
  begins(test::fake_catalog(), "");
  begins(kForce, ", N, kN");
  EXPECT_NE(template_text(kMoment[0], monte_carlo::kStudy).find("limits = { load = \"0.05 N m\" }"), std::string::npos);
  EXPECT_NE(model_text(kMoment[0]).find("  load                  N m first response\n"), std::string::npos);
}

}  // namespace
}  // namespace poesy
