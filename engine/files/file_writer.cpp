#include "engine/files/file_writer.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <utility>

#include "engine/base/error.h"

namespace poesy {
namespace {

constexpr int kClosed = -1;

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
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
