#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "engine/kinds/study_file.h"
#include "engine/random/normal_quantile.h"
#include "engine/random/stream.h"
#include "engine/study/plan.h"
#include "engine/study/study.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

constexpr std::string_view kHead =
    "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\ncount = 3\n";

/// The text of a Monte Carlo study of the fake mechanism. errors: text of [errors]; analysis: text of [analysis].
std::string study_text(const std::string& errors,
                       const std::string& analysis = "kind = \"monte-carlo\"\ndraws = \"per pose\"\n") {
  return std::string(kHead) + "[analysis]\n" + analysis + "[errors]\n" + errors;
}

Study read(const std::string& text, const std::string& path = "study.toml", StudyUse use = StudyUse::run) {
  return study_of_text(text, path, kFakeCatalog, use);
}

/// Expects that reading the study fails with these words at the place of '^'.
void expect_refused(const std::string& marked, const std::vector<std::string>& words,
                    const std::string& path = "study.toml") {
  const Marked text(marked);
  expect_input_error([&] { read(text.text, path); }, {path, text.line, text.column}, words);
}

/// A table of ten measured parts, in which the columns hole and tilt are correlated.
constexpr std::string_view kParts =
    "part,hole [mm],tilt,other\n"
    "a,0.01,1e-4,x\nb,0.02,3e-4,x\nc,0.05,5e-4,x\nd,0.03,2e-4,x\ne,-0.01,-1e-4,x\n"
    "f,0.00,0,x\ng,0.04,6e-4,x\nh,0.015,1.5e-4,x\ni,0.025,4e-4,x\nj,-0.02,-2e-4,x\n";

std::string measured(const std::string& factor, const std::string& column) {
  return factor + " = { distribution = \"measured\", file = \"parts.csv\", column = \"" + column + "\" }\n";
}

class MeasuredErrors : public ::testing::Test {
 protected:
  std::string path() const { return folder_.path() + "/study.toml"; }
  Study read_here(const std::string& text, StudyUse use = StudyUse::run) const { return read(text, path(), use); }

  TempFolder folder_;
};

TEST_F(MeasuredErrors, AreReadFromATableBesideTheStudy) {
  folder_.write("parts.csv", kParts);
  const Study study =
      read_here(study_text("[errors.override]\n" + measured("delta_1", "hole [mm]") + measured("epsilon_1", "tilt")));
  const Distribution& hole = study.errors.by_factor[0];
  ASSERT_EQ(hole.shape(), Distribution::Shape::measured);
  ASSERT_EQ(hole.parts()->values().size(), 10u);
  EXPECT_EQ(hole.parts()->values().front(), 0.01 * 1e-3);
  EXPECT_EQ(hole.parts()->values()[2], 0.05 * 1e-3);
  EXPECT_EQ(study.errors.by_factor[1].parts()->values()[6], 6e-4);
  EXPECT_EQ(study.errors.by_factor[2].shape(), Distribution::Shape::normal);
  EXPECT_EQ(read_here(study_text("[errors.override]\n" + measured("delta_1", "hole"))).errors.by_factor[0], hole);
}

TEST_F(MeasuredErrors, StandInTheResolvedStudyWithoutTheFile) {
  folder_.write("parts.csv", kParts);
  const Study study = read_here(study_text("correlated = \"as measured\"\n[errors.override]\n" +
                                           measured("delta_1", "hole") + measured("epsilon_1", "tilt")));
  const std::string text = resolved_text(study);
  EXPECT_EQ(text.find("parts.csv"), std::string::npos);
  const Study again = read(text, "elsewhere.toml");
  EXPECT_EQ(again.errors.by_factor, study.errors.by_factor);
  ASSERT_EQ(again.errors.correlated.size(), 1u);
  EXPECT_EQ(again.errors.correlated[0].factors, study.errors.correlated[0].factors);
  EXPECT_EQ(again.errors.correlated[0].correlation, study.errors.correlated[0].correlation);
  EXPECT_EQ(resolved_text(again), text);
}

// Spearman's rank correlation of the two columns is 1 - 6 * 10 / 990, because the squared differences of the ranks add
// up to 10.
TEST_F(MeasuredErrors, KeepTheirRankCorrelation) {
  folder_.write("parts.csv", kParts);
  const std::string errors = "[errors.override]\n" + measured("delta_1", "hole") + measured("epsilon_1", "tilt");
  const std::vector<CorrelatedErrors> found =
      read_here(study_text("correlated = \"as measured\"\n" + errors)).errors.correlated;
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].factors, (std::vector{FactorIndex(0), FactorIndex(1)}));
  const double rank = 1.0 - 6.0 * 8.0 / 990.0;
  EXPECT_NEAR(found[0].correlation[1], 2.0 * std::sin(std::acos(-1.0) / 6.0 * rank), 1e-14);
  const std::string block = "[[errors.correlated]]\nfactors = \"deforming\"\ncorrelation = \"as measured\"\n";
  EXPECT_EQ(read_here(study_text(errors + block)).errors.correlated[0].correlation, found[0].correlation);
}

/// Like parts of several limbs take the same columns: a pattern names them, and each part has a block of its own.
TEST_F(MeasuredErrors, OfPatternsAreCorrelatedByPart) {
  folder_.write("parts.csv", kParts);
  const std::string errors = "[errors.override]\n" + measured("\"delta_*\"", "hole") + measured("epsilon_1", "tilt");
  const std::string part =
      "[[errors.correlated]]\nfactors = [\"delta_2\", \"epsilon_1\"]\ncorrelation = \"as measured\"\n";
  EXPECT_EQ(read_here(study_text(errors + part)).errors.correlated.size(), 1u);
  expect_refused(study_text("correlated = ^\"as measured\"\n" + errors),
                 {"delta_1 and delta_2, which take the same column 'hole' of parts.csv", "for each part"}, path());
}

TEST_F(MeasuredErrors, AreNotOpenedWhereErrorsAreGiven) {
  const std::string errors =
      "correlated = \"as measured\"\n[errors.override]\n" + measured("delta_1", "hole") + measured("epsilon_1", "tilt");
  EXPECT_NO_THROW(read_here(study_text(errors), StudyUse::evaluate));
}

TEST_F(MeasuredErrors, AreRefusedWithThePlaceInTheTable) {
  const std::string table = folder_.path() + "/parts.csv";
  const std::string text = study_text("[errors.override]\n" + measured("delta_1", "hole"));
  const auto expect_at = [&](const std::string& content, const Place& place, const std::vector<std::string>& words) {
    folder_.write("parts.csv", content);
    expect_input_error([&] { read_here(text); }, place, words);
  };
  expect_at("part,holes\na,1\n", {table, 1, 1}, {"no column is 'hole'", "'holes'"});
  expect_at("hole,hole [mm]\n1,1\n", {table, 1, 6}, {"a second time"});
  expect_at("part,hole [deg]\na,1\n", {table, 1, 6}, {"a unit of angle"});
  expect_at("part,hole\na,0.1\nb,wide\n", {table, 3, 3}, {"'wide'", "hole"});
  expect_at("part,hole\na,0.1\nb,inf\n", {table, 3, 3}, {"'inf'"});
  expect_at("part,hole\na,0.1,3\n", {table, 2, 7}, {"2 cells"});
  expect_at("hole [mm]\n1\n2\n3\n4\n5\n6\n7\n", {table}, {"too few values", "7", "at least 8"});
}

TEST_F(MeasuredErrors, AreRefusedWithThePlaceInTheStudy) {
  folder_.write(
      "parts.csv", "equal,large\n" + [] {
        std::string rows;
        for (int k = 0; k < 9; ++k) rows += "0.1," + std::to_string(k) + "\n";
        return rows;
      }());
  const auto refused = [&](const std::string& own, const std::vector<std::string>& words) {
    expect_refused(study_text("[errors.override]\ndelta_1 = " + own + "\n"), words, path());
  };
  const std::string eight = "[\"1 mm\", \"2 mm\", \"3 mm\", \"4 mm\", \"5 mm\", \"6 mm\", \"7 mm\", \"8 mm\"]";
  refused("^{ distribution = \"measured\", file = \"parts.csv\", column = \"equal\" }", {"must not all be equal"});
  refused("^{ distribution = \"measured\" }", {"'file' is missing", "values = [...]"});
  refused("^{ distribution = \"measured\", file = \"parts.csv\" }", {"'column' is missing"});
  refused("{ distribution = \"measured\", values = [\"1 mm\", ^2] }", {"bare number"});
  refused("{ distribution = \"measured\", values = ^[\"1 mm\", \"2 mm\"] }", {"has 2 values", "at least 8"});
  refused("{ distribution = \"measured\", values = " + eight + ", ^file = \"parts.csv\" }", {"does not belong"});
  refused("{ distribution = \"normal\", sigma = \"1 mm\", ^file = \"parts.csv\" }", {"does not belong"});
}

std::string block(const std::string& factors, const std::string& correlation) {
  return "[[errors.correlated]]\nfactors = " + factors + "\ncorrelation = " + correlation + "\n";
}

const std::string kTwo = "[\"delta_1\", \"epsilon_1\"]";

TEST(CorrelatedErrorsFile, IsReadAndWritten) {
  const Study study = read(study_text(block("[\"delta_2\", \"delta_1\"]", "[[1, -0.25], [-0.25, 1.0]]")));
  ASSERT_EQ(study.errors.correlated.size(), 1u);
  EXPECT_EQ(study.errors.correlated[0].factors, (std::vector{FactorIndex(2), FactorIndex(0)}));
  EXPECT_EQ(study.errors.correlated[0].correlation, (std::vector{1.0, -0.25, -0.25, 1.0}));
  const std::string text = resolved_text(study);
  EXPECT_EQ(resolved_text(read(text)), text);
  EXPECT_NE(text.find("\n[[errors.correlated]]\n"), std::string::npos);
}

TEST(CorrelatedErrorsFile, RefusesWhatIsNoCorrelation) {
  const auto refused = [](const std::string& factors, const std::string& correlation,
                          const std::vector<std::string>& words) {
    expect_refused(study_text(block(factors, correlation)), words);
  };
  refused(kTwo, "[[1, 0.5], [^0.4, 1]]", {"is 0.4", "is 0.5", "symmetric"});
  refused(kTwo, "[[1, 0.5], [0.5, ^2]]", {"between -1 and 1"});
  refused(kTwo, "[[^0.9, 0.5], [0.5, 1]]", {"with itself is 1"});
  refused(kTwo, "^[[1, 0.5]]", {"1 values", "2 rows of 2"});
  refused(kTwo, "[[1, 0.5], ^[0.5]]", {"2 rows of 2"});
  refused(kTwo, "^[[1, 1], [1, 1]]", {"smallest eigenvalue is 0"});
  refused("\"all\"", "^[[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]]", {"smallest eigenvalue is -0.8"});
  refused("^[\"delta_1\"]", "[[1]]", {"names one error"});
  refused("[\"delta_1\", ^\"delta_1\"]", "[[1, 0.5], [0.5, 1]]", {"a second time"});
  refused(kTwo, "^\"as measured\"", {"delta_1 is not a column"});
  refused(kTwo, "^\"measured\"", {"unknown", "as measured"});
  expect_refused(study_text("correlated = ^\"as measured\"\n"), {"no two errors"});
  expect_refused(
      study_text(block(kTwo, "[[1, 0.5], [0.5, 1]]") + block("^[\"delta_2\", \"delta_1\"]", "[[1, 0.5], [0.5, 1]]")),
      {"'delta_1'", "another block"});
}

TEST(CorrelatedErrorsFile, IsForErrorsThatVaryTogether) {
  const std::string two = "correlated = ^[{ factors = " + kTwo + ", correlation = [[1, 0.5], [0.5, 1]] }]\n";
  expect_refused(study_text(two, "kind = \"sensitivity\"\n"),
                 {"delta_1, epsilon_1", "varies one error at a time", "kind = \"monte-carlo\""});
  expect_refused(
      study_text(two, "kind = \"monte-carlo\"\ndraws = \"per pose\"\nfactors = [\"delta_1\", \"delta_2\"]\n"),
      {"'epsilon_1'", "does not vary"});
}

/// A plan with the three errors of the fake mechanism. The first and the last error are correlated.
Plan plan_of(const std::string& kind = "kind = \"monte-carlo\"\ndraws = \"per pose\"\n") {
  const Study study =
      read(study_text("override = { delta_2 = { distribution = \"uniform\", half_width = \"2 mm\" } }\n" +
                          block("[\"delta_2\", \"delta_1\"]", "[[1, 0.75], [0.75, 1]]"),
                      kind));
  return {study, PoseSet(3, {-0.2, 0.0, 0.0})};
}

TEST(PlanOfCorrelatedErrors, TransformsBlocksTogetherAndOthersAlone) {
  constexpr std::size_t kCount = 50;
  const Plan plan = plan_of();
  EXPECT_TRUE(plan.is_correlated(0));
  EXPECT_FALSE(plan.is_correlated(1));
  EXPECT_TRUE(plan.is_correlated(2));
  std::vector<double> uniforms(3 * kCount);
  for (std::size_t v = 0; v < 3; ++v) {
    fill_uniforms(plan.address(v, PoseIndex(0)), SampleIndex(0), std::span(uniforms).subspan(v * kCount, kCount));
  }
  std::vector<double> errors = uniforms;
  plan.transform(errors, kCount);
  for (std::size_t b = 0; b < kCount; ++b) {
    // delta_2 is the first error of the block, so it keeps its own draw. delta_1 depends on it.
    EXPECT_NEAR(errors[2 * kCount + b], plan.distributions()[2].quantile(uniforms[2 * kCount + b]), 1e-17);
    EXPECT_EQ(errors[kCount + b], plan.distributions()[1].quantile(uniforms[kCount + b]));
    const double z = 0.75 * normal_quantile(1.0, uniforms[2 * kCount + b]) +
                     std::sqrt(1.0 - 0.75 * 0.75) * normal_quantile(1.0, uniforms[b]);
    EXPECT_NEAR(errors[b], 1e-3 * z, 1e-17);
  }
}

TEST(PlanOfCorrelatedErrors, ASampleDependsOnItselfAlone) {
  const Plan plan = plan_of();
  std::vector<double> many(3 * 40);
  for (std::size_t k = 0; k < many.size(); ++k) many[k] = (static_cast<double>(k) + 0.5) / 120.0;
  std::vector<double> one{many[7], many[47], many[87]};
  plan.transform(many, 40);
  plan.transform(one, 1);
  EXPECT_EQ(one, (std::vector{many[7], many[47], many[87]}));
}

}  // namespace
}  // namespace poesy::test
