#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "engine/kinds/allocation/in_no_part.h"
#include "engine/kinds/allocation/kind.h"
#include "engine/kinds/allocation/result.h"
#include "engine/kinds/allocation/summary.h"
#include "engine/report/display.h"
#include "engine/report/report_kind.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/engine/kinds/stored.h"
#include "tests/support/temp_folder.h"

namespace poesy::allocation {
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
    result = read_result(path);
  }

  Result& found() { return found_in<Result>(result); }

  /// Changes the verdict of the certificate.
  void decide(YieldVerdict::Decision decision) {
    found().certificate.decision = decision;
    result.verdicts->yield = found().certificate;
  }

  /// Sets the result to that of an aim without costs: all costs are NaN.
  void drop_costs() {
    found().aim = Aim::equal_effect;
    found().total_cost = found().lower_bound = std::nan("");
    for (const auto numbers : {found().cost.all(), found().share.all(), found().curve_yield_cost.all(),
                               found().curve_factor_cost.all(), found().multiplier.all(), found().saving.all()}) {
      std::ranges::fill(numbers, std::nan(""));
    }
    for (AllocationStage& stage : found().stages) stage.cost = stage.lower_bound = std::nan("");
  }

  std::vector<Table> tables(RowOrder order = RowOrder::effect) const {
    return result_tables(kReport, result, {default_ranking(result), order});
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
    return html_report(kReport, {&reported, 1});
  }

  StoredResult result;
};

std::vector<std::string> names(const std::vector<Table>& tables) {
  std::vector<std::string> list;
  for (const Table& table : tables) list.push_back(table.name);
  return list;
}

/// The texts of the column `name` of a table.
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

TEST_F(AllocationReport, HasTheYieldAsAMonteCarloStudy) {
  EXPECT_EQ(names(tables()),
            (Texts{"yield", "drawing", "allocation_limits", "stages", "cost_of_yield", "cost_of_limits"}));
  const Table yield = table("yield");
  EXPECT_EQ(column(yield, "yield"), Texts{"99.757"});
  EXPECT_EQ(column(yield, "rejects"), Texts{"360"});
}

TEST_F(AllocationReport, SaysThatPlaysAreInNoPart) {
  found().part_members(1) = "delta_2";
  result.factor_draws = {"per pose", "per pose"};
  EXPECT_NE(table("in_no_part").notes.front().find("no part can have them, because a machine draws them anew"),
            std::string::npos);
}

TEST_F(AllocationReport, NamesTheErrorsThatAreInNoPart) {
  found().part_members(1) = "delta_2";
  EXPECT_EQ(text_of(table("in_no_part"), 100),
            "In no part: 1 error, taken as [errors] states it\n"
            "error      distribution  sigma  unit\n"
            "epsilon_1  uniform       16.54  deg\n"
            "The tolerances were found and certified with these sizes, so the certificate holds only if these\n"
            "errors keep them; a part of [[analysis.parts]] that names them finds their tolerances\n");
  const std::string text =
      "1 of 2 varied errors is in no part; its size stays as [errors] states it: epsilon_1 (uniform, sigma 16.54 deg)";
  const std::string page = html();
  EXPECT_NE(page.find(text + ". The certificate holds only with these sizes."), std::string::npos);
  EXPECT_NE(page.find("data-table=\"in_no_part\""), std::string::npos);
  EXPECT_NE(kReport.method(result).text.find(text), std::string::npos);
}

TEST(InNoPartText, NamesThreeSizes) {
  std::vector<UnallocatedError> errors;
  for (const int n : {1, 2, 3, 4, 5}) errors.push_back({{"e_" + std::to_string(n), "m"}, "normal", 1e-5 * n});
  EXPECT_EQ(
      in_no_part_text(errors, 9),
      "5 of 9 varied errors are in no part; their sizes stay as [errors] states them: e_1 (normal, sigma 0.01 mm); "
      "e_2 (normal, sigma 0.02 mm); e_3 (normal, sigma 0.03 mm); and 2 more errors");
}

TEST_F(AllocationReport, PutsTheDrawingInATable) {
  EXPECT_EQ(text_of(table("drawing"), 100),
            "The drawing: tolerances of 3 parts at least cost, 10 in all\n"
            "                     grade or                               share     share of\n"
            "part   drawing       process   T =                  cost  of cost  mean square  at bound\n"
            "                                                              [%]          [%]\n"
            "hinge  +-0.1 deg     grinding  3 sigma               7         70         37.5  upper\n"
            "bars   +-0.01234 mm  -         3 sigma               2.5       25         50    -\n"
            "plate  +-0.025 mm    IT7       3 sigma + 10 % of T   0.5        5         12.5  no choice\n"
            "sigma: standard deviation about the mean; a share of T is for a mean that is off by so much, as\n"
            "often up as down; on the drawing T is rounded down to four digits\n"
            "share of mean square: of what all parts add to the mean square under the tightest limit; rejects if\n"
            "coarser: of the design's machines, predicted for this part alone with a T 5 % larger, or the next\n"
            "larger one that can be had\n"
            "in no part is 25 % of the mean square under the tightest limit: background, errors without a part,\n"
            "noise of measurements, interactions of errors; the tolerances of this table do not reduce it\n"
            "under the last limits on root mean squares no tolerances cost less than 9.995, to within 0.005\n"
            "(no room for rejects if coarser, T, errors: a wider terminal shows more)\n");
  EXPECT_EQ(column(table("drawing"), "coarser_rejects"), (Texts{"58", "70", "-"}));
  EXPECT_EQ(column(table("drawing"), "tolerance"), (Texts{"0.1", "0.0123457", "0.025"}));
  EXPECT_EQ(column(table("drawing"), "errors"), (Texts{"epsilon_1", "delta_1 delta_2", "delta_3"}));
}

/// The first note of a table that begins with `begin`. Empty if no note does.
std::string note_of(const Table& table, std::string_view begin) {
  for (const std::string& note : table.notes) {
    if (note.starts_with(begin)) return note;
  }
  return {};
}

TEST_F(AllocationReport, OffersNoToleranceOfAPartWithoutEffect) {
  EXPECT_EQ(column(table("drawing"), "drawing").front(), "+-0.1 deg");
  EXPECT_EQ(note_of(table("drawing"), "no effect"), "");
  found().mean_square_share(1) = 0.0;  // of the hinge under the tightest limit; another limit may depend on it
  EXPECT_EQ(column(table("drawing"), "drawing").front(), "+-0.1 deg");
  found().bound(1) = Result::kWithoutEffect;
  EXPECT_EQ(column(table("drawing"), "drawing").front(), "no effect");
  EXPECT_NE(note_of(table("drawing"), "no effect: "), "");
  found().bound(1) = 0;  // the hinge is no longer at its upper bound
  EXPECT_EQ(column(table("drawing"), "drawing").front(), "+-0.1 deg");
}

TEST_F(AllocationReport, StatesWhatIsInNoPart) {
  EXPECT_EQ(note_of(table("drawing"), "in no part"),
            "in no part is 25 % of the mean square under the tightest limit: background, errors without a part, noise "
            "of measurements, interactions of errors; the tolerances of this table do not reduce it");
  EXPECT_EQ(column(table("allocation_limits"), "fixed_share"), Texts{"25"});
  found().fixed_share(1) = 0.0;
  EXPECT_EQ(note_of(table("drawing"), "in no part"), "");
  found().fixed_share = {};  // files of version 0.2 have no fixed_share
  EXPECT_EQ(note_of(table("drawing"), "in no part"), "");
}

TEST_F(AllocationReport, SaysWhatEachLimitAsksForAndWhere) {
  EXPECT_EQ(text_of(table("allocation_limits"), 100),
            "What each limit asks for, and where\n"
            "                                         at  1 % wider             at\n"
            "response            limit  unit  used  pose      saves  decides  pose\n"
            "                                  [%]                       [%]\n"
            "linear_deformation   0.03  mm     100     3       0.09      100     2\n"
            "used: the predicted root mean square over what the tightest limit allows it, at the pose where it is\n"
            "largest\n"
            "in no part: share of the mean square at this pose that belongs to no part (background, errors\n"
            "without a part, noise of measurements, interactions of errors)\n"
            "1 % wider saves: of the cost, if this limit alone is wider by 1 % at all poses, to first order, at\n"
            "the same yield; much wider, a limit saves less for each per cent, because others then decide\n"
            "decides: share of the fresh machines near the limits, within 10 %, whose largest ratio of a response\n"
            "to its limit is under this limit; at pose: where most of them have it\n"
            "(no room for where, in no part: a wider terminal shows more)\n");
  EXPECT_EQ(column(table("allocation_limits"), "used_place"), Texts{"z -203 mm, beta 21.5 deg, gamma -43 deg"});
  EXPECT_EQ(column(table("allocation_limits"), "decides_place"), Texts{"z -219 mm, beta 14.3 deg, gamma -28.6 deg"});
  std::ranges::fill(found().deciding_share, std::nan(""));  // no machine is near the limits
  EXPECT_EQ(column(table("allocation_limits"), "decides"), Texts{"-"});
  EXPECT_EQ(column(table("allocation_limits"), "decides_pose"), Texts{"-"});
  found().deciding_share = {};  // files of version 0.2 have no deciding_share
  EXPECT_EQ(note_of(table("allocation_limits"), "decides"), "");
}

TEST_F(AllocationReport, PrintsPlacesWithMinusSigns) {
  const std::string page = html();
  EXPECT_NE(page.find(">z \u2212203 mm, beta 21.5 deg, gamma \u221243 deg<"), std::string::npos);
  EXPECT_EQ(column(table("allocation_limits"), "used_place"), Texts{"z -203 mm, beta 21.5 deg, gamma -43 deg"});
}

TEST_F(AllocationReport, TakesRoundingForNoChangeOfCost) {
  const double cost = found().total_cost;
  found().curve_yield_cost = {{3}, {0.9 * cost, cost * (1.0 - 1.2e-6), cost * (1.0 + 2e-16)}};
  const Texts changes = column(table("cost_of_yield"), "change");
  EXPECT_EQ(changes, (Texts{"-10", "0", "0"}));
}

TEST_F(AllocationReport, TellsTheWayAndWhatElseWouldCost) {
  EXPECT_EQ(text_of(table("stages"), kUnlimitedWidth),
            "How the tolerances were found, step by step\n"
            "                           above the  rms over\n"
            "stage                cost      bound     limit  machines  rejects\n"
            "linear                  9      0.25     0.3333         -        -\n"
            "scaled to the yield    10      0.005    0.3       20 000       48\n"
            "rms over limit: the limit on a root mean square over the limit on a value; rejects: of the machines\n"
            "that were tried at these tolerances\n"
            "at the end 48 of the design's 20 000 machines are rejects; with up to 49 the certificate will\n"
            "probably hold\n"
            "above the bound: cost above what no tolerances of this step's problem go below\n");
  EXPECT_EQ(text_of(table("cost_of_yield"), kUnlimitedWidth),
            "What another yield would cost\n"
            "yield  cost  change\n"
            "  [%]           [%]\n"
            "99      8       -20\n"
            "99.73  10         0\n"
            "99.9   12.5      25\n"
            "yield: what a study would ask for and certify with the same margin, so that more of its machines\n"
            "would be good\n"
            "predicted, not certified; change: from the cost of the tolerances found\n"
            "tolerances go in steps (grades, processes, rounded numbers), so costs jump, and the tolerances that\n"
            "a study finds may cost some per cent more than this\n");
  EXPECT_EQ(text_of(table("cost_of_limits"), kUnlimitedWidth),
            "What other limits would cost\n"
            "all limits\n"
            "     times  cost  change\n"
            "                     [%]\n"
            "       0.5    20     100\n"
            "       1      10       0\n"
            "errors that are in no part keep their size, so far from the study's limits these costs may be off by\n"
            "a third; run the study with the limits that you want\n"
            "predicted, not certified; change: from the cost of the tolerances found\n"
            "tolerances go in steps (grades, processes, rounded numbers), so costs jump, and the tolerances that\n"
            "a study finds may cost some per cent more than this\n");
}

TEST_F(AllocationReport, StatesSigmasOnceWhereAllAreAlike) {
  EXPECT_EQ(column(table("drawing"), "made_of"), (Texts{"3 sigma", "3 sigma", "3 sigma + 10 % of T"}));
  std::ranges::fill(found().shift, 0.0);
  std::ranges::fill(found().sigmas, 3.99);
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
  for (const char* word : {"cost", "saves", "saved", "bound:", "nan"})
    EXPECT_EQ(text.find(word), std::string::npos) << word;
  EXPECT_NE(text.find("each with the same share of the limit that it uses most"), std::string::npos);
  const std::string page = html();
  EXPECT_EQ(page.find("data-figure=\"cost-of-yield\""), std::string::npos);
  EXPECT_NE(page.find("data-figure=\"parts\""), std::string::npos);
}

TEST_F(AllocationReport, NamesEveryAim) {
  found().aim = Aim::equal_tolerance;
  EXPECT_EQ(table("drawing").caption,
            "The drawing: one tolerance for all lengths and one for all angles of 3 parts, which cost 10");
  found().aim = Aim::common_factor;
  EXPECT_EQ(table("drawing").caption,
            "The drawing: tolerances of 3 parts, the study's errors times one factor, which cost 10");
}

Json data(const std::string& html) {
  constexpr std::string_view kOpen = "<script type=\"application/json\" id=\"report-data\">";
  const std::size_t begin = html.find(kOpen) + kOpen.size();
  return Json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

/// The number of elements of an array in the page's data. Arrays are 32-bit floats in base64.
std::size_t numbers(const Json& report, const Json& name) {
  const std::string text = report["arrays"].at(name.get<std::string>());
  const std::size_t padding = text.size() - text.find_last_not_of('=') - 1;
  return (text.size() / 4 * 3 - padding) / sizeof(float);
}

TEST_F(AllocationReport, DrawsPartsCostsAndPoses) {
  const std::string page = html();
  const Json report = data(page);
  const Json& figures = report["figures"];
  for (const char* key : {"parts", "cost-of-yield", "cost-of-limits", "poses", "workspace"}) {
    EXPECT_TRUE(figures.contains(key)) << key;
    EXPECT_NE(page.find("data-figure=\"" + std::string(key) + "\""), std::string::npos) << key;
  }
  EXPECT_EQ(figures["parts"]["items"], (Json{"bars", "hinge", "plate"}));
  EXPECT_EQ(figures["parts"]["quantities"][0]["label"], "cost");
  EXPECT_EQ(figures["parts"]["quantities"][2]["units"], (Json{{"mm", "deg", "mm"}}));
  EXPECT_EQ(report["about"]["bars"], "delta_1 delta_2");
  EXPECT_EQ(figures["poses"]["rows"], Json{"linear_deformation"});
  EXPECT_DOUBLE_EQ(figures["cost-of-yield"]["marks"][0]["value"].get<double>(), 99.73);
  for (const Json& quantity : figures["parts"]["quantities"]) EXPECT_EQ(numbers(report, quantity["value"]), 3u);
  for (const Json& layer : figures["poses"]["layers"]) EXPECT_EQ(numbers(report, layer["value"]), 4u);
  EXPECT_EQ(numbers(report, figures["cost-of-yield"]["panels"][0]["series"][0]["value"]), 3u);
  EXPECT_EQ(numbers(report, figures["cost-of-limits"]["x"]["value"]), 2u);
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
  found().chosen(1) = "\"<i>\"";
  found().stages[0].name = "<u>";
  const std::string page = html();
  for (const char* tag : {"<b>", "<i>", "<u>"}) EXPECT_EQ(page.find(tag), std::string::npos) << tag;
  EXPECT_NE(page.find("&lt;b&gt;bars&lt;/b&gt;"), std::string::npos);
  EXPECT_EQ(data(page)["figures"]["parts"]["items"][0], "<b>bars</b>");
}

TEST_F(AllocationReport, ComparesTwoResultsPartByPart) {
  StoredResult other = result;
  found_in<Result>(other).part_names[2] = "lid";
  found_in<Result>(other).total_cost = 20.0;
  const std::vector<ReportedResult> both{{result, "a.h5"}, {other, "b.h5"}};
  const std::string page = html_report(kReport, both);
  EXPECT_NE(page.find("Only in B: lid."), std::string::npos);
  EXPECT_NE(page.find("Cost of all parts"), std::string::npos);
  EXPECT_EQ(data(page)["figures"]["side-by-side"]["items"], (Json{"bars", "hinge"}));
  drop_costs();
  const std::vector<ReportedResult> without{{result, "a.h5"}, {other, "b.h5"}};
  EXPECT_EQ(html_report(kReport, without).find("Cost of all parts"), std::string::npos);
}

TEST_F(AllocationReport, IsJsonForPrograms) {
  const Json json = Json::parse(json_of(result, allocation_of(result).total(), tables()));
  EXPECT_EQ(json["tables"][1]["name"], "drawing");
  EXPECT_EQ(json["tables"][1]["rows"][1]["tolerance"].get<double>(), 1.23456789e-5 / 1e-3);
  EXPECT_EQ(json["tables"][1]["rows"][1]["drawing"], "+-0.01234 mm");
  EXPECT_EQ(json["tables"][0]["rows"][0]["machines"], 148000);
}

}  // namespace
}  // namespace poesy::allocation
