#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace poesy {

/// Says what is at a path if it is not a plain file: "a folder", "a FIFO", "a device", "a socket". Empty for a plain
/// file, for a path where nothing is, and if the type is unknown. The function does not open the path, because opening
/// a FIFO waits for a writer.
std::string_view other_than_file(const std::string& path);

/// A plain file that is open for reading. Opening never blocks.
class PlainFile {
 public:
  explicit PlainFile(const std::string& path);  ///< Opens the file if it is a plain file; see is_open().
  PlainFile(const PlainFile&) = delete;
  PlainFile& operator=(const PlainFile&) = delete;
  ~PlainFile();

  bool is_open() const { return descriptor_ >= 0; }  ///< Returns true if the file is open.
  /// The reason why the file is not open. other() is empty unless the reason is that the path is not a plain file.
  /// @{
  std::string_view other() const { return other_; }  ///< result of other_than_file()
  int error() const { return error_; }  ///< errno of opening; EINVAL if other() is not empty; 0 if the file is open
  /// @}

  /// Reads from byte `at` of the file until `to` is full or the file ends. Returns the number of bytes; none on a disk
  /// error, with the reason in errno. It never blocks, even for special files that look plain, such as /proc/kmsg.
  /// Precondition of this and the functions below: is_open().
  std::optional<std::size_t> read(std::uintmax_t at, std::span<std::byte> to) const;
  /// Passes the whole file to take(), piece by piece. Returns false on a disk error, with the reason in errno.
  /// Exceptions of take() are not caught.
  bool read_parts(const std::function<void(std::span<const std::byte> part)>& take) const;
  std::uintmax_t size() const;  ///< Size in bytes; 0 if not known.
  /// Size in bytes without the holes of a sparse file.
  std::uintmax_t stored_bytes() const;

 private:
  int descriptor_ = -1;
  int error_ = 0;
  std::string_view other_;
};

}  // namespace poesy
