#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/mount.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "engine/base/error.h"
#include "engine/result/result_file.h"
#include "engine/result/shard_file.h"
#include "engine/storage/h5.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

/// The message of the FileError that the action throws. The test fails if it throws none.
template <class Action>
std::string file_error(const Action& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no FileError";
  return {};
}

void expect_contains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text;
}

/// A file system of 16 KiB, mounted at `folder`. mounted() is false if this process may not mount it.
class TinyDisk {
 public:
  explicit TinyDisk(const std::string& folder, unsigned long flags = 0) : folder_(folder) {
    mounted_ = ::mount("tmpfs", folder.c_str(), "tmpfs", flags, "size=16k") == 0;
  }
  TinyDisk(const TinyDisk&) = delete;
  TinyDisk& operator=(const TinyDisk&) = delete;
  ~TinyDisk() {
    if (mounted_) ::umount(folder_.c_str());
  }
  bool mounted() const { return mounted_; }

 private:
  std::string folder_;
  bool mounted_;
};

TEST(FullDisk, GivesAFileErrorAndLeavesTheOldResult) {
  const TempFolder folder;
  const TinyDisk disk(folder.path());
  if (!disk.mounted()) GTEST_SKIP() << "mounting a tmpfs is not permitted here";
  write_bytes(folder / "r.h5", "the old result");
  expect_contains(file_error([&] { Example().write_sensitivity(folder / "r.h5"); }), "No space left on device; needs ");
  EXPECT_EQ(read_bytes(folder / "r.h5"), "the old result");
  EXPECT_EQ(files_in(folder.path()), 1U) << "the temporary file is still there";
}

TEST(FullDisk, StopsAnExport) {
  const TempFolder results;
  Example().write_sensitivity(results / "r.h5");
  const TempFolder folder;
  const TinyDisk disk(folder.path());
  if (!disk.mounted()) GTEST_SKIP() << "mounting a tmpfs is not permitted here";
  write_bytes(folder / "filler", std::string(15000, 'x'));
  expect_contains(file_error([&] { export_tables(results / "r.h5", folder.path()); }), "No space left on device");
}

TEST(FileSizeLimit, GivesAFileErrorAndLeavesTheOldResult) {
  const TempFolder folder;
  write_bytes(folder / "r.h5", "the old result");
  {
    const FileSizeLimit limit(5000);
    expect_contains(file_error([&] { Example().write_sensitivity(folder / "r.h5"); }), "File too large");
  }
  EXPECT_EQ(read_bytes(folder / "r.h5"), "the old result");
  EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(ReadOnlyDisk, IsFoundBeforeAndWhileWriting) {
  const TempFolder folder;
  const TinyDisk disk(folder.path(), MS_RDONLY);
  if (!disk.mounted()) GTEST_SKIP() << "mounting a tmpfs is not permitted here";
  expect_contains(file_error([&] { check_result_path(folder / "r.h5"); }), "Read-only file system");
  expect_contains(file_error([&] { Example().write_sensitivity(folder / "r.h5"); }), "Read-only file system");
}

TEST(VanishedFolder, GivesAFileError) {
  const TempFolder folder;
  const std::string path = folder / "gone/r.h5";
  const std::string message = file_error([&] { Example().write_sensitivity(path); });
  expect_contains(message, path);
  expect_contains(message, "No such file or directory");
}

TEST(Device, IsNeverReplacedByAResult) {
  expect_contains(file_error([] { Example().write_sensitivity("/dev/null"); }), "not a plain file");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

class UnreadableResult : public testing::Test {
 protected:
  std::string message() const {
    const std::string from_verify = file_error([&] { verify_result(path_); });
    const std::string from_read = file_error([&] { read_result(path_); });
    EXPECT_EQ(from_read, from_verify);
    EXPECT_TRUE(from_read.starts_with(path_ + ": ")) << from_read;
    return from_read;
  }

  TempFolder folder_;
  std::string path_ = folder_ / "r.h5";
};

TEST_F(UnreadableResult, Missing) { expect_contains(message(), "No such file"); }

TEST_F(UnreadableResult, Folder) {
  std::filesystem::create_directory(path_);
  expect_contains(message(), "is a folder");
}

TEST_F(UnreadableResult, Empty) {
  write_bytes(path_, "");
  expect_contains(message(), "not an intact HDF5 file");
}

TEST_F(UnreadableResult, Text) {
  write_bytes(path_, std::string(10000, 'x'));
  expect_contains(message(), "not an intact HDF5 file");
}

TEST_F(UnreadableResult, Study) {
  path_ = folder_ / "study.toml";
  write_bytes(path_, "format = \"poesy-study\"\n");
  expect_contains(message(), "is not a result; if it is a study, run it");
}

TEST_F(UnreadableResult, TruncatedAnywhere) {
  Example().write_sensitivity(path_);
  const std::string whole = read_bytes(path_);
  for (std::size_t length = 1; length < whole.size(); length += whole.size() / 40) {
    write_bytes(path_, whole.substr(0, length));
    expect_contains(message(), "not an intact HDF5 file");
  }
  write_bytes(path_, whole.substr(0, whole.size() - 1));
  expect_contains(message(), "not an intact HDF5 file");
}

TEST_F(UnreadableResult, OfAnotherProgram) {
  H5Fclose(H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  expect_contains(message(), "not a result of poesy");
}

TEST_F(UnreadableResult, WithAnotherFileType) {
  const hid_t file = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(file, "filetype", H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT);
  H5Aclose(attribute);
  H5Sclose(space);
  H5Fclose(file);
  expect_contains(message(), "not a result of poesy");
}

/// Sets the two numbers of a file's version.
void set_version(const std::string& path, std::int64_t major, std::int64_t minor) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  const hid_t attribute = H5Aopen(file, "version", H5P_DEFAULT);
  const std::int64_t version[2] = {major, minor};
  H5Awrite(attribute, H5T_NATIVE_INT64, version);
  H5Aclose(attribute);
  H5Fclose(file);
}

TEST_F(UnreadableResult, OfANewerMajorVersion) {
  Example().write_sensitivity(path_);
  set_version(path_, 2, 0);
  expect_contains(message(), "format version 2.0, newer than this program's 1.0; use the poesy that wrote it (");
}

TEST_F(UnreadableResult, OfAnOlderMajorVersion) {
  Example().write_sensitivity(path_);
  set_version(path_, 0, 9);
  expect_contains(message(), "format version 0.9, older than this program's 1.0; use the poesy that wrote it (");
  expect_contains(message(), "), or run the study again");
}

TEST(NewerMinorVersion, IsRead) {
  const TempFolder folder;
  Example().write_sensitivity(folder / "r.h5");
  set_version(folder / "r.h5", 1, 7);
  EXPECT_EQ(read_result(folder / "r.h5").kind, "sensitivity");
}

// Whatever byte is damaged, the reader never crashes. It refuses the file, or the content hash differs, or the byte has
// no meaning.
TEST(DamagedResult, NeverCrashesTheReader) {
  const TempFolder folder;
  const std::string path = folder / "r.h5";
  Example().write_sensitivity(path);
  const std::string intact = read_bytes(path);
  std::size_t refused = 0;
  std::size_t different = 0;
  for (std::size_t place = 0; place < intact.size(); place += 151) {
    std::string damaged = intact;
    damaged[place] = static_cast<char>(damaged[place] ^ 0xff);
    write_bytes(path, damaged);
    try {
      const Verification verification = verify_result(path);
      if (!verification.matches()) ++different;
      read_result(path);
    } catch (const FileError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 50U);
  EXPECT_GT(different, 20U);
}

/// Writes a dataset that claims to have this shape but has no data.
void write_claim(const std::string& path, const std::vector<hsize_t>& shape) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const std::vector<hsize_t> chunk(shape.size(), 1);
  H5Pset_chunk(properties, static_cast<int>(chunk.size()), chunk.data());
  H5Dclose(H5Dcreate2(file, "/claim", H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, H5P_DEFAULT));
  H5Pclose(properties);
  H5Sclose(space);
  H5Fclose(file);
}

TEST(DamagedResult, WithMoreElementsThanCanBeIsRefused) {
  const TempFolder folder;
  constexpr hsize_t kLong = hsize_t{1} << 32U;
  for (const auto& shape : {std::vector<hsize_t>{kLong << 9U}, {kLong, kLong}, {kLong, kLong, 3}}) {
    write_claim(folder / "claim.h5", shape);
    const h5::File file = h5::File::open(folder / "claim.h5");
    EXPECT_THROW(file.shape("/claim"), h5::Error);
    EXPECT_THROW(file.read<double>("/claim"), h5::Error);
    EXPECT_THROW(file.value("/claim"), h5::Error);
  }
}

TEST(DamagedResult, WithNamesThatLeadElsewhereIsRefused) {
  const TempFolder folder;
  for (const char* name : {"../../x", "a,b", "", "line\nbreak", "clear \x1b[2J"}) {
    Catalog catalog = fake_catalog();
    catalog[0].description.responses[0].name = name;
    Example example;
    example.study.mechanism.entry = &catalog[0];
    example.write_sensitivity(folder / "r.h5");
    const std::string message = file_error([&] { export_tables(folder / "r.h5", folder / "tables"); });
    expect_contains(message, "in /responses/name is not a name");
    EXPECT_TRUE(std::ranges::none_of(message, [](char c) { return c >= 0 && c < ' '; })) << message;
  }
}

TEST(DamagedResult, WithoutWhatEveryResultHasIsRefused) {
  const TempFolder folder;
  const std::string path = folder / "r.h5";
  for (const char* name : {"/factors/description", "/factors/distribution", "/poses/condition", "/solver/failed_pose",
                           "/sensitivity/global_corrected", "/sensitivity/rounding", "/sensitivity/index_change",
                           "/sensitivity/background", "/sensitivity/history", "/tolerances"}) {
    Example().write_sensitivity(path);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(H5Ldelete(file, name, H5P_DEFAULT), 0) << name;
    H5Fclose(file);
    expect_contains(file_error([&] { read_result(path); }), "is damaged");
  }
}

/// The message with which a result is refused after `change` added an object /strange to it.
std::string refusal_of(const std::function<void(hid_t file)>& change) {
  const TempFolder folder;
  const std::string path = folder / "r.h5";
  Example().write_sensitivity(path);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  change(file);
  H5Fclose(file);
  const std::string of_verify = file_error([&] { verify_result(path); });
  EXPECT_EQ(file_error([&] { read_result(path); }), of_verify);
  EXPECT_EQ(file_error([&] { read_shard(path); }), of_verify);
  EXPECT_NE(of_verify.find("a result is one tree that reads nothing but itself; do not trust it"), std::string::npos);
  return of_verify;
}

/// Creates the dataset /strange of three bytes with these creation properties.
void make_strange(hid_t file, hid_t properties) {
  constexpr hsize_t kLength = 3;
  const hid_t space = H5Screate_simple(1, &kLength, nullptr);
  EXPECT_GE(H5Dclose(H5Dcreate2(file, "/strange", H5T_STD_U8LE, space, H5P_DEFAULT, properties, H5P_DEFAULT)), 0);
  H5Sclose(space);
  H5Pclose(properties);
}

TEST(StrangeResult, ThatReadsOtherFilesIsRefusedByName) {
  expect_contains(refusal_of([](hid_t file) {
                    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
                    H5Pset_external(properties, "/etc/passwd", 0, 3);
                    make_strange(file, properties);
                  }),
                  "/strange has its values in other files (external storage)");
  expect_contains(refusal_of([](hid_t file) {
                    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
                    constexpr hsize_t kLength = 3;
                    const hid_t space = H5Screate_simple(1, &kLength, nullptr);
                    H5Pset_virtual(properties, space, "other.h5", "/x", space);
                    H5Sclose(space);
                    make_strange(file, properties);
                  }),
                  "/strange is a virtual dataset");
  expect_contains(
      refusal_of([](hid_t file) { H5Lcreate_external("other.h5", "/", file, "/strange", H5P_DEFAULT, H5P_DEFAULT); }),
      "/strange is a link to another file");
  expect_contains(refusal_of([](hid_t file) {
                    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
                    constexpr hsize_t kChunk = 3;
                    H5Pset_chunk(properties, 1, &kChunk);
                    H5Pset_filter(properties, 32001, H5Z_FLAG_OPTIONAL, 0, nullptr);
                    make_strange(file, properties);
                  }),
                  "/strange needs the filter 32001");
}

TEST(StrangeResult, ThatIsNoTreeIsRefusedByName) {
  expect_contains(refusal_of([](hid_t file) { H5Lcreate_soft("/poses", file, "/strange", H5P_DEFAULT, H5P_DEFAULT); }),
                  "/strange is a soft link");
  expect_contains(
      refusal_of([](hid_t file) { H5Lcreate_hard(file, "/", file, "/poses/strange", H5P_DEFAULT, H5P_DEFAULT); }),
      "/poses/strange is a group that has two names, or is in itself");
  expect_contains(refusal_of([](hid_t file) {
                    for (int k = 0; k < 20; ++k) {
                      const std::string name = "/strange" + std::to_string(k);
                      H5Lcreate_hard(file, "/response", file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
                    }
                  }),
                  " has too many names");
  expect_contains(refusal_of([](hid_t file) {
                    const hid_t type = H5Tcopy(H5T_IEEE_F64LE);
                    H5Tcommit2(file, "/strange", type, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
                    H5Tclose(type);
                  }),
                  "/strange is neither a group nor a dataset");
  expect_contains(refusal_of([](hid_t file) {
                    std::string path;
                    for (int level = 0; level < 20; ++level) {
                      path += "/strange";
                      H5Gclose(H5Gcreate2(file, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
                    }
                  }),
                  "/strange is too deep");
}

TEST(DamagedResult, WithADatasetMissingIsRefused) {
  const TempFolder folder;
  const std::string path = folder / "r.h5";
  Example().write_sensitivity(path);
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, "/sensitivity/local", H5P_DEFAULT);
  H5Fclose(file);
  expect_contains(file_error([&] { read_result(path); }), "is damaged: cannot open dataset /sensitivity/local");
  EXPECT_FALSE(verify_result(path).matches());
}

}  // namespace
}  // namespace poesy::test
