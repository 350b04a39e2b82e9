#include "engine/report/merits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/report/report_kind.h"
#include "engine/stats/proportion.h"

namespace poesy {
namespace {

/// A yield of k good ones of n, in percent, with Wilson's interval at 95 %.
Merit by_wilson(double k, double n) {
  constexpr double kZ = 1.9599639845400545;
  const double p = k / n;
  const double middle = (p + kZ * kZ / (2.0 * n)) / (1.0 + kZ * kZ / n);
  const double half = kZ / (1.0 + kZ * kZ / n) * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n));
  return {"yield", "%", 100.0 * p, 100.0 * (middle - half), 100.0 * (middle + half), true};
}

/// The first four cases of Newcombe 1998, table II, method 10: his first sample is B here.
TEST(MeritChange, HasTheIntervalsThatNewcombePrints) {
  const struct {
    double k_b, n_b, k_a, n_a, low, high;
  } cases[] = {{56, 70, 48, 80, 5.24, 33.39},
               {9, 10, 3, 10, 17.05, 80.90},
               {6, 7, 2, 7, 5.82, 80.62},
               {5, 56, 0, 29, -3.81, 19.26}};
  for (const auto& one : cases) {
    const MeritChange change = change_of(by_wilson(one.k_a, one.n_a), by_wilson(one.k_b, one.n_b));
    EXPECT_NEAR(change.low, one.low, 0.006);
    EXPECT_NEAR(change.high, one.high, 0.006);
    EXPECT_EQ(change.verdict, one.low > 0.0 ? Change::better : Change::not_told_apart);
  }
}

TEST(MeritChange, CoversTheTrueChangeAtLeastAsOftenAsItSays) {
  std::mt19937 draw(41);
  constexpr int kTrials = 4000;
  int covered = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto yield = [&](double share) {
      const auto good = static_cast<std::uint64_t>(std::binomial_distribution<int>(300, share)(draw));
      const Estimate found = proportion(good, 300, 0.95);
      return Merit{"yield", "%", 100.0 * found.value, 100.0 * found.interval.low, 100.0 * found.interval.high, true};
    };
    const Merit a = yield(0.9);
    const Merit b = yield(0.95);
    const MeritChange change = change_of(a, b);
    covered += change.low <= 5.0 && 5.0 <= change.high ? 1 : 0;
  }
  // One-sided at alpha = 1e-3: 3.09 standard errors below 95 %.
  EXPECT_GE(covered, 0.95 * kTrials - 3.09 * std::sqrt(0.95 * 0.05 * kTrials));
}

TEST(MeritChange, IsCertainOfExactNumbers) {
  const Merit a{.what = "cost", .value = 4.0, .low = 4.0, .high = 4.0};
  const Merit b{.what = "cost", .value = 3.0, .low = 3.0, .high = 3.0};
  EXPECT_EQ(change_of(a, b).verdict, Change::better);
  EXPECT_EQ(change_of(b, a).verdict, Change::worse);
  EXPECT_EQ(change_of(a, a).verdict, Change::not_told_apart);
}

TEST(MeritChange, SaysNothingWithoutIntervals) {
  const MeritChange change = change_of({.what = "cost", .value = 4.0}, {.what = "cost", .value = 3.0});
  EXPECT_EQ(change.value, -1.0);
  EXPECT_EQ(change.verdict, Change::without_interval);
}

TEST(Merits, AreComparedWhereAllResultsHaveThem) {
  const Merit yield{"yield", "%", 90.0, 89.0, 91.0, true};
  const Merit better{"yield", "%", 95.0, 94.0, 96.0, true};
  const Merit cost{.what = "cost of all parts", .value = 10.0};
  const std::vector<std::vector<Merit>> both{{yield, cost}, {better}, {yield}};
  const Table table = merits_table(both).value();
  ASSERT_EQ(table.rows.size(), 3U);
  ASSERT_EQ(table.columns[2].name, "verdict");  // early, because a narrow page hides the last columns
  EXPECT_EQ(table.columns[3].name, "change");
  EXPECT_EQ(table.rows[0][2].text, "-");
  EXPECT_EQ(table.rows[1][2].text, "better");
  EXPECT_EQ(table.rows[2][2].text, "not told apart");
  EXPECT_FALSE(merits_table(std::vector<std::vector<Merit>>{{cost}, {yield}}));
  EXPECT_EQ(merit_sentences({yield, cost}, {better}),
            "B is better: the yield is 90 % in A and 95 % in B (+5 percentage points, interval +3.59 to +6.41).");
  EXPECT_EQ(merit_sentences({cost}, {Merit{.what = "cost of all parts", .value = 8.0}}, 'C'),
            "The cost of all parts is 10 in A and 8 in C (-20 %).");
  const auto exact = [](double value) { return Merit{.what = "cost", .value = value, .low = value, .high = value}; };
  EXPECT_EQ(merit_sentences({exact(10.0)}, {exact(8.0)}), "B is better: the cost is 10 in A and 8 in B (-20 %).");
}

std::vector<std::string> notes_on(const Merit& a, const Merit& b) {
  const Table table = merits_table(std::vector<std::vector<Merit>>{{a}, {b}}).value();
  return {table.notes.begin() + 1, table.notes.end()};
}

/// The half-width of the change is sqrt(2) on either side of 0.5, so it must shrink by sqrt(8) = 2.83.
TEST(Merits, SayHowManySamplesWouldTellThemApart) {
  const Merit yield{"yield", "%", 90.0, 89.0, 91.0, true};
  EXPECT_EQ(
      notes_on(yield, {"yield", "%", 90.5, 89.5, 91.5, true}),
      std::vector<std::string>{
          "yield, A and B not told apart: about 8 times as many samples of each would show a difference as large as "
          "this one"});
  EXPECT_TRUE(notes_on(yield, {"yield", "%", 95.0, 94.0, 96.0, true}).empty());
  const Merit rms{.what = "rms", .value = 1.0, .low = 0.9, .high = 1.1};
  EXPECT_EQ(
      notes_on(rms, {.what = "rms", .value = 1.0001, .low = 0.9, .high = 1.1}),
      std::vector<std::string>{"rms, A and B not told apart: the difference is too small for any number of samples"});
  EXPECT_EQ(notes_on(rms, rms), std::vector<std::string>{"rms, A and B not told apart: they are equal"});
  const Merit of_parts{.what = "yield", .value = 90.0, .low = 80.0, .high = 99.0, .most_best = true, .narrows = false};
  EXPECT_TRUE(notes_on(of_parts, of_parts).empty());
}

TEST(Merits, SayWhatHasNoInterval) {
  const Merit cost{.what = "cost", .value = 450.0, .note = "the cost has no interval"};
  EXPECT_EQ(notes_on(cost, {.what = "cost", .value = 466.0}), std::vector<std::string>{"the cost has no interval"});
}

TEST(ComparedResponse, IsOneThatAllHave) {
  StoredResult a;
  a.responses = {{"gap", "m"}, {"x", "m"}};
  a.headline = {0, 1};
  StoredResult b;
  b.responses = {{"x", "m"}};
  EXPECT_EQ(compared_response(std::vector<const StoredResult*>{&a, &a}), "gap");
  EXPECT_EQ(compared_response(std::vector<const StoredResult*>{&a, &b}), "x");
  b.responses = {{"y", "m"}};
  EXPECT_EQ(compared_response(std::vector<const StoredResult*>{&a, &b}), "");
}

}  // namespace
}  // namespace poesy
