#include "engine/base/plain_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace poesy {

std::string_view other_than_file(const std::string& path) {
  struct stat there {};
  if (::stat(path.c_str(), &there) != 0) return {};
  switch (there.st_mode & S_IFMT) {
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

PlainFile::PlainFile(const std::string& path) : error_(EINVAL), other_(other_than_file(path)) {
  if (!other_.empty()) return;
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  error_ = is_open() ? 0 : errno;
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
