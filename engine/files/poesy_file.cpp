#include "engine/files/poesy_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "engine/files/checkpoint.h"

namespace poesy {
namespace {

constexpr const char* kOther = "give a result file written by poesy";

bool is_checkpoint(const std::string& path) {
  std::array<char, kCheckpointMagic.size()> begin{};
  std::ifstream(path, std::ios::binary).read(begin.data(), begin.size());
  return std::ranges::equal(begin, kCheckpointMagic);
}

h5::File open_hdf5(const std::string& path) {
  try {
    return h5::File::open(path);
  } catch (const h5::Error& error) {
    if (is_checkpoint(path)) {
      throw FileError(path, "is a checkpoint of a run that has not ended, not a result",
                      "continue the run with poesy run --resume");
    }
    throw FileError(path, std::string("is not an intact HDF5 file: ") + error.what(), kOther);
  }
}

/// Empty when the file is none of poesy's.
std::string filetype_of(const h5::File& file) {
  try {
    return file.has_attribute("/", "filetype") ? text_attribute(file, "filetype") : "";
  } catch (const h5::Error&) {
    return "";  // an attribute of that name, but not text
  }
}

void check_version(const std::string& path, const h5::File& file) {
  const auto version = file.attribute<std::int64_t>("/", "version");
  if (version.size() != 2) throw h5::Error("attribute 'version' is not two numbers");
  if (version[0] > kMajorVersion) {
    throw FileError(
        path,
        "is of format version " + std::to_string(version[0]) + "." + std::to_string(version[1]) +
            ", newer than this program's " + std::to_string(kMajorVersion) + "." + std::to_string(kMinorVersion),
        "use the poesy that wrote it (" + printable(text_attribute(file, "poesy_version")) + ") or a newer one");
  }
}

}  // namespace

std::string text_attribute(const h5::File& file, const std::string& name) {
  const auto values = file.attribute<std::string>("/", name);
  if (values.size() != 1) throw h5::Error("attribute '" + name + "' is not one text");
  return values.front();
}

void check_readable(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw FileError(path, "is a folder", kOther);
  errno = 0;
  if (!std::ifstream(path)) {
    throw FileError(path, "cannot be read (" + std::generic_category().message(errno) + ")", kOther);
  }
}

h5::File open_poesy_file(const std::string& path) {
  h5::File file = open_hdf5(path);
  const std::string filetype = filetype_of(file);
  if (filetype != kResultFile && filetype != kShardFile) {
    throw FileError(path, "is an HDF5 file, but not a result of poesy", kOther);
  }
  check_version(path, file);
  return file;
}

void expect_filetype(const std::string& path, const h5::File& file, std::string_view filetype) {
  if (filetype_of(file) == filetype) return;
  if (filetype == kResultFile) {
    throw FileError(path, "is a shard of a study, not a whole result", "put all shards together with poesy merge");
  }
  throw FileError(path, "is a whole result, not a shard of one", "give files that poesy run --shard wrote");
}

}  // namespace poesy
