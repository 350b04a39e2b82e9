#include "engine/storage/output_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "engine/base/error.h"
#include "engine/storage/file_writer.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTitle =
    "# Files that poesy wrote here; it replaces or removes them while they are unchanged";
constexpr std::string_view kResult = "# content_sha256 ";
constexpr std::string_view kUnfinished = "# unfinished";
constexpr std::string_view kUnknown = "unknown";
constexpr const char* kRemedy = "name another folder with -d, or move it away";

/// The inode number of a file; 0 if there is no file. It changes when the file is replaced.
ino_t file_at(const std::string& path) {
  struct stat found {};
  return ::lstat(path.c_str(), &found) == 0 ? found.st_ino : 0;
}

}  // namespace

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder, "cannot be made (" + error.message() + ")", "choose another folder");
}

OutputFolder::OutputFolder(std::string path, const std::string& result)
    : path_(std::move(path)), result_(result.empty() ? kUnknown : result) {
  if (stands(file(kManifest))) read_manifest();
}

std::string OutputFolder::file(const std::string& name) const { return (fs::path(path_) / name).string(); }

void OutputFolder::read_manifest() {
  const std::string path = file(kManifest);
  const auto expect = [&](bool ours) {
    if (ours) return;
    throw InputError({.file = path}, "exists, was not written by poesy, and would be lost", kRemedy);
  };
  std::error_code error;
  expect(fs::is_regular_file(path, error));
  std::ifstream text(path);
  std::string line;
  expect(std::getline(text, line) && line == kTitle);
  while (std::getline(text, line)) {
    if (line == kUnfinished) {
      unfinished_ = true;
    } else if (line.starts_with(kResult)) {
      listed_result_ = line.substr(kResult.size());
    } else {
      expect(!line.empty() && fs::path(line).filename() == line);
      listed_.insert(line);
    }
  }
  const auto written = fs::last_write_time(path, error);
  for (const std::string& name : listed_) {
    const auto time = fs::last_write_time(file(name), error);
    if (!error && !unfinished_ && time > written) changed_.insert(name);
  }
}

/// Throws InputError if this file must not be replaced or removed. Precondition: the file exists.
void OutputFolder::check(const std::string& name) const {
  const auto refuse = [&](const std::string& problem) { throw InputError({.file = file(name)}, problem, kRemedy); };
  std::error_code ignored;
  if (fs::symlink_status(file(name), ignored).type() != fs::file_type::regular) {
    refuse("is not a plain file and will not be replaced");
  }
  if (!listed_.contains(name)) {
    refuse(fmt::format("exists and was not written by poesy ({} does not list it), and it would be lost", kManifest));
  }
  if (changed_.contains(name)) {
    refuse(fmt::format("was changed since poesy wrote it (it is newer than {}), and the changes would be lost",
                       kManifest));
  }
}

void OutputFolder::claim(const std::string& name) {
  if (stands(file(name))) check(name);
  claimed_[name] = file_at(file(name));
}

void OutputFolder::fill(const std::function<void()>& write) {
  const bool of_this = !unfinished_ && result_ != kUnknown && listed_result_ == result_;
  std::set<std::string> names;
  std::set<std::string> others;  // files of other results
  for (const std::string& name : listed_) {
    if (claimed_.contains(name) || !stands(file(name))) continue;
    if (!of_this) {
      check(name);
      others.insert(name);
    }
    if (!changed_.contains(name)) names.insert(name);
  }
  for (const auto& [name, before] : claimed_) names.insert(name);
  make_folder(path_);
  try {
    write_manifest(std::string(kUnfinished), names);
    write();
    remove(others);
    std::erase_if(names, [&](const std::string& name) { return !stands(file(name)); });
    write_manifest(std::string(kResult) + result_, names);
  } catch (const FileError& error) {
    throw FileError("", error.what(), what_is_there());
  }
}

void OutputFolder::remove(const std::set<std::string>& names) const {
  for (const std::string& name : names) {
    std::error_code error;
    fs::remove(file(name), error);
    if (!error) continue;
    throw FileError(file(name), "is of another result and cannot be removed (" + error.message() + ")", "remove it");
  }
}

/// The last part of the message after a failure: how many of the claimed files were replaced.
std::string OutputFolder::what_is_there() const {
  const auto is_new = [&](const auto& claimed) { return file_at(file(claimed.first)) != claimed.second; };
  const auto written = static_cast<std::size_t>(std::ranges::count_if(claimed_, is_new));
  if (written == 0) return "the files in " + path_ + " are as they were before";
  return fmt::format("{} of the {} files in {} are new, any others are those of before: do not use them together",
                     written, claimed_.size(), path_);
}

void OutputFolder::write_manifest(const std::string& state, const std::set<std::string>& names) const {
  std::string text = std::string(kTitle) + '\n' + state + '\n';
  for (const std::string& name : names) text += name + '\n';
  write_text(file(kManifest), text);
}

}  // namespace poesy
