#include <gtest/gtest.h>

#include <numbers>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::string with_analysis(std::string_view analysis) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 "
         "}\n[analysis]\n" +
         std::string(analysis);
}

Study study_of(std::string_view analysis, StudyUse use = StudyUse::run) {
  const test::TempFolder folder;
  return read_study(folder.write("study.toml", with_analysis(analysis)), test::kFakeCatalog, use);
}

TEST(StudyOfCases, SetsErrorsFromWideToNarrow) {
  const Study study = study_of(R"(kind = "evaluate"
background = { factors = ["delta_2"], linear = "7 mm" }
[[analysis.cases]]
name = "all"
errors = { linear = "1 mm", angular = "1 deg" }
[[analysis.cases]]
errors = { delta_1 = "-0.5 mm", linear = "1 mm", deforming = { linear = "2 mm", angular = "3 deg" } }
[[analysis.cases]]
errors = { epsilon_1 = "1 deg" }
)");
  const std::vector<evaluate::ErrorCase>& cases = asked_of<evaluate::CaseOptions>(study.analysis).cases;
  ASSERT_EQ(cases.size(), 3u);
  EXPECT_EQ(cases[0].name, "all");
  EXPECT_EQ(cases[0].errors, (std::vector<double>{1e-3, kDegree, 1e-3}));
  EXPECT_EQ(cases[1].name, "case 2");
  EXPECT_EQ(cases[1].errors, (std::vector<double>{-0.5e-3, 3 * kDegree, 1e-3}));
  EXPECT_EQ(cases[2].errors, (std::vector<double>{0.0, kDegree, 7e-3}));
}

TEST(StudyOfCases, LetsANarrowerSetWinWhateverItsPlaceInTheModel) {
  const Study study = study_of(R"(kind = "evaluate"
[[analysis.cases]]
errors = { all = { linear = "1 mm", angular = "1 deg" }, deforming = { linear = "2 mm" } }
)");
  EXPECT_EQ(asked_of<evaluate::CaseOptions>(study.analysis).cases[0].errors,
            (std::vector<double>{2e-3, kDegree, 1e-3}));
  Catalog wide_last = test::fake_catalog();
  std::swap(wide_last.front().description.factor_sets[0], wide_last.front().description.factor_sets[1]);
  const test::TempFolder folder;
  const std::string path = folder.write(
      "study.toml", with_analysis("kind = \"evaluate\"\ncases = [{ errors = { all = { linear = \"1 mm\" }, deforming = "
                                  "{ linear = \"2 mm\" } } }]\n"));
  EXPECT_EQ(asked_of<evaluate::CaseOptions>(read_study(path, wide_last, StudyUse::run).analysis).cases[0].errors,
            (std::vector<double>{2e-3, 0.0, 1e-3}));
}

TEST(StudyOfCases, RefusesSetsThatOverlap) {
  Catalog overlapping = test::fake_catalog();
  overlapping.front().description.factor_sets.push_back({"lengths", "", {FactorIndex(0), FactorIndex(2)}});
  const test::Marked bad(
      with_analysis("kind = \"evaluate\"\ncases = [{ errors = { lengths = ^{ linear = \"1 mm\" }, deforming = { linear "
                    "= \"2 mm\" } } }]"));
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", bad.text);
  test::expect_input_error([&] { read_study(path, overlapping, StudyUse::run); }, {path, bad.line, bad.column},
                           {"lengths", "deforming", "neither lies inside"});
}

TEST(StudyOfCases, NeedsNoCasesForATableOfErrors) {
  const Study study = study_of("kind = \"evaluate\"\n", StudyUse::evaluate);
  EXPECT_TRUE(asked_of<evaluate::CaseOptions>(study.analysis).cases.empty());
}

TEST(StudyOfIdentification, TakesGroupsAndShare) {
  const Study study = study_of(R"(kind = "identification"
pose_share = 0.9
groups = [{ name = "large", linear = "5 mm", angular = "0.005 rad" }, { linear = "1 mm", angular = "1 deg" }]
)");
  ASSERT_EQ(asked_of<identification::Options>(study.analysis).groups.size(), 2u);
  EXPECT_EQ(asked_of<identification::Options>(study.analysis).groups[0].name, "large");
  EXPECT_EQ(asked_of<identification::Options>(study.analysis).groups[0].angular, 0.005);
  EXPECT_EQ(asked_of<identification::Options>(study.analysis).groups[1].name, "group 2");
  EXPECT_EQ(asked_of<identification::Options>(study.analysis).pose_share, 0.9);
  EXPECT_EQ(study.analysis.factors.size(), 3u);
}

TEST(StudyOfIdentification, HasOneGroupUnlessToldOtherwise) {
  const Study study = study_of("kind = \"identification\"\n");
  ASSERT_EQ(asked_of<identification::Options>(study.analysis).groups.size(), 1u);
  EXPECT_EQ(asked_of<identification::Options>(study.analysis).groups[0].linear, 1e-3);
  EXPECT_DOUBLE_EQ(asked_of<identification::Options>(study.analysis).groups[0].angular, kDegree);
}

TEST(StudyOfIdentification, NeedsAModelInWhichSomethingDeforms) {
  Catalog rigid = test::fake_catalog();
  rigid.front().description.deformation.reset();
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", with_analysis("kind = \"identification\"\n"));
  test::expect_input_error([&] { read_study(path, rigid, StudyUse::run); }, {path, 6, 8},
                           {"analysis.kind", "nothing deforms in model \"fake\""});
}

TEST(StudyOfMonteCarlo, TakesQuantilesAndVariesAll) {
  const Study usual = study_of("kind = \"monte-carlo\"\n");
  EXPECT_EQ(asked_of<monte_carlo::Options>(usual.analysis).quantiles, (std::vector<double>{0.05, 0.5, 0.95}));
  const Study study = study_of("kind = \"monte-carlo\"\nquantiles = [0.01, 0.99]\n");
  EXPECT_EQ(asked_of<monte_carlo::Options>(study.analysis).quantiles, (std::vector<double>{0.01, 0.99}));
  EXPECT_EQ(study.analysis.factors.size(), 3u);
}

TEST(StudyOfMonteCarlo, SolvesSamplesAtEachPoseWhateverItsQuantiles) {
  // At most 10^15 solves are allowed; the study has three poses.
  EXPECT_EQ(study_of("kind = \"monte-carlo\"\nsamples = 333333333333333\n").analysis.samples, 333333333333333u);
  const test::TempFolder folder;
  const std::string path =
      folder.write("study.toml", with_analysis("kind = \"monte-carlo\"\nsamples = 333333333333334\n"));
  test::expect_input_error([&] { read_study(path, test::kFakeCatalog, StudyUse::run); }, {path, 5, 1},
                           {"poses times samples is", "at most 1000000000000000", "fewer samples"});
}

TEST(StudyOfSensitivity, TakesAReference) {
  const Study study = study_of("reference = { factor = \"epsilon_1\", tolerance = \"2 deg\" }\n");
  ASSERT_TRUE(asked_of<sensitivity::Options>(study.analysis).reference);
  EXPECT_EQ(asked_of<sensitivity::Options>(study.analysis).reference->factor, FactorIndex(1));
  EXPECT_DOUBLE_EQ(asked_of<sensitivity::Options>(study.analysis).reference->tolerance, 2 * kDegree);
  const Study usual = study_of("reference = { factor = \"delta_1\" }\n");
  EXPECT_EQ(asked_of<sensitivity::Options>(usual.analysis).reference->tolerance, 1e-3);
}

TEST(StudyOfAnyKind, KeepsFactorsAndSamplesOfAnother) {
  for (const std::string kind : {"sensitivity", "identification", "monte-carlo"}) {
    EXPECT_EQ(study_of("kind = \"" + kind + "\"\nfactors = [\"delta_1\"]\nsamples = 7\n").analysis.factors.size(), 1u);
  }
  study_of("kind = \"evaluate\"\nsamples = 7\nfactors = \"all\"\ncases = [{ errors = { linear = \"1 mm\" } }]\n");
}

TEST(StudyKinds, HaveNames) {
  EXPECT_EQ(names(study_kinds()), (std::vector<std::string_view>{"sensitivity", "identification", "evaluate",
                                                                 "monte-carlo", "sobol", "allocation", "coupling"}));
  EXPECT_EQ(find(study_kinds(), "monte-carlo"), &monte_carlo::kStudy);
  EXPECT_EQ(find(study_kinds(), "monte_carlo"), nullptr);
}

TEST(Template, RunsForEveryKind) {
  const test::TempFolder folder;
  for (const StudyKind* kind : study_kinds().all) {
    const std::string path = folder.write("study.toml", template_text(test::kFakeCatalog.front(), *kind));
    EXPECT_EQ(read_study(path, test::kFakeCatalog, StudyUse::run).analysis.kind, kind);
  }
}

TEST(ResolvedTextOfAnyKind, ReadsBack) {
  const test::TempFolder folder;
  for (const StudyKind* kind : study_kinds().all) {
    const std::string path = folder.write("study.toml", template_text(test::kFakeCatalog.front(), *kind));
    const std::string text = resolved_text(read_study(path, test::kFakeCatalog, StudyUse::run));
    EXPECT_EQ(resolved_text(read_study(folder.write("again.toml", text), test::kFakeCatalog, StudyUse::run)), text);
  }
}

struct BadAnalysis {
  const char* name;
  std::string analysis;  ///< text of [analysis]; a ^ marks the place of the mistake
  std::vector<std::string> words;
};

void PrintTo(const BadAnalysis& bad, std::ostream* out) { *out << bad.name; }

class BadAnalyses : public testing::TestWithParam<BadAnalysis> {};

TEST_P(BadAnalyses, AreRefused) {
  const test::Marked bad(with_analysis(GetParam().analysis));
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", bad.text);
  test::expect_input_error([&] { read_study(path, test::kFakeCatalog, StudyUse::run); }, {path, bad.line, bad.column},
                           GetParam().words);
}

const std::string kEvaluate = "kind = \"evaluate\"\n";
const std::string kIdentification = "kind = \"identification\"\n";
const std::string kMonteCarlo = "kind = \"monte-carlo\"\ndraws = \"per pose\"\n";

const auto kName = [](const auto& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    Kinds, BadAnalyses,
    testing::Values(
        BadAnalysis{"CaseWithUnknownError",
                    kEvaluate + "cases = [{ errors = { ^dleta_1 = \"1 mm\" } }]",
                    {"unknown factor 'dleta_1'", "did you mean 'delta_1'?"}},
        BadAnalysis{"CaseWithoutErrors", kEvaluate + "cases = [^{ name = \"a\" }]", {"'errors' is missing"}},
        BadAnalysis{"CaseWithEmptyErrors", kEvaluate + "cases = [{ errors = ^{} }]", {"'case 1' gives no error"}},
        BadAnalysis{"CaseInWrongUnit",
                    kEvaluate + "cases = [{ errors = { delta_1 = ^\"1 deg\" } }]",
                    {"errors.delta_1", "must be a length"}},
        BadAnalysis{"CaseBare", kEvaluate + "cases = [{ errors = { linear = ^1 } }]", {"errors.linear is the bare"}},
        BadAnalysis{"CasesOfOneName",
                    kEvaluate + "cases = [{ name = \"a\", errors = { linear = \"1 mm\" } }, "
                                "{ name = ^\"a\", errors = { linear = \"1 mm\" } }]",
                    {"'a'", "a name of its own"}},
        BadAnalysis{"CaseNameWithComma",
                    kEvaluate + "cases = [{ name = ^\"a,b\", errors = { linear = \"1 mm\" } }]",
                    {"'a,b'", "without commas"}},
        BadAnalysis{"EmptySetInCase", kEvaluate + "cases = [{ errors = { benign = ^{} } }]", {"benign gives no error"}},
        BadAnalysis{"SetInCaseWithUnknownKey",
                    kEvaluate + "cases = [{ errors = { benign = { ^liner = \"1 mm\" } } }]",
                    {"did you mean 'linear'?"}},
        BadAnalysis{"QuantilesOutOfRange", kMonteCarlo + "quantiles = [0.5, ^1.0]", {"quantiles[1] is 1", "0 and 1"}},
        BadAnalysis{"QuantilesUnsorted", kMonteCarlo + "quantiles = [0.5, ^0.5]", {"ascending"}},
        BadAnalysis{"NoQuantiles", kMonteCarlo + "quantiles = ^[]", {"analysis.quantiles is empty"}},
        BadAnalysis{
            "GroupWithoutAngle", kIdentification + "groups = [^{ linear = \"1 mm\" }]", {"'angular' is missing"}},
        BadAnalysis{"GroupOfZero",
                    kIdentification + "groups = [{ linear = ^\"0 mm\", angular = \"1 deg\" }]",
                    {"groups[0].linear"}},
        BadAnalysis{"NoGroups", kIdentification + "groups = ^[]", {"analysis.groups is empty"}},
        BadAnalysis{"ShareOfAll", kIdentification + "pose_share = ^1.0", {"pose_share is 1"}},
        BadAnalysis{"BackgroundOfIdentification",
                    kIdentification + "^background = { factors = \"all\" }",
                    {"does not belong to kind = \"identification\""}},
        BadAnalysis{"QuantilesOfSensitivity", "^quantiles = [0.5]", {"does not belong to kind = \"sensitivity\""}},
        BadAnalysis{"ReferenceNotVaried", "reference = { factor = ^\"delta_2\" }", {"'delta_2'", "does not vary"}},
        BadAnalysis{"ReferenceWithoutFactor", "reference = ^{ tolerance = \"1 mm\" }", {"'factor' is missing"}},
        BadAnalysis{
            "ReferenceOfZero", "reference = { factor = \"delta_1\", tolerance = ^\"0 mm\" }", {"reference.tolerance"}}),
    kName);

TEST(StudyOfCases, AsksForACase) {
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", with_analysis(kEvaluate));
  test::expect_input_error([&] { read_study(path, test::kFakeCatalog, StudyUse::run); }, {path, 5, 1},
                           {"at least one case", "[[analysis.cases]]"});
}

}  // namespace
}  // namespace poesy
