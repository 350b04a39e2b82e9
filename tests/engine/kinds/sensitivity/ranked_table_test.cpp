#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "engine/kinds/sensitivity/ranking.h"
#include "engine/kinds/sensitivity/result.h"
#include "engine/report/table.h"
#include "engine/report/tables.h"
#include "tests/engine/kinds/sensitivity/ranked_result.h"

namespace poesy::sensitivity {
namespace {

std::vector<std::string> names(RowOrder order) {
  const StoredResult result = ranked_result();
  std::vector<std::string> list;
  const Table table = result_tables(result, "x", order).front();
  for (const std::vector<Cell>& row : table.rows) {
    list.push_back(row[1].text);
  }
  return list;
}

TEST(RankedTable, ShowsEffectIndexIntervalAndSigma) {
  const StoredResult result = ranked_result();
  Table table = result_tables(result, "x").front();
  table.notes.clear();
  for (std::vector<Cell>& row : table.rows) row.erase(row.begin() + 8, row.begin() + 11);
  table.columns.erase(table.columns.begin() + 8, table.columns.begin() + 11);  // columns of the other response
  EXPECT_EQ(text_of(table, kUnlimitedWidth),
            "Effect of each error on x at the size the study gives it\n"
            "                                                                        at a        not\n"
            "rank  error      effect      index        low       high  sigma  unit  tenth  converged  published\n"
            "                   [mm]  [mm/unit]  [mm/unit]  [mm/unit]                 [%]        [%]  [mm/unit]\n"
            "   1  epsilon_a  0.8727      1.745      1.571      3.491    0.5  deg     0.0        0.1      2.618\n"
            "   2  delta_c    0.6         0.3        0.2        0.35     2    mm      0.0        0.2      0.8\n"
            "   3  delta_b    0.4         0.4        0.3        0.5      1    mm      0.0        0        0.6\n"
            "   4  delta_a         -          -          -          -    1    mm        -        0.3          -\n");
}

TEST(RankedTable, HasTheHeadlinesOtherResponses) {
  const StoredResult result = ranked_result();
  const Table table = result_tables(result, "x").front();
  ASSERT_EQ(table.columns.size(), 14U);  // the response without a dimension has no column
  EXPECT_EQ(table.columns[8].name, "index_tilt");
  EXPECT_EQ(table.columns[8].unit, "deg/unit");
  EXPECT_EQ(table.rows[0][8].text, "0.7");
  EXPECT_EQ(table.rows[0][10].text, "0.8");
  EXPECT_EQ(table.rows[2][8].text, "0");  // below rounding, so shown as 0
  EXPECT_NE(table.rows[2][8].value, 0.0);
}

TEST(RankedTable, RanksByTheCorrectedIndex) {
  const StoredResult result = ranked_result();
  const Table table = result_tables(result, "x").front();
  EXPECT_EQ(table.columns.back().name, "index_published");
  EXPECT_EQ(table.columns.back().unit, "mm/unit");
  std::vector<std::string> shown;
  for (const std::vector<Cell>& row : table.rows) {
    shown.push_back(row[1].text + " " + row[2].text + " " + row[3].text + " " + row[4].text + " " + row[5].text + " " +
                    row.back().text);
  }
  EXPECT_EQ(shown, (std::vector<std::string>{"epsilon_a 0.8727 1.745 1.571 3.491 2.618", "delta_c 0.6 0.3 0.2 0.35 0.8",
                                             "delta_b 0.4 0.4 0.3 0.5 0.6", "delta_a - - - - -"}));
  EXPECT_TRUE(table.notes[1].starts_with("published: ")) << table.notes[1];
}

TEST(RankedTable, SaysWhichErrorsAreTooSmallToTell) {
  StoredResult result = ranked_result();
  const std::size_t notes = result_tables(result, "x").front().notes.size();
  result.factor_sigma[3] = 1e-11;  // the error without an index
  const Table table = result_tables(result, "x").front();
  EXPECT_EQ(table.rows[3][3].text, "rounding");
  EXPECT_FALSE(table.rows[3][3].value);
  ASSERT_EQ(table.notes.size(), notes + 1);
  EXPECT_TRUE(table.notes.back().starts_with("rounding: the error is so small")) << table.notes.back();
}

TEST(RankedTable, SaysHowOftenIntervalsOfFewSamplesHold) {
  StoredResult result = ranked_result();
  const auto note = [&](std::uint64_t samples) -> std::string {
    for (SolveCounts& solves : sensitivity_in(result).solves) {
      solves = {};
      solves.by_status[0] = samples;
    }
    const Table table = result_tables(result, "x").front();
    for (const std::string& one : table.notes) {
      if (one.find(" at each pose are few") != std::string::npos) return one;
    }
    return {};
  };
  EXPECT_TRUE(note(50).starts_with("50 samples at each pose are few")) << note(50);
  EXPECT_EQ(note(200), "");
  sensitivity_in(result).index_change(0, 0) = -0.9;  // the table ranks by the first response
  EXPECT_TRUE(note(200).starts_with("200 samples at each pose are few"));
  EXPECT_EQ(note(1000), "");
}

TEST(RankedTable, IsInTheOrderAskedFor) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(names(RowOrder::effect), (Names{"epsilon_a", "delta_c", "delta_b", "delta_a"}));
  EXPECT_EQ(names(RowOrder::index), (Names{"epsilon_a", "delta_b", "delta_c", "delta_a"}));
  EXPECT_EQ(names(RowOrder::name), (Names{"delta_a", "delta_b", "delta_c", "epsilon_a"}));
  EXPECT_EQ(names(RowOrder::study), (Names{"delta_b", "epsilon_a", "delta_c", "delta_a"}));
  EXPECT_EQ(names(RowOrder::not_converged), (Names{"delta_a", "delta_c", "epsilon_a", "delta_b"}));
}

TEST(RankedTable, RanksByEffectWhateverTheOrder) {
  const StoredResult result = ranked_result();
  EXPECT_EQ(ranked_errors(result, "x", RowOrder::name).ranks, (std::vector<std::size_t>{3, 1, 2, 4}));
}

TEST(RankedTable, PutsAnotherResponseFirst) {
  const StoredResult result = ranked_result();
  const Table table = result_tables(result, "tilt").front();
  EXPECT_EQ(table.rows[0][1].text, "epsilon_a");
  EXPECT_EQ(table.rows[0][2].text, "0.35");
  EXPECT_EQ(table.columns[8].heading, "x");
}

TEST(RankedTable, IsReadableAtEightyColumnsWithManyResponses) {
  StoredResult result = ranked_result();
  for (std::size_t r = 3; r < 12; ++r) {
    result.headline.push_back(r);
    result.responses.push_back({"component_" + std::to_string(r), "m"});
  }
  set_indices(result, std::vector<double>(12 * 4, 0.125));
  const std::string text = text_of(result_tables(result, "x").front(), 80);
  std::size_t begin = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; begin = end + 1, end = text.find('\n', begin)) {
    EXPECT_LE(end - begin, 80U) << text;
  }
  EXPECT_NE(text.find("sigma"), std::string::npos) << text;
}

TEST(KeepFirst, SaysHowManyThereAre) {
  std::vector<Table> tables = result_tables(ranked_result(), "x");
  keep_first(2, tables);
  EXPECT_EQ(tables[0].rows.size(), 2U);
  EXPECT_EQ(tables[0].notes.back(), "2 of 4 rows shown");
  std::vector<Table> all = result_tables(ranked_result(), "x");
  const std::string before = text_of(all, kUnlimitedWidth);
  keep_first(4, all);
  EXPECT_EQ(text_of(all, kUnlimitedWidth), before);
}

}  // namespace
}  // namespace poesy::sensitivity
