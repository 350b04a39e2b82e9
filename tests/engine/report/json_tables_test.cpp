#include "engine/report/tables.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "engine/report/display.h"
#include "tests/engine/kinds/sensitivity/ranked_result.h"

namespace poesy {
namespace {

using nlohmann::json;

TEST(JsonTables, HaveEveryCellAsValueAndAsText) {
  const StoredResult result = sensitivity::ranked_result();
  const std::vector<Table> tables = result_tables(result, "x");
  const json all = json::parse(json_of(result, tally_of(result).total(), tables));
  ASSERT_EQ(all["tables"].size(), tables.size());
  for (std::size_t t = 0; t < tables.size(); ++t) {
    const json& table = all["tables"][t];
    ASSERT_EQ(table["rows"].size(), tables[t].rows.size());
    for (std::size_t n = 0; n < tables[t].rows.size(); ++n) {
      for (std::size_t c = 0; c < tables[t].columns.size(); ++c) {
        const Column& column = tables[t].columns[c];
        const Cell& cell = tables[t].rows[n][c];
        EXPECT_EQ(table["columns"][c]["unit"], column.unit);
        EXPECT_EQ(table["shown"][n][c], cell.text);
        const json& value = table["rows"][n][column.name];
        if (column.kind == Column::Kind::text) {
          EXPECT_EQ(value, cell.text);
        } else if (cell.value) {
          EXPECT_EQ(value.get<double>(), *cell.value);  // exactly
        } else {
          EXPECT_TRUE(value.is_null());
        }
      }
    }
  }
}

TEST(JsonTables, HaveWholeNumbersAsWholeNumbers) {
  constexpr std::uint64_t kSeed = 5193415256785059083U;  // 2^62 and more; no double has this value
  const Table table{.name = "t",
                    .caption = "",
                    .columns = {number_column("seed", "seed"), number_column("share", "share")},
                    .rows = {{count_cell(kSeed), number_cell(2.0)}}};
  const json row = json::parse(json_of(table))["rows"][0];
  EXPECT_TRUE(row["seed"].is_number_unsigned());
  EXPECT_EQ(row["seed"].get<std::uint64_t>(), kSeed);
  EXPECT_TRUE(row["share"].is_number_float());
}

TEST(JsonTables, NameEachColumnOnce) {
  for (const Table& table : result_tables(sensitivity::ranked_result(), "x")) {
    std::set<std::string> names;
    for (const Column& column : table.columns) {
      EXPECT_TRUE(names.insert(column.name).second) << column.name;
      EXPECT_EQ(column.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_"), std::string::npos);
    }
  }
}

TEST(JsonTables, SayWhatEachErrorAndResponseIs) {
  StoredResult result = sensitivity::ranked_result();
  result.factors[1].description = "a bolt that is too long";
  const json all = json::parse(json_of(result, tally_of(result).total(), {}));
  ASSERT_EQ(all["errors"].size(), result.factors.size());
  EXPECT_EQ(all["errors"][1]["name"], result.factors[1].name);
  EXPECT_EQ(all["errors"][1]["unit"], result.factors[1].unit);
  EXPECT_EQ(all["errors"][1]["description"], "a bolt that is too long");
  EXPECT_EQ(all["responses"].size(), result.responses.size());
}

TEST(JsonTables, HaveTheSummary) {
  StoredResult result = sensitivity::ranked_result();
  result.title = "not UTF-8: \xFF";
  const json all = json::parse(json_of(result, tally_of(result).total(), {}));
  EXPECT_EQ(all["kind"], "sensitivity");
  EXPECT_EQ(all["seed"].get<std::uint64_t>(), 9223372036854775807U);
  EXPECT_EQ(all["content_sha256"], "abc");
  EXPECT_EQ(all["solves"]["total"], 4000);
  EXPECT_EQ(all["solves"]["not_converged"], 6);
  EXPECT_EQ(all["solves"]["by_status"]["iteration_cap"], 6);
  result.study_text.clear();
  EXPECT_TRUE(json::parse(json_of(result, tally_of(result).total(), {}))["seed"].is_null());
}

}  // namespace
}  // namespace poesy
