#include <gtest/gtest.h>

#include <numbers>

#include "engine/kinds/identification/identification.h"
#include "engine/kinds/study_file.h"
#include "engine/study/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy::coupling {
namespace {

using Choice = ErrorPattern::Choice;

constexpr double kDegree = std::numbers::pi / 180.0;

/// The fake mechanism with components: delta_1 along x and epsilon_1 about z of limb 1, delta_2 a scalar of limb 2.
Catalog catalog() {
  Catalog components = test::fake_catalog();
  components.front().description.factors[0].axis = "x";
  components.front().description.factors[1].axis = "z";
  return components;
}

const Catalog kCouplingCatalog = catalog();

std::string with_analysis(std::string_view analysis) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 "
         "}\n[analysis]\nkind = \"coupling\"\n" +
         std::string(analysis);
}

Options coupling_of(const std::string& analysis, StudyUse use = StudyUse::run) {
  return asked_of<Options>(study_of_text(with_analysis(analysis), "study.toml", kCouplingCatalog, use).analysis);
}

const std::string kSizes = "linear = [\"1 mm\"]\nangular = [\"1 deg\"]\n";
const std::string kLengths = "sources = [{ factors = [\"delta_1\"] }, { factors = [\"delta_2\"] }]\n";

TEST(StudyOfCoupling, LooksForWorstCasesUnlessToldOtherwise) {
  EXPECT_EQ(coupling_of(kSizes).worst_case, UnknownSigns::search);
  EXPECT_EQ(coupling_of(kSizes + "worst_case = \"sum\"\n").worst_case, UnknownSigns::sum);
  const Study study =
      study_of_text(with_analysis(kSizes + "worst_case = \"sum\"\n"), "study.toml", kCouplingCatalog, StudyUse::run);
  const Study again = study_of_text(resolved_text(study), "resolved.toml", kCouplingCatalog, StudyUse::run);
  EXPECT_EQ(asked_of<Options>(again.analysis).worst_case, UnknownSigns::sum);
}

TEST(StudyOfCoupling, TakesTheModelsSourcesUnlessToldOtherwise) {
  const Options coupling = coupling_of("linear = [\"0.1 mm\", \"0.3 mm\"]\nangular = [\"1 deg\", \"2 deg\"]\n");
  EXPECT_EQ(coupling.linear, (std::vector<double>{1e-4, 3e-4}));
  ASSERT_EQ(coupling.angular.size(), 2u);
  EXPECT_DOUBLE_EQ(coupling.angular[1], 2 * kDegree);
  EXPECT_EQ(coupling.pattern.limbs, Choice::all);
  EXPECT_EQ(coupling.pattern.components, Choice::all);
  ASSERT_EQ(coupling.sources.size(), 2u);
  EXPECT_EQ(coupling.sources[0].name, "D");
  EXPECT_EQ(coupling.sources[0].factors, (std::vector<FactorIndex>{FactorIndex(0), FactorIndex(1)}));
}

TEST(StudyOfCoupling, TakesSourcesAndAPattern) {
  const Options coupling = coupling_of(R"(linear = ["1 mm"]
angular = ["1 deg"]
limbs = 1
components = "independent"
[[analysis.sources]]
name = "one"
factors = ["delta_1"]
[[analysis.sources]]
factors = ["epsilon_1"]
)");
  EXPECT_EQ(coupling.pattern.limbs, Choice::some);
  EXPECT_EQ(coupling.pattern.limb, 1u);
  EXPECT_EQ(coupling.pattern.components, Choice::independent);
  EXPECT_EQ(coupling.sources[0].name, "one");
  EXPECT_EQ(coupling.sources[1].name, "source 2");
  EXPECT_EQ(coupling.sources[1].factors, std::vector<FactorIndex>{FactorIndex(1)});
}

TEST(StudyOfCoupling, KeepsWhatThePatternLeaves) {
  const Study study =
      study_of_text(with_analysis(kSizes + "components = [\"x\"]\n"), "study.toml", kCouplingCatalog, StudyUse::run);
  EXPECT_EQ(asked_of<Options>(study.analysis).pattern.axes, std::vector<std::string>{"x"});
  EXPECT_EQ(asked_of<Options>(study.analysis).sources[0].factors.size(), 2u);  // delta_2 was named explicitly
  EXPECT_EQ(study.analysis.factors, (std::vector<FactorIndex>{FactorIndex(0), FactorIndex(2)}));
}

TEST(StudyOfCoupling, RefusesSizesOfNothing) {
  try {
    coupling_of("linear = [\"1 mm\"]\nangular = [\"1 deg\"]\n" + kLengths);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no source has an error with that dimension (angle)"), std::string::npos)
        << error.what();
  }
}

TEST(StudyOfCoupling, NeedsSizesOnlyOfWhatItHas) {
  EXPECT_TRUE(coupling_of("linear = [\"1 mm\"]\n" + kLengths).angular.empty());
  EXPECT_TRUE(coupling_of("linear = [\"1 mm\"]\ncomponents = [\"x\"]\n").angular.empty());
}

TEST(StudyOfCoupling, NeedsNothingForATableOfErrors) {
  EXPECT_TRUE(coupling_of("", StudyUse::evaluate).sources.empty());
  EXPECT_EQ(coupling_of(kLengths, StudyUse::evaluate).sources.size(), 2u);
}

TEST(ResolvedTextOfCoupling, ReadsBackToTheSameStudy) {
  for (const std::string pattern :
       {"", "limbs = \"independent\"\n", "components = \"independent\"\n", "components = [\"z\", \"x\"]\n",
        "limbs = 1\nsources = [{ name = \"a b\", factors = [\"epsilon_1\"] }, { factors = [\"delta_1\"] }]\n"}) {
    const Study study = study_of_text(with_analysis(kSizes + pattern), "study.toml", kCouplingCatalog, StudyUse::run);
    const std::string text = resolved_text(study);
    const Study again = study_of_text(text, "again.toml", kCouplingCatalog, StudyUse::run);
    EXPECT_EQ(resolved_text(again), text);
    const Options& a = asked_of<Options>(study.analysis);
    const Options& b = asked_of<Options>(again.analysis);
    EXPECT_EQ(a.linear, b.linear);
    EXPECT_EQ(a.angular, b.angular);
    EXPECT_EQ(a.pattern.limbs, b.pattern.limbs);
    EXPECT_EQ(a.pattern.limb, b.pattern.limb);
    EXPECT_EQ(a.pattern.components, b.pattern.components);
    EXPECT_EQ(a.pattern.axes, b.pattern.axes);
    EXPECT_EQ(study.analysis.factors, again.analysis.factors);
    ASSERT_EQ(a.sources.size(), b.sources.size());
    for (std::size_t s = 0; s < a.sources.size(); ++s) {
      EXPECT_EQ(a.sources[s].name, b.sources[s].name);
      EXPECT_EQ(a.sources[s].factors, b.sources[s].factors);
    }
  }
}

TEST(StudyOfCoupling, BoundsWhatAResultHolds) {
  std::string many = with_analysis(kSizes);
  many.replace(many.find("count = 3"), 9, "count = 9999999");
  test::expect_input_error([&] { study_of_text(many, "study.toml", kCouplingCatalog, StudyUse::run); },
                           {"study.toml", 4, 9}, {"poses times sizes times sets of sources", "at most 10000000"});
}

struct BadCoupling {
  const char* name;
  std::string analysis;  ///< text of [analysis]; a ^ marks the place of the mistake
  std::vector<std::string> words;
};

void PrintTo(const BadCoupling& bad, std::ostream* out) { *out << bad.name; }

class BadCouplings : public testing::TestWithParam<BadCoupling> {};

TEST_P(BadCouplings, AreRefused) {
  const test::Marked bad(with_analysis(GetParam().analysis));
  test::expect_input_error([&] { study_of_text(bad.text, "study.toml", kCouplingCatalog, StudyUse::run); },
                           {"study.toml", bad.line, bad.column}, GetParam().words);
}

const auto kName = [](const auto& info) { return std::string(info.param.name); };

std::string nine_sources() {
  std::string text = "sources = ^[";
  for (int n = 0; n < 9; ++n) text += "{ factors = [\"delta_1\"] }, ";
  return text + "]";
}

INSTANTIATE_TEST_SUITE_P(
    Coupling, BadCouplings,
    testing::Values(
        BadCoupling{"SizeOfZero", "linear = [\"1 mm\", ^\"0 mm\"]", {"analysis.linear[1]", "greater than zero"}},
        BadCoupling{"NegativeSize", "linear = [^\"-1 mm\"]", {"analysis.linear[0]", "greater than zero"}},
        BadCoupling{"SizeInWrongUnit", "linear = [^\"1 deg\"]", {"must be a length"}},
        BadCoupling{"BareSize", "linear = [^0.1]", {"bare number"}},
        BadCoupling{"NoSizes", "linear = ^[]", {"analysis.linear is empty", "at least one"}},
        BadCoupling{"SizesThatAreNoList", "linear = ^\"1 mm\"", {"write a list"}},
        BadCoupling{"SizeTwice", "linear = [\"1 mm\", ^\"0.001 m\"]", {"analysis.linear[1] repeats a size"}},
        BadCoupling{"UnequalNumbers",
                    "linear = [\"1 mm\", \"2 mm\"]\nangular = ^[\"1 deg\"]",
                    {"analysis.angular has 1 size, but linear has 2 sizes", "as many"}},
        BadCoupling{"LimbThatIsNot", "limbs = ^3", {"analysis.limbs is 3", "limbs 1, 2"}},
        BadCoupling{"NegativeLimb", "limbs = ^-1", {"analysis.limbs is -1", "at least 0"}},
        BadCoupling{"UnknownWordForLimbs", "limbs = ^\"independant\"", {"did you mean 'independent'?"}},
        BadCoupling{"UnknownAxis", "components = [\"x\", ^\"w\"]", {"components[1] is 'w'", "known: x, y, z"}},
        BadCoupling{"AxisTwice", "components = [\"x\", ^\"x\"]", {"'x' a second time"}},
        BadCoupling{"NoComponents", "components = ^[]", {"analysis.components is empty", "\"all\""}},
        BadCoupling{"OneSource", "sources = ^[{ factors = [\"delta_1\"] }]", {"has 1 source,", "2 to 8"}},
        BadCoupling{"NineSources", nine_sources(), {"has 9 sources", "2 to 8"}},
        BadCoupling{"SourceWithoutFactors", "sources = [^{ name = \"a\" }, {}]", {"'factors' is missing"}},
        BadCoupling{"UnknownSet",
                    "sources = [{ factors = ^\"bening\" }, { factors = \"deforming\" }]",
                    {"did you mean 'benign'?"}},
        BadCoupling{"SharedFactor",
                    "sources = [{ name = \"a\", factors = \"all\" }, { factors = ^\"deforming\" }]",
                    {"sources[1].factors has 'delta_1'", "source 'a' has as well", "one source"}},
        BadCoupling{"SourcesOfOneName",
                    "sources = [{ name = \"a\", factors = \"benign\" }, { name = ^\"a\", factors = \"deforming\" }]",
                    {"'a'", "a name of its own"}},
        BadCoupling{"NameThatJoins",
                    "sources = [{ name = ^\"a+b\", factors = \"benign\" }, { factors = \"deforming\" }]",
                    {"'a+b'", "without '+'"}},
        BadCoupling{"UnknownKeyOfASource", "sources = [{ ^set = \"benign\" }, {}]", {"unknown key 'set'"}},
        BadCoupling{"NothingLeftOfALimb",
                    "limbs = 2\nsources = [{ factors = ^\"deforming\" }, { factors = \"benign\" }]",
                    {"sources[0].factors has no factor of the limbs and components"}},
        BadCoupling{"NothingLeftOfAComponent",
                    "components = [\"y\"]\nsources = [{ factors = \"benign\" }, { factors = ^[\"delta_1\"] }]",
                    {"sources[1].factors has no factor"}},
        BadCoupling{"KeyOfAnotherKind", "^quantiles = [0.5]", {"does not belong to kind = \"coupling\""}},
        BadCoupling{"BackgroundOfCoupling", "^background = { factors = \"all\" }", {"does not belong"}}),
    kName);

void expect_error_of_section(const std::string& analysis, const Catalog& models,
                             const std::vector<std::string>& words) {
  test::expect_input_error([&] { study_of_text(with_analysis(analysis), "study.toml", models, StudyUse::run); },
                           {"study.toml", 5, 1}, words);
}

TEST(StudyOfCoupling, AsksForTheSizesOfItsErrors) {
  expect_error_of_section("linear = [\"1 mm\"]\n", kCouplingCatalog,
                          {"'angular' is missing", "'epsilon_1'", "angular = [\"0.1 deg\"]"});
  expect_error_of_section("angular = [\"1 deg\"]\n", kCouplingCatalog, {"'linear' is missing", "'delta_1'"});
}

TEST(StudyOfCoupling, AsksForSourcesWhereTheModelSuggestsNone) {
  Catalog without = kCouplingCatalog;
  without.front().description.sources.clear();
  expect_error_of_section(kSizes, without, {"model \"fake\" suggests none", "2 to 8 [[analysis.sources]]"});
  const Study study =
      study_of_text(with_analysis("linear = [\"1 mm\"]\n" + kLengths), "study.toml", without, StudyUse::run);
  EXPECT_EQ(asked_of<Options>(study.analysis).sources[1].name, "source 2");
}

TEST(StudyOfCoupling, SaysWhichUsualSourceThePatternEmpties) {
  expect_error_of_section(kSizes + "limbs = 2\n", kCouplingCatalog, {"source 'D' has no factor"});
}

TEST(StudyOfAnotherKind, RefusesTheKeysOfCoupling) {
  for (const std::string key : {"linear = []", "angular = []", "limbs = 1", "components = \"all\"", "sources = []"}) {
    const std::string text =
        "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count "
        "= 3 }\n[analysis]\n" +
        key + "\n";
    test::expect_input_error([&] { study_of_text(text, "study.toml", kCouplingCatalog, StudyUse::run); },
                             {"study.toml", 6, 1}, {"does not belong to kind = \"sensitivity\""});
  }
}

TEST(TemplateOfCoupling, ShowsTheSizesThatItsSourcesNeed) {
  const std::string text = template_text(kCouplingCatalog.front(), kStudy);
  EXPECT_NE(text.find("\nangular = ["), std::string::npos);
  Catalog lengths = kCouplingCatalog;
  lengths.front().description.factor_sets.push_back({"lengths", "", {FactorIndex(0)}});
  lengths.front().description.sources.front().set = "lengths";
  EXPECT_NE(template_text(lengths.front(), kStudy).find("\n# angular = ["), std::string::npos);
}

}  // namespace
}  // namespace poesy::coupling
