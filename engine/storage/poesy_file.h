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

/// The attribute `filetype` of the root, which says what a file is.
/// @{
inline constexpr std::string_view kResultFile = "poesy-result";
inline constexpr std::string_view kShardFile = "poesy-shard";
/// @}
/// The version of the format. A reader refuses another major version.
inline constexpr std::int64_t kMajorVersion = 1;
/// It grows with what is added and may be passed over.
inline constexpr std::int64_t kMinorVersion = 0;

/// Opens a file that poesy wrote, a result or a shard. Throws FileError when it is not one, of another major version,
/// or not a plain tree (h5::File::expect_plain_tree): whoever reads it reads nothing else. Throws h5::Error when it is
/// damaged in a way that HDF5 reports.
h5::File open_poesy_file(const std::string& path);

/// What to do about a damaged file.
inline constexpr const char* kDamagedRemedy = "take another copy, or run the study again";

inline constexpr unsigned long kTrialSeconds = 5;         ///< processor time that a child may take to read a file
inline constexpr unsigned long kTrialWaitSeconds = 9;     ///< time that it may take by the clock
inline constexpr unsigned long kTrialBytes = 1UL << 28U;  ///< memory that it may take besides what the program has

/// Calls read() in a child process, so that nothing that comes of it reaches this one; returns if it ended well there.
///
/// HDF5 1.10 may crash, loop or ask for all memory over a damaged file before it reports an error, or spoil its own
/// heap and crash later. The child is a copy of this process at this moment, so what ended well there ends well here.
/// It may take kTrialSeconds of processor time and one more for each 16 MiB of the file, wait_seconds by the clock
/// and one more for each 4 MiB, and kTrialBytes of memory and 16 more for each byte of the file (where /proc tells how
/// much it has already); it says nothing to the terminal.
///
/// Throws FileError as read() did, FileError that says so where read() ran out of memory (std::bad_alloc), because this
/// process may not take as much or because the file asks for more; FileError when the child did not come to an end of
/// read(), or when there can be no child. Precondition: no other thread holds a lock that read() takes (the allocator's
/// own may be held).
void trial_read(const std::string& path, const std::function<void()>& read,
                unsigned long wait_seconds = kTrialWaitSeconds);

/// The root's attribute of this name, which holds one text.
std::string text_attribute(const h5::File& file, const std::string& name);

/// The file that describes the mechanism; empty where there is none.
std::string mechanism_text(const h5::File& file);

/// Throws FileError, which says what it is instead, when the file's type is not this one.
void expect_filetype(const std::string& path, const h5::File& file, std::string_view filetype);

/// Whether HDF5 failed for want of memory.
bool is_out_of_memory(const std::exception& error);

/// Throws FileError when there is no such plain file to read.
void check_readable(const std::string& path);

/// Opens a file that poesy wrote and gives what `use(file)` gives. Because HDF5 fails over a damaged file in other ways
/// than by errors, the file is used in another process first. Anything that HDF5 reports means a damaged file.
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
      // Besides h5::Error: an empty list where a value should be, a shape too large for any list. It may quote the
      // file.
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
