#include "engine/report/drawing_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace poesy {
namespace {

/// The result of a drawing with one feature, a rail in limb 1.
StoredResult with_rail(const std::string& study) {
  StoredResult result;
  result.study_text = study;
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
  drawing.effect = drawing.share = drawing.worst_share = {{1, 1}, 1e-5};
  drawing.rms = drawing.rms_worst_division = drawing.worst_case = {{1, 2}, 1e-5};
  return result;
}

bool says_independent(const StoredResult& result) {
  return std::ranges::any_of(drawing_table(result, 0)->notes, [](const std::string& note) {
    return note.find("errors count as independent") != std::string::npos;
  });
}

TEST(FeaturesOfADrawing, CountAsIndependentWhateverTheStudyCorrelates) {
  EXPECT_FALSE(says_independent(with_rail("[errors]\nlinear = ...\n")));
  EXPECT_TRUE(says_independent(with_rail("[errors]\n\n[[errors.correlated]]\nfactors = ...\n")));
}

}  // namespace
}  // namespace poesy
