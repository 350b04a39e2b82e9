#include "engine/report/mechanism_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

namespace poesy {
namespace {

/// Two limbs: one with each type of joint, one slide from a joint to another.
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

/// Of a joint's glyph in the first view, from the front.
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
  // z of the frame is -x of the base, and x is z.
  EXPECT_EQ(count(svg, "data-p=\"120.000,0.000,200.000 80.000,0.000,200.000\" class=\"bar\""), 4u);
  EXPECT_EQ(count(svg, "data-p=\"100.000,0.000,230.000\" class=\"dot\""), 4u);
  EXPECT_EQ(count(svg, "class=\"plate\""), 4u);
  EXPECT_EQ(count(svg, "<g "), count(svg, "</g>"));
}

/// Glyphs have a radius of 6: as joints at one point, at the base, and as those on the platform.
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

/// A base that hangs: its z axis points to the ground.
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
