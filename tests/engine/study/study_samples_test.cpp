#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "engine/result/checkpoint_identity.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

std::string study_with(std::string_view analysis, std::string_view mechanism = "") {
  return "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n" + std::string(mechanism) +
         "[poses]\ncount = 3\n[analysis]\n" + std::string(analysis);
}

Study study_of(const std::string& text, const Catalog& catalog = test::kFakeCatalog) {
  return study_of_text(text, "study.toml", catalog, StudyUse::run);
}

void expect_refusal(const std::string& marked, const std::vector<std::string>& words,
                    const Catalog& catalog = test::kFakeCatalog) {
  const test::Marked study(marked);
  test::expect_input_error([&] { study_of(study.text, catalog); }, {"study.toml", study.line, study.column}, words);
}

TEST(AdaptiveSamples, AreReadWithTheirDefaults) {
  const Analysis analysis = study_of(study_with("samples = { max = 5000, relative_error = 0.01 }\n")).analysis;
  ASSERT_TRUE(analysis.adaptive);
  EXPECT_EQ(analysis.adaptive->min, 1000u);
  EXPECT_EQ(analysis.adaptive->relative_error, 0.01);
  EXPECT_EQ(analysis.samples, 5000u);
  EXPECT_EQ(analysis.conf_level, 0.95);
  EXPECT_FALSE(study_of(study_with("samples = 5000\n")).analysis.adaptive);
}

TEST(AdaptiveSamples, MaySetTheLevel) {
  const std::string table = "samples = { min = 50, max = 60, relative_error = 0.2, conf_level = 0.9 }\n";
  EXPECT_EQ(study_of(study_with(table)).analysis.conf_level, 0.9);
  EXPECT_EQ(study_of(study_with(table)).analysis.adaptive->min, 50u);
  EXPECT_EQ(study_of(study_with("conf_level = 0.9\n" + table)).analysis.conf_level, 0.9);
  expect_refusal(study_with("conf_level = 0.99\nsamples = { max = 5000, relative_error = 0.01, conf_level = ^0.9 }\n"),
                 {"analysis.samples.conf_level is 0.9", "analysis.conf_level is 0.99", "once"});
}

TEST(AdaptiveSamples, StandInTheResolvedText) {
  for (const std::string kind : {"sensitivity", "monte-carlo"}) {
    const std::string text = resolved_text(study_of(study_with(
        "kind = \"" + kind + "\"\nsamples = { min = 2000, max = 5000, relative_error = 0.015, conf_level = 0.9 }\n")));
    EXPECT_NE(text.find("\nsamples.min = 2000\nsamples.max = 5000\nsamples.relative_error = 0.015\n"),
              std::string::npos)
        << text;
    EXPECT_NE(text.find("\nconf_level = 0.9\n"), std::string::npos) << text;
    EXPECT_EQ(resolved_text(study_of(text)), text);
  }
}

TEST(AdaptiveSamples, StandInTheTemplate) {
  for (const test::KindOfStudy kind : {&sensitivity::kStudy, &monte_carlo::kStudy}) {
    std::string text = template_text(test::kFakeCatalog[0], *kind);
    const std::string_view fixed = "\nsamples = 1000";
    const std::string_view shown = "\n# samples = {";
    ASSERT_NE(text.find(shown), std::string::npos) << text;
    text.replace(text.find(shown), 3, "\n");
    text.replace(text.find(fixed), 1, "\n# ");
    EXPECT_EQ(study_of(text).analysis.adaptive->relative_error, 0.01);
  }
  EXPECT_EQ(template_text(test::kFakeCatalog[0], evaluate::kStudy).find("relative_error"), std::string::npos);
}

TEST(AdaptiveSamples, WrongOnesAreRefused) {
  const auto table = [](const std::string& keys) { return study_with("samples = { " + keys + " }\n"); };
  expect_refusal(table("min = ^6000, max = 5000, relative_error = 0.01"),
                 {"analysis.samples.min is 6000", "more than max = 5000", "smaller min"});
  expect_refusal(table("max = ^500, relative_error = 0.01"), {"analysis.samples.max is 500", "1000", "or min besides"});
  expect_refusal(table("min = ^1, max = 5000, relative_error = 0.01"), {"analysis.samples.min is 1", "at least 2"});
  expect_refusal(table("min = ^0.5, max = 5000, relative_error = 0.01"), {"analysis.samples.min", "whole number"});
  expect_refusal(table("max = ^1, relative_error = 0.01"), {"analysis.samples.max is 1", "at least 2"});
  expect_refusal(table("max = ^\"many\", relative_error = 0.01"), {"analysis.samples.max", "whole number"});
  expect_refusal(study_with("samples = ^{ relative_error = 0.01 }\n"), {"max", "max = 1000000"});
  expect_refusal(study_with("samples = ^{ max = 5000 }\n"), {"relative_error", "0.01"});
  expect_refusal(table("max = 5000, relative_error = 0.01, ^most = 7"), {"analysis.samples", "most", "max"});
  for (const std::string error : {"0", "0.0", "-0.01", "1", "inf"}) {
    expect_refusal(table("max = 5000, relative_error = ^" + error), {"analysis.samples.relative_error"});
  }
  expect_refusal(table("max = 5000, relative_error = 0.01, conf_level = ^1.0"), {"analysis.samples.conf_level is 1"});
  expect_refusal(study_with("samples = ^[1000, 5000]\n"), {"analysis.samples"});
  expect_refusal(study_with("samples = ^\"1000\"\n"), {"analysis.samples"});
}

TEST(AdaptiveSamples, TwoFidelitiesRefuseThem) {
  Catalog catalog = test::kFakeCatalog;
  catalog[0].description.fidelities = {"exact", "first-order"};
  expect_refusal(study_with("samples = ^{ max = 5000, relative_error = 0.01 }\n", "fidelity = \"both\"\n"),
                 {"analysis.samples", "same samples", "write a fixed number", "one fidelity"}, catalog);
}

TEST(AdaptiveSamples, CountWithTheirMaximum) {
  const std::string text = study_with("samples = { max = 900_000_000_000_000, relative_error = 0.01 }\n");
  try {
    study_of(text);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("can be solved"), std::string::npos) << error.what();
  }
}

/// The message with which a run with the samples `now` refuses a checkpoint of a run with the samples `before`. Empty
/// if it continues.
std::string refusal(const std::string& before, const std::string& now) {
  const auto identity = [](const std::string& samples) {
    return identity_of(study_of(study_with("samples = " + samples + "\n")), PoseSet(3, {-0.2, 0.0, 0.0}));
  };
  try {
    check_continues(identity(now), identity(before), "out.h5.part");
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(AdaptiveSamples, ACheckpointIsContinuedWithALargerMaxOnly) {
  const std::string before = "{ max = 5000, relative_error = 0.01 }";
  EXPECT_EQ(refusal(before, before), "");
  EXPECT_EQ(refusal(before, "{ max = 6000, relative_error = 0.01 }"), "");
  const auto has = [](const std::string& text, std::string_view word) { return text.find(word) != std::string::npos; };
  EXPECT_TRUE(has(refusal(before, "{ max = 4000, relative_error = 0.01 }"), "has 5000 samples"));
  EXPECT_TRUE(has(refusal(before, "{ max = 5000, relative_error = 0.02 }"),
                  "'samples.relative_error = 0.01' where this study has 'samples.relative_error = 0.02'"));
  EXPECT_TRUE(has(refusal(before, "{ min = 2000, max = 5000, relative_error = 0.01 }"),
                  "'samples.min = 1000' where this study has 'samples.min = 2000'"));
  EXPECT_TRUE(has(refusal(before, "{ max = 5000, relative_error = 0.01, conf_level = 0.9 }"), "conf_level = 0.95"));
  EXPECT_TRUE(has(refusal(before, "5000"), "takes as many samples as it needs"));
  EXPECT_TRUE(has(refusal("5000", before), "has a fixed number of samples"));
}

}  // namespace
}  // namespace poesy
