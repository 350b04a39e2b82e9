#include "engine/storage/output_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "engine/base/error.h"
#include "engine/base/plain_file.h"
#include "engine/storage/content_hash.h"
#include "engine/storage/file_writer.h"
#include "engine/study/text_file.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kComment = "#";
constexpr std::string_view kUnfinished = "# being written: ";
/// Before the result that the files below are of.
constexpr std::string_view kResult = "# content_sha256 ";
constexpr std::string_view kSeparator = "  ";
constexpr std::size_t kHashLength = 2 * std::tuple_size_v<Sha256::Digest>;
constexpr std::size_t kMostBytes = 1 << 20;
constexpr const char* kRemedy = "name another folder with -d, or move it away";

bool is_hash(std::string_view text) {
  return text.size() == kHashLength && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

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

OutputFolder::OutputFolder(std::string path, const std::string& result)
    : path_(std::move(path)), result_(is_hash(result) ? result : "") {
  if (!stands(file(kListOfFiles))) return;
  std::istringstream text(read_text(file(kListOfFiles), "list of files", kMostBytes));
  std::string of;
  for (std::string line; std::getline(text, line);) read_line(line, of);
}

std::string OutputFolder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

/// result: that of the lines above; a line that names one sets it.
void OutputFolder::read_line(const std::string& line, std::string& result) {
  Listed listed{.hash = {}, .result = result};
  std::string name;
  if (line.starts_with(kResult)) {
    const std::string hash = line.substr(kResult.size());
    result = is_hash(hash) ? hash : "";
    return;
  }
  if (line.starts_with(kUnfinished)) {
    name = line.substr(kUnfinished.size());
  } else if (line.empty() || line.starts_with(kComment)) {
    return;
  } else if (line.size() > kHashLength + kSeparator.size() &&
             line.compare(kHashLength, kSeparator.size(), kSeparator) == 0) {
    listed.hash = line.substr(0, kHashLength);
    name = line.substr(kHashLength + kSeparator.size());
  }
  const bool is_name = !name.empty() && fs::path(name).filename() == name;
  if (!is_name || (!listed.hash.empty() && !is_hash(listed.hash))) {
    throw InputError({.file = file(kListOfFiles)}, "exists, was not written by poesy, and would be lost", kRemedy);
  }
  listed_[name] = listed;
}

/// Throws InputError where what has this name must not be replaced or removed. Precondition: something has it.
void OutputFolder::check(const std::string& name) const {
  const std::string path = file(name);
  const auto refuse = [&](const std::string& problem) { throw InputError({.file = path}, problem, kRemedy); };
  std::error_code ignored;
  if (fs::symlink_status(path, ignored).type() != fs::file_type::regular) {
    refuse("is not a plain file and will not be replaced");
  }
  const auto listed = listed_.find(name);
  if (listed == listed_.end()) {
    refuse(
        fmt::format("exists and was not written by poesy ({} does not list it), and it would be lost", kListOfFiles));
  }
  const std::string& hash = listed->second.hash;
  const bool unfinished = hash.empty();
  if (!unfinished && hash_of(path) != hash) {
    refuse("was changed since poesy wrote it, and the changes would be lost");
  }
}

void OutputFolder::claim(const std::string& name) {
  std::string& before = claimed_[name];
  if (!stands(file(name))) return;
  check(name);
  before = hash_of(file(name)).value_or("");
}

void OutputFolder::fill(const std::function<void()>& write) {
  std::vector<std::string> others;  // of other results
  for (const auto& [name, listed] : listed_) {
    const bool of_this = !result_.empty() && listed.result == result_;
    if (of_this || claimed_.contains(name) || !stands(file(name))) continue;
    check(name);
    others.push_back(name);
  }
  make_folder(path_);
  for (const auto& [name, before] : claimed_) listed_[name] = {.hash = {}, .result = result_};
  try {
    write_list();
    write();
    remove(others);
    for (const auto& [name, before] : claimed_) listed_[name].hash = hash_of(file(name)).value_or("");
    std::erase_if(listed_, [&](const auto& one) { return !stands(file(one.first)); });
    write_list();
  } catch (const FileError& error) {
    throw FileError("", error.what(), what_is_there());
  }
}

void OutputFolder::remove(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    std::error_code error;
    fs::remove(file(name), error);
    if (!error) continue;
    throw FileError(file(name), "is of another result and cannot be removed (" + error.message() + ")", "remove it");
  }
}

/// After a failure: how many of the claimed files are new.
std::string OutputFolder::what_is_there() const {
  const auto is_new = [&](const auto& claimed) {
    return stands(file(claimed.first)) && hash_of(file(claimed.first)) != claimed.second;
  };
  const auto written = static_cast<std::size_t>(std::ranges::count_if(claimed_, is_new));
  if (written == 0) return "the files in " + path_ + " are as they were before";
  return fmt::format("{} of the {} files in {} are new, any others are those of before: do not use them together",
                     written, claimed_.size(), path_);
}

void OutputFolder::write_list() const {
  std::string text = "# Files that poesy wrote here; it replaces them while they are unchanged (sha256sum -c)\n";
  std::set<std::string> results;
  for (const auto& [name, listed] : listed_) results.insert(listed.result);
  for (const std::string& result : results) {
    text += std::string(kResult) + (result.empty() ? "unknown" : result) + '\n';
    for (const auto& [name, listed] : listed_) {
      if (listed.result != result) continue;
      text += listed.hash.empty() ? std::string(kUnfinished) : listed.hash + std::string(kSeparator);
      text += name + '\n';
    }
  }
  FileWriter writer(file(kListOfFiles));
  writer.write(text);
  writer.commit();
}

}  // namespace poesy
