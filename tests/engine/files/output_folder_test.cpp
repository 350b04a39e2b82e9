#include "engine/files/output_folder.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "engine/base/error.h"
#include "engine/files/result_file.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/input_error.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

namespace fs = std::filesystem;

class OutputFolders : public testing::Test {
 protected:
  /// A command that writes these bytes as a.csv.
  void write(const std::string& bytes) {
    OutputFolder output(folder_.path());
    output.claim("a.csv");
    output.open();
    folder_.write("a.csv", bytes);
    output.close();
  }

  void expect_refused(const std::string& name, const std::string& words) {
    OutputFolder output(folder_.path());
    expect_input_error([&] { output.claim(name); }, {folder_ / name, 0, 0}, {words, "-d"});
  }

  TempFolder folder_;
};

TEST_F(OutputFolders, WhatWasWrittenMayBeReplaced) {
  write("one\n");
  write("two\n");
  write("three\n");
  EXPECT_EQ(read_bytes(folder_ / "a.csv"), "three\n");
}

TEST_F(OutputFolders, AFileOfTheUsersIsRefused) {
  folder_.write("a.csv", "z\n0.1\n");
  expect_refused("a.csv", "does not list it");
}

TEST_F(OutputFolders, AnEmptyFileOfTheUsersIsRefused) {
  folder_.write("a.csv", "");
  expect_refused("a.csv", "does not list it");
}

TEST_F(OutputFolders, AFileThatWasChangedIsRefused) {
  write("z\n0.1\n");
  folder_.write("a.csv", "z\n0.2\n");
  expect_refused("a.csv", "was changed since poesy wrote it");
  folder_.write("a.csv", "z\n0.1\n");
  write("z\n0.3\n");
}

TEST_F(OutputFolders, FilesThatAnInterruptedCommandLeftMayBeReplaced) {
  write("whole\n");
  {
    OutputFolder killed(folder_.path());
    killed.claim("a.csv");
    killed.claim("b.csv");
    killed.open();
    folder_.write("a.csv", "of the command that was killed\n");
  }
  OutputFolder next(folder_.path());
  next.claim("a.csv");
  next.claim("b.csv");
  next.open();
  folder_.write("a.csv", "new\n");
  folder_.write("b.csv", "new\n");
  next.close();
  folder_.write("b.csv", "changed afterwards\n");
  expect_refused("b.csv", "was changed");
}

TEST_F(OutputFolders, LinksAndFoldersAreRefused) {
  write("mine\n");
  fs::rename(folder_ / "a.csv", folder_ / "b.csv");
  fs::create_symlink("b.csv", folder_ / "a.csv");
  expect_refused("a.csv", "is not a plain file");
  fs::remove(folder_ / "a.csv");
  fs::create_symlink("nowhere", folder_ / "a.csv");
  expect_refused("a.csv", "is not a plain file");
  fs::create_directory(folder_ / "c.csv");
  expect_refused("c.csv", "is not a plain file");
}

TEST_F(OutputFolders, TwoCommandsShareAFolder) {
  write("of one\n");
  OutputFolder other(folder_.path());
  other.claim("b.csv");
  other.open();
  folder_.write("b.csv", "of the other\n");
  other.close();
  write("again\n");
  const std::string list = read_bytes(folder_ / kListOfFiles);
  EXPECT_NE(list.find("  a.csv\n"), std::string::npos);
  EXPECT_NE(list.find("  b.csv\n"), std::string::npos);
}

TEST_F(OutputFolders, AListThatIsNotOursIsRefused) {
  for (const char* text : {"notes\n", "0123  a.csv\n", "../a.csv  0123\n"}) {
    folder_.write(kListOfFiles, text);
    expect_input_error([&] { OutputFolder{folder_.path()}; }, {folder_ / kListOfFiles, 0, 0}, {"no list of poesy"});
  }
}

// The list is the one of sha256sum, of which this is the hash of "abc".
TEST_F(OutputFolders, ListIsThatOfSha256sum) {
  write("abc");
  const std::string list = read_bytes(folder_ / kListOfFiles);
  EXPECT_NE(list.find("\nba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad  a.csv\n"), std::string::npos)
      << list;
}

TEST_F(OutputFolders, AnExportWritesNothingWhereOneTableIsTheUsers) {
  Example example;
  const std::string result = folder_ / "s.h5";
  example.write_sensitivity(result);
  for (const char* name : {"poses.csv", "factors.csv", "tolerances_linear_deformation.csv"}) {
    const TempFolder home;
    home.write(name, "z,beta,gamma\n-0.2,0,0\n");
    expect_input_error([&] { export_tables(result, home.path()); }, {home / name, 0, 0}, {"does not list it", "-d"});
    EXPECT_EQ(files_in(home.path()), 1U);
    EXPECT_EQ(read_bytes(home / name), "z,beta,gamma\n-0.2,0,0\n");
  }
}

TEST_F(OutputFolders, ExportsOfDifferentKindsReplaceEachOther) {
  Example example;
  example.write_sensitivity(folder_ / "s.h5");
  example.write_evaluation(folder_ / "e.h5", Pairing::every_pose_with_every_row);
  const std::string tables = folder_ / "tables";
  export_tables(folder_ / "s.h5", tables);
  export_tables(folder_ / "e.h5", tables);
  export_tables(folder_ / "s.h5", tables);
  folder_.write("tables/poses.csv", "pose,z [m],beta [rad],gamma [rad],condition\n0,-0.2,0,0,1\n");
  EXPECT_THROW(export_tables(folder_ / "s.h5", tables), InputError);
}

}  // namespace
}  // namespace poesy::test
