#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

struct stat;

namespace poesy {

/// A kind of file that the program writes.
struct OutputKind {
  std::string_view name;                             ///< "result"
  bool (*may_be_replaced)(const std::string& path);  ///< whether an existing file is of this kind, or empty
  std::string_view longest_end = {};  ///< longest end of the names of other files that begin with its name
};

/// Throws InputError if the name is too long for a FileWriter in this folder.
void check_name_length(const std::string& path);

/// Whether a plain file has this mark in its first 64 KiB.
bool has_mark(const std::string& path, std::string_view mark);
/// Whether a plain file has this mark, or is empty.
bool is_marked(const std::string& path, std::string_view mark);

/// Returns the path to write to: the target of a symbolic link, whether it exists or not, or the path itself. Throws if
/// such a file cannot be written, before anything is computed. InputError: the folder does not exist, the file there is
/// one of the inputs or must not be replaced, the name is too long, or links form a circle. FileError: the folder is
/// not writable.
std::string check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs);

bool stands(const std::string& path);  ///< Whether anything has this name, including a broken link.

/// Removes temporary files that killed programs left beside this file: PATH.tmp. and twelve digits, as FileWriter names
/// them. What cannot be removed stays. Precondition: nobody is writing this file.
void remove_left_over(const std::string& path);

/// Fills the bytes randomly: by the system, or by a substitute in a test. Returns whether it succeeded; if not, errno
/// has the reason.
using FillRandomly = bool (*)(std::span<std::byte> bytes);
bool fill_randomly(std::span<std::byte> bytes);  ///< Fills the bytes by the system.

/// Writes a file that appears complete or not at all. It is written beside its path under an unpredictable temporary
/// name, and finally synced and renamed. If the object is destroyed before commit(), the temporary file is removed and
/// an existing file stays. A symbolic link of that name is replaced, not followed; check_output_path() returns its
/// target. Every member throws FileError with the system's reason.
class FileWriter {
 public:
  /// Refuses a path that is something other than a plain file (a folder, a device). The file gets the permission bits
  /// of the file `like`, or else of the file that it replaces, or else those of the umask. fill: makes the temporary
  /// name; an existing file of that name is not changed, and causes an error.
  explicit FileWriter(std::string path, const std::string& like = {}, FillRandomly fill = fill_randomly);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// Returns the final size of the file, for the message if there is no room. It is called only then, from within
  /// another member.
  using ExpectedSize = std::function<std::size_t()>;
  /// Sets the size that is expected.
  void expect(ExpectedSize size) { expected_ = std::move(size); }
  /// Sets the size that is expected.
  void expect(std::size_t bytes) {
    expect([bytes] { return bytes; });
  }
  void write(std::span<const std::byte> bytes);  ///< Appends bytes.
  void write(std::string_view text);             ///< Appends text.

  /// For a caller that writes in any order and cannot stop at an error, such as HDF5.
  /// @{
  /// Writes bytes at a position. The first error is kept for check(), and nothing more is written after it.
  void put(std::uint64_t at, std::span<const std::byte> bytes) noexcept;
  /// Reads bytes that were put, and zeros elsewhere. Returns whether it succeeded; after an error it does not.
  bool get(std::uint64_t at, std::span<std::byte> to) noexcept;
  /// Sets the length of the file, which is also the expected size, even after an error.
  void end_at(std::uint64_t bytes) noexcept;
  void check() const;  ///< Throws the error that was kept; sync() and commit() do so too.
  /// @}

  void sync();    ///< Writes everything to the disk. Nothing may be written afterwards.
  void commit();  ///< Syncs if necessary, and renames the file.

 private:
  std::uint64_t expected_size() const;  ///< 0 if not known.
  [[noreturn]] void fail(std::string_view action, int error) const;
  std::string remedy(int error) const;
  std::string missing_space() const;

  std::string path_;
  std::string temporary_;
  ExpectedSize expected_;     // empty if not given
  std::uint64_t length_ = 0;  // as set by put() and end_at(), even after an error
  int descriptor_ = -1;
  int error_ = 0;  // first error of put(), get() or end_at(), an errno
};

/// Writes a whole file, or nothing. Throws FileError.
void write_text(const std::string& path, std::string_view text);

/// Gives a file a second name: POSIX link(), or a substitute in a test. Returns 0, or -1 with errno.
using LinkFile = int (*)(const char* existing, const char* second);

/// Gives the file at `path` also the name `second`, and replaces an existing file there at once. `path` exists at any
/// moment. On a file system without hard links the file is copied. Throws FileError and then leaves both as they were.
void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file);

void put_at_second_name(const std::string& path, const std::string& second);  ///< The same with POSIX link().

}  // namespace poesy
