#include "engine/study/table_file.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

const ModelDescription kModel = test::FakeModel::describe();
const test::FakeModel kMechanism;

PoseSet poses_of(std::string_view text) {
  const test::TempFolder folder;
  return read_poses(folder.write("poses.csv", text), kModel).points;
}

TEST(ReadPoses, ComesBackInTheModelsOrder) {
  const PoseSet poses = poses_of("gamma,z,beta\n0.3,-0.2,0.1\n0.4,-0.25,1e-1\n");
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_EQ(poses.column(0), (std::vector<double>{-0.2, -0.25}));
  EXPECT_EQ(poses.column(1), (std::vector<double>{0.1, 0.1}));
  EXPECT_EQ(poses.column(2), (std::vector<double>{0.3, 0.4}));
}

TEST(ReadPoses, ToleratesWhatProgramsWrite) {
  const std::vector<double> expected{-0.2, -0.25};
  EXPECT_EQ(poses_of("\xEF\xBB\xBFz,beta,gamma\r\n-0.2,0,0\r\n-0.25,0,0\r\n").column(0), expected);
  EXPECT_EQ(poses_of("z, beta\t, gamma\n  -0.2 , +0 ,0\n-0.25,0,0").column(0), expected);
  EXPECT_EQ(poses_of("z,beta,gamma\n-0.2,0,0\n-0.25,0,0\n\n  \r\n\n").column(0), expected);
}

TEST(ReadPoses, TheHeaderTellsTheCoordinates) {
  const test::TempFolder folder;
  const PoseTable table = read_poses(folder.write("poses.csv", "sum,difference,depth\n0.3,0.1,0.2\n"), kModel);
  EXPECT_EQ(table.chart, std::size_t{0});
  EXPECT_EQ(table.points.column(0), std::vector{0.2});
  EXPECT_EQ(table.points.column(1), std::vector{0.3});
  EXPECT_FALSE(read_poses(folder.write("own.csv", "z,beta,gamma\n-0.2,0,0\n"), kModel).chart);
}

TEST(ReadPoses, UnitsStandBehindTheNames) {
  const PoseSet poses = poses_of("z [mm],gamma[mrad], beta [rad] \n-200,300,0.1\n");
  EXPECT_EQ(poses.column(0), std::vector{-200 * 1e-3});
  EXPECT_EQ(poses.column(1), std::vector{0.1});
  EXPECT_EQ(poses.column(2), std::vector{300 * 1e-3});
}

TEST(ReadPoses, PassOverWhatAnExportSaysOfThem) {
  const std::vector<double> expected{-0.21875};
  EXPECT_EQ(poses_of("pose,z [m],beta [rad],gamma [rad],condition\n2,-0.21875,0.25,-0.5,inf\n").column(0), expected);
  EXPECT_EQ(poses_of("pose,time [s],z [m],beta [rad],gamma [rad]\n0,0,-0.21875,0,0\n").column(0), expected);
  EXPECT_EQ(poses_of("t,z,beta,gamma\n0,-0.21875,0,0\n").column(0), expected);
}

TEST(ReadTrajectory, TakesTheTimesOfAnExport) {
  const test::TempFolder folder;
  const std::string text = "pose,time [s],z [m],beta [rad],gamma [rad],condition\n0,0,1,2,3,9\n1,0.5,4,5,6,9\n";
  const TimedPoints points = read_trajectory(folder.write("c.csv", text), kModel);
  EXPECT_EQ(points.time, (std::vector{0.0, 0.5}));
  EXPECT_EQ(points.table.points.column(1), (std::vector{2.0, 5.0}));
  const TimedPoints slow = read_trajectory(folder.write("s.csv", "t [min],z,beta,gamma\n0,1,2,3\n2,4,5,6\n"), kModel);
  EXPECT_EQ(slow.time, (std::vector{0.0, 120.0}));
}

TEST(ReadTrajectory, TakesTimesFromAnyColumn) {
  const test::TempFolder folder;
  const TimedPoints own = read_trajectory(folder.write("c.csv", "gamma,t,z,beta\n3,-1,1,2\n6,0.5,4,5\n"), kModel);
  EXPECT_EQ(own.time, (std::vector{-1.0, 0.5}));
  EXPECT_FALSE(own.table.chart);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(own.table.points.column(c), (std::vector{1.0 + double(c), 4.0 + double(c)}));
  }
  const TimedPoints sums = read_trajectory(folder.write("s.csv", "t,depth,sum,difference\n0,1,2,3\n1,1,2,3\n"), kModel);
  EXPECT_EQ(sums.table.chart, std::size_t{0});
}

TEST(ReadErrors, TakesAnySubsetInAnyOrder) {
  const test::TempFolder folder;
  const ErrorTable table = read_errors(folder.write("e.csv", "delta_2,delta_1\n1,2\n3,4\n5,6\n"), kMechanism);
  EXPECT_EQ(table.factors, (std::vector<FactorIndex>{FactorIndex(2), FactorIndex(0)}));
  EXPECT_EQ(table.values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(table.rows, 3u);
}

TEST(ReadErrors, UnitsStandBehindTheNames) {
  const test::TempFolder folder;
  const ErrorTable table =
      read_errors(folder.write("e.csv", "delta_2 [\xC2\xB5m],epsilon_1 [mrad]\n12,3\n"), kMechanism);
  EXPECT_EQ(table.values, (std::vector{12 * 1e-6, 3 * 1e-3}));
}

TEST(ReadErrors, AColumnNamesTheRows) {
  const test::TempFolder folder;
  const ErrorTable parts = read_errors(folder.write("p.csv", "delta_2,part,delta_1\n1,17,2\n3, 18 b ,4\n"), kMechanism);
  EXPECT_EQ(parts.labels.column, "part");
  EXPECT_EQ(parts.labels.names, (std::vector<std::string>{"17", "18 b"}));
  EXPECT_EQ(parts.values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(parts.rows, 2u);
  EXPECT_EQ(read_errors(folder.write("n.csv", "name,delta_1\nx,0\n"), kMechanism).labels.column, "name");
}

TEST(ReadErrors, PassOverWhatAnExportSaysOfThem) {
  const test::TempFolder folder;
  for (const char* text :
       {"sample,delta_1 [m]\n0,0.25\n", "pose,delta_1 [m]\n0,0.25\n", "case,delta_1 [m]\n=a b,0.25\n"}) {
    const ErrorTable table = read_errors(folder.write("e.csv", text), kMechanism);
    EXPECT_EQ(table.values, std::vector{0.25});
    EXPECT_TRUE(table.labels.names.empty());
  }
}

TEST(ReadErrors, PassOverTexts) {
  const test::TempFolder folder;
  const ErrorTable table = read_errors(
      folder.write("e.csv", "part,operator,delta_1 [mm],remark\n17,B. Meier,250,-\n18,A,125,nan or so\n"), kMechanism);
  EXPECT_EQ(table.values, (std::vector{0.25, 0.125}));
  EXPECT_EQ(table.labels.names, (std::vector<std::string>{"17", "18"}));
}

std::vector<std::string> labels_in(const std::string& text) {
  const test::TempFolder folder;
  return read_errors(folder.write("e.csv", text), kMechanism).labels.names;
}

TEST(ReadErrors, TheColumnThatNamesRowsNeedsNoTitleOfOurs) {
  const std::vector<std::string> names{"FB-1", "FB-2"};
  for (const std::string title : {"Part No.", "part_no", "Teil", "Machine", "Prüfling"}) {
    EXPECT_EQ(labels_in(title + ",delta_1\nFB-1,0\nFB-2,0\n"), names) << title;
    EXPECT_EQ(labels_in("Inspector," + title + ",delta_1\nX,FB-1,0\nX,FB-2,0\n"), names) << title;
  }
  EXPECT_EQ(labels_in("remark,Part No.,delta_1\ngood,7,0\nbad,8,0\n"), (std::vector<std::string>{"7", "8"}));
  EXPECT_EQ(labels_in("remark,part,delta_1\ngood,7,0\nbad,8,0\n"), (std::vector<std::string>{"7", "8"}));
}

TEST(ReadErrors, TextsThatDoNotDifferNameNoRows) {
  EXPECT_TRUE(labels_in("Machine,delta_1\nM1,0\nM1,0\n").empty());
  EXPECT_TRUE(labels_in("Inspector,delta_1\nX,0\n,0\n").empty());
}

TEST(ReadErrors, OneRowHasANameByItsTitleOnly) {
  EXPECT_TRUE(labels_in("operator,delta_1\nBob,0\n").empty());
  EXPECT_EQ(labels_in("operator,delta_1\nBob,0\nEve,0\n"), (std::vector<std::string>{"Bob", "Eve"}));
  EXPECT_EQ(labels_in("operator,Machine,delta_1\nBob,M1,0\n"), (std::vector<std::string>{"M1"}));
}

TEST(ReadErrors, CellsMayBeInQuotes) {
  const test::TempFolder folder;
  const std::string text =
      "\"part\", \"delta_1 [mm]\" ,Inspector\r\n\"17\",\"250\",\"X, Mr.; \"\"Jim\"\"\"\n18, 125 ,Y \"Z\"\n";
  const ErrorTable table = read_errors(folder.write("e.csv", text), kMechanism);
  EXPECT_EQ(table.labels.names, (std::vector<std::string>{"17", "18"}));
  EXPECT_EQ(table.values, (std::vector{0.25, 0.125}));
}

struct BadTable {
  const char* name;
  std::string text;  ///< text of the table; a ^ marks the place of the mistake
  std::vector<std::string> words;
};

void PrintTo(const BadTable& bad, std::ostream* out) { *out << bad.name; }

const auto kName = [](const auto& info) { return std::string(info.param.name); };

class BadPoses : public testing::TestWithParam<BadTable> {};

TEST_P(BadPoses, AreRefused) {
  const test::TempFolder folder;
  const test::Marked bad(GetParam().text);
  const std::string path = folder.write("poses.csv", bad.text);
  test::expect_input_error([&] { read_poses(path, kModel); }, {path, bad.line, bad.column}, GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadPoses,
    testing::Values(
        BadTable{"Empty", "^", {"empty"}}, BadTable{"OnlyBlank", "^\n \r\n", {"empty"}},
        BadTable{"OnlyByteOrderMark", "^\xEF\xBB\xBF\n", {"empty"}},
        BadTable{"HeaderOnly", "z,beta,gamma\n^", {"no data"}},
        BadTable{"BlankFirstLine", "^\nz,beta,gamma\n0,0,0\n", {"has no name"}},
        BadTable{"MissingColumn", "^z,beta\n0,0\n", {"'gamma' is missing"}},
        BadTable{"ExtraColumn", "z,beta,gamma,^weight\n0,0,0,0\n", {"'weight'", "known: z, beta, gamma"}},
        BadTable{"MisspeltColumn", "z, ^bta,gamma\n0,0,0\n", {"'bta'", "did you mean 'beta'?"}},
        BadTable{"RepeatedColumn", "z,beta,^z,gamma\n0,0,0,0\n", {"'z'", "second time"}},
        BadTable{
            "NoHeader",
            "^0,0,0\n0,0,0\n",
            {"'0' is a number where the name of a column must be", "name the columns in the first line", "z [mm]"}},
        BadTable{"UnitInTheName", "^z_mm,beta,gamma\n0,0,0\n", {"write its unit in brackets: z [mm]"}},
        BadTable{"LargeLetter", "^Z,beta,gamma\n0,0,0\n", {"did you mean 'z'?"}},
        BadTable{"MixedCoordinates",
                 "^z,beta,difference\n0,0,0\n",
                 {"mix coordinates", "z,beta,gamma | depth,sum,difference"}},
        BadTable{"IncompleteChart", "^depth,sum\n0,0\n", {"'difference' is missing"}},
        BadTable{"UnknownUnit", "z,^beta [degree],gamma\n0,0,0\n", {"'beta [degree]'", "rad, mrad, deg"}},
        BadTable{"WrongUnit", "^z [deg],beta,gamma\n0,0,0\n", {"unit of angle", "is a length", "m, cm, mm"}},
        BadTable{"OpenBracket", "^z [mm,beta,gamma\n0,0,0\n", {"'z [mm'", "known: z"}},
        BadTable{"OnlyAUnit", "z,beta,gamma,^[mm]\n0,0,0,0\n", {"has no name"}},
        BadTable{"TrailingComma", "z,beta,gamma,^\n0,0,0,\n", {"has no name", "the comma at the ends of lines"}},
        BadTable{"RepeatedWithUnit", "z,beta,gamma,^z [mm]\n0,0,0,0\n", {"'z'", "second time"}},
        BadTable{"LabelOfPoses", "^part,z,beta,gamma\n1,0,0,0\n", {"'part'"}},
        BadTable{"OpenQuote", "z,^\"beta,gamma\n0,0,0\n", {"begins with a quote", "close the quotes"}},
        BadTable{"TextBehindQuotes", "^\"z\"a,beta,gamma\n0,0,0\n", {"begins with a quote"}},
        BadTable{"QuotedSemicolons", "\"z\"^;\"beta\";\"gamma\"\n0;0;0\n", {"separated by semicolons"}},
        BadTable{"LineOfUnits", "z,beta,gamma\n^mm,deg,deg\n0,0,0\n", {"units, such as 'mm'", "'z [mm]'", "remove"}},
        BadTable{"Tabs", "^z\tbeta\tgamma\n0\t0\t0\n", {"separated by tabs", "with commas"}},
        BadTable{"Word", "z,beta,gamma\n0,0,0\n0, ^left,0\n", {"'left'", "'beta'", "not a finite number"}},
        BadTable{"NotANumber", "z,beta,gamma\n0,^nan,0\n", {"'nan'", "not a finite number"}},
        BadTable{"Infinity", "z,beta,gamma\n0,0,^-inf\n", {"'-inf'", "not a finite number"}},
        BadTable{"Overflow", "z,beta,gamma\n^1e999,0,0\n", {"'1e999'", "not a finite number"}},
        BadTable{"Unit", "z,beta,gamma\n^1 mm,0,0\n", {"'1 mm'", "SI"}},
        BadTable{"Hexadecimal", "z,beta,gamma\n^0x1,0,0\n", {"'0x1'"}},
        BadTable{"EmptyCell", "z,beta,gamma\n0,^,0\n", {"''", "'beta'"}},
        BadTable{"Comment", "z,beta,gamma\n^# home\n0,0,0\n", {"begins with '#'", "remove it"}},
        BadTable{"CommentedNames", "^# z,beta,gamma\n0,0,0\n", {"begin with '#'", "comments=\"\""}},
        BadTable{"Parentheses", "z,^beta (deg),gamma\n0,0,0\n", {"in parentheses", "write 'beta [deg]'"}},
        BadTable{"TabsAfterUnits", "^z [mm]\tbeta\tgamma [deg]\n0\t0\t0\n", {"separated by tabs"}},
        BadTable{"TooFewCells", "z,beta,gamma\n0,0,0\n^0,0\n", {"should have 3 cells, but has 2"}},
        BadTable{"TooManyCells", "z,beta,gamma\n0,0,0,^0\n", {"should have 3 cells, but has 4"}},
        BadTable{"BlankLineBetween", "z,beta,gamma\n0,0,0\n^\n0,0,0\n", {"this line is blank", "remove it"}},
        BadTable{"Semicolons", "z^;beta;gamma\n0;0;0\n", {"separated by semicolons", "with commas"}},
        BadTable{"SemicolonsBelow", "z,beta,gamma\n0^;0;0\n", {"separated by semicolons"}},
        BadTable{"DecimalComma", "z,beta,gamma\n0,5,0,^5\n", {"but has 4", "decimal points"}},
        BadTable{"BinaryRubbish",
                 std::string("^\x7F"
                             "ELF\x02\x01\x00\x00\xFF",
                             10),
                 {"'?ELF?"}},
        BadTable{"ZeroByte", std::string("z,beta,gamma\n0,^0\0,0\n", 21), {"'0?'"}}),
    kName);

class BadTrajectory : public testing::TestWithParam<BadTable> {};

TEST_P(BadTrajectory, IsRefused) {
  const test::TempFolder folder;
  const test::Marked bad(GetParam().text);
  const std::string path = folder.write("curve.csv", bad.text);
  test::expect_input_error([&] { read_trajectory(path, kModel); }, {path, bad.line, bad.column}, GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadTrajectory,
    testing::Values(
        BadTable{"RepeatedTime",
                 "t,z,beta,gamma\n0,0,0,0\n0.5,0,0,0\n^0.5,0,0,0\n",
                 {"t = 0.5 s appears a second time, after line 3", "sort the rows"}},
        BadTable{"UnsortedTime",
                 "t,z,beta,gamma\n0,0,0,0\n0.5,0,0,0\n^0.25,0,0,0\n",
                 {"t = 0.25 s follows t = 0.5 s of line 3", "sort the rows"}},
        BadTable{"NoTime", "^z,beta,gamma\n0,0,0\n", {"'t' is missing", "t,z,beta,gamma | t,depth,sum,difference"}},
        BadTable{"OnlyTime", "^t\n0\n", {"'z' is missing"}},
        BadTable{"UnknownColumn", "t,z,beta,^weight\n0,0,0,0\n", {"'weight'", "known: t, z, beta, gamma, depth, sum"}},
        BadTable{"MixedCoordinates", "^t,z,beta,sum\n0,0,0,0\n", {"mix coordinates", "t,z,beta,gamma | t,depth"}},
        BadTable{"OneRow", "t,z,beta,gamma\n0,0,0,0\n^", {"only one row", "at least two"}},
        BadTable{"HeaderOnly", "t,z,beta,gamma\n^", {"no data"}},
        BadTable{"TimeWithUnit", "t,z,beta,gamma\n^0 s,0,0,0\n", {"'0 s'", "plain number, in SI"}}),
    kName);

class BadErrors : public testing::TestWithParam<BadTable> {};

TEST_P(BadErrors, AreRefused) {
  const test::TempFolder folder;
  const test::Marked bad(GetParam().text);
  const std::string path = folder.write("errors.csv", bad.text);
  test::expect_input_error([&] { read_errors(path, kMechanism); }, {path, bad.line, bad.column}, GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    All, BadErrors,
    testing::Values(
        BadTable{"UnknownFactor", "delta_1,^delta_9\n0,0\n", {"'delta_9'", "did you mean 'delta_1'?"}},
        BadTable{"UnknownFactorWithAUnit", "delta_1,^delta_9\n0,0.1 mm\n", {"'delta_9'", "did you mean 'delta_1'?"}},
        BadTable{"UnknownFactorFurtherDown", "delta_1,^delta_9\n0,none\n0,-.5\n", {"'delta_9'", "not a factor"}},
        BadTable{"UnknownFactorWithoutValues", "delta_1,^delta_9\n0,\n", {"'delta_9'", "not a factor"}},
        BadTable{"UnknownFactorThatIsNoNumber", "delta_1,^delta_9\n0,nan\n", {"'delta_9'", "not a factor"}},
        BadTable{"RepeatedText", "delta_1,operator,^operator\n0,a,b\n", {"'operator'", "second time"}},
        BadTable{"RepeatedFactor", "delta_1,^delta_1\n0,0\n", {"'delta_1'", "second time"}},
        BadTable{"Word", "delta_1\n^x\n", {"'x'", "'delta_1'"}}, BadTable{"HeaderOnly", "delta_1\n^", {"no data"}},
        BadTable{"Empty", "^", {"empty"}}, BadTable{"OnlyLabels", "^part\n1\n", {"no column of errors"}},
        BadTable{"TwoLabels", "part,delta_1,^name\n1,0,2\n", {"'name'", "another one"}},
        BadTable{"RepeatedLabel", "part,delta_1\n17,0\n18,0\n^17,0\n", {"part '17'", "second time, after line 2"}},
        BadTable{"EmptyLabel", "part,delta_1\n^,0\n", {"is empty", "at most 60"}},
        BadTable{"Formula", "delta_1,name\n0,^=1+1|cmd\n", {"'=1+1|cmd'", "begins with '='"}},
        BadTable{"QuoteInLabel", "part,delta_1\n^\"1\"\"7\",0\n", {"has a quote"}},
        BadTable{"UnitsBelowLabels", "part,delta_1\n,^mm\n17,0\n", {"units, such as 'mm'", "'delta_1 [mm]'"}},
        BadTable{"Dates", "part,^date,delta_1\na,2026-03-01,0\n", {"'date'", "or delete it, or call it 'part'"}},
        BadTable{"NumbersThatNameNothing",
                 "^Part No.,delta_1\n17,0\n17,0\n",
                 {"'Part No.'", "give each row a name of its own, or delete the column"}}),
    kName);

struct BadLabel {
  const char* name;
  std::string label;
  const char* words;
};

void PrintTo(const BadLabel& bad, std::ostream* out) { *out << bad.name; }

class BadLabels : public testing::TestWithParam<BadLabel> {};

TEST_P(BadLabels, AreRefusedWithTheReason) { EXPECT_EQ(label_problem(GetParam().label), GetParam().words); }

INSTANTIATE_TEST_SUITE_P(
    All, BadLabels,
    testing::Values(BadLabel{"Empty", "", "is empty"},
                    BadLabel{"Long", std::string(61, 'x'), "is longer than 60 bytes"},
                    BadLabel{"Comma", "a,b", "has a comma"}, BadLabel{"Semicolon", "a;b", "has a semicolon"},
                    BadLabel{"Quote", "a\"b", "has a quote"},
                    BadLabel{"LineEnd", "a\nb", "has characters that cannot be printed"},
                    BadLabel{"Escape", "a\x1b[2J", "has characters that cannot be printed"},
                    BadLabel{"NoText", "a\xff", "has characters that cannot be printed"},
                    BadLabel{"C1", "a\xc2\x9b", "has characters that cannot be printed"},
                    BadLabel{"Equals", "=1", "begins with '='"}, BadLabel{"Plus", "+1", "begins with '+'"},
                    BadLabel{"Minus", "-1", "begins with '-'"}, BadLabel{"At", "@1", "begins with '@'"}),
    kName);

TEST(RowLabel, WordsAndNumbersMayNameARow) {
  for (const std::string label : {"17", "Gehäuse 3/40", "A-12 <new>", "1=2", "x@home"}) {
    EXPECT_FALSE(label_problem(label)) << label;
  }
  EXPECT_FALSE(label_problem(std::string(60, 'x')));
}

TEST(ReadTables, TellAFolderFromAMissingFile) {
  const test::TempFolder folder;
  test::expect_input_error([&] { read_poses(folder.file("."), kModel); }, {folder.file("."), 0, 0}, {"folder"});
  test::expect_input_error([&] { read_errors(folder.file("."), kMechanism); }, {folder.file("."), 0, 0}, {"folder"});
  EXPECT_THROW(read_poses(folder.file("none.csv"), kModel), FileError);
  EXPECT_THROW(read_errors(folder.file("none.csv"), kMechanism), FileError);
}

}  // namespace
}  // namespace poesy
