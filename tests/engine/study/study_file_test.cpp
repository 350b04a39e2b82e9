#include "engine/kinds/study_file.h"

#include <gtest/gtest.h>

#include <numbers>

#include "tests/engine/study/valid_study.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Study study_of(std::string_view text, StudyUse use = StudyUse::run) {
  const test::TempFolder folder;
  return read_study(folder.write("study.toml", text), test::kFakeCatalog, use);
}

/// The text of the valid study with one passage replaced.
std::string changed(const std::string& passage, const std::string& replacement) {
  std::string text(test::kValidStudy);
  const std::size_t begin = text.find(passage);
  if (begin == std::string::npos) throw std::logic_error("not in the valid study: " + passage);
  return text.replace(begin, passage.size(), replacement);
}

TEST(ReadStudy, TakesEveryValue) {
  const Study study = study_of(test::kValidStudy);
  EXPECT_EQ(study.title, "A study");
  EXPECT_EQ(study.model().name, "fake");
  EXPECT_EQ(study.mechanism.geometry, (std::vector<double>{0.06}));
  EXPECT_EQ(study.poses.select, PoseSelection::Select::interior);
  EXPECT_EQ(study.poses.count, 20u);
  ASSERT_EQ(study.poses.workspace.size(), 3u);
  EXPECT_DOUBLE_EQ(study.poses.workspace[0].lower, -0.3);
  EXPECT_EQ(study.poses.workspace[0].upper, -0.18);
  EXPECT_EQ(study.poses.workspace[1].lower, -0.5);
  EXPECT_DOUBLE_EQ(study.poses.workspace[2].upper, 10 * kDegree);
  ASSERT_EQ(study.errors.by_factor.size(), 3u);
  EXPECT_EQ(study.errors.by_factor[0].shape(), Distribution::Shape::normal);
  EXPECT_EQ(study.errors.by_factor[0].sigma(), 1e-3);
  EXPECT_EQ(study.errors.by_factor[1].shape(), Distribution::Shape::uniform);
  EXPECT_DOUBLE_EQ(study.errors.by_factor[1].half_width(), 0.5 * kDegree);
  EXPECT_EQ(study.errors.by_factor[2].shape(), Distribution::Shape::truncated_normal);
  EXPECT_EQ(study.errors.by_factor[2].half_width(), 2e-3);
  EXPECT_EQ(study.analysis.kind, &sensitivity::kStudy);
  EXPECT_EQ(study.analysis.factors, (std::vector<FactorIndex>{FactorIndex(1), FactorIndex(0)}));
  EXPECT_EQ(study.analysis.samples, 100u);
  EXPECT_EQ(study.analysis.conf_level, 0.9);
  ASSERT_TRUE(study.analysis.background);
  EXPECT_EQ(study.analysis.background->factors, (std::vector<FactorIndex>{FactorIndex(2)}));
  EXPECT_EQ(study.analysis.background->linear, 1e-3);
  EXPECT_DOUBLE_EQ(study.analysis.background->angular, kDegree);
  EXPECT_EQ(study.solver.method, SolverOptions::Method::gauss_newton);
  EXPECT_EQ(study.solver.tolerance, 1e-14);
  EXPECT_EQ(study.solver.max_iterations, 30);
  EXPECT_EQ(study.not_converged, NotConverged::include);
  EXPECT_EQ(study.seed, 5u);
}

constexpr std::string_view kShortest =
    "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\ncount = 3\n";

TEST(ReadStudy, FillsInDefaults) {
  const Study study = study_of(kShortest);
  EXPECT_EQ(study.title, "");
  EXPECT_EQ(study.mechanism.geometry, (std::vector<double>{test::FakeModel::kArm}));
  EXPECT_EQ(study.poses.select, PoseSelection::Select::interior);
  ASSERT_EQ(study.poses.workspace.size(), 3u);
  EXPECT_EQ(study.poses.workspace[2].upper, 0.6);
  EXPECT_TRUE(study.poses.limits.empty());
  EXPECT_EQ(study.poses.max_condition, 1e8);
  EXPECT_EQ(study.errors.by_factor[0].sigma(), 1e-3);
  EXPECT_DOUBLE_EQ(study.errors.by_factor[1].sigma(), kDegree);
  EXPECT_EQ(study.analysis.factors, (std::vector<FactorIndex>{FactorIndex(0), FactorIndex(1)}));
  EXPECT_EQ(study.analysis.samples, 1000u);
  EXPECT_EQ(study.analysis.conf_level, 0.95);
  EXPECT_FALSE(study.analysis.background);
  EXPECT_EQ(study.solver.tolerance, 1e-15);
  EXPECT_EQ(study.solver.max_iterations, 50);
  EXPECT_EQ(study.not_converged, NotConverged::exclude);
  EXPECT_EQ(study.max_not_converged, 1.0);
  EXPECT_EQ(study.seed, 1u);
}

TEST(ReadStudy, VariesAllFactorsWhereTheModelHasNoDeformingSet) {
  Catalog catalog = test::kFakeCatalog;
  catalog[0].description.factor_sets.clear();
  const test::TempFolder folder;
  const Study study = read_study(folder.write("study.toml", kShortest), catalog, StudyUse::run);
  EXPECT_EQ(study.analysis.factors.size(), 3u);
}

TEST(ReadStudy, TakesTheGreatestSeedAndWholeNumbersForNumbers) {
  EXPECT_EQ(study_of(changed("seed = 5", "seed = 9223372036854775807")).seed, 9223372036854775807u);
  EXPECT_EQ(study_of(changed("tolerance = 1e-14", "tolerance = 1")).solver.tolerance, 1.0);
}

TEST(ReadStudy, TakesLimitsInTheModelsOrderAndAGrid) {
  const PoseSelection poses =
      study_of(changed("\"interior\"\ncount = 20",
                       "\"grid\"\ncount = { gamma = 7, z = 1, beta = 5 }\nmax_condition = 1e6\n"
                       "limits = { q_2 = [\"-60 deg\", \"60 deg\"], q_1 = [\"-50 mm\", \"80 mm\"] }"))
          .poses;
  EXPECT_EQ(poses.select, PoseSelection::Select::grid);
  EXPECT_EQ(poses.grid_counts, (std::vector<std::size_t>{1, 5, 7}));
  EXPECT_EQ(poses.count, 35u);
  EXPECT_EQ(poses.max_condition, 1e6);
  ASSERT_EQ(poses.limits.size(), 2u);
  EXPECT_EQ(poses.limits[0].joint, 0u);
  EXPECT_EQ(poses.limits[0].range.lower, -0.05);
  EXPECT_EQ(poses.limits[0].range.upper, 0.08);
  EXPECT_EQ(poses.limits[0].place.line, 13u);
  EXPECT_EQ(poses.limits[1].joint, 1u);
  EXPECT_DOUBLE_EQ(poses.limits[1].range.upper, 60 * kDegree);
  EXPECT_EQ(poses.count_place.line, 11u);
}

TEST(ReadStudy, FindsThePoseFileBesideTheStudy) {
  const test::TempFolder folder;
  const std::string poses = folder.write("my poses.csv", "z,beta,gamma\n-0.2,0,0.1\n-0.25,0,0\n");
  const std::string path = folder.write("study.toml",
                                        "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n"
                                        "[poses]\nselect = \"file\"\nfile = \"my poses.csv\"\n");
  const Study study = read_study(path, test::kFakeCatalog, StudyUse::run);
  EXPECT_EQ(study.poses.file, "my poses.csv");
  EXPECT_EQ(study.poses.from_file.points.column(0), (std::vector<double>{-0.2, -0.25}));
  EXPECT_EQ(to_string(study.poses.place), poses + ":2:1");
  folder.write("my poses.csv", "z,beta,gamma\n-0.2,0,zero\n");
  test::expect_input_error([&] { read_study(path, test::kFakeCatalog, StudyUse::run); }, {poses, 2, 8}, {"'zero'"});
  std::filesystem::remove(poses);
  EXPECT_THROW(read_study(path, test::kFakeCatalog, StudyUse::run), FileError);
  EXPECT_EQ(read_study(path, test::kFakeCatalog, StudyUse::evaluate).poses.file, "my poses.csv");
}

TEST(ReadStudyToEvaluate, NeedsTheMechanismOnly) {
  const Study study =
      study_of("format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n", StudyUse::evaluate);
  EXPECT_EQ(study.model().name, "fake");
  EXPECT_EQ(study.solver.max_iterations, 50);
}

TEST(ReadStudyToEvaluate, NeedsTheNameOfAFileOfPoses) {
  const std::string text =
      "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\nselect = \"file\"\n";
  EXPECT_THROW(study_of(text, StudyUse::evaluate), InputError);
  EXPECT_EQ(study_of(text + "file = \"p.csv\"\n", StudyUse::evaluate).poses.file, "p.csv");
}

TEST(ReadStudyToEvaluate, PassesOverKeysOfAnotherKind) {
  const std::string text = changed("kind = \"sensitivity\"", "kind = \"sensitivity\"\ngroups = []\nsources = []");
  EXPECT_FALSE(study_of(text, StudyUse::evaluate).analysis.asked.has_value());
}

TEST(ReadStudyToEvaluate, TakesKindsAndPosesThatCannotBeRunYet) {
  for (const std::string select : {"boundary", "grid"}) {
    const std::string text = changed("\"interior\"", "\"" + select + "\"");
    EXPECT_EQ(name(study_of(text, StudyUse::evaluate).poses.select), select);
  }
  for (const std::string kind : {"identification", "evaluate", "monte-carlo"}) {
    const std::string text = changed("\"sensitivity\"", "\"" + kind + "\"");
    EXPECT_EQ(study_of(text, StudyUse::evaluate).analysis.kind->name, kind);
  }
  study_of(changed("kind = \"sensitivity\"",
                   "kind = \"evaluate\"\ncases = [{ name = \"group 1\", errors = { linear = \"1 mm\", angular = "
                   "\"1 deg\", delta_1 = \"0.01 mm\" } }]"),
           StudyUse::evaluate);
}

/// The message with which this standard deviation of linear errors is refused. Empty if it is accepted.
std::string refusal_of_sigma(const std::string& sigma) {
  const std::string errors = "[errors]\nlinear = { distribution = \"normal\", sigma = \"" + sigma + "\" }\n";
  try {
    study_of_text("format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n[poses]\ncount = 3\n" + errors,
                  "study.toml", test::kFakeCatalog, StudyUse::run);
    return {};
  } catch (const InputError& error) {
    return error.what();
  }
}

/// No unit of another size is proposed for an unknown unit, even if only one letter differs: 8 dm would become 8 m.
TEST(ReadStudy, GuessesNoUnitOfAnotherSize) {
  for (const std::string unit : {"dm", "km", "nm", "pm", "em", "mn", "mmm", "foot", "grad", "x"}) {
    const std::string said = refusal_of_sigma("8 " + unit);
    EXPECT_NE(said.find("unknown unit '" + unit + "'"), std::string::npos) << said;
    EXPECT_EQ(said.find("did you mean"), std::string::npos) << said;
    EXPECT_EQ(said.find("arcsec"), std::string::npos) << said << ": lists units of another dimension";
  }
  EXPECT_NE(refusal_of_sigma("8 MM").find("did you mean 'mm'?"), std::string::npos);
  EXPECT_EQ(refusal_of_sigma("1 cm"), "");
  EXPECT_EQ(refusal_of_sigma("1 \xC2\xB5m"), "");
  EXPECT_NE(refusal_of_sigma("1 \xC2\xB0").find("must be a length"), std::string::npos);
  EXPECT_NE(refusal_of_sigma("0,08 mm").find("decimal comma; write a decimal point"), std::string::npos);
  EXPECT_NE(refusal_of_sigma("1e-999 mm").find("too small"), std::string::npos);
}

TEST(ReadStudy, TakesNamesOfMechanismsInCapitals) {
  const std::string study =
      "format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"Fake\"\n[poses]\ncount = 3\n";
  EXPECT_EQ(study_of_text(study, "study.toml", test::kFakeCatalog, StudyUse::run).model().name, "fake");
}

TEST(ReadStudy, TellsAFolderFromAMissingFile) {
  const test::TempFolder folder;
  test::expect_input_error([&] { read_study(folder.file("."), test::kFakeCatalog, StudyUse::run); },
                           {folder.file("."), 0, 0}, {"folder", "not a study"});
  EXPECT_THROW(read_study(folder.file("none.toml"), test::kFakeCatalog, StudyUse::run), FileError);
}

TEST(ReadStudy, RefusesAFileTooLarge) {
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", std::string(2 << 20, '\n'));
  test::expect_input_error([&] { read_study(path, test::kFakeCatalog, StudyUse::run); }, {path, 0, 0},
                           {"1048576 bytes"});
}

TEST(ReadStudy, RefusesTooManyCellsAcrossFactors) {
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", changed("count = 20", "count = 5000001"));
  test::expect_input_error([&] { read_study(path, test::kFakeCatalog, StudyUse::run); }, {path, 9, 1},
                           {"poses times factors", "10000000"});
}

struct BadStudy {
  const char* name;
  std::string passage;      ///< a passage of the valid study; empty: the replacement is the whole file
  std::string replacement;  ///< text in place of the passage; a ^ marks the place of the mistake
  std::vector<std::string> words;
};

void PrintTo(const BadStudy& bad, std::ostream* out) { *out << bad.name; }

class BadStudies : public testing::TestWithParam<BadStudy> {};

TEST_P(BadStudies, AreRefused) {
  const BadStudy& parameter = GetParam();
  const test::Marked bad(parameter.passage.empty() ? parameter.replacement
                                                   : changed(parameter.passage, parameter.replacement));
  const test::TempFolder folder;
  const std::string path = folder.write("study.toml", bad.text);
  test::expect_input_error([&] { read_study(path, test::kFakeCatalog, StudyUse::run); }, {path, bad.line, bad.column},
                           parameter.words);
}

const auto kName = [](const auto& info) { return std::string(info.param.name); };

INSTANTIATE_TEST_SUITE_P(
    File, BadStudies,
    testing::Values(BadStudy{"Empty", "", "^", {"empty", "poesy template"}},
                    BadStudy{"OnlyBlank", "", "^\n \t\r\n", {"empty"}},
                    BadStudy{"OnlyComment", "", "^# nothing\n", {"'format' is missing"}},
                    BadStudy{"BinaryRubbish",
                             "",
                             std::string("\x7F"
                                         "ELF\x02\x01^\x00\xFF\xFE",
                                         10),
                             {"not TOML"}},
                    BadStudy{"InvalidUtf8", "\"A study\"", "\"A s^t\xC3\x28\"", {"not TOML", "UTF-8"}},
                    BadStudy{"OpenText", "\"A study\"\n", "^\"A study\n", {"is not closed on its line"}},
                    BadStudy{"NoValue", "count = 20\n", "count =^\n", {"not TOML"}},
                    BadStudy{"KeyTwice", "count = 20\n", "count = 20\ncount = ^21\n", {"not TOML", "count"}},
                    BadStudy{"NotClosed", "[solver]", "[solver^\n", {"not TOML"}},
                    BadStudy{"LongLine", "count = 20\n", "count = 20\n^# " + std::string(20000, 'x') + "\n", {"16384"}},
                    BadStudy{"DeepKey",
                             "count = 20\n",
                             "^count" +
                                 [] {
                                   std::string dots;
                                   for (int k = 0; k < 100000; ++k) dots += ".a";
                                   return dots;
                                 }() +
                                 " = 20\n",
                             {"16384"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Top, BadStudies,
    testing::Values(
        BadStudy{"NoFormat", "format = \"poesy-study\"", "^", {"'format' is missing", "poesy-study"}},
        BadStudy{"OtherFormat", "\"poesy-study\"", "^\"poesy-result\"", {"format is 'poesy-result'"}},
        BadStudy{"FormatNumber", "\"poesy-study\"", "^3", {"format is the whole number 3", "text in quotes"}},
        BadStudy{"NewerVersion", "version = 1", "version = ^2", {"version is 2", "newer poesy"}},
        BadStudy{"OlderVersion", "version = 1", "version = ^0", {"version is 0", "at least 1"}},
        BadStudy{"TextVersion", "version = 1", "version = ^\"1\"", {"version is the text '1'", "whole number"}},
        BadStudy{"UnknownSection", "[solver]", "[^slover]", {"unknown key 'slover'", "did you mean 'solver'?"}},
        BadStudy{"UnknownTopKey", "title = ", "^author = \"me\"\ntitle = ", {"unknown key 'author'", "known: "}},
        BadStudy{"ControlCharacterInKey", "title = ", "^\"a\\u001b\\nb\" = 1\ntitle = ", {"unknown key 'a??b'"}},
        BadStudy{"SectionIsNumber", "[run]\nseed = 5", "[solver.^run]", {"unknown key 'run' in [solver]"}},
        BadStudy{"TitleNumber", "\"A study\"", "^5", {"title is the whole number 5"}}),
    kName);

/// The valid study with this `select` and these other keys (rest) in [poses]. With "file" the workspace is commented
/// out.
BadStudy bad_poses(const char* name, const std::string& select, const std::string& rest,
                   std::vector<std::string> words) {
  return {name, "select = \"interior\"\ncount = 20\n",
          "select = \"" + select + "\"\n" + rest + (select == "file" ? " # " : "\n"), std::move(words)};
}

INSTANTIATE_TEST_SUITE_P(
    Workspace, BadStudies,
    testing::Values(
        bad_poses("UnknownJoint", "interior", "count = 9\nlimits = { ^q_3 = [\"0 mm\", \"1 mm\"] }",
                  {": unknown joint 'q_3' in [poses.limits]; did you mean 'q_1'?"}),
        bad_poses("LimitReversed", "boundary", "count = 9\nlimits = { q_1 = ^[\"8 mm\", \"-5 mm\"] }",
                  {": poses.limits.q_1 runs from 8 mm to -5 mm; write the lower end first, and two different ends"}),
        bad_poses("LimitOfOne", "grid", "count = 9\nlimits = { q_1 = ^[\"8 mm\"] }",
                  {": poses.limits.q_1 has 1 values; write the two ends of the range"}),
        bad_poses("LimitDimension", "interior", "count = 9\nlimits = { q_2 = [\"-60 deg\", ^\"60 mm\"] }",
                  {": poses.limits.q_2[1] is '60 mm', but must be an angle; write it like \"1 deg\""}),
        bad_poses("LimitBare", "interior", "count = 9\nlimits = { q_1 = [^-50, \"80 mm\"] }",
                  {": poses.limits.q_1[0] is the bare number -50; write it with a unit, e.g. \"1 mm\""}),
        bad_poses("LimitsList", "interior", "count = 9\nlimits = ^[]",
                  {": poses.limits is a list; write a section [poses.limits] or { key = value }"}),
        bad_poses("MaxConditionOne", "interior", "count = 9\nmax_condition = ^1",
                  {": poses.max_condition is 1; it must be greater than 1, e.g. 1e6"}),
        bad_poses("MaxConditionText", "interior", "count = 9\nmax_condition = ^\"1e6\"",
                  {": poses.max_condition is the text '1e6'; write a number without a unit"}),
        bad_poses("MaxConditionInfinite", "interior", "count = 9\nmax_condition = ^inf",
                  {": poses.max_condition is not finite; write a finite number"}),
        bad_poses("GridZero", "grid", "count = { z = 2, beta = ^0, gamma = 2 }",
                  {": poses.count.beta is 0; it must be at least 1"}),
        bad_poses("GridIncomplete", "grid", "count = ^{ z = 2, beta = 3 }",
                  {": key 'gamma' is missing in [poses.count]; give a number for every pose coordinate of the model"}),
        bad_poses("GridUnknown", "grid", "count = { z = 2, ^bata = 3, gamma = 1 }",
                  {": unknown pose coordinate 'bata' in [poses.count]; did you mean 'beta'?"}),
        bad_poses("GridHuge", "grid", "count = ^{ z = 10000000, beta = 10000000, gamma = 10000000 }",
                  {": poses.count makes a grid of more than 10000000 poses; write smaller numbers"}),
        bad_poses("LimitsOfFile", "file", "file = \"p.csv\"\n^limits = { q_1 = [\"0 mm\", \"1 mm\"] }",
                  {": poses.limits does not belong to select = \"file\"; remove it"}),
        bad_poses("MaxConditionOfFile", "file", "file = \"p.csv\"\n^max_condition = 10",
                  {": poses.max_condition does not belong to select = \"file\"; remove it"})),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Mechanism, BadStudies,
    testing::Values(
        BadStudy{"NoSection", "", "^format = \"poesy-study\"\nversion = 1\n", {"'mechanism' is missing"}},
        BadStudy{"NotASection",
                 "",
                 "format = \"poesy-study\"\nversion = 1\nmechanism = ^\"fake\"\n",
                 {"mechanism is the text 'fake'", "[mechanism]"}},
        BadStudy{"NoModel", "[mechanism]\nmodel = \"fake\"", "^[mechanism]", {"'model' is missing in [mechanism]"}},
        BadStudy{"UnknownModel", "\"fake\"", "^\"faek\"", {"mechanism.model is 'faek'", "did you mean 'fake'?"}},
        BadStudy{"UnknownKey", "model = \"fake\"", "^modle = \"fake\"", {"'modle' in [mechanism]", "'model'?"}},
        BadStudy{"UnknownParameter", "arm =", "^arn =", {"unknown parameter 'arn'", "did you mean 'arm'?"}},
        BadStudy{"BareGeometry", "\"60 mm\"", "^60", {"mechanism.geometry.arm is the bare number 60", "\"1 mm\""}},
        BadStudy{"GeometryAngle", "\"60 mm\"", "^\"60 deg\"", {"'60 deg'", "must be a length"}},
        BadStudy{"ImpossibleGeometry",
                 "{ arm = \"60 mm\" }",
                 "^{ arm = \"-60 mm\" }",
                 {"impossible geometry", "arm must be greater than zero"}},
        BadStudy{"Fidelity", "model = \"fake\"", "model = \"fake\"\n^fidelity = \"exact\"", {"fidelity", "remove"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Poses, BadStudies,
    testing::Values(
        BadStudy{"NoSection",
                 "",
                 "^format = \"poesy-study\"\nversion = 1\n[mechanism]\nmodel = \"fake\"\n",
                 {"'poses' is missing"}},
        BadStudy{"NoCount", "[poses]\nselect = \"interior\"\ncount = 20\n", "^[poses]\n", {"'count' is missing"}},
        BadStudy{"CountZero", "count = 20", "count = ^0", {"poses.count is 0", "at least 1"}},
        BadStudy{"CountNegative", "count = 20", "count = ^-3", {"poses.count is -3", "at least 1"}},
        BadStudy{"CountHuge", "count = 20", "count = ^9223372036854775807", {"poses.count", "at most 10000000"}},
        BadStudy{"CountTooLargeForToml", "count = 20", "count = 9223372036854775808^", {"not TOML"}},
        BadStudy{"CountFraction", "count = 20", "count = ^20.5", {"poses.count is the number 20.5", "whole number"}},
        BadStudy{"CountText", "count = 20", "count = ^\"20\"", {"poses.count is the text '20'"}},
        BadStudy{"CountsOfInterior",
                 "count = 20",
                 "count = ^{ z = 2, beta = 2, gamma = 2 }",
                 {"poses.count is a section; write a whole number"}},
        BadStudy{"UnknownSelect", "\"interior\"", "^\"exterior\"", {"'exterior'", "did you mean 'interior'?"}},
        BadStudy{"FileBesideInterior", "count = 20", "count = 20\n^file = \"p.csv\"", {"poses.file", "interior"}},
        BadStudy{"CountBesideFile",
                 "select = \"interior\"\n",
                 "select = \"file\"\nfile = \"p.csv\"\n^",
                 {"poses.count", "\"file\"", "remove"}},
        BadStudy{"NoFile",
                 "select = \"interior\"\ncount = 20\nworkspace",
                 "select = \"file\"\n^workspace",
                 {"poses.workspace", "\"file\""}},
        BadStudy{"TrajectoryBesideInterior", "count = 20", "count = 20\n^trajectory = { }", {"poses.trajectory"}},
        BadStudy{"ReversedRange",
                 "z = [\"-300 mm\", \"-0.18 m\"]",
                 "z = ^[\"-0.18 m\", \"-300 mm\"]",
                 {"poses.workspace.z runs from -0.18 m to -300 mm", "lower end first"}},
        BadStudy{"EmptyRange",
                 "[\"-0.5 rad\", \"0.5 rad\"]",
                 "^[\"0.5 rad\", \"500 mrad\"]",
                 {"two different ends; a narrow range, or a grid with one point"}},
        BadStudy{"RangeOfThree", "[\"-0.5 rad\", \"0.5 rad\"]", "^[\"-1 rad\", \"0 rad\", \"1 rad\"]", {"3 values"}},
        BadStudy{"RangeNotAList",
                 "[\"-0.5 rad\", \"0.5 rad\"]",
                 "^\"0.5 rad\"",
                 {"poses.workspace.beta is the text '0.5 rad'"}},
        BadStudy{"BareRange",
                 "[\"-0.5 rad\", ",
                 "[^-0.5, ",
                 {"poses.workspace.beta[0] is the bare number -0.5", "\"1 deg\""}},
        BadStudy{"RangeOfLengths", "\"0.5 rad\"]", "^\"0.5 mm\"]", {"poses.workspace.beta[1]", "an angle"}},
        BadStudy{"MissingCoordinate", "{ z = [\"-300 mm\", \"-0.18 m\"], ", "^{ ", {"'z' is missing"}},
        BadStudy{"UnknownCoordinate", "{ z =", "{ ^x =", {"unknown pose coordinate 'x'"}},
        BadStudy{"WorkspaceList", "workspace = {", "workspace = ^[] #", {"poses.workspace is a list"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Errors, BadStudies,
    testing::Values(
        BadStudy{"BareSigma",
                 "sigma = \"1 mm\" }\nangular",
                 "sigma = ^1 }\nangular",
                 {"errors.linear.sigma is the bare number 1", "\"1 mm\""}},
        BadStudy{"UnknownUnit",
                 "\"1 mm\" }\nangular",
                 "^\"1 mn\" }\nangular",
                 {"unknown unit 'mn'", "(known: m, cm, mm, um, in, mil, thou); write"}},
        BadStudy{"ForeignUnit",
                 "\"1 mm\" }\nangular",
                 "^\"1 foot\" }\nangular",
                 {"unknown unit 'foot'", "(known: m, cm, mm, um, in, mil, thou); write"}},
        BadStudy{"NoUnit", "\"1 mm\" }\nangular", "^\"1\" }\nangular", {"'1' has no unit"}},
        BadStudy{
            "NoNumber", "\"1 mm\" }\nangular", "^\"one mm\" }\nangular", {"'one mm'", "write a number and a unit"}},
        BadStudy{"EmptyQuantity", "\"1 mm\" }\nangular", "^\"\" }\nangular", {"''"}},
        BadStudy{"NanQuantity", "\"1 mm\" }\nangular", "^\"nan mm\" }\nangular", {"finite"}},
        BadStudy{"WrongDimension", "\"1 mm\" }\nangular", "^\"1 deg\" }\nangular", {"'1 deg'", "must be a length"}},
        BadStudy{"WrongType", "\"1 mm\" }\nangular", "^true }\nangular", {"errors.linear.sigma is true"}},
        BadStudy{"Date", "\"1 mm\" }\nangular", "^2020-01-01 }\nangular", {"a date or time"}},
        BadStudy{"NegativeSigma", "\"1 mm\" }\nangular", "^\"-1 mm\" }\nangular", {"'-1 mm'", "greater than zero"}},
        BadStudy{"ZeroSigma", "\"1 mm\" }\nangular", "^\"0 mm\" }\nangular", {"'0 mm'", "greater than zero"}},
        BadStudy{"UnderflowSigma", "\"1 mm\" }\nangular", "^\"1e-323 um\" }\nangular", {"greater than zero"}},
        BadStudy{"ZeroHalfWidth", "\"0.5 deg\"", "^\"0 deg\"", {"errors.angular.half_width", "greater than zero"}},
        BadStudy{"UnknownDistribution", "\"normal\"", "^\"beta\"", {"'beta'", "known: normal"}},
        BadStudy{"OtherDistribution", "\"normal\"", "^\"gaussian\"", {"'gaussian'", "did you mean 'normal'?"}},
        BadStudy{"MisspeltDistribution", "\"normal\"", "^\"noraml\"", {"did you mean 'normal'?"}},
        BadStudy{"NoDistribution", "{ distribution = \"normal\", sigma", "^{ sigma", {"'distribution' is missing"}},
        BadStudy{"NoSigma",
                 "{ distribution = \"normal\", sigma = \"1 mm\" }",
                 "^{ distribution = \"normal\" }",
                 {"'sigma' is missing in [errors.linear]", "normal"}},
        BadStudy{"HalfWidthOfNormal",
                 "\"normal\", sigma",
                 "\"normal\", ^half_width = \"1 mm\", sigma",
                 {"errors.linear.half_width does not belong", "\"normal\""}},
        BadStudy{"MisspeltSigma", "\"normal\", sigma", "\"normal\", ^sgima", {"'sgima'", "did you mean 'sigma'?"}},
        BadStudy{"NotASection",
                 "linear = { distribution = \"normal\", sigma = \"1 mm\" }",
                 "linear = ^\"1 mm\"",
                 {"errors.linear is the text '1 mm'"}},
        BadStudy{"UnknownKey", "angular = { dist", "^angle = { dist", {"unknown key 'angle' in [errors]"}},
        BadStudy{"UnknownFactor", "{ delta_2 =", "{ ^delta_3 =", {"unknown factor 'delta_3'", "did you mean"}},
        BadStudy{"OverrideDimension",
                 "half_width = \"2 mm\"",
                 "half_width = ^\"2 deg\"",
                 {"errors.override.delta_2.half_width", "must be a length"}}),
    kName);

INSTANTIATE_TEST_SUITE_P(
    Analysis, BadStudies,
    testing::Values(
        BadStudy{"SamplesOne", "samples = 100", "samples = ^1", {"analysis.samples is 1", "at least 2"}},
        BadStudy{"SamplesHuge", "samples = 100", "samples = ^1000000000000001", {"at most 1000000000000000"}},
        BadStudy{"TooManySolves",
                 "[analysis]\nkind = \"sensitivity\"\nfactors = [\"epsilon_1\", \"delta_1\"]\nsamples = 100",
                 "^[analysis]\nsamples = 500000000000000",
                 {"poses times factors times samples", "fewer samples"}},
        BadStudy{"SamplesFraction", "samples = 100", "samples = ^100.0", {"analysis.samples is the number 100"}},
        BadStudy{"UnknownKind", "\"sensitivity\"", "^\"sensibility\"", {"did you mean 'sensitivity'?"}},
        BadStudy{"Cases", "samples = 100", "samples = 100\n^cases = []", {"analysis.cases", "\"sensitivity\""}},
        BadStudy{"UnknownSet", "[\"epsilon_1\", \"delta_1\"]", "^\"deformin\"", {"did you mean 'deforming'?"}},
        BadStudy{
            "FactorAsSet", "[\"epsilon_1\", \"delta_1\"]", "^\"delta_1\"", {"a factor, not a set", "[\"delta_1\"]"}},
        BadStudy{"UnknownFactor", "\"delta_1\"]", "^\"dleta_1\"]", {"'dleta_1'", "did you mean 'delta_1'?"}},
        BadStudy{"DuplicateFactor",
                 "\"delta_1\"]",
                 "^\"epsilon_1\"]",
                 {"analysis.factors[1]", "'epsilon_1'", "second time"}},
        BadStudy{"NoFactors", "[\"epsilon_1\", \"delta_1\"]", "^[]", {"analysis.factors is empty"}},
        BadStudy{"FactorNumber", "\"delta_1\"]", "^7]", {"analysis.factors[1] is the whole number 7"}},
        BadStudy{"FactorsNumber", "[\"epsilon_1\", \"delta_1\"]", "^7", {"analysis.factors is the whole number 7"}},
        BadStudy{
            "ConfLevelOne", "conf_level = 0.9", "conf_level = ^1.0", {"analysis.conf_level is 1", "between 0 and 1"}},
        BadStudy{"ConfLevelPercent", "conf_level = 0.9", "conf_level = ^95", {"is 95", "0.95"}},
        BadStudy{"ConfLevelNan", "conf_level = 0.9", "conf_level = ^nan", {"not finite"}},
        BadStudy{"UnknownBackground", "\"benign\"", "^\"bening\"", {"analysis.background.factors", "'benign'?"}},
        BadStudy{"NoBackgroundFactors", "{ factors = \"benign\", linear", "^{ linear", {"'factors' is missing"}},
        BadStudy{
            "BackgroundBare", "linear = \"1 mm\", angular", "linear = ^1, angular", {"analysis.background.linear"}},
        BadStudy{"BackgroundKey", "linear = \"1 mm\", angular", "^lineal = \"1 mm\", angular", {"'linear'?"}}),
    kName);

/// The valid study with another kind and with these lines in [analysis].
std::string with_limits(const std::string& kind, const std::string& lines) {
  return changed("kind = \"sensitivity\"", "kind = \"" + kind + "\"\n" + lines);
}

TEST(StudyFile, TakesLimitsInTheOrderOfTheModelsResponses) {
  const Analysis by_rms =
      study_of(with_limits("monte-carlo",
                           "draws = \"per pose\"\nlimits = { linear_deformation = \"0.03 mm\", angular_deformation = "
                           "\"0.5 deg\" }"))
          .analysis;
  ASSERT_EQ(by_rms.limits.size(), 2u);
  EXPECT_EQ(by_rms.limits[0].response, 0u);
  EXPECT_DOUBLE_EQ(by_rms.limits[0].allowed.to(), 0.5 * kDegree);
  EXPECT_EQ(by_rms.limits[1].response, 1u);
  EXPECT_DOUBLE_EQ(by_rms.limits[1].allowed.to(), 0.03e-3);
  EXPECT_EQ(asked_of<monte_carlo::Options>(by_rms).judge, Judge::rms);
  const Analysis by_share =
      study_of(with_limits("monte-carlo", "judge = \"share\"\nshare = 0.9973\nlimits.linear_deformation = \"1 mm\""))
          .analysis;
  EXPECT_EQ(asked_of<monte_carlo::Options>(by_share).judge, Judge::share);
  EXPECT_EQ(asked_of<monte_carlo::Options>(by_share).share, 0.9973);
  EXPECT_TRUE(study_of(test::kValidStudy).analysis.limits.empty());
}

/// 'poesy evaluate' takes the limits of a study of any kind.
TEST(StudyFile, GivesItsLimitsToAnEvaluation) {
  const std::string text = changed("kind = \"sensitivity\"", "limits.linear_deformation = \"1 mm\"");
  EXPECT_EQ(study_of(text, StudyUse::evaluate).analysis.limits.size(), 1u);
}

BadStudy bad_limits(const char* name, const std::string& kind, const std::string& lines,
                    std::vector<std::string> words) {
  return {name, "kind = \"sensitivity\"", "kind = \"" + kind + "\"\n" + lines, std::move(words)};
}

INSTANTIATE_TEST_SUITE_P(
    Limits, BadStudies,
    testing::Values(
        bad_limits("OfASensitivityStudy", "sensitivity", "^limits.linear_deformation = \"1 mm\"",
                   {"analysis.limits does not belong to kind = \"sensitivity\""}),
        bad_limits("UnknownResponse", "monte-carlo", "limits = { ^linear_deformatoin = \"1 mm\" }",
                   {"unknown response 'linear_deformatoin' in [analysis.limits]",
                    "did you mean 'linear_deformation'?"}),
        bad_limits("LimitOfZero", "monte-carlo", "limits = { linear_deformation = ^\"0 mm\" }",
                   {"analysis.limits.linear_deformation is '0 mm'", "greater than zero"}),
        bad_limits("LimitOfTheWrongDimension", "monte-carlo", "limits = { linear_deformation = ^\"1 deg\" }",
                   {"analysis.limits.linear_deformation is '1 deg', but must be a length"}),
        bad_limits("NoLimits", "monte-carlo", "limits = ^{}", {"analysis.limits states no limit"}),
        bad_limits("UnknownJudge", "monte-carlo", "limits = { linear_deformation = \"1 mm\" }\njudge = ^\"median\"",
                   {"analysis.judge is 'median', which is unknown", "rms, share, yield"}),
        bad_limits("YieldOfDrawsPerPose", "monte-carlo",
                   "draws = \"per pose\"\nlimits = { linear_deformation = \"1 mm\" }\njudge = ^\"yield\"",
                   {"analysis.judge is \"yield\", but errors are drawn anew at each pose", "draws = \"per machine\""}),
        bad_limits("YieldForRms", "monte-carlo",
                   "draws = \"per pose\"\nlimits = { linear_deformation = \"1 mm\" }\nyield = ^0.99",
                   {"analysis.yield is set, but analysis.judge is \"rms\"", "draws = \"per machine\""}),
        bad_limits("YieldWithoutLimits", "monte-carlo", "draws = \"per machine\"\nyield = ^0.9",
                   {"analysis.yield is set, but the study states no limit"}),
        bad_limits("YieldOfTooFewMachines", "monte-carlo",
                   "draws = \"per machine\"\nlimits = { linear_deformation = \"1 mm\" }\nyield = ^0.99999",
                   {"machines cannot show at a confidence of 0.9 even if all of them are good", "230258 samples"}),
        bad_limits("UnknownDraws", "monte-carlo", "draws = ^\"per robot\"",
                   {"analysis.draws is 'per robot', which is unknown", "per pose, per machine"}),
        bad_limits("DrawsOfASensitivityStudy", "sensitivity", "^draws = \"per machine\"",
                   {"analysis.draws does not belong to kind = \"sensitivity\""}),
        bad_limits("JudgeWithoutLimits", "monte-carlo", "judge = ^\"rms\"",
                   {"analysis.judge is set, but the study states no limit", "[analysis.limits]"}),
        bad_limits("ShareWithoutItsNumber", "monte-carlo",
                   "limits = { linear_deformation = \"1 mm\" }\njudge = ^\"share\"",
                   {"analysis.judge is \"share\", but analysis.share is missing", "share = 0.9973"}),
        bad_limits("ShareOfAllDraws", "monte-carlo",
                   "limits = { linear_deformation = \"1 mm\" }\njudge = \"share\"\nshare = ^1.0",
                   {"analysis.share is 1", "between 0 and 1"}),
        bad_limits("ShareForRms", "monte-carlo",
                   "draws = \"per pose\"\nlimits = { linear_deformation = \"1 mm\" }\nshare = ^0.9973",
                   {"analysis.share is set, but analysis.judge is \"rms\""}),
        bad_limits("JudgeOfCases", "evaluate", "limits = { linear_deformation = \"1 mm\" }\n^judge = \"rms\"",
                   {"analysis.judge does not belong to kind = \"evaluate\""})),
    kName);

TEST(StudyFile, FailIsALimitOfZero) {
  const Study none = study_of(changed("not_converged = \"include\"", "not_converged = \"fail\""));
  EXPECT_EQ(none.not_converged, NotConverged::exclude);
  EXPECT_EQ(none.max_not_converged, 0.0);
  const Study some = study_of(changed("not_converged = \"include\"", "max_not_converged = 0.001"));
  EXPECT_EQ(some.not_converged, NotConverged::exclude);
  EXPECT_EQ(some.max_not_converged, 0.001);
}

INSTANTIATE_TEST_SUITE_P(
    SolverAndRun, BadStudies,
    testing::Values(
        BadStudy{"UnknownMethod", "\"gauss-newton\"", "^\"gauss\"", {"solver.method is 'gauss'"}},
        BadStudy{"ToleranceZero", "1e-14", "^0.0", {"solver.tolerance is 0", "greater than zero"}},
        BadStudy{"ToleranceNegative", "1e-14", "^-1e-14", {"solver.tolerance is -1e-14"}},
        BadStudy{"ToleranceInfinite", "1e-14", "^inf", {"solver.tolerance is not finite"}},
        BadStudy{
            "ToleranceQuantity", "1e-14", "^\"1e-14 m\"", {"solver.tolerance is the text '1e-14 m'", "without a unit"}},
        BadStudy{"NoIterations", "max_iterations = 30", "max_iterations = ^0", {"at least 1"}},
        BadStudy{"IterationsHuge", "max_iterations = 30", "max_iterations = ^3000000000", {"at most 2147483647"}},
        BadStudy{"UnknownPolicy", "\"include\"", "^\"ignore\"", {"solver.not_converged is 'ignore'", "exclude"}},
        BadStudy{"LimitAboveOne",
                 "not_converged = \"include\"",
                 "max_not_converged = ^1.5",
                 {"solver.max_not_converged is 1.5", "from 0 to 1"}},
        BadStudy{"LimitNegative",
                 "not_converged = \"include\"",
                 "max_not_converged = ^-0.1",
                 {"solver.max_not_converged is -0.1"}},
        BadStudy{"LimitText",
                 "not_converged = \"include\"",
                 "max_not_converged = ^\"0.1 %\"",
                 {"solver.max_not_converged is the text '0.1 %'"}},
        BadStudy{"LimitBesideFail",
                 "not_converged = \"include\"",
                 "not_converged = \"fail\"\n^max_not_converged = 0.1",
                 {"max_not_converged", "not_converged = \"fail\""}},
        BadStudy{"UnknownSolverKey", "tolerance =", "^tolerence =", {"did you mean 'tolerance'?"}},
        BadStudy{"SeedNegative", "seed = 5", "seed = ^-1", {"run.seed is -1", "at least 0"}},
        BadStudy{"SeedText", "seed = 5", "seed = ^\"5\"", {"run.seed is the text '5'"}},
        BadStudy{"UnknownRunKey", "seed = 5", "^sead = 5", {"did you mean 'seed'?"}}),
    kName);

}  // namespace
}  // namespace poesy
