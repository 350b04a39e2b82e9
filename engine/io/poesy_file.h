#pragma once

#include <string>
#include <string_view>

#include "engine/base/error.h"
#include "engine/io/h5.h"

namespace poesy {

/// What to do about a damaged file.
inline constexpr const char* kDamagedRemedy = "take another copy, or run the study again";

/// Opens a file that poesy wrote, a result or a shard. Throws FileError when it is not one, or of a newer major
/// version; h5::Error when it is damaged.
h5::File open_poesy_file(const std::string& path);

/// The root's attribute of this name, which holds one text.
std::string text_attribute(const h5::File& file, const std::string& name);

/// Throws FileError, which says what it is instead, when the file's type is not this one.
void expect_filetype(const std::string& path, const h5::File& file, std::string_view filetype);

/// Opens a file that poesy wrote and gives what `use(file)` gives. Anything HDF5 stumbles over means a damaged file.
template <class Use>
auto with_poesy_file(const std::string& path, const Use& use) {
  try {
    const h5::File file = open_poesy_file(path);
    return use(file);
  } catch (const FileError&) {
    throw;
  } catch (const std::exception& error) {
    // Besides h5::Error: an empty list where a value should be, a shape too large for memory.
    throw FileError(path, std::string("is damaged: ") + error.what(), kDamagedRemedy);
  }
}

}  // namespace poesy
