#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace poesy {

/// What there is at a path in place of a plain file: "a folder", "a FIFO", "a device", "a socket". Empty for a plain
/// file, and where nothing can be looked at. Opens nothing: to open a FIFO is to wait for whoever writes to it.
std::string_view other_than_file(const std::string& path);

/// A plain file that is open for reading. Opening never waits.
class PlainFile {
 public:
  explicit PlainFile(const std::string& path);  ///< Opens the file there if it is a plain one; see is_open().
  PlainFile(const PlainFile&) = delete;
  PlainFile& operator=(const PlainFile&) = delete;
  ~PlainFile();

  bool is_open() const { return descriptor_ >= 0; }  ///< Whether it has a file open.
  /// Why it is not open.
  /// @{
  std::string_view other() const { return other_; }  ///< what other_than_file() says
  int error() const { return error_; }               ///< the errno of opening; EINVAL where other() says something
  /// @}

  /// Reads from position `at` on until `to` is full or the file ends: the number of bytes. None where the disk fails,
  /// with the reason in errno. Reading does not wait either, not even for the next message of /proc/kmsg, which looks
  /// like a plain file. Precondition: is_open(), as for those below.
  std::optional<std::size_t> read(std::uintmax_t at, std::span<std::byte> to) const;
  /// Hands the whole file to `take`, part by part from the beginning. False where the disk fails, with the reason in
  /// errno. What `take` throws goes through.
  bool read_parts(const std::function<void(std::span<const std::byte> part)>& take) const;
  std::uintmax_t size() const;  ///< Bytes; 0 where the system does not tell.
  /// Bytes that are on the disk: without the holes of a sparse file, which make it look as large as one likes.
  std::uintmax_t stored_bytes() const;

 private:
  int descriptor_ = -1;
  int error_ = 0;
  std::string_view other_;
};

}  // namespace poesy
