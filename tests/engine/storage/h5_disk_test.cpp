#include "engine/storage/h5_disk.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <hdf5.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

#include "engine/base/error.h"
#include "engine/storage/content_hash.h"
#include "engine/storage/file_writer.h"
#include "engine/storage/h5.h"
#include "tests/support/file_size_limit.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

std::vector<std::byte> bytes_of(std::string_view text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(FileWriter, PutsBytesInAnyOrder) {
  const TempFolder folder;
  FileWriter writer(folder / "f");
  writer.put(6, bytes_of("world"));
  writer.put(0, bytes_of("hello"));
  std::vector<std::byte> back(13);
  EXPECT_TRUE(writer.get(0, back));
  EXPECT_EQ(back, bytes_of(std::string_view("hello\0world\0\0", 13)));
  writer.end_at(9);
  writer.commit();
  EXPECT_EQ(read_bytes(folder / "f"), std::string_view("hello\0wor", 9));
}

/// Random numbers, so that a wrong order would be noticed.
std::vector<double> some_numbers(std::size_t count) {
  std::vector<double> values(count);
  std::mt19937_64 random(7);
  for (double& value : values) value = std::ldexp(static_cast<double>(random()), -64);
  return values;
}

/// Shapes with more elements than one slice, so that they are cut along different axes.
class Slices : public testing::TestWithParam<h5::Shape> {};

TEST_P(Slices, AreWrittenAndReadInOrder) {
  const TempFolder folder;
  const h5::Shape& shape = GetParam();
  const std::vector<double> values = some_numbers(h5::size(shape));
  FileWriter writer(folder / "f.h5");
  h5::File file = h5::File::on_disk(writer);
  std::size_t calls = 0;
  std::size_t next = 0;
  file.write_slices<double>("/x", shape, [&](std::size_t first, std::span<double> to) {
    EXPECT_EQ(first, next);
    std::ranges::copy(std::span(values).subspan(first, to.size()), to.begin());
    next += to.size();
    ++calls;
  });
  EXPECT_GT(calls, 1U);
  EXPECT_EQ(next, values.size());
  file.close();
  writer.commit();
  const h5::File stored = h5::File::open(folder / "f.h5");
  EXPECT_EQ(stored.shape("/x"), shape);
  EXPECT_TRUE(stored.read<double>("/x") == values);
  std::vector<std::byte> read;
  stored.read_slices("/x", [&](std::span<std::byte> slice) {
    EXPECT_LE(slice.size(), std::size_t{1} << 22U);
    read.insert(read.end(), slice.begin(), slice.end());
  });
  EXPECT_TRUE(read == stored.value("/x").numbers);
  EXPECT_TRUE(stored.head("/x").numbers.empty());
}

INSTANTIATE_TEST_SUITE_P(Shapes, Slices,
                         testing::Values(h5::Shape{1'500'001}, h5::Shape{3, 700'001}, h5::Shape{700'001, 3},
                                         h5::Shape{2, 1, 600'007, 1}, h5::Shape{5, 7, 30'011}, h5::Shape{2, 524'288}));

/// Writes groups, texts, and small and large datasets to a file. large: number of elements of all large datasets
/// together.
void compose(h5::File& file, std::size_t large) {
  file.make_group("/group");
  file.set_attribute("/group", "description", std::string("of numbers"));
  const std::vector<std::string> names(300, "a name that takes some room");
  file.write<std::string>("/group/names", {names.size()}, names);
  for (int k = 0; k < 20; ++k) {
    const std::vector<double> values = some_numbers(large / 20);
    file.write<double>("/group/values_" + std::to_string(k), {values.size()}, values);
  }
  file.set_attribute("/", "content_sha256", content_sha256(file));
}

TEST(FileOnDisk, HasTheContentOfOneInMemory) {
  const TempFolder folder;
  h5::File memory = h5::File::in_memory();
  compose(memory, 2'000'000);
  FileWriter writer(folder / "f.h5");
  h5::File disk = h5::File::on_disk(writer);
  compose(disk, 2'000'000);
  EXPECT_EQ(content_sha256(disk), content_sha256(memory));
  disk.close();
  writer.commit();
  EXPECT_EQ(content_sha256(h5::File::open(folder / "f.h5")), content_sha256(memory));
}

/// The message if the file does not fit on the disk. Empty if it fits. If HDF5 fails first, the writer must know the
/// reason too.
std::string message_of(const std::string& path, std::size_t large) {
  FileWriter writer(path);
  try {
    h5::File file = h5::File::on_disk(writer);
    compose(file, large);
    file.close();
  } catch (const h5::Error& error) {
    EXPECT_THROW(writer.check(), FileError) << error.what();
  }
  try {
    writer.commit();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST(FileOnDisk, ThatDoesNotFitIsAnErrorOfTheDiskWhereverItEnds) {
  const TempFolder folder;
  constexpr std::size_t kLarge = 20'000;
  ASSERT_EQ(message_of(folder / "whole.h5", kLarge), "");
  const auto bytes = std::filesystem::file_size(folder / "whole.h5");
  for (std::size_t limit = 0; limit < bytes; limit += limit < 8000 ? 97 : 3001) {
    const FileSizeLimit least(limit);
    testing::internal::CaptureStderr();
    const std::string message = message_of(folder / "f.h5", kLarge);
    h5::close_library();
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << limit;
    EXPECT_NE(message.find("cannot be written (File too large); raise the limit on file sizes to "), std::string::npos)
        << limit << ": " << message;
    const std::size_t number = message.find(" to ") + 4;
    EXPECT_NEAR(std::stod(message.substr(number)), static_cast<double>(bytes), 600.0) << "the hash is an attribute";
    EXPECT_EQ(files_in(folder.path()), 1U) << limit;
  }
}

TEST(FileOnDisk, MayBeLeftUnfinished) {
  const TempFolder folder;
  {
    FileWriter writer(folder / "f.h5");
    h5::File file = h5::File::on_disk(writer);
    compose(file, 20'000);
  }
  EXPECT_EQ(files_in(folder.path()), 0U);
  h5::close_library();
}

/// Writes the dataset as another program may store it: in compressed chunks.
void write_chunks(const std::string& path, const std::vector<double>& values) {
  const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hsize_t length = values.size();
  const hsize_t chunk = 100'000;
  const hid_t space = H5Screate_simple(1, &length, nullptr);
  const hid_t storage = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_chunk(storage, 1, &chunk);
  H5Pset_deflate(storage, 1);
  const hid_t dataset = H5Dcreate2(file, "/x", H5T_IEEE_F64BE, space, H5P_DEFAULT, storage, H5P_DEFAULT);
  H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
  H5Pclose(storage);
  H5Sclose(space);
  H5Fclose(file);
}

TEST(FileOnDisk, HasTheHashOfOneInChunks) {
  const TempFolder folder;
  const std::vector<double> values = some_numbers(1'000'003);
  write_chunks(folder / "chunks.h5", values);
  FileWriter writer(folder / "f.h5");
  h5::File file = h5::File::on_disk(writer);
  file.write<double>("/x", {values.size()}, values);
  EXPECT_EQ(content_sha256(h5::File::open(folder / "chunks.h5")), content_sha256(file));
}

/// A dataset of more than one slice has the hash of its whole content.
TEST(FileOnDisk, IsHashedInSlicesAsAWhole) {
  const TempFolder folder;
  constexpr std::size_t kCount = 1'000'003;
  const std::vector<double> values = some_numbers(kCount);
  FileWriter writer(folder / "f.h5");
  h5::File file = h5::File::on_disk(writer);
  file.write<double>("/x", {kCount}, values);
  std::string all;
  const auto number = [&](std::uint64_t value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    all += bytes;
  };
  const auto text = [&](std::string_view value) {
    number(value.size());
    all += value;
  };
  text("/");
  text("group");
  number(0);
  text("/x");
  text("dataset");
  text("float");
  number(8);
  number(1);
  number(kCount);
  all.append(reinterpret_cast<const char*>(values.data()), kCount * sizeof(double));
  number(0);
  EXPECT_EQ(content_sha256(file), hex(sha256(std::as_bytes(std::span(all)))));
}

TEST(H5File, LeavesNothingOpen) {
  const TempFolder folder;
  const std::string path = folder / "f.h5";
  FileWriter writer(path);
  h5::File::on_disk(writer).close();
  writer.commit();
  const std::size_t open = files_in("/proc/self/fd");
  { const h5::File file = h5::File::open(path); }
  EXPECT_THROW(h5::File::open(folder.write("text", "no HDF5")), h5::Error);
  EXPECT_THROW(h5::File::open(folder.path()), h5::Error);
  EXPECT_EQ(files_in("/proc/self/fd"), open);
}

TEST(H5File, SaysWhenTheDiskFails) {
  try {
    h5::File::open("/proc/self/mem");  // a plain file, but reading at offset 0 fails
    ADD_FAILURE() << "was opened";
  } catch (const h5::Error& error) {
    EXPECT_NE(std::string(error.what()).find("Input/output error"), std::string::npos) << error.what();
  }
}

/// Reading needs no lock: some file systems have none, and a result may be replaced while it is read.
TEST(H5File, IsReadWhateverLocksItHas) {
  const TempFolder folder;
  const std::string path = folder / "f.h5";
  FileWriter writer(path);
  h5::File::on_disk(writer).close();
  writer.commit();
  const int other = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(other, LOCK_EX), 0);
  EXPECT_NO_THROW(h5::File::open(path));
  ::close(other);
}

}  // namespace
}  // namespace poesy::test
