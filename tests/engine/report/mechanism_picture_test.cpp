#include "engine/report/mechanism_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <regex>
#include <sstream>

namespace poesy {
namespace {

/// Two limbs: one with each type of joint, and one with a slide between two revolute joints.
Sketch sketch() {
  Sketch made{.limbs = {}, .platform = {0.0, 0.0, 0.5}, .tool = {{0.0, 0.0, 0.6}}};
  std::vector<SketchedJoint> first;
  for (const char type : {'R', 'P', 'H', 'C', 'U', 'S', 'F'}) {
    const double height = 0.05 * static_cast<double>(first.size());
    first.push_back({std::string("j") + type, type, type == 'P', {0.2, 0.0, height}, {0.0, 0.0, 1.0}, type == 'R'});
  }
  made.limbs = {first,
                {{"A", 'R', false, {-0.2, 0.0, 0.0}, {0.0, 1.0, 0.0}, false},
                 {"q<", 'P', true, {-0.2, 0.0, 0.0}, {0.0, 0.0, 1.0}, false},
                 {"B", 'R', false, {-0.2, 0.0, 0.4}, {0.0, 1.0, 0.0}, false}}};
  return made;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(MechanismPicture, HasEveryJointInFourViews) {
  const std::string svg = mechanism_picture(sketch(), "X & Y");
  EXPECT_NE(svg.find("<title>X &amp; Y</title>"), std::string::npos);
  EXPECT_NE(svg.find(kPictureMark), std::string::npos);
  for (const char* name : {"jR", "jP", "jH", "jC", "jU", "jS", "jF", "q&lt;", "B"}) {
    EXPECT_EQ(count(svg, " " + std::string(name) + "</title>"), 4u) << name;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(count(svg, "<g "), count(svg, "</g>"));
}

/// The position (x, y) of a joint's glyph in the first view, which is from the front.
std::pair<double, double> place_of(const std::string& svg, const std::string& name) {
  std::smatch match;
  const std::regex joint(R"re(translate\(([\d.]+) ([\d.]+)\)"[^>]*><title>[^<]* )re" + name + "</title>");
  EXPECT_TRUE(std::regex_search(svg, match, joint)) << name;
  return {std::stod(match[1]), std::stod(match[2])};
}

TEST(MechanismPicture, ShowsASlideBetweenTheJointsThatItConnects) {
  const std::string svg = mechanism_picture(sketch(), "slide");
  EXPECT_NEAR(place_of(svg, "q&lt;").second, (place_of(svg, "A").second + place_of(svg, "B").second) / 2, 0.11);
}

/// A Tricept: three legs with ball joints on the platform, and a central strut that slides in a gimbal on the base.
/// slide: the strut's direction.
Sketch tricept(const SketchVector& slide) {
  Sketch made{.limbs = {}, .platform = {0.0, 0.0, -0.7}, .tool = {}};
  made.limbs = {{{"gimbal", 'U', false, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, false},
                 {"slide", 'P', false, {0.0, 0.0, 0.0}, slide, false}}};
  for (int leg = 0; leg < 3; ++leg) {
    const double angle = 2.0 * std::numbers::pi * leg / 3.0;
    const double x = std::cos(angle);
    const double y = std::sin(angle);
    made.limbs.push_back({{"A", 'U', false, {0.25 * x, 0.25 * y, 0.0}, {-y, x, 0.0}, false},
                          {"q", 'P', true, {0.25 * x, 0.25 * y, 0.0}, {0.0, 0.0, -1.0}, false},
                          {"B" + std::to_string(leg), 'S', false, {0.12 * x, 0.12 * y, -0.7}, {0.0, 0.0, 1.0}, false}});
  }
  return made;
}

/// The z coordinates (mm) of the corners of a body (base or platform).
std::vector<double> heights_of(const std::string& svg, const std::string& body) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(svg, match, std::regex("data-p=\"([^\"]*)\" class=\"" + body + "\"")));
  std::istringstream corners(match[1]);
  std::vector<double> heights;
  for (std::string corner; corners >> corner;) heights.push_back(std::stod(corner.substr(corner.rfind(',') + 1)));
  return heights;
}

TEST(MechanismPicture, ShowsAStrutBetweenItsJointAndThePlatform) {
  const std::string svg = mechanism_picture(tricept({0.0, 0.0, -1.0}), "Tricept");
  EXPECT_EQ(heights_of(svg, "platform"), std::vector<double>(3, -700.0));  // the gimbal is not a corner of it
  const double gimbal = place_of(svg, "gimbal").second;
  const double ball = place_of(svg, "B0").second;
  EXPECT_NEAR(place_of(svg, "slide").second, (gimbal + ball) / 2, 0.11);
  EXPECT_NEAR(place_of(svg, "slide").first, place_of(svg, "gimbal").first, 0.11);
}

/// A slide that is not directed to the platform is drawn at its joint, and the platform includes this joint.
TEST(MechanismPicture, LeavesOtherSlidesAtTheirJoint) {
  const std::string svg = mechanism_picture(tricept({1.0, 0.0, 0.0}), "Tricept");
  const std::vector<double> heights = heights_of(svg, "platform");
  EXPECT_EQ(std::ranges::count(heights, 0.0), 1);
  EXPECT_LT(std::abs(place_of(svg, "slide").second - place_of(svg, "gimbal").second), 20.0);
}

/// The angles (deg) of a body's corners about the z axis, in the order in which the polygon is drawn.
std::vector<double> corners_of(const std::string& svg, const std::string& body) {
  std::smatch match;
  EXPECT_TRUE(std::regex_search(svg, match, std::regex("data-p=\"([^\"]*)\" class=\"" + body + "\"")));
  std::istringstream points(match[1]);
  std::vector<double> angles;
  for (std::string point; points >> point;) {
    std::ranges::replace(point, ',', ' ');
    std::istringstream numbers(point);
    double x = 0.0;
    double y = 0.0;
    numbers >> x >> y;
    angles.push_back(std::atan2(y, x) * 180.0 / std::numbers::pi);
  }
  return angles;
}

TEST(MechanismPicture, DrawsBodiesByTheirHulls) {
  Sketch made{.limbs = {}, .platform = {0.0, 0.0, 0.5}, .tool = {}};
  // In this order of the limbs the polygon through the joints would cross itself.
  for (const double degrees : {10.0, 130.0, 250.0, -10.0, 110.0, 230.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const SketchVector foot{0.3 * std::cos(angle), 0.3 * std::sin(angle), 0.0};
    const SketchVector ball{0.2 * std::cos(angle), 0.2 * std::sin(angle), 0.5};
    made.limbs.push_back({{"foot", 'U', false, foot, {0.0, 0.0, 1.0}, false}, {"ball", 'S', false, ball, {}, false}});
  }
  made.limbs.push_back({{"post", 'U', false, {}, {0.0, 0.0, 1.0}, false},  // inside both bodies
                        {"top", 'F', false, {0.01, 0.0, 0.5}, {}, false}});
  const std::string svg = mechanism_picture(made, "hexapod");
  for (const char* body : {"base", "platform"}) {
    const std::vector<double> angles = corners_of(svg, body);
    ASSERT_EQ(angles.size(), 6U) << body;
    double round = 0.0;
    for (std::size_t n = 0; n < angles.size(); ++n) {
      const double turn = std::remainder(angles[(n + 1) % angles.size()] - angles[n], 360.0);
      EXPECT_GT(turn * std::remainder(angles[1] - angles[0], 360.0), 0.0) << body;  // all turns have the same sign
      round += turn;
    }
    EXPECT_NEAR(std::abs(round), 360.0, 1e-9) << body;
  }
}

TEST(MechanismPicture, ShowsFeaturesInTheFramesOfTheirParts) {
  EXPECT_EQ(count(mechanism_picture(sketch(), "no drawing"), "feature"), 0u);
  Sketch made = sketch();
  const SketchedFrame frame{{0.1, 0.0, 0.2}, {{{0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}}}};
  made.frames = {{frame, frame}, {frame}};
  made.features = {{"bore", "position 0.05 mm to A|B", 0, 1, {{0.0, 0.0, -0.02}, {0.0, 0.0, 0.02}}},
                   {"face", "", 1, 0, {{0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}, {-0.01, 0.0, 0.0}}},
                   {"rod", "tolerance 0.02 mm", 1, 0, {{0.03, 0.0, 0.0}}}};
  const std::string svg = mechanism_picture(made, "drawing");
  EXPECT_EQ(count(svg, "<title>bore of limb 1: position 0.05 mm to A|B</title>"), 4u);
  EXPECT_EQ(count(svg, "<title>face of limb 2</title>"), 4u);
  EXPECT_EQ(count(svg, "<title>rod of limb 2: tolerance 0.02 mm</title>"), 4u);
  // The frame's z axis is -x of the base, and its x axis is z of the base.
  EXPECT_EQ(count(svg, "data-p=\"120.000,0.000,200.000 80.000,0.000,200.000\" class=\"bar\""), 4u);
  EXPECT_EQ(count(svg, "data-p=\"100.000,0.000,230.000\" class=\"dot\""), 4u);
  EXPECT_EQ(count(svg, "class=\"plate\""), 4u);
  EXPECT_EQ(count(svg, "<g "), count(svg, "</g>"));
}

/// Glyphs of joints at one point, at the base and on the platform, must not overlap. A glyph has a radius of 6.
TEST(MechanismPicture, ShowsJointsAtOnePointSideBySide) {
  Sketch made = sketch();
  for (const char* name : {"base1", "base2", "base3"}) {
    made.limbs[0].insert(made.limbs[0].begin(), {name, 'R', false, {0.2, 0.0, -0.3}, {0.0, 1.0, 0.0}, false});
  }
  for (const char* name : {"top1", "top2"}) {
    made.limbs[1].push_back({name, 'S', false, {-0.2, 0.0, 0.4}, {0.0, 1.0, 0.0}, false});
  }
  const std::string svg = mechanism_picture(made, "one point");
  for (const std::vector<std::string>& row :
       {std::vector<std::string>{"base1", "base2", "base3"}, std::vector<std::string>{"B", "top1", "top2"}}) {
    for (std::size_t a = 0; a < row.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const auto [x, y] = place_of(svg, row[a]);
        const auto [other_x, other_y] = place_of(svg, row[b]);
        EXPECT_GE(std::hypot(x - other_x, y - other_y), 12.0) << row[a] << ' ' << row[b];
      }
    }
  }
}

/// A mechanism whose base hangs, with its z axis to the ground, is drawn upside down.
TEST(MechanismPicture, ShowsWhatHangsAsItHangs) {
  Sketch hanging = sketch();
  hanging.z_is_down = true;
  const std::string stands = mechanism_picture(sketch(), "stands");
  const std::string hangs = mechanism_picture(hanging, "hangs");
  EXPECT_LT(place_of(stands, "B").second, place_of(stands, "A").second);
  EXPECT_GT(place_of(hangs, "B").second, place_of(hangs, "A").second);
  EXPECT_NE(stands.find("front: x to the right, z up"), std::string::npos);
  EXPECT_NE(hangs.find("front: x to the right, z down"), std::string::npos);
}

TEST(MechanismPicture, BreaksLongTitles) {
  const std::string words =
      "a title of many words that is longer than any picture of a mechanism is wide in characters, so it takes two "
      "lines";
  const std::string svg = mechanism_picture(sketch(), words);
  EXPECT_EQ(count(svg, "font-size=\"14\""), 2u);
  EXPECT_NE(svg.find("<title>" + words + "</title>"), std::string::npos);
  EXPECT_EQ(count(mechanism_picture(sketch(), "short"), "font-size=\"14\""), 1u);
}

TEST(MechanismPicture, StaysInsideItsFrameWhateverTheSize) {
  for (const double scale : {1e-3, 1.0, 1e3}) {
    Sketch scaled = sketch();
    const auto grow = [&](SketchVector& point) {
      for (double& value : point) value *= scale;
    };
    grow(scaled.platform);
    for (SketchVector& tip : scaled.tool) grow(tip);
    for (auto& limb : scaled.limbs) {
      for (SketchedJoint& joint : limb) grow(joint.point);
    }
    const std::string svg = mechanism_picture(scaled, "size");
    const std::regex joints(R"re(translate\((-?[\d.]+) (-?[\d.]+)\)"[^>]*><title>)re");
    const auto begin = std::sregex_iterator(svg.begin(), svg.end(), joints);
    EXPECT_EQ(std::distance(begin, std::sregex_iterator()), 4 * 10);
    for (auto at = begin; at != std::sregex_iterator(); ++at) {
      EXPECT_GE(std::stod((*at)[1]), 0.0);
      EXPECT_LE(std::stod((*at)[1]), 460.0);
      EXPECT_GE(std::stod((*at)[2]), 0.0);
      EXPECT_LE(std::stod((*at)[2]), 340.0);
    }
  }
}

}  // namespace
}  // namespace poesy
