#include "engine/kinds/sensitivity/tolerances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "engine/report/table.h"
#include "tests/engine/kinds/sensitivity/ranked_result.h"

namespace poesy::sensitivity {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ResponseTolerances example() {
  ResponseTolerances found{.response = 0, .all = {}, .limit = std::nullopt};
  found.all.reference = ReferenceError{0, 1e-3};
  found.all.equal_effect = {1e-3, 0.004, kInfinity, kNaN};
  found.all.mean_square_share = {0.25, 0.75, 0.0, kNaN};
  found.all.mean_square = {.background = 0.0, .effects = {0.25, 0.0, 0.0, 0.0}};
  return found;
}

TEST(ToleranceTable, HasTolerancesInTheUnitOfEachError) {
  Table table = tolerance_table(ranked_result(), example());
  EXPECT_EQ(table.notes[0],
            "equal effect: as much as delta_b = 1 mm; with these, predicted root mean square of x: 0.5 mm");
  table.notes.clear();
  EXPECT_EQ(text_of(table, kUnlimitedWidth),
            "Tolerances for x: standard deviations of normal errors\n"
            "                              equal\n"
            "error      kind     limb     effect  unit      index        low       high  share\n"
            "                                           [mm/unit]  [mm/unit]  [mm/unit]    [%]\n"
            "delta_b    linear      1     1       mm        0.6        0.5        0.7       25\n"
            "epsilon_a  angular     1     0.2292  deg       2.618      2.443      4.363     75\n"
            "delta_c    linear      2  no effect  mm        0.8        0.7        0.85       0\n"
            "delta_a    linear      3          -  mm            -          -          -      -\n");
}

TEST(ToleranceTable, OfALimitHasBothWaysToShareIt) {
  ResponseTolerances found = example();
  found.limit =
      LimitTolerances{.limit = 1e-4, .equal_effect = {1e-4, 2e-4, 3e-4, 4e-4}, .equal_tolerance = {1.0, 1.0, 1.0, 1.0}};
  const Table table = tolerance_table(ranked_result(), found);
  EXPECT_EQ(table.columns[3].name, "limit_equal_effect");
  EXPECT_EQ(table.rows[0][3].text, "0.1");
  EXPECT_EQ(table.rows[0][4].text, "1000");
  EXPECT_EQ(table.columns[5].name, "unit") << "no column that does not keep the limit";
  for (const std::string& note : table.notes) EXPECT_FALSE(note.starts_with("equal effect: as much as")) << note;
  EXPECT_TRUE(std::ranges::any_of(table.notes, [](const std::string& note) {
    return note.starts_with("4 of 4 errors have a tolerance larger than the sigma of the study");
  }));
}

/// Whether a note of the table contains these words.
bool says(const Table& table, std::string_view words) {
  return std::ranges::any_of(table.notes,
                             [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

TEST(ToleranceTable, OfALimitSaysWhatItLeavesOut) {
  ResponseTolerances found = example();
  EXPECT_FALSE(says(tolerance_table(ranked_result(), found), "kind allocation"));
  found.limit =
      LimitTolerances{.limit = 1e-4, .equal_effect = {1e-4, 2e-4, 3e-4, 4e-4}, .equal_tolerance = {1.0, 1.0, 1.0, 1.0}};
  const Table table = tolerance_table(ranked_result(), found);
  EXPECT_TRUE(
      says(table, "standard deviations under a limit on one root mean square, without costs, bounds or a yield"));
  EXPECT_TRUE(says(table, "A study of kind allocation finds the tolerances of a drawing, with a certificate"));
  EXPECT_TRUE(says(table, "poesy template MODEL allocation"));
}

TEST(ToleranceTable, SaysByHowMuchALimitMayBeExceeded) {
  StoredResult stored = ranked_result();
  ResponseTolerances found = example();
  found.limit =
      LimitTolerances{.limit = 3e-4, .equal_effect = {1e-4, 2e-4, 3e-4, 4e-4}, .equal_tolerance = {1.0, 1.0, 1.0, 1.0}};
  sensitivity_in(stored).mean_square_bound = {{2}, {2.25, 1.0}};
  const Table table = tolerance_table(stored, found);
  EXPECT_TRUE(says(table, "may come out up to 1.5 times as large, 0.45 mm"));
  EXPECT_TRUE(says(table, "give --limit \"0.2 mm\""));
  sensitivity_in(stored).mean_square_bound = {{2}, {1.0, 2.25}};
  EXPECT_FALSE(says(tolerance_table(stored, found), "times as large"));
}

TEST(ToleranceTable, SaysWhichErrorsAreNotNormal) {
  StoredResult stored = ranked_result();
  stored.factor_distribution = {"normal", "uniform", "triangular", "uniform"};
  EXPECT_TRUE(says(tolerance_table(stored, example()),
                   "3 of 4 errors are not normal in the study (uniform, triangular): the tolerance is still"));
  stored.factor_distribution = {"normal", "normal", "normal", "normal"};
  EXPECT_FALSE(says(tolerance_table(stored, example()), "not normal"));
}

}  // namespace
}  // namespace poesy::sensitivity
