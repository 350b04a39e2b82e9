#include "engine/base/plain_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>

namespace poesy {
namespace {

/// What a mode says; empty for a plain file.
std::string_view other_of(mode_t mode) {
  switch (mode & S_IFMT) {
    case S_IFDIR:
      return "a folder";
    case S_IFIFO:
      return "a FIFO";
    case S_IFCHR:
    case S_IFBLK:
      return "a device";
    case S_IFSOCK:
      return "a socket";
    default:
      return {};
  }
}

}  // namespace

std::string_view other_than_file(const std::string& path) {
  struct stat there {};
  return ::stat(path.c_str(), &there) == 0 ? other_of(there.st_mode) : std::string_view();
}

PlainFile::PlainFile(const std::string& path) : other_(other_than_file(path)) {
  if (other_.empty()) {
    descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    struct stat opened {};
    error_ = is_open() && ::fstat(descriptor_, &opened) == 0 ? 0 : errno;
    if (error_ == 0) other_ = other_of(opened.st_mode);
  }
  if (!other_.empty()) error_ = EINVAL;
  if (error_ != 0 && is_open()) ::close(std::exchange(descriptor_, -1));
}

PlainFile::PlainFile(PlainFile&& other) noexcept { *this = std::move(other); }

PlainFile& PlainFile::operator=(PlainFile&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  std::swap(error_, other.error_);
  std::swap(other_, other.other_);
  return *this;
}

PlainFile::~PlainFile() {
  if (is_open()) ::close(descriptor_);
}

std::optional<std::size_t> PlainFile::read(std::uintmax_t at, std::span<std::byte> to) const {
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t bytes = ::pread(descriptor_, to.data() + done, to.size() - done, static_cast<off_t>(at + done));
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) return std::nullopt;
    if (bytes == 0) break;
    done += static_cast<std::size_t>(bytes);
  }
  return done;
}

bool PlainFile::read_parts(const std::function<void(std::span<const std::byte>)>& take) const {
  constexpr std::size_t kPart = 1 << 16;
  std::array<std::byte, kPart> part{};
  std::uintmax_t at = 0;
  while (const auto bytes = read(at, part)) {
    if (*bytes == 0) return true;
    take(std::span(part).first(*bytes));
    at += *bytes;
  }
  return false;
}

std::uintmax_t PlainFile::size() const {
  struct stat file {};
  return ::fstat(descriptor_, &file) == 0 ? static_cast<std::uintmax_t>(file.st_size) : 0;
}

std::uintmax_t PlainFile::stored_bytes() const {
  constexpr int kMostPieces = 10'000;
  std::uintmax_t bytes = 0;
  off_t end = 0;
  for (int piece = 0; piece < kMostPieces; ++piece) {
    const off_t begin = ::lseek(descriptor_, end, SEEK_DATA);
    if (begin < 0) break;  // no data follow
    end = ::lseek(descriptor_, begin, SEEK_HOLE);
    if (end < 0) break;
    bytes += static_cast<std::uintmax_t>(end - begin);
  }
  return bytes;
}

}  // namespace poesy
