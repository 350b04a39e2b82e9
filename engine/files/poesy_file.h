#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "engine/base/error.h"
#include "engine/base/text.h"
#include "engine/files/h5.h"
#include "engine/files/trial_read.h"

namespace poesy {

/// The attribute `filetype` of the root, which says what a file is.
/// @{
inline constexpr std::string_view kResultFile = "poesy-result";
inline constexpr std::string_view kShardFile = "poesy-shard";
/// @}
/// A reader refuses a newer major version; a minor version only adds.
inline constexpr std::int64_t kMajorVersion = 1;
inline constexpr std::int64_t kMinorVersion =
    0;  ///< from the first release on grows with what older programs may pass over

/// Opens a file that poesy wrote, a result or a shard. Throws FileError when it is not one, or of a newer major
/// version; h5::Error when it is damaged in a way that HDF5 reports.
h5::File open_poesy_file(const std::string& path);

/// The root's attribute of this name, which holds one text.
std::string text_attribute(const h5::File& file, const std::string& name);

/// Throws FileError, which says what it is instead, when the file's type is not this one.
void expect_filetype(const std::string& path, const h5::File& file, std::string_view filetype);

/// Opens such a file and gives what `use(file)` gives. Anything that HDF5 reports means a damaged file.
template <class Use>
auto use_poesy_file(const std::string& path, const Use& use) {
  try {
    const h5::File file = open_poesy_file(path);
    return use(file);
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    // Besides h5::Error: an empty list where a value should be, a shape too large for memory. It may quote the file.
    throw FileError(path, "is damaged: " + printable(error.what(), 300), kDamagedRemedy);
  }
}

/// Throws FileError when there is no such file to read.
void check_readable(const std::string& path);

/// The same as use_poesy_file, but of a file over which HDF5 fails in any other way too: it is used in another process
/// first.
template <class Use>
auto with_poesy_file(const std::string& path, const Use& use) {
  check_readable(path);
  trial_read(path, [&] {
    static_cast<void>(use_poesy_file(path, use));
    h5::close_library();
  });
  return use_poesy_file(path, use);
}

}  // namespace poesy
