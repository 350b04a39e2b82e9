#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/summary.h"
#include "engine/report/display.h"
#include "engine/report/report_kind.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/engine/kinds/stored.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

using Json = nlohmann::json;
using enum YieldVerdict::Decision;

class AllocationReport : public testing::Test {
 protected:
  AllocationReport() {
    const test::TempFolder folder;
    const std::string path = folder.file("r.h5");
    test::Example example;
    example.write_allocation(path, example.allocation());
    result = read_result(path, [](std::string_view) { return &kAllocationFile; });
  }

  AllocationResult& found() { return found_in<AllocationResult>(result); }

  /// Changes what the fresh machines show.
  void decide(YieldVerdict::Decision decision) {
    found().certificate.decision = decision;
    result.verdicts->yield = found().certificate;
  }

  /// As an aim without costs leaves it.
  void drop_costs() {
    found().aim = Aim::equal_effect;
    found().total_cost = found().lower_bound = std::nan("");
    for (auto* list : {&found().cost, &found().share}) list->assign(3, std::nan(""));
    found().curve_yield_cost.assign(3, std::nan(""));
    found().curve_factor_cost.assign(2, std::nan(""));
    found().multiplier.assign(8, std::nan(""));
    found().saving.assign(2, std::nan(""));
    for (AllocationStage& stage : found().stages) stage.cost = stage.lower_bound = std::nan("");
  }

  std::vector<Table> tables(RowOrder order = RowOrder::effect) const {
    return result_tables(kAllocationReport, result, {default_ranking(result), order});
  }
  Table table(const std::string& name) const {
    for (Table& one : tables()) {
      if (one.name == name) return one;
    }
    ADD_FAILURE() << "no table " << name;
    return {};
  }
  std::string html() const {
    const ReportedResult reported{result, "r.h5"};
    return html_report(kAllocationReport, {&reported, 1});
  }

  StoredResult result;
};

std::vector<std::string> names(const std::vector<Table>& tables) {
  std::vector<std::string> list;
  for (const Table& table : tables) list.push_back(table.name);
  return list;
}

/// The texts of a column, by its name.
std::vector<std::string> column(const Table& table, const std::string& name) {
  std::vector<std::string> list;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (table.columns[c].name != name) continue;
    for (const std::vector<Cell>& row : table.rows) list.push_back(row[c].text);
  }
  return list;
}

using Texts = std::vector<std::string>;

TEST_F(AllocationReport, SaysFirstWhetherItIsCertified) {
  EXPECT_EQ(tables().front().caption,
            "certified: at least 99.73 % of the machines are within all limits at all poses, with 95 % confidence (360 "
            "of 148 000 fresh machines rejected, 366 were allowed)");
  decide(undecided);
  EXPECT_EQ(tables().front().caption,
            "not certified: it is not shown with 95 % confidence that at least 99.73 % of the machines are within all "
            "limits at all poses (360 of 148 000 fresh machines rejected, 366 were allowed)");
  found().certificate_most = 1;
  decide(not_kept);
  EXPECT_EQ(tables().front().caption,
            "not certified: fewer than 99.73 % of the machines are within all limits at all poses, with 95 % "
            "confidence (360 of 148 000 fresh machines rejected, 1 was allowed)");
}

TEST_F(AllocationReport, HasTheYieldOnceAsAMonteCarloStudyHasIt) {
  EXPECT_EQ(names(tables()),
            (Texts{"yield", "drawing", "allocation_limits", "stages", "cost_of_yield", "cost_of_limits"}));
  const Table yield = table("yield");
  EXPECT_EQ(column(yield, "yield"), Texts{"99.76"});
  EXPECT_EQ(column(yield, "rejects"), Texts{"360"});
}

TEST_F(AllocationReport, PutsTheDrawingInATable) {
  EXPECT_EQ(text_of(table("drawing"), kUnlimitedWidth), "");
  EXPECT_EQ(text_of(table("allocation_limits"), kUnlimitedWidth), "");
  EXPECT_EQ(text_of(table("stages"), kUnlimitedWidth), "");
  EXPECT_EQ(text_of(table("cost_of_yield"), kUnlimitedWidth), "");
  EXPECT_EQ(text_of(table("cost_of_limits"), kUnlimitedWidth), "");
  EXPECT_EQ(text_of(table("yield"), kUnlimitedWidth), "");
  EXPECT_EQ(text_of(table("drawing"), 100), "");
}

TEST_F(AllocationReport, StatesSigmasOnceWhereAllAreAlike) {
  EXPECT_EQ(column(table("drawing"), "made_of"), (Texts{"3 sigma", "3 sigma", "3 sigma + 10 % of T"}));
  found().shift = {0.0, 0.0, 0.0};
  found().sigmas = {3.99, 3.99, 3.99};
  EXPECT_TRUE(column(table("drawing"), "made_of").empty());
  EXPECT_TRUE(table("drawing").notes.front().starts_with("T = 3.99 sigma; sigma: standard deviation about the mean;"));
  found().shift = found().tolerance;
  for (double& one : found().shift) one *= 0.2;
  EXPECT_TRUE(table("drawing").notes.front().starts_with("T = 3.99 sigma + 20 % of T; sigma: "));
}

TEST_F(AllocationReport, RanksPartsByCost) {
  const auto parts = [&](RowOrder order) { return column(tables(order).at(1), "part"); };
  EXPECT_EQ(parts(RowOrder::effect), (Texts{"hinge", "bars", "plate"}));
  EXPECT_EQ(parts(RowOrder::study), (Texts{"bars", "hinge", "plate"}));
  found().part_names = {"c", "b", "a"};
  EXPECT_EQ(parts(RowOrder::name), (Texts{"a", "b", "c"}));
  std::vector<Table> all = tables();
  keep_first(1, all);
  EXPECT_EQ(column(all.at(1), "part"), Texts{"b"});
  drop_costs();
  EXPECT_EQ(parts(RowOrder::effect), (Texts{"c", "b", "a"}));
}

TEST_F(AllocationReport, NeverRoundsATolerance) {
  EXPECT_EQ(drawing_text(1.23499e-5, "m"), "+-0.01234 mm");
  EXPECT_EQ(drawing_text(9.9999e-3, "m"), "+-9.999 mm");
  EXPECT_EQ(drawing_text(0.05e-3, "m"), "+-0.05 mm");
  EXPECT_EQ(drawing_text(0.07e-3, "m"), "+-0.07 mm");
  EXPECT_EQ(drawing_text(0.0, "m"), "+-0 mm");
  EXPECT_EQ(drawing_text(2.0 * std::acos(-1.0) / 360.0, "rad"), "+-1 deg");
  for (int k = 1; k < 2000; ++k) {
    const double value = 1e-6 * static_cast<double>(k) * (1.0 + 1e-3 * static_cast<double>(k % 7));
    const double shown = std::stod(drawing_text(value, "m").substr(2)) * 1e-3;
    EXPECT_LE(shown, value * (1.0 + 1e-11));
    EXPECT_GT(shown, value * (1.0 - 1.001e-3));
  }
}

TEST_F(AllocationReport, LeavesCostsOutWhereThereAreNone) {
  drop_costs();
  EXPECT_EQ(names(tables()), (Texts{"yield", "drawing", "allocation_limits", "stages"}));
  const std::string text = text_of(tables(), kUnlimitedWidth);
  for (const char* word : {"cost", "saves", "saved", "gap", "nan"})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  EXPECT_NE(text.find("each with the same share of the limit that it uses most"), std::string::npos);
  const std::string page = html();
  EXPECT_EQ(page.find("data-figure=\"cost-of-yield\""), std::string::npos);
  EXPECT_NE(page.find("data-figure=\"parts\""), std::string::npos);
}

TEST_F(AllocationReport, NamesEveryAim) {
  found().aim = Aim::equal_tolerance;
  EXPECT_EQ(table("drawing").caption,
            "The drawing: one tolerance for 3 parts; an angle has it at a radius of 1 m, which cost 10");
  found().aim = Aim::common_factor;
  EXPECT_EQ(table("drawing").caption,
            "The drawing: tolerances of 3 parts, the study's errors times one factor, which cost 10");
}

Json data(const std::string& html) {
  constexpr std::string_view kOpen = "<script type=\"application/json\" id=\"report-data\">";
  const std::size_t begin = html.find(kOpen) + kOpen.size();
  return Json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

TEST_F(AllocationReport, DrawsPartsCostsAndPoses) {
  const std::string page = html();
  const Json figures = data(page)["figures"];
  for (const char* key : {"parts", "cost-of-yield", "cost-of-limits", "poses", "workspace"}) {
    EXPECT_TRUE(figures.contains(key)) << key;
    EXPECT_NE(page.find("data-figure=\"" + std::string(key) + "\""), std::string::npos) << key;
  }
  EXPECT_EQ(figures["parts"]["items"], (Json{"bars", "hinge", "plate"}));
  EXPECT_EQ(figures["parts"]["quantities"][0]["label"], "cost");
  EXPECT_EQ(figures["parts"]["quantities"][2]["units"], (Json{{"mm", "deg", "mm"}}));
  EXPECT_EQ(figures["poses"]["rows"], Json{"linear_deformation"});
  EXPECT_DOUBLE_EQ(figures["cost-of-yield"]["marks"][0]["value"].get<double>(), 99.73);
  EXPECT_LT(page.find("id=\"certificate\""), page.find("id=\"drawing\""));
  EXPECT_NE(page.find("# limits &lt; 30 um"), std::string::npos);
}

TEST_F(AllocationReport, WarnsOfWhatIsNotCertified) {
  const std::string warning = "Not certified: it is not shown with 95 % confidence";
  EXPECT_EQ(html().find(warning), std::string::npos);
  decide(undecided);
  EXPECT_NE(html().find(warning), std::string::npos);
}

TEST_F(AllocationReport, EscapesNames) {
  found().part_names[0] = "<b>bars</b>";
  found().chosen[1] = "\"<i>\"";
  found().stages[0].name = "<u>";
  const std::string page = html();
  for (const char* tag : {"<b>", "<i>", "<u>"}) EXPECT_EQ(page.find(tag), std::string::npos) << tag;
  EXPECT_NE(page.find("&lt;b&gt;bars&lt;/b&gt;"), std::string::npos);
  EXPECT_EQ(data(page)["figures"]["parts"]["items"][0], "<b>bars</b>");
}

TEST_F(AllocationReport, ComparesTwoResultsPartByPart) {
  StoredResult other = result;
  found_in<AllocationResult>(other).part_names[2] = "lid";
  found_in<AllocationResult>(other).total_cost = 20.0;
  const std::vector<ReportedResult> both{{result, "a.h5"}, {other, "b.h5"}};
  const std::string page = html_report(kAllocationReport, both);
  EXPECT_NE(page.find("Only in B: lid."), std::string::npos);
  EXPECT_NE(page.find("Cost of all parts"), std::string::npos);
  EXPECT_EQ(data(page)["figures"]["side-by-side"]["items"], (Json{"bars", "hinge"}));
  drop_costs();
  const std::vector<ReportedResult> without{{result, "a.h5"}, {other, "b.h5"}};
  EXPECT_EQ(html_report(kAllocationReport, without).find("Cost of all parts"), std::string::npos);
}

TEST_F(AllocationReport, IsJsonForPrograms) {
  const Json json = Json::parse(json_of(result, allocation_of(result).total(), tables()));
  EXPECT_EQ(json["tables"][1]["name"], "drawing");
  EXPECT_EQ(json["tables"][1]["rows"][1]["tolerance"].get<double>(), 1.23456789e-5 / 1e-3);
  EXPECT_EQ(json["tables"][1]["rows"][1]["drawing"], "+-0.01234 mm");
  EXPECT_EQ(json["tables"][0]["rows"][0]["machines"], 148000);
}

}  // namespace
}  // namespace poesy
