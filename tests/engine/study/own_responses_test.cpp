#include "engine/model/own_responses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/kinds/study_file.h"
#include "models/registry.h"
#include "tests/support/input_error.h"

// [[response]]: what it gives, and what it refuses.
namespace poesy {
namespace {

constexpr const char* kTilt = "[[response]]\nname = \"tilt\"\nnorm = [\"theta_x\", \"theta_y\"]\n";
constexpr const char* kHeight = "[[response]]\nname = \"height\"\nsum = { z = 2, theta_x = \"-20 mm\" }\n";

std::string study_text(const std::string& responses, const std::string& keys = "") {
  return "format = \"poesy-study\"\nversion = 1\n" + responses +
         "[mechanism]\nmodel = \"3-prs\"\n[poses]\ncount = 2\n[analysis]\nkind = \"monte-carlo\"\n" + keys;
}

Study read(const std::string& responses, const std::string& keys = "") {
  return study_of_text(study_text(responses, keys), "study.toml", registry(), StudyUse::run);
}

std::size_t position_of(const ModelDescription& model, std::string_view name) {
  const auto found = std::ranges::find(model.responses, name, &Response::name);
  EXPECT_NE(found, model.responses.end()) << name;
  return static_cast<std::size_t>(found - model.responses.begin());
}

/// Responses [R] of random errors of 0.1 mm and mrad in the middle of the workspace.
std::vector<double> responses_of(const Study& study) {
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  const ModelDescription& description = model->description();
  std::mt19937_64 engine(4);
  std::normal_distribution<double> normal(0.0, 1e-4);
  std::vector<double> errors(description.factors.size());
  for (double& error : errors) error = normal(engine);
  std::vector<double> pose;
  for (std::size_t c = 0; c < description.pose_lower.size(); ++c) {
    pose.push_back(0.5 * (description.pose_lower[c] + description.pose_upper[c]));
  }
  std::vector<double> responses(description.responses.size());
  SolveStatus status{};
  std::uint32_t iterations = 0;
  model->evaluator({})->evaluate({pose, errors, {}, {}, 1}, {responses, {&status, 1}, {&iterations, 1}, {}});
  EXPECT_TRUE(solved(status));
  const std::optional<SolveTrace> trace = model->trace(pose, errors, {});
  for (std::size_t r = 0; trace && r < responses.size(); ++r) EXPECT_NEAR(trace->responses[r], responses[r], 1e-12);
  return responses;
}

TEST(OwnResponses, AreFormedFromThoseOfTheMechanism) {
  for (const char* keys : {"", "calibrated = true\n"}) {
    const Study study = read(std::string(kTilt) + kHeight, keys);
    const std::vector<double> found = responses_of(study);
    const auto value = [&](std::string_view name) { return found[position_of(study.model(), name)]; };
    EXPECT_DOUBLE_EQ(value("tilt"), std::hypot(value("theta_x"), value("theta_y")));
    EXPECT_NEAR(value("height"), 2.0 * value("z") - 0.02 * value("theta_x"), 1e-19);
    const Study plain = read("", keys);
    const std::vector<double> before = responses_of(plain);
    EXPECT_EQ(before, std::vector(found.begin(), found.end() - 2));
  }
}

TEST(OwnResponses, AreDescribedAsWhatTheyAre) {
  const Study study = read(std::string(kTilt) + kHeight);
  const ModelDescription& model = study.model();
  const Response& tilt = model.responses[position_of(model, "tilt")];
  const Response& height = model.responses[position_of(model, "height")];
  EXPECT_EQ(tilt.dimension, Dimension::angle);
  EXPECT_EQ(height.dimension, Dimension::length);
  EXPECT_TRUE(tilt.is_magnitude());
  EXPECT_FALSE(height.is_magnitude());
  const std::vector components{position_of(model, "theta_x"), position_of(model, "theta_y")};
  EXPECT_EQ(tilt.components, components);
  EXPECT_EQ(height.description, "sum of -20 mm times theta_x and 2 times z, a response of one's own");
  ASSERT_GE(model.headline.size(), 2U);
  EXPECT_EQ(model.headline[0], position_of(model, "tilt"));
  const std::unique_ptr<Model> built = build_model(study.mechanism);
  EXPECT_EQ(built->description().responses.size(), model.responses.size());
}

TEST(OwnResponses, AreInTheResolvedText) {
  const Study study =
      read(std::string(kTilt) + kHeight + "description = \"by the probe\"\n", "limits = { tilt = \"1 mrad\" }\n");
  const std::string text = resolved_text(study);
  const Study again = study_of_text(text, "again.toml", registry(), StudyUse::run);
  EXPECT_EQ(resolved_text(again), text);
  EXPECT_EQ(responses_of(again), responses_of(study));
  EXPECT_EQ(again.model().responses.back().description, "by the probe");
  EXPECT_EQ(resolved_text(read("")).find("response"), std::string::npos);
}

TEST(OwnResponses, AreRefusedWithPlaceAndRemedy) {
  const auto refused = [](const std::string& marked, const std::vector<std::string>& words) {
    SCOPED_TRACE(marked);
    const test::Marked text(study_text(marked));
    test::expect_input_error([&] { study_of_text(text.text, "study.toml", registry(), StudyUse::run); },
                             {"study.toml", text.line, text.column}, words);
  };
  const std::string head = "[[response]]\n";
  const std::string named = head + "name = \"a\"\n";
  refused("response = ^1\n", {"response", "list"});
  refused("^" + head + "norm = [\"x\", \"y\"]\n", {"name", "e.g. name = \"tilt\""});
  refused(head + "name = ^\"Tilt\"\nnorm = [\"x\", \"y\"]\n", {"response[0].name is 'Tilt'", "small letters"});
  refused(head + "name = ^\"\"\nnorm = [\"x\", \"y\"]\n", {"response[0].name", "small letters"});
  refused(head + "name = ^\"position\"\nnorm = [\"x\", \"y\"]\n", {"name of another response", "another name"});
  refused(std::string(kTilt) + head + "name = ^\"tilt\"\nnorm = [\"x\", \"y\"]\n",
          {"for the second time", "another name"});
  refused("^" + named, {"neither a norm nor a sum", "write one of them"});
  refused("^" + named + "norm = [\"x\", \"y\"]\nsum = { z = 1 }\n", {"a norm and a sum", "write one of them"});
  refused(named + "norm = ^[]\n", {"response[0].norm is empty", "at least two"});
  refused(named + "norm = ^[\"x\"]\n", {"names one response", "at least two"});
  refused(named + "norm = ^\"x\"\n", {"response[0].norm", "list"});
  refused(named + "norm = [\"x\", ^\"theta_u\"]\n", {"names 'theta_u'", "theta_"});
  refused(named + "norm = [\"x\", ^\"x\"]\n", {"for the second time", "once"});
  refused(named + "norm = [\"x\", ^\"theta_x\"]\n", {"is an angle, but the first one is a length", "one dimension"});
  refused(named + "norm = [\"x\", ^1]\n", {"response[0].norm[1]", "text"});
  refused(named + "sum = ^{}\n", {"response[0].sum is empty", "sum = { z = 1 }"});
  refused(named + "sum = ^[\"z\"]\n", {"response[0].sum is a list", "key = value"});
  refused(named + "sum = { z = ^0 }\n", {"response[0].sum.z is 0", "leave the response out"});
  refused(named + "sum = { position = ^1 }\n", {"which has no sign", "norm"});
  refused(named + "sum = { z = ^\"20 mm\" }\n", {"is a length", "weigh it with a number"});
  refused(named + "sum = { z = ^\"20 deg\" }\n", {"response[0].sum.z", "length"});
  refused(named + "sum = { theta_x = 1, z = ^1 }\n", {"makes a length, but the first term is an angle", "20 mm"});
  refused(named + "sum = { zz = ^1 }\n", {"names 'zz'", "z"});
  refused(named + "sum = { z = ^true }\n", {"response[0].sum.z", "number"});
  refused(named + "^norms = [\"x\", \"y\"]\n", {"unknown key 'norms'", "norm"});
}

}  // namespace
}  // namespace poesy
