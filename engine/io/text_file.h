#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace poesy {

/// Reads a whole file. `what` names what it should be, for messages ("study").
/// Throws InputError for a folder or a file of more than most_bytes, FileError when it cannot be read.
std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes);

}  // namespace poesy
