#include "engine/kinds/sensitivity/linearity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/report/tables.h"
#include "tests/engine/kinds/sensitivity/ranked_result.h"

namespace poesy::sensitivity {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// changes: of the indices of delta_b, epsilon_a, delta_c, delta_a; the last error has no index.
StoredResult result(const std::vector<double>& changes) {
  StoredResult stored = ranked_result();
  std::ranges::fill(sensitivity_in(stored).index_change, kNaN);
  std::ranges::copy(changes, sensitivity_in(stored).index_change.begin());
  return stored;
}

/// Tolerances without a limit. equal_effect: the tolerances of equal effect (m, rad).
ResponseTolerances tolerances(std::vector<double> equal_effect) {
  ResponseTolerances found{.response = 0, .all = {}, .limit = std::nullopt};
  found.all.reference = ReferenceError{0, 1e-3};
  found.all.equal_effect = std::move(equal_effect);
  found.all.mean_square_share = {0.25, 0.75, 0.0, kNaN};
  found.all.mean_square = {.background = 0.0, .effects = {0.25, 0.0, 0.0, 0.0}};
  return found;
}

TEST(IndexChange, NamesErrorsWhoseIndexChangesTheLargestFirst) {
  EXPECT_EQ(index_change_text(result({-0.5, 0.01, -0.991}), 0),
            "the index on x holds at a tenth of the size, within 2 %: 1 of 3 errors with an effect; not for delta_c "
            "(-99.1 %), delta_b (-50.0 %)");
  EXPECT_EQ(index_change_text(result({0.0, kNaN, -0.02}), 0),
            "the index on x holds at a tenth of the size, within 2 %: 2 of 3 errors with an effect; not known for 1");
  EXPECT_EQ(changing_errors(result({-0.5, 0.01, -0.991, -0.9}), 0), (std::vector<std::size_t>{2, 0}))
      << "an error without an index has none that changes";
}

TEST(IndexChange, IsNotTestedToFirstOrder) {
  StoredResult stored = result({0.0, 0.0, 0.0});
  stored.study_text = "[mechanism]\nfidelity = \"first-order\"\n";
  const std::string text =
      "solved to first order in the errors, so it is not tested whether indices hold at other sizes";
  EXPECT_EQ(index_change_text(stored, 0), text);
  const Table table = result_tables(stored, "x").front();
  EXPECT_EQ(std::ranges::find(table.columns, "index_change", &Column::name), table.columns.end());
  EXPECT_NE(std::ranges::find(table.notes, text), table.notes.end());
  stored = result({-0.5, 0.0, 0.0});
  stored.study_text = "[mechanism]\nfidelity = \"first-order\"\n";
  EXPECT_EQ(index_change_text(stored, 0),
            text + "; already to first order they change at a tenth of the size for delta_b (-50.0 %)");
}

TEST(IndexChange, IsAColumnOfTheRankingAndANote) {
  const StoredResult stored = result({-0.5, 1e-14, -0.991});
  const Table table = result_tables(stored, "x").front();
  const auto at = std::ranges::find(table.columns, "index_change", &Column::name) - table.columns.begin();
  ASSERT_LT(static_cast<std::size_t>(at), table.columns.size());
  std::vector<std::string> texts;
  for (const std::vector<Cell>& row : table.rows) texts.push_back(row[static_cast<std::size_t>(at)].text);
  EXPECT_EQ(texts, (std::vector<std::string>{"0.0", "-99.1", "-50.0", "-"}));  // epsilon_a, delta_c, delta_b, delta_a
  EXPECT_TRUE(std::ranges::count(table.notes, index_change_text(stored, 0)));
}

TEST(WrongSizes, AreTolerancesOfAnotherSizeWhereTheIndexChanges) {
  const StoredResult stored = result({-0.5, 0.01, -0.991});  // studied at 1 mm, 0.5 deg, 2 mm
  EXPECT_EQ(wrong_sizes_text(stored, tolerances({0.6e-3, 1e-6, 1e-3, kNaN})), "");
  EXPECT_EQ(wrong_sizes_text(stored, tolerances({2.5e-3, 1e-6, 0.9e-3, kNaN})),
            "2 errors have an index on x that changes with size, by so much at a tenth of it, and a tolerance of "
            "another size than was studied: delta_c (-99.1 %; study it at 1.54 mm), delta_b (-50.0 %; study it at "
            "2.02 mm)");
  EXPECT_EQ(wrong_sizes_text(ranked_result(), tolerances({1.0, 1.0, 1.0, 1.0})), "") << "no index changes";
  EXPECT_EQ(wrong_sizes_text(stored, tolerances({std::numeric_limits<double>::infinity(), 1e-3, 2e-3, kNaN})), "")
      << "no effect";
}

// A new study of a quadratic error should use the geometric mean of the studied size (1 mm) and its tolerance (0.01
// mm). At 0.01 mm its effect would be 100 times too small for the linear law, which would give 1 mm as its tolerance
// again.
TEST(WrongSizes, OfAQuadraticErrorAreStudiedInTheMiddle) {
  const StoredResult stored = result({-0.9, 0.01, 0.0});
  const std::string text = wrong_sizes_text(stored, tolerances({0.01e-3, 1e-6, 2e-3, kNaN}));
  EXPECT_NE(text.find("delta_b (-90.0 %; study it at 0.1 mm)"), std::string::npos) << text;
}

TEST(WrongSizes, OfALimitAreThoseOfEitherWayToShareIt) {
  const StoredResult stored = result({-0.5, 0.01, 0.0});
  ResponseTolerances found = tolerances({1.0, 1.0, 1.0, 1.0});
  found.limit = LimitTolerances{1e-4, {1e-3, 1e-3, 1e-3, 1e-3}, {1e-3, 1e-3, 1e-3, 1e-3}};
  EXPECT_EQ(wrong_sizes_text(stored, found), "");
  found.limit->equal_tolerance[0] = 1e-4;
  EXPECT_NE(wrong_sizes_text(stored, found).find("delta_b (-50.0 %; study it at 0.17 mm)"), std::string::npos);
}

TEST(Negligible, ErrorsChangeWithSizeAndAddNextToNothing) {
  const StoredResult stored = result({-0.5, -0.5, 0.0});  // studied at 1 mm, 0.5 deg, 2 mm
  const double angle = stored.factor_sigma[1];
  const double most = 1e-3 / 4.0;  // at most a thousandth of the mean square for four errors together
  const auto found = [&](double of_length, double of_angle) {
    return negligible_errors(stored, 0, {0.0, {of_length / 1e-6, of_angle / (angle * angle), 1e-9, kNaN}}, 1.0);
  };
  EXPECT_EQ(found(0.99 * most, 1.01 * most), std::vector<std::size_t>{0});
  EXPECT_EQ(found(1.01 * most, 0.99 * most), std::vector<std::size_t>{1});
  EXPECT_EQ(found(0.0, kNaN), std::vector<std::size_t>{0}) << "what is not known is not negligible";
  EXPECT_EQ(found(1.0, 1.0), std::vector<std::size_t>());
  EXPECT_EQ(negligible_errors(ranked_result(), 0, {0.0, {0.0, 0.0, 0.0, 0.0}}, 1.0), std::vector<std::size_t>())
      << "no index changes";
}

TEST(Negligible, ErrorsAreNamedWithTheSizeStudied) {
  const StoredResult stored = result({-0.5, -0.5, 0.0});
  ResponseTolerances found = tolerances({1e-3, 1e-3, 2e-3, kNaN});
  EXPECT_EQ(negligible_text(stored, found), "");
  found.negligible = {1, 0};
  const std::string text =
      "2 negligible errors have the size studied as tolerance: the index on x changes with size, but at that size all "
      "together add at most 0.1 % to its mean square: epsilon_a (0.5 deg), delta_b (1 mm)";
  EXPECT_EQ(negligible_text(stored, found), text);
  EXPECT_TRUE(std::ranges::count(tolerance_table(stored, found).notes, text));
}

TEST(WrongSizes, StandBelowTheTolerances) {
  ResponseTolerances found = tolerances({2.5e-3, 1e-6, 0.9e-3, kNaN});
  found.caveat = "they may not hold";
  EXPECT_TRUE(std::ranges::count(tolerance_table(result({}), found).notes, "they may not hold"));
}

}  // namespace
}  // namespace poesy::sensitivity
