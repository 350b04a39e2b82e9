#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace poesy {

/// What there is at a path in place of a plain file: "a folder", "a FIFO", "a device", "a socket". Empty for a plain
/// file, and where nothing can be looked at. Opens nothing: to open a FIFO is to wait for whoever writes to it.
std::string_view other_than_file(const std::string& path);

/// A plain file that is open for reading. Opening does not wait, and what was opened is looked at once more, because
/// another file may have taken the place of the first: neither a FIFO nor a device ever is a PlainFile.
class PlainFile {
 public:
  PlainFile() = default;                             ///< None.
  explicit PlainFile(const std::string& path);       ///< Opens what is there, if it is a plain file.
  PlainFile(PlainFile&& other) noexcept;             ///< Leaves none.
  PlainFile& operator=(PlainFile&& other) noexcept;  ///< Exchanges the two.
  ~PlainFile();

  bool is_open() const { return descriptor_ >= 0; }  ///< Whether there is one.
  /// Why it is not open.
  /// @{
  std::string_view other() const { return other_; }  ///< as other_than_file says
  int error() const { return error_; }               ///< of errno; EINVAL where there is something other
  /// @}

  /// Reads from position `at` on until `to` is full or the file ends: the number of bytes. None where the disk fails,
  /// with the reason in errno. Reading does not wait either, not even for the next message of /proc/kmsg, which looks
  /// like a plain file. Precondition: is_open(), as for those below.
  std::optional<std::size_t> read(std::uintmax_t at, std::span<std::byte> to) const;
  std::uintmax_t size() const;  ///< Bytes; 0 where the system does not tell.
  /// Bytes that are on the disk: without the holes of a sparse file, which make it look as large as one likes.
  std::uintmax_t stored_bytes() const;

 private:
  int descriptor_ = -1;
  int error_ = 0;
  std::string_view other_;
};

}  // namespace poesy
