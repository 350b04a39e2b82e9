#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/monte_carlo/kind.h"
#include "engine/kinds/monte_carlo/result.h"
#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "tests/engine/kinds/stored.h"

namespace poesy::monte_carlo {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

StoredResult example() {
  StoredResult result;
  result.kind = "monte-carlo";
  result.factors = {{"delta_1", "m"}, {"epsilon_1", "rad"}};
  result.responses = {{"linear_deformation", "m"}, {"ratio", "1"}};
  result.headline = {0, 1};
  Result& found = monte_carlo_in(result);
  found.quantile_relative_error = 1.0 / 512.0;
  found.levels = {0.5, 0.95};
  found.mean = {{2, 3}, {1e-3, 4e-3, 1e-3, 0.5, 0.25, 0.75}};
  found.quantiles = {{2, 3, 2}, {1e-3, 9e-3, 4e-3, 8e-3, 1e-3, 7e-3, 0.5, 1.0, 0.25, 2.0, 0.75, 1.5}};
  found.overall_mean = {{2}, {2e-3, 0.5}};
  found.overall_std = {{2}, {1.5e-3, 0.125}};
  found.overall_rms = {{2}, {2.5e-3, 0.5}};
  found.conf_level = 0.95;
  found.quantiles_ci_low = {{2, 3, 2}, {1e-3, 6e-3, 3e-3, 7e-3, 1e-3, 5e-3, 0.5, 0.9, 0.25, 1.75, 0.75, 1.25}};
  found.quantiles_ci_high = {{2, 3, 2}, {2e-3, 12e-3, 5e-3, 9e-3, 2e-3, 6e-3, 0.75, 1.5, 0.5, kInfinity, 1.0, 1.75}};
  found.overall_count = {{2}, {36000, 2}};
  found.overall_min = {{2}, {1e-6, 0.0625}};
  found.overall_max = {{2}, {1.25e-2, 3.0}};
  found.overall_quantiles = {{2, 2}, {1.75e-3, 8.5e-3, 0.4375, 1.25}};
  found.effects.s1_poses = {0, 1, 2};
  found.effects.effects.s1 = {{2, 2}, {0.25, 0.625, 0.5, 0.125}};
  found.effects.effects.s1_ci_low = {{2, 2}, {0.125, 0.5, 0.375, 0.0}};
  found.effects.effects.s1_ci_high = {{2, 2}, {0.375, 0.75, 0.625, 0.25}};
  found.solves.resize(3);
  for (SolveCounts& solves : found.solves) solves.by_status[0] = 12000;
  return result;
}

TEST(MonteCarloTable, ShowsAllPosesTogetherAndTheWorst) {
  EXPECT_EQ(text_of(result_tables(example(), "linear_deformation"), kUnlimitedWidth),
            "2 errors vary together: responses over the samples of all 3 poses\n"
            "response            unit  mean    std  rms     min   q_0.5  q_0.95   max\n"
            "linear_deformation  mm     2    1.5    2.5  0.001   1.75      8.5   12.5\n"
            "ratio               1      0.5  0.125  0.5  0.0625  0.4375    1.25   3\n"
            "12 000 samples at each pose; std: standard deviation; rms: root mean square; q_0.95: 95 % of the\n"
            "samples lie below it (quantiles to 0.195 % of their value)\n"
            "\n"
            "Pose by pose: the mean of the poses' means, and the worst poses\n"
            "                          mean of  largest    at  largest    at                poses\n"
            "response            unit    means     mean  pose   q_0.95  pose   low  high  like it\n"
            "linear_deformation  mm        2       4        1        9     0  6       12        1\n"
            "ratio               1         0.5     0.75     2        2     1  1.75   inf        0\n"
            "low, high: 95 % interval of the largest q_0.95, from order statistics; inf: too few samples for an\n"
            "end; poses like it: other poses whose interval reaches above low\n"
            "linear_deformation: the largest q_0.95 is at pose 0, but its samples do not tell it from pose 1\n"
            "\n"
            "First-order indices S1: the part of a response's variance that an error makes alone\n"
            "error      linear_deformation    low   high  ratio    low   high\n"
            "epsilon_1               0.625  0.5    0.75   0.125  0      0.25\n"
            "delta_1                 0.25   0.125  0.375  0.5    0.375  0.625\n"
            "added up over 3 poses; low, high: 95 % interval\n"
            "linear_deformation: the indices sum to 0.875; what is missing from 1 is what errors do together. A\n"
            "response without sign makes such interaction of its own, so an error with a small index is not one\n"
            "without effect\n");
}

TEST(MonteCarloTable, SaysHowGoodItsQuantilesAre) {
  StoredResult result = example();
  Result& found = monte_carlo_in(result);
  found.overall_quantile_error = {{2}, {1.5e-6, 0.125 / 512.0}};
  EXPECT_NE(text_of(result_tables(result, "linear_deformation"), kUnlimitedWidth).find("(quantiles to 0.195 % of std)"),
            std::string::npos);
  found.overall_quantile_error = {{2}, {0.0, 0.0}};
  EXPECT_NE(text_of(result_tables(result, "linear_deformation"), kUnlimitedWidth)
                .find("(quantiles are those of the samples)"),
            std::string::npos);
}

TEST(MonteCarloTable, NamesSomeOfManyPosesLikeTheWorstByCoordinates) {
  StoredResult result = example();
  constexpr std::size_t kPoses = 10;
  Result& found = monte_carlo_in(result);
  found.solves.resize(kPoses);
  found.levels = {0.95};
  std::vector<double> coordinates;
  make_room({1, kPoses, 1}, found.quantiles);
  for (std::size_t m = 0; m < kPoses; ++m) {
    coordinates.push_back(-0.19 + 0.001 * static_cast<double>(m));
    found.quantiles(0, m, 0) = 1.0 + static_cast<double>(m);
  }
  result.pose_coordinates = {{"z", "m"}};
  result.poses = PoseSet(1, coordinates);
  found.quantiles_ci_low = Result::QuantilesAtPoses({1, kPoses, 1}, 1.5);
  found.quantiles_ci_high = Result::QuantilesAtPoses({1, kPoses, 1}, 12.0);
  found.quantiles_ci_high(0, 0, 0) = 1.5;  // ends where the interval of the largest begins
  result.headline = {0};
  found.mean = Result::AtPoses({1, kPoses}, 1.0);
  const Table table = monte_carlo_tables(result).at(1);
  EXPECT_EQ(table.rows[0].back().text, "8");
  EXPECT_EQ(table.notes.at(1),
            "linear_deformation: the largest q_0.95 is at pose 9 (z -181 mm), but its samples do not tell it from pose "
            "8 (z -182 mm), pose 7 (z -183 mm), pose 6 (z -184 mm), pose 5 (z -185 mm), pose 4 (z -186 mm) "
            "and 3 others");
}

TEST(LimitsTable, SaysPassOrFailWithBothNumbers) {
  StoredResult result = example();
  EXPECT_FALSE(limits_table(result));
  result.verdicts = LimitVerdicts{
      .judge = Judge::rms,
      .share = 0.0,
      .limits = {{.response = 0, .limit = 3e-5, .value = 0.0155, .passed = false, .tried = 1000, .within = 21},
                 {.response = 1, .limit = 2.0, .value = 0.5, .passed = true, .tried = 1000, .within = 999}}};
  EXPECT_EQ(text_of(limits_table(result).value(), kUnlimitedWidth),
            "FAIL by root mean square: 1 of 2 limits not kept\n"
            "limit                            judged\n"
            "kept   response            unit  by      value  limit  within  where\n"
            "                                                          [%]\n"
            "FAIL   linear_deformation  mm    rms      15.5   0.03     2.1  -\n"
            "PASS   ratio               1     rms       0.5   2       99.9  -\n"
            "rms: the root mean square over the draws of all poses; draws that were not solved are left out;\n"
            "within: the share of all draws that are within the limit\n");
}

/// The caption states the judge (here rms) first and adds the share of samples beyond the limit, because an rms within
/// the limit does not mean that all samples are.
TEST(LimitsTable, SaysFirstWhatIsJudgedAndHowManySamplesAreBeyond) {
  StoredResult result = example();
  LimitVerdict one{.response = 0, .limit = 3e-5, .value = 2e-5, .passed = true, .tried = 1000, .within = 906};
  result.verdicts = LimitVerdicts{.judge = Judge::rms, .limits = {one}};
  EXPECT_EQ(limits_table(result)->caption,
            "PASS by root mean square: the limit is kept; 9.4 % of the samples are not within it");
  EXPECT_EQ(
      limits_text(result),
      "linear_deformation keeps its limit of 0.03 mm by root mean square with 0.02 mm; 9.4 % of the samples are not "
      "within it.");
  one.within = one.tried;
  result.verdicts = LimitVerdicts{.judge = Judge::share, .share = 0.95, .limits = {one}};
  EXPECT_EQ(limits_table(result)->caption,
            "PASS by 95 % of the draws at the worst pose: the limit is kept; all samples are within it");
}

/// Estimates are shown with four digits, but with six if four digits would look like the limit. The cell keeps the full
/// value.
TEST(LimitsTable, HasTheDigitsThatTellAValueFromItsLimit) {
  StoredResult result = example();
  const auto cell = [&](double value, const ValueLimit& limit) {
    result.verdicts = LimitVerdicts{
        .judge = Judge::rms,
        .share = 0.0,
        .limits = {{.response = 0, .limit = limit, .value = value, .passed = true, .tried = 9, .within = 9}}};
    const Cell shown = limits_table(result)->rows[0][4];
    EXPECT_EQ(shown.value, value / 1e-3);
    return shown.text;
  };
  EXPECT_EQ(cell(4.97177e-5, ValueLimit(6e-5)), "0.04972");
  EXPECT_EQ(cell(5.00012e-5, ValueLimit(5e-5)), "0.0500012");
  EXPECT_EQ(cell(-2.00003e-5, ValueLimit::between(-2e-5, 1e-4)), "-0.0200003");
}

TEST(LimitsTable, NamesTheWorstPlace) {
  StoredResult result = example();
  result.verdicts = LimitVerdicts{
      .judge = Judge::share,
      .share = 0.9973,
      .limits = {
          {.response = 0, .limit = 1e-3, .value = kInfinity, .passed = false, .tried = 10, .within = 4, .pose = 2}}};
  const Table share = limits_table(result).value();
  EXPECT_EQ(share.rows[0][3].text, "99.73 % of draws");
  EXPECT_EQ(share.rows[0][4].text, "inf");
  EXPECT_EQ(share.rows[0][7].text, "pose 2");
  result.row_names = {"sample 0", "sample 1"};
  result.verdicts = LimitVerdicts{
      .limits = {
          {.response = 0, .limit = 1e-3, .value = 5e-4, .passed = true, .tried = 2, .within = 2, .pose = 1, .row = 1}}};
  EXPECT_EQ(limits_table(result)->rows[0][7].text, "sample 1, pose 1");
  EXPECT_EQ(limits_table(result)->caption, "PASS: the limit is kept");
  result.row_names = {"small", "large"};
  EXPECT_EQ(limits_table(result)->rows[0][7].text, "large, pose 1");
}

TEST(PercentText, KeepsWhatIsMissingFromAHundred) {
  for (const auto& [share, text] : std::vector<std::pair<double, std::string>>{{0.9973, "99.73 %"},
                                                                               {0.99865, "99.865 %"},
                                                                               {0.95, "95 %"},
                                                                               {0.999999, "99.9999 %"},
                                                                               {0.5, "50 %"},
                                                                               {0.876543, "87.7 %"},
                                                                               {0.0125, "1.25 %"},
                                                                               {1.0, "100 %"},
                                                                               {0.0, "0 %"}}) {
    EXPECT_EQ(percent_text(share), text);
  }
}

TEST(MonteCarloTable, NamesTheWorstOfThePosesThatAreKnown) {
  StoredResult result = example();
  monte_carlo_in(result).mean(0, 0) = std::numeric_limits<double>::quiet_NaN();
  const Table poses = monte_carlo_tables(result).at(1);
  EXPECT_EQ(poses.rows[0][2].text, "-");
  EXPECT_FALSE(poses.rows[0][2].value);
  EXPECT_EQ(poses.rows[0][4].text, "1");
}

TEST(MonteCarloTable, ShowsTheHeadlineAlone) {
  StoredResult result = example();
  result.headline = {1};
  const std::vector<Table> tables = monte_carlo_tables(result);
  ASSERT_EQ(tables.size(), 3U);
  for (const Table& table : std::span(tables).first(2)) {
    ASSERT_EQ(table.rows.size(), 1U);
    EXPECT_EQ(table.rows[0][0].text, "ratio");
  }
  ASSERT_EQ(tables[2].columns.size(), 4U);  // the error, its index and the two ends of the interval
  EXPECT_EQ(tables[2].columns[1].name, "S1_ratio");
}

/// A result of machines with five errors and limits on both responses.
StoredResult example_of_machines() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  StoredResult result = example();
  result.factors = {{"delta_1", "m"}, {"epsilon_1", "rad"}, {"delta_2", "m"}, {"delta_3", "m"}, {"delta_4", "m"}};
  result.factor_sigma.assign(5, 1e-3);
  Result& found = monte_carlo_in(result);
  for (auto* list : {&found.effects.effects.s1, &found.effects.effects.s1_ci_low, &found.effects.effects.s1_ci_high}) {
    *list = MainEffects::Indices({2, 5}, 0.1);
  }
  MachineResult& machines = found.machines.emplace();
  for (MachineValues* values : {&machines.largest, &machines.rms}) {
    values->mean = values->max = {{2}, {1e-3, 0.5}};
    values->quantiles = MachineValues::Quantiles({2, 2}, 1e-3);
  }
  YieldResult& yield = machines.yield.emplace();
  yield.value = 0.75;
  yield.rejects = 50;
  yield.machines = 200;
  yield.by_response = {{2}, {0.8, 0.9}};
  make_room({2, 3}, yield.worst_pose_share);
  yield.gradient = {{5}, {-10.0, -200.0, 1.0, -2.0, kNone}};
  yield.change = {{5}, {-0.01, -0.2, 0.001, -0.002, kNone}};
  yield.change_ci_low = {{5}, {-0.015, -0.25, -0.001, -0.004, kNone}};
  yield.change_ci_high = {{5}, {-0.005, -0.15, 0.003, 0.0001, kNone}};
  yield.mean_square_share = {{2, 5}, {0.1, 0.7, 0.05, 0.125, kNone, 0.5, 0.25, 0.125, 0.125, kNone}};
  yield.mean_square_share_ci_low = yield.mean_square_share;
  yield.mean_square_share_ci_high = yield.mean_square_share;
  yield.linear_share = {{2}, {0.975, 0.5}};
  return result;
}

TEST(MonteCarloTable, ShowsFirstWhatMakesTheLimitedResponse) {
  const std::vector<Table> tables = monte_carlo_tables(example_of_machines());
  ASSERT_GT(tables.size(), 2U);
  EXPECT_EQ(tables[0].caption,
            "Which errors a limit is up against: shares of the scatter of linear_deformation, to first order");
  std::vector<std::string> shown;
  for (const std::vector<Cell>& row : tables[0].rows) shown.push_back(row[0].text + " " + row[1].text);
  EXPECT_EQ(shown, (std::vector<std::string>{"epsilon_1 70", "delta_3 12.5", "delta_1 10", "delta_2 5",
                                             "1 correlated error together 0", "delta_4 -"}));
  EXPECT_EQ(tables[0].columns[4].name, "share_ratio");
  EXPECT_EQ(tables[0].notes[1],
            "together: delta_4; correlated errors have no shares of their own, and where some are correlated, shares "
            "have no intervals");
  EXPECT_EQ(tables[0].notes[2], "linear_deformation: 97.5 % of its scatter is linear in the errors");
  EXPECT_EQ(
      tables[0].notes[3],
      "ratio: 50 % of its scatter is linear in the errors; the rest belongs to no error alone, so these shares say "
      "little");
}

TEST(MonteCarloTable, DoesNotTestItsLinearityToFirstOrder) {
  StoredResult result = example_of_machines();
  result.study_text = "[mechanism]\nfidelity = \"first-order\"\n";
  const std::vector<std::string> notes = monte_carlo_tables(result)[0].notes;
  EXPECT_EQ(
      notes[2],
      "linear_deformation: solved to first order in the errors, so it is not tested whether its scatter is linear "
      "in them");
  EXPECT_NE(notes[3].find("ratio: 50 % of its scatter is linear"), std::string::npos);
}

TEST(MonteCarloTable, StatesTheMeanThatIsInNoShare) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.offset = {{2}, {25e-6, 0.5}};
  yield.offset_share = {{2}, {0.42, 0.0009}};
  const std::vector<std::string> notes = monte_carlo_tables(result)[0].notes;
  ASSERT_EQ(notes.size(), 5U);  // no note on the second response, whose mean is negligible
  EXPECT_EQ(notes[3],
            "linear_deformation: not in these shares is its mean over the machines, 0.025 mm as a root mean square "
            "over the poses: 42 % of the whole mean square. Background and means of all errors make it together, with "
            "their signs; tighter tolerances leave it as it is");
}

/// The share of correlated errors together is what is linear in the errors, less the shares of the others.
TEST(MonteCarloTable, RanksCorrelatedErrorsTogether) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.mean_square_share = {{2, 5}, {0.125, 0.25, 0.0625, kNaN, kNaN, 0.5, 0.0, 0.25, kNaN, kNaN}};
  yield.linear_share = {{2}, {0.9375, 1.0}};
  const Table table = monte_carlo_tables(result)[0];
  std::vector<std::string> shown;
  for (const std::vector<Cell>& row : table.rows) shown.push_back(row[0].text + " " + row[1].text + " " + row[4].text);
  EXPECT_EQ(shown, (std::vector<std::string>{"2 correlated errors together 50 25", "epsilon_1 25 0", "delta_1 12.5 50",
                                             "delta_2 6.25 25", "delta_3 - -", "delta_4 - -"}));
  EXPECT_EQ(table.notes[1],
            "together: delta_3, delta_4; correlated errors have no shares of their own, and where some are correlated, "
            "shares have no intervals");
}

/// What is advised at the top of the report of the example.
std::string advice_of(const StoredResult& result) {
  const Answer lines = monte_carlo::kReport.answer(result);
  return std::ranges::find(lines, "What to do", &Answer::value_type::first)->second;
}

/// The correlated errors belong to delta_*, which has other errors too, so that delta_* as a whole is compared.
TEST(MonteCarloAdvice, AddsCorrelatedErrorsToTheirFeature) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.mean_square_share = {{2, 5}, {0.125, 0.25, 0.0625, kNaN, kNaN, 0.5, 0.0, 0.25, kNaN, kNaN}};
  yield.linear_share = {{2}, {0.9375, 1.0}};
  EXPECT_NE(advice_of(result).find("Make smaller first what adds most to the scatter of linear_deformation: delta_* "
                                   "(68.8 %, correlated errors included), epsilon_1 (25 %)."),
            std::string::npos)
      << advice_of(result);
}

TEST(MonteCarloAdvice, NamesCorrelatedErrorsOfSeveralFeaturesApart) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.mean_square_share = {{2, 5}, {0.125, kNaN, 0.0625, 0.125, kNaN, 0.5, kNaN, 0.25, 0.125, kNaN}};
  yield.linear_share = {{2}, {0.9375, 1.0}};
  EXPECT_NE(advice_of(result).find("Make smaller first what adds most to the scatter of linear_deformation: the "
                                   "correlated errors epsilon_1, delta_4 together (62.5 %), the rest of delta_* "
                                   "(31.2 %)."),
            std::string::npos)
      << advice_of(result);
}

TEST(MonteCarloAdvice, NamesTheErrorsOfACorrelatedFeature) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.mean_square_share = {{2, 5}, {kNaN, 0.25, kNaN, kNaN, kNaN, kNaN, 0.25, kNaN, kNaN, kNaN}};
  yield.linear_share = {{2}, {0.9375, 1.0}};
  EXPECT_NE(advice_of(result).find("Make smaller first what adds most to the scatter of linear_deformation: the "
                                   "correlated errors delta_1, delta_2 and 2 more together (68.8 %), epsilon_1 "
                                   "(25 %)."),
            std::string::npos)
      << advice_of(result);
}

TEST(MonteCarloAdvice, IsToRemoveAMeanThatAddsATenthOrMoreThanAnyError) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.offset = {{2}, {25e-6, 0.5}};
  const auto begins_with_mean = [&](double share) {
    yield.offset_share = {{2}, {share, 0.0}};
    return advice_of(result).find("Remove first") != std::string::npos;
  };
  EXPECT_FALSE(begins_with_mean(0.09)) << advice_of(result);
  EXPECT_TRUE(begins_with_mean(0.11)) << advice_of(result);
  EXPECT_NE(advice_of(result).find("Remove first the mean of linear_deformation over the machines, 0.025 mm as a root "
                                   "mean square: it makes 11 % of the mean square"),
            std::string::npos)
      << advice_of(result);
  EXPECT_NE(advice_of(result).find("Make smaller then what adds most"), std::string::npos) << advice_of(result);
  // Below a tenth, it is more than any error where many errors make little.
  yield.mean_square_share = {{2, 5}, {0.05, 0.05, 0.05, 0.05, 0.05, 0.5, 0.25, 0.125, 0.125, kNaN}};
  EXPECT_TRUE(begins_with_mean(0.06)) << advice_of(result);
  EXPECT_FALSE(begins_with_mean(0.04)) << advice_of(result);
}

TEST(MonteCarloTable, PutsWhatIsNotCertainIntoOneLine) {
  const StoredResult result = example_of_machines();
  Table table = monte_carlo_tables(result)[1];
  EXPECT_EQ(table.name, "yield_gradient");
  table.notes.clear();
  EXPECT_EQ(text_of(table, kUnlimitedWidth),
            "What the yield changes by if the sigma of one error grows by 10 %\n"
            "                                                                             share of\n"
            "error                                           yield    low   high   slope   scatter\n"
            "                                                  [%]    [%]    [%]               [%]\n"
            "epsilon_1                                         -20  -25    -15    -3.491        70\n"
            "delta_1                                            -1   -1.5   -0.5  -0.01         50\n"
            "2 errors whose effects are not certain              -      -      -       -         -\n"
            "1 error of which these machines do not tell it      -      -      -       -         -\n");
}

TEST(MonteCarloTable, SaysThatFewRejectsTellLittle) {
  StoredResult result = example_of_machines();
  const auto says = [&](std::uint64_t rejects) {
    monte_carlo_in(result).machines->yield->rejects = rejects;
    const Table table = monte_carlo_tables(result)[1];
    return std::ranges::any_of(table.notes,
                               [](const std::string& note) { return note.find(" are few: ") != std::string::npos; });
  };
  EXPECT_TRUE(says(5));
  EXPECT_TRUE(says(19));
  EXPECT_FALSE(says(20));
}

TEST(MonteCarloTable, ShowsNoEffectThatIsChanceAmongMany) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.change_ci_high = {{5}, {-0.0005, -0.15, 0.003, 0.0001, yield.change(4)}};  // delta_1: certain alone
  yield.change_ci_low = {{5}, {-0.0195, -0.25, -0.001, -0.004, yield.change(4)}};
  const Table table = monte_carlo_tables(result)[1];
  EXPECT_EQ(table.rows[0][0].text, "epsilon_1");
  EXPECT_EQ(table.rows[1][0].text, "3 errors whose effects are not certain");
  EXPECT_EQ(
      table.notes[1],
      "shown are errors whose effect is certain at 95 % for all 4 together (Holm 1979): of so many intervals some "
      "exclude zero by chance");
  EXPECT_EQ(
      table.notes[2],
      "rows are listed because their interval excludes zero, the largest loss first, errors whose share may be zero "
      "last; of many uncertain effects those that are listed are overestimated as a rule, so compare a change with "
      "the share of the scatter");
  EXPECT_EQ(table.notes[3], "share of scatter: the largest of the shares of the scatter of linear_deformation, ratio");
}

/// An error without a share of the scatter is not listed, even if the interval of its effect excludes zero.
TEST(MonteCarloTable, ShowsNoEffectOfAnErrorWithoutAShare) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.mean_square_share(0, 1) = yield.mean_square_share(1, 1) = 0.0;
  const Table table = monte_carlo_tables(result)[1];
  EXPECT_EQ(table.rows[0][0].text, "delta_1");
  EXPECT_EQ(table.rows[1][0].text, "3 errors whose effects are not certain");
  // Errors whose share may be zero are listed last.
  yield.mean_square_share(0, 1) = 0.001;
  yield.mean_square_share_ci_low(0, 1) = yield.mean_square_share_ci_low(1, 1) = 0.0;
  const Table other = monte_carlo_tables(result)[1];
  EXPECT_EQ(other.rows[0][0].text, "delta_1");
  EXPECT_EQ(other.rows[1][0].text, "epsilon_1");
}

/// Files of version 0.2 have only the gradient, so the table shows the change for 10 % of the standard deviation.
TEST(MonteCarloTable, TakesAPartOfTheSlopeWhereAFileHasNoChange) {
  StoredResult result = example_of_machines();
  YieldResult& yield = *monte_carlo_in(result).machines->yield;
  yield.change = yield.change_ci_low = yield.change_ci_high = {};
  yield.mean_square_share = yield.mean_square_share_ci_low = yield.mean_square_share_ci_high = {};
  yield.linear_share = {};
  yield.gradient_ci_low = {{5}, {-15.0, -9000.0, -1.0, -4.0, yield.gradient(4)}};
  yield.gradient_ci_high = {{5}, {-5.0, -150.0, 3.0, 0.1, yield.gradient(4)}};
  const Table table = monte_carlo_tables(result).front();
  ASSERT_EQ(table.name, "yield_gradient");
  EXPECT_NEAR(table.rows[0][1].value.value(), -2.0, 1e-12);
  EXPECT_EQ(table.rows[0][2].value.value(), -75.0);  // at most the whole yield
  EXPECT_EQ(table.rows[2][0].text, "2 errors whose effects are not certain");
}

TEST(DefaultRanking, IsTheFirstLengthOfTheHeadline) {
  StoredResult result = example();
  result.responses = {{"x", "m"}, {"rotation", "rad"}, {"position", "m"}};
  result.headline = {1, 2};
  EXPECT_EQ(default_ranking(result), "position");
  result.headline = {1};
  EXPECT_EQ(default_ranking(result), "rotation");
}

TEST(SummaryText, ShowsNoControlCharacterOfATitle) {
  StoredResult result = example();
  result.title = "\x1b[31mred\x07";
  EXPECT_TRUE(summary_text(result, tally_of(result), kUnlimitedWidth).starts_with("?[31mred?\n"));
}

TEST(MonteCarloTable, CountsOnePoseAsOne) {
  StoredResult result = example();
  result.factors.resize(1);
  monte_carlo_in(result).solves.resize(1);
  EXPECT_EQ(monte_carlo_tables(result).at(0).caption, "1 error varies together: responses over the samples of 1 pose");
}

TEST(FailuresText, CountsTheSolvesOfAllPosesOnce) {
  StoredResult result = example();
  monte_carlo_in(result).solves[2].by_status[2] = 360;
  EXPECT_EQ(failures_text(result, tally_of(result), "r.h5", kUnlimitedWidth),
            "360 of 36 360 solves (0.99 %) did not converge\n");
  result.varied = {std::string(kAllFactors)};
  result.failures = {{0, PoseIndex{2}, {SampleIndex{7}, SolveStatus::iteration_cap}}};
  EXPECT_EQ(failures_text(result, tally_of(result), "my r.h5", 80),
            "360 of 36 360 solves (0.99 %) did not converge\n"
            "the first of them (error, pose, sample): all 2 7, iteration_cap; failures.csv of\n"
            "'poesy export' lists 1 of the 360 (at most 10 of each pose, and 1 000 in all)\n"
            "replay it: poesy replay 'my r.h5' all 2 7\n");
}

/// The default is a response that is a length, unless it is constant and another response varies.
TEST(DefaultRanking, IsByWhatVaries) {
  StoredResult result = example();
  EXPECT_EQ(default_ranking(result), "linear_deformation");
  result.constant = {0};
  EXPECT_EQ(default_ranking(result), "ratio");
  EXPECT_EQ(varying_first(result, {0, 1}), (std::vector<std::size_t>{1, 0}));
  result.constant = {0, 1};
  EXPECT_EQ(default_ranking(result), "linear_deformation") << "none varies";
}

/// The notes below the table of first-order indices.
std::string notes_of_indices(const StoredResult& result) {
  std::string text;
  for (const Table& table : result_tables(result, default_ranking(result))) {
    if (table.name != "first_order") continue;
    for (const std::string& note : table.notes) text += note + "\n";
  }
  return text;
}

TEST(NoIndices, HaveTheirTrueReason) {
  StoredResult result = example();
  result.headline = {0};
  Result& found = monte_carlo_in(result);
  found.count = {{2, 3}, {63, 100, 100, 100, 100, 100}};
  std::ranges::fill(found.effects.effects.s1, std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(notes_of_indices(result).find("no S1 is formed below 64 samples"), std::string::npos);
  found.count(0, 0) = 100;
  result.study_text = "[analysis]\n\n[[errors.correlated]]\n";
  EXPECT_NE(notes_of_indices(result).find("each is correlated or drawn with others"), std::string::npos);
  result.constant = {0};
  EXPECT_NE(notes_of_indices(result).find("linear_deformation does not vary"), std::string::npos);
}

TEST(FailuresText, TellsWhatCannotBeAssembledFromWhatDidNotConverge) {
  StoredResult result = example();
  SolveCounts& solves = monte_carlo_in(result).solves[2];
  const auto text = [&] { return failures_text(result, tally_of(result), "r.h5", kUnlimitedWidth); };
  solves.by_status[5] = 360;
  EXPECT_EQ(text(), "360 of 36 360 solves (0.99 %) found no solution, because the machine cannot be assembled\n");
  EXPECT_EQ(unsolved_in_short(solves), "0 not converged, 360 cannot be assembled");
  solves.by_status[5] = 300;
  solves.by_status[2] = 60;
  EXPECT_EQ(text(),
            "360 of 36 360 solves (0.99 %) found no solution, 300 of them because the machine cannot be assembled\n");
  EXPECT_EQ(unsolved_in_short(solves), "60 not converged, 300 cannot be assembled");
  const std::string told = unsolved_text(result, tally_of(result));
  EXPECT_NE(told.find(kAssemblyAdvice), std::string::npos) << told;
  EXPECT_EQ(told.find("unfinished iterates"), std::string::npos) << told;
}

}  // namespace
}  // namespace poesy::monte_carlo
