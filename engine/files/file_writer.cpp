#include "engine/files/file_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "engine/base/error.h"

namespace poesy {
namespace {

namespace fs = std::filesystem;

constexpr int kClosed = -1;

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

/// What stands at the path must not be lost.
void check_present(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  if (!fs::is_regular_file(path, ignored)) {
    throw InputError({.file = path}, fs::is_directory(path, ignored) ? "is a folder" : "is not a plain file",
                     fmt::format("name a file for the {}", kind.name));
  }
  for (const std::string& input : inputs) {
    if (!fs::equivalent(path, input, ignored)) continue;
    throw InputError({.file = path}, fmt::format("is also an input, which the {} would replace", kind.name),
                     "name another file with -o");
  }
  if (kind.may_be_replaced(path)) return;
  throw InputError({.file = path}, fmt::format("exists and is no {} of poesy, and it would be lost", kind.name),
                   "name another file with -o, or remove it");
}

/// Makes the rename survive a crash. Some file systems cannot sync a folder: the file itself is safe there.
bool sync_folder(const std::string& path) {
  const int folder = ::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder == kClosed) return errno == EACCES;
  const bool synced = ::fsync(folder) == 0 || errno == EINVAL;
  const int error = errno;
  ::close(folder);
  errno = error;
  return synced;
}

}  // namespace

bool is_marked(const std::string& path, std::string_view mark) {
  constexpr std::size_t kHead = 1024;
  std::string head(kHead, '\0');
  std::ifstream file(path, std::ios::binary);
  if (!file) return false;
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(file.gcount()));
  return head.empty() || head.find(mark) != std::string::npos;
}

void check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs) {
  const fs::path folder = folder_of(path);
  check_present(path, kind, inputs);
  if (std::error_code ignored; !fs::is_directory(folder, ignored)) {
    throw InputError({.file = path}, "its folder " + folder.string() + " does not exist", "make it or choose another");
  }
  if (!fs::path(path).has_filename()) {
    throw InputError({.file = path}, "names no file", fmt::format("name a file for the {}", kind.name));
  }
  if (::access(folder.c_str(), W_OK | X_OK) != 0) {
    const std::string reason = std::generic_category().message(errno);
    throw FileError(path, "cannot be written into its folder (" + reason + ")", "choose another folder");
  }
}

bool stands(const std::string& path) {
  std::error_code ignored;
  return fs::exists(fs::symlink_status(path, ignored));
}

FileWriter::FileWriter(std::string path, std::string temporary)
    : path_(std::move(path)), temporary_(std::move(temporary)) {
  if (temporary_.empty()) temporary_ = path_ + ".tmp." + std::to_string(::getpid());
  struct stat there {};
  if (::stat(path_.c_str(), &there) == 0 && !S_ISREG(there.st_mode)) {
    throw FileError(path_, "is not a plain file and will not be replaced", "choose another name");
  }
  constexpr mode_t kReadableByAll = 0666;  // before the umask
  descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kReadableByAll);
  if (descriptor_ == kClosed) fail("cannot be created", errno);
}

FileWriter::~FileWriter() {
  if (descriptor_ != kClosed) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void FileWriter::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail("cannot be written", errno);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void FileWriter::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void FileWriter::sync() {
  if (::fsync(descriptor_) != 0) fail("cannot be written", errno);
  if (::close(std::exchange(descriptor_, kClosed)) != 0) fail("cannot be written", errno);
}

void FileWriter::commit() {
  if (descriptor_ != kClosed) sync();
  if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail("cannot be put in place", errno);
  temporary_.clear();
  if (!sync_folder(path_)) fail("is in place, but its folder cannot be synced", errno);
}

/// "needs N bytes, M are free", as much as is known; what was written so far counts as free, for it is going to be.
std::string FileWriter::missing_space() const {
  std::string text = expected_ == 0 ? "" : "; needs " + std::to_string(expected_) + " bytes";
  struct statvfs disk {};
  struct stat file {};
  constexpr std::uintmax_t kStatBlock = 512;  // the unit of st_blocks
  if (::fstatvfs(descriptor_, &disk) == 0 && ::fstat(descriptor_, &file) == 0) {
    const std::uintmax_t free = std::uintmax_t{disk.f_bavail} * disk.f_frsize + file.st_blocks * kStatBlock;
    text += (text.empty() ? "; " : ", ") + std::to_string(free) + " are free";
  }
  return text;
}

std::string FileWriter::remedy(int error) const {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
      return "make room or choose another folder";
    case EFBIG:
      return "raise the limit on file sizes" + (expected_ == 0 ? "" : " to " + std::to_string(expected_) + " bytes") +
             " or choose another folder";
    case ENOENT:
    case ENOTDIR:
      return "make the folder or choose another one";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose a folder that you may write to";
    default:
      return "choose another folder, or repair the disk";
  }
}

void FileWriter::fail(std::string_view action, int error) const {
  std::string reason = std::generic_category().message(error);
  if (error == ENOSPC && descriptor_ != kClosed) reason += missing_space();
  throw FileError(path_, std::string(action) + " (" + reason + ")", remedy(error));
}

void write_text(const std::string& path, std::string_view text) {
  FileWriter file(path);
  file.expect(text.size());
  file.write(text);
  file.commit();
}

}  // namespace poesy
