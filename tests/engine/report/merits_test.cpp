#include "engine/report/merits.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "engine/report/report_kind.h"
#include "engine/report/requirements.h"
#include "engine/stats/proportion.h"

namespace poesy {
namespace {

/// The yield (%) of k good machines of n, with Wilson's 95 % interval.
Merit by_wilson(double k, double n) {
  constexpr double kZ = 1.9599639845400545;
  const double p = k / n;
  const double middle = (p + kZ * kZ / (2.0 * n)) / (1.0 + kZ * kZ / n);
  const double half = kZ / (1.0 + kZ * kZ / n) * std::sqrt(p * (1.0 - p) / n + kZ * kZ / (4.0 * n * n));
  return {"yield", "%", 100.0 * p, 100.0 * (middle - half), 100.0 * (middle + half), true};
}

/// The first four cases of Newcombe 1998, Table II, method 10. Newcombe's first sample is B here.
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
  // At most 3.09 standard errors below 95 % (one-sided, alpha = 1e-3).
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
  ASSERT_EQ(table.columns[2].name, "verdict");  // in front, because a narrow page hides the last columns
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

TEST(Merits, ThatContradictTheYieldAreNamed) {
  const Merit yield{"yield", "%", 90.0, 89.0, 91.0, true};
  const Merit better{"yield", "%", 95.0, 94.0, 96.0, true};
  const auto rms = [](double value) { return Merit{"rms", "mm", value, 0.99 * value, 1.01 * value}; };
  const auto cost = [](double value) {
    return Merit{.what = std::string(kCostMerit), .value = value, .low = value, .high = value};
  };
  const std::string sentence =
      " By the rms the other is better: the yield counts machines that keep all limits, and not how far they are from "
      "them.";
  EXPECT_TRUE(merit_sentences({yield, rms(1.0)}, {better, rms(2.0)}).ends_with(sentence));
  EXPECT_TRUE(merit_sentences({better, rms(2.0)}, {yield, rms(1.0)}).ends_with(sentence));
  EXPECT_EQ(merit_sentences({yield, rms(2.0)}, {better, rms(1.0)}).find("the other"), std::string::npos);
  EXPECT_EQ(merit_sentences({yield, rms(1.0)}, {yield, rms(2.0)}).find("the other"), std::string::npos);
  // a better yield may cost more
  EXPECT_EQ(merit_sentences({yield, cost(1.0)}, {better, cost(2.0)}).find("the other"), std::string::npos);
}

std::vector<std::string> notes_on(const Merit& a, const Merit& b) {
  const Table table = merits_table(std::vector<std::vector<Merit>>{{a}, {b}}).value();
  return {table.notes.begin() + 1, table.notes.end()};
}

/// The change is 0.5 with a half-width of sqrt(2). The half-width must shrink by sqrt(8) = 2.83, which takes 8 times as
/// many samples.
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

TEST(Merits, HaveNoVerdictUnderOtherRequirements) {
  const Merit yield{"yield", "%", 90.0, 89.0, 91.0, true};
  Merit wider{"yield", "%", 95.0, 94.0, 96.0, true};
  wider.others = {{"limits", "analysis.limits.gap", "0.15 mm", "0.2 mm"}, {"limits", "analysis.limits.x", "1 mm", ""}};
  const Merit rms{.what = "rms", .unit = "mm", .value = 2.0};
  EXPECT_EQ(change_of(yield, wider).verdict, Change::other_requirements);
  EXPECT_EQ(
      merit_sentences({rms, yield}, {rms, wider}),
      "No verdict, because the limits differ (analysis.limits.gap: 0.15 mm in A, 0.2 mm in B; analysis.limits.x: 1 "
      "mm in A, none in B): the yield is 90 % in A and 95 % in B. The rms is 2 mm in A and 2 mm in B (+0 %).");
  const Table table = merits_table(std::vector<std::vector<Merit>>{{yield}, {wider}}).value();
  EXPECT_EQ(table.caption, "Which is better: no verdict on the yield, because the limits differ");
  EXPECT_EQ(table.rows[1][2].text, "other limits");
  EXPECT_EQ(table.notes.back(),
            "no verdict on yield, because the limits differ (analysis.limits.gap: 0.15 mm in A, 0.2 mm in B; "
            "analysis.limits.x: 1 mm in A, none in B)");
  Merit elsewhere = rms;
  elsewhere.others = {{"poses", "poses.workspace", std::string(50, 'x'), "z = [0 mm, 1 mm]"}};
  EXPECT_EQ(merit_sentences({rms}, {elsewhere}),
            "No verdict, because the poses differ (poses.workspace): the rms is 2 mm in A and 2 mm in B.");
}

/// A result of a study with this text. It has one pose with the single coordinate `place`.
StoredResult result_of(std::string study, double place) {
  StoredResult result;
  result.study_text = std::move(study);
  result.poses = PoseSet(1, {place});
  return result;
}

TEST(OtherRequirements, AreLimitsOfYieldsAndPosesOfAll) {
  const StoredResult a =
      result_of("[poses]\nselect = \"boundary\"\ncount = 2\n[analysis]\nlimits.gap = \"0.001 m\"\n", 0.0);
  const StoredResult wider =
      result_of("[poses]\nselect = \"boundary\"\ncount = 3\n[analysis]\nlimits.gap = \"0.002 m\"\n", 1.0);
  using List = std::vector<OtherRequirement>;
  EXPECT_EQ(other_requirements(a, wider, kYieldMerit), (List{{"limits", "analysis.limits.gap", "1 mm", "2 mm"}}));
  EXPECT_EQ(other_requirements(a, wider, "root mean square of gap"), List());
  StoredResult elsewhere =
      result_of("[poses]\nselect = \"interior\"\ncount = 2\n[analysis]\nlimits.gap = \"0.001 m\"\n", 1.0);
  const List poses{{"poses", "poses.select", "boundary", "interior"}};
  EXPECT_EQ(other_requirements(a, elsewhere, kYieldMerit), poses);
  EXPECT_EQ(other_requirements(a, elsewhere, "root mean square of gap"), poses);
  elsewhere.poses = a.poses;
  EXPECT_EQ(other_requirements(a, elsewhere, kYieldMerit), List());
}

TEST(OtherRequirements, AreTheContentOfAFileOfPoses) {
  const std::string study = "[poses]\nselect = \"file\"\nfile = \"p.csv\"\n";
  EXPECT_TRUE(other_requirements(result_of(study, 0.0), result_of(study, 0.0), kYieldMerit).empty());
  EXPECT_EQ(topics_text(other_requirements(result_of(study, 0.0), result_of(study, 1.0), kYieldMerit)), "poses");
}

TEST(OtherRequirements, AreTheContentOfAFileOfATrajectory) {
  const auto study = [](const std::string& rest) {
    return "[poses]\nselect = \"trajectory\"\ntrajectory = { file = \"way.csv\"" + rest + " }\n";
  };
  const StoredResult a = result_of(study(", points = 3"), 0.0);
  EXPECT_EQ(topics_text(other_requirements(a, result_of(study(", points = 3"), 1.0), kYieldMerit)), "poses");
  EXPECT_TRUE(other_requirements(a, result_of(study(", points = 9"), 1.0), kYieldMerit).empty());
  EXPECT_TRUE(other_requirements(a, a, kYieldMerit).empty());
}

TEST(OtherRequirements, AreTablesOfPoses) {
  const StoredResult a = result_of("", 0.0);
  const StoredResult b = result_of("", 1.0);
  const std::string merit = "largest magnitude of gap";
  EXPECT_TRUE(other_requirements(a, b, merit, PosesFrom::study).empty());
  EXPECT_TRUE(other_requirements(a, a, merit, PosesFrom::table).empty());
  EXPECT_EQ(others_text(other_requirements(a, b, merit, PosesFrom::table), 'B'), "the poses differ (--poses)");
}

TEST(OtherRequirements, AreNotTheNumberOfPosesOfATrajectory) {
  const auto study = [](const std::string& rest) {
    return "[poses]\nselect = \"trajectory\"\ntrajectory = { curve = \"circle\", " + rest + " }\n";
  };
  const StoredResult a = result_of(study("points = 3, time = [\"0 s\", \"2 s\"]"), 0.0);
  EXPECT_TRUE(
      other_requirements(a, result_of(study("points = 9, time = [\"0 s\", \"2 s\"]"), 1.0), kYieldMerit).empty());
  EXPECT_FALSE(
      other_requirements(a, result_of(study("points = 3, time = [\"0 s\", \"1 s\"]"), 1.0), kYieldMerit).empty());
}

TEST(OtherRequirements, AreErrorsThatOnlyOneResultDrawsAtEachPose) {
  StoredResult a = result_of("", 0.0);
  a.factors = {{"play", "m"}, {"length", "m"}};
  StoredResult b = a;
  b.factor_draws = {"per pose", "per machine"};
  EXPECT_EQ(others_text(other_requirements(a, b, kYieldMerit), 'C'),
            "the draws differ (draws of play: per machine in A, per pose in C)");
  EXPECT_EQ(topics_text(other_requirements(a, b, kCostMerit)), "draws");
  EXPECT_TRUE(other_requirements(a, b, "root mean square of gap").empty());
  a.study_text = "[errors]\noverride.play.draws = \"per machine\"\n";
  b.study_text = "[errors]\noverride.play.draws = \"per pose\"\n";
  EXPECT_EQ(other_requirements(a, b, kYieldMerit).size(), 1U);
}

TEST(RequiredBy, KnowsTheKeysOfASweep) {
  EXPECT_EQ(required_by("analysis.limits.gap", kYieldMerit), "limits");
  EXPECT_EQ(required_by("analysis.limits.gap", "root mean square of gap"), "");
  const std::string within_gap = fmt::format("{}gap", kLimitMerit);
  EXPECT_EQ(required_by("analysis.limits.gap", within_gap), "limits");
  EXPECT_EQ(required_by("analysis.limits.rotation", within_gap), "");
  EXPECT_EQ(required_by("analysis.draws", within_gap), "draws");
  EXPECT_EQ(required_by("analysis.yield", kCostMerit), "wanted yields");
  EXPECT_EQ(required_by("analysis.yield", kYieldMerit), "");
  EXPECT_EQ(required_by("analysis.draws", kYieldMerit), "draws");
  EXPECT_EQ(required_by("poses.workspace.z", kYieldMerit), "poses");
  EXPECT_EQ(required_by("poses.count", kYieldMerit), "");
  EXPECT_EQ(required_by("mechanism.geometry.R", kYieldMerit), "");
  EXPECT_EQ(required_by("errors.override.play.draws", kYieldMerit), "draws");
  EXPECT_EQ(required_by("errors.linear.draws", kCostMerit), "draws");
  EXPECT_EQ(required_by("errors.linear.draws", "root mean square of gap"), "");
  EXPECT_EQ(required_by("errors.linear.sigma", kYieldMerit), "");
  EXPECT_EQ(required_by("solver.metric", "root mean square of gap"), "metrics");
  EXPECT_EQ(required_value("poses.trajectory", "{ file = \"way.csv\", points = 9 }"),
            required_value("poses.trajectory", "{ file = \"way.csv\", points = 3 }"));
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
