#include "engine/report/drawing_table.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace poesy {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The result of a drawing with one feature, a rail in limb 1. together: what all features do together.
StoredResult with_rail(double together) {
  StoredResult result;
  result.factors = {{"rail_x_1", "m"}};
  result.responses = {{"tip_position", "m"}};
  DrawingResult& drawing = result.drawing.emplace();
  drawing.names = {"rail_1"};
  drawing.label = {{1}, "rail"};
  drawing.limb = {{1}, 1};
  drawing.kind = {{1}, "axis"};
  drawing.location = {{1}, "position"};
  drawing.location_zone = {{1}, 5e-5};
  drawing.location_datums = {{1}, "A"};
  drawing.orientation = drawing.orientation_datums = {{1}, "-"};
  drawing.orientation_zone = {{1}, 0.0};
  drawing.effect = drawing.worst_share = {{1, 1}, 1e-5};
  drawing.share = {{1, 1}, together};
  drawing.rms = drawing.rms_worst_division = {{1, 2}, together};
  drawing.worst_case = {{1, 2}, 1e-5};
  return result;
}

TEST(FeaturesOfADrawing, DoNothingKnownTogetherIfErrorsAreCorrelated) {
  const Table known = drawing_table(with_rail(2e-5), 0).value();
  EXPECT_NE(known.notes[0].find("all of them together: 0.02 mm"), std::string::npos) << known.notes[0];
  const Table unknown = drawing_table(with_rail(kNaN), 0).value();
  EXPECT_NE(unknown.notes[0].find("not known here, because the study correlates errors"), std::string::npos)
      << unknown.notes[0];
  EXPECT_EQ(unknown.rows[0][3].text, "0.01");
  EXPECT_EQ(unknown.rows[0][4].text, "-");
}

}  // namespace
}  // namespace poesy
