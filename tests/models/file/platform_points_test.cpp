#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "models/file/model.h"
#include "tests/models/file/files.h"
#include "tests/support/input_error.h"

// Tests [platform.points]: named points are displaced like the tool, which the solvers report directly.
namespace poesy::file {
namespace {

/// The text of a mechanism file with two named points: the nozzle at the tool, and the probe elsewhere.
std::string with_points(const std::string& name) {
  std::string text = text_of(name);
  const std::size_t tool = text.find("tool ");
  const std::size_t end = text.find('\n', tool);
  const std::string place = text.substr(text.find('[', tool), text.find(']', tool) + 1 - text.find('[', tool));
  const std::size_t list = text.find("\npoints ", text.find("[platform]"));
  if (list != std::string::npos) text.replace(list + 1, 6, "metric_points");
  text.insert(end, "\npoints.nozzle = " + place + "\npoints.probe = [\"15 mm\", \"-20 mm\", \"5 mm\"]");
  return text;
}

std::size_t position_of(const ModelDescription& model, std::string_view name) {
  const auto found = std::ranges::find(model.responses, name, &Response::name);
  EXPECT_NE(found, model.responses.end()) << name;
  return static_cast<std::size_t>(found - model.responses.begin());
}

/// [errors] Random normal errors with the standard deviation `size` (m, rad).
std::vector<double> some_errors(const ModelDescription& model, double size) {
  std::mt19937_64 engine(8);
  std::normal_distribution<double> normal(0.0, size);
  std::vector<double> errors(model.factors.size());
  for (double& error : errors) error = normal(engine);
  return errors;
}

/// A pose in the workspace. The first coordinate is at this share of its range, the others at different shares.
std::vector<double> pose_at(const ModelDescription& model, double share) {
  std::vector<double> pose;
  for (std::size_t c = 0; c < model.pose_lower.size(); ++c, share = std::fmod(share + 0.37, 1.0)) {
    pose.push_back(model.pose_lower[c] + share * (model.pose_upper[c] - model.pose_lower[c]));
  }
  return pose;
}

std::vector<double> evaluate(Evaluator& evaluator, std::size_t responses, const std::vector<double>& pose,
                             const std::vector<double>& errors) {
  std::vector<double> found(responses);
  SolveStatus status{};
  std::uint32_t iterations = 0;
  evaluator.evaluate({pose, errors, {}, {}, 1}, {found, {&status, 1}, {&iterations, 1}, {}});
  EXPECT_TRUE(solved(status));
  return found;
}

/// Expects that the nozzle moves like the tip. Returns the displacement of the tip (m).
double expect_like_tip(const ModelDescription& model, std::span<const double> found) {
  for (const std::string end : {"_x", "_y", "_z", "_position"}) {
    const double tip = found[position_of(model, "tip" + end)];
    EXPECT_NEAR(found[position_of(model, "nozzle" + end)], tip, 1e-15 + 1e-13 * std::abs(tip)) << end;
  }
  return found[position_of(model, "tip_position")];
}

class Points : public testing::TestWithParam<const char*> {};

TEST_P(Points, MoveAsTheToolDoes) {
  const CatalogEntry first = catalog_entry(with_points(GetParam()), "m.toml");
  for (const CatalogEntry* entry = &first; entry != nullptr; entry = entry->other_metric.get()) {
    for (const std::size_t fidelity : {0U, 1U}) {
      SCOPED_TRACE(entry->description.metric + " " + std::to_string(fidelity));
      const std::unique_ptr<Model> model = build(*entry, fidelity);
      const ModelDescription& description = model->description();
      const std::size_t responses = description.responses.size();
      const std::vector<double> errors = some_errors(description, 1e-4);
      for (const double share : {0.3, 0.6}) {
        const std::vector<double> pose = pose_at(description, share);
        ASSERT_FALSE(model->unreachable(pose));
        EXPECT_GT(expect_like_tip(description, evaluate(*model->evaluator({}), responses, pose, errors)), 1e-6);
        const auto trace = model->trace(pose, errors, {});
        ASSERT_TRUE(trace);
        expect_like_tip(description, trace->responses);
        if (const auto calibrated = model->calibrated_evaluator({})) {
          expect_like_tip(description, evaluate(*calibrated, responses, pose, errors));
        }
        const std::optional<Sketch> sketch = model->sketch(pose);
        ASSERT_EQ(sketch->points.size(), 2U);
        EXPECT_EQ(sketch->points[0].name, "nozzle");
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(sketch->points[0].point[k], sketch->tool[0][k], 1e-12);
      }
    }
  }
}

// Compares the displacement of the probe with that of the platform, by Rodrigues' rotation formula.
TEST_P(Points, FollowFromThePlatform) {
  const CatalogEntry entry = catalog_entry(with_points(GetParam()), "m.toml");
  const std::unique_ptr<Model> model = build(entry);
  const ModelDescription& description = model->description();
  std::vector<double> pose = pose_at(description, 0.4);
  const std::vector<double> found =
      evaluate(*model->evaluator({}), description.responses.size(), pose, some_errors(description, 2e-3));
  const auto vector = [&](const std::string& stem) {
    return lie::Vector3<double>(found[position_of(description, stem + "x")],
                                found[position_of(description, stem + "y")],
                                found[position_of(description, stem + "z")]);
  };
  const lie::Vector3<double> theta = vector("theta_");
  const std::optional<Sketch> sketch = model->sketch(pose);
  lie::Vector3<double> arm;
  for (std::size_t k = 0; k < 3; ++k)
    arm[static_cast<Eigen::Index>(k)] = sketch->points[1].point[k] - sketch->platform[k];
  EXPECT_NEAR(arm.norm(), std::hypot(0.015, 0.02, 0.005), 1e-12);
  const lie::Vector3<double> turned = Eigen::AngleAxisd(theta.norm(), theta.normalized()) * arm;
  EXPECT_NEAR((vector("probe_") - vector("") - (turned - arm)).norm(), 0.0, 1e-15);
  EXPECT_GT(theta.norm(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Files, Points,
                         testing::Values("rps3", "ups6", "upr2-rpu", "upr2-rpu-beams", "linear-delta",
                                         "delta-parallelogram", "lift-table"),
                         [](const auto& file) {
                           std::string name = file.param;
                           std::erase(name, '-');
                           return name;
                         });

TEST(NamedPoints, AreDescribedBehindTheMechanism) {
  const ModelDescription& plain = catalog_entry(text_of("rps3"), "m.toml").description;
  const ModelDescription model = catalog_entry(with_points("rps3"), "m.toml").description;
  ASSERT_EQ(model.responses.size(), plain.responses.size() + 8);
  for (std::size_t r = 0; r < plain.responses.size(); ++r) EXPECT_EQ(model.responses[r].name, plain.responses[r].name);
  const std::size_t x = position_of(model, "nozzle_x");
  EXPECT_EQ(x, plain.responses.size());
  EXPECT_EQ(model.responses[x + 3].name, "nozzle_position");
  EXPECT_EQ(model.responses[x + 3].components, (std::vector{x, x + 1, x + 2}));
  EXPECT_EQ(model.responses[x + 4].name, "probe_x");
  EXPECT_EQ(model.headline.back(), x + 7);
  EXPECT_NE(model.structure.find("nozzle"), std::string::npos);
}

TEST(NamedPoints, FollowTheGeometry) {
  std::string text = with_points("rps3");
  text.insert(text.find("\npoints.probe"), "\npoints.head = [0, 0, \"-2 * h\"]");
  const CatalogEntry entry = catalog_entry(text, "m.toml");
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) {
    geometry.push_back(parameter.name == "h" ? 1.1 * parameter.published : parameter.published);
  }
  const std::optional<Sketch> sketch = entry.build(geometry, 0)->sketch({});
  const double h =
      geometry[static_cast<std::size_t>(std::ranges::find(entry.description.geometry, "h", &GeometryParameter::name) -
                                        entry.description.geometry.begin())];
  EXPECT_NEAR(sketch->points[1].point[2] - sketch->platform[2], -2.0 * h, 1e-12);
}

TEST(NamedPoints, AreRefusedWithPlaceAndRemedy) {
  const auto refused = [](const std::string& keys, const std::vector<std::string>& words,
                          const std::string& file = "rps3") {
    SCOPED_TRACE(keys);
    std::string marked = text_of(file);
    marked.insert(marked.find('\n', marked.find("tool ")), "\n" + keys);
    const test::Marked text(marked);
    test::expect_input_error([&] { catalog_entry(text.text, "m.toml"); }, {"m.toml", text.line, text.column}, words);
  };
  refused("points.tip = ^[0, 0, 0]", {"platform.points.tip has the name of another point", "as tool"});
  refused("points.origin = ^[0, 0, 0]", {"platform.points.origin has the name of another point", "another name"});
  refused("points.theta = ^[0, 0, 0]", {"a response 'theta_x', which there is already", "another name"});
  refused("points.a = ^[0, 0]", {"platform.points.a has 2 values", "three"});
  refused("points.a = ^\"10 mm\"", {"platform.points.a", "list"});
  refused("points.a = [0, 0, ^\"10 deg\"]", {"platform.points.a[2]", "length"});
  refused("points.a = [0, 0, \"^hh\"]", {"hh", "did you mean 'h'"});
  refused("points.\"a b\" = ^[0, 0, 0]", {"'a b' is not a name", "letters"});
  refused("points = ^\"nozzle\"", {"platform.points", "list"});
  refused("points = ^[[0, 0, 0]]", {"fewer than three points"});
  refused("metric_points = ^[[0, 0, 0]]", {"fewer than three points"});
  refused("metric_points = [[^1, 1, 1], [0, 0, 0], [0, 0, 0]]", {"metric_points[0][0]", "length"});
  refused("points.foot_1 = ^[0, 0, 0]", {"'foot_1_x', which there is already", "another name"}, "delta-parallelogram");
}

TEST(NamedPoints, LeaveOneListOfTheMetric) {
  std::string text = with_points("rps3");
  const std::string list = "[[\"1 mm\", 0, 0], [\"-1 mm\", 0, 0], [0, \"1 mm\", 0]]";
  std::string both = text_of("rps3");
  both.insert(both.find('\n', both.find("tool ")), "\npoints = " + list + "\nmetric_points = " + list);
  EXPECT_NE(test::refusal_of([&] { catalog_entry(both, "m.toml"); }).find("a second list of the metric's points"),
            std::string::npos);
  text.insert(text.find("\npoints.probe"), "\nmetric_points = " + list);
  EXPECT_EQ(test::refusal_of([&] { catalog_entry(text, "m.toml"); }), "");
}

}  // namespace
}  // namespace poesy::file
