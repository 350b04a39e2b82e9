#include "engine/study/limit_keys.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

#include "engine/kinds/study_file.h"
#include "engine/study/study.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The fake mechanism with a signed response z and a response gap that has no sign.
Catalog limited_catalog() {
  Catalog catalog = test::fake_catalog();
  catalog[0].description.responses = {{"z", Dimension::length, "with a sign"}, {"gap", Dimension::length, "without"}};
  catalog[0].description.responses[1].has_no_sign = true;
  return catalog;
}

const Catalog kLimitedCatalog = limited_catalog();
const std::string kPerMachine = "kind = \"monte-carlo\"\ndraws = \"per machine\"\n";

std::string text_with(const std::string& analysis, const std::string& limits) {
  return "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\ncount = 3\n[analysis]\n" +
         analysis + "limits = { " + limits + " }\n";
}

Study study_with(const std::string& text) {
  const test::TempFolder folder;
  return read_study(folder.write("study.toml", text), kLimitedCatalog, StudyUse::run);
}

/// The only limit of a study with these limits. Expects the same limit after the resolved text is read again.
ValueLimit limit_of(const std::string& limits, const std::string& analysis = kPerMachine) {
  const Study study = study_with(text_with(analysis, limits));
  EXPECT_EQ(study.analysis.limits.size(), 1u) << limits;
  const Study again = study_with(resolved_text(study));
  EXPECT_EQ(again.analysis.limits.at(0).allowed, study.analysis.limits.at(0).allowed) << resolved_text(study);
  EXPECT_EQ(resolved_text(again), resolved_text(study));
  return study.analysis.limits.at(0).allowed;
}

TEST(LimitKeys, TakeTwoEndsOneEndAShareAndASpread) {
  EXPECT_EQ(limit_of("z = \"1 mm\""), ValueLimit(1e-3));
  EXPECT_EQ(limit_of("z = [\"-1 mm\", \"2 mm\"]"), ValueLimit::between(-1e-3, 2e-3));
  EXPECT_EQ(limit_of("z = [0, \"2 mm\"]"), ValueLimit::between(0.0, 2e-3));
  EXPECT_EQ(limit_of("z = [\"1 mm\", \"2 mm\"]"), ValueLimit::between(1e-3, 2e-3));
  EXPECT_EQ(limit_of("z = { to = \"2 mm\" }"), ValueLimit::between(-kInfinity, 2e-3));
  EXPECT_EQ(limit_of("z = { to = \"-2 mm\" }"), ValueLimit::between(-kInfinity, -2e-3));
  EXPECT_EQ(limit_of("z = { from = \"-1 mm\" }"), ValueLimit::between(-1e-3, kInfinity));
  EXPECT_EQ(limit_of("z = { from = \"-1 mm\", to = \"2 mm\", share = 0.9 }"),
            ValueLimit::between(-1e-3, 2e-3).at_share(0.9));
  EXPECT_EQ(limit_of("z = { to = \"2 mm\", share = \"95 %\" }"), ValueLimit::between(-kInfinity, 2e-3).at_share(0.95));
  EXPECT_EQ(limit_of("z = { to = \"2 mm\", share = 1 }"), ValueLimit::between(-kInfinity, 2e-3));
  EXPECT_EQ(limit_of("z = { spread = \"1 mm\" }"), ValueLimit::of_spread(1e-3));
  EXPECT_EQ(limit_of("gap = { spread = \"1 mm\" }"), ValueLimit::of_spread(1e-3));
}

TEST(LimitKeys, LimitMagnitudesWhereEndsAreOpposite) {
  EXPECT_EQ(limit_of("z = [\"-1 mm\", \"1 mm\"]"), ValueLimit(1e-3));
  EXPECT_EQ(limit_of("z = { from = \"-1 mm\", to = \"1 mm\", share = 0.9 }"), ValueLimit(1e-3).at_share(0.9));
  EXPECT_EQ(limit_of("gap = { to = \"1 mm\" }"), ValueLimit(1e-3));
  EXPECT_EQ(limit_of("gap = [\"0 mm\", \"1 mm\"]"), ValueLimit(1e-3));
  EXPECT_EQ(limit_of("gap = { to = \"1 mm\", share = 0.9 }"), ValueLimit(1e-3).at_share(0.9));
  EXPECT_EQ(limit_of("gap = { to = \"1 mm\" }", "kind = \"monte-carlo\"\ndraws = \"per pose\"\n"), ValueLimit(1e-3));
}

TEST(LimitKeys, TakeEndsWhereAShareOfTheDrawsIsJudged) {
  EXPECT_EQ(limit_of("z = [\"-1 mm\", \"2 mm\"]",
                     "kind = \"monte-carlo\"\ndraws = \"per pose\"\njudge = \"share\"\nshare = 0.99\n"),
            ValueLimit::between(-1e-3, 2e-3));
}

struct BadLimit {
  std::string analysis;
  std::string limits;
  std::vector<std::string> words;
};

TEST(LimitKeys, SayWhatIsWrong) {
  const std::string rms = "kind = \"monte-carlo\"\ndraws = \"per pose\"\n";
  const std::string share = "kind = \"monte-carlo\"\ndraws = \"per pose\"\njudge = \"share\"\nshare = 0.9\n";
  const std::vector<BadLimit> list{
      {kPerMachine, "z = ^[\"2 mm\", \"-1 mm\"]", {"analysis.limits.z runs from 2 mm to -1 mm", "lower end first"}},
      {kPerMachine, "z = ^[\"2 mm\", \"2 mm\"]", {"two different ends"}},
      {kPerMachine, "z = ^[\"2 mm\"]", {"the lower one first; { to = ... } has one end"}},
      {kPerMachine, "z = [\"2 mm\", ^\"2 deg\"]", {"analysis.limits.z[1] is '2 deg', but must be a length"}},
      {kPerMachine, "z = ^{ from = \"2 mm\", to = \"1 mm\" }", {"runs from"}},
      {kPerMachine, "z = ^{ }", {"states no end", "write from, to, or both; or spread"}},
      {kPerMachine, "z = ^{ share = 0.9 }", {"states no end"}},
      {kPerMachine, "z = { ^upto = \"1 mm\" }", {"unknown key 'upto'"}},
      {kPerMachine, "gap = ^[\"1 mm\", \"2 mm\"]", {"begins at", "gap has no sign", "write the upper end alone"}},
      {kPerMachine, "gap = ^[\"-2 mm\", \"-1 mm\"]", {"ends at", "gap has no sign", "an upper end above zero"}},
      {kPerMachine, "gap = ^{ from = \"-1 mm\" }", {"limits nothing", "write an upper end, to"}},
      {kPerMachine, "z = { to = \"1 mm\", share = ^0 }", {"analysis.limits.z.share is 0", "above 0 and at most 1"}},
      {kPerMachine, "z = { to = \"1 mm\", share = ^1.1 }", {"analysis.limits.z.share is 1.1", "e.g. 0.99"}},
      {kPerMachine, "z = { to = \"1 mm\", share = ^99 }", {"at most 1"}},
      {kPerMachine, "z = { spread = ^\"0 mm\" }", {"analysis.limits.z.spread is '0 mm'", "greater than zero"}},
      {kPerMachine, "z = { spread = \"1 mm\", to = ^\"1 mm\" }", {"is set beside spread", "[[response]]"}},
      {kPerMachine, "z = { spread = \"1 mm\", share = ^0.9 }", {"is set beside spread"}},
      {rms, "z = ^{ spread = \"1 mm\" }", {"limits the spread over the poses of a machine", "per machine"}},
      {rms,
       "z = ^{ from = \"-1 mm\", to = \"1 mm\", share = 0.9 }",
       {"share of the poses of a machine", "per machine"}},
      {share, "z = ^{ spread = \"1 mm\" }", {"limits the spread", "judge = \"yield\""}},
      {kPerMachine + "judge = \"rms\"\n", "z = ^{ spread = \"1 mm\" }", {"limits the spread", "judge = \"yield\""}},
      {rms, "z = ^[\"-1 mm\", \"2 mm\"]", {"root mean square, which has no sign", "judge = \"share\""}},
      {kPerMachine + "judge = \"rms\"\n", "z = ^{ to = \"2 mm\" }", {"root mean square, which has no sign"}}};
  for (const auto& [analysis, limits, words] : list) {
    const test::Marked marked(text_with(analysis, limits));
    const test::TempFolder folder;
    const std::string path = folder.write("study.toml", marked.text);
    test::expect_input_error([&] { static_cast<void>(read_study(path, kLimitedCatalog, StudyUse::run)); },
                             {path, marked.line, marked.column}, words);
  }
}

TEST(LimitKeys, AreWrittenInWords) {
  const auto text = [](const ValueLimit& limit) { return limit_text(limit, Dimension::length); };
  EXPECT_EQ(text(3e-5), "0.03 mm");
  EXPECT_EQ(text(ValueLimit::between(-2e-5, 1e-4)), "-0.02 mm to 0.1 mm");
  EXPECT_EQ(text(ValueLimit::between(-kInfinity, 1e-4)), "at most 0.1 mm");
  EXPECT_EQ(text(ValueLimit::between(-2e-5, kInfinity)), "at least -0.02 mm");
  EXPECT_EQ(text(ValueLimit::of_spread(8e-5)), "a spread of 0.08 mm");
  EXPECT_EQ(text(ValueLimit(3e-5).at_share(0.99)), "0.03 mm at 99 % of the poses");
}

}  // namespace
}  // namespace poesy
