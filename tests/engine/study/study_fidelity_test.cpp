#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "engine/study/study.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

/// The fake mechanism at two fidelities. The second has an arm twice as long.
Catalog catalog_with_choice() {
  Catalog catalog = test::fake_catalog();
  catalog[0].description.fidelities = {"exact", "first-order"};
  catalog[0].build = [](std::span<const double> geometry, std::size_t fidelity) {
    return std::make_unique<test::FakeModel>(geometry[0] * (fidelity == 0 ? 1.0 : 2.0));
  };
  return catalog;
}

const Catalog kFidelityCatalog = catalog_with_choice();

std::string study_with(std::string_view line) {
  return "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n" + std::string(line) +
         "[poses]\ncount = 3\n";
}

Study study_of(std::string_view text) {
  const test::TempFolder folder;
  return read_study(folder.write("study.toml", text), kFidelityCatalog, StudyUse::run);
}

double first_response(const Study& study) {
  const std::vector<double> pose{-0.2, 0.0, 0.0};
  const std::vector<double> errors{1e-3, 0.0, 0.0};
  std::array<double, 2> responses{};
  SolveStatus status{};
  std::uint32_t iterations = 0;
  build_model(study.mechanism)
      ->evaluator({})
      ->evaluate({pose, errors, {}, {}, 1}, {responses, std::span(&status, 1), std::span(&iterations, 1), {}});
  return responses[0];
}

TEST(Fidelity, DefaultIsTheFirst) { EXPECT_EQ(study_of(study_with("")).mechanism.fidelity, 0u); }

TEST(Fidelity, ReachesTheModel) {
  const double exact = first_response(study_of(study_with("fidelity = \"exact\"\n")));
  EXPECT_EQ(exact, first_response(study_of(study_with(""))));
  EXPECT_EQ(2.0 * exact, first_response(study_of(study_with("fidelity = \"first-order\"\n"))));
}

TEST(Fidelity, StandsInTheResolvedText) {
  EXPECT_NE(resolved_text(study_of(study_with(""))).find("\nfidelity = \"exact\"\n"), std::string::npos);
  const Study study = study_of(study_with("fidelity = \"first-order\"\n"));
  EXPECT_EQ(study_of(resolved_text(study)).mechanism.fidelity, 1u);
}

TEST(Fidelity, StandsInTheTemplate) {
  const std::string text = template_text(kFidelityCatalog[0], sensitivity::kStudy);
  EXPECT_NE(text.find("\nfidelity = \"exact\"\n"), std::string::npos) << text;
  EXPECT_EQ(study_of(text).mechanism.fidelity, 0u);
  EXPECT_EQ(template_text(test::fake_catalog()[0], sensitivity::kStudy).find("\nfidelity"), std::string::npos);
}

TEST(Fidelity, UnknownOneIsRefusedWithASuggestion) {
  const test::Marked study(study_with("fidelity = ^\"frist-order\"\n"));
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", study.text);
  test::expect_input_error([&] { read_study(path, kFidelityCatalog, StudyUse::run); }, {path, study.line, study.column},
                           {"mechanism.fidelity is 'frist-order'", "did you mean 'first-order'?"});
}

TEST(BothFidelities, AreReadAndWritten) {
  const Study study = study_of(study_with("fidelity = \"both\"\n"));
  EXPECT_EQ(study.mechanism.fidelity, 0u);
  EXPECT_EQ(study.mechanism.compared, 1u);
  EXPECT_EQ(asked_of<sensitivity::Options>(study.analysis).linearity, 0.01);
  const std::string text = resolved_text(study);
  EXPECT_NE(text.find("\nfidelity = \"both\"\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nlinearity = 0.01\n"), std::string::npos) << text;
  EXPECT_EQ(resolved_text(study_of(text)), text);
  EXPECT_EQ(resolved_text(study_of(study_with(""))).find("linearity"), std::string::npos);
}

TEST(BothFidelities, LinearityIsRead) {
  const std::string text = study_with("fidelity = \"both\"\n") + "[analysis]\nlinearity = 0.05\n";
  const Study study = study_of(text);
  EXPECT_EQ(asked_of<sensitivity::Options>(study.analysis).linearity, 0.05);
  const Study again = study_of(resolved_text(study));
  EXPECT_EQ(asked_of<sensitivity::Options>(again.analysis).linearity, 0.05);
}

TEST(BothFidelities, SecondIsSolvedAlone) {
  Study study = study_of(study_with("fidelity = \"both\"\n"));
  const double first = first_response(study);
  study.mechanism = at_compared_fidelity(study.mechanism);
  EXPECT_EQ(first_response(study), 2.0 * first);
  EXPECT_FALSE(study.mechanism.compared);
}

TEST(BothFidelities, StandInTheTemplateOfSensitivityAlone) {
  const std::string text = template_text(kFidelityCatalog[0], sensitivity::kStudy);
  EXPECT_NE(text.find("# fidelity = \"both\""), std::string::npos) << text;
  EXPECT_NE(text.find("# linearity = 0.01"), std::string::npos) << text;
  EXPECT_EQ(template_text(kFidelityCatalog[0], monte_carlo::kStudy).find("fidelity = \"both\""), std::string::npos);
  EXPECT_EQ(template_text(test::fake_catalog()[0], sensitivity::kStudy).find("linearity"), std::string::npos);
}

void expect_refusal(const std::string& marked, const Catalog& catalog, const std::vector<std::string>& words) {
  const test::Marked study(marked);
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", study.text);
  test::expect_input_error([&] { read_study(path, catalog, StudyUse::run); }, {path, study.line, study.column}, words);
}

TEST(BothFidelities, OtherKindsRefuseThem) {
  for (const std::string kind : {"monte-carlo", "identification"}) {
    expect_refusal(study_with("fidelity = ^\"both\"\n") + "[analysis]\nkind = \"" + kind + "\"\n", kFidelityCatalog,
                   {"mechanism.fidelity is \"both\"", "kind = \"" + kind + "\" solves at one fidelity",
                    "write \"exact\" or \"first-order\""});
  }
}

TEST(BothFidelities, ModelsWithoutTwoRefuseThem) {
  Catalog three = kFidelityCatalog;
  three[0].description.fidelities.push_back("coarse");
  expect_refusal(study_with("fidelity = ^\"both\"\n"), three, {"mechanism.fidelity is 'both'", "known: exact"});
  expect_refusal(study_with("^fidelity = \"both\"\n"), test::fake_catalog(), {"offers no choice"});
}

TEST(BothFidelities, LinearityNeedsThem) {
  expect_refusal(study_with("") + "[analysis]\n^linearity = 0.05\n", kFidelityCatalog,
                 {"analysis.linearity", "without fidelity = \"both\""});
  for (const std::string value : {"0", "1", "-0.5", "2"}) {
    expect_refusal(study_with("fidelity = \"both\"\n") + "[analysis]\nlinearity = ^" + value + "\n", kFidelityCatalog,
                   {"analysis.linearity", "between 0 and 1", "0.01"});
  }
}

}  // namespace
}  // namespace poesy
