#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/report/display.h"
#include "engine/report/html/figures.h"
#include "engine/report/html/page.h"
#include "engine/report/solves.h"

namespace poesy {
namespace {

TEST(Escaped, LeavesNothingThatMeansSomethingInHtml) {
  EXPECT_EQ(escaped("<a href=\"x\">'&'"), "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;");
  EXPECT_EQ(escaped("line\nand\ttab"), "line\nand\ttab");
}

TEST(Escaped, KeepsUtf8AndReplacesWhatIsNone) {
  EXPECT_EQ(escaped("ü € 😀"), "ü € 😀");
  const std::string replaced = "\xEF\xBF\xBD";
  for (const char* bad : {"\xFF", "\x80", "\x01", "\x7F", "\xC3"}) EXPECT_EQ(escaped(bad), replaced) << bad;
  EXPECT_EQ(escaped("\xC0\xAF"), replaced + replaced);                 // overlong encoding
  EXPECT_EQ(escaped("\xED\xA0\x80"), replaced + replaced + replaced);  // a surrogate
  EXPECT_EQ(escaped("\xE2\x82"
                    "a"),
            replaced + replaced + "a");
}

TEST(Base64, IsThatOfRfc4648) {
  const auto of = [](std::string_view text) { return base64(std::as_bytes(std::span(text))); };
  EXPECT_EQ(of(""), "");
  EXPECT_EQ(of("f"), "Zg==");
  EXPECT_EQ(of("fo"), "Zm8=");
  EXPECT_EQ(of("foo"), "Zm9v");
  EXPECT_EQ(of("foobar"), "Zm9vYmFy");
}

TEST(ArrayPool, KeepsEachNameOnceInTheUnitShown) {
  ArrayPool pool;
  const std::array values{0.001, 0.25, std::numeric_limits<double>::infinity()};
  EXPECT_EQ(pool.add("a", values, 0.001), "a");
  EXPECT_EQ(pool.add("a", values, 0.001), "a");
  ASSERT_EQ(pool.arrays().size(), 1U);
  const std::vector<float>& kept = pool.arrays().at("a");
  EXPECT_FLOAT_EQ(kept[0], 1.0F);
  EXPECT_FLOAT_EQ(kept[1], 250.0F);
  EXPECT_TRUE(std::isnan(kept[2]));
}

TEST(FiguresJson, SaysWhatNamesMeanAndWhatIsADifference) {
  FigureSet set;
  set.about = {{"delta", "a shift"}};
  set.figures.emplace("k", HeatMap{.layers = {{"B - A", "mm", "v", true}, {"A", "mm", "v"}},
                                   .rows = {},
                                   .column_label = "pose",
                                   .coordinates = {},
                                   .order = "|x|"});
  const nlohmann::json json = nlohmann::json::parse(figures_json(set));
  EXPECT_EQ(json["about"]["delta"], "a shift");
  EXPECT_EQ(json["figures"]["k"]["columns"]["order"], "|x|");
  EXPECT_TRUE(json["figures"]["k"]["layers"][0]["signed"]);
  EXPECT_FALSE(json["figures"]["k"]["layers"][1].contains("signed"));
}

TEST(FiguresJson, HasNoNumberForAnInfiniteEndOfALimit) {
  FigureSet set;
  constexpr double kNone = std::numeric_limits<double>::infinity();
  set.figures.emplace("k",
                      WhatIf{.factors = {0.5, 1.0},
                             .sliders = {{"rail", {{"position", 0.1, "mm"}}, {0, 2}}, {"rod", {}, {1}, {2.0, 1.0}}},
                             .limits = {{3, -1.0, 1.0}, {1, 0.5, kNone}}});
  const nlohmann::json json = nlohmann::json::parse(figures_json(set))["figures"]["k"];
  EXPECT_EQ(json["type"], "whatIf");
  EXPECT_EQ(json["limits"][0]["high"], 1.0);
  EXPECT_EQ(json["limits"][1]["low"], 0.5);
  EXPECT_TRUE(json["limits"][1]["high"].is_null());
  EXPECT_FALSE(json["sliders"][0].contains("costs"));
  EXPECT_EQ(json["sliders"][1]["costs"], (std::vector{2.0, 1.0}));
}

TEST(Page, PutsASectionAfterTheNamedOneOrAtTheEnd) {
  Page page;
  page.add_section("a", "A");
  page.add_section("b", "B");
  page.insert_section("a", "after-a", "After A");
  page.insert_section("none", "last", "Last");
  std::vector<std::string> ids;
  for (const Section& section : page.sections) ids.push_back(section.id());
  EXPECT_EQ(ids, (std::vector<std::string>{"a", "after-a", "b", "last"}));
}

TEST(FiguresJson, HasNoTags) {
  FigureSet set;
  set.figures.emplace("k", HeatMap{.layers = {}, .rows = {"</script><!--"}, .column_label = "pose", .coordinates = {}});
  const std::string json = figures_json(set);
  EXPECT_EQ(json.find('<'), std::string::npos);
  EXPECT_NE(json.find("\\u003c/script>\\u003c!--"), std::string::npos);
}

TEST(HtmlTable, NamesRowsByTheFirstTextAndShowsUnitsAndNotes) {
  const Table table{.name = "t",
                    .caption = "A & B",
                    .columns = {{"rank", "rank", "", Column::Kind::number},
                                {"error", "error", "", Column::Kind::text},
                                {"x", "x", "mm", Column::Kind::number}},
                    .rows = {{{"1", 1.0}, {"<a>", {}}, {"2.5", 2.5}}},
                    .notes = {"a note"}};
  const std::string html = html_table(table);
  for (const char* part : {"<caption>A &amp; B</caption>", "<th scope=\"col\" class=\"n\">x [mm]</th>",
                           "<tr><td class=\"n\">1</td><th scope=\"row\">&lt;a&gt;</th><td class=\"n\">2.5</td></tr>",
                           "<p class=\"note\">a note</p>", "data-table=\"t\""}) {
    EXPECT_NE(html.find(part), std::string::npos) << part << "\n" << html;
  }
}

TEST(HtmlTable, NamesRowsByTheFirstNumberWhereItHasNoTexts) {
  const Table table{.name = "t",
                    .caption = "c",
                    .columns = {{"x", "x", "mm", Column::Kind::number}, {"y", "y", "mm", Column::Kind::number}},
                    .rows = {{{"-43.301", -43.301}, {"1", 1.0}}, {{"50", 50.0}, {"2", 2.0}}}};
  const std::string html = html_table(table);
  EXPECT_NE(html.find("<th scope=\"row\" class=\"n\">\u221243.301</th>"), std::string::npos) << html;
  EXPECT_EQ(html.find("<th scope=\"row\">"), std::string::npos) << html;
}

TEST(HtmlTable, MarksColumnsThatAreHiddenFirstOrNever) {
  const Table table{.name = "t",
                    .caption = "c",
                    .columns = {{"error", "error", ""},
                                {"x", "x", "mm", Column::Kind::number, 2},
                                {"y", "y", "mm", Column::Kind::number}},
                    .rows = {}};
  Table marked = table;
  marked.columns[2].main = true;
  const std::string html = html_table(marked);
  EXPECT_NE(html.find("<th scope=\"col\" class=\"n\" data-spare=\"2\">x [mm]</th>"), std::string::npos) << html;
  EXPECT_NE(html.find("<th scope=\"col\" class=\"n\" data-main>y [mm]</th>"), std::string::npos) << html;
  EXPECT_EQ(html_table(table).find("data-main"), std::string::npos);
}

TEST(HtmlTable, GivesLongNamesOfRowsLines) {
  const Table table{.name = "t",
                    .caption = "c",
                    .columns = {{"error", "error", "", Column::Kind::text}, {"x", "x", "mm", Column::Kind::number}},
                    .rows = {{{"18 errors whose effect cannot be told from zero", {}}, {"-", {}}}}};
  const std::string html = html_table(table);
  EXPECT_NE(html.find("<th scope=\"row\" class=\"long\">18 errors"), std::string::npos) << html;
}

TEST(HtmlTable, DrawsToleranceFramesInThePlaceOfTheirTexts) {
  const Table table{.name = "t",
                    .caption = "c",
                    .columns = {{"feature", "feature", ""},
                                {.name = "symbol", .heading = "symbol", .unit = "", .only_text = true},
                                {"zone", "zone", ""}},
                    .rows = {{{"rail", {}}, {"\u2316", {}}, {"0.05 mm", {}, {}, {"\u2316", "\u23000.05", "<A>"}}}}};
  const std::string html = html_table(table);
  EXPECT_NE(html.find("<th scope=\"col\">feature</th><th scope=\"col\">zone</th></tr>"), std::string::npos) << html;
  EXPECT_NE(html.find("<tr><th scope=\"row\">rail</th><td><span class=\"tolerance\" role=\"img\" "
                      "aria-label=\"position dia 0.05 &lt;A&gt;\" title=\"position dia 0.05 &lt;A&gt;\">"
                      "<span>\u2316</span><span>\u23000.05</span><span>&lt;A&gt;</span></span></td></tr>"),
            std::string::npos)
      << html;
}

TEST(HtmlTable, PutsDecimalPointsBelowEachOther) {
  const Table table{.name = "t",
                    .caption = "c",
                    .columns = {{"error", "error", "", Column::Kind::text}, {"x", "x", "mm", Column::Kind::number}},
                    .rows = {{{"a", {}}, {"2.616", 2.616}},
                             {{"b", {}}, {"0.4", 0.4}},
                             {{"c", {}}, {"0", 0.0}},
                             {{"d", {}}, {"-", {}}}},
                    .notes = {}};
  const std::string html = html_table(table);
  for (const char* part : {"<td class=\"n\" style=\"--room:1\">2.616</td>", "<td class=\"n\">0.4000</td>",
                           "<td class=\"n\" style=\"--room:4.5\">0</td>", "<td class=\"n\">-</td>"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part << "\n" << html;
  }
}

/// Whether `failed` of 100 000 solves are many for a study with this line under [solver].
bool many_of_a_hundred_thousand(std::uint64_t failed, const std::string& line) {
  StoredResult result;
  result.study_text = "max_not_converged = 0.7\n[solver]\nmethod = \"newton\"\n" + line + "\n";
  return many_not_converged(result, failed, 100'000);
}

TEST(NotConverged, IsWorthAWarningAboveWhatTheStudyAllows) {
  EXPECT_FALSE(many_of_a_hundred_thousand(2000, "max_not_converged = 0.02"));
  EXPECT_TRUE(many_of_a_hundred_thousand(2001, "max_not_converged = 0.02"));
  EXPECT_FALSE(many_of_a_hundred_thousand(1, "max_not_converged = 1e-05"));
  EXPECT_TRUE(many_of_a_hundred_thousand(2, "max_not_converged = 1e-05"));
  EXPECT_FALSE(many_of_a_hundred_thousand(0, "max_not_converged = 0"));
  EXPECT_TRUE(many_of_a_hundred_thousand(1, "max_not_converged = 0"));
}

TEST(NotConverged, IsAWarningAboveATenthOfAPercent) {
  for (const char* line : {"max_not_converged = 1", "tolerance = 1e-15"}) {
    EXPECT_FALSE(many_of_a_hundred_thousand(100, line)) << line;
    EXPECT_TRUE(many_of_a_hundred_thousand(101, line)) << line;
  }
}

TEST(StudySettings, ListsGoOnOverLines) {
  const auto settings = study_settings(
      "[errors.override]\nx = { distribution = \"measured\", values = [\n  \"1 m\", \"2 m\",\n  \"3 m [\",\n] }\n"
      "[analysis]\nsamples = 2\n");
  ASSERT_EQ(settings.size(), 2u);
  EXPECT_EQ(settings[0].section, "errors.override");
  EXPECT_EQ(settings[0].key, "x");
  EXPECT_EQ(settings[0].value, "{ distribution = \"measured\", values = [\"1 m\", \"2 m\", \"3 m [\"] }");
  EXPECT_EQ(settings[1].section, "analysis");
  EXPECT_EQ(settings[1].value, "2");
}

TEST(StudySettings, CountRepeatedSections) {
  const auto settings = study_settings(
      "title = \"x\"\n[[case]]\nname = \"a\"\n\n[[case]]\nname = \"b\"\n[case.errors]\nlinear = \"1 mm\"\n");
  ASSERT_EQ(settings.size(), 4U);
  EXPECT_EQ(settings[0].section, "");
  EXPECT_EQ(settings[1].section, "case 1");
  EXPECT_EQ(settings[2].section, "case 2");
  EXPECT_EQ(settings[2].key, "name");
  EXPECT_EQ(settings[2].value, "\"b\"");
  EXPECT_EQ(settings[3].section, "case 2.errors");
}

TEST(StudySettings, HaveTheOrderOfTheText) {
  const auto settings = study_settings("z = 1\n[b]\ny = 2 # not 3\nx.w = true\n[a]\nv = 0.5\n");
  std::string all;
  for (const StudySetting& one : settings) all += one.section + "." + one.key + "=" + one.value + " ";
  EXPECT_EQ(all, ".z=1 b.y=2 b.x.w=true a.v=0.5 ");
}

TEST(StudySettings, AreNoneInATextThatIsNotToml) {
  EXPECT_TRUE(study_settings("a = 1\nx = [").empty());
  std::string deep = "a";
  for (int k = 0; k < 8000; ++k) deep += ".a";
  EXPECT_TRUE(study_settings(deep + " = 1").empty());
}

TEST(StudySettings, AreFoundInTheirSectionAndMadeReadable) {
  const std::string text =
      "a = 1\n[errors]\nlinear = { distribution = \"normal\", sigma = \"0.001 m\" }\n[solver]\nmethod = \"newton\"\n";
  EXPECT_EQ(study_setting(text, "solver", "method"), "\"newton\"");
  EXPECT_EQ(study_setting(text, "errors", "method"), "");
  EXPECT_EQ(study_setting(text, "", "a"), "1");
  EXPECT_EQ(readable_setting(text, "errors", "linear"), "distribution = normal, sigma = 1 mm");
  EXPECT_EQ(readable_setting("\"0.017453292519943295 rad\""), "1 deg");
  EXPECT_EQ(readable_setting("\"open"), "\"open");
  EXPECT_EQ(readable_setting("{ sigma = 4.9999999999999996e-05, samples = 1000 }"), "sigma = 5e-05, samples = 1000");
  EXPECT_EQ(readable_setting("[0.00025000000000000001, 12345678901234567890]"), "[0.00025, 12345678901234567890]");
}

}  // namespace
}  // namespace poesy
