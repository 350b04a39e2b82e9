#include "engine/storage/output_folder.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>

#include "engine/base/error.h"
#include "engine/result/result_file.h"
#include "engine/storage/file_writer.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/input_error.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

namespace fs = std::filesystem;

/// content_sha256 of two results.
const std::string kResult(64, '1');
const std::string kOther(64, '2');

/// Thrown in place of a command that is killed.
struct Killed {};

class OutputFolders : public testing::Test {
 protected:
  /// Acts as a command that writes these files, each with this text. result: content_sha256 of the result that it
  /// shows.
  void write_all(const std::vector<std::string>& names, const std::string& text, const std::string& result = kResult) {
    OutputFolder output(folder_.path(), result);
    for (const std::string& name : names) output.claim(name);
    output.fill([&] {
      for (const std::string& name : names) folder_.write(name, text);
    });
  }

  /// Acts as a command that writes these bytes to a.csv.
  void write(const std::string& bytes) { write_all({"a.csv"}, bytes); }

  /// Acts as a command that should write these files and is killed after the first one.
  void kill(const std::vector<std::string>& names, const std::string& result) {
    OutputFolder killed(folder_.path(), result);
    for (const std::string& name : names) killed.claim(name);
    EXPECT_THROW(killed.fill([&] {
      folder_.write(names.front(), "of the command that was killed\n");
      throw Killed();
    }),
                 Killed);
  }

  /// Acts as the user, who writes a file after poesy wrote its files.
  void change(const std::string& name, const std::string& bytes) {
    folder_.write(name, bytes);
    fs::last_write_time(folder_ / name, fs::last_write_time(folder_ / kManifest) + std::chrono::milliseconds(1));
  }

  void expect_refused(const std::string& name, const std::string& words) {
    OutputFolder output(folder_.path(), kResult);
    expect_input_error([&] { output.claim(name); }, {folder_ / name, 0, 0}, {words, "-d"});
  }

  std::string manifest() const { return read_bytes(folder_ / kManifest); }
  bool has(const std::string& name) const { return fs::exists(folder_ / name); }

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
  change("a.csv", "z\n0.2\n");
  expect_refused("a.csv", "was changed since poesy wrote it");
  // The file still belongs to the user after another command has written other files.
  write_all({"b.csv"}, "of the other\n");
  expect_refused("a.csv", "does not list it");
  EXPECT_EQ(read_bytes(folder_ / "a.csv"), "z\n0.2\n");
}

TEST_F(OutputFolders, FilesThatAnInterruptedCommandLeftMayBeReplaced) {
  write("whole\n");
  kill({"a.csv", "b.csv"}, kResult);
  write_all({"a.csv", "b.csv"}, "new\n");
  change("b.csv", "changed afterwards\n");
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

TEST_F(OutputFolders, TwoCommandsOfAResultShareAFolder) {
  write("of one\n");
  write_all({"b.csv"}, "of the other\n");
  write("again\n");
  EXPECT_NE(manifest().find("\na.csv\nb.csv\n"), std::string::npos);
}

TEST_F(OutputFolders, FilesOfAnotherResultGoAsAWhole) {
  folder_.write("mine.csv", "z\n0.1\n");
  write_all({"a.csv", "b.csv"}, "old\n");
  write_all({"b.csv", "c.csv"}, "new\n", kOther);
  EXPECT_FALSE(has("a.csv"));
  EXPECT_EQ(read_bytes(folder_ / "b.csv"), "new\n");
  EXPECT_EQ(read_bytes(folder_ / "mine.csv"), "z\n0.1\n");
  EXPECT_EQ(manifest().find(kResult), std::string::npos);
  EXPECT_NE(manifest().find("# content_sha256 " + kOther + "\n"), std::string::npos);
  EXPECT_EQ(manifest().find("a.csv"), std::string::npos);
  EXPECT_EQ(files_in(folder_.path()), 4U);
}

TEST_F(OutputFolders, AChangedFileOfAnotherResultIsKept) {
  write_all({"a.csv", "b.csv"}, "old\n");
  change("a.csv", "of the user\n");
  const std::string before = manifest();
  OutputFolder output(folder_.path(), kOther);
  output.claim("b.csv");
  expect_input_error([&] { output.fill([] { FAIL() << "nothing may be written"; }); }, {folder_ / "a.csv", 0, 0},
                     {"was changed since poesy wrote it", "-d"});
  EXPECT_EQ(read_bytes(folder_ / "a.csv"), "of the user\n");
  EXPECT_EQ(read_bytes(folder_ / "b.csv"), "old\n");
  EXPECT_EQ(manifest(), before);
}

TEST_F(OutputFolders, AfterAKillTheNextResultHasTheFolderForItself) {
  for (const std::string& next : {kResult, kOther, std::string(64, '3')}) {
    write_all({"a.csv", "b.csv"}, "old\n");
    kill({"b.csv", "c.csv"}, kOther);
    write_all({"b.csv"}, "new\n", next);
    EXPECT_FALSE(has("a.csv"));
    EXPECT_FALSE(has("c.csv"));
    EXPECT_EQ(read_bytes(folder_ / "b.csv"), "new\n");
  }
}

TEST_F(OutputFolders, FilesOfAnUnknownResultStayWithNoOthers) {
  write_all({"a.csv"}, "old\n", "");
  write_all({"b.csv"}, "new\n", "");
  EXPECT_FALSE(has("a.csv"));
  write_all({"c.csv"}, "new\n", kResult);
  EXPECT_FALSE(has("b.csv"));
}

TEST_F(OutputFolders, AFailureSaysHowManyFilesAreNew) {
  const auto failure = [&](const std::function<void()>& write) {
    OutputFolder output(folder_.path(), kResult);
    for (const char* name : {"a.csv", "b.csv", "c.csv"}) output.claim(name);
    try {
      output.fill([&] {
        write();
        throw FileError("b.csv", "cannot be written", "make room");
      });
    } catch (const FileError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  write_all({"a.csv", "b.csv"}, "old\n");
  EXPECT_EQ(failure([] {}),
            "b.csv: cannot be written; make room; the files in " + folder_.path() + " are as they were before");
  EXPECT_EQ(failure([&] { write_text(folder_ / "a.csv", "new\n"); }),
            "b.csv: cannot be written; make room; 1 of the 3 files in " + folder_.path() +
                " are new, any others are those of before: do not use them together");
}

TEST_F(OutputFolders, AManifestThatIsNotOursIsRefused) {
  write("mine\n");
  const std::string ours = manifest();
  for (const std::string& text :
       {std::string(), std::string("notes\n"), "a.csv\n" + ours, ours + "../a.csv\n", ours + "/a.csv\n", ours + "\n"}) {
    folder_.write(kManifest, text);
    expect_input_error([&] { OutputFolder(folder_.path(), kResult); }, {folder_ / kManifest, 0, 0},
                       {"was not written by poesy"});
  }
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
  for (const char* result : {"s.h5", "e.h5", "s.h5"}) {
    const std::size_t files = export_tables(folder_ / result, tables).size();
    EXPECT_EQ(files_in(tables), 1 + files) << result;
  }
  EXPECT_NE(read_bytes(tables + "/" + kManifest).find(read_result(folder_ / "s.h5").content_sha256), std::string::npos);
  folder_.write("tables/poses.csv", "pose,z [m],beta [rad],gamma [rad],condition\n0,-0.2,0,0,1\n");
  fs::last_write_time(tables + "/poses.csv", fs::file_time_type::clock::now() + std::chrono::seconds(1));
  EXPECT_THROW(export_tables(folder_ / "s.h5", tables), InputError);
}

}  // namespace
}  // namespace poesy::test
