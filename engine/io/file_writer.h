#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace poesy {

/// Writes a file that appears whole or not at all under its name: beside it under a temporary name, and at the end
/// synced and renamed. Destroyed before commit, it removes the temporary file; what stood under the name stays.
/// Every member throws FileError with the system's reason.
class FileWriter {
 public:
  /// Refuses a path where something other than a plain file stands (a folder, a device).
  explicit FileWriter(std::string path);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Puts the file in its place. Nothing may be written afterwards.
  void commit();

 private:
  [[noreturn]] void fail(std::string_view action, int error) const;
  void close_file();

  std::string path_;
  std::string temporary_;
  int descriptor_ = -1;
};

}  // namespace poesy
