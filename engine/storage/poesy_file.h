#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <new>
#include <string>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/storage/h5.h"

namespace poesy {

/// Values of the root's attribute `filetype`, which states the type of a file.
/// @{
inline constexpr std::string_view kResultFile = "poesy-result";
inline constexpr std::string_view kShardFile = "poesy-shard";
/// @}
/// The version of the format. A reader refuses another major version.
inline constexpr std::int64_t kMajorVersion = 1;
/// The minor version grows with additions that readers may ignore.
inline constexpr std::int64_t kMinorVersion = 0;

/// Opens a result or a shard. Throws FileError if it is neither, has another major version, or is not a plain tree
/// (h5::File::expect_plain_tree), so that callers read nothing outside the file. Throws h5::Error if it is damaged in a
/// way that HDF5 reports.
h5::File open_poesy_file(const std::string& path);

/// The advice for a damaged file.
inline constexpr const char* kDamagedRemedy = "take another copy, or run the study again";

inline constexpr unsigned long kTrialSeconds = 5;         ///< processor time that a child may take to read a file
inline constexpr unsigned long kTrialWaitSeconds = 9;     ///< wall time that a child may take
inline constexpr unsigned long kTrialBytes = 1UL << 28U;  ///< memory that a child may take in addition to the program's

/// Calls read() in a child process, so that a crash does not reach this one. Returns if the child succeeded.
///
/// With a damaged file, HDF5 1.10 may crash, loop, ask for all memory, or corrupt its heap and crash later, before it
/// reports an error. The child is a copy of this process, so what succeeds there succeeds here. Its limits:
/// kTrialSeconds of processor time and one more second for each 16 MiB of the file, wait_seconds of wall time and one
/// more for each 4 MiB, and kTrialBytes of memory and 16 more for each byte of the file (if /proc tells how much it has
/// already). It prints nothing.
///
/// Throws the FileError that read() threw. Throws FileError if read() ran out of memory (std::bad_alloc), because this
/// process may not take as much or because the file asks for more, if the child did not finish, or if there can be no
/// child. Precondition: no other thread holds a lock that read() takes (locks of the allocator are allowed).
void trial_read(const std::string& path, const std::function<void()>& read,
                unsigned long wait_seconds = kTrialWaitSeconds);

/// An attribute of the root that is one text.
std::string text_attribute(const h5::File& file, const std::string& name);

/// The mechanism file in a result or shard; empty if the mechanism has none.
std::string mechanism_text(const h5::File& file);

/// Throws FileError, which names the actual type, if the file has another type.
void expect_filetype(const std::string& path, const h5::File& file, std::string_view filetype);

/// Whether HDF5 failed because it ran out of memory.
bool is_out_of_memory(const std::exception& error);

/// Throws FileError if this is not a readable plain file.
void check_readable(const std::string& path);

/// Opens a file that poesy wrote and returns use(file). HDF5 may crash on a damaged file, so use() runs in another
/// process first. Any error that HDF5 reports means a damaged file.
template <class Use>
auto with_poesy_file(const std::string& path, const Use& use) {
  const auto open_and_use = [&] {
    try {
      const h5::File file = open_poesy_file(path);
      return use(file);
    } catch (const FileError&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      // Also other exceptions: an empty list where a value should be, a shape too large for any list. The message may
      // quote the file.
      if (is_out_of_memory(error)) throw std::bad_alloc();
      throw FileError(path, "is damaged: " + printable(error.what(), 300), kDamagedRemedy);
    }
  };
  check_readable(path);
  trial_read(path, [&] {
    static_cast<void>(open_and_use());
    h5::close_library();
  });
  return open_and_use();
}

}  // namespace poesy
