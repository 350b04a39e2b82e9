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
/// The major version of the format. A reader refuses files with another major version.
inline constexpr std::int64_t kMajorVersion = 1;
/// The minor version of the format. It grows with additions that readers may ignore.
inline constexpr std::int64_t kMinorVersion = 0;

/// Opens a result or a shard. Throws FileError if HDF5 cannot open the file, or if the file is of another type, has
/// another major version, or is not a plain tree (h5::File::expect_plain_tree). So callers never read data outside the
/// file. Throws h5::Error if HDF5 opens the file but then reports that it is damaged.
h5::File open_poesy_file(const std::string& path);

/// The advice for a damaged file.
inline constexpr const char* kDamagedRemedy = "take another copy, or run the study again";

inline constexpr unsigned long kTrialSeconds = 5;       ///< s, processor time of the child in trial_read()
inline constexpr unsigned long kTrialWaitSeconds = 60;  ///< s, wall time of that child, on a busy machine
/// Bytes of memory that the child in trial_read() may take in addition to those of the program.
inline constexpr unsigned long kTrialBytes = 1UL << 28U;

/// Calls read() in a child process, so that a crash does not end this process. Returns if the child succeeded.
///
/// With a damaged file, HDF5 1.10 may crash, loop, ask for all memory, or corrupt its heap and crash later, before it
/// reports an error. The child is a copy of this process, so if read() succeeds there, it succeeds here. The limits of
/// the child are: processor time, kTrialSeconds plus one second for each 16 MiB of the file; wall time, wait_seconds
/// plus one second for each 4 MiB; additional memory, kTrialBytes plus 16 bytes for each byte of the file (not limited
/// if /proc does not tell how much memory the child already has). The child prints nothing.
///
/// Throws the FileError that read() threw. Also throws FileError if the child ran out of memory (std::bad_alloc), did
/// not finish, or could not be started. Memory runs out if the limit of this process is too low, or if a damaged file
/// asks for too much. Precondition: no other thread holds a lock that read() takes (locks of the allocator are
/// allowed).
void trial_read(const std::string& path, const std::function<void()>& read,
                unsigned long wait_seconds = kTrialWaitSeconds);

/// The text in an attribute of the root. Throws h5::Error if it is not one text.
std::string text_attribute(const h5::File& file, const std::string& name);

/// The text of the mechanism file, which a result or shard contains; empty if the mechanism is not from a file.
std::string mechanism_text(const h5::File& file);

/// Throws FileError if the file is not of the type `filetype` (kResultFile or kShardFile). The message names the actual
/// type.
void expect_filetype(const std::string& path, const h5::File& file, std::string_view filetype);

/// Returns true if HDF5 failed because it ran out of memory.
bool is_out_of_memory(const std::exception& error);

/// Throws FileError if this is not a readable plain file.
void check_readable(const std::string& path);

/// Opens a file that poesy wrote and returns use(file). HDF5 may crash on a damaged file, so use() runs in another
/// process first. An error that HDF5 reports is thrown as a FileError for a damaged file.
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
      // This also catches exceptions that do not come from HDF5, for instance if a list is empty or a shape is too
      // large. The message may contain text from the file.
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
