#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace poesy {

/// Reads a whole file. `what` names what it should be, for messages ("study").
/// Throws InputError for a folder or a file of more than most_bytes, FileError when it cannot be read.
std::string read_text(const std::string& path, std::string_view what, std::size_t most_bytes);

/// Gives a file a second name: POSIX link(), or what stands for it in a test. 0, or -1 and errno.
using LinkFile = int (*)(const char* existing, const char* second);

/// Puts the file at `path` at `second` as well, in place of what is there. `path` stays all the while, and `second`
/// is replaced at once. A file system without hard links gets a copy. Throws FileError; then both are as they were.
void put_at_second_name(const std::string& path, const std::string& second, LinkFile link_file);

/// The same with POSIX link().
void put_at_second_name(const std::string& path, const std::string& second);

}  // namespace poesy
