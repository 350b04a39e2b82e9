// Tests the words that describe where and how an error displaces a part.

#include "engine/report/sketch_words.h"

#include <gtest/gtest.h>

namespace poesy {
namespace {

constexpr std::array<SketchVector, 3> kAsBase{{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}};
/// The axes of a frame that is turned by -53.13 deg about y of the base.
constexpr std::array<SketchVector, 3> kTurned{{{0.6, 0.0, 0.8}, {0.0, 1.0, 0.0}, {-0.8, -0.0, 0.6}}};

/// A limb with one joint and a bore. Frame 1 is turned about y of the base.
Sketch turned_limb() {
  Sketch sketch{
      .limbs = {{{.name = "q", .type = 'P', .actuated = true, .point = {}, .axis = kTurned[2], .has_errors = true}}},
      .platform = {},
      .tool = {}};
  sketch.frames = {{{{}, kAsBase}, {{}, kTurned}, {{}, kAsBase}}};
  sketch.features = {{.name = "bore", .zones = {}, .limb = 0, .frame = 1, .outline = {}}};
  return sketch;
}

std::string words(std::size_t frame, std::size_t axis, bool turns, const std::string& name = "own",
                  const std::string& description = "what it is") {
  const SketchedError error{
      .limb = 0, .frame = frame, .axis = axis, .turns = turns, .after = 0, .before = 1, .motions = {}};
  return axis_words(turned_limb(), error, name, description);
}

TEST(AxisWords, SayTheDirectionInTheBaseIfTheFrameIsTurned) {
  EXPECT_EQ(words(0, 0, false), "displacement along x of the base");
  EXPECT_EQ(words(1, 0, false), "displacement along x of frame 1, (0.6, 0, 0.8) in the base at home");
  EXPECT_EQ(words(1, 1, true), "rotation about y of frame 1");
  EXPECT_EQ(words(1, 2, true), "rotation about z of frame 1, (-0.8, 0, 0.6) in the base at home");
  EXPECT_EQ(words(2, 2, true), "rotation about z of the platform");
}

TEST(AxisWords, OfAFeatureAreThoseOfItsDrawing) {
  const std::string leans = "bore of limb 1 leans to x: its far end against its near end, 30 mm apart";
  EXPECT_EQ(words(1, 1, true, "bore_lean_x_1", leans + ", where x is (0.6, 0, 0.8) at home"),
            "leans to x, where x is (0.6, 0, 0.8) at home");
  EXPECT_EQ(words(1, 1, true, "bore_lean_x_1", leans), "leans to x");
  EXPECT_EQ(words(1, 1, false, "bore_y_1", "bore of limb leg_1 its middle is off along y"),
            "its middle is off along y");
  EXPECT_EQ(words(1, 1, true, "bore_lean_x_11", leans), "rotation about y of frame 1");
  EXPECT_EQ(words(1, 1, true, "bores_lean_x_1", leans), "rotation about y of frame 1");
}

}  // namespace
}  // namespace poesy
