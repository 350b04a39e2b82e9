#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

struct stat;

namespace poesy {

/// A kind of file that the program writes.
struct OutputKind {
  std::string_view name;  ///< name of the kind, such as "result"
  /// Returns true if the existing file at `path` is of this kind, or empty.
  bool (*may_be_replaced)(const std::string& path);
  /// Longest text that is added to the file's name for the names of further files, such as checkpoints.
  std::string_view longest_end = {};
};

/// Throws InputError if the name is too long for a FileWriter in this folder.
void check_name_length(const std::string& path);

/// The content of a plain file, empty if it cannot be read; none if there is no plain file.
std::optional<std::string> content_of(const std::string& path);
/// Returns true if a plain file contains the text `mark` in its first 64 KiB.
bool has_mark(const std::string& path, std::string_view mark);
/// Returns true if a plain file contains the text `mark` in its first 64 KiB, or is empty.
bool is_marked(const std::string& path, std::string_view mark);

/// Checks, before anything is computed, that a file can be written to this path. Returns the path to write to: for a
/// symbolic link its target, which may not exist yet, otherwise the path itself. Throws InputError if the folder does
/// not exist, if the file at the path is one of the inputs or must not be replaced, if the name is too long, or if
/// links form a circle. Throws FileError if the folder is not writable.
std::string check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs);

bool stands(const std::string& path);  ///< Returns true if there is anything at this path, including a broken link.

/// Removes temporary files of FileWriter that killed programs left beside this file: PATH.tmp. followed by twelve
/// digits. Files that cannot be removed stay. Precondition: nobody is writing this file.
void remove_left_over(const std::string& path);

/// A function that fills bytes with random numbers: fill_randomly(), or a substitute in a test. Returns true if it
/// succeeded; if not, errno has the reason.
using FillRandomly = bool (*)(std::span<std::byte> bytes);
bool fill_randomly(std::span<std::byte> bytes);  ///< Fills bytes with random numbers of the system.

/// Writes a file that appears complete or not at all. The file is written in the same folder under an unpredictable
/// temporary name, and finally synced and renamed. If the object is destroyed before commit(), the temporary file is
/// removed and an existing file stays. A symbolic link at the path is replaced, not followed; use check_output_path()
/// to get its target. Every member throws FileError with the system's reason.
class FileWriter {
 public:
  /// Refuses a path at which there is something other than a plain file (a folder, a device). The new file gets the
  /// permission bits of the file `like` if that exists, otherwise those of the file that it replaces, otherwise those
  /// that the umask allows. fill: gives the random bytes of the temporary name. If a file with the temporary name
  /// exists, it is not changed, and FileError is thrown.
  explicit FileWriter(std::string path, const std::string& like = {}, FillRandomly fill = fill_randomly);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// A function that returns the final size of the file in bytes. It is called only if the disk is full, for the
  /// message.
  using ExpectedSize = std::function<std::size_t()>;
  /// Sets the function that returns the expected size.
  void expect(ExpectedSize size) { expected_ = std::move(size); }
  /// Sets the expected size of the file, for the message if the disk is full.
  void expect(std::size_t bytes) {
    expect([bytes] { return bytes; });
  }
  void write(std::span<const std::byte> bytes);  ///< Appends bytes.
  void write(std::string_view text);             ///< Appends text.

  /// Functions for a caller that writes in any order and cannot stop at an error, such as HDF5.
  /// @{
  /// Writes bytes that begin at byte number `at` of the file. The first error is kept for check(), and nothing more is
  /// written after it.
  void put(std::uint64_t at, std::span<const std::byte> bytes) noexcept;
  /// Reads the bytes from byte number `at` on; bytes that put() did not write are zero. Returns true if it succeeded;
  /// after an error it always fails.
  bool get(std::uint64_t at, std::span<std::byte> to) noexcept;
  /// Sets the length of the file, which is also the expected size, even after an error.
  void end_at(std::uint64_t bytes) noexcept;
  void check() const;  ///< Throws the error that put() kept, if any; sync() and commit() do so too.
  /// @}

  void sync();    ///< Writes everything to the disk. Nothing may be written afterwards.
  void commit();  ///< Syncs if necessary, and renames the file.

 private:
  std::uint64_t expected_size() const;  ///< The expected size of the file in bytes; 0 if not known.
  [[noreturn]] void fail(std::string_view action, int error) const;
  std::string remedy(int error) const;
  std::string missing_space() const;

  std::string path_;
  std::string temporary_;
  ExpectedSize expected_;     // empty if not given
  std::uint64_t length_ = 0;  // length that put() and end_at() gave, even after an error
  int descriptor_ = -1;
  int error_ = 0;  // first error of put(), get() or end_at(), an errno
};

/// Writes a whole file, or nothing. Throws FileError.
void write_text(const std::string& path, std::string_view text);

/// A function that gives a file a second name: POSIX link(), or a substitute in a test. Returns 0, or -1 with errno.
using LinkFile = int (*)(const char* existing, const char* second);

/// Gives the file at `path` a second name, `second`, and atomically replaces an existing file there. `path` exists at
/// any moment. On a file system without hard links the file is copied. If it throws FileError, both names are as
/// before.
void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file);

/// Gives the file a second name with POSIX link().
void put_at_second_name(const std::string& path, const std::string& second);

}  // namespace poesy
