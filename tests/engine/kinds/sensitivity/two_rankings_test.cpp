#include "engine/kinds/sensitivity/ranking.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/base/error.h"
#include "engine/report/display.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "tests/engine/kinds/sensitivity/ranked_result.h"

namespace poesy::sensitivity {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// ranked_result() with these effects (m) of its errors on the first response.
StoredResult with_effects(const std::vector<double>& effects) {
  StoredResult result = ranked_result();
  result.factors[3].name = "delta_d";
  for (std::size_t p = 0; p < effects.size(); ++p) {
    sensitivity_in(result).global_corrected(0, p) = effects[p] / result.factor_sigma[p];
  }
  return result;
}

/// A result with the published metric and the effects 0.4, 0.1, 0 and 0 mm.
StoredResult published() {
  StoredResult result = with_effects({4e-4, 1e-4, 0.0, 0.0});
  result.title = "Published";
  result.metric = "published";
  return result;
}

/// A result with the platform metric and the effects 1, 2, 3 and 0 mm.
StoredResult by_platform() {
  StoredResult result = with_effects({1e-3, 2e-3, 3e-3, 0.0});
  result.title = "By the platform";
  result.metric = "platform";
  result.metric_points = {{0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}, {0.0, 0.0, 0.0}};
  result.responses[0].name = "gap";
  return result;
}

TEST(TwoRankings, StandBesideEachOtherWithRanksAndEffects) {
  const StoredResult a = published();
  const StoredResult b = by_platform();
  const TwoRankings rankings = two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "gap", {}});
  EXPECT_EQ(text_of(rankings.table, kUnlimitedWidth),
            "Two rankings: the effect of each error at the size that its study gives it\n"
            "               rank,  x, published     rank,  gap, platform\n"
            "error      published        metric  platform         metric\n"
            "                              [mm]                     [mm]\n"
            "delta_b            1           0.4         3              1\n"
            "epsilon_a          2           0.1         2              2\n"
            "delta_c            3           0           1              3\n"
            "delta_d            3           0           4              0\n");
}

/// B orders all six pairs of errors. A orders five: b-epsilon, b-c and epsilon-c unlike B, b-d and epsilon-d like B.
TEST(TwoRankings, HaveKendallsTau) {
  const StoredResult a = published();
  const StoredResult b = by_platform();
  const TwoRankings rankings = two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "gap", {}});
  EXPECT_DOUBLE_EQ(rankings.tau, -1.0 / std::sqrt(5.0 * 6.0));
  ASSERT_EQ(rankings.remarks.size(), 2U);
  EXPECT_TRUE(rankings.remarks[0].starts_with("Kendall's tau of the two rankings is -0.18, over 4 errors"));
  EXPECT_NE(rankings.remarks[1].find("unit of length"), std::string::npos);
}

TEST(TwoRankings, OfOneMetricSayAAndB) {
  const StoredResult a = published();
  const TwoRankings rankings = two_rankings({a, "a.h5", "x", {}}, {a, "b.h5", "tilt", {}});
  EXPECT_EQ(rankings.table.columns[1].heading, "rank in A");
  EXPECT_EQ(rankings.table.columns[4].heading, "tilt in B");
  EXPECT_EQ(rankings.table.columns[4].unit, "deg");
  EXPECT_EQ(rankings.remarks.size(), 1U);
  EXPECT_EQ(two_rankings({a, "a.h5", "x", {}}, {a, "b.h5", "x", {}}).tau, 1.0);
}

TEST(TwoRankings, LeaveOutWhatIsNotKnown) {
  const StoredResult a = with_effects({1e-3, kNaN, 2e-3, 3e-3});
  const StoredResult b = with_effects({1e-3, 9e-3, 2e-3, 3e-3});
  const TwoRankings rankings = two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "x", {}});
  EXPECT_EQ(rankings.tau, 1.0);
  EXPECT_NE(rankings.remarks[0].find("over 3 errors"), std::string::npos);
  const std::vector<Cell>& last = rankings.table.rows.back();
  EXPECT_EQ(last[0].text, "epsilon_a");
  EXPECT_EQ(last[1].text, "-");
  EXPECT_EQ(last[2].text, "-");
  EXPECT_EQ(last[3].text, "1");
}

TEST(TwoRankings, SayWhenNoTauIsKnown) {
  const StoredResult a = with_effects({1e-3, kNaN, kNaN, kNaN});
  const TwoRankings rankings = two_rankings({a, "a.h5", "x", {}}, {a, "b.h5", "x", {}});
  EXPECT_TRUE(std::isnan(rankings.tau));
  EXPECT_NE(rankings.remarks[0].find("is not known"), std::string::npos);
}

TEST(TwoRankings, SayWhenTheMetricsPointsDiffer) {
  const StoredResult a = by_platform();
  StoredResult b = by_platform();
  EXPECT_EQ(two_rankings({a, "a.h5", "gap", {}}, {b, "b.h5", "gap", {}}).remarks.size(), 1U);
  b.metric_points[0][0] = 0.2;
  const TwoRankings rankings = two_rankings({a, "a.h5", "gap", {}}, {b, "b.h5", "gap", {}});
  ASSERT_EQ(rankings.remarks.size(), 2U);
  EXPECT_NE(rankings.remarks[1].find("different points"), std::string::npos);
}

TEST(TwoRankings, ClaimNothingOfAMetricWhereOneWeighsNothing) {
  const StoredResult a = by_platform();
  const StoredResult b = with_effects({1e-3, 2e-3, 3e-3, 0.0});
  const TwoRankings rankings = two_rankings({a, "a.h5", "gap", {}}, {b, "b.h5", "x", {}});
  EXPECT_EQ(rankings.table.columns[1].heading, "rank in A");
  for (const std::string& remark : rankings.remarks) EXPECT_EQ(remark.find("metric"), std::string::npos) << remark;
}

TEST(TwoRankings, AreOfTheErrorsThatBothHave) {
  const StoredResult a = published();
  StoredResult b = by_platform();
  b.factors[0].name = "delta_e";
  const TwoRankings rankings = two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "gap", {}});
  ASSERT_EQ(rankings.table.rows.size(), 3U);
  EXPECT_EQ(rankings.table.rows[0][1].text, "1");  // rank among the three common errors; it is second among all
  EXPECT_EQ(rankings.remarks[2], "Only in A: delta_b.");
  EXPECT_EQ(rankings.remarks[3], "Only in B: delta_e.");
  for (NamedUnit& factor : b.factors) factor.name += "_of_b";
  EXPECT_THROW(two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "gap", {}}), InputError);
}

TEST(TwoRankings, AreInTheOrderAskedFor) {
  const StoredResult a = published();
  const StoredResult b = by_platform();
  const Table table = two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "gap", {}}, RowOrder::name).table;
  EXPECT_EQ(table.rows[1][0].text, "delta_c");
  EXPECT_EQ(table.rows[1][3].text, "1");
}

TEST(TwoRankings, AreOfOneKind) {
  const StoredResult a = published();
  StoredResult b = by_platform();
  b.model = "another";
  EXPECT_NO_THROW(two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "gap", {}}));
  b.kind = "sobol";
  EXPECT_THROW(two_rankings({a, "a.h5", "x", {}}, {b, "b.h5", "gap", {}}), InputError);
}

TEST(TwoRankings, SayWhatEachResultIs) {
  const StoredResult a = published();
  const StoredResult b = by_platform();
  EXPECT_EQ(ranked_text('A', {a, "a.h5", "x", tally_of(a).total()}),
            "A: Published (a.h5); metric: published, radians against metres at the base's origin; ranked by x; 6 of "
            "4 000 solves did not converge");
  EXPECT_NE(ranked_text('B', {b, "b.h5", "gap", tally_of(b).total()})
                .find("metric: platform, by displacement of 3 points; ranked by gap"),
            std::string::npos);
  EXPECT_EQ(metric_text(ranked_result()), "");
}

TEST(TwoRankings, AsJsonHaveBothResultsAndTheTau) {
  const StoredResult a = published();
  const StoredResult b = by_platform();
  const std::array<RankedResult, 2> both{
      {{a, "a.h5", "x", tally_of(a).total()}, {b, "b.h5", "gap", tally_of(b).total()}}};
  const TwoRankings rankings = two_rankings(both[0], both[1]);
  const auto all =
      nlohmann::json::parse(json_of(both, {.tables = {rankings.table}, .tau = rankings.tau, .remarks = {}}));
  EXPECT_EQ(all["kendall_tau"].get<double>(), rankings.tau);
  EXPECT_EQ(all["results"][0]["path"], "a.h5");
  EXPECT_EQ(all["results"][1]["response"], "gap");
  EXPECT_EQ(all["results"][1]["metric"], "platform");
  EXPECT_EQ(all["results"][1]["metric_points"][0][0], 0.1);
  EXPECT_EQ(all["tables"][0]["rows"][2]["rank_a"], 3);
  EXPECT_EQ(all["tables"][0]["rows"][2]["rank_b"], 1);
  EXPECT_TRUE(nlohmann::json::parse(json_of(ranked_result(), {}, {}))["metric"].is_null());
}

}  // namespace
}  // namespace poesy::sensitivity
