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
  /// The longest ending that is appended to the name of the file for a related file: ".part.1" for the older checkpoint
  /// of a result.
  std::string_view longest_end = {};
};

/// Throws InputError if the temporary file of a FileWriter for this path would have too long a name for its folder.
void check_name_length(const std::string& path);

/// The content of a plain file; none if there is no plain file that can be opened, and empty if reading fails.
std::optional<std::string> content_of(const std::string& path);
/// Returns true if a plain file contains the text `mark` in its first 64 KiB.
bool has_mark(const std::string& path, std::string_view mark);
/// Returns true if a plain file contains the text `mark` in its first 64 KiB, or is empty.
bool is_marked(const std::string& path, std::string_view mark);

/// Checks, before anything is computed, that a file can be written to this path. Returns the path to write to: for a
/// symbolic link its target, which may not exist yet, otherwise the path itself. Throws InputError if the folder does
/// not exist, if the path leads to one of the inputs or to a file that must not be replaced (OutputKind), if the name
/// is too long, or if links form a circle. Throws FileError if the folder is not writable.
std::string check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs);

bool stands(const std::string& path);  ///< Returns true if there is anything at this path, including a broken link.

/// Removes the temporary files that FileWriters for this path left when their programs were killed: PATH.tmp. followed
/// by twelve hexadecimal digits. Files that cannot be removed stay. Precondition: no program is writing the file.
void remove_left_over(const std::string& path);

/// A function that fills bytes with random numbers: fill_randomly(), or a substitute in a test. Returns true if it
/// succeeded, else false with the reason in errno.
using FillRandomly = bool (*)(std::span<std::byte> bytes);
bool fill_randomly(std::span<std::byte> bytes);  ///< Fills bytes with random numbers of the system.

/// Writes a file that appears complete or not at all. The file is written in the same folder under an unpredictable
/// temporary name, and finally synced and renamed. If the object is destroyed before commit(), the temporary file is
/// removed and an existing file stays. A symbolic link at the path is replaced, not followed; use check_output_path()
/// to get its target. All members that are not noexcept throw FileError with the system's reason.
class FileWriter {
 public:
  /// Throws FileError if there is something other than a plain file at the path (a folder, a device). The new file gets
  /// the permission bits of the file `like` if that exists, otherwise those of the file that it replaces, otherwise
  /// those that the umask allows. fill: makes the random bytes of the temporary name. If there is already a file with
  /// that name, it is not changed, and FileError is thrown.
  explicit FileWriter(std::string path, const std::string& like = {}, FillRandomly fill = fill_randomly);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// A function that returns the final size of the file in bytes. It is called only for the message that the disk is
  /// full.
  using ExpectedSize = std::function<std::size_t()>;
  /// Sets the function that returns the expected size.
  void expect(ExpectedSize size) { expected_ = std::move(size); }
  /// Sets the expected size of the file, for the message that the disk is full.
  void expect(std::size_t bytes) {
    expect([bytes] { return bytes; });
  }
  void write(std::span<const std::byte> bytes);  ///< Appends bytes.
  void write(std::string_view text);             ///< Appends text.

  /// Functions for a caller that writes in any order and cannot stop at an error, such as HDF5.
  /// @{
  /// Writes the bytes at the offset `at` (bytes) of the file. The first error is kept for check(); after an error,
  /// nothing is written.
  void put(std::uint64_t at, std::span<const std::byte> bytes) noexcept;
  /// Fills `to` with the bytes of the file from the offset `at` (bytes) on; bytes that put() did not write are zero.
  /// Returns false after an error of this or an earlier call.
  bool get(std::uint64_t at, std::span<std::byte> to) noexcept;
  /// Sets the length of the file. Even after an error, the length is recorded as the expected size.
  void end_at(std::uint64_t bytes) noexcept;
  void check() const;  ///< Throws the first error of put(), get() or end_at(), if any; sync() and commit() do so too.
  /// @}

  void sync();    ///< Waits until all bytes are on the disk. Nothing may be written afterwards.
  void commit();  ///< Calls sync() if that was not done, and renames the temporary file to the path.

 private:
  std::uint64_t expected_size() const;  ///< The expected size of the file in bytes; 0 if not known.
  [[noreturn]] void fail(std::string_view action, int error) const;
  std::string remedy(int error) const;
  std::string missing_space() const;

  std::string path_;
  std::string temporary_;
  ExpectedSize expected_;     // empty if not given
  std::uint64_t length_ = 0;  // length of the file as put() and end_at() set it, even after an error
  int descriptor_ = -1;
  int error_ = 0;  // first error of put(), get() or end_at(), an errno
};

/// Writes a text file, which appears complete or not at all. Throws FileError.
void write_text(const std::string& path, std::string_view text);

/// A function that gives a file a second name: POSIX link(), or a substitute in a test. Returns 0, or -1 with errno.
using LinkFile = int (*)(const char* existing, const char* second);

/// Gives the file at `path` a second name, `second`, and atomically replaces an existing file there. At every moment
/// there is a file at `path`. On a file system without hard links the file is copied. If the function throws FileError,
/// both names are as before.
void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file);

/// Gives the file a second name with POSIX link().
void put_at_second_name(const std::string& path, const std::string& second);

}  // namespace poesy
