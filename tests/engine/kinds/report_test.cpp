#include "engine/kinds/sensitivity/result.h"
#include "engine/report/report_kind.h"
#include "engine/report/tables.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "engine/base/error.h"
#include "engine/kinds/identification/identification.h"
#include "engine/report/display.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/engine/kinds/stored.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

using Json = nlohmann::json;

/// The first group of every match of `pattern` in `text`.
std::vector<std::string> all(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  std::vector<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), expression); at != std::sregex_iterator(); ++at) {
    found.push_back((*at)[1]);
  }
  return found;
}

/// The body of the page without its scripts.
std::string body(const std::string& html) {
  const std::size_t begin = html.find("<body>");
  return html.substr(begin, html.find("<script type=\"application/json\"") - begin);
}

Json data(const std::string& html) {
  constexpr std::string_view kOpen = "<script type=\"application/json\" id=\"report-data\">";
  const std::size_t begin = html.find(kOpen) + kOpen.size();
  return Json::parse(html.substr(begin, html.find("</script>", begin) - begin));
}

std::vector<float> floats(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned group = 0;
  unsigned bits = 0;
  for (const char digit : base64) {
    if (digit == '=') break;
    group = group << 6 | static_cast<unsigned>(digits.find(digit));
    bits += 6;
    if (bits >= 8) bytes += static_cast<char>(group >> (bits -= 8) & 0xFF);
  }
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), values.size() * sizeof(float));  // little-endian, as this machine
  return values;
}

std::vector<float> array(const Json& report, const Json& name) {
  return floats(report["arrays"].at(name.get<std::string>()).get<std::string>());
}

void expect_size(const Json& report, const Json& name, std::size_t size) {
  if (name.is_null()) return;
  EXPECT_EQ(array(report, name).size(), size) << name;
}

std::size_t options(const Json& figure) {
  std::size_t product = 1;
  for (const Json& choice : figure["choices"]) product *= choice["options"].size();
  return product;
}

void check_bars(const Json& report, const Json& figure) {
  const std::size_t series = figure.contains("series") ? figure["series"].size() : 1;
  const std::size_t items = figure["items"].size();
  for (const Json& quantity : figure["quantities"]) {
    EXPECT_EQ(quantity["units"].size(), options(figure));
    for (const Json& unit : quantity["units"]) EXPECT_TRUE(unit.is_string() || unit.size() == items);
    for (const char* member : {"value", "low", "high"}) {
      expect_size(report, quantity[member], series * options(figure) * items);
    }
  }
}

void check_heat_map(const Json& report, const Json& figure) {
  const std::size_t rows = figure["rows"].size();
  const std::size_t cells = array(report, figure["layers"][0]["value"]).size();
  for (const Json& coordinate : figure["columns"]["coordinates"]) {
    expect_size(report, coordinate["value"], cells / rows);
  }
  EXPECT_EQ(cells % rows, 0u);
  for (const Json& layer : figure["layers"]) expect_size(report, layer["value"], cells);
}

void check_workspace(const Json& report, const Json& figure) {
  const std::size_t poses = array(report, figure["coordinates"][0]["value"]).size();
  if (figure.contains("numbers")) expect_size(report, figure["numbers"], poses);
  for (const Json& coordinate : figure["coordinates"]) expect_size(report, coordinate["value"], poses);
  for (const Json& field : figure["fields"]) {
    expect_size(report, field["value"], (field.contains("rows") ? field["rows"].size() : 1) * poses);
  }
}

void check_lines(const Json& report, const Json& figure) {
  const std::size_t points = array(report, figure["x"]["value"]).size();
  for (const Json& panel : figure["panels"]) {
    for (const Json& series : panel["series"]) {
      for (const char* member : {"value", "low", "high"}) {
        if (series.contains(member)) expect_size(report, series[member], points);
      }
    }
  }
}

void check_scatter(const Json& report, const Json& figure) {
  EXPECT_EQ(figure["units"].size(), options(figure));
  for (const char* axis : {"x", "y"}) {
    expect_size(report, figure[axis]["value"], options(figure) * figure["names"].size());
  }
}

/// Checks that the page is consistent: unique sections that the navigation links to, a figure in the data for each
/// figure element, and closed tags.
void check_page(const std::string& html) {
  const std::string page = body(html);
  const std::vector<std::string> ids = all(page, "<section id=\"([^\"]*)\"");
  EXPECT_EQ(std::set(ids.begin(), ids.end()).size(), ids.size());
  EXPECT_EQ(all(page, "<a href=\"#([^\"]*)\">"), ids);  // the skip link has a class
  const Json report = data(html);
  const std::vector<std::string> keys = all(page, "<figure data-figure=\"([^\"]*)\">");
  EXPECT_EQ(std::set(keys.begin(), keys.end()).size(), keys.size());
  EXPECT_EQ(keys.size(), report["figures"].size());
  using Check = std::function<void(const Json&, const Json&)>;
  const std::map<std::string, Check> checks{{"bars", check_bars},
                                            {"heatmap", check_heat_map},
                                            {"workspace", check_workspace},
                                            {"lines", check_lines},
                                            {"scatter", check_scatter}};
  for (const std::string& key : keys) {
    SCOPED_TRACE(key);
    ASSERT_TRUE(report["figures"].contains(key));
    const Json& figure = report["figures"][key];
    checks.at(figure["type"])(report, figure);
  }
  for (const char* tag : {"section", "table", "tr", "figure", "details", "ul", "p"}) {
    const std::string name = tag;
    EXPECT_EQ(all(page, "<(" + name + ")[ >]").size(), all(page, "</(" + name + ")>").size()) << tag;
  }
}

/// Expects that a figure shows `value`, rounded to a 32-bit float. NaN stays NaN.
void expect_shown(float shown, double value) {
  EXPECT_EQ(std::isnan(shown), std::isnan(value));
  if (!std::isnan(value)) {
    EXPECT_FLOAT_EQ(shown, static_cast<float>(value));
  }
}

/// Expects that the bars of a figure show these series ([responses x errors] each), in the figure's order of the
/// responses. member: name of the array in the figure's first quantity.
void expect_bars(const Json& page, const Json& figure, const char* member, const StoredResult& result,
                 const std::vector<std::span<const double>>& series) {
  const std::vector<float> shown = array(page, figure["quantities"][0][member]);
  const std::vector<std::string> order = figure["choices"][0]["options"];
  const std::size_t items = figure["items"].size();
  ASSERT_EQ(shown.size(), series.size() * order.size() * items);
  for (std::size_t s = 0; s < series.size(); ++s) {
    for (std::size_t k = 0; k < order.size(); ++k) {
      const std::size_t r = order[k] == result.responses[0].name ? 0 : 1;
      for (std::size_t p = 0; p < items; ++p) {
        expect_shown(shown[(s * order.size() + k) * items + p], series[s][r * items + p]);
      }
    }
  }
}

/// An identification of two errors at two sizes and four poses.
identification::Result identified() {
  identification::Result found;
  found.sizes = {{"small", 1e-4, 1e-3}, {"large", 1e-3, 1e-2}};
  found.poses = 4;
  found.rounding = 1e-14;
  found.required_poses = 4;
  found.single_below = {{2, 2}, {4, 0, 4, 1}};
  found.single_max = {{2, 2}, {1e-15, 1e-3, 5e-3, 1e-2}};
  found.not_solved = {{2, 2}, {0, 0, 0, 0}};
  found.coupled_below = {{2, 2}, {4, 4, 2, 4}};
  found.coupled_reduced = {{2, 2}, {0, 0, 2, 0}};
  found.single_by_group = {{2, 2}, {0, 1, 0, 1}};
  found.coupled_by_group = {{2, 2}, {0, 1, 0, 1}};
  found.single = {{2}, {0, 1}};
  found.coupled = {{2}, {0, 1}};
  return found;
}

class HtmlReport : public testing::Test {
 protected:
  ReportedResult stored() const { return {read_result(path), "r.h5"}; }
  ReportedResult sensitivity() const {
    example.write_sensitivity(path);
    return stored();
  }

  static std::string report(const ReportedResult& result) {
    return html_report(kind_of(result.stored).report, {&result, 1});
  }
  static std::string report(const ReportedResult& a, const ReportedResult& b) {
    const std::vector<ReportedResult> both{a, b};
    return html_report(kind_of(both[0].stored).report, both);
  }

  test::TempFolder folder;
  std::string path = folder / "r.h5";
  test::Example example;
};

TEST_F(HtmlReport, OfEveryKindIsWhole) {
  check_page(report(sensitivity()));
  example.write_evaluation(path, Pairing::every_pose_with_every_row);
  check_page(report(stored()));
  example.write_evaluation(path, Pairing::row_by_row);
  check_page(report(stored()));
  example.write_coupling(path);
  check_page(report(stored()));
  example.write_monte_carlo(path);
  check_page(report(stored()));
  example.write_allocation(path, example.allocation());
  check_page(report(stored()));
}

TEST_F(HtmlReport, OfAnIdentificationIsWhole) {
  ReportedResult result = sensitivity();
  result.stored.kind = "identification";
  result.stored.found = identified();
  const std::string html = report(result);
  check_page(html);
  const Json page = data(html);
  const Json& quantities = page["figures"]["deforming"]["quantities"];
  EXPECT_EQ(array(page, quantities[0]["value"]), (std::vector<float>{0.0F, 100.0F, 50.0F, 100.0F}));
  EXPECT_EQ(quantities.size(), 3u);
  EXPECT_EQ(array(page, quantities[1]["value"]), (std::vector<float>{0.0F, 0.0F, 50.0F, 0.0F}));
}

TEST_F(HtmlReport, OfAnIdentificationHasNoBarsThatAreAllOrNothing) {
  ReportedResult result = sensitivity();
  result.stored.kind = "identification";
  identification::Result found = identified();
  found.coupled_below = {{2, 2}, {4, 4, 0, 4}};
  found.coupled_reduced = {{2, 2}, {0, 0, 4, 0}};
  result.stored.found = found;
  const Json page = data(report(result));
  EXPECT_EQ(page["figures"]["deforming"]["quantities"].size(), 1u);
}

TEST_F(HtmlReport, OfATrajectoryHasCurvesOverTime) {
  ReportedResult result = sensitivity();
  result.stored.time = {0.0, 0.5, 1.0, 1.5};
  const std::string html = report(result);
  check_page(html);
  const Json page = data(html);
  EXPECT_EQ(array(page, page["figures"]["trajectory"]["x"]["value"]), (std::vector<float>{0.0F, 0.5F, 1.0F, 1.5F}));
}

TEST_F(HtmlReport, ShowsTheNumbersOfTheResult) {
  const ReportedResult result = sensitivity();
  const sensitivity::Result& found = sensitivity::sensitivity_of(result.stored);
  const Json page = data(report(result));
  const Json& ranking = page["figures"]["ranking"]["quantities"][0];
  const Json& heat = page["figures"]["heat"];
  const std::vector<std::string> order = page["figures"]["ranking"]["choices"][0]["options"];
  for (std::size_t shown = 0; shown < 2; ++shown) {
    const std::size_t r = order[shown] == result.stored.responses[0].name ? 0 : 1;
    EXPECT_EQ(heat["layers"][shown]["label"], "effect on " + result.stored.responses[r].name);
    const double unit = display(result.stored.responses[r]).si;
    const std::vector<float> local = array(page, heat["layers"][shown]["value"]);
    for (std::size_t p = 0; p < 2; ++p) {
      const double scale = result.stored.factor_sigma[p] / unit;
      const std::vector<float> global = array(page, ranking["value"]);
      expect_shown(global[shown * 2 + p], found.global_corrected(r, p) * scale);
      const std::size_t row = heat["rows"][0] == result.stored.factors[p].name ? 0 : 1;
      for (std::size_t m = 0; m < 4; ++m) expect_shown(local[row * 4 + m], found.local(r, p, m) * scale);
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> shown = array(page, page["figures"]["workspace"]["coordinates"][c]["value"]);
    const std::vector<double> column = result.stored.poses.column(c);
    const double unit = display(result.stored.pose_coordinates[c]).si;
    for (std::size_t m = 0; m < 4; ++m) EXPECT_FLOAT_EQ(shown[m], static_cast<float>(column[m] / unit));
  }
}

/// The histogram of the example's first response has one inner bin, from 1 to 2, because the next bin reaches the
/// largest value.
TEST_F(HtmlReport, DrawsTheHistogramOfAMonteCarloResultWithItsLimit) {
  example.write_monte_carlo(path);
  const ReportedResult result = stored();
  const double unit = display(result.stored.responses[0]).si;
  const std::string html = report(result);
  const Json page = data(html);
  const Json& figure = page["figures"]["distribution-0"];
  EXPECT_EQ(figure["x"]["label"], result.stored.responses[0].name);
  EXPECT_EQ(array(page, figure["x"]["value"]),
            (std::vector<float>{static_cast<float>(1.0 / unit), static_cast<float>(2.0 / unit)}));
  const std::vector<float> density = array(page, figure["panels"][0]["series"][0]["value"]);
  const std::vector<float> below = array(page, figure["panels"][1]["series"][0]["value"]);
  // The bin is 1 rad = 57.3 deg wide, but the label counts per 50 deg.
  EXPECT_EQ(figure["panels"][0]["label"], "share of the samples per 50 deg");
  EXPECT_EQ(figure["panels"][0]["unit"], "%");
  expect_shown(density.at(0), 100.0 * 200.0 / 382.0 * unit * 50.0);
  expect_shown(below.at(0), 100.0 * 100.0 / 382.0);
  expect_shown(below.at(1), 100.0 * 300.0 / 382.0);
  ASSERT_EQ(figure["marks"].size(), 1u);
  EXPECT_DOUBLE_EQ(figure["marks"][0]["value"].get<double>(), 0.5 / unit);
  EXPECT_NE(html.find("95.5 % of the draws are within the limit"), std::string::npos);
  EXPECT_NE(html.find("99.5 % quantile"), std::string::npos);
  EXPECT_NE(html.find("Are the limits kept"), std::string::npos);
  EXPECT_LT(html.find("Are the limits kept"), html.find("How large are the deviations"));
}

/// The share of the machines beyond the mark of the limit is then the share that the limit rejects.
TEST_F(HtmlReport, DrawsTheLargestOfMachinesThatALimitJudges) {
  example.write_machines(path);
  const ReportedResult result = stored();
  const std::string html = report(result);
  const Json page = data(html);
  const Json& figure = page["figures"]["distribution-1"];
  EXPECT_TRUE(figure["panels"][0]["label"].get<std::string>().starts_with("share of the machines per "));
  EXPECT_EQ(figure["panels"][1]["label"], "share of the machines below");
  EXPECT_EQ(figure["x"]["label"], "largest " + result.stored.responses[1].name + " over the poses");
  const monte_carlo::MachineValues& largest = monte_carlo::monte_carlo_of(result.stored).machines->largest;
  const std::vector<float> below = array(page, figure["panels"][1]["series"][0]["value"]);
  expect_shown(below.at(0), 100.0 * static_cast<double>(largest.histogram_counts(1, 0)) / 198.0);
  EXPECT_EQ(figure["marks"].size(), 1u);
  EXPECT_NE(html.find("75 % of the machines are within the limit at all poses"), std::string::npos);
  EXPECT_EQ(page["figures"]["distribution-0"]["panels"][1]["label"], "share of the samples below");  // has no limit
}

TEST_F(HtmlReport, DrawsSobolIndicesWithTheirIntervals) {
  example.write_sobol(path);
  const ReportedResult result = stored();
  const std::string html = report(result);
  check_page(html);
  const Json page = data(html);
  const Json& figure = page["figures"]["sobol"];
  EXPECT_EQ(figure["series"], Json({"ST, with interactions", "S1, alone"}));
  const auto& [conf_level, S1, ST] = sobol::sobol_of(result.stored).aggregated;
  expect_bars(page, figure, "value", result.stored, {ST.value.all(), S1.value.all()});
  expect_bars(page, figure, "low", result.stored, {ST.ci_low.all(), S1.ci_low.all()});
  expect_bars(page, figure, "high", result.stored, {ST.ci_high.all(), S1.ci_high.all()});
  EXPECT_FALSE(page["figures"].contains("shapley"));
}

TEST_F(HtmlReport, DrawsShapleyEffectsWithTheirIntervals) {
  example.write_sobol(path);
  ReportedResult result = stored();
  sobol::Result found = sobol::sobol_of(result.stored);
  found.Sh.value = {{2, 2}, {0.25, 0.75, 0.625, 0.375}};
  found.Sh.ci_low = {{2, 2}, {0.125, 0.5, 0.5, std::nan("")}};
  found.Sh.ci_high = {{2, 2}, {0.375, 1.0, 0.75, std::nan("")}};
  result.stored.found = found;
  const std::string html = report(result);
  check_page(html);
  const Json page = data(html);
  const Json& figure = page["figures"]["shapley"];
  EXPECT_EQ(figure["items"], Json(found.group_names));
  expect_bars(page, figure, "value", result.stored, {found.Sh.value.all()});
  expect_bars(page, figure, "low", result.stored, {found.Sh.ci_low.all()});
  expect_bars(page, figure, "high", result.stored, {found.Sh.ci_high.all()});
  EXPECT_NE(html.find("Shapley effect of each error"), std::string::npos);
}

/// Gives every response to every error the same values at the poses.
void fill_poses(sensitivity::Result::Cells<double>& cells, const std::vector<double>& at_poses) {
  for (const std::size_t r : {0U, 1U}) {
    for (const std::size_t p : {0U, 1U}) std::ranges::copy(at_poses, cells.row(r, p).begin());
  }
}

TEST_F(HtmlReport, PutsTheMostImportantErrorFirst) {
  ReportedResult result = sensitivity();
  StoredResult& stored = result.stored;
  stored.factor_sigma = {1.0, 1.0};
  sensitivity::Result& found = sensitivity_in(stored);
  found.global = found.global_corrected = sensitivity::Result::Indices({2, 2}, {0.1, 1.0, 0.1, 1.0});
  fill_poses(found.local, {1.0, 1.0, 1.0, 5.0});  // the last is the worst, 2.5 times the mean
  const std::string html = report(result);
  const Json page = data(html);
  const Json order{stored.factors[1].name, stored.factors[0].name};
  EXPECT_EQ(page["figures"]["heat"]["rows"], order);
  EXPECT_EQ(page["figures"]["workspace"]["fields"][0]["rows"], order);
  EXPECT_NE(html.find("is largest at pose 3 ("), std::string::npos);
  EXPECT_NE(html.find("2.5 times its mean over the poses"), std::string::npos);
}

TEST_F(HtmlReport, PutsPosesInTheOrderThatExplainsTheEffects) {
  ReportedResult result = sensitivity();
  StoredResult& stored = result.stored;
  stored.poses = PoseSet(3, {-0.2, 0.1, -0.6, -0.3, 0.3, 0.1, -0.1, -0.2, 0.4, -0.4, 0.5, -0.3});
  std::vector<double> grown;
  for (const double gamma : stored.poses.column(2)) grown.push_back(std::exp(std::abs(gamma)));
  fill_poses(sensitivity_in(stored).local, grown);
  const std::string html = report(result);
  EXPECT_EQ(data(html)["figures"]["heat"]["columns"]["order"], "|gamma|");
  EXPECT_NE(html.find("grows with |gamma|: their rank correlation over the poses is 1.00."), std::string::npos);
  for (double& value : sensitivity_in(stored).local) value = 1.0 / value;
  EXPECT_NE(report(result).find("falls with |gamma|"), std::string::npos);
  fill_poses(sensitivity_in(stored).local, {2.0, 3.0, 1.0, 2.5});
  EXPECT_EQ(report(result).find("with |gamma|:"), std::string::npos);
  stored.time = {0.0, 1.0, 2.0, 3.0};
  EXPECT_FALSE(data(report(result))["figures"]["heat"]["columns"].contains("order"));
}

/// Each of the 8 cells (errors x poses) has this number of solves, and one solve in all does not converge.
ReportedResult with_one_failure(ReportedResult result, std::uint64_t solves) {
  for (SolveCounts& cell : sensitivity_in(result.stored).solves) cell.by_status = {solves, 0, 0, 0, 0};
  sensitivity_in(result.stored).solves(1, 1).by_status = {solves - 1, 0, 1, 0, 0};
  return result;
}

TEST_F(HtmlReport, NamesAFewFailuresWhereTheyBelongAndDrawsNothing) {
  const std::string few = report(with_one_failure(sensitivity(), 1000));
  const std::size_t section = few.find("<section id=\"not-solved\"");
  const std::size_t line = few.find("1 of 8 000 solves (0.0125 %) did not converge.");
  EXPECT_LT(section, line);
  EXPECT_EQ(few.find("1 of 8 000 solves", line + 1), std::string::npos);
  EXPECT_FALSE(data(few)["figures"].contains("not-converged"));
  EXPECT_FALSE(data(few)["figures"].contains("not-converged-where"));
  EXPECT_NE(few.find("The largest shares: delta_1 0.025 %; pose 1 (z "), std::string::npos);
}

TEST_F(HtmlReport, WarnsOfManyFailuresAndDrawsThoseThatHaveSome) {
  const ReportedResult result = with_one_failure(sensitivity(), 100);
  const std::string many = report(result);
  EXPECT_LT(many.find("1 of 800 solves (0.125 %) did not converge."), many.find("<section id=\"what-is-measured\""));
  const Json page = data(many);
  EXPECT_EQ(page["figures"]["not-converged"]["items"], Json{result.stored.factors[1].name});
  EXPECT_NE(many.find("that did not converge; 1 more had none."), std::string::npos);
  EXPECT_TRUE(page["figures"].contains("not-converged-where"));
}

TEST_F(HtmlReport, HoldsToWhatTheStudyAllows) {
  ReportedResult result = with_one_failure(sensitivity(), 100);
  result.stored.study_text = "[solver]\nmax_not_converged = 0.01\n";
  EXPECT_FALSE(data(report(result))["figures"].contains("not-converged"));
  result = with_one_failure(sensitivity(), 1000);
  result.stored.study_text = "[solver]\nmax_not_converged = 0.0001\n";
  EXPECT_TRUE(data(report(result))["figures"].contains("not-converged"));
}

TEST_F(HtmlReport, SaysWhatItsNamesMean) {
  ReportedResult result = sensitivity();
  StoredResult& stored = result.stored;
  stored.factors[0].description = "tilt of the bolt";
  stored.responses[1].description = "how far <it> moves";
  const std::string html = report(result);
  check_page(html);
  EXPECT_NE(html.find("<dt>linear_deformation</dt><dd>How far &lt;it&gt; moves.</dd>"), std::string::npos);
  EXPECT_LT(html.find("<section id=\"what-is-measured\""), html.find("<section id=\"which-errors-matter\""));
  EXPECT_NE(html.find("<td>tilt of the bolt</td>"), std::string::npos);
  EXPECT_EQ(data(html)["about"]["epsilon_1"], "tilt of the bolt");
}

// The first error has the larger index, but the second has the larger mean square, which decides about limits.
TEST_F(HtmlReport, SaysWhichErrorsMakeTheMeanSquare) {
  ReportedResult result = sensitivity();
  StoredResult& stored = result.stored;
  stored.factor_sigma = {1.0, 1.0};
  sensitivity::Result& found = sensitivity_in(stored);
  found.global = {{2, 2}, {5.0, 4.0, 5.0, 4.0}};
  std::ranges::fill(found.background, 0.0);
  std::ranges::fill(found.std, 0.0);
  for (const std::size_t r : {0U, 1U}) {
    std::ranges::fill(found.mean.row(r, 0), 0.3);
    std::ranges::fill(found.mean.row(r, 1), 4.0);
  }
  const std::string html = report(result);
  const std::string response = default_ranking(stored);
  EXPECT_NE(html.find("1 of 2 errors makes 99 % of what the study&#39;s sizes add to the mean square of " + response +
                      " over samples and poses: " + stored.factors[1].name + ". 1 hardly matters (below 1 % together)"),
            std::string::npos);
  EXPECT_EQ(body(html).find("variance"), std::string::npos);  // the bundled scripts have the word
}

TEST_F(HtmlReport, CountsWhatTheSecondFidelityDidNotSolve) {
  ReportedResult result = sensitivity();
  StoredResult& stored = result.stored;
  sensitivity::FidelityResult& compared = sensitivity_in(stored).fidelity.emplace();
  compared.fidelities = {"one", "two"};
  for (auto* values :
       {&compared.global, &compared.discrepancy, &compared.relative_discrepancy, &compared.nonlinearity}) {
    *values = sensitivity::FidelityResult::Indices({2, 2});
  }
  compared.linear = {{2}, {1, 1}};
  compared.not_converged = {{2, 4}, {0, 0, 0, 0, 0, 7, 0, 0}};
  for (SolveCounts& solves : sensitivity_in(stored).solves) solves.by_status = {100, 0, 0, 0, 0};
  const std::string page = body(report(result));
  EXPECT_NE(page.find("All 800 solves at fidelity &quot;one&quot; converged."), std::string::npos);
  EXPECT_NE(page.find("At fidelity &quot;two&quot;, 7 of 800 solves did not converge:"), std::string::npos);
  EXPECT_NE(page.find("7 of 800 solves at fidelity &quot;two&quot; (0.875 %) did not converge."), std::string::npos);
}

TEST_F(HtmlReport, TakesRoundingForNoDifference) {
  const ReportedResult a = sensitivity();
  ReportedResult b = a;
  for (double& value : sensitivity_in(b.stored).global_corrected) value *= 1.0 + 1e-13;
  for (double& value : sensitivity_in(b.stored).local) value += 1e-12;
  const std::string html = report(a, b);
  const Json page = data(html);
  for (const float value : array(page, page["figures"]["heat"]["layers"][0]["value"])) {
    EXPECT_TRUE(value == 0.0F || std::isnan(value)) << value;
  }
  const std::size_t begin = html.find("<section id=\"differences\"");
  const std::string numbers = html.substr(begin, html.find("<section id=\"what-was-run\"") - begin);
  EXPECT_TRUE(all(numbers, "(e-1[0-9]( %)?)</td>").empty());
}

TEST_F(HtmlReport, OfTwoHasTheirRankingsBesideEachOther) {
  ReportedResult a = sensitivity();
  a.stored.factor_sigma = {1.0, 1.0};
  sensitivity_in(a.stored).global_corrected = {{2, 2}, {1.0, 2.0, 1.0, 2.0}};
  ReportedResult b = a;
  EXPECT_NE(body(report(a, b)).find("Kendall&#39;s tau of the two rankings is 1, over 2 errors"), std::string::npos);
  a.stored.metric = "published";
  b.stored.metric = "platform";
  sensitivity_in(b.stored).global_corrected = {{2, 2}, {2.0, 1.0, 2.0, 1.0}};
  const std::string page = body(report(a, b));
  check_page(report(a, b));
  EXPECT_NE(page.find("Kendall&#39;s tau of the two rankings is -1, over 2 errors"), std::string::npos);
  EXPECT_NE(page.find("; metric: published, radians against metres at the base&#39;s origin;"), std::string::npos);
  EXPECT_NE(page.find("Two metrics do not mean the same by them."), std::string::npos);
  ASSERT_FALSE(all(page, "<section id=\"(rankings)\"").empty());
}

TEST_F(HtmlReport, OfCoupledSourcesOpensAtTheLastSize) {
  example.write_coupling(path);
  const ReportedResult result = stored();
  const std::string label = data(report(result))["figures"]["sources"]["panels"][0]["label"];
  EXPECT_TRUE(label.ends_with(" at " + coupling::coupling_of(result.stored).size_names.back())) << label;
}

TEST_F(HtmlReport, HoldsTheHistoryOfItsIndices) {
  ReportedResult result = sensitivity();
  EstimateCourse history{
      {10, 100}, std::vector<double>(8, 0.5), std::vector<double>(8, 0.25), std::vector<double>(8, 1.0)};
  sensitivity_in(result.stored).history = history;
  std::ranges::fill(sensitivity_in(result.stored).global_corrected, 0.5);
  const std::string html = report(result);
  check_page(html);
  const Json page = data(html);
  const Json& lines = page["figures"]["convergence"];
  EXPECT_EQ(array(page, lines["x"]["value"]), (std::vector<float>{10.0F, 100.0F}));
  EXPECT_EQ(lines["panels"][0]["series"].size(), 2U);
}

TEST_F(HtmlReport, EscapesWhateverComesFromTheFile) {
  const std::string evil = "<script>alert(1)</script><!-- \" ' & \xFF";
  ReportedResult result = sensitivity();
  result.path = evil;
  StoredResult& stored = result.stored;
  for (std::string* text : {&stored.title, &stored.model, &stored.study_text, &stored.poesy_version, &stored.git_commit,
                            &stored.content_sha256, &stored.facts.created, &stored.facts.host, &stored.facts.cpu,
                            &stored.factors[0].name, &stored.responses[0].name, &stored.pose_coordinates[0].name,
                            &stored.factors[0].description, &stored.responses[0].description}) {
    *text = evil;
  }
  const std::string html = report(result);
  check_page(html);
  EXPECT_EQ(body(html).find("<script"), std::string::npos);
  EXPECT_EQ(body(html).find("<!--"), std::string::npos);
  EXPECT_EQ(html.find('\xFF'), std::string::npos);
  const std::string json = data(html).dump(-1, ' ', false, Json::error_handler_t::replace);
  EXPECT_NE(json.find("<script>alert(1)</script><!--"), std::string::npos);  // the JSON value is unchanged
  EXPECT_NE(html.find("&lt;script&gt;alert(1)&lt;/script&gt;&lt;!-- &quot; &#39; &amp; \xEF\xBF\xBD"),
            std::string::npos);
}

TEST_F(HtmlReport, WarnsOfWhatAReaderMustNotMiss) {
  ReportedResult result = sensitivity();
  result.stored.changed = true;
  result.stored.git_commit = "abc-dirty";
  std::ranges::fill(sensitivity_in(result.stored).count, 1);
  const std::string page = body(report(result));
  for (const char* text : {"was changed since it was written", "(abc-dirty)", "did not converge",
                           "That is more than 1 %", "fewer than two samples", "close to singular"}) {
    EXPECT_NE(page.find(text), std::string::npos) << text;
  }
}

TEST_F(HtmlReport, WarnsOfIndicesThatHoldAtNoOtherSize) {
  ReportedResult result = sensitivity();
  constexpr const char* kWarning = "Some indices say something about the size of the errors in this study and no other";
  EXPECT_EQ(body(report(result)).find(kWarning), std::string::npos);
  sensitivity_in(result.stored).index_change = {{2, 2}, {0.0, 0.0, -0.9, 0.0}};
  const std::string page = body(report(result));
  EXPECT_NE(page.find(kWarning), std::string::npos);
  EXPECT_NE(page.find("not for epsilon_1 (-90.0 %)"), std::string::npos);
}

TEST_F(HtmlReport, HasNoSectionOfWarningsWithoutAny) {
  ReportedResult result = sensitivity();
  StoredResult& stored = result.stored;
  stored.git_commit = "abc";
  stored.condition = {1.0, 1.0, 1.0, 1.0};
  sensitivity::Result& found = sensitivity_in(stored);
  std::ranges::fill(found.global, 1.0);
  found.global_corrected = found.global_corrected_ci_low = found.global_corrected_ci_high = found.global;
  for (SolveCounts& solves : found.solves) solves.by_status = {100, 0, 0, 0, 0};
  stored.failures.clear();
  EXPECT_EQ(body(report(result)).find("id=\"warnings\""), std::string::npos);
}

TEST_F(HtmlReport, ThinsPosesOfALargeResultAndSaysSo) {
  constexpr std::size_t kPoses = 400'000;
  ReportedResult result = sensitivity();
  StoredResult& stored = result.stored;
  sensitivity::Result& found = sensitivity_in(stored);
  for (auto* values : {&found.local, &found.local_ci_low, &found.local_ci_high, &found.mean, &found.std}) {
    *values = sensitivity::Result::Cells<double>({2, 2, kPoses}, 1.0);
  }
  found.count = sensitivity::Result::Cells<std::uint64_t>({2, 2, kPoses}, 1);
  found.background = Array<double, axis::Response, axis::Pose>({2, kPoses});
  found.solves = Array<SolveCounts, axis::Factor, axis::Pose>({2, kPoses});
  stored.poses = PoseSet(3, std::vector<double>(3 * kPoses, 0.5));
  stored.condition.assign(kPoses, 1.0);
  const std::string html = report(result);
  check_page(html);
  EXPECT_NE(html.find("of the 400 000 poses, evenly spread"), std::string::npos);
  EXPECT_LT(html.size(), 12'000'000U);
  const Json page = data(html);
  const std::vector<float> numbers = array(page, page["figures"]["heat"]["columns"]["numbers"]);
  EXPECT_LT(numbers.size(), kPoses / 2);
  EXPECT_EQ(numbers[0], 0.0F);
  EXPECT_GT(numbers.back(), 0.99 * kPoses);
  EXPECT_EQ(array(page, page["figures"]["workspace"]["numbers"]), numbers);
}

TEST_F(HtmlReport, OfTwoResultsShowsWhatDiffers) {
  const ReportedResult a = sensitivity();
  ReportedResult b = a;
  b.path = "b.h5";
  sensitivity_in(b.stored).global_corrected(0, 0) += 10.0;
  b.stored.factors[1].name = "another";
  const std::string html = report(a, b);
  check_page(html);
  const Json page = data(html);
  EXPECT_EQ(page["figures"]["side-by-side"]["items"], Json::array({a.stored.factors[0].name}));
  const std::vector<float> effects = array(page, page["figures"]["side-by-side"]["quantities"][0]["value"]);
  const double scale = a.stored.factor_sigma[0] / display(a.stored.responses[0]).si;
  const std::vector<std::string> responses = page["figures"]["side-by-side"]["choices"][0]["options"];
  const std::size_t r = responses[0] == a.stored.responses[0].name ? 0 : 1;
  EXPECT_FLOAT_EQ(effects[r], static_cast<float>(sensitivity::sensitivity_of(a.stored).global_corrected(0, 0) * scale));
  EXPECT_FLOAT_EQ(effects[2 + r],
                  static_cast<float>(sensitivity::sensitivity_of(b.stored).global_corrected(0, 0) * scale));
  EXPECT_NE(html.find("Only in B: another."), std::string::npos);
  for (const Json& layer : page["figures"]["heat"]["layers"]) EXPECT_TRUE(layer["signed"]);
}

/// The HTML of the table with this name. Empty if there is none.
std::string table(const std::string& html, const std::string& name) {
  const std::size_t begin = html.find("data-table=\"" + name + "\"");
  return begin == std::string::npos ? "" : html.substr(begin, html.find("</table>", begin) - begin);
}

TEST_F(HtmlReport, OfTwoResultsSaysFirstHowTheStudiesDiffer) {
  ReportedResult a = sensitivity();
  ReportedResult b = a;
  a.stored.study_text = "title = \"x\"\n[errors]\nlinear = { sigma = \"0.001 m\" }\n[run]\nseed = 1\n[[g]]\nk = 1\n";
  b.stored.study_text =
      "title = \"y\"\n[errors]\nlinear = { sigma = \"1e-05 m\" }\n[run]\nseed = 1\n[[g]]\nk = 2\nm = 3\n";
  b.stored.facts.host = "elsewhere";
  const std::string html = report(a, b);
  check_page(html);
  const auto sections = all(body(html), "<section id=\"([^\"]*)\"");
  const std::size_t first = html.find("id=\"warnings\"") == std::string::npos ? 1 : 2;
  EXPECT_EQ(sections.at(first), "which-is-better");
  EXPECT_EQ(sections.at(first + 1), "studies");
  const std::string rows = table(html, "settings");
  EXPECT_NE(rows.find("<th scope=\"row\">errors.linear</th><td>sigma = 1 mm</td><td>sigma = 0.01 mm</td>"),
            std::string::npos)
      << rows;
  EXPECT_NE(rows.find("<th scope=\"row\">g 1.k</th><td>1</td><td>2</td>"), std::string::npos) << rows;
  EXPECT_NE(rows.find("<th scope=\"row\">g 1.m</th><td>-</td><td>3</td>"), std::string::npos) << rows;
  EXPECT_EQ(rows.find("run.seed"), std::string::npos);
  EXPECT_NE(table(html, "settings_alike").find("run.seed"), std::string::npos);
  EXPECT_NE(table(html, "what_was_run").find("elsewhere"), std::string::npos);
  EXPECT_EQ(table(html, "what_was_run").find("threads"), std::string::npos);
  EXPECT_NE(table(html, "what_was_run_alike").find("threads"), std::string::npos);
  EXPECT_NE(report(a, a).find("The studies of A and B have the same settings."), std::string::npos);
}

TEST_F(HtmlReport, OfTwoResultsHasTheTotals) {
  ReportedResult a = sensitivity();
  sensitivity::Result& found = sensitivity_in(a.stored);
  std::ranges::fill(found.global, 1.0);  // every error is known to have an effect
  std::ranges::fill(found.count, 1000);
  std::ranges::fill(found.background, 0.0);
  std::ranges::fill(found.mean, 3e-3);
  std::ranges::fill(found.std, 4e-3);
  ReportedResult b = a;
  std::ranges::fill(sensitivity_in(b.stored).mean, 0.5e-3);
  std::ranges::fill(sensitivity_in(b.stored).std, 0.0);
  const std::string rows = table(report(a, b), "totals");
  // The root mean squares of two errors: sqrt(2 (3^2 + 4^2 999 / 1000)) = 7.069 mm in A, and sqrt(2) 0.5 mm in B.
  EXPECT_NE(rows.find("<th scope=\"row\">linear_deformation</th><td class=\"n\" style=\"--room:1\">7.069</td>"),
            std::string::npos)
      << rows;
  EXPECT_NE(rows.find(">0.7071</td><td>mm</td><td class=\"n\">0.1</td>"), std::string::npos) << rows;
}

TEST_F(HtmlReport, WarnsOfErrorsTooSmallToTell) {
  ReportedResult result = sensitivity();
  EXPECT_EQ(report(result).find("so small in this study"), std::string::npos);
  StoredResult& stored = result.stored;
  stored.factor_sigma[1] = 1e-12;
  for (const std::size_t r : {0U, 1U}) sensitivity_in(stored).global_corrected(r, 1) = std::nan("");
  EXPECT_NE(report(result).find("1 error is so small in this study that an effect cannot be told from the rounding of "
                                "the solves: " +
                                stored.factors[1].name + ". Study larger errors."),
            std::string::npos);
}

TEST_F(HtmlReport, OfTwoResultsOfEveryKindIsWhole) {
  check_page(report(sensitivity(), sensitivity()));
  example.write_evaluation(path, Pairing::every_pose_with_every_row);
  check_page(report(stored(), stored()));
  example.write_coupling(path);
  check_page(report(stored(), stored()));
  const ReportedResult coupling = stored();
  example.write_monte_carlo(path);
  check_page(report(stored(), stored()));
  EXPECT_THROW(report(stored(), coupling), InputError);
  example.write_allocation(path, example.allocation());
  check_page(report(stored(), stored()));
  EXPECT_THROW(report(stored(), coupling), InputError);
}

TEST_F(HtmlReport, RefusesResultsWithNothingInCommon) {
  const ReportedResult a = sensitivity();
  ReportedResult b = a;
  b.stored.kind = "sobol";
  EXPECT_THROW(report(a, b), InputError);
  b = a;
  b.stored.factors = {{"c", "m"}, {"d", "m"}};
  EXPECT_THROW(report(a, b), InputError);
  b = a;
  b.stored.responses = {{"c", "m"}, {"d", "m"}};
  EXPECT_THROW(report(a, b), InputError);
}

}  // namespace
}  // namespace poesy
