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
  /// Refuses a path where something other than a plain file stands (a folder, a device). temporary: a path in the same
  /// folder, where a file that stands there is lost; by default one that no other process uses.
  explicit FileWriter(std::string path, std::string temporary = {});
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// The size that the file is going to have, for the message when it finds no room.
  void expect(std::size_t bytes) { expected_ = bytes; }
  /// Appends. Throws FileError.
  void write(std::span<const std::byte> bytes);
  /// Appends. Throws FileError.
  void write(std::string_view text);
  /// Brings everything to the disk. Nothing may be written afterwards.
  void sync();
  /// Syncs, unless that was done, and puts the file in its place.
  void commit();

 private:
  [[noreturn]] void fail(std::string_view action, int error) const;
  std::string remedy(int error) const;
  std::string missing_space() const;

  std::string path_;
  std::string temporary_;
  std::size_t expected_ = 0;
  int descriptor_ = -1;
};

/// Writes a whole file, or nothing. Throws FileError.
void write_text(const std::string& path, std::string_view text);

}  // namespace poesy
