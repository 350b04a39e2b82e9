#include "engine/files/output_folder.h"

#include <fmt/format.h>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/plain_file.h"
#include "engine/files/content_hash.h"
#include "engine/files/file_writer.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kComment = "#";
constexpr std::string_view kUnfinished = "# being written: ";
constexpr std::string_view kSeparator = "  ";
constexpr std::size_t kHashLength = 2 * std::tuple_size_v<Sha256::Digest>;
constexpr std::size_t kMostBytes = 1 << 20;
constexpr const char* kRemedy = "name another folder with -d, or move it away";

/// SHA-256 of a file; none when it cannot be read.
std::optional<std::string> hash_of(const std::string& path) {
  const PlainFile file(path);
  Sha256 hash;
  if (!file.is_open() || !file.read_parts([&](std::span<const std::byte> part) { hash.bytes(part); })) {
    return std::nullopt;
  }
  return hex(hash.digest());
}

}  // namespace

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot be made (" + error.message() + ")", "choose another folder");
}

OutputFolder::OutputFolder(std::string path) : path_(std::move(path)) {
  if (!stands(file(kListOfFiles))) return;
  std::istringstream text(read_text(file(kListOfFiles), "list of files", kMostBytes));
  for (std::string line; std::getline(text, line);) read_line(line);
}

std::string OutputFolder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

void OutputFolder::read_line(const std::string& line) {
  if (line.starts_with(kUnfinished)) {
    hashes_[line.substr(kUnfinished.size())].clear();
  } else if (!line.empty() && !line.starts_with(kComment)) {
    const std::size_t name = kHashLength + kSeparator.size();
    const bool hash = line.find_first_not_of("0123456789abcdef") == kHashLength;
    if (!hash || line.size() <= name || line.compare(kHashLength, kSeparator.size(), kSeparator) != 0) {
      throw InputError({.file = file(kListOfFiles)}, "exists and is no list of poesy, and it would be lost", kRemedy);
    }
    hashes_[line.substr(name)] = line.substr(0, kHashLength);
  }
}

void OutputFolder::claim(const std::string& name) {
  claimed_.push_back(name);
  const std::string path = file(name);
  if (!stands(path)) return;
  const auto refuse = [&](const std::string& problem) { throw InputError({.file = path}, problem, kRemedy); };
  std::error_code ignored;
  if (fs::symlink_status(path, ignored).type() != fs::file_type::regular) {
    refuse("is not a plain file and will not be replaced");
  }
  const auto listed = hashes_.find(name);
  if (listed == hashes_.end()) {
    refuse(
        fmt::format("exists and was not written by poesy ({} does not list it), and it would be lost", kListOfFiles));
  }
  const bool unfinished = listed->second.empty();
  if (!unfinished && hash_of(path) != listed->second) {
    refuse("was changed since poesy wrote it, and the changes would be lost");
  }
}

void OutputFolder::open() {
  make_folder(path_);
  for (const std::string& name : claimed_) hashes_[name].clear();
  write_list();
}

void OutputFolder::close() {
  for (const std::string& name : claimed_) hashes_[name] = hash_of(file(name)).value_or("");
  std::erase_if(hashes_, [&](const auto& listed) { return !stands(file(listed.first)); });
  write_list();
}

void OutputFolder::write_list() const {
  std::string text = "# Files that poesy wrote here; it replaces them while they are unchanged (sha256sum -c)\n";
  for (const auto& [name, hash] : hashes_) {
    text += hash.empty() ? std::string(kUnfinished) : hash + std::string(kSeparator);
    text += name + '\n';
  }
  FileWriter writer(file(kListOfFiles));
  writer.write(text);
  writer.commit();
}

}  // namespace poesy
