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
  bool (*may_be_replaced)(const std::string& path);  ///< whether a file that stands there is of this kind, or empty
  std::string_view longest_end = {};                 ///< of the names of files beside it that begin with its own
};

/// Throws InputError where a FileWriter can give no file this name, because its folder takes none that is so long.
void check_name_length(const std::string& path);

/// Whether a plain file has this mark in its first 64 KiB.
bool has_mark(const std::string& path, std::string_view mark);
/// The same, or it is empty.
bool is_marked(const std::string& path, std::string_view mark);

/// Gives the path to write to: where a symbolic link leads, whether there is a file yet or not; else the path itself.
/// Throws when no such file can come into being there, before anything is computed: InputError when its folder does not
/// exist, when what is there is one of the inputs or must not be replaced, for a name that is too long, or for
/// links in a circle, FileError when the folder cannot be written.
std::string check_output_path(const std::string& path, const OutputKind& kind, std::span<const std::string> inputs);

bool stands(const std::string& path);  ///< Whether anything has this name, a link that leads nowhere too.

/// Removes what killed programs left of files that were to become this one: PATH.tmp. and twelve digits, as FileWriter
/// names them. What cannot be removed stays. Precondition: nobody is writing this file.
void remove_left_over(const std::string& path);

/// Fills all of it with random bytes: the system's, or what stands for them in a test. Whether it could; if not, errno
/// says why.
using FillRandomly = bool (*)(std::span<std::byte> bytes);
bool fill_randomly(std::span<std::byte> bytes);  ///< The system's.

/// Writes a file that appears whole or not at all under its name: beside it under a temporary name that nobody can
/// guess, and at the end synced and renamed. Destroyed before commit, it removes the temporary file; what stood under
/// the name stays. A symbolic link of that name is replaced, not followed: check_output_path() gives where it leads.
/// Every member throws FileError with the system's reason.
class FileWriter {
 public:
  /// Refuses a path where something other than a plain file is (a folder, a device). The file gets the permission
  /// bits of the file `like`; if there is none, of the file that it replaces, and without that either those of the
  /// umask. fill: for the temporary name; what is there is not touched, and refused.
  explicit FileWriter(std::string path, const std::string& like = {}, FillRandomly fill = fill_randomly);
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;
  ~FileWriter();

  /// Gives the size that the file is going to have, for the message when it finds no room. Asked only then, from
  /// within another member.
  using ExpectedSize = std::function<std::size_t()>;
  /// That of this file.
  void expect(ExpectedSize size) { expected_ = std::move(size); }
  /// The same for a size that is known.
  void expect(std::size_t bytes) {
    expect([bytes] { return bytes; });
  }
  void write(std::span<const std::byte> bytes);  ///< Appends.
  void write(std::string_view text);             ///< Appends.

  /// For who writes in any order and cannot stop at an error, as HDF5 cannot.
  /// @{
  /// Writes bytes at a place. The first error is kept for check(); after it nothing more is written.
  void put(std::uint64_t at, std::span<const std::byte> bytes) noexcept;
  /// Reads back what was put, zeros elsewhere; whether it can be read. After an error nothing can.
  bool get(std::uint64_t at, std::span<std::byte> to) noexcept;
  /// Gives the file this length. It is also the size that is expected, even after an error.
  void end_at(std::uint64_t bytes) noexcept;
  void check() const;  ///< Throws the error that was kept; sync() and commit() do so too.
  /// @}

  void sync();    ///< Brings everything to the disk. Nothing may be written afterwards.
  void commit();  ///< Syncs, unless that was done, and puts the file in its place.

 private:
  std::uint64_t expected_size() const;  ///< 0 where it is not known.
  [[noreturn]] void fail(std::string_view action, int error) const;
  std::string remedy(int error) const;
  std::string missing_space() const;

  std::string path_;
  std::string temporary_;
  ExpectedSize expected_;     // if it was given
  std::uint64_t length_ = 0;  // as put() and end_at() leave it, with what came after an error
  int descriptor_ = -1;
  int error_ = 0;  // the first of put(), get() and end_at(): an errno
};

/// Writes a whole file, or nothing. Throws FileError.
void write_text(const std::string& path, std::string_view text);

/// Gives a file a second name: POSIX link(), or what stands for it in a test. 0, or -1 and errno.
using LinkFile = int (*)(const char* existing, const char* second);

/// Puts the file at `path` at `second` as well, in place of what is there. `path` stays all the while, and `second`
/// is replaced at once. A file system without hard links gets a copy. Throws FileError; then both are as they were.
void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file);

void put_at_second_name(const std::string& path, const std::string& second);  ///< The same with POSIX link().

}  // namespace poesy
