#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "engine/study/study.h"
#include "tests/engine/study/valid_study.h"
#include "tests/support/fake_model.h"
#include "tests/support/kinds.h"
#include "tests/support/names.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

Study study_of(std::string_view text, StudyUse use = StudyUse::run) {
  const test::TempFolder folder;
  folder.write("poses.csv", "z,beta,gamma\n-0.2,0,0\n");
  return read_study(folder.write("study.toml", text), test::kFakeCatalog, use);
}

std::string shortest_study(std::string_view rest) {
  return "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n" + std::string(rest);
}

void expect_same(const identification::Options& a, const identification::Options& b) {
  EXPECT_EQ(a.pose_share, b.pose_share);
  ASSERT_EQ(a.groups.size(), b.groups.size());
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    EXPECT_EQ(a.groups[g].name, b.groups[g].name);
    EXPECT_EQ(a.groups[g].linear, b.groups[g].linear);
    EXPECT_EQ(a.groups[g].angular, b.groups[g].angular);
  }
}

void expect_same(const evaluate::CaseOptions& a, const evaluate::CaseOptions& b) {
  ASSERT_EQ(a.cases.size(), b.cases.size());
  for (std::size_t c = 0; c < a.cases.size(); ++c) {
    EXPECT_EQ(a.cases[c].name, b.cases[c].name);
    EXPECT_EQ(a.cases[c].errors, b.cases[c].errors);
  }
}

void expect_same(const sensitivity::Options& a, const sensitivity::Options& b) {
  EXPECT_EQ(a.linearity, b.linearity);
  ASSERT_EQ(a.reference.has_value(), b.reference.has_value());
  if (!a.reference) return;
  EXPECT_EQ(a.reference->factor, b.reference->factor);
  EXPECT_EQ(a.reference->tolerance, b.reference->tolerance);
}

void expect_same(const monte_carlo::Options& a, const monte_carlo::Options& b) {
  EXPECT_EQ(a.quantiles, b.quantiles);
  EXPECT_EQ(a.judge, b.judge);
  EXPECT_EQ(a.share, b.share);
  EXPECT_EQ(a.yield, b.yield);
}

template <class Options>
void expect_same_options(const Analysis& a, const Analysis& b) {
  expect_same(asked_of<Options>(a), asked_of<Options>(b));
}

void expect_same_asked(const Analysis& a, const Analysis& b) {
  if (a.kind == &sensitivity::kStudy) expect_same_options<sensitivity::Options>(a, b);
  if (a.kind == &identification::kStudy) expect_same_options<identification::Options>(a, b);
  if (a.kind == &evaluate::kStudy) expect_same_options<evaluate::CaseOptions>(a, b);
  if (a.kind == &monte_carlo::kStudy) expect_same_options<monte_carlo::Options>(a, b);
}

void expect_same(const Study& a, const Study& b) {
  EXPECT_EQ(a.title, b.title);
  EXPECT_EQ(a.mechanism.geometry, b.mechanism.geometry);
  EXPECT_EQ(a.poses.select, b.poses.select);
  EXPECT_EQ(a.poses.count, b.poses.count);
  EXPECT_EQ(a.poses.file, b.poses.file);
  ASSERT_EQ(a.poses.workspace.size(), b.poses.workspace.size());
  for (std::size_t c = 0; c < a.poses.workspace.size(); ++c) {
    EXPECT_EQ(a.poses.workspace[c].lower, b.poses.workspace[c].lower);
    EXPECT_EQ(a.poses.workspace[c].upper, b.poses.workspace[c].upper);
  }
  EXPECT_EQ(a.poses.grid_counts, b.poses.grid_counts);
  EXPECT_EQ(a.poses.max_condition, b.poses.max_condition);
  ASSERT_EQ(a.poses.limits.size(), b.poses.limits.size());
  for (std::size_t k = 0; k < a.poses.limits.size(); ++k) {
    EXPECT_EQ(a.poses.limits[k].joint, b.poses.limits[k].joint);
    EXPECT_EQ(a.poses.limits[k].range.lower, b.poses.limits[k].range.lower);
    EXPECT_EQ(a.poses.limits[k].range.upper, b.poses.limits[k].range.upper);
  }
  for (std::size_t f = 0; f < a.errors.by_factor.size(); ++f) {
    EXPECT_EQ(a.errors.by_factor[f].shape(), b.errors.by_factor[f].shape());
    EXPECT_EQ(a.errors.by_factor[f].sigma(), b.errors.by_factor[f].sigma());
    EXPECT_EQ(a.errors.by_factor[f].half_width(), b.errors.by_factor[f].half_width());
  }
  EXPECT_EQ(a.analysis.kind, b.analysis.kind);
  expect_same_asked(a.analysis, b.analysis);
  EXPECT_EQ(a.analysis.factors, b.analysis.factors);
  EXPECT_EQ(a.analysis.samples, b.analysis.samples);
  EXPECT_EQ(a.analysis.conf_level, b.analysis.conf_level);
  EXPECT_EQ(a.analysis.draws, b.analysis.draws);
  EXPECT_EQ(background_errors(a.analysis.background, a.model()), background_errors(b.analysis.background, b.model()));
  ASSERT_EQ(a.analysis.limits.size(), b.analysis.limits.size());
  for (std::size_t k = 0; k < a.analysis.limits.size(); ++k) {
    EXPECT_EQ(a.analysis.limits[k].response, b.analysis.limits[k].response);
    EXPECT_EQ(a.analysis.limits[k].allowed, b.analysis.limits[k].allowed);
  }
  EXPECT_EQ(a.solver.tolerance, b.solver.tolerance);
  EXPECT_EQ(a.solver.max_iterations, b.solver.max_iterations);
  EXPECT_EQ(a.not_converged, b.not_converged);
  EXPECT_EQ(a.max_not_converged, b.max_not_converged);
  EXPECT_EQ(a.seed, b.seed);
}

class ResolvedText : public testing::TestWithParam<std::string> {};

TEST_P(ResolvedText, ReadsBackToTheSameStudy) {
  const Study study = study_of(GetParam());
  const std::string text = resolved_text(study);
  const Study again = study_of(text);
  expect_same(study, again);
  EXPECT_EQ(resolved_text(again), text);
}

INSTANTIATE_TEST_SUITE_P(
    Studies, ResolvedText,
    testing::Values(
        std::string(test::kValidStudy), shortest_study("[poses]\ncount = 3\n"),
        shortest_study("[poses]\ncount = 3\nmax_condition = 1234.5\n"
                       "limits = { q_2 = [\"-60 deg\", \"0.7 rad\"], q_1 = [\"0 mm\", \"250.1 mm\"] }\n"),
        shortest_study("[poses]\nselect = \"boundary\"\ncount = 692\nlimits = { q_1 = [\"0 mm\", \"250 mm\"] }\n"),
        shortest_study("[poses]\nselect = \"grid\"\ncount = 158\n"),
        shortest_study("[poses]\nselect = \"grid\"\ncount = { gamma = 7, z = 1, beta = 5 }\nmax_condition = 1e3\n"),
        shortest_study("[poses]\nselect = \"file\"\nfile = \"poses.csv\"\n"),
        shortest_study("[poses]\ncount = 3\n[errors.override]\ndelta_1 = { distribution = \"triangular\", "
                       "half_width = \"0.123456789012345678 mm\" }\n"),
        shortest_study("[poses]\ncount = 3\n[analysis]\nfactors = [\"epsilon_1\"]\n"
                       "background = { factors = [\"delta_2\", \"delta_1\"], linear = \"-1 um\" }\n"),
        shortest_study("[poses]\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per pose\"\njudge = "
                       "\"share\"\nshare = 0.9973\n"
                       "[analysis.limits]\nangular_deformation = \"0.1 deg\"\n"),
        shortest_study("[poses]\ncount = 3\n[analysis]\nkind = \"monte-carlo\"\ndraws = \"per machine\"\n"
                       "yield = 0.99\n[analysis.limits]\nangular_deformation = \"0.1 deg\"\n"),
        shortest_study("[poses]\ncount = 3\n[analysis]\nkind = \"evaluate\"\n"
                       "limits = { angular_deformation = \"0.1 deg\" }\n"
                       "cases = [{ errors = { linear = \"1 mm\" } }]\n"),
        "title = \"quotes \\\" backslash \\\\ line \\n control \\u0001\\u007f and \xC2\xB5\"\n" +
            shortest_study("[poses]\ncount = 3\n")),
    test::named({"Whole", "Shortest", "Limits", "Boundary", "Grid", "GridCounts", "File", "Override", "Background",
                 "LimitsByShare", "LimitsByYield", "LimitsOfCases", "Title"}));

TEST(ResolvedTextOf, TheShortestStudyShowsEveryDefault) {
  EXPECT_EQ(resolved_text(study_of(shortest_study("[poses]\ncount = 3\n"))), R"(format = "poesy-study"
version = 1
title = ""

[mechanism]
model = "fake"

[mechanism.geometry]
arm = "0.06 m"

[poses]
select = "interior"
count = 3
workspace = { z = ["-0.3 m", "-0.18 m"], beta = ["-0.5 rad", "0.5 rad"], gamma = ["-0.6 rad", "0.6 rad"] }
max_condition = 1e+08

[errors]
linear = { distribution = "normal", sigma = "0.001 m" }
angular = { distribution = "normal", sigma = "0.017453292519943295 rad" }

[analysis]
kind = "sensitivity"
factors = "deforming"
samples = 1000
conf_level = 0.95

[solver]
method = "newton"
tolerance = 1e-15
max_iterations = 50
not_converged = "exclude"
max_not_converged = 1

[run]
seed = 1
)");
}

TEST(ResolvedTextOf, AGridUnderLimitsShowsThem) {
  const std::string text = resolved_text(study_of(
      shortest_study("[poses]\nselect = \"grid\"\ncount = { z = 1, gamma = 7, beta = 5 }\nmax_condition = 1e6\n"
                     "limits = { q_2 = [\"-1 rad\", \"0.5 rad\"], q_1 = [\"-50 mm\", \"80 mm\"] }\n")));
  EXPECT_NE(text.find("count = { z = 1, beta = 5, gamma = 7 }\n"), std::string::npos) << text;
  EXPECT_NE(text.find("limits = { q_1 = [\"-0.05 m\", \"0.08 m\"], q_2 = [\"-1 rad\", \"0.5 rad\"] }\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("max_condition = 1e+06\n"), std::string::npos) << text;
}

TEST(ResolvedTextOf, AStudyToEvaluateReadsBackToEvaluate) {
  const Study study = study_of(shortest_study("[solver]\nmax_iterations = 7\n"), StudyUse::evaluate);
  const std::string text = resolved_text(study);
  EXPECT_EQ(resolved_text(study_of(text, StudyUse::evaluate)), text);
}

TEST(SetName, IsTheSetThatEqualsTheFactorsInOrder) {
  ModelDescription model = test::kFakeCatalog[0].description;
  const std::vector<FactorIndex> all{FactorIndex(0), FactorIndex(1), FactorIndex(2)};
  const std::vector<FactorIndex> reversed{FactorIndex(1), FactorIndex(0)};
  EXPECT_EQ(set_name(all, model), "all");
  EXPECT_EQ(set_name(reversed, model), "");
  model.factor_sets.clear();
  EXPECT_EQ(set_name(all, model), "all");
  EXPECT_EQ(set_name(reversed, model), "");
}

TEST(ReadableValue, IsExactAndShort) {
  EXPECT_EQ(readable_value(0.06, Dimension::length), "\"60 mm\"");
  EXPECT_EQ(readable_value(-0.18, Dimension::length), "\"-180 mm\"");
  EXPECT_EQ(readable_value(0.5, Dimension::angle), "\"0.5 rad\"");
  EXPECT_EQ(readable_value(display_unit(Dimension::angle).si, Dimension::angle), "\"1 deg\"");
  EXPECT_EQ(readable_value(1.0 / 3.0, Dimension::length), "\"0.3333333333333333 m\"");
  EXPECT_EQ(readable_value(2.5, Dimension::number), "2.5");
}

TEST(Template, RunsAsItIsAndAsksForTheUsualStudy) {
  const Study study = study_of(template_text(test::kFakeCatalog[0], sensitivity::kStudy));
  const Study usual = study_of("title = \"Sensitivity of fake\"\n" +
                               shortest_study("[poses]\ncount = 158\n[analysis]\nbackground = { factors = "
                                              "\"benign\", linear = \"1 mm\", angular = \"1 deg\" }\n"));
  expect_same(study, usual);
}

TEST(Template, RunsForAModelWithoutSetsAndGeometry) {
  Catalog catalog = test::kFakeCatalog;
  catalog[0].description.factor_sets.clear();
  catalog[0].description.geometry.clear();
  catalog[0].description.workspace_note = "two\nlines";
  catalog[0].build = [](std::span<const double>, std::size_t) { return std::make_unique<test::FakeModel>(); };
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", template_text(catalog[0], sensitivity::kStudy));
  const Study study = read_study(path, catalog, StudyUse::run);
  EXPECT_EQ(study.analysis.factors.size(), 3u);
  EXPECT_FALSE(study.analysis.background);
}

TEST(Template, NamesEveryKey) {
  const std::string text = template_text(test::kFakeCatalog[0], sensitivity::kStudy);
  for (const char* key : {"format = ",        "version = ",
                          "title = ",         "model = ",
                          "arm = ",           "select = ",
                          "count = ",         "workspace = ",
                          "file = ",          "linear = ",
                          "angular = ",       "override = ",
                          "sigma = ",         "half_width = ",
                          "kind = ",          "factors = ",
                          "samples = ",       "conf_level = ",
                          "background = ",    "method = ",
                          "tolerance = ",     "max_iterations = ",
                          "not_converged = ", "max_not_converged = ",
                          "seed = ",          "normal",
                          "truncated-normal", "uniform",
                          "triangular",       "exclude",
                          "include",          "interior",
                          "boundary",         "grid",
                          "limits = ",        "trajectory = ",
                          "curve = ",         "origin = ",
                          "points = ",        "time = ",
                          "max_condition = "}) {
    EXPECT_NE(text.find(key), std::string::npos) << key;
  }
}

/// Each trajectory that a template shows as a comment can be read if it replaces the workspace.
TEST(Template, ShowsTrajectoriesThatRead) {
  const std::string text = template_text(test::kFakeCatalog[0], sensitivity::kStudy);
  std::size_t shown = 0;
  for (std::size_t at = text.find("# trajectory = "); at != std::string::npos;
       at = text.find("# trajectory = ", at + 1)) {
    const std::string line = text.substr(at + 2, text.find('\n', at) - at - 2);
    const Study study =
        study_of(shortest_study("[poses]\nselect = \"trajectory\"\n" + line + "\n"), StudyUse::evaluate);
    EXPECT_EQ(study.poses.count, 201u);
    ++shown;
  }
  EXPECT_EQ(shown, 2u);
}

}  // namespace
}  // namespace poesy
