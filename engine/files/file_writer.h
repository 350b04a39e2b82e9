#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace poesy {

/// A kind of file that the program writes.
struct OutputKind {
  std::string_view name;                             ///< "result"
  bool (*may_be_replaced)(const std::string& path);  ///< whether a file that stands there is of this kind, or empty
};

/// Whether a file is empty, or has this mark in its first kilobyte.
bool is_marked(const std::string& path, std::string_view mark);

/// Throws when no such file can come into being at this path, before anything is computed: InputError when its folder
/// does not exist, when what stands there is one of the inputs or must not be replaced, FileError when the folder
/// cannot be written.
void check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs);

bool stands(const std::string& path);  ///< Whether anything has this name, a link that leads nowhere too.

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
  void write(std::span<const std::byte> bytes);  ///< Appends.
  void write(std::string_view text);             ///< Appends.
  void sync();                                   ///< Brings everything to the disk. Nothing may be written afterwards.
  void commit();                                 ///< Syncs, unless that was done, and puts the file in its place.

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
