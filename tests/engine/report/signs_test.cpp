#include "engine/report/signs.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "engine/model/feature.h"

namespace poesy {
namespace {

TEST(SignsOfADrawing, HaveWords) {
  EXPECT_EQ(with_words("\u2316 \u23000.02 mm"), "position dia 0.02 mm");
  EXPECT_EQ(with_words("S\u23000.02 mm"), "sphere dia 0.02 mm");
  EXPECT_EQ(with_words("\u00b10.01 mm, \u00b10.02 mm"), "+-0.01 mm, +-0.02 mm");
  EXPECT_EQ(with_words("no sign"), "no sign");
  for (const ZoneTraits& zone : zone_traits()) {
    EXPECT_EQ(with_words(zone.sign), zone.of == ZoneClass::size ? "+-" : zone.key);
  }
}

TEST(SignsOfADrawing, AreInABoxOfAFrame) {
  using Boxes = std::vector<std::string>;
  EXPECT_EQ(frame_boxes("\u2316", "\u23000.05", "A|B-C"), (Boxes{"\u2316", "\u23000.05", "A", "B-C"}));
  EXPECT_EQ(frame_boxes("\u23e5", "0.05", ""), (Boxes{"\u23e5", "0.05"}));
}

TEST(SignsOfADrawing, AreReplacedInAllCells) {
  std::vector<Table> tables{{.name = "t", .caption = "t", .columns = {{"a", "a", ""}}, .rows = {{{"\u2225", {}}}}}};
  use_words(tables);
  EXPECT_EQ(tables[0].rows[0][0].text, "parallelism");
}

TEST(Signs, OfPrintReplaceThoseOfAKeyboard) {
  EXPECT_EQ(typographic("endstop_1 0.0000 -> -0.3890 +- 0.0233 mm"),
            "endstop_1 0.0000 \u2192 \u22120.3890 \u00b1 0.0233 mm");
  EXPECT_EQ(typographic("pose 9 (z -17.5 mm)"), "pose 9 (z \u221217.5 mm)");
  EXPECT_EQ(typographic("to within 2.8e-10"), "to within 2.8e\u221210");
  EXPECT_EQ(typographic("-5 (-5)"), "\u22125 (\u22125)");
  EXPECT_EQ(typographic("limbs 1-3, first-order, --yes, -o, a -"), "limbs 1-3, first-order, --yes, -o, a -");
}

}  // namespace
}  // namespace poesy
