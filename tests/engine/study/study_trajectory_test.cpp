#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/names.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

constexpr std::string_view kFile = "t,z,beta,gamma\n0,-0.2,0,0\n1,-0.2,0.1,0\n2,-0.3,0.1,0\n";

/// The text of a study with this trajectory. The text may go on with other keys of [poses].
std::string study_with(std::string_view trajectory) {
  return "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\nselect = \"trajectory\"\n"
         "trajectory = " +
         std::string(trajectory) + "\n";
}

Study study_of(const std::string& text, StudyUse use = StudyUse::run, const Catalog& catalog = test::fake_catalog()) {
  static Catalog kept;
  kept = catalog;
  const test::TempFolder folder;
  folder.write("curve.csv", kFile);
  return read_study(folder.write("study.toml", text), kept, use);
}

Trajectory trajectory_of(std::string_view trajectory, StudyUse use = StudyUse::run) {
  return study_of(study_with(trajectory), use).poses.trajectory.value();
}

TEST(ReadTrajectory, FillsInTheDefaultsOfACurve) {
  const Study study = study_of(study_with("{ curve = \"wave\" }"));
  const Trajectory& trajectory = *study.poses.trajectory;
  EXPECT_EQ(trajectory.curve, std::size_t{0});
  EXPECT_EQ(trajectory.origin, (std::vector{0.2, -1.0, 0.0}));
  EXPECT_EQ(trajectory.points, 201u);
  EXPECT_EQ(trajectory.time->lower, 0.0);
  EXPECT_EQ(trajectory.time->upper, 4.0);
  EXPECT_EQ(study.poses.count, 201u);
  EXPECT_EQ(study.poses.max_condition, 1e8);
}

TEST(ReadTrajectory, TakesEveryValue) {
  const Trajectory trajectory = trajectory_of(
      "{ curve = \"wave\", origin = [\"250 mm\", \"0.5 rad\", \"0 rad\"], points = 7, time = [\"500 ms\", \"0.05 "
      "min\"] }");
  EXPECT_EQ(trajectory.origin, (std::vector{0.25, 0.5, 0.0}));
  EXPECT_EQ(trajectory.points, 7u);
  EXPECT_EQ(trajectory.time->lower, 0.5);
  EXPECT_EQ(trajectory.time->upper, 3.0);
}

TEST(ReadTrajectory, OfAFileIsAsItIsUnlessPointsOrTimeAreAsked) {
  const Study own = study_of(study_with("{ file = \"curve.csv\" }"));
  EXPECT_EQ(own.poses.trajectory->points, 0u);
  EXPECT_FALSE(own.poses.trajectory->time);
  EXPECT_EQ(own.poses.count, 3u);
  EXPECT_EQ(own.poses.trajectory->from_file.time, (std::vector{0.0, 1.0, 2.0}));
  const Trajectory points = trajectory_of("{ file = \"curve.csv\", points = 11 }");
  EXPECT_EQ(points.points, 11u);
  EXPECT_EQ(points.time->upper, 2.0);
  const Trajectory time = trajectory_of("{ file = \"curve.csv\", time = [\"0.5 s\", \"2 s\"] }");
  EXPECT_EQ(time.points, 201u);
  EXPECT_EQ(time.time->lower, 0.5);
}

TEST(ReadTrajectoryToEvaluate, OpensNoFileAndMayLackAll) {
  EXPECT_EQ(trajectory_of("{ file = \"absent.csv\", points = 5 }", StudyUse::evaluate).points, 5u);
  std::string text = study_with("");
  text.erase(text.find("trajectory = \n"));
  EXPECT_FALSE(study_of(text, StudyUse::evaluate).poses.trajectory);
  EXPECT_THROW(trajectory_of("{ curve = \"wavy\" }", StudyUse::evaluate), InputError);
}

class ResolvedTrajectory : public testing::TestWithParam<std::string> {};

TEST_P(ResolvedTrajectory, ReadsBackToTheSame) {
  for (const StudyUse use : {StudyUse::run, StudyUse::evaluate}) {
    const Study study = study_of(study_with(GetParam()), use);
    const std::string text = resolved_text(study);
    const Study again = study_of(text, use);
    EXPECT_EQ(resolved_text(again), text);
    const Trajectory& a = *study.poses.trajectory;
    const Trajectory& b = *again.poses.trajectory;
    EXPECT_EQ(a.curve, b.curve);
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.file, b.file);
    EXPECT_EQ(a.points, b.points);
    ASSERT_EQ(a.time.has_value(), b.time.has_value());
    if (a.time) {
      EXPECT_EQ(std::pair(a.time->lower, a.time->upper), std::pair(b.time->lower, b.time->upper));
    }
    EXPECT_EQ(study.poses.count, again.poses.count);
    EXPECT_EQ(study.poses.max_condition, again.poses.max_condition);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, ResolvedTrajectory,
    testing::Values("{ curve = \"wave\" }\nmax_condition = 1234.5",
                    "{ curve = \"wave\", origin = [\"0.1234567890123456 mm\", \"11.3 deg\", \"0 rad\"], points = 2, "
                    "time = [\"333 ms\", \"0.0123 min\"] }",
                    "{ file = \"curve.csv\" }", "{ file = \"curve.csv\", points = 12 }",
                    "{ file = \"curve.csv\", time = [\"0.1 s\", \"1.7 s\"] }"),
    test::named({"Curve", "CurveWithOrigin", "File", "FileWithPoints", "FileWithTime"}));

struct Bad {
  const char* name;
  std::string trajectory;  ///< a ^ marks the place of the mistake
  std::vector<std::string> words;
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

const auto kName = [](const auto& info) { return std::string(info.param.name); };

class BadTrajectoryStudy : public testing::TestWithParam<Bad> {};

TEST_P(BadTrajectoryStudy, IsRefused) {
  const test::TempFolder folder;
  const Catalog catalog = test::fake_catalog();
  folder.write("curve.csv", kFile);
  const test::Marked bad(study_with(GetParam().trajectory));
  const std::string path = folder.write("study.toml", bad.text);
  test::expect_input_error([&] { read_study(path, catalog, StudyUse::run); }, {path, bad.line, bad.column},
                           GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadTrajectoryStudy,
    testing::Values(
        Bad{"Neither", "^{ points = 3 }", {"neither curve nor file", "write one of them"}},
        Bad{"Both", "^{ curve = \"wave\", file = \"curve.csv\" }", {"both curve and file"}},
        Bad{"UnknownKey", "{ curve = \"wave\", ^colour = 1 }", {"'colour'", "poses.trajectory"}},
        Bad{"UnknownCurve", "{ curve = ^\"spiral\" }", {"'spiral'", "known: wave"}},
        Bad{"BareOrigin", "{ curve = \"wave\", origin = [^1, \"0 rad\", \"0 rad\"] }", {"bare number 1", "\"1 mm\""}},
        Bad{"ShortOrigin", "{ curve = \"wave\", origin = ^[\"1 mm\"] }", {"has 1 values", "depth, sum, difference"}},
        Bad{"OriginOfWrongDimension",
            "{ curve = \"wave\", origin = [\"1 mm\", ^\"1 mm\", \"0 rad\"] }",
            {"must be an angle"}},
        Bad{"OriginOfFile", "{ file = \"curve.csv\", ^origin = [] }", {"origin", "remove"}},
        Bad{"OnePoint", "{ curve = \"wave\", points = ^1 }", {"at least 2"}},
        Bad{"TooManyPoints", "{ curve = \"wave\", points = ^100000000 }", {"at most 10000000"}},
        Bad{"BareTime", "{ curve = \"wave\", time = [^0, \"1 s\"] }", {"bare number 0", "\"1 s\""}},
        Bad{"LengthAsTime", "{ curve = \"wave\", time = [^\"0 mm\", \"1 s\"] }", {"must be a time"}},
        Bad{"UnknownTimeUnit", "{ curve = \"wave\", time = [^\"0 fortnights\", \"1 s\"] }", {"fortnights", "ms"}},
        Bad{"OneTime", "{ curve = \"wave\", time = ^[\"1 s\"] }", {"has 1 values"}},
        Bad{"ReversedTime", "{ curve = \"wave\", time = ^[\"2 s\", \"1 s\"] }", {"from 2 s to 1 s", "start first"}},
        Bad{"EmptyTime",
            "{ curve = \"wave\", time = ^[\"1 s\", \"1000 ms\"] }",
            {"from 1 s to 1000 ms", "an end after it"}},
        Bad{"TimeOutsideCurve", "{ curve = \"wave\", time = ^[\"0 s\", \"5 s\"] }", {"curve 'wave' has 0 s to 4 s"}},
        Bad{"TimeOutsideFile",
            "{ file = \"curve.csv\", time = ^[\"-1 s\", \"1 s\"] }",
            {"from -1 s to 1 s", "curve.csv has 0 s to 2 s"}},
        Bad{"Count", "{ curve = \"wave\" }\n^count = 3", {"poses.count", "\"trajectory\"", "remove"}},
        Bad{"Workspace", "{ curve = \"wave\" }\n^workspace = { }", {"poses.workspace", "\"trajectory\""}},
        Bad{"Limits", "{ curve = \"wave\" }\n^limits = { }", {"poses.limits", "\"trajectory\""}},
        Bad{"File", "{ curve = \"wave\" }\n^file = \"p.csv\"", {"poses.file", "\"trajectory\""}},
        Bad{"NotASection", "^\"wave\"", {"the text 'wave'"}}),
    kName);

TEST(BadTrajectory, IsMissing) {
  std::string text = study_with("");
  text.erase(text.find("trajectory = \n"));
  try {
    study_of(text);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(":5:1: key 'trajectory' is missing"), std::string::npos) << error.what();
  }
}

TEST(BadTrajectory, NamesACurveOfAModelWithoutCurves) {
  Catalog catalog = test::fake_catalog();
  catalog.front().description.curves.clear();
  try {
    study_of(study_with("{ curve = \"wave\" }"), StudyUse::run, catalog);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("model \"fake\" has no curves; "), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace poesy
