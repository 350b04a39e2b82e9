#include "engine/report/mechanism_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  const std::string svg = mechanism_picture(sketch(), "A & B");
  EXPECT_NE(svg.find("<title>A &amp; B</title>"), std::string::npos);
  EXPECT_NE(svg.find(kPictureMark), std::string::npos);
  for (const char* name : {"jR", "jP", "jH", "jC", "jU", "jS", "jF", "q&lt;", "B"}) {
    EXPECT_EQ(count(svg, "<title>" + std::string(name) + "</title>"), 4u) << name;
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(count(svg, "<g>"), count(svg, "</g>"));
}

TEST(MechanismPicture, ShowsASlideBetweenTheJointsThatItConnects) {
  // From the front, with P (the smaller of the joint's two rectangles) halfway between A and B.
  const std::string svg = mechanism_picture(sketch(), "slide");
  const auto height_of = [&](const std::string& name) {
    const std::size_t at = svg.find("<title>" + name + "</title>");
    std::smatch match;
    const std::string rest = svg.substr(at);
    EXPECT_TRUE(std::regex_search(rest, match, std::regex(R"re((?:cy="|<path d="M\S+ )([\d.]+))re"))) << name;
    return std::stod(match[1]);
  };
  const double half_a_glyph = 6.0;
  EXPECT_NEAR(height_of("q&lt;") + half_a_glyph, (height_of("A") + height_of("B")) / 2, 0.11);
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
    const std::regex places(R"re(c[xy]="(-?[\d.]+)")re");
    for (auto at = std::sregex_iterator(svg.begin(), svg.end(), places); at != std::sregex_iterator(); ++at) {
      EXPECT_GE(std::stod((*at)[1]), 0.0);
      EXPECT_LE(std::stod((*at)[1]), 720.0);
    }
  }
}

}  // namespace
}  // namespace poesy
