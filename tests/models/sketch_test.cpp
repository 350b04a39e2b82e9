// Compares the sketches of models, which pictures use, with their evaluators and files.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "models/registry.h"

namespace poesy {
namespace {

CatalogEntry from_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return registry().from_text(text.str(), path);
}

CatalogEntry from_gallery(const std::string& name) {
  return from_file(POESY_TEST_DATA "/../../results/gallery/" + name + "/" + name + ".toml");
}

std::unique_ptr<Model> build_published(const CatalogEntry& entry) {
  constexpr std::size_t kFirstOrder = 1;
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, kFirstOrder);
}

/// The entry of a mechanism in the registry or, if there is none, in the gallery.
CatalogEntry entry_of(const std::string& name) {
  const CatalogEntry* known = find(registry(), name);
  return known == nullptr ? from_gallery(name.substr(name.find('/') + 1)) : by_metric(*known, "platform");
}

class Sketches : public testing::TestWithParam<const char*> {
 protected:
  Sketches() : entry_(entry_of(GetParam())), model_(build_published(entry_)) {
    const ModelDescription& description = model_->description();
    if (description.pose_lower.empty()) {
      pose_ = {-0.19, 0.2, -0.3};
      return;
    }
    for (std::size_t c = 0; c < description.pose_lower.size(); ++c) {
      pose_.push_back(0.4 * description.pose_lower[c] + 0.6 * description.pose_upper[c]);
    }
  }

  /// The responses followed by the details, for one error of this size (SI).
  std::vector<double> outcome(std::size_t factor, double size) const {
    const ModelDescription& description = model_->description();
    std::size_t details = 0;
    for (const Detail& detail : description.details) details += detail.components.size();
    std::vector<double> errors(description.factors.size(), 0.0);
    errors[factor] = size;
    std::vector<double> responses(description.responses.size());
    std::vector<double> more(details);
    std::array<SolveStatus, 1> status{};
    std::array<std::uint32_t, 1> iterations{};
    model_->evaluator({})->evaluate({pose_, errors, {}, {}, 1}, {responses, status, iterations, more});
    responses.insert(responses.end(), more.begin(), more.end());
    return responses;
  }

  CatalogEntry entry_;
  std::unique_ptr<Model> model_;
  std::vector<double> pose_;
};

double distance(const SketchVector& a, const SketchVector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The displacement of the point p by the twist t = [rotation; translation].
SketchVector displaced(const SketchTwist& t, const SketchVector& p) {
  return {t[3] + t[1] * p[2] - t[2] * p[1], t[4] + t[2] * p[0] - t[0] * p[2], t[5] + t[0] * p[1] - t[1] * p[0]};
}

TEST_P(Sketches, JointsStandAtTheirFrames) {
  for (const std::vector<double>& pose : {std::vector<double>(), pose_}) {
    const std::optional<Sketch> sketch = model_->sketch(pose);
    ASSERT_TRUE(sketch.has_value());
    ASSERT_EQ(sketch->errors.size(), model_->description().factors.size());
    for (std::size_t i = 0; i < sketch->limbs.size(); ++i) {
      const std::vector<SketchedFrame>& frames = sketch->frames[i];
      const SketchVector last = sketch->errors_at_joints ? frames[frames.size() - 2].origin : sketch->platform;
      EXPECT_LT(distance(frames.back().origin, last), 1e-9);
      const SketchVector first = sketch->errors_at_joints ? sketch->limbs[i].front().point : SketchVector{};
      EXPECT_LT(distance(frames.front().origin, first), 1e-12);
      for (const SketchedJoint& joint : sketch->limbs[i]) {
        const SketchedFrame& frame = sketch->frames[i][joint.frame];
        const SketchVector moved{frame.origin[0] - joint.point[0], frame.origin[1] - joint.point[1],
                                 frame.origin[2] - joint.point[2]};
        const double length = std::hypot(moved[0], moved[1], moved[2]);
        if (joint.type != 'P' && joint.type != 'C' && joint.type != 'H') {
          EXPECT_LT(length, 1e-12) << joint.name;
        }
        // A sliding joint displaces its frame only along the joint's axis.
        const SketchVector& z = frame.axes[2];
        EXPECT_NEAR(std::abs(moved[0] * z[0] + moved[1] * z[1] + moved[2] * z[2]), length, 1e-12);
      }
    }
  }
}

TEST_P(Sketches, ErrorsAreWhereTheModelSays) {
  const Sketch sketch = model_->sketch({}).value();
  for (std::size_t f = 0; f < sketch.errors.size(); ++f) {
    const Factor& factor = model_->description().factors[f];
    const SketchedError& error = sketch.errors[f];
    EXPECT_EQ(error.limb + 1, factor.limb);
    if (!factor.axis.empty()) {
      EXPECT_EQ(std::string(1, "xyz"[error.axis]), factor.axis);
    }
    EXPECT_LE(error.after, error.before);
    EXPECT_LE(error.before, error.after + 1);
    EXPECT_LE(error.before, sketch.limbs[error.limb].size() + 1);
    ASSERT_LT(error.frame, sketch.frames[error.limb].size());
  }
}

/// The faces of a linear Delta's drawing lift about lines in the base through their middles.
TEST(SketchedErrors, OfAFeatureHaveTheAxisOfTheFeature) {
  const CatalogEntry entry = from_file(POESY_TEST_DATA "/mechanisms/linear-delta-drawing.toml");
  const std::unique_ptr<Model> model = build_published(entry);
  const Sketch sketch = model->sketch({}).value();
  std::size_t seen = 0;
  std::size_t with_own = 0;  // the face of limb 1 lifts along y about the base's own x axis
  for (std::size_t f = 0; f < sketch.errors.size(); ++f) {
    const Factor& factor = model->description().factors[f];
    if (!factor.name.starts_with("face_lift_")) continue;
    ++seen;
    const SketchedError& error = sketch.errors[f];
    if (error.own) ++with_own;
    EXPECT_TRUE(error.own ? error.own->turns : error.turns);
    const SketchedFrame& frame = error.own ? error.own->frame : sketch.frames[error.limb][error.frame];
    const SketchVector& axis = frame.axes[error.own ? 2 : error.axis];
    EXPECT_NEAR(axis[2], 0.0, 1e-12);
    const double turned = 2.0 * std::numbers::pi / 3.0 * static_cast<double>(error.limb);
    const double lifted = factor.name.starts_with("face_lift_x") ? turned : turned + 0.5 * std::numbers::pi;
    EXPECT_NEAR(axis[0] * std::cos(lifted) + axis[1] * std::sin(lifted), 0.0, 1e-12) << factor.name;
    const auto feature = std::ranges::find_if(
        sketch.features, [&](const SketchedFeature& one) { return one.name == "face" && one.limb == error.limb; });
    ASSERT_NE(feature, sketch.features.end());
    SketchVector middle{};
    for (const SketchVector& corner : feature->outline) {
      for (std::size_t c = 0; c < 3; ++c) middle[c] += corner[c] / static_cast<double>(feature->outline.size());
    }
    // the part of the face is the base, so its frame is that of the base
    const SketchVector& p = frame.origin;
    const double distance = std::hypot((middle[1] - p[1]) * axis[2] - (middle[2] - p[2]) * axis[1],
                                       (middle[2] - p[2]) * axis[0] - (middle[0] - p[0]) * axis[2],
                                       (middle[0] - p[0]) * axis[1] - (middle[1] - p[1]) * axis[0]);
    EXPECT_NEAR(distance, 0.0, 1e-9) << factor.name;
  }
  EXPECT_EQ(seen, 6u);
  EXPECT_EQ(with_own, 5u);
}

TEST_P(Sketches, MotionsAreTheEvaluators) {
  constexpr double kSize = 1e-4;
  const ModelDescription& description = model_->description();
  const Sketch sketch = model_->sketch(pose_).value();
  const auto position = [&](std::string_view name) {
    const auto at = std::ranges::find(description.responses, name, &Response::name);
    return static_cast<std::size_t>(at - description.responses.begin());
  };
  std::size_t compared = 0;
  for (std::size_t f = 0; f < sketch.errors.size(); ++f) {
    const std::vector<SketchTwist>& motions = sketch.errors[f].motions;
    ASSERT_FALSE(motions.empty());
    const std::vector<double> found = outcome(f, kSize);
    if (position("theta_x") < description.responses.size()) {
      SketchTwist mean{};
      for (const SketchTwist& motion : motions) {
        for (std::size_t c = 0; c < 6; ++c) mean[c] += motion[c] / static_cast<double>(motions.size());
      }
      const SketchVector moved = displaced(mean, sketch.platform);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean[c], found[position(std::array{"theta_x", "theta_y", "theta_z"}[c])] / kSize, 1e-7);
        EXPECT_NEAR(moved[c], found[position(std::array{"x", "y", "z"}[c])] / kSize, 1e-7);
      }
      ++compared;
    }
    if (description.deformation && motions.size() > 1) {
      std::size_t at = description.responses.size();
      for (const Detail& pair : description.details) {
        const auto k = static_cast<std::size_t>(pair.name[9] - '1');  // delta_mu_ki
        const auto i = static_cast<std::size_t>(pair.name[10] - '1');
        for (std::size_t c = 0; c < 6; ++c, ++at) {
          EXPECT_NEAR(motions[k][c] - motions[i][c], found[at] / kSize, 1e-7) << description.factors[f].name;
        }
      }
      ++compared;
    }
  }
  EXPECT_GT(compared, 10u);
}

std::string case_name(const testing::TestParamInfo<const char*>& info) {
  std::string name = info.param;
  std::ranges::replace_if(
      name, [](char c) { return c == '-' || c == '/'; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, Sketches,
                         testing::Values("2upr-rpu", "3-prs", "gallery/2upr-rpu", "gallery/3-prs", "gallery/3-rps",
                                         "gallery/3-rrr", "gallery/6-ups", "gallery/tripteron"),
                         case_name);

TEST(Sketch, OfAFileIsAtItsPointsAtHome) {
  const CatalogEntry entry = from_gallery("3-rps");
  const Sketch sketch = entry.build(std::array{0.25, 0.135, 0.6}, 0)->sketch({}).value();
  ASSERT_EQ(sketch.limbs.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double angle = 2.0943951023931953 * static_cast<double>(i);
    const auto at = [&](double radius, double z) {
      return SketchVector{radius * std::cos(angle), radius * std::sin(angle), z};
    };
    EXPECT_LT(distance(sketch.limbs[i][0].point, at(0.25, 0.0)), 1e-12);
    EXPECT_LT(distance(sketch.limbs[i][1].point, at(0.25, 0.0)), 1e-12);
    EXPECT_LT(distance(sketch.limbs[i][2].point, at(0.135, 0.6)), 1e-12);
  }
  EXPECT_LT(distance(sketch.platform, {0.0, 0.0, 0.6}), 1e-12);
  EXPECT_LT(distance(sketch.tool.front(), {0.0, 0.0, 0.7}), 1e-12);
}

}  // namespace
}  // namespace poesy
