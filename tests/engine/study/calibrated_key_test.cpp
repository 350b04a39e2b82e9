#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "engine/result/checkpoint_identity.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"

namespace poesy {
namespace {

/// The fake mechanism with a calibration that leaves half of each response.
class Correctable final : public test::FakeModel {
 public:
  using FakeModel::FakeModel;

  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& /*options*/) const override {
    return std::make_unique<test::FakeEvaluator>(0.5 * kArm);
  }
};

Catalog correctable_catalog() {
  Catalog catalog = test::fake_catalog();
  catalog[0].description.separation = SeparationDescription{"a measure", {}};
  catalog[0].build = [](std::span<const double> geometry, std::size_t) {
    return std::make_unique<Correctable>(geometry[0]);
  };
  return catalog;
}

const Catalog kCorrectableCatalog = correctable_catalog();

std::string study_text(const std::string& analysis) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 "
         "}\n[analysis]\n" +
         analysis;
}

Study read(const std::string& analysis, const Catalog& catalog = kCorrectableCatalog) {
  return study_of_text(study_text(analysis), "study.toml", catalog, StudyUse::run);
}

double response_of(const Study& study) {
  const std::vector<double> pose{-0.2, 0.1, 0.1};
  const std::vector<double> errors{1e-3, 0.0, 0.0};
  std::vector<double> responses(2);
  std::vector<SolveStatus> status(1);
  std::vector<std::uint32_t> iterations(1);
  const auto model = build_model(study.mechanism);
  model->evaluator({})->evaluate({pose, errors, {}, {}, 1}, {responses, status, iterations, {}});
  return responses[0];
}

TEST(Calibrated, IsAKeyOfAnAnalysis) {
  const Study plain = read("kind = \"monte-carlo\"\ndraws = \"per pose\"\n");
  const Study corrected = read("kind = \"monte-carlo\"\ndraws = \"per pose\"\ncalibrated = true\n");
  EXPECT_FALSE(plain.mechanism.calibrated);
  EXPECT_TRUE(corrected.mechanism.calibrated);
  EXPECT_EQ(response_of(corrected), 0.5 * response_of(plain));
  EXPECT_EQ(calibration_text(plain), "");
  EXPECT_NE(calibration_text(corrected).find(
                "so that the platform's points (metric_points of a mechanism from a file) are best"),
            std::string::npos);
}

TEST(Calibrated, IsInTheResolvedTextWhereItHolds) {
  const std::string plain = resolved_text(read("kind = \"monte-carlo\"\ndraws = \"per pose\"\ncalibrated = false\n"));
  EXPECT_EQ(plain, resolved_text(read("kind = \"monte-carlo\"\ndraws = \"per pose\"\n")));
  EXPECT_EQ(plain.find("calibrated"), std::string::npos);
  const std::string text = resolved_text(read("kind = \"monte-carlo\"\ndraws = \"per pose\"\ncalibrated = true\n"));
  EXPECT_NE(text.find("\ncalibrated = true\n"), std::string::npos) << text;
  const Study again = study_of_text(text, "again.toml", kCorrectableCatalog, StudyUse::run);
  EXPECT_TRUE(again.mechanism.calibrated);
  EXPECT_EQ(resolved_text(again), text);
}

TEST(Calibrated, IsPartOfWhatARunContinues) {
  const PoseSet poses(3, {-0.2, 0.1, 0.1});
  EXPECT_FALSE(
      identity_of(read("kind = \"monte-carlo\"\ndraws = \"per pose\"\ncalibrated = true\n"), poses, std::nullopt) ==
      identity_of(read("kind = \"monte-carlo\"\ndraws = \"per pose\"\n"), poses, std::nullopt));
}

TEST(Calibrated, IsRefusedByOtherKindsAndOtherModels) {
  const auto refused = [](const std::string& marked, const Catalog& catalog, const std::vector<std::string>& words) {
    const test::Marked text(study_text(marked));
    test::expect_input_error([&] { study_of_text(text.text, "study.toml", catalog, StudyUse::run); },
                             {"study.toml", text.line, text.column}, words);
  };
  refused("kind = \"sensitivity\"\n^calibrated = true\n", kCorrectableCatalog, {"analysis.calibrated does not belong"});
  refused("kind = \"monte-carlo\"\ndraws = \"per pose\"\ncalibrated = ^\"yes\"\n", kCorrectableCatalog,
          {"analysis.calibrated", "true or false"});
  refused("kind = \"monte-carlo\"\ndraws = \"per pose\"\ncalibrated = ^true\n", test::fake_catalog(),
          {"analysis.calibrated is true, but model \"fake\" does not separate actuated from constrained directions",
           "leave it out"});
}

TEST(Calibrated, IsShownByTemplatesOfModelsThatCanBe) {
  EXPECT_NE(template_text(kCorrectableCatalog[0], monte_carlo::kStudy).find("calibrated = false"), std::string::npos);
  const Catalog others = test::fake_catalog();
  EXPECT_EQ(template_text(others[0], monte_carlo::kStudy).find("calibrated"), std::string::npos);
}

}  // namespace
}  // namespace poesy
