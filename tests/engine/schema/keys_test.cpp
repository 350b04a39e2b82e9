#include "engine/schema/keys.h"

#include <gtest/gtest.h>

#include "tests/support/input_error.h"

namespace poesy {
namespace {

enum class Shape { round, square };

std::string_view name(Shape shape) { return shape == Shape::round ? "round" : "square"; }

struct Inner {
  double share = 0.25;
};

struct Part {
  std::string title = "none";
  Shape shape = Shape::square;
  int holes = 4;
  double width = 0.002;
  Inner inner = {};
  double limit = 1e8;
};

struct Nobody {};

using PartRow = Key<Part, Nobody>;

void read_limit(const StudyValue& value, Part& part, const Nobody&) { part.limit = value.number() + 1.0; }

const Keys<Part, Nobody>& part_keys() {
  static const Keys<Part, Nobody> keys{
      .paths = {"part"},
      .meaning = "A part.",
      .chooser = "shape",
      .rows = {PartRow{.name = "shape",
                       .value = word_at<Shape>({{Shape::round, "turned"}, {Shape::square, "milled"}}, &Part::shape),
                       .meaning = "Its shape."},
               PartRow{.name = "limit",
                       .value = {.type = "number", .text = [](const Part& part) { return shortest(part.limit); }},
                       .meaning = "Its limit.",
                       .reader = read_limit,
                       .late = 1},
               PartRow{.name = "title", .value = text_at(&Part::title), .meaning = "Free text."},
               PartRow{.name = "holes", .value = whole_at(1, 8, &Part::holes), .meaning = "Its holes."},
               PartRow{.name = "width",
                       .value = positive_at(Dimension::length, &Part::width),
                       .missing = "write {}",
                       .example = "\"2 mm\"",
                       .only_for = {name(Shape::square)},
                       .meaning = "Its width."},
               PartRow{.name = "share",
                       .value = number_at(between_0_and_1("0.5"), &Part::inner, &Inner::share),
                       .besides = ", mostly",
                       .only_for = {name(Shape::square)},
                       .may_stay = true,
                       .meaning = "Of it."}}};
  return keys;
}

const StudyTables& tables() {
  static const StudyTables all{described(part_keys())};
  return all;
}

Part read(const std::string& text, Extent extent = Extent::complete) {
  const toml::table parsed = toml::parse(text);
  Part part;
  read_keys(part_keys(), StudySection(parsed, "part", {"f", 1, 1}, tables()), part, Nobody(), extent);
  return part;
}

std::string refusal(const std::string& text) {
  return test::refusal_of([&] { read(text); });
}

TEST(Keys, SetTheMembersOfTheirRows) {
  const Part part = read("title = \"a\"\nholes = 2\nwidth = \"5 mm\"\nshare = 0.75\nlimit = 3");
  EXPECT_EQ(part.title, "a");
  EXPECT_EQ(part.holes, 2);
  EXPECT_DOUBLE_EQ(part.width, 0.005);
  EXPECT_DOUBLE_EQ(part.inner.share, 0.75);
  EXPECT_DOUBLE_EQ(part.limit, 4.0);
}

TEST(Keys, RefuseWhatTheirRowsDoNotAllow) {
  EXPECT_EQ(refusal("width = \"5 mm\"\nwidht = 3"), "f:2:1: unknown key 'widht' in [part]; did you mean 'width'?");
  EXPECT_EQ(refusal("width = \"5 mm\"\nholes = 9"), "f:2:9: part.holes is 9; it must be at most 8");
  EXPECT_EQ(refusal("width = \"5 mm\"\nshare = 1"), "f:2:9: part.share is 1; it must lie between 0 and 1, e.g. 0.5");
  EXPECT_EQ(refusal("shape = \"oval\""), "f:1:9: part.shape is 'oval', which is unknown; known: round, square");
  EXPECT_EQ(refusal("holes = 2"), "f:1:1: key 'width' is missing in [part]; write width = \"2 mm\"");
  EXPECT_EQ(refusal("shape = \"round\"\nwidth = \"5 mm\""),
            "f:2:1: part.width does not belong to shape = \"round\"; remove it");
}

TEST(Keys, NeedNotHoldWhereAnythingIsRead) {
  EXPECT_EQ(refusal("shape = \"round\"\nshare = 0.5"), "");
  EXPECT_DOUBLE_EQ(read("shape = \"round\"\nwidth = \"5 mm\"", Extent::any).width, 0.005);
  EXPECT_DOUBLE_EQ(read("", Extent::partial).width, 0.002);
}

TEST(Keys, WriteWhatHoldsWithItsDefaults) {
  EXPECT_EQ(keys_text(part_keys(), Part()),
            "shape = \"square\"\ntitle = \"none\"\nholes = 4\nwidth = \"0.002 m\"\nshare = 0.25\nlimit = 1e+08\n");
  EXPECT_EQ(keys_text(part_keys(), Part{.shape = Shape::round}),
            "shape = \"round\"\ntitle = \"none\"\nholes = 4\nlimit = 1e+08\n");
}

TEST(Keys, TellTemplatesTheirDefaultsAndExamples) {
  const TemplateLines lines(tables());
  EXPECT_EQ(lines.usual("part", "limit"), "limit = 1e8  # Its limit. Default: 1e8.\n");
  EXPECT_EQ(lines.usual("part", "width", "# "),
            "# width = \"2 mm\"  # Its width. Greater than 0. Required where shape is square.\n");
  EXPECT_EQ(lines.usual("part", "shape"),
            "# shape: Its shape. Default: \"square\".\n#   round: turned\n#   square: milled\nshape = \"square\"\n");
}

TEST(Keys, FillTheReference) {
  const std::string text = tables_reference(tables());
  EXPECT_NE(text.find("| `width` | length, greater than 0 | *required* | `square` | Its width. |\n"),
            std::string::npos);
  EXPECT_NE(text.find("| `share` | number, between 0 and 1 | `0.25`, mostly | `square`; else ignored | Of it. |\n"),
            std::string::npos);
  EXPECT_NE(text.find("| `holes` | integer, at least 1 | `4` | all | Its holes. |\n"), std::string::npos);
  EXPECT_NE(text.find("- `round`: turned\n"), std::string::npos);
}

}  // namespace
}  // namespace poesy
