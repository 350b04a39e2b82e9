#include "engine/storage/content_hash.h"
#include "engine/run/evaluation.h"

#include <gtest/gtest.h>
#include <hdf5.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <utility>

#include "engine/base/error.h"
#include "engine/result/result_file.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

bool outside_run(const std::string& path) { return path != "/run" && !path.starts_with("/run/"); }

/// Appends the paths of a group and of all objects below it. A scale appears under each of its names.
void collect(const h5::File& file, const std::string& path, std::vector<std::string>& paths) {
  paths.push_back(path);
  if (!file.is_group(path)) return;
  for (const std::string& child : file.children(path)) {
    collect(file, path == "/" ? path + child : path + "/" + child, paths);
  }
}

struct Attribute {
  std::string path;
  std::string name;
};

struct Inventory {
  std::vector<std::string> objects;
  std::vector<std::string> datasets;
  std::vector<Attribute> attributes;
};

Inventory inventory(const std::string& path) {
  const h5::File file = h5::File::open(path);
  Inventory all;
  collect(file, "/", all.objects);
  for (const std::string& object : all.objects) {
    if (!file.is_group(object)) all.datasets.push_back(object);
    for (const std::string& name : file.attributes(object)) all.attributes.push_back({object, name});
  }
  return all;
}

/// A copy of a file that is changed with the HDF5 library directly.
class Change {
 public:
  Change(const std::string& original, const std::string& copy) : copy_(copy) {
    write_bytes(copy, read_bytes(original));
  }

  void operator()(const std::function<void(hid_t file)>& change) const {
    const hid_t file = H5Fopen(copy_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(file, 0);
    change(file);
    ASSERT_GE(H5Fclose(file), 0);
  }

 private:
  std::string copy_;
};

/// Changes the first element of a dataset or an attribute: replaces a text, or flips the lowest bit of a number. read,
/// write: the HDF5 functions for it.
template <class Read, class Write>
void alter(hid_t type, hid_t space, const Read& read, const Write& write) {
  const auto count = static_cast<std::size_t>(H5Sget_simple_extent_npoints(space));
  std::vector<char> bytes(count * H5Tget_size(type));
  ASSERT_GE(read(type, bytes.data()), 0);
  if (H5Tis_variable_str(type) > 0) {
    std::string another = "another";
    auto* texts = reinterpret_cast<char**>(bytes.data());
    char* first = std::exchange(texts[0], another.data());
    ASSERT_GE(write(type, bytes.data()), 0);
    texts[0] = first;
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, bytes.data());
  } else {
    bytes.front() = static_cast<char>(bytes.front() ^ 1);
    ASSERT_GE(write(type, bytes.data()), 0);
  }
}

void alter_dataset(hid_t file, const std::string& path) {
  const hid_t dataset = H5Dopen2(file, path.c_str(), H5P_DEFAULT);
  const hid_t type = H5Dget_type(dataset);
  const hid_t space = H5Dget_space(dataset);
  alter(
      type, space, [&](hid_t as, void* to) { return H5Dread(dataset, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, to); },
      [&](hid_t as, void* from) { return H5Dwrite(dataset, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, from); });
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(dataset);
}

void alter_attribute(hid_t file, const Attribute& which) {
  const hid_t owner = H5Oopen(file, which.path.c_str(), H5P_DEFAULT);
  const hid_t attribute = H5Aopen(owner, which.name.c_str(), H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  const hid_t space = H5Aget_space(attribute);
  alter(
      type, space, [&](hid_t as, void* to) { return H5Aread(attribute, as, to); },
      [&](hid_t as, void* from) { return H5Awrite(attribute, as, from); });
  H5Sclose(space);
  H5Tclose(type);
  H5Aclose(attribute);
  H5Oclose(owner);
}

bool is_bookkeeping(const std::string& name) {
  return name == "CLASS" || name == "NAME" || name == "DIMENSION_LIST" || name == "REFERENCE_LIST";
}

class ContentHash : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (GetParam() == std::string("sensitivity")) {
      Example().write_sensitivity(original_);
    } else {
      Example().write_evaluation(original_, Pairing::every_pose_with_every_row);
    }
    hash_ = verify_result(original_).stored;
    ASSERT_EQ(hash_.size(), 64U);
  }

  std::string hash_after(const std::function<void(hid_t file)>& change) const {
    Change(original_, copy_)(change);
    return verify_result(copy_).computed;
  }

  TempFolder folder_;
  std::string original_ = folder_ / "original.h5";
  std::string copy_ = folder_ / "copy.h5";
  std::string hash_;
};

INSTANTIATE_TEST_SUITE_P(BothKinds, ContentHash, testing::Values("sensitivity", "evaluate"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(ContentHash, MatchesAFreshFile) { EXPECT_TRUE(verify_result(original_).matches()); }

TEST_P(ContentHash, ChangesWithEveryDataset) {
  const Inventory all = inventory(original_);
  EXPECT_GT(all.datasets.size(), 20U);
  for (const std::string& path : all.datasets) {
    const std::string hash = hash_after([&](hid_t file) { alter_dataset(file, path); });
    EXPECT_EQ(hash != hash_, outside_run(path)) << path;
  }
}

TEST_P(ContentHash, ChangesWithEveryAttribute) {
  const Inventory all = inventory(original_);
  EXPECT_GT(all.attributes.size(), 50U);
  for (const Attribute& attribute : all.attributes) {
    if (is_bookkeeping(attribute.name)) continue;
    if (attribute.name == "filetype" || attribute.name == "version") continue;  // without them it is not a result file
    const std::string hash = hash_after([&](hid_t file) { alter_attribute(file, attribute); });
    EXPECT_EQ(hash != hash_, outside_run(attribute.path) && attribute.name != "content_sha256")
        << attribute.path << " " << attribute.name;
  }
}

TEST_P(ContentHash, ChangesWithEveryName) {
  for (const std::string& path : inventory(original_).objects) {
    if (path == "/" || path == "/run") continue;
    const std::string hash = hash_after([&](hid_t file) {
      ASSERT_GE(H5Lmove(file, path.c_str(), file, (path + "x").c_str(), H5P_DEFAULT, H5P_DEFAULT), 0);
    });
    EXPECT_EQ(hash != hash_, outside_run(path)) << path;
  }
}

TEST_P(ContentHash, ChangesWithRemovedObjects) {
  for (const std::string& path : inventory(original_).objects) {
    if (path == "/") continue;
    const std::string hash = hash_after([&](hid_t file) { ASSERT_GE(H5Ldelete(file, path.c_str(), H5P_DEFAULT), 0); });
    EXPECT_EQ(hash != hash_, outside_run(path)) << path;
  }
}

TEST_P(ContentHash, FindsAFlippedBitInNumbers) {
  for (const std::string& path : inventory(original_).datasets) {
    haddr_t offset = HADDR_UNDEF;
    bool text = false;
    Change(original_, copy_)([&](hid_t file) {
      const hid_t dataset = H5Dopen2(file, path.c_str(), H5P_DEFAULT);
      const hid_t type = H5Dget_type(dataset);
      text = H5Tis_variable_str(type) > 0;
      offset = H5Dget_offset(dataset);
      H5Tclose(type);
      H5Dclose(dataset);
    });
    if (text || !outside_run(path)) continue;
    std::string bytes = read_bytes(original_);
    ASSERT_LT(offset, bytes.size()) << path;
    bytes[offset] = static_cast<char>(bytes[offset] ^ 4);
    write_bytes(copy_, bytes);
    EXPECT_FALSE(verify_result(copy_).matches()) << path;
  }
}

TEST_P(ContentHash, FindsAFlippedBitInText) {
  const std::string bytes = read_bytes(original_);
  const std::size_t at = bytes.find("epsilon_1");
  ASSERT_NE(at, std::string::npos);
  std::string flipped = bytes;
  flipped[at] = static_cast<char>(flipped[at] ^ 4);
  write_bytes(copy_, flipped);
  EXPECT_FALSE(verify_result(copy_).matches());
}

TEST(ContentHashOfFacts, DoesNotDependOnThem) {
  const TempFolder folder;
  Example example;
  example.write_sensitivity(folder / "a.h5");
  example.facts.created = "later";
  example.facts.host = "elsewhere";
  example.facts.threads = 7;
  example.facts.wall_seconds = 9.0;
  example.write_sensitivity(folder / "b.h5");
  EXPECT_NE(read_bytes(folder / "a.h5"), read_bytes(folder / "b.h5"));
  EXPECT_EQ(verify_result(folder / "a.h5").stored, verify_result(folder / "b.h5").stored);
}

// Computed with Python's hashlib from the definition in content_hash.h, for a root with one attribute and one dataset.
TEST(ContentHashDefinition, KnownAnswer) {
  h5::File file = h5::File::in_memory();
  const std::vector<double> values{1.0, std::bit_cast<double>(std::uint64_t{0xfff8000000000001U})};
  file.write<double>("/x", {2}, values);
  file.set_attribute("/", "title", std::string("ä"));
  file.set_attribute("/", "content_sha256", std::string("not part of it"));
  EXPECT_EQ(content_sha256(file), "7b8db24e29079e7c516c7b93e7d7c52d8c48397ad37317bd37a5dc2deadb0787");
}

}  // namespace
}  // namespace poesy::test
