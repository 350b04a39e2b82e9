#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "engine/kinds/allocation/result.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/study/study_file.h"
#include "engine/study/study_kind.h"
#include "models/registry.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"

namespace poesy::allocation {
namespace {

using Choice = AllocatedPart::Choice;
using Law = StatedCost::Law;
using Factors = std::vector<FactorIndex>;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Bounds of the errors: delta_1 (length) the arm, epsilon_1 (angle) 3 rad, delta_2 (length) a hole of 10 mm.
class BoundedModel final : public test::FakeModel {
 public:
  using FakeModel::FakeModel;

  ErrorBound error_bound(FactorIndex factor) const override {
    if (factor.value == 1) return {3.0, "three radians"};
    if (factor.value == 2) return {0.01, "the hole"};
    return {kArm, "the arm"};
  }
};

Catalog catalog() {
  Catalog bounded = test::fake_catalog();
  bounded[0].build = [](std::span<const double> geometry, std::size_t /*fidelity*/) {
    return std::make_unique<BoundedModel>(geometry[0]);
  };
  return bounded;
}

const Catalog kAllocationCatalog = catalog();

const StudyKinds& kinds() {
  static const StudyKinds some = study_kinds_of({&sensitivity::kStudy, &monte_carlo::kStudy, &kStudy}, {});
  return some;
}

Study read(const std::string& text, const Catalog& models = kAllocationCatalog, StudyUse use = StudyUse::run) {
  return study_of_text(text, "study.toml", models, use, kinds());
}

const std::string kLimits = "limits = { linear_deformation = \"0.03 mm\" }\n";
const std::string kSigmas = "sigmas = 3\n";

/// The text of a study of the fake mechanism. Its errors are delta_1 and epsilon_1 (an angle) of limb 1 and delta_2 of
/// limb 2.
std::string with_analysis(const std::string& analysis, const std::string& errors = "") {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 }\n" + errors +
         "[analysis]\nkind = \"allocation\"\n" + analysis;
}

Study study_of(const std::string& analysis, StudyUse use = StudyUse::run) {
  return read(with_analysis(analysis), kAllocationCatalog, use);
}

const Options& options_of(const Study& study) { return asked_of<Options>(study.analysis); }

std::vector<AllocatedPart> parts_of(const std::string& parts) {
  return options_of(study_of(kLimits + kSigmas + parts)).parts;
}

/// The part of a study with one block of parts. keys: the keys of this block.
AllocatedPart part_of(const std::string& keys) {
  const std::vector<AllocatedPart> parts = parts_of("[[analysis.parts]]\n" + keys);
  EXPECT_EQ(parts.size(), 1u);
  return parts.front();
}

const std::string kOnePart = "[[analysis.parts]]\nfactors = [\"delta_1\"]\n";

TEST(StudyOfTolerances, HasDefaults) {
  const Study study = study_of(kLimits + kSigmas + kOnePart);
  const Options& asked = options_of(study);
  EXPECT_EQ(asked.yield, 0.9973);
  EXPECT_EQ(asked.confidence, 0.95);
  EXPECT_EQ(asked.aim, Aim::equal_effect);
  EXPECT_EQ(study.analysis.samples, 149'000u);
  EXPECT_EQ(study.analysis.draws, Draws::per_machine);
  EXPECT_EQ(study.analysis.factors.size(), 3u);
  ASSERT_EQ(study.analysis.limits.size(), 1u);
  EXPECT_EQ(study.analysis.limits[0].allowed.to(), 0.03e-3);
  ASSERT_EQ(asked.parts.size(), 1u);
  const AllocatedPart& part = asked.parts.front();
  EXPECT_EQ(part.name, "delta_1");
  EXPECT_EQ(part.factors, Factors{FactorIndex(0)});
  EXPECT_EQ(part.sigmas, 3.0);
  EXPECT_EQ(part.shift, 0.0);
  EXPECT_EQ(part.choice, Choice::range);
  EXPECT_EQ(part.cost, StatedCost());
  EXPECT_EQ(part.lo, 0.0);
  EXPECT_EQ(part.hi, std::numeric_limits<double>::infinity());
}

TEST(StudyOfTolerances, WarnsIfErrorsDoNotEndAtTheTolerance) {
  const auto doubts = [](const std::string& distribution, const std::string& sigmas) {
    return read(with_analysis(
                    kLimits + "sigmas = " + sigmas + "\n[[analysis.parts]]\nfactors = \"linear\"\neach = true\n",
                    "errors.linear = { distribution = " + distribution + " }\n"))
        .doubts;
  };
  const std::string uniform = "\"uniform\", half_width = \"1 um\"";
  ASSERT_EQ(doubts(uniform, "3").size(), 1u);
  EXPECT_EQ(
      doubts(uniform, "3").front(),
      "the errors of part 'delta_1' and 1 more part end 1.732 standard deviations from their mean, but a "
      "tolerance is 3 of them: what is certified are errors that end at 0.577 times the tolerance; write sigmas = "
      "1.732 if errors may lie anywhere within it");
  EXPECT_TRUE(doubts(uniform, "1.73").empty());
  EXPECT_EQ(doubts("\"triangular\", half_width = \"1 um\"", "3").size(), 1u);
  EXPECT_TRUE(doubts("\"triangular\", half_width = \"1 um\"", "2.449").empty());
  EXPECT_TRUE(doubts("\"truncated-normal\", sigma = \"1 um\", half_width = \"3 um\"", "3").empty());
  EXPECT_EQ(doubts("\"truncated-normal\", sigma = \"1 um\", half_width = \"1 um\"", "3").size(), 1u);
  EXPECT_TRUE(doubts("\"normal\", sigma = \"1 um\"", "1").empty());
}

TEST(StudyOfTolerances, TakesItsKeys) {
  const Study study = study_of(kLimits +
                               "yield = 0.99\nconfidence = 0.9\nsamples = 500\naim = \"equal-tolerance\"\ncpk = 2\n"
                               "factors = [\"delta_2\", \"delta_1\"]\nbackground = { factors = [\"epsilon_1\"] }\n" +
                               kOnePart + "cost = { law = \"reciprocal\", b = 1, unit = \"mm\" }\n");
  const Options& asked = options_of(study);
  EXPECT_EQ(asked.yield, 0.99);
  EXPECT_EQ(asked.confidence, 0.9);
  EXPECT_EQ(study.analysis.samples, 500u);
  EXPECT_EQ(asked.aim, Aim::equal_tolerance);
  EXPECT_EQ(asked.parts.front().sigmas, 6.0);
  EXPECT_EQ(study.analysis.factors, (Factors{FactorIndex(2), FactorIndex(0)}));
  EXPECT_TRUE(study.analysis.background);
}

TEST(StudyOfTolerances, AsksForTheLeastCostWhereThereAreCosts) {
  const std::string cost = "cost = { law = \"exponential\", b = 1, tau = \"1 mm\" }";
  EXPECT_EQ(options_of(study_of(kLimits + kSigmas + kOnePart + cost)).aim, Aim::least_cost);
  EXPECT_EQ(options_of(study_of(kLimits + kSigmas + kOnePart + "processes = [{ " + cost + " }]")).aim, Aim::least_cost);
}

TEST(StudyOfTolerances, TakesMachinesUntilEnoughFail) {
  const auto samples = [](const std::string& yield) {
    return study_of(kLimits + kSigmas + "yield = " + yield + "\n" + kOnePart).analysis.samples;
  };
  EXPECT_EQ(samples("0.5"), 2000u);
  EXPECT_EQ(samples("0.9"), 4000u);
  EXPECT_EQ(samples("0.9999"), 4'000'000u);
  EXPECT_EQ(samples("0.99999"), 20'000'000u);
}

TEST(StudyOfTolerances, KnowsItsWords) {
  EXPECT_EQ(name(Aim::least_cost), "least-cost");
  EXPECT_EQ(name(Aim::equal_effect), "equal-effect");
  EXPECT_EQ(name(Aim::equal_tolerance), "equal-tolerance");
  EXPECT_EQ(name(Aim::common_factor), "common-factor");
  EXPECT_EQ(name(Law::none), "none");
  EXPECT_EQ(name(Law::reciprocal), "reciprocal");
  EXPECT_EQ(name(Law::reciprocal_power), "reciprocal-power");
  EXPECT_EQ(name(Law::exponential), "exponential");
}

TEST(StudyOfTolerances, NeedsNothingForATableOfErrors) {
  EXPECT_TRUE(options_of(study_of("", StudyUse::evaluate)).parts.empty());
  EXPECT_EQ(options_of(study_of("aim = \"least-cost\"\n" + kSigmas + kOnePart, StudyUse::evaluate)).parts.size(), 1u);
}

TEST(PartOfADrawing, TakesItsKeys) {
  const AllocatedPart part = part_of(
      "name = \"hinge pins\"\nfactors = [\"delta_2\", \"delta_*\"]\ncpk = 1.5\nshift = 0.1\n"
      "bounds = [\"0 mm\", \"0.5 mm\"]\n");
  EXPECT_EQ(part.name, "hinge pins");
  EXPECT_EQ(part.factors, (Factors{FactorIndex(2), FactorIndex(0)}));
  EXPECT_EQ(part.sigmas, 4.5);
  EXPECT_EQ(part.shift, 0.1);
  EXPECT_EQ(part.choice, Choice::range);
  EXPECT_EQ(part.lo, 0.0);
  EXPECT_EQ(part.hi, 0.5e-3);
  EXPECT_EQ(part_of("factors = [\"delta_1\"]\nsigmas = 2\n").sigmas, 2.0);
}

TEST(PartOfADrawing, TakesErrorsByNamePatternSetAndDimension) {
  EXPECT_EQ(part_of("factors = \"benign\"").factors, Factors{FactorIndex(2)});
  EXPECT_EQ(part_of("factors = \"linear\"").factors, (Factors{FactorIndex(0), FactorIndex(2)}));
  EXPECT_EQ(part_of("factors = \"angular\"").factors, Factors{FactorIndex(1)});
  EXPECT_EQ(part_of("factors = [\"*_2\", \"delta_?\"]").factors, (Factors{FactorIndex(2), FactorIndex(0)}));
  EXPECT_EQ(part_of("factors = [\"delta_?\"]").name, "delta_1");
}

TEST(PartOfADrawing, MayBeGivenOrOneOfSeveralValues) {
  const AllocatedPart given = part_of("factors = [\"epsilon_1\"]\ntolerance = \"0.5 deg\"\n");
  EXPECT_EQ(given.choice, Choice::fixed);
  EXPECT_DOUBLE_EQ(given.lo, 0.5 * kDegree);
  const AllocatedPart values = part_of("factors = [\"delta_1\"]\nvalues = [\"0.01 mm\", \"20 um\"]\n");
  EXPECT_EQ(values.choice, Choice::values);
  EXPECT_EQ(values.values, (std::vector<double>{1e-5, 20 * 1e-6}));
  const AllocatedPart grades =
      part_of("factors = [\"delta_1\"]\ngrades = [\"IT6\", \"IT7\", \"IT11\"]\nnominal_size = \"55.29 mm\"\n");
  EXPECT_EQ(grades.choice, Choice::grades);
  EXPECT_EQ(grades.grades, (std::vector<ItGrade>{ItGrade::it6, ItGrade::it7, ItGrade::it11}));
  EXPECT_EQ(grades.nominal_size, 55.29 * 1e-3);
}

TEST(PartOfADrawing, IsMadeByOneOfSeveralProcesses) {
  const AllocatedPart part = part_of(R"(factors = ["delta_1"]
processes = [
  { name = "turning", cost = { law = "reciprocal", a = 10, b = 0.015, unit = "mm" }, bounds = ["0.015 mm", "0.08 mm"] },
  { cost = { law = "reciprocal", b = 0.5, unit = "mm" } },
]
)");
  EXPECT_EQ(part.choice, Choice::processes);
  ASSERT_EQ(part.processes.size(), 2u);
  EXPECT_EQ(part.processes[0].name, "turning");
  EXPECT_EQ(part.processes[0].cost.a, 10.0);
  EXPECT_EQ(part.processes[0].lo, 0.015 * 1e-3);
  EXPECT_EQ(part.processes[0].hi, 0.08 * 1e-3);
  EXPECT_EQ(part.processes[1].name, "2");
  EXPECT_EQ(part.processes[1].hi, std::numeric_limits<double>::infinity());
}

/// The cost of this tolerance (m) of an error. cost: the value of the key `cost`.
double cost_at(const std::string& cost, double tolerance, const std::string& error = "delta_1") {
  return part_of("factors = [\"" + error + "\"]\ncost = " + cost + "\n").cost.cost_law().at(tolerance);
}

TEST(CostOfATolerance, CountsItInTheUnitThatTheStudyStates) {
  EXPECT_DOUBLE_EQ(cost_at("{ law = \"reciprocal\", a = 3.5, b = 0.75, unit = \"mm\" }", 0.25e-3), 3.5 + 0.75 / 0.25);
  EXPECT_DOUBLE_EQ(cost_at("{ law = \"reciprocal\", b = 2, unit = \"deg\" }", 0.5 * kDegree, "epsilon_1"), 2 / 0.5);
  EXPECT_DOUBLE_EQ(cost_at("{ law = \"reciprocal-power\", b = 2, k = 2, unit = \"um\" }", 5e-6), 2.0 / 25.0);
  EXPECT_DOUBLE_EQ(cost_at("{ law = \"exponential\", a = 1, b = 2, tau = \"0.1 mm\" }", 0.2e-3),
                   1.0 + 2.0 * std::exp(-2.0));
  EXPECT_EQ(StatedCost().cost_law().at(1e-3), 0.0);
}

std::vector<std::string> names_of(const std::vector<AllocatedPart>& parts) {
  std::vector<std::string> list;
  for (const AllocatedPart& part : parts) list.push_back(part.name);
  return list;
}

TEST(BlockOfParts, MakesAPartOfEachError) {
  const std::vector<AllocatedPart> parts =
      parts_of("[[analysis.parts]]\nfactors = \"all\"\neach = true\nshift = 0.2\n");
  EXPECT_EQ(names_of(parts), (std::vector<std::string>{"delta_1", "epsilon_1", "delta_2"}));
  for (const AllocatedPart& part : parts) EXPECT_EQ(part.shift, 0.2);
  EXPECT_EQ(parts_of("[[analysis.parts]]\nfactors = \"linear\"\neach = false\n").size(), 1u);
}

TEST(BlockOfParts, JoinsTheErrorsOfIdenticalLimbs) {
  const std::vector<AllocatedPart> parts =
      parts_of("[[analysis.parts]]\nfactors = [\"delta_2\", \"*\"]\neach = true\nidentical_limbs = [1, 2]\n");
  EXPECT_EQ(names_of(parts), (std::vector<std::string>{"delta_2", "epsilon_1"}));
  EXPECT_EQ(parts[0].factors, (Factors{FactorIndex(2), FactorIndex(0)}));
}

TEST(BlockOfParts, JoinsOnlyErrorsOfOneFrameAndDimension) {
  for (const bool of_frame : {true, false}) {
    Catalog other = kAllocationCatalog;
    std::vector<Factor>& factors = other.front().description.factors;
    if (of_frame) factors[2].frame = 1;
    if (!of_frame) factors[2].dimension = Dimension::angle;
    const test::Marked bad(with_analysis(
        kLimits + kSigmas + "[[analysis.parts]]\nfactors = \"all\"\neach = true\nidentical_limbs = ^[1, 2]\n"));
    test::expect_input_error([&] { read(bad.text, other); }, {"study.toml", bad.line, bad.column},
                             {"identical_limbs joins no two errors"});
  }
}

/// A study of a mechanism of the catalog in which each error is a part, but the same errors of the given limbs share
/// one part.
Study study_of_limbs(const std::string& model, const std::string& limit, const std::string& limbs,
                     const Catalog& catalog = registry()) {
  return read("format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"" + model +
                  "\" }\nposes = { count = 3 }\n[analysis]\nkind = \"allocation\"\nsigmas = 3\nlimits = { " + limit +
                  " }\n[[analysis.parts]]\nfactors = \"all\"\neach = true\nidentical_limbs = " + limbs,
              catalog);
}

TEST(BlockOfParts, JoinsTheLimbsOfMechanisms) {
  const auto parts = [](const std::string& model, const std::string& limit, const std::string& limbs) {
    return options_of(study_of_limbs(model, limit, limbs)).parts;
  };
  const std::vector<AllocatedPart> upr = parts("2upr-rpu", "linear_deformation = \"0.03 mm\"", "[1, 2]");
  EXPECT_EQ(upr.size(), 47u);  // 24 errors of limbs 1 and 2 each, 23 of limb 3
  const ModelDescription& model = find(registry(), "2upr-rpu")->description;
  std::size_t errors = 0;
  for (const AllocatedPart& part : upr) {
    errors += part.factors.size();
    EXPECT_EQ(part.factors.size(), model.factors[part.factors[0].value].limb == 3 ? 1u : 2u) << part.name;
  }
  EXPECT_EQ(errors, 71u);
  EXPECT_EQ(upr[0].name, "delta_1_0_x");
  EXPECT_EQ(model.factors[upr[0].factors[1].value].name, "delta_2_0_x");
  const Response& first = find(registry(), "3-prs")->description.responses.front();
  const std::string size = first.dimension == Dimension::length ? "\"1 mm\"" : "\"1 deg\"";
  EXPECT_EQ(parts("3-prs", first.name + " = " + size, "[1, 2, 3]").size(), 17u);  // its set "all" has 51 errors
}

TEST(BlockOfParts, JoinsCopiesOfLimbsWithNames) {
  std::ostringstream text;
  text << std::ifstream(POESY_TEST_DATA "/mechanisms/linear-delta.toml").rdbuf();
  const Catalog catalog{registry().from_text(text.str(), "linear-delta.toml")};  // the study refers to its entry
  const Study study = study_of_limbs("linear-delta", "x = \"0.1 mm\"", "[4, 5, 6, 7, 8, 9]", catalog);
  const ModelDescription& model = study.model();
  std::vector<std::string> alike;
  for (const AllocatedPart& part : options_of(study).parts) {
    for (const FactorIndex error : part.factors) {
      if (part.name.starts_with("rod_")) alike.push_back(part.name + ": " + model.factors[error.value].name);
    }
  }
  EXPECT_EQ(alike, (std::vector<std::string>{"rod_left_1: rod_left_1", "rod_left_1: rod_left_2",
                                             "rod_left_1: rod_left_3", "rod_right_1: rod_right_1",
                                             "rod_right_1: rod_right_2", "rod_right_1: rod_right_3"}));
}

TEST(BlockOfParts, AsksAboutIdenticalLimbsWithOtherJoints) {
  const std::string limit = "linear_deformation = \"0.03 mm\"";
  EXPECT_TRUE(study_of_limbs("2upr-rpu", limit, "[1, 2]").doubts.empty());
  const Study study = study_of_limbs("2upr-rpu", limit, "[1, 3]");
  ASSERT_EQ(study.doubts.size(), 1u);
  EXPECT_EQ(study.doubts.front(),
            "identical_limbs has limb 1 with the joints UPR and limb 3 with RPU, which are not alike; is one tolerance "
            "for both meant?");
}

TEST(TemplateOfTolerances, JoinsLimbsWithTheSameJoints) {
  const auto text_of = [](const std::string& name) {
    std::ostringstream text;
    text << std::ifstream(POESY_TEST_DATA "/mechanisms/" + name).rdbuf();
    const CatalogEntry entry = registry().from_text(text.str(), name);
    return template_text(entry, kStudy, kinds());
  };
  EXPECT_NE(text_of("linear-delta.toml").find("\n# identical_limbs = [1, 2]\n"), std::string::npos);
  EXPECT_EQ(text_of("five-bar.toml").find("\n# identical_limbs"), std::string::npos);
}

TEST(PartOfADrawing, MayBeRoundedToStepsOfAWorkshop) {
  const AllocatedPart multiple = part_of("factors = [\"delta_1\"]\nround = \"1 um\"\n");
  EXPECT_EQ(multiple.choice, Choice::range);
  EXPECT_NEAR(multiple.round->down(12.9e-6), 12e-6, 1e-18);
  EXPECT_NEAR(multiple.round->down(12e-6 * (1.0 - 1e-15)), 12e-6, 1e-18);
  EXPECT_NEAR(multiple.round->up(12.1e-6), 13e-6, 1e-18);
  EXPECT_EQ(multiple.round->up(0.0), 1e-6);
  EXPECT_EQ(multiple.round->down(0.9e-6), 0.0);
  const AllocatedPart series =
      part_of("factors = [\"epsilon_1\"]\nbounds = [\"0.1 deg\", \"1 deg\"]\nround = \"R5\"\n");
  EXPECT_NEAR(series.round->down(0.3 * kDegree), 0.25 * kDegree, 1e-16);
  EXPECT_EQ(series.round->up(0.0), 0.0);
}

/// Expects that all members of two parts are equal. Numbers must be equal in every bit.
void expect_same(const AllocatedPart& a, const AllocatedPart& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.factors, b.factors);
  EXPECT_EQ(a.sigmas, b.sigmas);
  EXPECT_EQ(a.shift, b.shift);
  EXPECT_EQ(a.choice, b.choice);
  EXPECT_EQ(a.cost, b.cost);
  EXPECT_EQ(a.lo, b.lo);
  EXPECT_EQ(a.hi, b.hi);
  EXPECT_EQ(a.values, b.values);
  EXPECT_EQ(a.grades, b.grades);
  EXPECT_EQ(a.nominal_size, b.nominal_size);
  EXPECT_EQ(a.round, b.round);
  ASSERT_EQ(a.processes.size(), b.processes.size());
  for (std::size_t p = 0; p < a.processes.size(); ++p) {
    EXPECT_EQ(a.processes[p].name, b.processes[p].name);
    EXPECT_EQ(a.processes[p].cost, b.processes[p].cost);
    EXPECT_EQ(a.processes[p].lo, b.processes[p].lo);
    EXPECT_EQ(a.processes[p].hi, b.processes[p].hi);
  }
}

void expect_reads_back(const std::string& written, const Catalog& models = kAllocationCatalog) {
  const Study study = read(written, models);
  const std::string text = resolved_text(study);
  for (const StudyUse use : {StudyUse::run, StudyUse::evaluate}) {
    const Study again = read(text, models, use);
    EXPECT_EQ(resolved_text(again), text);
    EXPECT_EQ(again.analysis.samples, study.analysis.samples);
    EXPECT_EQ(again.analysis.draws, study.analysis.draws);
    const Options& a = options_of(study);
    const Options& b = options_of(again);
    EXPECT_EQ(a.yield, b.yield);
    EXPECT_EQ(a.confidence, b.confidence);
    EXPECT_EQ(a.aim, b.aim);
    ASSERT_EQ(a.parts.size(), b.parts.size());
    for (std::size_t p = 0; p < a.parts.size(); ++p) expect_same(a.parts[p], b.parts[p]);
  }
}

/// The analysis of a study that sets every key of parts, costs and processes. The numbers have many digits, so that
/// lost digits would be seen.
const std::string kEveryKey = kLimits + R"(yield = 0.987654321
confidence = 0.912345678
samples = 12345
aim = "least-cost"
cpk = 1.3333333
[[analysis.parts]]
name = "hinge pins of µ"
factors = ["delta_1"]
shift = 0.123456789
processes = [
  { name = "a b", cost = { law = "reciprocal", a = 3.3, b = 0.777, unit = "um" }, bounds = ["0.0123 mm", "0.1 mm"] },
  { cost = { law = "exponential", a = 0.1, b = 0.2, tau = "0.07 mm" } },
]
[[analysis.parts]]
factors = ["epsilon_1"]
cost = { law = "reciprocal-power", a = 0.1, b = 0.3, k = 1.7, unit = "deg" }
bounds = ["0.1 arcsec", "1.1 deg"]
[[analysis.parts]]
factors = "benign"
sigmas = 2.7
cost = { law = "reciprocal", b = 0.1, unit = "cm" }
grades = ["IT01", "IT6", "IT18"]
nominal_size = "55.29 mm"
)";

TEST(ResolvedTextOfTolerances, ReadsBackToTheSameStudy) {
  expect_reads_back(with_analysis(kEveryKey));
  expect_reads_back(with_analysis(kLimits + kSigmas + kOnePart + "values = [\"0.0123 mm\", \"0.3 mm\"]\n"));
  expect_reads_back(with_analysis(kLimits + kSigmas + kOnePart + "tolerance = \"0.3 mm\"\n"));
  expect_reads_back(with_analysis(kLimits + kSigmas + kOnePart + "round = \"R20\"\n"));
  expect_reads_back(
      with_analysis(kLimits + kSigmas + kOnePart + "round = \"0.0013 mm\"\nbounds = [\"0 mm\", \"1 mm\"]\n"));
  expect_reads_back(
      with_analysis(kLimits + kSigmas +
                    "[[analysis.parts]]\nfactors = \"linear\"\n"
                    "each = true\nidentical_limbs = [2, 1]\n[[analysis.parts]]\nfactors = \"angular\"\n"));
}

TEST(ResolvedTextOfTolerances, ListsPartsOneByOneInSi) {
  const std::string text = resolved_text(
      study_of(kLimits + kSigmas +
               "[[analysis.parts]]\nfactors = \"linear\"\neach = true\ncost = { law = \"reciprocal\", b = 1, unit = "
               "\"mm\" }\nbounds = [\"0 mm\", \"1 mm\"]\n"));
  const std::string one = R"(
[[analysis.parts]]
name = "delta_2"
factors = ["delta_2"]
sigmas = 3
shift = 0
cost = { law = "reciprocal", a = 0, b = 0.001, unit = "m" }
bounds = ["0 m", "0.001 m"]
)";
  EXPECT_NE(text.find(one), std::string::npos) << text;
  EXPECT_EQ(text.find("each"), std::string::npos);
  EXPECT_NE(text.find("\nsamples = 149000\n"), std::string::npos);
  EXPECT_NE(text.find("\naim = \"least-cost\"\n"), std::string::npos);
}

TEST(TemplateOfTolerances, RunsForEveryMechanism) {
  for (const Catalog* models : {&registry(), &kAllocationCatalog}) {
    for (const CatalogEntry& entry : *models) {
      const std::string text = template_text(entry, kStudy, kinds());
      const Study study = read(text, *models);
      const Options& asked = options_of(study);
      EXPECT_EQ(asked.parts.size(), study.analysis.factors.size()) << entry.description.name;
      EXPECT_EQ(asked.aim, Aim::least_cost);
      expect_reads_back(text, *models);
    }
  }
}

TEST(TemplateOfTolerances, ExplainsEveryKey) {
  const std::string text = template_text(kAllocationCatalog.front(), kStudy, kinds());
  for (const std::string_view path : {"analysis.parts", "analysis.parts.cost", "analysis.parts.processes"}) {
    const StudyTable* table = find_table(kinds().tables, path);
    ASSERT_NE(table, nullptr);
    for (const StudyKey& key : table->keys) {
      EXPECT_NE(text.find(std::string(key.name) + ": "), std::string::npos) << path << " " << key.name;
    }
  }
  for (const std::string line : {"\nsigmas = 3", "\n# cpk = 1.33", "\n# samples = 149000\n", "\nyield = 0.9973",
                                 "\nlimits = { linear_deformation = \"0.05 mm\" }", "\n# identical_limbs = [1, 2]\n",
                                 "\n# aim = \"least-cost\"\n"}) {
    EXPECT_NE(text.find(line), std::string::npos) << line;
  }
  std::istringstream lines(text.substr(text.find("\n[analysis]\n")));
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 121u) << line;
}

TEST(TemplateOfTolerances, NeedsErrorsAndResponses) {
  ModelDescription model = kAllocationCatalog.front().description;
  EXPECT_FALSE(kStudy.no_template(model));
  model.responses.clear();
  EXPECT_TRUE(kStudy.no_template(model));
}

TEST(SharedKeys, AreThoseOfTheKindWhereItHasItsOwn) {
  const StudyTable* table = find_table(kinds().tables, "analysis");
  EXPECT_TRUE(table->find("limits", "allocation")->required);
  EXPECT_FALSE(table->find("limits", "monte-carlo")->required);
  EXPECT_EQ(table->find("samples", "allocation")->type, "integer");
  EXPECT_EQ(table->find("samples", "sensitivity")->type, "integer or table");
  EXPECT_NE(table->find("yield", "allocation")->meaning, table->find("yield", "monte-carlo")->meaning);
  const std::string reference = study_reference(kinds());
  EXPECT_NE(reference.find("## `[analysis.parts.cost]`, `[analysis.parts.processes.cost]`"), std::string::npos);
}

TEST(SharedKeys, OfAnotherKindAreRefusedOrIgnoredAsBefore) {
  EXPECT_EQ(study_of(kLimits + kSigmas + "conf_level = 0.5\n" + kOnePart).analysis.samples, 149'000u);
  test::expect_input_error([&] { study_of(kLimits + kSigmas + "draws = \"per pose\"\n" + kOnePart); },
                           {"study.toml", 9, 1}, {"analysis.draws does not belong to kind = \"allocation\""});
}

struct BadStudy {
  const char* name;
  std::string analysis;  ///< text of [analysis]; a ^ marks the place of the mistake
  std::vector<std::string> words;
  std::string errors = {};  ///< text of [errors]
};

void PrintTo(const BadStudy& bad, std::ostream* out) { *out << bad.name; }

class BadTolerances : public testing::TestWithParam<BadStudy> {};

TEST_P(BadTolerances, AreRefused) {
  const test::Marked bad(with_analysis(GetParam().analysis, GetParam().errors));
  test::expect_input_error([&] { read(bad.text); }, {"study.toml", bad.line, bad.column}, GetParam().words);
}

const auto kName = [](const auto& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    Analysis, BadTolerances,
    testing::Values(
        BadStudy{"YieldOfZero", "yield = ^0", {"analysis.yield is 0", "between 0 and 1"}},
        BadStudy{"YieldOfOne", "yield = ^1", {"analysis.yield is 1", "between 0 and 1"}},
        BadStudy{"YieldInPercent", "yield = ^99.73", {"between 0 and 1"}},
        BadStudy{"NegativeYield", "yield = ^-0.5", {"between 0 and 1"}},
        BadStudy{"ConfidenceOfZero", "confidence = ^0.0", {"analysis.confidence is 0", "between 0 and 1"}},
        BadStudy{"ConfidenceOfOne", "confidence = ^1.0", {"analysis.confidence is 1", "between 0 and 1"}},
        BadStudy{"AdaptiveSamples", "samples = ^{ max = 5000 }", {"analysis.samples is a table", "samples = 149000"}},
        BadStudy{"TooFewSamples",
                 "samples = ^1108",
                 {"1108 machines cannot certify a yield of 0.9973 at a confidence of 0.95", "samples = 1109 or more"}},
        BadStudy{"TooFewUsualSamples",
                 "yield = ^0.9999999",
                 {"20000000 machines cannot certify a yield of 0.9999999", "samples = 29957322 or more"}},
        BadStudy{"UnknownAim", "aim = ^\"least_cost\"", {"did you mean 'least-cost'?"}},
        BadStudy{"LeastCostWithoutCosts",
                 kLimits + kSigmas + "aim = ^\"least-cost\"\n" + kOnePart,
                 {"analysis.aim is \"least-cost\", but no part has a cost", "choose another aim"}},
        BadStudy{"SigmasAndCpk",
                 "sigmas = 3\ncpk = ^1",
                 {"analysis.cpk is set, and so is analysis.sigmas", "cpk is sigmas / 3"}},
        BadStudy{"NoSigmas", "sigmas = ^0", {"analysis.sigmas is 0", "greater than zero"}},
        BadStudy{"NegativeCpk", "cpk = ^-1", {"analysis.cpk is -1", "greater than zero"}},
        BadStudy{"NoParts", kLimits + "parts = ^[]", {"analysis.parts is empty", "[[analysis.parts]]"}},
        BadStudy{"LimitOfZero", "limits = { linear_deformation = ^\"0 mm\" }", {"greater than zero"}}),
    kName);

TEST(StudyOfTolerances, AsksForLimitsAndParts) {
  test::expect_input_error([] { study_of(kSigmas + kOnePart); }, {"study.toml", 5, 1},
                           {"'limits' is missing in [analysis]", "limits = { linear_deformation = \"0.05 mm\" }"});
  test::expect_input_error([] { study_of(kLimits); }, {"study.toml", 5, 1},
                           {"'parts' is missing in [analysis]", "[[analysis.parts]]"});
}

/// The analysis of a study with one block of parts. keys: the keys of the block.
std::string block(const std::string& keys) { return kLimits + kSigmas + "[[analysis.parts]]\n" + keys; }

std::string of_delta(const std::string& keys) { return block("factors = [\"delta_1\"]\n" + keys); }

INSTANTIATE_TEST_SUITE_P(
    Errors, BadTolerances,
    testing::Values(
        BadStudy{"NoFactors", kLimits + kSigmas + "^[[analysis.parts]]\nname = \"a\"", {"'factors' is missing"}},
        BadStudy{"EmptyFactors", block("factors = ^[]"), {"factors is empty"}},
        BadStudy{"UnknownName", block("factors = [\"delta_1\", ^\"dleta_2\"]"), {"did you mean 'delta_2'?"}},
        BadStudy{"PatternOfNothing",
                 block("factors = [^\"gamma_*\"]"),
                 {"parts[0].factors[0] is 'gamma_*', which is none of the model's errors", "poesy models fake"}},
        BadStudy{"UnknownSet", block("factors = ^\"bening\""), {"did you mean 'benign'?"}},
        BadStudy{"NameThatDoesNotVary",
                 kLimits + kSigmas + "factors = [\"delta_1\"]\n[[analysis.parts]]\nfactors = [^\"delta_2\"]",
                 {"the study does not vary 'delta_2'", "analysis.factors"}},
        BadStudy{"SetThatDoesNotVary",
                 kLimits + kSigmas + "factors = [\"delta_1\"]\n[[analysis.parts]]\nfactors = ^\"deforming\"",
                 {"has 'epsilon_1', which the study does not vary"}},
        BadStudy{"NoAngles",
                 kLimits + kSigmas + "factors = [\"delta_1\"]\n[[analysis.parts]]\nfactors = ^\"angular\"",
                 {"no error that the study varies is an angle"}},
        BadStudy{"InTwoParts",
                 block("name = \"pins\"\nfactors = [\"delta_1\"]\n[[analysis.parts]]\nname = \"holes\"\n"
                       "factors = ^[\"delta_*\"]"),
                 {"puts 'delta_1' into part 'holes', but part 'pins' has it as well"}},
        BadStudy{"LengthsAndAngles",
                 block("factors = ^[\"*_1\"]"),
                 {"has the length 'delta_1' and the angle 'epsilon_1', but a part has one tolerance",
                  "factors = \"linear\""}},
        BadStudy{"OneCostForBoth",
                 block("factors = ^\"all\"\neach = true\ncost = { law = \"reciprocal\", b = 1, unit = \"mm\" }"),
                 {"the angle 'epsilon_1', and 'cost' cannot hold for both", "factors = \"angular\""}},
        BadStudy{"Measured",
                 block("factors = ^[\"delta_1\"]"),
                 {"has 'delta_1', whose distribution is measured", "leave it out of all parts"},
                 "[errors.override.delta_1]\ndistribution = \"measured\"\nvalues = [\"1 mm\", \"2 mm\", \"3 mm\", "
                 "\"4 mm\", \"5 mm\", \"6 mm\", \"7 mm\", \"8 mm\"]\n"},
        BadStudy{"Correlated",
                 block("factors = ^[\"delta_*\"]"),
                 {"has 'delta_1', which errors.correlated correlates with others"},
                 "[errors]\ncorrelated = [{ factors = [\"delta_1\", \"epsilon_1\"], correlation = [[1, 0.5], [0.5, "
                 "1]] }]\n"},
        BadStudy{"TwoPartsOfOneName",
                 of_delta("name = \"a\"\n[[analysis.parts]]\nname = ^\"a\"\nfactors = [\"delta_2\"]"),
                 {"is 'a', which another one has"}},
        BadStudy{"NameOfAnotherPartsError",
                 block("name = \"delta_2\"\nfactors = [\"delta_1\"]\n^[[analysis.parts]]\nfactors = "
                       "[\"delta_2\"]\neach = true"),
                 {"has the name of its error 'delta_2', which another part has", "another name"}},
        BadStudy{"NameOfEach", of_delta("each = true\nname = ^\"a\""), {"name is set, but with each = true"}},
        BadStudy{"IdenticalWithoutEach",
                 block("factors = \"linear\"\nidentical_limbs = ^[1, 2]"),
                 {"identical_limbs is set, but each is not true", "each = true"}},
        BadStudy{"UnknownLimb",
                 block("factors = \"linear\"\neach = true\nidentical_limbs = [1, ^3]"),
                 {"is 3, but model \"fake\" has errors of limbs 1, 2"}},
        BadStudy{"LimbTwice",
                 block("factors = \"linear\"\neach = true\nidentical_limbs = [1, ^1]"),
                 {"names limb 1 a second time"}},
        BadStudy{
            "OneLimb", block("factors = \"linear\"\neach = true\nidentical_limbs = ^[1]"), {"fewer than two limbs"}},
        BadStudy{"UnknownKey", of_delta("^tolerances = 1"), {"unknown key 'tolerances'", "'tolerance'"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Choices, BadTolerances,
    testing::Values(
        BadStudy{"NeitherSigmasNorCpk",
                 kLimits + "^[[analysis.parts]]\nfactors = [\"delta_1\"]",
                 {"part 'delta_1' has neither sigmas nor cpk",
                  "say how many standard deviations a tolerance is: sigmas = 3 or cpk = 1"}},
        BadStudy{"BothSigmasAndCpk", of_delta("sigmas = 3\ncpk = ^1"), {"parts[0].cpk is set, and so is"}},
        BadStudy{"SigmasOfZero", of_delta("sigmas = ^0"), {"greater than zero"}},
        BadStudy{"EndlessSigmas", of_delta("sigmas = ^1e7"), {"below"}},
        BadStudy{"NegativeShift", of_delta("shift = ^-0.1"), {"it must be at least 0 and less than 1"}},
        BadStudy{"WholeShift", of_delta("shift = ^1"), {"it must be at least 0 and less than 1"}},
        BadStudy{"ReversedBounds",
                 of_delta("bounds = [\"0.5 mm\", ^\"0.1 mm\"]"),
                 {"bounds[1] is '0.1 mm', less than '0.5 mm' before it"}},
        BadStudy{"NegativeBound", of_delta("bounds = [^\"-1 mm\", \"1 mm\"]"), {"a tolerance is at least 0"}},
        BadStudy{"UpperBoundOfZero", of_delta("bounds = [\"0 mm\", ^\"0 mm\"]"), {"greater than zero"}},
        BadStudy{"OneBound", of_delta("bounds = ^[\"1 mm\"]"), {"has 1 values", "the least and the largest"}},
        BadStudy{"BoundsInDegrees", of_delta("bounds = [^\"1 deg\", \"2 deg\"]"), {"must be a length"}},
        BadStudy{"BoundsAndValues",
                 of_delta("bounds = [\"0 mm\", \"1 mm\"]\nvalues = ^[\"1 mm\"]"),
                 {"values is set, and so is analysis.parts[0].bounds", "write one of"}},
        BadStudy{"BoundsAndTolerance",
                 of_delta("bounds = [\"0 mm\", \"1 mm\"]\ntolerance = ^\"1 mm\""),
                 {"tolerance is set, and so is"}},
        BadStudy{"DescendingValues", of_delta("values = [\"2 mm\", ^\"1 mm\"]"), {"ascending order"}},
        BadStudy{"ValueOfZero", of_delta("values = [^\"0 mm\"]"), {"greater than zero"}},
        BadStudy{"UnknownSeries", of_delta("round = ^\"R40\""), {"round is 'R40'", "R5, R10 or R20"}},
        BadStudy{"RoundedToNothing", of_delta("round = ^\"0 mm\""), {"greater than zero"}},
        BadStudy{"RoundedToAnAngle", of_delta("round = ^\"1 deg\""), {"1 deg"}},
        BadStudy{"RoundedValues",
                 of_delta("values = [\"1 mm\"]\nround = ^\"R10\""),
                 {"has a list of the tolerances that can be had", "remove it"}},
        BadStudy{"NothingWithinTheBounds",
                 of_delta("bounds = [\"1.1 mm\", \"1.2 mm\"]\nround = ^\"R10\""),
                 {"no such value is within the bounds", "finer step"}},
        BadStudy{"NoValues", of_delta("values = ^[]"), {"values is empty"}},
        BadStudy{"ToleranceOfZero", of_delta("tolerance = ^\"0 mm\""), {"greater than zero"}},
        BadStudy{"GradesWithoutSize", of_delta("grades = ^[\"IT7\"]"), {"nominal_size is missing", "50 mm"}},
        BadStudy{"SizeWithoutGrades", of_delta("nominal_size = ^\"5 mm\""), {"the part has no grades"}},
        BadStudy{"UnknownGrade", of_delta("nominal_size = \"5 mm\"\ngrades = [^\"IT19\"]"), {"'IT19'"}},
        BadStudy{"GradesOutOfOrder",
                 of_delta("nominal_size = \"5 mm\"\ngrades = [\"IT7\", ^\"IT6\"]"),
                 {"is IT6, not coarser", "finest one first"}},
        BadStudy{"GradeThatASizeHasNot",
                 of_delta("nominal_size = \"0.6 m\"\ngrades = [^\"IT0\"]"),
                 {"is IT0, for which ISO 286-1 has no value at a nominal size of 600 mm"}},
        BadStudy{"SizeBeyondTheStandard",
                 of_delta("nominal_size = ^\"4 m\"\ngrades = [\"IT7\"]"),
                 {"'4 m', for which ISO 286-1 has no grades", "3150 mm"}},
        BadStudy{"GradesOfAngles",
                 block("factors = [\"epsilon_1\"]\ngrades = ^[\"IT7\"]\nnominal_size = \"5 mm\""),
                 {"the part's errors are angles", "write values"}},
        BadStudy{"NoGrades", of_delta("grades = ^[]\nnominal_size = \"5 mm\""), {"grades is empty"}},
        BadStudy{"BoundBeyondThePart",
                 of_delta("bounds = [\"0 mm\", ^\"60 mm\"]"),
                 {"bounds[1] gives delta_1 a tolerance of 60 mm, no less than the arm (60 mm)"}},
        BadStudy{"ValueBeyondThePart", of_delta("values = [\"1 mm\", ^\"70 mm\"]"), {"values[1] gives delta_1"}},
        BadStudy{"GradeBeyondThePart",
                 block("factors = [\"delta_2\"]\ngrades = [\"IT7\", ^\"IT18\"]\nnominal_size = \"3 m\""),
                 {"grades[1] gives delta_2 a tolerance of 16.5 mm, no less than the hole (10 mm)"}},
        BadStudy{"ToleranceBeyondThePart",
                 block("factors = [\"epsilon_1\"]\ntolerance = ^\"4 rad\""),
                 {"no less than three radians"}},
        BadStudy{"ProcessBeyondThePart",
                 of_delta("processes = [{ cost = { law = \"reciprocal\", b = 1, unit = \"mm\" }, bounds = [\"0 mm\", "
                          "^\"70 mm\"] }]"),
                 {"processes[0].bounds[1] gives delta_1"}}),
    kName);

std::string with_cost(const std::string& cost) { return of_delta("cost = " + cost); }

INSTANTIATE_TEST_SUITE_P(
    Costs, BadTolerances,
    testing::Values(
        BadStudy{"NoLaw", with_cost("^{ b = 1, unit = \"mm\" }"), {"'law' is missing", "\"reciprocal\""}},
        BadStudy{"UnknownLaw", with_cost("{ law = ^\"linear\", b = 1 }"), {"known: reciprocal, reciprocal-power"}},
        BadStudy{"LawNone", with_cost("{ law = ^\"none\" }"), {"'none', which is unknown"}},
        BadStudy{"NegativeA",
                 with_cost("{ law = \"reciprocal\", a = ^-1, b = 1, unit = \"mm\" }"),
                 {"cost.a is -1", "at least 0"}},
        BadStudy{
            "NegativeB", with_cost("{ law = \"reciprocal\", b = ^-1, unit = \"mm\" }"), {"cost.b is -1", "at least 0"}},
        BadStudy{"EndlessB", with_cost("{ law = \"reciprocal\", b = ^inf, unit = \"mm\" }"), {"is not finite"}},
        BadStudy{"NoB", with_cost("^{ law = \"reciprocal\", unit = \"mm\" }"), {"'b' is missing"}},
        BadStudy{"NoUnit", with_cost("^{ law = \"reciprocal\", b = 1 }"), {"'unit' is missing", "unit = \"mm\""}},
        BadStudy{"UnknownUnit",
                 with_cost("{ law = \"reciprocal\", b = 1, unit = ^\"foot\" }"),
                 {"is 'foot', which is not a unit of the part's tolerance, a length",
                  "known: m, cm, mm, um, in, mil, thou"}},
        BadStudy{"UnitOfAngles",
                 with_cost("{ law = \"reciprocal\", b = 1, unit = ^\"deg\" }"),
                 {"not a unit of the part's tolerance, a length"}},
        BadStudy{"UnitOfAnExponential",
                 with_cost("{ law = \"exponential\", b = 1, tau = \"1 mm\", ^unit = \"mm\" }"),
                 {"cost.unit does not belong to the cost law \"exponential\""}},
        BadStudy{"NoTau", with_cost("^{ law = \"exponential\", b = 1 }"), {"'tau' is missing", "\"0.1 mm\""}},
        BadStudy{"TauOfZero", with_cost("{ law = \"exponential\", b = 1, tau = ^\"0 mm\" }"), {"greater than zero"}},
        BadStudy{"NoPower", with_cost("^{ law = \"reciprocal-power\", b = 1, unit = \"mm\" }"), {"'k' is missing"}},
        BadStudy{"PowerOfZero",
                 with_cost("{ law = \"reciprocal-power\", b = 1, k = ^0, unit = \"mm\" }"),
                 {"greater than zero"}},
        BadStudy{"PowerOfAReciprocal",
                 with_cost("{ law = \"reciprocal\", b = 1, ^k = 2, unit = \"mm\" }"),
                 {"k does not belong to the cost law \"reciprocal\""}},
        BadStudy{"PowerThatVanishesInSi",
                 with_cost("{ law = \"reciprocal-power\", b = ^1, k = 200, unit = \"mm\" }"),
                 {"out of range", "smaller power"}},
        BadStudy{"CostAndProcesses",
                 of_delta("cost = ^{ law = \"reciprocal\", b = 1, unit = \"mm\" }\nprocesses = [{ cost = { law = "
                          "\"reciprocal\", b = 1, unit = \"mm\" } }]"),
                 {"cost is set, but each of the processes has a cost"}},
        BadStudy{"NoProcesses", of_delta("processes = ^[]"), {"processes is empty"}},
        BadStudy{"ProcessWithoutCost", of_delta("processes = [^{ name = \"a\" }]"), {"'cost' is missing"}},
        BadStudy{"ProcessesOfOneName",
                 of_delta("processes = [{ name = \"2\", cost = { law = \"reciprocal\", b = 1, unit = \"mm\" } }, ^{ "
                          "cost = { law = \"reciprocal\", b = 1, unit = \"mm\" } }]"),
                 {"it has no name, and '2' is taken"}},
        BadStudy{"NegativeCostOfAProcess",
                 of_delta("processes = [{ cost = { law = \"reciprocal\", b = ^-1, unit = \"mm\" } }]"),
                 {"processes[0].cost.b is -1"}}),
    kName);

}  // namespace
}  // namespace poesy::allocation
